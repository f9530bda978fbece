/* The calls of the model that the filter's phase selects. SPDX-License-Identifier: MIT */
#include "refined/goe_model.h"

#include <string.h>

#include "refined/goe_box.h"
#include "refined/goe_box_start.h"
#include "refined/goe_footprint.h"
#include "refined/goe_footprint_start.h"
#include "refined/goe_ground.h"
#include "refined/goe_kind.h"

#if GOE_WITH_FILTER

#define NEAR_IMAGES 8u /* images in which an invisible near corner counts as missed, not as nonexistent */

bool goe_model_place(goe_filter_t *filter, const goe_view_t *view) {
    goe_filter_place_axes(filter, view->motion);
    return goe_footprint_face(filter, view);
}

bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs) {
    bool by_kind = false;
    if (!goe_footprint_start(obs, filter->state, &filter->root, &by_kind)) {
        return false;
    }
    goe_filter_enter(filter, GOE_PHASE_FOOTPRINT);
    memset(filter->side, 0, sizeof filter->side);
    goe_ground_start(filter, obs);
    goe_kind_start(filter, obs, by_kind);
    memset(filter->walk_s, 0, sizeof filter->walk_s);
    filter->due_s = 0.0f;
    return true;
}

/* A detector sometimes misses the near corner between two faces. */
static void note_near(goe_filter_t *filter, const goe_observation_t *obs) {
    if (obs->point[GOE_POINT_BASE_NEAR].usable) {
        filter->candidate.near_images = NEAR_IMAGES;
    } else if (filter->candidate.near_images > 0) {
        filter->candidate.near_images--;
    }
}

bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs) {
    note_near(filter, obs);
    if (goe_filter_traits(filter)->is_ellipse && obs->sides->usable != 0) {
        goe_ground_meet_box(filter);
    }
    if (goe_filter_is_box(filter)) {
        return goe_box_change(filter, obs);
    }
    return goe_filter_has_started(filter) && goe_box_start(filter, obs);
}

void goe_model_rows(const goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows) {
    if (goe_filter_is_box(filter)) {
        obs->depth_variance = goe_filter_variance(filter, GOE_DEPTH_DIFFERENCE);
        obs->two_faces = !goe_filter_traits(filter)->one_face;
        goe_box_rows(obs, rows);
    } else {
        goe_footprint_rows(obs, rows);
    }
}

void goe_model_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    if (goe_filter_traits(filter)->is_ellipse) {
        goe_footprint_recall(filter, obs, rows);
    }
}

void goe_model_learn(goe_filter_t *filter, goe_rows_t *rows) {
    if (goe_filter_traits(filter)->is_ellipse) {
        goe_footprint_learn(filter, rows);
    }
}

float goe_model_update(goe_filter_t *filter, float nuisance_root, goe_rows_t *rows, float change[GOE_UNKNOWNS]) {
    const bool ellipse = goe_filter_traits(filter)->is_ellipse;
    const float nis = ellipse && !goe_footprint_knows_depth(filter)
                          ? goe_srif_update_considering(&filter->root, nuisance_root, rows->matrix, rows->count, change)
                          : goe_srif_update(&filter->root, nuisance_root, rows->matrix, rows->count, change);
    const float before = filter->state[GOE_INVERSE_RANGE];
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter->state[i] += change[i];
    }
    goe_ground_follow(filter, before);
    if (ellipse) {
        goe_footprint_follow(filter, change);
    }
    return nis;
}

void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    if (goe_filter_is_box(filter)) {
        goe_box_shape(filter, shape);
    } else {
        goe_footprint_shape(filter, shape);
    }
}

#endif
