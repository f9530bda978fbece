/* Rotation of image points into T: the ego-motion transformation of Section 2. SPDX-License-Identifier: MIT */
#ifndef GOE_ALIGN_H
#define GOE_ALIGN_H

#include "image/goe_fault.h"
#include "image/goe_view.h"

/* Sets view->point, view->sides and view->seen from view->image and view->camera_to_trajectory. A box replaces left, right and top. A
 * feature that is not visible, or that causes GOE_BEHIND_CAMERA or GOE_LENS_FAILED, is not usable. */
void goe_align_points(const goe_camera_t *camera, goe_view_t *view, goe_faults_t *faults);

#endif
