/* The window method: passes one image through the equations (1) to (8). SPDX-License-Identifier: MIT
 *
 *   aligned points -> disc row -------------------> fit -> length, height -> estimate
 *                 \-> edges -> orientation -> line row -/
 */
#include "window/goe_window.h"

#include <math.h>
#include <string.h>

#include "image/goe_ego_motion.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "window/goe_edge.h"
#include "window/goe_extent.h"
#include "window/goe_fit.h"
#include "window/goe_mean.h"
#include "window/goe_orientation.h"
#include "window/goe_projection.h"

#if GOE_WITH_WINDOW

/* Data of one image on its way through the processing chain. */
typedef struct {
    const goe_settings_t *settings;
    const goe_view_t *view;
    const goe_motion_t *motion;
    goe_estimate_t *estimate;
    goe_edges_t edges;
    goe_faces_t faces;
    goe_turn_t turn;  /* filtered orientation */
    goe_span_t front; /* valid if line_row */
    goe_faults_t faults;
    bool disc_row, line_row; /* the image added a row to that model's ring */
} frame_t;

void goe_window_clear(goe_window_t *window) { memset(window, 0, sizeof *window); }

/* ------------------------------------------------------------------------------------------------- rows of one image -- */

static inline void add_row(goe_fit_ring_t *ring, const frame_t *frame, goe_row_t row) {
    goe_fit_add(ring, frame->settings->window.points, frame->motion->dx_m, frame->motion->dz_m, row);
}

static goe_status_t add_disc_row(goe_window_t *window, frame_t *frame) {
    goe_row_t row;
    const goe_point_t *left = &frame->view->point[GOE_POINT_LEFT];
    const goe_point_t *right = &frame->view->point[GOE_POINT_RIGHT];
    if (frame->settings->model == GOE_MODEL_LINE || !left->usable || !right->usable) {
        return GOE_OK;
    }
    const goe_status_t fault = goe_projection_disc(left, right, &row);
    if (fault == GOE_OK) {
        add_row(&window->disc, frame, row);
        frame->disc_row = true;
    }
    return fault;
}

static void clear_faces(frame_t *frame) {
    frame->edges.count = 0;
    frame->faces.measured = false;
    frame->turn.s = 0.0f;
    frame->turn.c = 1.0f;
}

static void find_faces(goe_window_t *window, frame_t *frame) {
    if (frame->settings->model == GOE_MODEL_DISC) {
        clear_faces(frame);
        return;
    }
    goe_fault_note(&frame->faults, goe_edge_find(frame->settings, frame->view, &frame->edges));
    goe_orientation_update(&window->orientation, &frame->edges, frame->settings->window.orientation_memory,
                           &frame->faces);
    goe_sincos_deg(window->orientation.filtered_deg, &frame->turn.s, &frame->turn.c);
}

static void add_line_row(goe_window_t *window, frame_t *frame) {
    goe_row_t row;
    if (!frame->faces.measured || !frame->faces.front || !frame->faces.front->counts) {
        return;
    }
    const goe_edge_t *front = frame->faces.front;
    const goe_status_t fault = goe_projection_line(front->left, front->right, frame->turn, &frame->front, &row);
    goe_fault_note(&frame->faults, fault);
    if (fault == GOE_OK) {
        add_row(&window->line, frame, row);
        frame->line_row = true;
    }
}

/* ------------------------------------------------------------------------------------------------------- solution -- */

static int line_points_needed(const goe_settings_t *settings) {
    return settings->window.line_points > settings->window.points ? settings->window.line_points
                                                                  : settings->window.points;
}

/* The model to report, by Section 4 of the paper: disc until there are enough line points. */
static goe_model_t reported_model(const goe_window_t *window, const goe_settings_t *settings) {
    if (settings->model != GOE_MODEL_AUTO) {
        return settings->model;
    }
    return window->line.count >= line_points_needed(settings) ? GOE_MODEL_LINE : GOE_MODEL_DISC;
}

static void take_fit(const frame_t *frame, goe_model_t model) {
    goe_estimate_t *estimate = frame->estimate;
    estimate->method = GOE_METHOD_WINDOW;
    estimate->model = model;
    estimate->valid |= GOE_HAS_POSITION | GOE_HAS_WIDTH;
    estimate->fresh = true;
    estimate->images_used = frame->settings->window.points;
}

/* Returns GOE_OK: solved; GOE_CONVERGING, GOE_STALE: nothing to solve; otherwise why there is no solution. */
static goe_status_t solve(goe_window_t *window, const frame_t *frame) {
    const goe_model_t model = reported_model(window, frame->settings);
    const goe_fit_ring_t *ring = model == GOE_MODEL_LINE ? &window->line : &window->disc;
    const int length = frame->settings->window.points;
    if (ring->count < length) {
        return GOE_CONVERGING;
    }
    if (!(model == GOE_MODEL_LINE ? frame->line_row : frame->disc_row)) {
        return GOE_STALE;
    }
    const goe_status_t status = goe_fit_solve(ring, length, frame->settings->window.min_baseline_m, frame->estimate);
    if (status == GOE_OK) {
        take_fit(frame, model);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------- what hangs on a solution -- */

/* Adds one image's length or height to its sliding mean. A mean that is not positive is not valid. */
static void take_extent(goe_mean_t *mean, int length, const goe_extent_t *extent, unsigned has, unsigned *valid,
                        float *value_m, float *sigma_m) {
    const goe_average_t average = goe_mean_add(mean, length, extent->value_m);
    const bool answers = average.mean > 0.0f;
    *value_m = answers ? average.mean : 0.0f;
    *sigma_m = answers ? sqrtf(average.variance + extent->variance_m2) : 0.0f;
    *valid = answers ? *valid | has : *valid & ~has;
}

static void measure_length(goe_window_t *window, frame_t *frame) {
    goe_estimate_t *estimate = frame->estimate;
    goe_extent_t extent;
    if (estimate->model != GOE_MODEL_LINE || !frame->faces.measured || !frame->faces.side) {
        return;
    }
    const float min_x = frame->settings->window.side_min_px / frame->view->camera->fx_px;
    const goe_status_t fault = goe_extent_length(&frame->faces, &frame->front, frame->turn, estimate, min_x, &extent);
    goe_fault_note(&frame->faults, fault);
    if (fault == GOE_OK) {
        take_extent(&window->length, frame->settings->window.points, &extent, GOE_HAS_LENGTH, &estimate->valid,
                    &estimate->length_m, &estimate->sigma.length_m);
    }
}

static void measure_height(goe_window_t *window, frame_t *frame) {
    goe_estimate_t *estimate = frame->estimate;
    const goe_point_t *top = &frame->view->point[GOE_POINT_TOP];
    goe_extent_t extent;
    if (!top->usable) {
        return;
    }
    const goe_status_t fault = goe_extent_height(top, frame->motion->height_m, estimate, &extent);
    goe_fault_note(&frame->faults, fault);
    if (fault == GOE_OK) {
        take_extent(&window->height, frame->settings->window.points, &extent, GOE_HAS_HEIGHT, &estimate->valid,
                    &estimate->height_m, &estimate->sigma.height_m);
    }
}

static void report_orientation(const goe_orientation_t *orientation, const frame_t *frame) {
    const goe_turn_t turn = frame->turn;
    goe_estimate_t *estimate = frame->estimate;
    if (orientation->count == 0) {
        return;
    }
    estimate->valid |= GOE_HAS_ORIENTATION;
    estimate->orientation_deg = orientation->filtered_deg;
    estimate->orientation_raw_deg = orientation->raw_deg;
    estimate->front_orientation_deg = goe_fold_deg(orientation->filtered_deg + 90.0f);
    estimate->length_axis[0] = turn.s;
    estimate->length_axis[1] = turn.c;
    estimate->width_axis[0] = turn.c;
    estimate->width_axis[1] = -turn.s;
    estimate->sigma.orientation_deg = goe_orientation_sigma_deg(orientation);
}

static void clear_center(goe_estimate_t *estimate) {
    estimate->valid &= ~GOE_HAS_CENTER;
    estimate->center_north_m = 0.0f;
    estimate->center_east_m = 0.0f;
    estimate->center_ne_m2 = 0.0f;
    estimate->sigma.center_north_m = 0.0f;
    estimate->sigma.center_east_m = 0.0f;
}

/* Reports the middle of the base: a disc's reference point; for a line, half a length behind the front edge. */
static void report_center(goe_estimate_t *estimate, const goe_motion_t *motion) {
    const goe_sigma_t *sigma = &estimate->sigma;
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    float x_m = estimate->x0_m;
    float z_m = estimate->z0_m;
    float variance_x = sigma->x0_m * sigma->x0_m;
    float variance_z = sigma->z0_m * sigma->z0_m;
    const unsigned needed = GOE_HAS_POSITION | (estimate->model == GOE_MODEL_DISC ? 0u : GOE_HAS_LENGTH);
    if ((estimate->valid & needed) != needed) {
        clear_center(estimate);
        return;
    }
    if (estimate->model == GOE_MODEL_LINE) {
        const float half_x = 0.5f * estimate->length_axis[0];
        const float half_z = 0.5f * estimate->length_axis[1];
        x_m += half_x * estimate->length_m;
        z_m += half_z * estimate->length_m;
        variance_x += half_x * half_x * sigma->length_m * sigma->length_m;
        variance_z += half_z * half_z * sigma->length_m * sigma->length_m;
    }
    estimate->valid |= GOE_HAS_CENTER;
    goe_motion_place(motion, x_m, z_m, &estimate->center_north_m, &estimate->center_east_m);
    estimate->center_ne_m2 = c * s * (variance_z - variance_x);
    estimate->sigma.center_north_m = sqrtf(c * c * variance_z + s * s * variance_x);
    estimate->sigma.center_east_m = sqrtf(s * s * variance_z + c * c * variance_x);
}

/* --------------------------------------------------------------------------------------------------------- the chain -- */

/* The status of an image that was taken. */
static goe_status_t judge(const frame_t *frame, goe_status_t solving) {
    if (solving == GOE_OK) {
        return frame->faults.first == GOE_OK ? GOE_OK : GOE_PARTIAL;
    }
    if (solving < GOE_OK) {
        goe_count_cause(frame->faults.fault_counts, solving);
        return solving;
    }
    if (frame->faults.first != GOE_OK) {
        return frame->faults.first;
    }
    if (!frame->view->seen) {
        return GOE_NO_DETECTION;
    }
    if (frame->settings->model == GOE_MODEL_LINE && frame->edges.count > 0 && !frame->line_row) {
        goe_count_cause(frame->faults.fault_counts, GOE_NO_EDGE);
        return GOE_NO_EDGE;
    }
    return solving;
}

static void start_frame(frame_t *frame, const goe_settings_t *settings, const goe_view_t *view,
                        const goe_faults_t *faults, goe_estimate_t *estimate) {
    frame->settings = settings;
    frame->view = view;
    frame->motion = view->motion;
    frame->estimate = estimate;
    frame->faults = *faults;
    frame->disc_row = false;
    frame->line_row = false;
}

goe_status_t goe_window_update(goe_window_t *window, const goe_settings_t *settings, const goe_view_t *view,
                               const goe_faults_t *faults, goe_estimate_t *estimate) {
    frame_t frame;
    start_frame(&frame, settings, view, faults, estimate);
    const goe_status_t fault = add_disc_row(window, &frame);
    estimate->fresh = false;
    goe_fault_note(&frame.faults, fault);
    find_faces(window, &frame);
    add_line_row(window, &frame);

    const goe_status_t solving = solve(window, &frame);
    goe_motion_relate(view->motion, estimate);
    report_orientation(&window->orientation, &frame);
    if (solving == GOE_OK) {
        measure_length(window, &frame);
        measure_height(window, &frame);
    }
    report_center(estimate, view->motion);
    return judge(&frame, solving);
}

#endif
