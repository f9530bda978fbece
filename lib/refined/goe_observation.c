/* Projection under a small attitude bias, noise of the points. SPDX-License-Identifier: MIT */
#include "refined/goe_observation.h"

#define ABEAM 0.02f           /* third component of an aligned point's ray after the turn */
#define FORWARD_LEAST 1.0e-4f /* a predicted point is taken to lie at least this far ahead, in units of Z0 */

/* Left must lie left of right, or neither counts. Where base_near lies between them is not asked: the gate judges it. */
static bool in_order(goe_point_t *left, goe_point_t *right) {
    if (left->usable && right->usable && !(left->x < right->x)) {
        left->usable = false;
        right->usable = false;
        return false;
    }
    return true;
}

static unsigned put_in_order(goe_observation_t *sight, goe_view_t *view) {
    const void *points = view; /* one after the other, in the order of the features */
    const bool silhouette = in_order(&view->left, &view->right);
    const bool base = in_order(&view->base_left, &view->base_right);
    const bool left = view->base_left.usable;
    const bool right = view->base_right.usable;
    sight->base = left && right;
    sight->edge = sight->base || (view->base_near.usable && (left || right));
    sight->point = points;
    return (silhouette ? 0u : 1u) + (base ? 0u : 1u);
}

/* About the vertical: X = c x - s z, Z = s x + c z. */
static void turn_points(goe_view_t *view, float c, float s) {
    void *points = view;
    goe_point_t *p = points;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        const float forward = p[i].usable ? s * p[i].x + c : 0.0f;
        p[i].usable = forward > ABEAM;
        if (p[i].usable) {
            p[i].x = (c * p[i].x - s) / forward;
            p[i].y = p[i].y / forward;
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
static void find_body(goe_observation_t *sight, const float camera_to_body[9]) {
    const float *t = sight->camera_to_axes;
    for (size_t j = 0; j < 3; j++) {
        const float *b = &camera_to_body[3 * j];
        for (size_t i = 0; i < 3; i++) {
            sight->body_to_axes[3 * i + j] = t[3 * i] * b[0] + t[3 * i + 1] * b[1] + t[3 * i + 2] * b[2];
        }
    }
}

unsigned goe_observation_open(goe_observation_t *sight, const goe_estimator_t *estimator,
                              const float camera_to_trajectory[9], goe_view_t *view) {
    const float c = estimator->filter.turn_cos;
    const float s = estimator->filter.turn_sin;
    sight->settings = &estimator->settings;
    sight->state = estimator->filter.state;
    turn_rotation(camera_to_trajectory, c, s, sight->camera_to_axes);
    turn_points(view, c, s);
    find_body(sight, estimator->camera_to_body);
    const float dx_m = estimator->dx_m - estimator->filter.start_dx_m;
    const float dz_m = estimator->dz_m - estimator->filter.start_dz_m;
    sight->dx_m = c * dx_m - s * dz_m;
    sight->dz_m = s * dx_m + c * dz_m;
    sight->height_m = estimator->height_m;
    sight->depth_variance = 0.0f;
    return put_in_order(sight, view);
}

void goe_observation_look(goe_observation_t *sight) {
    const float *m = sight->body_to_axes;
    const float *b = &sight->state[GOE_BX];
    sight->ex = m[0] * b[0] + m[1] * b[1] + m[2] * b[2];
    sight->ey = m[3] * b[0] + m[4] * b[1] + m[5] * b[2];
    sight->ez = m[6] * b[0] + m[7] * b[1] + m[8] * b[2];
}

goe_point_t goe_observation_project(const goe_observation_t *sight, float x, float y, float z, goe_gradient_t *of_x,
                                    goe_gradient_t *of_y) {
    const float ex = sight->ex;
    const float ey = sight->ey;
    const float ez = sight->ez;
    const float turned_z = z + ex * y - ey * x;
    const float reciprocal = 1.0f / (turned_z < FORWARD_LEAST ? FORWARD_LEAST : turned_z);
    goe_point_t seen;
    seen.x = (x + ey * z - ez * y) * reciprocal;
    seen.y = (y + ez * x - ex * z) * reciprocal;
    seen.usable = true;
    of_x->x = (1.0f + seen.x * ey) * reciprocal;
    of_x->y = (-ez - seen.x * ex) * reciprocal;
    of_x->z = (ey - seen.x) * reciprocal;
    of_x->ey = (z + seen.x * x) * reciprocal;
    of_x->ex = -(seen.x * y) * reciprocal;
    of_x->ez = -y * reciprocal;
    of_y->x = (ez + seen.y * ey) * reciprocal;
    of_y->y = (1.0f - seen.y * ex) * reciprocal;
    of_y->z = (-ex - seen.y) * reciprocal;
    of_y->ey = (seen.y * x) * reciprocal;
    of_y->ex = (-z - seen.y * y) * reciprocal;
    of_y->ez = x * reciprocal;
    return seen;
}

goe_point_t goe_observation_unbiased(const goe_observation_t *sight, size_t feature) {
    const goe_point_t *p = &sight->point[feature];
    goe_point_t q = *p;
    q.x = p->x - sight->ey * (1.0f + p->x * p->x) + sight->ez * p->y + sight->ex * p->x * p->y;
    q.y = p->y + sight->ex * (1.0f + p->y * p->y) - sight->ez * p->x - sight->ey * p->x * p->y;
    return q;
}

/* Derivative of the aligned point n1/n3, n2/n3, n = H (u, v, 1), by the pixel; 1/n3 is the third component of H'(x, y, 1). The
 * lens is left out: its scale is good to a few percent. */
goe_spread_t goe_observation_spread(const goe_observation_t *sight, size_t feature) {
    const float *h = sight->camera_to_axes;
    const goe_point_t *p = &sight->point[feature];
    const float scale = (h[2] * p->x + h[5] * p->y + h[8]) * sight->settings->noise.pixel_px;
    const float u = scale / sight->settings->camera.fx_px;
    const float v = scale / sight->settings->camera.fy_px;
    const float xu = (h[0] - p->x * h[6]) * u;
    const float xv = (h[1] - p->x * h[7]) * v;
    const float yu = (h[3] - p->y * h[6]) * u;
    const float yv = (h[4] - p->y * h[7]) * v;
    const goe_spread_t spread = {xu * xu + xv * xv, xu * yu + xv * yv, yu * yu + yv * yv};
    return spread;
}

float goe_observation_size_variance(const goe_observation_t *sight) {
    const goe_point_t *left = &sight->point[GOE_LEFT];
    const goe_point_t *right = &sight->point[GOE_RIGHT];
    if (!left->usable || !right->usable) {
        return 0.0f;
    }
    const float sigma = sight->settings->noise.size_share * (right->x - left->x);
    return sigma * sigma;
}

void goe_rows_clear(goe_rows_t *rows, goe_matrix_t *matrix) {
    rows->matrix = matrix;
    rows->count = 0;
}

void goe_rows_end(goe_rows_t *rows) {
    for (size_t row = rows->count; row < GOE_ROWS_MAX; row++) {
        for (size_t c = 0; c < GOE_COLUMNS; c++) {
            rows->matrix->column[c][row] = 0.0f;
        }
    }
}

size_t goe_rows_add(goe_rows_t *rows, size_t feature, float residual, float variance, const goe_gradient_t *gradient) {
    const size_t row = rows->count++;
    for (size_t state = GOE_DH; state < GOE_STATES; state++) {
        goe_rows_set(rows, row, state, 0.0f);
    }
    rows->matrix->column[0][row] = gradient->ey;
    rows->matrix->column[1][row] = gradient->ex;
    rows->matrix->column[2][row] = gradient->ez;
    rows->matrix->column[GOE_RESIDUAL][row] = residual;
    rows->variance[row] = variance;
    rows->feature[row] = (uint8_t)feature;
    return row;
}

void goe_rows_turn(goe_rows_t *rows, const goe_observation_t *sight) {
    const float *m = sight->body_to_axes;
    for (size_t i = 0; i < rows->count; i++) {
        const float ey = rows->matrix->column[0][i];
        const float ex = rows->matrix->column[1][i];
        const float ez = rows->matrix->column[2][i];
        for (size_t j = 0; j < 3; j++) {
            goe_rows_set(rows, i, GOE_BX + j, ex * m[j] + ey * m[3 + j] + ez * m[6 + j]);
        }
    }
}
