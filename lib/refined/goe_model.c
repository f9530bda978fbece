/* Dispatch to the models. SPDX-License-Identifier: MIT */
#include "refined/goe_model.h"

#include <string.h>

#include "refined/goe_box.h"
#include "refined/goe_box_start.h"
#include "refined/goe_chord.h"
#include "refined/goe_disc.h"
#include "refined/goe_ground.h"
#include "refined/goe_prism.h"

#if GOE_WITH_FILTER

#define NEAR_IMAGES 8u /* in which an invisible near corner is a missed one, not a nonexistent one */

/* Base corners are more informative than a box: with them it starts as a disc that substitutes for one. */
static bool shows_prism(goe_model_t asked, const goe_view_t *view) {
    const goe_point_t *p = view->point;
    return view->sides.usable != 0 && asked != GOE_MODEL_LINE &&
           !(p[GOE_POINT_BASE_LEFT].usable && p[GOE_POINT_BASE_RIGHT].usable);
}

bool goe_model_place(goe_filter_t *filter, goe_model_t asked, const goe_view_t *view) {
    goe_filter_place_axes(filter, view->motion);
    return shows_prism(asked, view) && goe_prism_face(filter, view);
}

bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs, bool prism) {
    if (!(prism ? goe_prism_start(obs, filter->state, &filter->root)
                : goe_disc_start(obs, filter->state, &filter->root))) {
        return false;
    }
    goe_filter_enter(filter, prism ? GOE_PHASE_PRISM : GOE_PHASE_DISC);
    memset(filter->side, 0, sizeof filter->side);
    filter->datum.boxes = obs->sides->usable != 0;
    goe_ground_start(filter, goe_observation_height_variance(obs, filter->datum.boxes));
    memset(filter->walk_s, 0, sizeof filter->walk_s);
    filter->due_s = 0.0f;
    filter->candidate.stand_in = false;
    return true;
}

/* A near corner between two faces is missed now and then. */
static void note_near(goe_filter_t *filter, const goe_observation_t *obs) {
    if (obs->point[GOE_POINT_BASE_NEAR].usable) {
        filter->candidate.near_images = NEAR_IMAGES;
    } else if (filter->candidate.near_images > 0) {
        filter->candidate.near_images--;
    }
}

bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs) {
    note_near(filter, obs);
    filter->candidate.stand_in = filter->candidate.stand_in || (obs->base && obs->settings->model != GOE_MODEL_DISC);
    switch (goe_filter_phase(filter)) {
        case GOE_PHASE_DISC:
            return goe_box_start(filter, obs) || goe_chord_start(filter, obs);
        case GOE_PHASE_CHORD:
            return goe_box_start(filter, obs) || goe_chord_change(filter, obs);
        case GOE_PHASE_BOX_FACE:
        case GOE_PHASE_BOX:
        case GOE_PHASE_BOX_OUTLINE:
            return goe_box_change(filter, obs);
        case GOE_PHASE_PRISM:
        case GOE_PHASE_NONE:
        default:
            return false;
    }
}

void goe_model_rows(const goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows) {
    switch (goe_filter_phase(filter)) {
        case GOE_PHASE_PRISM:
            goe_prism_rows(obs, rows);
            break;
        case GOE_PHASE_CHORD:
            goe_chord_rows(obs, rows);
            break;
        case GOE_PHASE_BOX_FACE:
        case GOE_PHASE_BOX:
        case GOE_PHASE_BOX_OUTLINE:
            obs->depth_variance = goe_filter_variance(filter, GOE_DEPTH_DIFFERENCE);
            obs->two_faces = !goe_filter_traits(filter)->one_face;
            goe_box_rows(obs, rows);
            break;
        case GOE_PHASE_DISC:
        case GOE_PHASE_NONE:
        default:
            obs->stand_in = filter->candidate.stand_in;
            goe_disc_rows(obs, rows);
            break;
    }
}

void goe_model_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    if (goe_filter_traits(filter)->remembers_sides) {
        goe_prism_recall(filter, obs, rows);
    }
}

void goe_model_learn(goe_filter_t *filter, goe_rows_t *rows, const goe_verdict_t *verdict) {
    const goe_traits_t *traits = goe_filter_traits(filter);
    if (traits->can_lose_an_end) {
        goe_chord_follow(filter, verdict);
    } else if (traits->remembers_sides) {
        goe_prism_learn(filter, rows);
    }
}

void goe_model_doubt(goe_filter_t *filter, const goe_observation_t *obs) {
    if (goe_filter_traits(filter)->can_lose_an_end) {
        goe_chord_free_top(filter, obs);
    }
}

float goe_model_update(goe_filter_t *filter, float nuisance_root, goe_rows_t *rows, float change[GOE_UNKNOWNS]) {
    const bool prism = goe_filter_traits(filter)->is_ellipse;
    const float nis = prism && !goe_prism_knows_depth(filter)
                          ? goe_srif_update_considering(&filter->root, nuisance_root, rows->matrix, rows->count, change)
                          : goe_srif_update(&filter->root, nuisance_root, rows->matrix, rows->count, change);
    const float before = filter->state[GOE_INVERSE_RANGE];
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter->state[i] += change[i];
    }
    goe_ground_follow(filter, before);
    if (prism) {
        goe_prism_follow(filter, change);
    }
    return nis;
}

void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    switch (goe_filter_phase(filter)) {
        case GOE_PHASE_PRISM:
            goe_prism_shape(filter, shape);
            break;
        case GOE_PHASE_CHORD:
            goe_chord_shape(filter, shape);
            break;
        case GOE_PHASE_BOX_FACE:
        case GOE_PHASE_BOX:
        case GOE_PHASE_BOX_OUTLINE:
            goe_box_shape(filter, shape);
            break;
        case GOE_PHASE_DISC:
        case GOE_PHASE_NONE:
        default:
            goe_disc_shape(filter, shape);
            break;
    }
}

#endif
