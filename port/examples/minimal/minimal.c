/* The least that works: one camera, one obstacle, its box in every image. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "goe.h"

#define FOCAL_PX 500.0f
#define WIDTH_PX 640.0f
#define HEIGHT_PX 480.0f
#define FLYING_HEIGHT_M 20.0f
#define FLOWN_M 2.0f /* from image to image */
#define IMAGE_US 100000
#define IMAGES 40

static goe_estimator_t chimney; /* one per obstacle, all the memory there is */

/* Replace this by your autopilot and your detector; here a chimney 5 m wide and 35 m high, straight ahead. */
static void take_image(int k, goe_image_t *image) {
    const float ahead_m = 150.0f - FLOWN_M * (float)k;
    image->pose.time_us = (int64_t)k * IMAGE_US;
    image->pose.position_ned_m[0] = FLOWN_M * (float)k;
    image->pose.position_ned_m[2] = -FLYING_HEIGHT_M;
    image->pose.height_m = FLYING_HEIGHT_M;
    image->pose.attitude[0] = 1.0f; /* level, heading north */
    image->box.left_px = 0.5f * WIDTH_PX - FOCAL_PX * 2.5f / ahead_m;
    image->box.right_px = 0.5f * WIDTH_PX + FOCAL_PX * 2.5f / ahead_m;
    image->box.top_px = 0.5f * HEIGHT_PX - FOCAL_PX * (35.0f - FLYING_HEIGHT_M) / ahead_m;
    image->box.bottom_px = 0.5f * HEIGHT_PX + FOCAL_PX * FLYING_HEIGHT_M / ahead_m;
    image->box.sides = GOE_SIDES_ALL;
}

int main(void) {
    goe_settings_t settings;
    const char *bad = NULL;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = 0.5f * WIDTH_PX;
    settings.camera.cy_px = 0.5f * HEIGHT_PX;
    settings.camera.width_px = WIDTH_PX;
    settings.camera.height_px = HEIGHT_PX;
    if (goe_init(&chimney, sizeof chimney, &settings, &bad) != GOE_OK) {
        printf("bad setting: %s\n", bad != NULL ? bad : "compiled with other limits than the library");
        return 1;
    }
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image = {0};
        goe_estimate_t now;
        take_image(k, &image);
        const goe_status_t status = goe_update(&chimney, &image, &now);
        if (k % 8 != 7) {
            continue;
        }
        printf("image %2d, %s:", k, goe_status_text(status));
        if (now.valid & GOE_HAS_POSITION) {
            printf(" %.0f +- %.0f m ahead", (double)now.z_m, (double)now.sigma.z_m);
        }
        if (now.valid & GOE_HAS_HEIGHT) {
            printf(", %.0f +- %.0f m high", (double)now.height_m, (double)now.sigma.height_m);
        }
        if (now.suspect) {
            printf(", suspect: %s", goe_reason_text(now.reason)); /* the sigmas may be too small: widen your margins */
        }
        printf("\n");
    }
    return 0;
}
