/* One image in the state's axes: projection under a small attitude bias, noise of the points, and rows. SPDX-License-Identifier: MIT */
#include "refined/goe_observation.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define ABEAM 0.02f           /* least third component of an aligned point's ray after the turn */
#define WHITE_MIN_DEG 1.0e-4f /* least errors of an image, as for the settings */
#define PIXEL_MIN_PX 0.05f
#define HEIGHT_SD_MIN_M 1.0e-3f
#define EXCESS_WEIGHT                                                                                                  \
    4.0f /* weight of the altimeter's scatter beyond the configured one: terrain, which is no noise, and one-sided */
#define SCATTER_CHANCE                                                                                                 \
    1.4f /* factor on the configured scatter that it reaches by chance: two sigma of a mean square of 64 readings */
#define WIDTH_AHEAD_MIN 0.01f /* least Z of the reference point for a width, in units of Z0 */
#define HEADING_ARM 0.08f     /* s/m: a yaw bias of this size per m/s looks like a velocity bias */
#define BEARING_FREEDOM 1.0f  /* prior sigma of X0/Z0 */
#define RANGE_FREEDOM 4.0f    /* relative prior sigma of 1/Z0 */
#define TOP_FREEDOM 10.0f     /* prior sigma of the top, over the larger of top and width */
#define WIDTH_MIN 1.0e-5f     /* least width between two ends, focal lengths */
#define SURE_SIGMAS                                                                                                    \
    3.0f            /* sigmas of position_white_sd_m up to which a way, or a distance off the path, counts as noise */
#define SHARED 2.0f /* rows that share an error of the camera's place along Z: opposite sides */
#define FORWARD_MIN 1.0e-4f /* least distance ahead of a predicted point, in units of Z0 */

static const goe_kind_t UNKNOWN; /* replaces a class that proved wrong */

/* Left must be left of right, or neither is usable. The place of base_near between them is not checked here: the gate judges it. */
static bool in_order(goe_point_t *left, goe_point_t *right) {
    if (left->usable && right->usable && !(left->x < right->x)) {
        left->usable = false;
        right->usable = false;
        return false;
    }
    return true;
}

/*@ requires \valid(obs); */
static unsigned put_in_order(goe_observation_t *obs) {
    goe_point_t *p = obs->point;
    const bool silhouette = in_order(&p[GOE_POINT_LEFT], &p[GOE_POINT_RIGHT]);
    const bool base = in_order(&p[GOE_POINT_BASE_LEFT], &p[GOE_POINT_BASE_RIGHT]);
    const bool left = p[GOE_POINT_BASE_LEFT].usable;
    const bool right = p[GOE_POINT_BASE_RIGHT].usable;
    obs->base = left && right;
    obs->edge = obs->base || (p[GOE_POINT_BASE_NEAR].usable && (left || right));
    return (silhouette ? 0u : 1u) + (base ? 0u : 1u);
}

/* Turns the view's points about the vertical. Base corners that proved to belong to something else are left out. */
/*@ requires \valid(obs) && \valid_read(filter) && goe_view_is_open(view); */
static void turn_points(goe_observation_t *obs, const goe_filter_t *filter, const goe_view_t *view) {
    const float c = filter->axes.turn_cos;
    const float s = filter->axes.turn_sin;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        goe_point_t *p = &obs->point[i];
        *p = view->point[i];
        const float forward = p->usable ? s * p->x + c : 0.0f;
        p->usable = forward > ABEAM && !(i >= GOE_POINT_BASE_LEFT && filter->health.base_refused);
        if (p->usable) {
            p->x = (c * p->x - s) / forward;
            p->y = p->y / forward;
        }
    }
}

static void turn_rotation(const float from[9], float c, float s, float to[9]) {
    for (size_t j = 0; j < 3; j++) {
        to[j] = c * from[j] - s * from[6 + j];
        to[3 + j] = from[3 + j];
        to[6 + j] = s * from[j] + c * from[6 + j];
    }
}

/* body -> axes = (camera -> axes)(camera -> body)' */
/*@ requires \valid(obs) && \valid_read(camera_to_body + (0 .. 8)); */
static void find_body(goe_observation_t *obs, const float camera_to_body[9]) {
    const float *t = obs->camera_to_axes;
    for (size_t j = 0; j < 3; j++) {
        const float *b = &camera_to_body[3 * j];
        for (size_t i = 0; i < 3; i++) {
            obs->body_to_axes[3 * i + j] = t[3 * i] * b[0] + t[3 * i + 1] * b[1] + t[3 * i + 2] * b[2];
        }
    }
}

static float given_or(float given, float least, float setting) {
    return given > 0.0f ? goe_larger(given, least) : setting;
}

/*@ requires \valid(obs) && \valid_read(obs->settings) && \valid_read(filter) && \valid_read(noise); */
static void take_noise(goe_observation_t *obs, const goe_filter_t *filter, const goe_image_noise_t *noise) {
    const goe_settings_t *settings = obs->settings;
    const goe_navigation_t *navigation = &settings->navigation;
    const goe_datum_t *datum = &filter->datum;
    obs->white_rad =
        given_or(noise->attitude_sd_deg, WHITE_MIN_DEG, navigation->attitude_white_sd_deg) * GOE_RAD_PER_DEG;
    obs->point_px = given_or(noise->pixel_sd_px, PIXEL_MIN_PX, settings->detector.point_noise_px);
    obs->side_px = given_or(noise->pixel_sd_px, PIXEL_MIN_PX, settings->detector.box_noise_px);
    const float excess = datum->scatter_m2 - SCATTER_CHANCE * goe_square(navigation->height_white_sd_m);
    const float bias_m = given_or(datum->sd_m, HEIGHT_SD_MIN_M, navigation->height_bias_sd_m);
    obs->height_sd_m = sqrtf(goe_square(bias_m) + goe_square(navigation->terrain_height_sd_m) + datum->noise_m2 +
                             EXCESS_WEIGHT * goe_larger(excess, 0.0f));
}

/* A way as far as noise does not explain it (James and Stein 1961): most of a long one, nothing of one within the noise. */
static float sure_way(float way_m, float noise2_m2) {
    const float way2 = goe_square(way_m);
    return way2 > noise2_m2 ? way_m * (1.0f - noise2_m2 / way2) : 0.0f;
}

#if GOE_AUGMENTED
static void turn_rate(const goe_filter_t *filter, const float rate[3], float turned[3]) {
    const goe_xz_t level = {rate[0], rate[2]};
    const goe_xz_t into = goe_xz_into(level, filter->axes.turn_cos, filter->axes.turn_sin);
    turned[0] = into.x;
    turned[1] = rate[1];
    turned[2] = into.z;
}

/* off_m: the place off the path, the state's axes. */
/*@ requires \valid(obs) && \valid_read(filter) && goe_view_is_open(view); */
static void note_pace(goe_observation_t *obs, const goe_filter_t *filter, const goe_view_t *view, goe_xz_t off_m) {
    obs->gained_m_s = goe_filter_gained(filter, view->motion);
    obs->gained_m_s.x -= view->gain_1_s * off_m.x; /* by this image, whose error the residual contains */
    obs->gained_m_s.z -= view->gain_1_s * off_m.z;
    obs->latency_s = filter->mover.augmented[GOE_AUGMENTED_LATENCY];
    turn_rate(filter, view->motion->rate_rad_s, obs->rate_rad_s);
    turn_rate(filter, view->motion->rate_before_rad_s, obs->rate_before_rad_s);
}

/* The part of a distance off the path that noise explains: the path lags in a turn, and does not exist if the places are not those of a
 * flight. */
static float noise_of(float off_m, float most_m) {
    const float less_m = goe_within(off_m, most_m) ? off_m : most_m; /* also if it is not finite */
    return off_m < -most_m ? -most_m : less_m;
}

/* Moves the camera to the smoothed path, once the filter runs, as far as the places are noisy. off_m: as above. */
/*@ requires \valid(obs) && \valid_read(obs->settings) && \valid_read(obs->state + (0 .. GOE_STATES - 1));
    requires \valid_read(filter) && goe_view_is_open(view); */
static void take_path(goe_observation_t *obs, const goe_filter_t *filter, const goe_view_t *view, goe_xz_t off_m) {
    const float white_m = goe_filter_has_started(filter) ? obs->settings->navigation.position_white_sd_m : 0.0f;
    const float most_m = SURE_SIGMAS * white_m;
    const float q = white_m > 0.0f ? obs->state[GOE_INVERSE_RANGE] : 0.0f;
    const float down_m = noise_of(view->off_m[2], most_m);
    off_m.x = noise_of(off_m.x, most_m);
    off_m.z = noise_of(off_m.z, most_m);
    obs->camera_m.x -= off_m.x;
    obs->camera_m.z -= off_m.z;
    obs->height_m += down_m;
    /* exact for a point at this Z: (X - x)/(Z - z) is X/Z minus (x - z X/Z)/(Z - z) */
    const float ahead = goe_observation_ahead(obs);
    const float share = ahead / goe_larger(ahead - q * off_m.z, GOE_AHEAD_MIN) * q;
    obs->off.x = share * off_m.x;
    obs->off.z = share * off_m.z;
    obs->off_y = share * down_m;
}
#endif

/* Sets the ways that noise does not explain. */
/*@ requires \valid(obs) && \valid_read(obs->settings) && \valid_read(filter); */
static void note_sure(goe_observation_t *obs, const goe_filter_t *filter) {
    const float noise2 = goe_square(SURE_SIGMAS * obs->settings->navigation.position_white_sd_m);
    const float start_m = filter->datum.start_m;
    obs->sure_m.x = sure_way(obs->camera_m.x, noise2);
    obs->sure_m.z = sure_way(obs->camera_m.z, noise2);
    obs->sure_height_m = start_m + sure_way(obs->height_m - start_m, noise2);
}

/* A class knows better than a setting. */
static bool starts_round(goe_model_t asked, const goe_kind_t *kind) {
    return kind->shape != GOE_KIND_UNKNOWN ? kind->shape == GOE_KIND_ROUND : asked == GOE_MODEL_DISC;
}

unsigned goe_observation_open(goe_observation_t *obs, const goe_settings_t *settings, const goe_filter_t *filter,
                              const goe_view_t *view) {
    obs->settings = settings;
    obs->camera = view->camera;
    obs->number = view->image->camera;
    obs->passed = filter->kind.passed;
    obs->state = filter->state;
    turn_points(obs, filter, view);
    turn_rotation(view->camera_to_trajectory, filter->axes.turn_cos, filter->axes.turn_sin, obs->camera_to_axes);
    find_body(obs, view->camera_to_body);
    obs->camera_m = goe_filter_camera(filter, view->motion);
    obs->sides = &view->sides;
    obs->kind = filter->kind.wrong ? &UNKNOWN : &view->image->kind;
    obs->is_round = goe_filter_has_started(filter) ? filter->kind.is_round : starts_round(settings->model, obs->kind);
    obs->height_m = filter->datum.height_m;
#if GOE_AUGMENTED
    const goe_xz_t level = {view->off_m[0], view->off_m[1]};
    const goe_xz_t off_m = goe_xz_into(level, filter->axes.turn_cos, filter->axes.turn_sin);
    take_path(obs, filter, view, off_m);
    note_pace(obs, filter, view, off_m);
#else
    obs->off.x = obs->off.z = obs->off_y = 0.0f;
#endif
    note_sure(obs, filter);
    obs->is_placed = (filter->known & GOE_HAS_POSITION) != 0u;
    obs->fade = 0.0f;
    obs->shift = 0.0f;
    take_noise(obs, filter, &view->image->noise);
    obs->outline_share = settings->detector.point_noise_rel;
    obs->depth_variance = 0.0f;
    obs->two_faces = false;
    obs->elapsed_s = goe_filter_elapsed_s(filter, view->motion);
    return put_in_order(obs);
}

void goe_observation_linearise(goe_observation_t *obs) {
    const float *m = obs->body_to_axes;
    const float *b = &obs->state[GOE_BIAS_X];
    obs->ex = m[0] * b[0] + m[1] * b[1] + m[2] * b[2];
    obs->ey = m[3] * b[0] + m[4] * b[1] + m[5] * b[2];
    obs->ez = m[6] * b[0] + m[7] * b[1] + m[8] * b[2];
#if GOE_AUGMENTED
    obs->ex -= obs->latency_s * obs->rate_rad_s[0];
    obs->ey -= obs->latency_s * obs->rate_rad_s[1];
    obs->ez -= obs->latency_s * obs->rate_rad_s[2];
#endif
}

bool goe_observation_ends(const goe_point_t point[GOE_FEATURES], goe_feature_t *left, goe_feature_t *right) {
    const bool base = !(point[GOE_POINT_LEFT].usable && point[GOE_POINT_RIGHT].usable) &&
                      point[GOE_POINT_BASE_LEFT].usable && point[GOE_POINT_BASE_RIGHT].usable;
    *left = base ? GOE_POINT_BASE_LEFT : GOE_POINT_LEFT;
    *right = base ? GOE_POINT_BASE_RIGHT : GOE_POINT_RIGHT;
    const goe_point_t *p = point;
    return p[*left].usable && p[*right].usable && p[*right].x - p[*left].x >= WIDTH_MIN;
}

/* 1/Z of the point in the axes by the supplied attitude. */
static float nearness(const goe_observation_t *obs, float x, float y, float z) {
    const float turned_z = z + obs->ex * y - obs->ey * x;
    return 1.0f / (turned_z < FORWARD_MIN ? FORWARD_MIN : turned_z);
}

void goe_observation_project_x(const goe_observation_t *obs, float x, float y, float z, goe_gradient_t *of_x) {
    const float reciprocal = nearness(obs, x, y, z);
    const float image_x = (x + obs->ey * z - obs->ez * y) * reciprocal;
    of_x->at = image_x;
    of_x->x = (1.0f + image_x * obs->ey) * reciprocal;
    of_x->y = (-obs->ez - image_x * obs->ex) * reciprocal;
    of_x->z = (obs->ey - image_x) * reciprocal;
    of_x->ey = (z + image_x * x) * reciprocal;
    of_x->ex = -(image_x * y) * reciprocal;
    of_x->ez = -y * reciprocal;
}

void goe_observation_project_y(const goe_observation_t *obs, float x, float y, float z, goe_gradient_t *of_y) {
    const float reciprocal = nearness(obs, x, y, z);
    const float image_y = (y + obs->ez * x - obs->ex * z) * reciprocal;
    of_y->at = image_y;
    of_y->x = (obs->ez + image_y * obs->ey) * reciprocal;
    of_y->y = (1.0f - image_y * obs->ex) * reciprocal;
    of_y->z = (-obs->ex - image_y) * reciprocal;
    of_y->ey = (image_y * x) * reciprocal;
    of_y->ex = (-z - image_y * y) * reciprocal;
    of_y->ez = x * reciprocal;
}

goe_point_t goe_observation_unbiased(const goe_observation_t *obs, goe_feature_t feature) {
    const goe_point_t *p = &obs->point[feature];
    goe_point_t q = *p;
    q.x = p->x - obs->ey * (1.0f + p->x * p->x) + obs->ez * p->y + obs->ex * p->x * p->y;
    q.y = p->y + obs->ex * (1.0f + p->y * p->y) - obs->ez * p->x - obs->ey * p->x * p->y;
    return q;
}

/* Derivative of the aligned point n1/n3, n2/n3, n = H (u, v, 1), by the pixel; 1/n3 is the third component of H'(x, y, 1). The lens is
 * neglected: the scale is good to a few percent. */
goe_spread_t goe_observation_spread(const goe_observation_t *obs, goe_feature_t feature) {
    const float *h = obs->camera_to_axes;
    const goe_point_t *p = &obs->point[feature];
    const float scale = (h[2] * p->x + h[5] * p->y + h[8]) * obs->point_px;
    const float u = scale / obs->camera->fx_px;
    const float v = scale / obs->camera->fy_px;
    const float xu = (h[0] - p->x * h[6]) * u;
    const float xv = (h[1] - p->x * h[7]) * v;
    const float yu = (h[3] - p->y * h[6]) * u;
    const float yv = (h[4] - p->y * h[7]) * v;
    const goe_spread_t spread = {xu * xu + xv * xv, xu * yu + xv * yv, yu * yu + yv * yv};
    return spread;
}

float goe_observation_size_variance(const goe_observation_t *obs) {
    const goe_point_t *left = &obs->point[GOE_POINT_LEFT];
    const goe_point_t *right = &obs->point[GOE_POINT_RIGHT];
    const bool seen = left->usable && right->usable;
    const float width = seen ? right->x - left->x
                             : (obs->state[GOE_FRONT_X] + goe_absolute(obs->state[GOE_SIDE_X])) /
                                   goe_larger(goe_observation_reference(obs).z, WIDTH_AHEAD_MIN);
    return goe_square(obs->outline_share * width);
}

void goe_observation_prior(const goe_observation_t *obs, const float state[GOE_STATES], float size,
                           float sd[GOE_STATES]) {
    const goe_navigation_t *navigation = &obs->settings->navigation;
    const float bias = navigation->attitude_bias_sd_deg * GOE_RAD_PER_DEG;
    sd[GOE_BIAS_X] = bias;
    sd[GOE_BIAS_Y] = bias;
    sd[GOE_BIAS_Z] = sqrtf(goe_square(bias) + goe_square(HEADING_ARM * navigation->velocity_bias_sd_m_s));
    sd[GOE_BEARING] = BEARING_FREEDOM;
    sd[GOE_INVERSE_RANGE] = RANGE_FREEDOM * state[GOE_INVERSE_RANGE];
    sd[GOE_TOP] = TOP_FREEDOM * goe_larger(goe_absolute(state[GOE_TOP]), size);
}

/* ------------------------------------------------------------------------------------------------------------ rows -- */

void goe_rows_clear(goe_rows_t *rows, goe_matrix_t *matrix) {
    rows->matrix = matrix;
    rows->remembered = 0;
    rows->count = 0;
}

void goe_rows_move(float *by, const goe_observation_t *obs, float by_x, float by_y, float by_z) {
    by[GOE_BEARING] = by_x;
    by[GOE_INVERSE_RANGE] = by_y * obs->sure_height_m - by_x * obs->sure_m.x - by_z * obs->sure_m.z;
#if GOE_AUGMENTED
    by[GOE_STATES + GOE_AUGMENTED_VELOCITY_X] = by_x; /* until goe_mover_columns() */
    by[GOE_STATES + GOE_AUGMENTED_VELOCITY_Z] = by_z;
#endif
}

float *goe_rows_add(goe_rows_t *rows, const goe_observation_t *obs, goe_feature_t feature, goe_axis_t axis,
                    float measured, float variance, const goe_gradient_t *gradient) {
    const size_t at = rows->count++;
    float *row = rows->matrix->row[at];
    float *by = &row[GOE_STATE_COLUMN];
    rows->variance[at] = variance + SHARED * goe_square(obs->shift * gradient->z);
    rows->feature[at] = (uint8_t)feature;
    rows->axis[at] = (uint8_t)axis;
    rows->series[at] = (uint8_t)(2u * (unsigned)feature);
    row[0] = gradient->ey;
    row[1] = gradient->ex;
    row[2] = gradient->ez;
    goe_srif_zero(by, GOE_GROUND);
    goe_rows_move(by, obs, gradient->x, gradient->y, gradient->z);
    by[GOE_BEHIND_STATES] =
        measured - gradient->at + (gradient->x * obs->off.x + gradient->y * obs->off_y + gradient->z * obs->off.z);
    return by;
}

/* Adds the derivatives of x by the bias through the Y/Z at which the edge was measured. */
static void add_height_of_edge(const goe_point_t *p, float z, goe_gradient_t *of_x) {
    const float by_height = of_x->y * z;
    of_x->ex += by_height * (1.0f + p->y * p->y);
    of_x->ez -= by_height * p->x;
    of_x->ey -= by_height * p->x * p->y;
}

float *goe_rows_add_edge(goe_rows_t *rows, const goe_observation_t *obs, goe_xz_t place, goe_feature_t feature,
                         float more, goe_gradient_t *of_x) {
    const goe_point_t *measured = &obs->point[feature];
    if (!measured->usable) {
        return NULL;
    }
    const float y = goe_observation_unbiased(obs, feature).y;
    goe_observation_project_x(obs, place.x, y * place.z, place.z, of_x);
    of_x->z += of_x->y * y; /* the height moves with the distance */
    add_height_of_edge(measured, place.z, of_x);
    of_x->y = 0.0f;
    return goe_rows_add(rows, obs, feature, GOE_ALONG_X, measured->x, goe_observation_spread(obs, feature).xx + more,
                        of_x);
}

float *goe_rows_add_level(goe_rows_t *rows, const goe_observation_t *obs, goe_xz_t place, float y,
                          goe_feature_t feature, float more, goe_gradient_t *of_y) {
    const goe_point_t *measured = &obs->point[feature];
    if (!measured->usable) {
        return NULL;
    }
    goe_observation_project_y(obs, place.x, y, place.z, of_y);
    return goe_rows_add(rows, obs, feature, GOE_ALONG_Y, measured->y, goe_observation_spread(obs, feature).yy + more,
                        of_y);
}

GOE_STATIC_ASSERT(GOE_NUISANCES == 3, the_nuisances_are_the_attitude_about_y_x_z);

/*@ requires \valid(row + (0 .. GOE_COLUMNS - 1)) && \valid_read(body_to_axes + (0 .. 8)); */
static void turn_attitude(float *row, const float body_to_axes[9]) {
    const float *m = body_to_axes;
    const float ey = row[0];
    const float ex = row[1];
    const float ez = row[2];
    for (size_t j = 0; j < 3; j++) {
        row[GOE_STATE_COLUMN + GOE_BIAS_X + j] = ex * m[j] + ey * m[3 + j] + ez * m[6 + j];
    }
}

void goe_rows_end(goe_rows_t *rows, const goe_observation_t *obs) {
    for (size_t i = 0; i < rows->count; i++) {
        turn_attitude(rows->matrix->row[i], obs->body_to_axes);
    }
    for (size_t i = rows->count; i < GOE_ROWS_MAX; i++) {
        memset(rows->matrix->row[i], 0, sizeof rows->matrix->row[i]);
    }
}

#endif
