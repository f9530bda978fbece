/* The augmented states: latency of the poses, velocity of the obstacle. SPDX-License-Identifier: MIT */
#include "refined/goe_mover.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_gate.h"
#include "refined/goe_growth.h"

#if GOE_AUGMENTED

#define LATENCY_PRIOR_S 0.05f /* one sigma of the latency of the poses before any image */
#define LATENCY_SHARE 0.25f   /* relative sigma of a latency: a mean rate of turn replaces the rate at the exposure */
#define SPREAD_GROWN 25.0f    /* factor on a velocity's variance when the filter begins to follow the obstacle */
#define SPEED_MAX_M_S 20.0f   /* largest velocity by the images; a faster one is an error of the linearization */
#define LATE_MIN_S 0.02f      /* least latency that is reported as late */
#define LATE_SIGMAS 2.7f      /* least ratio of such a latency to its sigma */
#define RATE_PREDICTED 0.8f   /* share of the previous rate of turn in the present one: mean over usual swaying */
#define MOVES_CHI2 25.0f /* chi-squared of a velocity, two degrees of freedom: 4e-6 by chance if there is only noise */
#define BOXES_CHI2 45.0f /* the same for upright boxes, which drift also because the obstacle is no ellipse */
#define REST_CHI2 9.0f   /* the obstacle moves if a latency leaves at least this sum of squares unexplained */
#define REST_SHARE 0.15f /* and if a velocity leaves at most this share of that sum */
#define LATE_SHARE 0.3f  /* poses are late only if a velocity leaves more than this share of that sum */
#define MOVING_SIGMAS2 9.0f  /* squared sigmas of the velocity above which a late track moves as well */
#define MOVES_MIN_M_S 1.0f   /* a slower motion counts as none */
#define MOVES_S 0.4f         /* least time for which all images contradict a static obstacle */
#define MOVES_IMAGES 3       /* least number of these images */
#define SETTLED_S 1.4f       /* least time of informative images: less gives no velocity */
#define SINCE_MAX_S 0.5f     /* a longer gap between images counts as this */
#define COLUMN_MAX 1.0e3f    /* limit of a column, focal lengths per second, or per m/s: no flight exceeds it */
#define AUGMENTED_MAX 1.0e9f /* limit of the augmented states and of their rows of the triangle: no flight exceeds it */
#define SPEED_SD_M_S 8.0f /* one sigma of the velocity along north and east of an obstacle that moves on the ground */
#define TIME_MIN_S 0.1f   /* keeps a walk over time finite */
#define DETERMINANT_MIN 1.0e-5f /* least determinant of a 2 x 2 covariance, over the product of the variances */

/*@ requires \valid(root) && i <= j < GOE_AUGMENTED; */
static float *augmented_at(goe_triangle_t *root, size_t i, size_t j) {
    return goe_srif_at(root, GOE_STATES + i, GOE_STATES + j);
}

static void forget_augmented(goe_triangle_t *root) {
    const size_t first = goe_srif_augmented_row();
    memset(&root->element[first], 0, sizeof root->element - first * sizeof root->element[0]);
    memset(root->right, 0, sizeof root->right);
}

void goe_mover_clear(goe_filter_t *filter) {
    memset(&filter->mover, 0, sizeof filter->mover);
    forget_augmented(&filter->root);
    *augmented_at(&filter->root, GOE_AUGMENTED_LATENCY, GOE_AUGMENTED_LATENCY) = 1.0f / LATENCY_PRIOR_S;
    filter->root.estimated = 0;
}

/* ------------------------------------------------------------------------------------------------------------ columns -- */

static float sane(float column) { return goe_within(column, COLUMN_MAX) ? column : 0.0f; }

/* (R33): an obstacle with the velocity v has moved by v t. Poses that are late by tau have the attitude and velocity of another time, tau
 * away. */
void goe_mover_columns(const goe_axes_t *axes, const goe_observation_t *obs, goe_rows_t *rows) {
    const float q = obs->state[GOE_INVERSE_RANGE];
    const float passed = q * obs->elapsed_s;
    const float *before = obs->rate_before_rad_s;
    const float rate[3] = {-RATE_PREDICTED * before[0], -RATE_PREDICTED * before[1], -RATE_PREDICTED * before[2]};
    const goe_xz_t gained = {q * obs->gained_m_s.x, q * obs->gained_m_s.z};
    for (size_t i = 0; i < rows->count; i++) {
        float *row = rows->matrix->row[i];
        float *by = &row[GOE_AUGMENTED_COLUMN];
        const goe_xz_t place = {by[GOE_AUGMENTED_VELOCITY_X], by[GOE_AUGMENTED_VELOCITY_Z]};
        const goe_xz_t moved = goe_xz_out_of(place, axes->turn_cos, axes->turn_sin);
        const float turned = row[0] * rate[1] + row[1] * rate[0] + row[2] * rate[2];
        by[GOE_AUGMENTED_LATENCY] = sane(turned - goe_xz_dot(place, gained));
        by[GOE_AUGMENTED_VELOCITY_X] = sane(moved.x * passed);
        by[GOE_AUGMENTED_VELOCITY_Z] = sane(moved.z * passed);
    }
}

/* ------------------------------------------------------------------------------------------------------------ sigmas -- */

float goe_mover_variance(const goe_filter_t *filter, goe_xz_t along) {
    const float *t = &filter->root.element[goe_srif_augmented_row()];
    if (goe_srif_augmented_count(&filter->root) < GOE_AUGMENTED) {
        return 0.0f;
    }
    const float x = along.x / t[3]; /* T' y = (0, along) */
    return goe_square(x) + goe_square((along.z - t[4] * x) / t[5]);
}

float goe_mover_own_variance(const goe_navigation_t *navigation, float elapsed_s) {
    return goe_square(navigation->velocity_bias_sd_m_s) +
           goe_square(navigation->position_walk_sd_m) / goe_larger(elapsed_s, TIME_MIN_S);
}

/* A latency that is not corrected, because it is not significant, is an error as well. */
float goe_mover_latency_sd(const goe_filter_t *filter) {
    const float wider = goe_larger(filter->health.mean_nis, 1.0f);
    const float root = filter->root.element[goe_srif_augmented_row()];
    if (goe_srif_augmented_count(&filter->root) > 0) {
        const float states[GOE_STATES] = {0.0f};
        const float latency[GOE_AUGMENTED] = {1.0f, 0.0f, 0.0f};
        float part[GOE_AUGMENTED];
        goe_srif_augmented(&filter->root, states, GOE_UNWEIGHTED, latency, 0.0f, part);
        return sqrtf(wider * goe_srif_augmented_dot(part, part) +
                     goe_square(LATENCY_SHARE * filter->mover.augmented[GOE_AUGMENTED_LATENCY]));
    }
    return sqrtf(wider + goe_square(filter->root.right[GOE_AUGMENTED_LATENCY])) / goe_absolute(root);
}

/* ----------------------------------------------------------------------------------------------------------- judgement -- */

/* (R34): least squares, with T'T and T'z, for a velocity with poses that are on time, and how much of the squares latency and velocity
 * explain. z includes the latency that is already corrected. */
typedef struct {
    goe_xz_t velocity_m_s;
    float spread[3];                   /* its covariance: XX, XZ, ZZ */
    float latency_s;                   /* if nothing moves */
    float by_latency;                  /* sum of squares that the latency explains */
    float rest_latency, rest_velocity; /* sum of squares that the latency, or the velocity, leaves */
    float wider;                       /* variance of the residuals over the configured one, at least 1 */
} fit_t;

static bool fit_augmented(const goe_filter_t *filter, const goe_observation_t *obs, fit_t *fit) {
    const float *r = &filter->root.element[goe_srif_augmented_row()];
    const float t[GOE_AUGMENTED][GOE_AUGMENTED] = {{r[0], r[1], r[2]}, {0.0f, r[3], r[4]}, {0.0f, 0.0f, r[5]}};
    const float latency_s = filter->mover.augmented[GOE_AUGMENTED_LATENCY];
    const float z[GOE_AUGMENTED] = {filter->root.right[0] + t[0][0] * latency_s, filter->root.right[1],
                                    filter->root.right[2]};
    const float xx = t[0][1] * t[0][1] + t[1][1] * t[1][1];
    const float xz = t[0][1] * t[0][2] + t[1][1] * t[1][2];
    const float zz = t[0][2] * t[0][2] + t[1][2] * t[1][2] + t[2][2] * t[2][2];
    const float to_x = t[0][1] * z[0] + t[1][1] * z[1];
    const float to_z = t[0][2] * z[0] + t[1][2] * z[1] + t[2][2] * z[2];
    /* xx zz - xz^2 as a sum of squares: no cancellation */
    const float determinant = goe_square(t[0][1] * t[1][2] - t[0][2] * t[1][1]) + goe_square(t[0][1] * t[2][2]) +
                              goe_square(t[1][1] * t[2][2]);
    if (!(determinant > 0.0f)) {
        return false;
    }
    const float own = goe_mover_own_variance(&obs->settings->navigation, obs->elapsed_s);
    const float left = filter->mover.nis - z[0] * z[0] - z[1] * z[1] - z[2] * z[2];
    fit->wider = goe_larger(left / filter->mover.rows, 1.0f);
    fit->velocity_m_s.x = (zz * to_x - xz * to_z) / determinant;
    fit->velocity_m_s.z = (xx * to_z - xz * to_x) / determinant;
    fit->spread[0] = fit->wider * zz / determinant + own;
    fit->spread[1] = -fit->wider * xz / determinant;
    fit->spread[2] = fit->wider * xx / determinant + own;
    fit->latency_s = z[0] / t[0][0];
    fit->by_latency = z[0] * z[0];
    fit->rest_latency = z[1] * z[1] + z[2] * z[2];
    fit->rest_velocity =
        goe_larger(fit->by_latency + fit->rest_latency - fit->velocity_m_s.x * to_x - fit->velocity_m_s.z * to_z, 0.0f);
    return true;
}

/* Whether the image gives a scale that does not require a static obstacle: the foot, through the height. */
static bool has_scale(const goe_observation_t *obs) { return goe_sides_see(obs->sides, GOE_SIDE_BOTTOM) || obs->base; }

/* Determinant of the covariance (x, both; both, z). One too close to singular for float counts as wide as it may be. */
static float determinant_of(float x, float both, float z) {
    return goe_larger(x * z - both * both, DETERMINANT_MIN * (x * z));
}

/* Whether no static obstacle and no latency shows that velocity. */
static bool is_unlike_static(const fit_t *fit, float least) {
    const goe_xz_t v = fit->velocity_m_s;
    const float determinant = determinant_of(fit->spread[0], fit->spread[1], fit->spread[2]);
    const float squared = v.x * v.x * fit->spread[2] - 2.0f * v.x * v.z * fit->spread[1] + v.z * v.z * fit->spread[0];
    return goe_xz_dot(v, v) > MOVES_MIN_M_S * MOVES_MIN_M_S && squared > least * determinant &&
           fit->rest_latency > REST_CHI2 * fit->wider && fit->rest_velocity < REST_SHARE * fit->rest_latency;
}

/* Whether enough images in a row contradict a static obstacle. */
static bool is_moving(goe_filter_t *filter, const fit_t *fit, bool outgrown, float since_s) {
    goe_mover_t *m = &filter->mover;
    const float least = goe_filter_by_boxes(filter) ? BOXES_CHI2 : MOVES_CHI2;
    if (!outgrown && !(m->observed_s > SETTLED_S && is_unlike_static(fit, least))) {
        m->unlike_s = 0.0f;
        m->images = 0;
        return false;
    }
    m->unlike_s += since_s;
    return goe_count_image(&m->images) >= MOVES_IMAGES && m->unlike_s >= MOVES_S;
}

/* (R35): one over the sigma of a component of the velocity, the smaller of five sigmas by the images and of SPEED_SD_M_S, which covers
 * obstacles that move on the ground. */
static float root_of(float variance) { return goe_larger(1.0f / sqrtf(SPREAD_GROWN * variance), 1.0f / SPEED_SD_M_S); }

/* Follows the obstacle with the velocity by the images. As this was linearized at a wrong place, its sigma is increased. The latency starts
 * from its prior again. */
static void follow(goe_filter_t *filter, const fit_t *fit) {
    goe_mover_t *m = &filter->mover;
    goe_triangle_t *root = &filter->root;
    m->moves = true;
    m->followed = true;
    m->late = false;
    m->augmented[GOE_AUGMENTED_LATENCY] = 0.0f;
    m->augmented[GOE_AUGMENTED_VELOCITY_X] = fit->velocity_m_s.x;
    m->augmented[GOE_AUGMENTED_VELOCITY_Z] = fit->velocity_m_s.z;
    forget_augmented(root);
    *augmented_at(root, GOE_AUGMENTED_LATENCY, GOE_AUGMENTED_LATENCY) = 1.0f / LATENCY_PRIOR_S;
    *augmented_at(root, GOE_AUGMENTED_VELOCITY_X, GOE_AUGMENTED_VELOCITY_X) = root_of(fit->spread[0]);
    *augmented_at(root, GOE_AUGMENTED_VELOCITY_Z, GOE_AUGMENTED_VELOCITY_Z) = root_of(fit->spread[2]);
    root->estimated = GOE_AUGMENTED;
}

/* Decides whether the poses are late. If they are, the latency is estimated with the state from then on. */
static void judge_latency(goe_filter_t *filter, const fit_t *fit) {
    const float least = LATE_SIGMAS * LATE_SIGMAS * fit->wider;
    const bool late = goe_absolute(fit->latency_s) > LATE_MIN_S && fit->by_latency > least;
    if (filter->root.estimated == 0 && late && fit->rest_velocity > LATE_SHARE * fit->rest_latency) {
        filter->root.estimated = 1;
    }
    filter->mover.late = late && filter->root.estimated > 0;
}

/* Late poses in a turn look like a motion at first; later, motion and latency separate. */
static void judge_followed(goe_filter_t *filter) {
    goe_mover_t *m = &filter->mover;
    const goe_xz_t v = {m->augmented[GOE_AUGMENTED_VELOCITY_X], m->augmented[GOE_AUGMENTED_VELOCITY_Z]};
    const float late = goe_absolute(m->augmented[GOE_AUGMENTED_LATENCY]);
    const float squared = goe_xz_dot(v, v); /* |v|^2; spread is |v|^2 times the variance of v along itself */
    const float wider = goe_larger(filter->health.mean_nis, 1.0f);
    const float spread = wider * goe_mover_variance(filter, v);
    m->late = late > LATE_MIN_S && late > LATE_SIGMAS * goe_mover_latency_sd(filter);
    m->moves = !m->late || (squared > MOVES_MIN_M_S * MOVES_MIN_M_S && squared * squared > MOVING_SIGMAS2 * spread);
}

static bool is_sound(const goe_filter_t *filter) {
    const float *corner = &filter->root.element[goe_srif_augmented_row()];
    uint32_t largest = 0;
    for (size_t i = 0; i < GOE_AUGMENTED; i++) {
        largest = goe_larger_bits(largest, goe_magnitude(filter->mover.augmented[i]));
        largest = goe_larger_bits(largest, goe_magnitude(filter->root.right[i]));
    }
    for (size_t i = 0; i < GOE_AUGMENTED * (GOE_AUGMENTED + 1) / 2; i++) {
        largest = goe_larger_bits(largest, goe_magnitude(corner[i]));
    }
    return largest <= goe_magnitude(AUGMENTED_MAX);
}

bool goe_mover_judge(goe_filter_t *filter, const goe_observation_t *obs, const float change[GOE_UNKNOWNS],
                     float since_s) {
    goe_mover_t *m = &filter->mover;
    fit_t fit;
    for (size_t i = 0; i < GOE_AUGMENTED; i++) {
        m->augmented[i] += change[GOE_STATES + i];
    }
    if (!is_sound(filter)) {
        const bool followed = m->followed; /* the axes become static again */
        const bool moves = m->moves;
        goe_mover_clear(filter);
        m->moves = moves;
        return followed;
    }
    since_s = since_s < SINCE_MAX_S ? since_s : SINCE_MAX_S;
    m->observed_s += since_s;
    m->nis += filter->health.nis / goe_gate_repeated(filter, obs->settings->detector.point_correlation);
    m->rows += (float)filter->health.nis_rows;
    if (m->followed) {
        judge_followed(filter);
        return false;
    }
    if (!fit_augmented(filter, obs, &fit)) {
        return false;
    }
    judge_latency(filter, &fit);
    const bool outgrown = obs->grown2 > GOE_GROWN_SIGMAS2;
    const bool seen = is_moving(filter, &fit, outgrown, since_s);
    if (!seen || !has_scale(obs)) { /* an outline of another shape also seems to move, but fits */
        const bool misfit = outgrown || filter->health.mean_nis > obs->settings->filter.nis_ratio_max;
        m->moves = m->moves || (seen && misfit);
        return false;
    }
    if (outgrown || goe_xz_dot(fit.velocity_m_s, fit.velocity_m_s) > goe_square(SPEED_MAX_M_S)) {
        fit.velocity_m_s.x = 0.0f;
        fit.velocity_m_s.z = 0.0f;
        fit.spread[0] = goe_square(SPEED_SD_M_S);
        fit.spread[2] = goe_square(SPEED_SD_M_S);
    }
    follow(filter, &fit);
    return true;
}

#endif
