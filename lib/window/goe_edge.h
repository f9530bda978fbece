/* The visible edges of the obstacle's base: which exist, which count, their headings. SPDX-License-Identifier: MIT */
#ifndef GOE_EDGE_H
#define GOE_EDGE_H

#include "image/goe_view.h"

typedef struct {
    const goe_point_t *left, *right; /* end points in image order */
    bool counts;                     /* long enough in the raw image */
    bool has_heading;                /* counts, and steep enough in the aligned image */
    float heading_deg;               /* from Z, (-90, 90]; valid if has_heading */
} goe_edge_t;

typedef struct {
    int count;          /* 0 to 2 */
    goe_edge_t edge[2]; /* from left to right; two edges meet at the near corner */
} goe_edges_t;

/* Finds the edges between the usable base corners. Returns GOE_OK; or GOE_SWAPPED, and no edges, if the corners are not in image order. The
 * edges point into view. */
goe_status_t goe_edge_find(const goe_settings_t *settings, const goe_view_t *view, goe_edges_t *edges);

#endif
