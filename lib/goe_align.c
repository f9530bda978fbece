/* Alignment: the ego-motion transformation of Section 2. SPDX-License-Identifier: MIT */
#include "goe_align.h"

#include <math.h>

#include "goe_camera.h"

#define FORWARD_MIN 0.05f /* third component of a unit ray in T: farther aside than 87 degrees nothing can be aligned */

typedef struct {
    const goe_camera_t *camera;
    const float *rotation; /* camera -> T */
    bool undistorts;
} aligner_t;

static goe_status_t align(const aligner_t *aligner, const goe_pixel_t *pixel, goe_point_t *point) {
    const float *r = aligner->rotation;
    float x;
    float y;
    if (!goe_camera_ray(aligner->camera, aligner->undistorts, pixel, &x, &y)) {
        return GOE_LENS_FAILED;
    }
    const float forward = r[6] * x + r[7] * y + r[8];
    if (forward <= FORWARD_MIN * sqrtf(x * x + y * y + 1.0f)) {
        return GOE_BEHIND_CAMERA;
    }
    point->x = (r[0] * x + r[1] * y + r[2]) / forward;
    point->y = (r[3] * x + r[4] * y + r[5]) / forward;
    point->usable = true;
    return GOE_OK;
}

static void align_if_seen(const aligner_t *aligner, const goe_pixel_t *pixel, goe_point_t *point,
                          goe_faults_t *faults) {
    point->usable = false;
    if (pixel->seen) {
        goe_fault_note(faults, align(aligner, pixel, point));
    }
}

void goe_align_view(const goe_camera_t *camera, const float camera_to_trajectory[9], const goe_image_t *image,
                    goe_view_t *view, goe_faults_t *faults) {
    const aligner_t aligner = {camera, camera_to_trajectory, goe_camera_distorts(camera)};
    align_if_seen(&aligner, &image->left, &view->left, faults);
    align_if_seen(&aligner, &image->right, &view->right, faults);
    align_if_seen(&aligner, &image->top, &view->top, faults);
    align_if_seen(&aligner, &image->base_left, &view->base_left, faults);
    align_if_seen(&aligner, &image->base_near, &view->base_near, faults);
    align_if_seen(&aligner, &image->base_right, &view->base_right, faults);
}
