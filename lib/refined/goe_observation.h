/* One image in the form that the filter uses, and its rows. SPDX-License-Identifier: MIT */
#ifndef GOE_OBSERVATION_H
#define GOE_OBSERVATION_H

#include "image/goe_view.h"
#include "maths/goe_scalar.h"
#include "refined/goe_filter.h"

typedef struct {
    const goe_settings_t *settings;
    const goe_camera_t *camera;
    const float *state;
    goe_point_t point[GOE_FEATURES]; /* aligned with the state's axes; usable: measured in this image */
    float camera_to_axes[9], body_to_axes[9];
    float ex, ey, ez;    /* attitude bias about the state's axes, rad */
    goe_xz_t camera_m;   /* camera on the smoothed path since the filter's start, the state's axes */
    goe_xz_t sure_m;     /* the same as far as noise does not explain it: see goe_rows_move() */
    float height_m;      /* camera above ground on the path, by the changes of down: see goe_datum_t */
    float sure_height_m; /* the same as far as noise does not explain its change since the filter's start */
    goe_xz_t off;        /* the given place minus that on the path, units of Z0 */
    float off_y;         /* the same along Y */
    const goe_sides_t *sides;
    const goe_kind_t *kind;
    float height_sd_m; /* one sigma of the height above the obstacle's ground, without the ground's slope */
    float since_s;     /* time since the previous image */
    float elapsed_s;   /* since the filter's start */
    float fade;        /* share of a box side's error that remains from the image used before */
    float white_rad; /* one sigma of the image's own attitude error, and of its position error, which looks the same */
    float point_px, side_px; /* one sigma of a point, and of a box's side, pixels */
    float outline_share;     /* one sigma of left, right and top beyond the pixel noise, over the width */
    float shift; /* one sigma of the image's own position error, units of Z0, with the uncertainty of the range */
    float range_variance; /* variance of GOE_INVERSE_RANGE */
    float depth_variance; /* box: variance of GOE_DEPTH_DIFFERENCE */
    float grown2;         /* (excess of width or height over the predicted one, in sigmas)^2 */
    bool two_faces;       /* box: both were visible, its length is estimated */
    bool is_placed;       /* the latest image knew the position */
    bool is_round;        /* round by its class, or by the settings */
    bool base;            /* both outer base corners are visible */
    bool edge;            /* an edge of the base is visible */
    uint8_t number;       /* number of the camera */
    uint8_t passed;       /* priors of the range that were too near */
#if GOE_AUGMENTED
    float rate_rad_s[3];        /* of the vehicle, the state's axes */
    float rate_before_rad_s[3]; /* the same shortly before, free of this image's own attitude error */
    goe_xz_t gained_m_s;        /* change of the velocity since the filter's start, the state's axes */
    float latency_s;            /* of the poses, as far as estimated */
#endif
} goe_observation_t;

/*@ predicate goe_observation_is_open(goe_observation_t *obs) =
        \valid_read(obs) && \valid_read(obs->settings) && \valid_read(obs->camera) && \valid_read(obs->sides) &&
        \valid_read(obs->state + (0 .. GOE_STATES - 1)); */

/* What a row measures: a coordinate of a point in the state's axes, or of a side in the raw image. */
typedef enum { GOE_ALONG_X, GOE_ALONG_Y } goe_axis_t;

/* The rows of an image. Until the gate weights it, each row contains the derivatives of a predicted image coordinate by the image's own
 * attitude error and by the states, and the residual; `variance` is that of its own noise. */
typedef struct {
    goe_matrix_t *matrix;
    float variance[GOE_ROWS_MAX];
    float weight[GOE_ROWS_MAX]; /* after the gate: the factor on the row; 0: refused */
    uint8_t feature[GOE_ROWS_MAX];
    uint8_t axis[GOE_ROWS_MAX];   /* goe_axis_t */
    uint8_t series[GOE_ROWS_MAX]; /* series of residuals, see goe_scatter_t */
    uint8_t side[GOE_ROWS_MAX];   /* memory of its error: goe_box_side_t, then left and right as points */
    size_t count;
    size_t remembered; /* the first rows, those whose errors are remembered */
    float white_rad;   /* one sigma of the nuisances */
} goe_rows_t;

/*@ predicate goe_rows_hold(goe_rows_t *rows) =
        \valid_read(rows) && \valid(rows->matrix) && rows->count <= GOE_ROWS_MAX; */

/* A predicted image coordinate, and its derivatives by the point (X, Y, Z) and by the attitude's error about the axes. */
typedef struct {
    float at;
    float x, y, z, ex, ey, ez;
} goe_gradient_t;

/* (R4): covariance of an aligned point by the pixel noise alone. */
typedef struct {
    float xx, xy, yy;
} goe_spread_t;

/* Turns the view into the state's axes. Pairs that are out of their order, left to right, are not usable; returns their number. After the
 * time update, goe_observation_linearise() sets the attitude bias from the state. */
/*@ requires \valid(obs) && \valid_read(settings) && \valid_read(filter) && goe_view_is_open(view); */
unsigned goe_observation_open(goe_observation_t *obs, const goe_settings_t *settings, const goe_filter_t *filter,
                              const goe_view_t *view);
void goe_observation_linearise(goe_observation_t *obs);

/* (R3): the image of the point (X, Y, Z), in units of Z0 or any other, along x, and along y. */
void goe_observation_project_x(const goe_observation_t *obs, float x, float y, float z, goe_gradient_t *of_x);
void goe_observation_project_y(const goe_observation_t *obs, float x, float y, float z, goe_gradient_t *of_y);

/* Prior sigmas of the states that do not depend on the model: attitude bias, bearing, range, and the top of an obstacle of that size. */
void goe_observation_prior(const goe_observation_t *obs, const float state[GOE_STATES], float size,
                           float sd[GOE_STATES]);

/* Adds the due process noise to the filter. Call before rows are used, and before the model changes. */
static inline void goe_observation_age(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_filter_age(filter, &obs->settings->navigation, obs->since_s);
}

/* One sigma of a pixel, focal lengths. */
static inline float goe_observation_pixel(const goe_observation_t *obs) { return obs->point_px / obs->camera->fx_px; }

/* (R1): the state's reference point relative to the camera now, units of Z0. */
static inline goe_xz_t goe_observation_reference(const goe_observation_t *obs) {
    const float q = obs->state[GOE_INVERSE_RANGE];
    const goe_xz_t reference = {obs->state[GOE_BEARING] - obs->camera_m.x * q, 1.0f - obs->camera_m.z * q};
    return reference;
}

/* Least Z of the reference point and of a touching point, units of Z0. */
#define GOE_AHEAD_MIN 0.02f

static inline float goe_observation_ahead(const goe_observation_t *obs) {
    return goe_larger(goe_observation_reference(obs).z, GOE_AHEAD_MIN);
}

/* (R2): Y of the roof, units of Z0. */
static inline float goe_observation_roof(const goe_observation_t *obs) {
    return obs->height_m * obs->state[GOE_INVERSE_RANGE] - obs->state[GOE_TOP];
}

/* The ends of the silhouette, or else the outer base corners, as features. False if neither pair is visible in its order. */
bool goe_observation_ends(const goe_point_t point[GOE_FEATURES], goe_feature_t *left, goe_feature_t *right);

/* A measured point, corrected for the attitude bias to first order. */
/*@ requires goe_observation_is_open(obs) && feature < GOE_FEATURES; */
goe_point_t goe_observation_unbiased(const goe_observation_t *obs, goe_feature_t feature);

/*@ requires goe_observation_is_open(obs) && feature < GOE_FEATURES; */
goe_spread_t goe_observation_spread(const goe_observation_t *obs, goe_feature_t feature);

/* Variance of left, right or top beyond the pixel noise, by outline_share. */
float goe_observation_size_variance(const goe_observation_t *obs);

/* ------------------------------------------------------------------------------------------------------------ rows -- */

/* Starts an empty set of rows. */
/*@ requires \valid(rows) && \valid(matrix); */
void goe_rows_clear(goe_rows_t *rows, goe_matrix_t *matrix);

/* Index of the residual, from the derivatives by the states. */
#define GOE_BEHIND_STATES (GOE_RESIDUAL - GOE_STATE_COLUMN)

/* Sets the derivatives of a coordinate whose point moves with the reference point, by whose X, Y and Z it changes by by_x, by_y and by_z: by
 * GOE_BEARING, and by GOE_INVERSE_RANGE as far as the camera's path determines it. */
/*@ requires \valid(by + (0 .. GOE_BEHIND_STATES)) && goe_observation_is_open(obs); */
void goe_rows_move(float *by, const goe_observation_t *obs, float by_x, float by_y, float by_z);

/* Each function adds a row, and returns its derivatives by the states, those of goe_rows_move() and otherwise 0, followed by the residual
 * (GOE_BEHIND_STATES). goe_rows_end() sets those by the attitude bias. The row's variance is the last one of rows->variance.
 *
 * Any row: the residual is the measured coordinate minus the predicted one. This is gradient->at, which is that on the smoothed path, and the
 * rest of the given place: an error of the place that is in derivatives and residual would count as range, by its square. */
/*@ requires goe_rows_hold(rows) && goe_observation_is_open(obs) && \valid_read(gradient);
    requires rows->count < GOE_ROWS_MAX && feature < GOE_FEATURES; */
float *goe_rows_add(goe_rows_t *rows, const goe_observation_t *obs, goe_feature_t feature, goe_axis_t axis,
                    float measured, float variance, const goe_gradient_t *gradient);

/* Adds the row of an upright edge at the place (X, Z), measured along x at the height of the measurement, corrected for the attitude bias:
 * it has no height of its own, of_x->y is 0. Null if the feature is not usable. more: variance beyond the pixel noise. */
/*@ requires goe_rows_hold(rows) && goe_observation_is_open(obs) && \valid(of_x);
    requires rows->count < GOE_ROWS_MAX && feature < GOE_FEATURES; */
float *goe_rows_add_edge(goe_rows_t *rows, const goe_observation_t *obs, goe_xz_t place, goe_feature_t feature,
                         float more, goe_gradient_t *of_x);

/* Adds the row of a point at the place (X, Z) and the height y, measured along y. */
/*@ requires goe_rows_hold(rows) && goe_observation_is_open(obs) && \valid(of_y);
    requires rows->count < GOE_ROWS_MAX && feature < GOE_FEATURES; */
float *goe_rows_add_level(goe_rows_t *rows, const goe_observation_t *obs, goe_xz_t place, float y,
                          goe_feature_t feature, float more, goe_gradient_t *of_y);

/*@ requires goe_rows_hold(rows) && 1 <= rows->count <= GOE_ROWS_MAX; */
static inline float *goe_rows_last_variance(goe_rows_t *rows) { return &rows->variance[rows->count - 1u]; }

/* Call after the last row: computes the columns of the attitude bias from those of the image's own attitude error, and clears unused
 * rows. */
void goe_rows_end(goe_rows_t *rows, const goe_observation_t *obs);

#endif
