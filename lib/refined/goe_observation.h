/* One image as the refined method sees it, and the rows that it gives. SPDX-License-Identifier: MIT */
#ifndef GOE_OBSERVATION_H
#define GOE_OBSERVATION_H

#include "image/goe_align.h"
#include "refined/goe_srif.h"

/* States, all scaled by the range Z0 of the reference point at the track's first image, in which the image is nearly
 * linear. X, Z: T's axes, of a box turned about the vertical so that Z pointed at its near corner when it started (only
 * there is it near enough to the axis for the states to be independent of each other). "Side" is the edge of length L,
 * "front" that of width W, b the side's angle from Z. */
enum {
    GOE_BX, /* attitude bias about body x, y, z: small rotation from the told to the true attitude, rad */
    GOE_BY,
    GOE_BZ,
    GOE_DH, /* true minus told height of the camera above the obstacle's ground, m */
    GOE_A,  /* X0/Z0 */
    GOE_Q,  /* 1/Z0, 1/m */
    GOE_SX, /* L sin(b)/Z0. Of a disc: how much deeper its right end lies than its left one, over Z0, which is 0 unless it is
               no disc; of a chord the same */
    GOE_FX, /* W cos(b)/Z0; of a disc: diameter/Z0; of a chord: how much farther to the right, over Z0 */
    GOE_D,  /* (L cos(b) - W |sin(b)|)/Z0: how much deeper the side reaches than the front; otherwise idle */
    GOE_E   /* (H - GOE_DH)/Z0: the top above the altimeter's own datum */
};

/* Features in the order of goe_image_t. */
enum { GOE_LEFT, GOE_RIGHT, GOE_TOP, GOE_BASE_LEFT, GOE_BASE_NEAR, GOE_BASE_RIGHT };

typedef struct {
    const goe_settings_t *settings;
    const float *state;
    const goe_point_t *point; /* GOE_FEATURES, aligned with the state's axes; usable: measured in this image */
    float camera_to_axes[9], body_to_axes[9];
    float ex, ey, ez;           /* attitude bias about the state's axes, rad */
    float dx_m, dz_m, height_m; /* camera since the track's first image, the state's axes; above ground, as told */
    float depth_variance;       /* of GOE_D */
    bool base;                  /* both outer base corners are seen */
    bool edge;                  /* an edge of the base is seen */
    bool deep;                  /* goe_filter_t */
} goe_observation_t;

/* What each row is made of, until it is weighted. */
typedef struct {
    goe_matrix_t *matrix;         /* columns GOE_TEMPORARIES on: derivatives of the prediction by the states */
    float variance[GOE_ROWS_MAX]; /* of the row's own noise */
    uint8_t feature[GOE_ROWS_MAX];
    size_t count;
} goe_rows_t;

/* Derivatives of one image coordinate by the point (X, Y, Z) and by the attitude's error about the axes. */
typedef struct {
    float x, y, z, ex, ey, ez;
} goe_gradient_t;

/* Covariance of an aligned point, of the pixel noise alone. */
typedef struct {
    float xx, xy, yy;
} goe_spread_t;

/* Turns the view into the state's axes and sets what does not depend on the rest of the state; goe_observation_look() does that,
 * and again after the state changed. Pairs that are out of their order,
 * left to right, do not count; returns how many. */
unsigned goe_observation_open(goe_observation_t *sight, const goe_estimator_t *estimator,
                              const float camera_to_trajectory[9], goe_view_t *view);
void goe_observation_look(goe_observation_t *sight);

/* Where the point (X, Y, Z), in units of Z0 or any other, is seen, and the derivatives of both coordinates. */
goe_point_t goe_observation_project(const goe_observation_t *sight, float x, float y, float z, goe_gradient_t *of_x,
                                    goe_gradient_t *of_y);

/* One sigma of a pixel, focal lengths. */
static inline float goe_observation_pixel(const goe_observation_t *sight) {
    return sight->settings->noise.pixel_px / sight->settings->camera.fx_px;
}

/* The state's reference point relative to the camera now, units of Z0. */
static inline float goe_observation_reference_x(const goe_observation_t *sight) {
    return sight->state[GOE_A] - sight->dx_m * sight->state[GOE_Q];
}

static inline float goe_observation_reference_z(const goe_observation_t *sight) {
    return 1.0f - sight->dz_m * sight->state[GOE_Q];
}

/* A measured point with the attitude bias taken off, to first order. */
goe_point_t goe_observation_unbiased(const goe_observation_t *sight, size_t feature);

goe_spread_t goe_observation_spread(const goe_observation_t *sight, size_t feature);

/* Variance of a silhouette point beyond the pixel noise: goe_noise_t.size_share. */
float goe_observation_size_variance(const goe_observation_t *sight);

/* Begins, and ends: unused rows of the matrix are set to 0. */
void goe_rows_clear(goe_rows_t *rows, goe_matrix_t *matrix);
void goe_rows_end(goe_rows_t *rows);

/* Starts a row: residual, variance, attitude. Returns its index; the states' columns are 0 but for the attitude bias, which
 * goe_rows_turn() fills. */
size_t goe_rows_add(goe_rows_t *rows, size_t feature, float residual, float variance, const goe_gradient_t *gradient);

static inline void goe_rows_set(goe_rows_t *rows, size_t row, size_t state, float derivative) {
    rows->matrix->column[GOE_TEMPORARIES + state][row] = derivative;
}

static inline float goe_rows_get(const goe_rows_t *rows, size_t row, size_t state) {
    return rows->matrix->column[GOE_TEMPORARIES + state][row];
}

/* Fills the columns of the attitude bias from those of the image's own attitude error. */
void goe_rows_turn(goe_rows_t *rows, const goe_observation_t *sight);

#endif
