/* Sets the estimate from the filter's state, and keeps the data of it that goe_hazard() needs later. SPDX-License-Identifier: MIT */
#include "refined/goe_answer.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_kind.h"
#include "refined/goe_near_side.h"
#include "refined/goe_report.h"

#if GOE_WITH_FILTER

#define REACH_MAX_M 1.0e6f /* the limit of all positions */

/* Keeps the data of the estimate that goe_hazard() needs while no new estimate follows. */
static void keep_answer(goe_filter_t *filter) {
    goe_answer_t *answer = &filter->answer;
    goe_xz_t nearer_m;
    const float reach_m = goe_near_side_reach(filter, &nearer_m);
    answer->nearer.dx_m = nearer_m.x;
    answer->nearer.dz_m = nearer_m.z;
    if (goe_within(reach_m, REACH_MAX_M)) {
        answer->reach_m = reach_m;
    }
    answer->height_bias_m = filter->state[GOE_GROUND] / filter->state[GOE_INVERSE_RANGE];
    answer->outdated = false;
    answer->by_kind = false;
}

/* Whether the obstacle is behind the camera with its entire extent, in an image that shows it ahead. */
static bool lies_behind(const goe_filter_t *filter, const goe_quantities_t *quantities, const goe_motion_t *motion) {
    goe_xz_t nearer_m;
    const float circle_m = goe_near_side_reach(filter, &nearer_m);
    const float reach_m = circle_m + sqrtf(goe_xz_dot(nearer_m, nearer_m));
    return quantities->value[GOE_Z0] - motion->dz_m <
           -(reach_m + (quantities->box ? quantities->value[GOE_LENGTH] : 0.0f));
}

/* by_kind: the state contains the sizes of the class. Returns whether the estimate is new. */
static bool update(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion, bool by_kind,
                   goe_estimate_t *estimate) {
    goe_quantities_t quantities;
    goe_quantities_find(filter, settings, motion, &quantities);
    filter->known = (uint8_t)quantities.now;
    const bool placed = (quantities.now & GOE_HAS_POSITION) != 0u; /* otherwise the other fields may be unset */
    if (placed && lies_behind(filter, &quantities, motion)) {
        if (by_kind) {
            goe_kind_reject(filter);
        } else {
            goe_kind_start_farther(filter);
        }
        return false;
    }
    const bool fresh = goe_report_quantities(&quantities, motion, estimate);
    if (fresh) {
        keep_answer(filter);
    }
    return fresh;
}

/* `kind.known` stores the quantities known with the sizes; `known`, that of the images alone, becomes 0. The covariance with the sizes is
 * valid for this estimate only. */
static bool update_with_sizes(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                              goe_estimate_t *estimate) {
    filter->known = filter->kind.known;
    const bool fresh = update(filter, settings, motion, true, estimate);
    filter->kind.known = filter->known;
    filter->known = 0;
    filter->answer.outdated = true;
    filter->answer.by_kind = fresh || filter->answer.by_kind;
    return fresh;
}

bool goe_answer_update(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                       goe_estimate_t *estimate) {
    goe_kind_saved_t saved;
    const bool own = (estimate->valid & GOE_HAS_POSITION) != 0u && !filter->answer.by_kind; /* no class replaces it */
    if (own || !goe_kind_apply(filter, &saved)) {
        return update(filter, settings, motion, false, estimate);
    }
    const bool fresh = update_with_sizes(filter, settings, motion, estimate);
    goe_kind_restore(filter, &saved);
    return fresh;
}

#endif
