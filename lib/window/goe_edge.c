/* Edges: (1) and the gates of Section 4. SPDX-License-Identifier: MIT */
#include "window/goe_edge.h"

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_WINDOW

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

/* edge->left and edge->right are usable; from and to are their pixels. */
static void measure_edge(const goe_settings_t *settings, const goe_pixel_t *from, const goe_pixel_t *to,
                         goe_edge_t *edge) {
    const goe_point_t *left = edge->left;
    const goe_point_t *right = edge->right;
    const float du = to->u_px - from->u_px;
    const float dv = to->v_px - from->v_px;
    const float rise_px = goe_absolute(right->y - left->y) * settings->camera.fx_px;
    edge->counts = du * du + dv * dv > settings->window.edge_min_px * settings->window.edge_min_px;
    edge->has_heading = edge->counts && rise_px > settings->window.orientation_min_px;
    edge->heading_deg = edge->has_heading ? heading_deg(left, right) : 0.0f;
}

static void add_edge(const goe_settings_t *settings, const goe_pixel_t *from_px, const goe_point_t *from,
                     const goe_pixel_t *to_px, const goe_point_t *to, goe_edges_t *edges) {
    if (from->usable && to->usable) {
        goe_edge_t *edge = &edges->edge[edges->count++];
        edge->left = from;
        edge->right = to;
        measure_edge(settings, from_px, to_px, edge);
    }
}

goe_status_t goe_edge_find(const goe_settings_t *settings, const goe_view_t *view, goe_edges_t *edges) {
    const goe_image_t *image = view->image;
    const goe_point_t *left = &view->point[GOE_POINT_BASE_LEFT];
    const goe_point_t *corner = &view->point[GOE_POINT_BASE_NEAR];
    const goe_point_t *right = &view->point[GOE_POINT_BASE_RIGHT];
    edges->count = 0;
    if (corner->usable) {
        if (!in_order(left, corner) || !in_order(corner, right)) {
            return GOE_SWAPPED;
        }
        add_edge(settings, &image->base_left, left, &image->base_near, corner, edges);
        add_edge(settings, &image->base_near, corner, &image->base_right, right, edges);
    } else {
        if (!in_order(left, right)) {
            return GOE_SWAPPED;
        }
        add_edge(settings, &image->base_left, left, &image->base_right, right, edges);
    }
    return GOE_OK;
}

#endif
