/* From a disc to a box, and from a box to another name of it. SPDX-License-Identifier: MIT */
#include "refined/goe_change.h"

#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_box.h"
#include "refined/goe_footprint.h"

#define QUARTER_TURN_RAD 1.57079633f
#define ONE_FACE_IMAGES 3   /* that must agree before a box starts from one face */
#define TWO_FACES_IMAGES 2  /* ... from two */
#define AGREEING_PX 7.0f    /* sigmas of a pixel by which the extents of two images may differ */
#define AGREEING_SHARE 0.1f /* ... and share of the whole */
#define RANGE_SHARE 0.1f    /* one sigma of the range over it */
#define AGREEING_SIGMAS2 9.0f
#define SIZE_FREEDOM 2.0f  /* one sigma of the box's extents at its start, in its larger side */
#define DEPTH_FREEDOM 4.0f /* ... of its depth */
#define DEPTH_HELD 0.01f   /* ... if one face alone is seen */
#define LENGTH_FREED 2.0f  /* relative, when it comes into view */

/* --------------------------------------------------------------------------------------------------------------- start -- */

/* GOE_A and GOE_Q of a covariance, about axes turned by the angle of c, s: a' = (a c - s) m, q' = q m, m = 1/(a s + c). */
static void turn_covariance(const float x[GOE_STATES], float c, float s, float covariance[GOE_KEPT][GOE_KEPT]) {
    const float m = 1.0f / (x[GOE_A] * s + c);
    const float shear = x[GOE_Q] * s * m;
    for (size_t i = 0; i < GOE_A; i++) {
        covariance[i][GOE_Q] = m * (covariance[i][GOE_Q] - shear * covariance[i][GOE_A]);
        covariance[i][GOE_A] *= m * m;
    }
    const float aa = covariance[GOE_A][GOE_A];
    const float aq = covariance[GOE_A][GOE_Q] - shear * aa;
    const float qq = covariance[GOE_Q][GOE_Q] - shear * (covariance[GOE_A][GOE_Q] + aq);
    covariance[GOE_A][GOE_A] = goe_square(m * m) * aa;
    covariance[GOE_A][GOE_Q] = m * m * m * aq;
    covariance[GOE_Q][GOE_Q] = m * m * qq;
}

/* From a disc to the box of the footprint. The nuisances and the range keep their covariance; the reference moves by up to
 * the box's size, and the disc was only a stand-in. both: two faces are seen. */
static void start_box(goe_filter_t *filter, const goe_footprint_t *box, bool both) {
    float c[GOE_KEPT][GOE_KEPT];
    float *x = filter->state;
    const float size = goe_larger(box->width, box->length);
    goe_srif_marginal(&filter->inverse, c);
    for (size_t i = GOE_BX; i <= GOE_BZ; i++) {
        c[i][i] += filter->drift_rad2;
    }
    c[GOE_A][GOE_A] += filter->walk2;
    turn_covariance(x, box->turn_cos, box->turn_sin, c);
    c[GOE_A][GOE_A] = 4.0f * c[GOE_A][GOE_A] + goe_square(4.0f * size) + 1.0e-6f;
    c[GOE_Q][GOE_Q] = 2.0f * c[GOE_Q][GOE_Q] + goe_square(size * box->q);
    x[GOE_E] *= box->q / x[GOE_Q];
    x[GOE_A] = box->a;
    x[GOE_Q] = box->q;
    x[GOE_SX] = box->length * box->sine;
    x[GOE_FX] = box->width * box->cosine;
    x[GOE_D] = box->length * box->cosine - box->width * goe_absolute(box->sine);
    const float sigma[GOE_STATES - GOE_KEPT] = {SIZE_FREEDOM * size, SIZE_FREEDOM * size,
                                                (both ? DEPTH_FREEDOM : DEPTH_HELD) * size,
                                                SIZE_FREEDOM * goe_larger(goe_absolute(x[GOE_E]), size)};
    goe_srif_from_covariance(c, sigma, &filter->root, &filter->inverse);
    goe_refined_settle(filter);
    filter->turn_cos = box->turn_cos;
    filter->turn_sin = box->turn_sin;
    filter->deep = both;
    filter->outline = false;
    filter->exchanged = false;
    filter->named = false;
    goe_refined_enter(filter, GOE_PHASE_BOX);
}

/* Difference of two orientations, each within a quarter turn of Z, that may have front and side exchanged. */
static float difference_rad(float a, float b) {
    const float d = a - b;
    if (d > 0.5f * QUARTER_TURN_RAD) {
        return d - QUARTER_TURN_RAD;
    }
    return d < -0.5f * QUARTER_TURN_RAD ? d + QUARTER_TURN_RAD : d;
}

/* One image alone may be lucky. */
static bool one_face_agrees(goe_filter_t *filter, const goe_footprint_t *box) {
    const float d = difference_rad(box->orientation_rad, filter->candidate[0]);
    const bool agrees = filter->agreeing > 0 && goe_square(d) < AGREEING_SIGMAS2 * goe_square(box->sigma_rad);
    filter->agreeing = (uint8_t)(agrees ? filter->agreeing + 1 : 1);
    filter->candidate[0] = box->orientation_rad;
    return filter->agreeing >= ONE_FACE_IMAGES;
}

/* An outlier must not become the start, and range and depth multiply in the image: the range must be known. */
static bool two_faces_agree(goe_filter_t *filter, const goe_observation_t *sight, const goe_footprint_t *box) {
    const float q = filter->state[GOE_Q];
    const float most = RANGE_SHARE * q * goe_observation_reference_z(sight);
    const float tolerance = AGREEING_PX * goe_observation_pixel(sight) + AGREEING_SHARE * (box->left + box->right);
    const bool agree = filter->agreeing > 0 && goe_absolute(box->left - filter->candidate[0]) < tolerance &&
                       goe_absolute(box->right - filter->candidate[1]) < tolerance;
    filter->agreeing = (uint8_t)(agree ? filter->agreeing + 1 : 1);
    filter->candidate[0] = box->left;
    filter->candidate[1] = box->right;
    if (goe_inverse_variance(&filter->inverse, GOE_Q) > most * most) {
        filter->agreeing = 0;
    }
    return filter->agreeing >= TWO_FACES_IMAGES;
}

static bool find_box(goe_filter_t *filter, const goe_observation_t *sight, goe_footprint_t *box) {
    const bool both = sight->point[GOE_BASE_NEAR].usable;
    if (both != filter->candidate_both) { /* what the images before told is no candidate of this kind */
        filter->candidate_both = both;
        filter->agreeing = 0;
    }
    if (!(both ? goe_footprint_two_faces(sight, box) : goe_footprint_one_face(sight, box))) {
        filter->agreeing = 0;
        return false;
    }
    return both ? two_faces_agree(filter, sight, box) : one_face_agrees(filter, box);
}

bool goe_change_to_box(goe_filter_t *filter, const goe_observation_t *sight) {
    goe_footprint_t box;
    if (!sight->base || sight->settings->model == GOE_MODEL_DISC || !find_box(filter, sight, &box)) {
        return false;
    }
    start_box(filter, &box, sight->point[GOE_BASE_NEAR].usable);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- upkeep -- */

/* The side's length was held while one face alone was seen: with it free, only its direction would be seen, and every new
 * linearisation would draw another line through the origin; they meet at length 0. */
static void free_length(goe_filter_t *filter, float side) {
    goe_srif_spread(&filter->root, GOE_SX, filter->state[GOE_SX], GOE_D, side, LENGTH_FREED);
    goe_refined_invert(filter);
    filter->deep = true;
}

/* Front and side with each other's names. Doing it again undoes it. */
static void exchange_state(float x[GOE_STATES]) {
    const float sign = x[GOE_SX] > 0.0f ? 1.0f : -1.0f;
    const float scale = 1.0f / (1.0f + 0.5f * x[GOE_D]);
    const float side = x[GOE_SX];
    x[GOE_A] = (x[GOE_A] + 0.5f * (sign * x[GOE_FX] + side)) * scale;
    x[GOE_Q] *= scale;
    x[GOE_SX] = -sign * x[GOE_FX] * scale;
    x[GOE_FX] = goe_absolute(side) * scale;
    x[GOE_D] = -x[GOE_D] * scale;
    x[GOE_E] *= scale;
}

/* R in the new states: the derivative of the old ones by them is that of the exchange back. */
static void exchange_root(goe_filter_t *filter, const float was[GOE_STATES]) {
    enum { OF_A, OF_Q, OF_SX, OF_FX, OF_D, OF_E };
    goe_substitution_t old;
    const float *is = filter->state;
    const float sign = is[GOE_SX] > 0.0f ? 1.0f : -1.0f;
    const float scale = 1.0f / (1.0f + 0.5f * is[GOE_D]);
    memset(&old, 0, sizeof old);
    for (size_t k = 0; k < GOE_CHANGED; k++) {
        old.by[k][OF_D] = -0.5f * scale * was[GOE_A + k];
    }
    old.by[OF_D][OF_D] -= scale;
    old.by[OF_A][OF_SX] = 0.5f * scale;
    old.by[OF_A][OF_FX] = 0.5f * scale * sign;
    old.by[OF_SX][OF_FX] = -scale * sign;
    old.by[OF_FX][OF_SX] = scale * sign;
    old.by[OF_A][OF_A] = scale;
    old.by[OF_Q][OF_Q] = scale;
    old.by[OF_E][OF_E] = scale;
    goe_srif_substitute(&filter->root, &old, &filter->rows);
}

static void exchange_names(goe_filter_t *filter) {
    float was[GOE_STATES];
    memcpy(was, filter->state, sizeof was);
    exchange_state(filter->state);
    exchange_root(filter, was);
    goe_refined_invert(filter);
    filter->exchanged = !filter->exchanged;
}

bool goe_change_box(goe_filter_t *filter, const goe_observation_t *sight) {
    const float side = goe_box_depth(filter->state).side;
    if (!filter->deep && sight->base && sight->point[GOE_BASE_NEAR].usable) {
        free_length(filter, side);
        return true;
    }
    if (goe_absolute(filter->state[GOE_SX]) > GOE_EXCHANGE_SLOPE * side) {
        exchange_names(filter);
        return true;
    }
    return false;
}
