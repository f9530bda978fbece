/* Edges: (1) and the gates of Section 4. SPDX-License-Identifier: MIT */
#include "goe_edge.h"

#include <math.h>

#include "goe_angle.h"

typedef struct {
    const goe_pixel_t *pixel;
    const goe_point_t *point;
} corner_t;

static bool in_order(const goe_point_t *left, const goe_point_t *right) {
    return !left->usable || !right->usable || left->x <= right->x;
}

/* (1). The edge through a and b meets the horizon y = 0 at x_a - y_a (x_b - x_a)/(y_b - y_a) = x/y of the vector below,
 * which needs no division: an edge parallel to the horizon simply has no Z component. */
static float heading_deg(const goe_point_t *a, const goe_point_t *b) {
    const float x = a->x * b->y - a->y * b->x;
    const float z = b->y - a->y;
    const float rad = z < 0.0f ? goe_arctan_rad(-x, -z) : goe_arctan_rad(x, z);
    return goe_fold_deg(rad * GOE_DEG_PER_RAD);
}

static void add_edge(const goe_settings_t *settings, corner_t left, corner_t right, goe_edges_t *edges) {
    if (!left.point->usable || !right.point->usable) {
        return;
    }
    goe_edge_t *edge = &edges->edge[edges->count++];
    const float du = right.pixel->u_px - left.pixel->u_px;
    const float dv = right.pixel->v_px - left.pixel->v_px;
    const float rise_px = fabsf(right.point->y - left.point->y) * settings->camera.fx_px;
    edge->left = left.point;
    edge->right = right.point;
    edge->counts = du * du + dv * dv > settings->edge_min_px * settings->edge_min_px;
    edge->has_heading = edge->counts && rise_px > settings->orientation_min_px;
    edge->heading_deg = edge->has_heading ? heading_deg(left.point, right.point) : 0.0f;
}

goe_status_t goe_edge_find(const goe_settings_t *settings, const goe_image_t *image, const goe_view_t *view,
                           goe_edges_t *edges) {
    const corner_t left = {&image->base_left, &view->base_left};
    const corner_t near = {&image->base_near, &view->base_near};
    const corner_t right = {&image->base_right, &view->base_right};
    edges->count = 0;
    if (!in_order(left.point, near.point) || !in_order(near.point, right.point) || !in_order(left.point, right.point)) {
        return GOE_SWAPPED;
    }
    if (near.point->usable) {
        add_edge(settings, left, near, edges);
        add_edge(settings, near, right, edges);
    } else {
        add_edge(settings, left, right, edges);
    }
    return GOE_OK;
}
