/* Edges of the obstacle's base: their heading (1), and the gates of Section 4. SPDX-License-Identifier: MIT */
#include "window/goe_edge.h"

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_WINDOW

/*@ requires goe_view_is_open(view) && left < GOE_FEATURES && right < GOE_FEATURES; */
static bool in_order(const goe_view_t *view, goe_feature_t left, goe_feature_t right) {
    const goe_point_t *point = view->point;
    return !point[left].usable || !point[right].usable || point[left].x <= point[right].x;
}

/* (1). The edge through a and b meets the horizon y = 0 at x_a - y_a (x_b - x_a)/(y_b - y_a). This is x/z of the vector below, which needs
 * no division: an edge parallel to the horizon has no Z component. */
static float heading_deg(const goe_point_t *a, const goe_point_t *b) {
    const float x = a->x * b->y - a->y * b->x;
    const float z = b->y - a->y;
    const float rad = z < 0.0f ? goe_arctan_rad(-x, -z) : goe_arctan_rad(x, z);
    return goe_fold_deg(rad * GOE_DEG_PER_RAD);
}

/* edge->left and edge->right must be usable; from and to are their pixels. */
static void measure_edge(const goe_settings_t *settings, float fx_px, const goe_pixel_t *from, const goe_pixel_t *to,
                         goe_edge_t *edge) {
    const goe_point_t *left = edge->left;
    const goe_point_t *right = edge->right;
    const float du = to->u_px - from->u_px;
    const float dv = to->v_px - from->v_px;
    const float rise_px = goe_absolute(right->y - left->y) * fx_px;
    edge->counts = du * du + dv * dv > settings->window.edge_min_px * settings->window.edge_min_px;
    edge->has_heading = edge->counts && rise_px > settings->window.orientation_min_px;
    edge->heading_deg = edge->has_heading ? heading_deg(left, right) : 0.0f;
}

/*@ requires \valid_read(settings) && goe_view_is_open(view) && \valid(edges);
    requires from < GOE_FEATURES && to < GOE_FEATURES && 0 <= edges->count < 2; */
static void add_edge(const goe_settings_t *settings, const goe_view_t *view, goe_feature_t from, goe_feature_t to,
                     goe_edges_t *edges) {
    const goe_pixel_t *pixels = goe_image_pixels(view->image);
    if (view->point[from].usable && view->point[to].usable) {
        goe_edge_t *edge = &edges->edge[edges->count++];
        edge->left = &view->point[from];
        edge->right = &view->point[to];
        measure_edge(settings, view->camera->fx_px, &pixels[from], &pixels[to], edge);
    }
}

goe_status_t goe_edge_find(const goe_settings_t *settings, const goe_view_t *view, goe_edges_t *edges) {
    const bool near_corner = view->point[GOE_POINT_BASE_NEAR].usable;
    const goe_feature_t end = near_corner ? GOE_POINT_BASE_NEAR : GOE_POINT_BASE_RIGHT; /* end of the first edge */
    edges->count = 0;
    if (!in_order(view, GOE_POINT_BASE_LEFT, end) || !in_order(view, end, GOE_POINT_BASE_RIGHT)) {
        return GOE_SWAPPED;
    }
    add_edge(settings, view, GOE_POINT_BASE_LEFT, end, edges);
    if (near_corner) {
        add_edge(settings, view, GOE_POINT_BASE_NEAR, GOE_POINT_BASE_RIGHT, edges);
    }
    return GOE_OK;
}

#endif
