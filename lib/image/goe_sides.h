/* The sides of an upright bounding box: which of them are measured. SPDX-License-Identifier: MIT */
#ifndef GOE_SIDES_H
#define GOE_SIDES_H

#include "image/goe_fault.h"
#include "image/goe_view.h"

/* Sets view->sides from view->image->box: sides at the image's border, or out of order (GOE_SWAPPED), are not usable. */
void goe_sides_read(const goe_camera_t *camera, goe_view_t *view, goe_faults_t *faults);

/* Leftmost, rightmost and highest point of the obstacle for methods that use points only: the box of an obstacle whose verticals
 * lean in the image, turned back about its middle. Sets left, right and top where the sides determine them; the others become
 * invisible. Needs view->camera_to_trajectory. */
void goe_sides_points(const goe_camera_t *camera, const goe_view_t *view, goe_pixel_t *left, goe_pixel_t *right,
                      goe_pixel_t *top);

#endif
