/* Flies towards a mast of 6 m by 30 m, 200 m ahead, and prints its estimate. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "goe.h"

#define FOCAL_PX 914.0f
#define CENTER_PX 640.0f
#define IMAGES 60

static goe_estimator_t mast; /* one per obstacle, all the memory there is */

static void look(int k, goe_image_t *image) {
    const float ahead_m = 200.0f - 2.0f * (float)k;
    image->pose.time_us = INT64_C(125000) * k;
    image->pose.position_ned_m[0] = 2.0f * (float)k;
    image->pose.height_m = 15.0f;
    image->pose.attitude[0] = 1.0f;
    image->box.left_px = CENTER_PX - FOCAL_PX * 3.0f / ahead_m;
    image->box.right_px = CENTER_PX + FOCAL_PX * 3.0f / ahead_m;
    image->box.top_px = CENTER_PX - FOCAL_PX * 15.0f / ahead_m;
    image->box.bottom_px = CENTER_PX + FOCAL_PX * 15.0f / ahead_m;
    image->box.sides = GOE_SIDES_ALL;
}

void app_main(void);

void app_main(void) {
    goe_settings_t settings;
    const char *bad = NULL;
    printf("self check: 0x%02X\n", goe_self_check());
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = settings.camera.cy_px = CENTER_PX;
    settings.camera.width_px = settings.camera.height_px = 2.0f * CENTER_PX;
    if (goe_init(&mast, sizeof mast, &settings, &bad) != GOE_OK) {
        printf("bad setting: %s\n", bad ? bad : "another library than this header's");
        return;
    }
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image = {0};
        goe_estimate_t now;
        look(k, &image);
        const goe_status_t status = goe_update(&mast, &image, &now);
        if (now.valid & GOE_HAS_POSITION) {
            printf("%s: %.1f m ahead, one sigma %.1f\n", goe_status_text(status), (double)now.z_m,
                   (double)now.sigma.z_m);
        } else {
            printf("%s\n", goe_status_text(status));
        }
    }
}
