/* A straight flight past a mast. SPDX-License-Identifier: MIT */
#include "scripted_flight.h"

#include <stdio.h>
#include <string.h>

#define SPEED_M_S 18.0f /* north */
#define METERS_PER_TICK 0.36f
#define HEIGHT_M 40.0f
#define MAST_NORTH_M 230.0f
#define MAST_EAST_M 10.0f
#define MAST_WIDTH_M 6.0f
#define MAST_HEIGHT_M 60.0f
#define NEAREST_M 5.0f /* nearer than this it is out of the image */

#define FOCAL_PX 500.0f
#define WIDTH_PX 640.0f
#define HEIGHT_PX 480.0f
#define TIME_SD_US 3000u

#define SILENT_BEGIN_TICK 126u /* no image arrives after 2.5 s and before 4 s */
#define SILENT_END_TICK 200u

void scripted_settings(goe_settings_t *settings) {
    goe_settings_default(settings);
    settings->camera.fx_px = settings->camera.fy_px = FOCAL_PX;
    settings->camera.cx_px = 0.5f * WIDTH_PX;
    settings->camera.cy_px = 0.5f * HEIGHT_PX;
    settings->camera.width_px = WIDTH_PX;
    settings->camera.height_px = HEIGHT_PX;
}

static float north_m(uint32_t tick) { return METERS_PER_TICK * (float)tick; }

void scripted_pose(uint32_t tick, scripted_pose_t *pose) {
    memset(pose, 0, sizeof *pose);
    pose->attitude.time_us = pose->position.time_us = tick * SCRIPTED_TICK_US;
    pose->attitude.q[0] = 1.0f; /* level, heading north */
    pose->position.position_ned_m[0] = north_m(tick);
    pose->position.position_ned_m[2] = -HEIGHT_M;
    pose->position.velocity_ned_m_s[0] = SPEED_M_S;
    pose->position.height_m[GOE_FLIGHT_TERRAIN] = HEIGHT_M;
    pose->position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
}

/* A detector draws whole pixels, within the image. */
static float drawn_px(float px, float size_px) {
    if (px < 0.0f) {
        return 0.0f;
    }
    return px > size_px ? size_px : (float)(int32_t)(px + 0.5f);
}

static bool see_mast(uint32_t tick, goe_box_t *box) {
    const float ahead_m = MAST_NORTH_M - north_m(tick);
    const float left_m = MAST_EAST_M - 0.5f * MAST_WIDTH_M;
    const float right_m = MAST_EAST_M + 0.5f * MAST_WIDTH_M;
    if (ahead_m < NEAREST_M || FOCAL_PX * left_m / ahead_m > 0.5f * WIDTH_PX) {
        return false;
    }
    box->left_px = drawn_px(0.5f * WIDTH_PX + FOCAL_PX * left_m / ahead_m, WIDTH_PX);
    box->right_px = drawn_px(0.5f * WIDTH_PX + FOCAL_PX * right_m / ahead_m, WIDTH_PX);
    box->top_px = drawn_px(0.5f * HEIGHT_PX + FOCAL_PX * (HEIGHT_M - MAST_HEIGHT_M) / ahead_m, HEIGHT_PX);
    box->bottom_px = drawn_px(0.5f * HEIGHT_PX + FOCAL_PX * HEIGHT_M / ahead_m, HEIGHT_PX);
    box->sides = GOE_SIDES_ALL;
    return true;
}

bool scripted_image(uint32_t tick, scripted_image_t *image) {
    if (tick < SCRIPTED_DELAY_TICKS || (tick - SCRIPTED_DELAY_TICKS) % SCRIPTED_IMAGE_TICKS != 0u) {
        return false;
    }
    if (tick >= SILENT_BEGIN_TICK && tick < SILENT_END_TICK) {
        return false;
    }
    const uint32_t exposed = tick - SCRIPTED_DELAY_TICKS;
    memset(image, 0, sizeof *image);
    image->frame.arrival_us = tick * SCRIPTED_TICK_US;
    image->frame.capture_us = exposed * SCRIPTED_TICK_US;
    image->frame.time_sd_us = TIME_SD_US;
    image->frame.time_base = GOE_FLIGHT_AUTOPILOT_CLOCK;
    if (see_mast(exposed, &image->detection.box)) {
        image->frame.number = image->frame.count = 1u;
        image->detection.score = 0.9f;
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- line -- */

typedef struct {
    char *text;
    size_t used;
} line_t;

static void add_text(line_t *line, const char *text) {
    while (*text != '\0' && line->used + 1u < SCRIPTED_LINE) {
        line->text[line->used++] = *text++;
    }
    line->text[line->used] = '\0';
}

/* " -12.3 m": a number and its unit, to a tenth. */
static void add_number(line_t *line, float number, const char *unit) {
    char text[24];
    const float size = number < 0.0f ? -number : number;
    const unsigned tenths = (unsigned)(size * 10.0f + 0.5f);
    (void)snprintf(text, sizeof text, " %s%u.%u ", number < 0.0f && tenths > 0u ? "-" : "", tenths / 10u, tenths % 10u);
    add_text(line, text);
    add_text(line, unit);
}

static void add_obstacle(line_t *line, const goe_flight_obstacle_t *obstacle) {
    add_text(line, ": at");
    add_number(line, obstacle->center_ned_m[0], "m north");
    add_number(line, obstacle->center_ned_m[1], "m east,");
    add_number(line, obstacle->width_m, "m wide,");
    add_number(line, obstacle->height_m, "m high;");
}

void scripted_line(const goe_flight_t *flight, uint32_t now_us, const goe_flight_assessment_t *assessment,
                   char text[SCRIPTED_LINE]) {
    line_t line = {text, 0u};
    goe_flight_obstacle_t obstacle;
    add_number(&line, 1e-6f * (float)now_us, "s");
    if (goe_flight_obstacle(flight, assessment->worst, &obstacle) == GOE_FLIGHT_OK) {
        add_obstacle(&line, &obstacle);
        add_text(&line, " in");
        add_number(&line, assessment->hazard.tcpa_s, "s");
        add_number(&line, assessment->hazard.dcpa_m, "m aside;");
    } else {
        add_text(&line, assessment->detector_alive ? ": clear;" : ": nothing known;");
    }
    add_text(&line, assessment->detector_alive ? "" : " no detector;");
    add_text(&line, " action ");
    add_text(&line, goe_flight_action_text(assessment->action));
}
