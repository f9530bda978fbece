/* The start of a box from base corners: its first shape, the images that must agree on it, and its state. SPDX-License-Identifier: MIT */
#include "refined/goe_box_start.h"

#include <math.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_box.h"

#if GOE_WITH_FILTER

#define BEARING_GROWTH 4.0f    /* factor on the variance of the bearing: the footprint's middle was another point */
#define BEARING_FREEDOM 4.0f   /* sigma added to it, over the larger side */
#define BEARING_FLOOR2 1.0e-6f /* constant variance added to it */
#define RANGE_GROWTH 2.0f      /* factor on the variance of 1/Z0 */
#define RANGE_MIN_M 1.0f
#define HEIGHT_MIN_M 0.3f /* camera above ground: from lower, the corners' y give no range */
#define NEARER_MAX 1.7f   /* largest 1/range of a corner over the state's 1/range */
#define FARTHER_MAX 0.6f
#define POINT_NOISE 1.5f  /* one sigma of a difference of two points, in sigmas of a pixel */
#define SURE_SIGMAS2 4.0f /* a difference in depth counts only by its part beyond 2 sigma, or chance would pass */
#define EDGE_MIN_M2 1.0e-6f
#define SIGMA_MAX_RAD 0.2f
#define SIZE_SHARE_MAX 0.4f /* largest size of a box, over the range */
#define SIZE_MIN_M 0.05f
#define QUARTER_TURN_RAD 1.57079633f
#define ONE_FACE_IMAGES 3   /* images that must agree before a box starts from one face */
#define TWO_FACES_IMAGES 2  /* the same from two faces */
#define AGREEING_PX 7.0f    /* sigmas of a pixel by which the extents of two images may differ */
#define AGREEING_SHARE 0.1f /* plus this share of both extents */
#define RANGE_SHARE 0.1f    /* largest relative sigma of the range for two faces */
#define AGREEING_SIGMAS2 9.0f
#define SIZE_FREEDOM 2.0f  /* one sigma of the extents at the start, over the larger side */
#define DEPTH_FREEDOM 4.0f /* the same of the depth difference */
#define DEPTH_HELD 0.01f   /* the same if one face alone is visible */
#define FACE_MIN_PX 3.0f   /* least lateral extent of a face, in sigmas of a pixel */

/* Sets position and sizes. reference: middle of the front edge from the camera, in axes turned by box->turn_cos, turn_sin. False if out of
 * bounds. */
static bool scale(const goe_observation_t *obs, goe_xz_t reference, float width_m, float length_m, float range_m,
                  goe_first_box_t *box) {
    const float c = box->turn_cos;
    const float s = box->turn_sin;
    const float z0_m = reference.z + s * obs->camera_m.x + c * obs->camera_m.z;
    if (!(z0_m >= RANGE_MIN_M) || goe_larger(width_m, length_m) > SIZE_SHARE_MAX * range_m) {
        return false;
    }
    box->q = 1.0f / z0_m;
    box->a = (reference.x + c * obs->camera_m.x - s * obs->camera_m.z) * box->q;
    box->width = goe_larger(width_m, SIZE_MIN_M) * box->q;
    box->length = goe_larger(length_m, SIZE_MIN_M) * box->q;
    return true;
}

static float range_of(const goe_observation_t *obs) { return 1.0f / obs->state[GOE_INVERSE_RANGE] - obs->camera_m.z; }

/* ----------------------------------------------------------------------------------------------------------- two faces -- */

bool goe_box_of_two_faces(const goe_observation_t *obs, goe_first_box_t *box) {
    const float range_m = range_of(obs);
    if (!obs->base || !obs->point[GOE_POINT_BASE_NEAR].usable || !(range_m >= RANGE_MIN_M)) {
        return false;
    }
    const float corner = goe_observation_unbiased(obs, GOE_POINT_BASE_NEAR).x;
    const float c = 1.0f / sqrtf(1.0f + corner * corner);
    box->left = corner - goe_observation_unbiased(obs, GOE_POINT_BASE_LEFT).x;
    box->right = goe_observation_unbiased(obs, GOE_POINT_BASE_RIGHT).x - corner;
    const float left_m = box->left * range_m * c;
    const float right_m = box->right * range_m * c;
    const float least_m = left_m < right_m ? left_m : right_m;
    if (!(least_m > FACE_MIN_PX * goe_observation_pixel(obs) * range_m)) {
        return false;
    }
    /* side (right_m, deep_m) and front (left_m, -deep_m) are perpendicular; or they exchange their names */
    const float deep_m = sqrtf(left_m * right_m);
    const float on_left_m = sqrtf(left_m * left_m + deep_m * deep_m);
    const float on_right_m = sqrtf(right_m * right_m + deep_m * deep_m);
    const bool exchange = right_m > deep_m;
    const goe_xz_t reference = {exchange ? 0.5f * right_m : -0.5f * left_m, range_m / c + 0.5f * deep_m};
    box->turn_cos = c;
    box->turn_sin = corner * c;
    box->sine = exchange ? -left_m / on_left_m : right_m / on_right_m;
    box->cosine = exchange ? deep_m / on_left_m : deep_m / on_right_m;
    return scale(obs, reference, exchange ? on_right_m : on_left_m, exchange ? on_left_m : on_right_m, range_m, box);
}

/* ------------------------------------------------------------------------------------------------------------ one face -- */

typedef struct {
    goe_xz_t left, right;
    float range_m, height_m;
} face_t;

/* (R18): places an end of the face by its y. False if its range is impossible. */
static bool place_end(const goe_point_t *point, float mean_y, const face_t *face, goe_xz_t *end) {
    const float nearness = 1.0f / face->range_m;
    const float inverse = nearness + (point->y - mean_y) / face->height_m;
    if (!(inverse >= FARTHER_MAX * nearness && inverse <= NEARER_MAX * nearness)) {
        return false;
    }
    end->z = 1.0f / inverse;
    end->x = point->x * end->z;
    return true;
}

static bool place_face(const goe_observation_t *obs, face_t *face) {
    const goe_point_t left = goe_observation_unbiased(obs, GOE_POINT_BASE_LEFT);
    const goe_point_t right = goe_observation_unbiased(obs, GOE_POINT_BASE_RIGHT);
    const float mean_y = 0.5f * (left.y + right.y);
    return place_end(&left, mean_y, face, &face->left) && place_end(&right, mean_y, face, &face->right);
}

/* One sigma of the orientation that the edge (x, z) gives, rad. */
static float edge_sigma(const goe_observation_t *obs, const face_t *face, float x, float z) {
    const float pixel = goe_observation_pixel(obs) * POINT_NOISE;
    const float deep = face->range_m * face->range_m / face->height_m * pixel;
    const float wide = face->range_m * pixel;
    const float tilt =
        face->range_m / face->height_m * (obs->settings->navigation.attitude_bias_sd_deg * GOE_RAD_PER_DEG) * x * x;
    const float noise = sqrtf(deep * x * (deep * x) + wide * z * (wide * z) + tilt * tilt);
    const float sure = z * z - SURE_SIGMAS2 * deep * deep;
    return noise / goe_larger(x * x + goe_larger(sure, 0.0f), EDGE_MIN_M2);
}

/* An edge more along X than along Z is the front, any other the side. Returns the middle of the front. */
static goe_xz_t measure_face(const face_t *face, float x, float z, float size_m, goe_first_box_t *box) {
    const bool front = goe_absolute(x) > goe_absolute(z);
    const float across = front ? -z : x;
    const float along = front ? x : z;
    const float sign = along < 0.0f ? -1.0f : 1.0f;
    box->sine = sign * across / size_m;
    box->cosine = sign * along / size_m;
    box->orientation_rad = goe_arctan_rad(sign * across, sign * along);
    if (front) {
        const goe_xz_t middle = {0.5f * (face->left.x + face->right.x), 0.5f * (face->left.z + face->right.z)};
        return middle;
    }
    /* the near end of the side is a corner of the front: the right one if the side is visible to the right of it */
    const bool left_is_near = face->left.z < face->right.z;
    const goe_xz_t corner = left_is_near ? face->left : face->right;
    const float half_m = left_is_near ? 0.5f * size_m : -0.5f * size_m;
    const goe_xz_t middle = {corner.x - half_m * box->cosine, corner.z + half_m * box->sine};
    return middle;
}

/* Angle from the ends of the face to the foot of the camera's perpendicular, rad; negative between the ends. */
static float beyond(const face_t *face, float x, float z, float size_m) {
    const float mx = 0.5f * (face->left.x + face->right.x);
    const float mz = 0.5f * (face->left.z + face->right.z);
    const float along_m = goe_absolute(mx * x + mz * z) / size_m;
    return (along_m - 0.5f * size_m) / sqrtf(mx * mx + mz * mz);
}

bool goe_box_of_one_face(const goe_observation_t *obs, goe_first_box_t *box) {
    face_t face = {{0.0f, 0.0f}, {0.0f, 0.0f}, range_of(obs), 0.0f};
    face.height_m = obs->height_m + obs->state[GOE_GROUND] / obs->state[GOE_INVERSE_RANGE];
    if (!obs->base || !(face.range_m >= RANGE_MIN_M) || !(obs->height_m >= HEIGHT_MIN_M) ||
        !(face.height_m >= HEIGHT_MIN_M) || !place_face(obs, &face)) {
        return false;
    }
    const float x = face.right.x - face.left.x;
    const float z = face.right.z - face.left.z;
    box->turn_cos = 1.0f;
    box->turn_sin = 0.0f;
    box->sigma_rad = edge_sigma(obs, &face, x, z);
    if (!(x * x + z * z >= EDGE_MIN_M2) || !(box->sigma_rad < SIGMA_MAX_RAD)) {
        return false;
    }
    const float size_m = sqrtf(x * x + z * z);
    box->beyond_rad = beyond(&face, x, z, size_m);
    const goe_xz_t reference = measure_face(&face, x, z, size_m, box);
    return scale(obs, reference, size_m, size_m, face.range_m, box);
}

/* --------------------------------------------------------------------------------------------------------- agreement -- */

/* Difference of two orientations within a quarter turn of Z; one may have front and side exchanged. */
static float difference_rad(float a, float b) {
    const float d = a - b;
    if (d > 0.5f * QUARTER_TURN_RAD) {
        return d - QUARTER_TURN_RAD;
    }
    return d < -0.5f * QUARTER_TURN_RAD ? d + QUARTER_TURN_RAD : d;
}

/* Whether enough images in a row show the same orientation. One alone may do so by chance. */
static bool one_face_agrees(goe_filter_t *filter, const goe_first_box_t *box) {
    const float d = difference_rad(box->orientation_rad, filter->candidate.extent[0]);
    const bool alone = box->beyond_rad < box->sigma_rad; /* otherwise a second face would be visible */
    const bool agrees =
        alone && filter->candidate.agreeing > 0 && goe_square(d) < AGREEING_SIGMAS2 * goe_square(box->sigma_rad);
    filter->candidate.agreeing = (uint8_t)(agrees ? filter->candidate.agreeing + 1 : (alone ? 1 : 0));
    filter->candidate.extent[0] = box->orientation_rad;
    return filter->candidate.agreeing >= ONE_FACE_IMAGES;
}

/* Variance of 1/Z0 without the part by the footprint's depth, which a box does not inherit. */
static float range_variance(const goe_filter_t *filter) {
    float range[GOE_STATES];
    return goe_filter_error(filter, GOE_INVERSE_RANGE, range) - goe_srif_last_variance(range);
}

/* Whether enough images in a row agree: an outlier must not start a box. Range and depth multiply in the image, so the range must be
 * known. */
static bool two_faces_agree(goe_filter_t *filter, const goe_observation_t *obs, const goe_first_box_t *box) {
    const float q = filter->state[GOE_INVERSE_RANGE];
    const float most = RANGE_SHARE * q * goe_observation_reference(obs).z;
    const float tolerance = AGREEING_PX * goe_observation_pixel(obs) + AGREEING_SHARE * (box->left + box->right);
    const bool agree = filter->candidate.agreeing > 0 &&
                       goe_absolute(box->left - filter->candidate.extent[0]) < tolerance &&
                       goe_absolute(box->right - filter->candidate.extent[1]) < tolerance;
    filter->candidate.agreeing = (uint8_t)(agree ? filter->candidate.agreeing + 1 : 1);
    filter->candidate.extent[0] = box->left;
    filter->candidate.extent[1] = box->right;
    if (range_variance(filter) > most * most) {
        filter->candidate.agreeing = 0;
    }
    return filter->candidate.agreeing >= TWO_FACES_IMAGES;
}

static bool find_box(goe_filter_t *filter, const goe_observation_t *obs, goe_first_box_t *box) {
    const bool both = obs->point[GOE_POINT_BASE_NEAR].usable;
    if (!both && filter->candidate.near_images > 0) {
        return false; /* the detector missed it: the outer corners are the ends of two faces */
    }
    if (both != filter->candidate.both) { /* the previous images show another number of faces */
        filter->candidate.both = both;
        filter->candidate.agreeing = 0;
    }
    if (!(both ? goe_box_of_two_faces(obs, box) : goe_box_of_one_face(obs, box))) {
        filter->candidate.agreeing = 0;
        return false;
    }
    return both ? two_faces_agree(filter, obs, box) : one_face_agrees(filter, box);
}

/* --------------------------------------------------------------------------------------------------------------- start -- */

/* Transforms GOE_BEARING and GOE_INVERSE_RANGE of a covariance into axes turned by the angle with cosine c and sine s: a' = (a c - s) m, q'
 * = q m, m = 1/(a s + c). */
static void turn_covariance(const float x[GOE_STATES], float c, float s, float covariance[GOE_KEPT][GOE_KEPT]) {
    const float m = 1.0f / (x[GOE_BEARING] * s + c);
    const float shear = x[GOE_INVERSE_RANGE] * s * m;
    for (size_t i = 0; i < GOE_BEARING; i++) {
        covariance[i][GOE_INVERSE_RANGE] = m * (covariance[i][GOE_INVERSE_RANGE] - shear * covariance[i][GOE_BEARING]);
        covariance[i][GOE_BEARING] *= m * m;
    }
    const float aa = covariance[GOE_BEARING][GOE_BEARING];
    const float aq = covariance[GOE_BEARING][GOE_INVERSE_RANGE] - shear * aa;
    const float qq =
        covariance[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] - shear * (covariance[GOE_BEARING][GOE_INVERSE_RANGE] + aq);
    covariance[GOE_BEARING][GOE_BEARING] = goe_square(m * m) * aa;
    covariance[GOE_BEARING][GOE_INVERSE_RANGE] = m * m * m * aq;
    covariance[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] = m * m * qq;
}

/* Rescales GOE_GROUND of a covariance to another Z0. */
static void scale_ground(float scale, float covariance[GOE_KEPT][GOE_KEPT]) {
    for (size_t i = 0; i < GOE_GROUND; i++) {
        covariance[i][GOE_GROUND] *= scale;
    }
    for (size_t i = GOE_GROUND; i < GOE_KEPT; i++) {
        covariance[GOE_GROUND][i] *= scale;
    }
    covariance[GOE_GROUND][GOE_GROUND] *= scale;
}

/* Changes a footprint into a box. The states that both have keep their covariance, increased for bearing and range: the reference point
 * moves by up to the box's size, and the footprint was only a substitute. both: two faces are visible. */
static void start_box(goe_filter_t *filter, const goe_observation_t *obs, const goe_first_box_t *box, bool both) {
    float c[GOE_KEPT][GOE_KEPT];
    float *x = filter->state;
    const float size = goe_larger(box->width, box->length);
    goe_observation_age(filter, obs);
    goe_srif_marginal(&filter->root, obs->settings->navigation.velocity_bias_sd_m_s, c);
    turn_covariance(x, box->turn_cos, box->turn_sin, c);
    c[GOE_BEARING][GOE_BEARING] =
        BEARING_GROWTH * c[GOE_BEARING][GOE_BEARING] + goe_square(BEARING_FREEDOM * size) + BEARING_FLOOR2;
    c[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] =
        RANGE_GROWTH * c[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] + goe_square(size * box->q);
    const float nearer = box->q / x[GOE_INVERSE_RANGE];
    x[GOE_TOP] *= nearer;
    x[GOE_GROUND] *= nearer;
    scale_ground(nearer, c);
    x[GOE_BEARING] = box->a;
    x[GOE_INVERSE_RANGE] = box->q;
    x[GOE_SIDE_X] = box->length * box->sine;
    x[GOE_FRONT_X] = box->width * box->cosine;
    x[GOE_DEPTH_DIFFERENCE] = box->length * box->cosine - box->width * goe_absolute(box->sine);
    const float sigma[GOE_STATES - GOE_KEPT] = {SIZE_FREEDOM * goe_larger(goe_absolute(x[GOE_TOP]), size),
                                                SIZE_FREEDOM * size, SIZE_FREEDOM * size,
                                                (both ? DEPTH_FREEDOM : DEPTH_HELD) * size};
    goe_srif_from_covariance(c, sigma, &filter->root);
    const goe_axes_t was = filter->axes;
    goe_filter_turn_axes(filter, was.turn_cos * box->turn_cos - was.turn_sin * box->turn_sin,
                         was.turn_sin * box->turn_cos + was.turn_cos * box->turn_sin);
    goe_box_enter(filter, both ? GOE_PHASE_BOX : GOE_PHASE_BOX_FACE);
}

bool goe_box_start(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_first_box_t box;
    if (!obs->base || obs->is_round || !find_box(filter, obs, &box)) {
        return false;
    }
    start_box(filter, obs, &box, obs->point[GOE_POINT_BASE_NEAR].usable);
    return true;
}

#endif
