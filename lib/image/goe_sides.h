/* The sides of an upright bounding box: which are measured, and the points that they give. SPDX-License-Identifier: MIT */
#ifndef GOE_SIDES_H
#define GOE_SIDES_H

#include "image/goe_fault.h"
#include "image/goe_view.h"

/* Sets view->sides from view->image->box. Sides at the image's border, or out of order (GOE_SWAPPED), are not usable. */
void goe_sides_read(const goe_camera_t *camera, goe_view_t *view, goe_faults_t *faults);

/* Computes the leftmost, rightmost and highest point of the obstacle, for methods that use points only. If the obstacle's verticals lean in
 * the image, the box is turned back about its middle. Sets left, right and top if the sides determine them; the others become invisible.
 * Needs view->camera_to_trajectory. */
void goe_sides_points(const goe_camera_t *camera, const goe_view_t *view, goe_pixel_t *left, goe_pixel_t *right,
                      goe_pixel_t *top);

#endif
