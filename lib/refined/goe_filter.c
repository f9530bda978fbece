/* Phase, root with inverse, axes. SPDX-License-Identifier: MIT */
#include "refined/goe_filter.h"

#include <string.h>

#if GOE_WITH_REFINED

GOE_STATIC_ASSERT(GOE_PHASE_BOX_OUTLINE <= UINT8_MAX, a_phase_fits_its_byte);
GOE_STATIC_ASSERT((GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_HEIGHT | GOE_HAS_ORIENTATION | GOE_HAS_CENTER |
                   GOE_HAS_WIDTH) <= UINT8_MAX,
                  what_is_known_fits_its_byte);
GOE_STATIC_ASSERT(GOE_BIAS_Y == GOE_BIAS_X + 1 && GOE_BIAS_Z == GOE_BIAS_X + 2, the_biases_follow_each_other);

bool goe_filter_reports(const goe_filter_t *filter, const goe_settings_t *settings) {
    return filter->phase >= (settings->model == GOE_MODEL_LINE ? GOE_PHASE_BOX_FACE : GOE_PHASE_PRISM);
}

void goe_filter_clear(goe_filter_t *filter) {
    memset(filter, 0, sizeof *filter);
    filter->axes.turn_cos = 1.0f;
}

void goe_filter_enter(goe_filter_t *filter, goe_phase_t phase) {
    filter->phase = (uint8_t)phase;
    filter->phase_images = 0;
    filter->known = 0;
    filter->candidate.agreeing = 0;
    filter->health.poor = 0;
    filter->health.recent_nis = GOE_NIS_NONE; /* the first image of a phase does not count */
}

void goe_filter_settle(goe_filter_t *filter) {
    filter->drift_rad2 = 0.0f;
    filter->walk2 = 0.0f;
}

void goe_filter_invert(goe_filter_t *filter) {
    goe_srif_invert(&filter->root, &filter->inverse);
    goe_filter_settle(filter);
}

void goe_filter_inflate(goe_filter_t *filter, goe_state_index_t state, float sigma) {
    float direction[GOE_STATES];
    direction[state] = 1.0f;
    goe_srif_spread(&filter->root, direction, state, state, sigma);
}

/* Down in the camera's axes is a row of camera -> T, as T is level. */
static float camera_down_m(const goe_view_t *view) {
    const float *down = &view->camera_to_trajectory[3];
    float arm_m = 0.0f;
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 3; j++) {
            arm_m += down[i] * view->camera_to_body[3 * j + i] * view->camera->offset_m[j];
        }
    }
    return view->image->pose.position_ned_m[2] + arm_m;
}

/* Before the filter starts the ground is where the mean of the heights puts it. */
static void read_height(goe_datum_t *datum, bool started, float down_m, float height_m) {
    const float off_m = height_m + down_m - datum->ground_m;
    datum->readings = (uint16_t)(datum->readings < UINT16_MAX ? datum->readings + 1 : UINT16_MAX);
    datum->mean_m += (off_m - datum->mean_m) / (float)datum->readings;
    if (!started) {
        datum->ground_m += datum->mean_m;
        datum->mean_m = 0.0f;
    }
}

void goe_filter_take_height(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view) {
    goe_datum_t *datum = &filter->datum;
    const bool white = navigation->height_white_m > 0.0f;
    if ((!white && view->image->box.seen == 0 && !filter->has_datum)) {
        return; /* points alone take each image's height as it is */
    }
    const float down_m = camera_down_m(view);
    if (!filter->has_datum) {
        datum->ground_m = view->motion->height_m + down_m;
        datum->sd_m = view->image->noise.height_m;
        filter->has_datum = true;
    }
    if (white) {
        read_height(datum, filter->phase != GOE_PHASE_NONE, down_m, view->motion->height_m);
    }
    datum->height_m = datum->ground_m - down_m;
}

void goe_filter_place_axes(goe_filter_t *filter, const goe_motion_t *motion) {
    filter->axes.start_time_us = motion->time_us;
    filter->axes.turn_cos = 1.0f;
    filter->axes.turn_sin = 0.0f;
    filter->axes.start_dx_m = motion->dx_m;
    filter->axes.start_dz_m = motion->dz_m;
}

#endif
