/* A landing approach towards a building, and the image from which on it must be broken off. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "goe.h"

#define FOCAL_PX 800.0f
#define WIDTH_PX 1280.0f
#define HEIGHT_PX 960.0f
#define SPEED_M_S 20.0f
#define SINK_M_S 1.0f
#define START_HEIGHT_M 30.0f
#define IMAGES_PER_S 8.0f
#define IMAGE_US 125000
#define IMAGES 180

#define BUILDING_NORTH_M 430.0f /* its near wall */
#define BUILDING_LEFT_M (-4.0f) /* its ends, east of the path */
#define BUILDING_RIGHT_M 10.0f
#define BUILDING_TOP_M 12.0f

#define MARGIN_M 15.0f    /* aside */
#define CLEARANCE_M 10.0f /* over the top */
#define LATENCY_S 0.1f    /* from the exposure to this decision */

static goe_estimator_t building;

static void take_image(int k, goe_image_t *image) {
    const float flown_s = (float)k / IMAGES_PER_S;
    const float height_m = START_HEIGHT_M - SINK_M_S * flown_s;
    const float ahead_m = BUILDING_NORTH_M - SPEED_M_S * flown_s;
    image->pose.time_us = (int64_t)k * IMAGE_US;
    image->pose.position_ned_m[0] = SPEED_M_S * flown_s;
    image->pose.position_ned_m[2] = -height_m;
    image->pose.height_m = height_m;
    image->pose.attitude[0] = 1.0f;
    image->box.left_px = 0.5f * WIDTH_PX + FOCAL_PX * BUILDING_LEFT_M / ahead_m;
    image->box.right_px = 0.5f * WIDTH_PX + FOCAL_PX * BUILDING_RIGHT_M / ahead_m;
    image->box.top_px = 0.5f * HEIGHT_PX + FOCAL_PX * (height_m - BUILDING_TOP_M) / ahead_m;
    image->box.bottom_px = 0.5f * HEIGHT_PX + FOCAL_PX * height_m / ahead_m;
    image->box.sides = GOE_SIDES_ALL;
}

int main(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = 0.5f * WIDTH_PX;
    settings.camera.cy_px = 0.5f * HEIGHT_PX;
    settings.camera.width_px = WIDTH_PX;
    settings.camera.height_px = HEIGHT_PX;
    if (goe_init(&building, sizeof building, &settings, NULL) != GOE_OK) {
        return 1;
    }
    const goe_intent_t intent = {.velocity_ned_m_s = {SPEED_M_S, 0.0f, SINK_M_S},
                                 .margin_m = MARGIN_M,
                                 .clearance_m = CLEARANCE_M,
                                 .since_image_s = LATENCY_S};
    bool order = false;
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image = {0};
        goe_estimate_t now;
        goe_hazard_t hazard;
        take_image(k, &image);
        (void)goe_update(&building, &image, &now); /* a fault leaves the last good estimate */
        const goe_decision_t decision = goe_decide(&building, &intent, NULL, &hazard);
        order = decision == GOE_DECISION_ACT || (order && decision != GOE_DECISION_CLEAR);
        if ((order || k % 8 == 0) && (now.valid & GOE_HAS_POSITION) != 0u) {
            printf("%4.1f s: in %4.1f +- %3.1f s %3.0f m past it, %3.0f m over its top; margins violated: %3.0f %%%s\n",
                   (double)((float)k / IMAGES_PER_S), (double)hazard.tcpa_s, (double)hazard.tcpa_sd_s,
                   (double)hazard.dcpa_m, (double)hazard.clearance_m, (double)(100.0f * hazard.conflict_probability),
                   order ? ": GO AROUND" : "");
        }
        if (order) {
            break;
        }
    }
    return 0;
}
