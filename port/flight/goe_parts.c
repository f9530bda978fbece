/* Images whose detections come in several calls. SPDX-License-Identifier: MIT */
#include "goe_parts.h"

#include "goe_flight_maths.h"

#define SAME_US                                                                                                        \
    5000 /* largest time between calls of one image: an age, or a clock offset, differs a little from call to call */

static bool is_same(const goe_flight_parts_t *parts, uint32_t time_us) {
    const int32_t apart_us = goe_flight_between_us(time_us, parts->begun_us);
    return parts->given != 0u && apart_us <= SAME_US && apart_us >= -SAME_US;
}

bool goe_flight_parts_add(goe_flight_parts_t *parts, const goe_flight_slot_view_t *view,
                          const goe_flight_frame_t *frame) {
    if (!is_same(parts, view->time_us)) {
        parts->begun_us = view->time_us;
        parts->given = 0u;
        parts->taken = 0u;
    }
    const unsigned given = (unsigned)parts->given + frame->count;
    parts->given = (uint8_t)(given < UINT8_MAX ? given : UINT8_MAX);
    return parts->given >= frame->number;
}

void goe_flight_parts_keep(goe_flight_parts_t *parts, const goe_flight_slot_view_t *view, uint32_t now_us) {
    parts->viewed = true;
    parts->viewed_us = now_us;
    memcpy(parts->q, view->pose.q, sizeof parts->q);
    parts->above_m = goe_flight_larger(view->ground_down_m - view->pose.ned_m[2], 0.0f);
}
