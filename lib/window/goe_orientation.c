/* Orientation of the obstacle: which edge is its side, and the low-pass. SPDX-License-Identifier: MIT */
#include "window/goe_orientation.h"

#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_WINDOW

/* Between +-30 and +-60 degrees, under noise, the smaller angle does not separate side edge and front edge. There the low-pass decides;
 * otherwise it would average +45 with -45. */
#define AMBIGUOUS_DEG 30.0f
#define FOLDED_MAX_DEG 90.0f

/* The orientation if `side` is the side edge and `front` the front edge. Either may be missing. */
/*@ requires side == \null || \valid_read(side);
    requires front == \null || \valid_read(front);
    requires side != \null || front != \null; */
static float hypothesis_deg(const goe_edge_t *side, const goe_edge_t *front) {
    if (side && side->has_heading) {
        return side->heading_deg;
    }
    return goe_fold_deg(front->heading_deg - 90.0f);
}

static float distance_deg(float a_deg, float b_deg) { return goe_absolute(goe_fold_deg(a_deg - b_deg)); }

static bool prefers_first(const goe_orientation_t *orientation, float first_deg, float second_deg) {
    const float first = goe_absolute(first_deg);
    const float second = goe_absolute(second_deg);
    if (orientation->count > 0 && goe_absolute(first - second) < AMBIGUOUS_DEG) {
        return distance_deg(first_deg, orientation->filtered_deg) <=
               distance_deg(second_deg, orientation->filtered_deg);
    }
    return first <= second;
}

/* b <- b + (g - b)/min(k, memory), for angles of undirected lines. */
/*@ requires \valid(orientation) && 1 <= memory <= 1000 && 0 <= orientation->count <= 1000; */
static void low_pass(goe_orientation_t *orientation, float measured_deg, int memory) {
    const float step = orientation->count > 0 ? goe_fold_deg(measured_deg - orientation->filtered_deg) : 0.0f;
    const float before = orientation->count > 0 ? orientation->filtered_deg : measured_deg;
    orientation->count += orientation->count < memory ? 1 : 0;
    const float gain = 1.0f / (float)orientation->count;
    orientation->raw_deg = measured_deg;
    orientation->filtered_deg = goe_fold_deg(before + step * gain);
    orientation->variance_deg2 += (step * step - orientation->variance_deg2) * gain;
}

/* Resets values that no image can have left there. */
static void mend(goe_orientation_t *orientation, int memory) {
    if (orientation->count < 0 || orientation->count > memory ||
        !goe_within(orientation->filtered_deg, FOLDED_MAX_DEG)) {
        memset(orientation, 0, sizeof *orientation);
    }
}

void goe_orientation_update(goe_orientation_t *orientation, const goe_edges_t *edges, int memory, goe_faces_t *faces) {
    const goe_edge_t *first = edges->count > 0 ? &edges->edge[0] : NULL;
    const goe_edge_t *second = edges->count > 1 ? &edges->edge[1] : NULL;
    mend(orientation, memory);
    faces->measured = (first && first->has_heading) || (second && second->has_heading);
    if (!faces->measured) {
        return;
    }
    const float if_first_deg = hypothesis_deg(first, second);
    const float if_second_deg = hypothesis_deg(second, first);
    const bool first_is_side = prefers_first(orientation, if_first_deg, if_second_deg);
    faces->side = first_is_side ? first : second;
    faces->front = first_is_side ? second : first;
    faces->side_is_right = !first_is_side;
    low_pass(orientation, first_is_side ? if_first_deg : if_second_deg, memory);
}

#endif
