/* Rotation of image points into T: the ego-motion transformation of Section 2. SPDX-License-Identifier: MIT */
#include "image/goe_align.h"

#include <math.h>
#include <string.h>

#include "image/goe_camera.h"
#include "image/goe_sides.h"
#include "maths/goe_scalar.h"

#define FORWARD_MIN 0.05f /* least third component of a unit ray in T: beyond 87 degrees nothing can be aligned */

/* For an image with a box: its sides replace the points left, right and top. */
static void replace_points(const goe_camera_t *camera, goe_view_t *view, goe_pixel_t pixels[GOE_FEATURES],
                           goe_faults_t *faults) {
    memcpy(pixels, goe_image_pixels(view->image), GOE_FEATURES * sizeof pixels[0]);
    view->seen = (view->image->box.sides & GOE_SIDES_ALL) != 0;
    goe_sides_read(camera, view, faults);
    goe_sides_points(camera, view, &pixels[GOE_POINT_LEFT], &pixels[GOE_POINT_RIGHT], &pixels[GOE_POINT_TOP]);
}

/* Rotation and camera are copied first: the compiler does not know that writing the points leaves them unchanged. */
void goe_align_points(const goe_camera_t *camera, goe_view_t *view, goe_faults_t *faults) {
    goe_pixel_t replaced[GOE_FEATURES];
    const goe_pixel_t *pixels = goe_image_pixels(view->image);
    memset(&view->sides, 0, sizeof view->sides);
    view->seen = false;
    if (view->image->box.sides != 0) {
        replace_points(camera, view, replaced, faults);
        pixels = replaced;
    }
    const float *r = view->camera_to_trajectory;
    const float xx = r[0], xy = r[1], xz = r[2];
    const float yx = r[3], yy = r[4], yz = r[5];
    const float zx = r[6], zy = r[7], zz = r[8];
    const float cx_px = camera->cx_px, cy_px = camera->cy_px, fx_px = camera->fx_px, fy_px = camera->fy_px;
    const bool distorts = goe_camera_distorts(camera);
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        const goe_pixel_t *pixel = &pixels[i];
        goe_point_t *point = &view->point[i];
        if (!goe_is_set(&pixel->visible)) {
            point->usable = false;
            continue;
        }
        view->seen = true;
        float x = (pixel->u_px - cx_px) / fx_px;
        float y = (pixel->v_px - cy_px) / fy_px;
        if (distorts) {
            float ray[2] = {x, y}; /* its own array: x and y stay in registers */
            if (!goe_camera_undistort(camera, &ray[0], &ray[1])) {
                point->usable = false;
                goe_fault_count(faults, GOE_LENS_FAILED);
                continue;
            }
            x = ray[0];
            y = ray[1];
        }
        const float forward = zx * x + zy * y + zz;
        if (!(forward > FORWARD_MIN * sqrtf(x * x + y * y + 1.0f))) {
            point->usable = false;
            goe_fault_count(faults, GOE_BEHIND_CAMERA);
            continue;
        }
        point->x = (xx * x + xy * y + xz) / forward;
        point->y = (yx * x + yy * y + yz) / forward;
        point->usable = true;
    }
}
