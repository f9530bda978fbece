/* Drawn flights. SPDX-License-Identifier: MIT */
#include "drawn.h"

#include <math.h>

#define RAD_PER_DEG 0.017453292519943295
#define BOX_MEMORY_S 1.2 /* of a detector's errors */
#define POINT_PX 0.5
#define IMAGE_PX 1280.0f

drawn_t drawn_flight(scene_t *scene, check_random_t *any) {
    scene_default(scene);
    scene->shape = check_random_bits(any) % 2u == 0u ? SCENE_CYLINDER : SCENE_BOX;
    scene->width_m = exp(check_random_between(any, log(2.5), log(30.0)));
    scene->length_m = scene->width_m * check_random_between(any, 0.4, 2.5);
    scene->alpha_deg = check_random_between(any, -45.0, 45.0);
    scene->altitude_m = check_random_between(any, 15.0, 40.0);
    scene->height_m = scene->altitude_m + check_random_between(any, 0.0, 30.0);
    scene->x0_m = check_random_between(any, -0.3, 0.3) * scene->width_m;
    scene->z0_m = check_random_between(any, 160.0, 250.0);
    scene->speed_mps = check_random_between(any, 10.0, 20.0);
    scene->image_rate_hz = DRAWN_RATE_HZ;
    scene->roll_swing_deg = check_random_bits(any) % 2u == 0u ? 0.0 : check_random_between(any, 0.0, 10.0);
    scene->roll_swing_hz = check_random_between(any, 0.1, 0.25);
    const unsigned features = check_random_bits(any) % 3u;
    drawn_t drawn = {features != 1u, features != 0u, check_random_bits(any) % 2u == 0u ? 0.02 : 0.07, {0.0}};
    for (int i = 0; i < 4; i++) {
        drawn.error[i] = check_random_normal(any);
    }
    return drawn;
}

/* The errors of the sides go on from image to image. */
static void spoil_box(drawn_t *drawn, check_random_t *any, goe_box_t *box) {
    float *const side[4] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    const double size[2] = {(double)(box->right_px - box->left_px), (double)(box->bottom_px - box->top_px)};
    const double kept = exp(-1.0 / DRAWN_RATE_HZ / BOX_MEMORY_S);
    for (int i = 0; i < 4; i++) {
        drawn->error[i] = kept * drawn->error[i] + sqrt(1.0 - kept * kept) * check_random_normal(any);
        *side[i] += (float)(drawn->box_share * size[i % 2] * drawn->error[i] + check_random_normal(any));
        *side[i] = fminf(fmaxf(*side[i], 0.0f), IMAGE_PX - 1.0f);
    }
}

void drawn_image(drawn_t *drawn, scene_t *scene, check_random_t *any, int k, goe_image_t *image) {
    scene_image(scene, k, image, NULL);
    scene_add_noise(image, any, POINT_PX);
    if (drawn->boxes) {
        goe_image_t boxed;
        scene->boxes = true;
        scene_image(scene, k, &boxed, NULL);
        scene->boxes = false;
        image->box = boxed.box;
        if (!drawn->points) {
            scene_hide_points(image);
        }
        spoil_box(drawn, any, &image->box);
    }
}

double drawn_left_s(const scene_t *scene, int k) {
    const double turned = fabs(sin(scene->alpha_deg * RAD_PER_DEG));
    const double reach_m =
        0.5 * scene->width_m * (scene->shape == SCENE_CYLINDER ? 1.0 : turned); /* nearer than z0_m */
    return (scene->z0_m - reach_m) / scene->speed_mps - k / DRAWN_RATE_HZ;
}
