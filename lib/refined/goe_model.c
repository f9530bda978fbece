/* Dispatch to the models. SPDX-License-Identifier: MIT */
#include "refined/goe_model.h"

#include "refined/goe_box.h"
#include "refined/goe_box_start.h"
#include "refined/goe_chord.h"
#include "refined/goe_disc.h"

#if GOE_WITH_REFINED

bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs) {
    if (!goe_disc_start(obs, filter->state, &filter->root)) {
        return false;
    }
    goe_filter_enter(filter, GOE_PHASE_DISC);
    filter->stand_in = false;
    goe_srif_invert_diagonal(&filter->root, &filter->inverse);
    goe_filter_settle(filter);
    return true;
}

bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs) {
    filter->stand_in = filter->stand_in || (obs->base && obs->settings->model != GOE_MODEL_DISC);
    switch (goe_filter_phase(filter)) {
        case GOE_PHASE_DISC:
            return goe_box_start(filter, obs) || goe_chord_start(filter, obs);
        case GOE_PHASE_CHORD:
            return goe_box_start(filter, obs) || goe_chord_change(filter, obs);
        case GOE_PHASE_BOX_FACE:
        case GOE_PHASE_BOX:
        case GOE_PHASE_BOX_OUTLINE:
            return goe_box_change(filter, obs);
        case GOE_PHASE_NONE:
        default:
            return false;
    }
}

void goe_model_rows(goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows) {
    if (goe_filter_is_box(filter)) {
        obs->depth_variance = goe_filter_variance(filter, GOE_DEPTH_DIFFERENCE);
        obs->two_faces = filter->phase != GOE_PHASE_BOX_FACE;
        goe_box_rows(obs, rows);
    } else if (filter->phase == GOE_PHASE_CHORD) {
        goe_chord_free_top(filter, obs);
        goe_chord_rows(obs, rows);
    } else {
        goe_disc_rows(obs, rows);
    }
}

void goe_model_follow(goe_filter_t *filter, const goe_verdict_t *verdict) {
    if (filter->phase == GOE_PHASE_CHORD) {
        goe_chord_follow(filter, verdict);
    }
}

void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    if (goe_filter_is_box(filter)) {
        goe_box_shape(filter, shape);
    } else if (filter->phase == GOE_PHASE_CHORD) {
        goe_chord_shape(filter, shape);
    } else {
        goe_disc_shape(filter, shape);
    }
}

#endif
