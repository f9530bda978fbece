/* Orientation of the obstacle: which edge is its side, and the low-pass. SPDX-License-Identifier: MIT */
#ifndef GOE_ORIENTATION_H
#define GOE_ORIENTATION_H

#include <math.h>

#include "window/goe_edge.h"

typedef struct {
    bool measured;           /* an edge of this image has a heading; otherwise the other fields are invalid */
    const goe_edge_t *front; /* null if not visible */
    const goe_edge_t *side;  /* null if not visible */
    bool side_is_right;      /* the side edge is right of the front edge */
} goe_faces_t;

/* Separates front from side. If an edge has a heading, adds it to the low-pass. memory: number of images, >= 1. */
/*@ requires \valid(orientation) && \valid_read(edges) && \valid(faces) && 1 <= memory <= 1000; */
void goe_orientation_update(goe_orientation_t *orientation, const goe_edges_t *edges, int memory, goe_faces_t *faces);

/* One sigma of the filtered orientation, degrees. */
static inline float goe_orientation_sigma_deg(const goe_orientation_t *orientation) {
    return orientation->count > 0 ? sqrtf(orientation->variance_deg2 / (float)orientation->count) : 0.0f;
}

#endif
