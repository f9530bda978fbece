/* Long walls, whose ends the image does not show: CLEAR never names a wall passed that still is next to the aircraft, or ahead. The boxes
 * are exact and clipped at the image's border, the camera is level. SPDX-License-Identifier: MIT */
/* tests: lib/goe_estimator.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe.h"

#define IMAGE_PX 1280.0
#define FOCAL_PX 914.0
#define PERIOD_S 0.1
#define STEP_M 0.25
#define NEAREST_M 0.2
#define WALL_HEIGHT_M 25.0
#define RAD_PER_DEG (3.14159265358979323846 / 180.0)

/* A wall in axes of the aircraft's course: ahead and to the right of the start, m; turned about its middle. */
typedef struct {
    double ahead_m, right_m, across_m, along_m, turned_rad;
} wall_t;

typedef struct {
    double camera_right_deg; /* the camera looks to the right of the course */
    double altitude_m, speed_m_s;
    float margin_m;
    double wrong_m; /* a wall nearer than this is not clear */
} flight_t;

static goe_estimator_t estimator;
static goe_image_t image;

void setUp(void) {}
void tearDown(void) {}

/* A point of the outline, by its place from 0 to 1 along the perimeter: ahead and to the right. */
static void outline(const wall_t *wall, double share, double at[2]) {
    const double side = 4.0 * share;
    const double part = side - floor(side) - 0.5;
    const double half[2] = {0.5 * wall->along_m, 0.5 * wall->across_m};
    const double along[4] = {2.0 * part, 1.0, -2.0 * part, -1.0};
    const double across[4] = {1.0, -2.0 * part, -1.0, 2.0 * part};
    const int which = (int)side & 3;
    const double x = across[which] * half[1];
    const double z = along[which] * half[0];
    const double c = cos(wall->turned_rad);
    const double s = sin(wall->turned_rad);
    at[0] = wall->ahead_m + c * z - s * x;
    at[1] = wall->right_m + s * z + c * x;
}

static double clipped(double px) { return fmin(fmax(px, 0.0), IMAGE_PX - 1.0); }

/* Sets the visible box with the bits of all sides, and returns the distance of the wall. */
static double look(const wall_t *wall, const flight_t *flight, double flown_m) {
    const double c = cos(flight->camera_right_deg * RAD_PER_DEG);
    const double s = sin(flight->camera_right_deg * RAD_PER_DEG);
    const int count = 4 * (int)(fmax(wall->along_m, wall->across_m) / STEP_M);
    double box[4] = {1.0e6, 1.0e6, -1.0e6, -1.0e6};
    double distance_m = 1.0e6;
    for (int i = 0; i < count; i++) {
        double at[2];
        outline(wall, (double)i / count, at);
        at[0] -= flown_m;
        distance_m = fmin(distance_m, hypot(at[0], at[1]));
        const double z = c * at[0] + s * at[1];
        const double x = c * at[1] - s * at[0];
        if (z < NEAREST_M) {
            continue;
        }
        const double u = 0.5 * IMAGE_PX + FOCAL_PX * x / z;
        const double top = 0.5 * IMAGE_PX + FOCAL_PX * (flight->altitude_m - WALL_HEIGHT_M) / z;
        const double low = 0.5 * IMAGE_PX + FOCAL_PX * flight->altitude_m / z;
        box[0] = fmin(box[0], u);
        box[1] = fmin(box[1], top);
        box[2] = fmax(box[2], u);
        box[3] = fmax(box[3], low);
    }
    const bool seen = box[0] < IMAGE_PX - 1.0 && box[2] > 0.0;
    image.box.left_px = (float)clipped(box[0]);
    image.box.top_px = (float)clipped(box[1]);
    image.box.right_px = (float)clipped(box[2]);
    image.box.bottom_px = (float)clipped(box[3]);
    image.box.sides = seen ? GOE_SIDES_ALL : 0u;
    return distance_m;
}

static void take(const flight_t *flight, int k, double flown_m) {
    goe_estimate_t estimate;
    image.pose.time_us = 1000000 + (int64_t)(k * 1.0e6 * PERIOD_S);
    image.pose.position_ned_m[0] = (float)flown_m;
    image.pose.position_ned_m[2] = (float)-flight->altitude_m;
    image.pose.height_m = (float)flight->altitude_m;
    image.pose.attitude[0] = (float)cos(0.5 * flight->camera_right_deg * RAD_PER_DEG);
    image.pose.attitude[3] = (float)sin(0.5 * flight->camera_right_deg * RAD_PER_DEG);
    (void)goe_update(&estimator, &image, &estimate);
}

static void start(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = (float)FOCAL_PX;
    settings.camera.cx_px = settings.camera.cy_px = 0.5f * (float)IMAGE_PX;
    settings.camera.width_px = settings.camera.height_px = (float)IMAGE_PX;
    memset(&image, 0, sizeof image);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

/* Flies from 0 to `to_m`, and counts the images after which the decision is wrongly CLEAR. acted: images with ACT. */
static int wrongly_clear(const wall_t *wall, const flight_t *flight, double to_m, int *acted) {
    const goe_intent_t intent = {{(float)flight->speed_m_s, 0.0f, 0.0f}, flight->margin_m, 5.0f, 0.0f, 0.0f};
    int clear = 0;
    start();
    for (int k = 0; k * PERIOD_S * flight->speed_m_s < to_m; k++) {
        const double flown_m = k * PERIOD_S * flight->speed_m_s;
        const double distance_m = look(wall, flight, flown_m);
        take(flight, k, flown_m);
        const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
        clear += decision == GOE_DECISION_CLEAR && distance_m < flight->wrong_m ? 1 : 0;
        *acted += decision == GOE_DECISION_ACT ? 1 : 0;
    }
    return clear;
}

/* GIVEN a wall from its end, whose length no image shows WHEN the aircraft flies along it, and the image shows the part that is ahead THEN no estimate that lies behind the camera clears the course. */
static void a_wall_alongside_is_not_passed(void) {
    int flights = 0;
    int acted = 0;
    for (double long_m = 40.0; long_m <= 120.0; long_m += 20.0) {
        for (double aside_m = 2.0; aside_m <= 5.0; aside_m += 1.0) {
            for (double speed_m_s = 5.0; speed_m_s <= 20.0; speed_m_s += 5.0) {
                const wall_t wall = {80.0 + 0.5 * long_m, aside_m + 1.5, 3.0, long_m, 0.0};
                const flight_t flight = {0.0, 12.0, speed_m_s, 12.0f, 12.0};
                TEST_ASSERT_EQUAL_INT(0, wrongly_clear(&wall, &flight, 80.0 + long_m - 10.0, &acted));
                flights++;
            }
        }
    }
    check_report("flights along a wall", flights);
    check_report("images with ACT", acted);
    TEST_ASSERT_TRUE(acted > 10 * flights);
}

/* GIVEN a camera that looks far aside, and a wall across the course WHEN its box fills the image, so that no side is measured, and the
 * estimate of its middle is passed THEN nothing is clear: the end toward the course is not known. */
static void a_wall_that_fills_the_image_may_reach_the_course(void) {
    int flights = 0;
    int acted = 0;
    for (double looks_deg = -60.0; looks_deg <= 60.0; looks_deg += 10.0) {
        for (double turned_rad = -0.6; turned_rad < 0.7; turned_rad += 0.3) {
            for (double right_m = -8.0; right_m <= 8.0; right_m += 4.0) {
                const wall_t wall = {80.0, right_m, 20.0, 4.0, turned_rad};
                const flight_t flight = {looks_deg, 15.0, 10.0, 10.0f, 10.0};
                TEST_ASSERT_EQUAL_INT(0, wrongly_clear(&wall, &flight, 80.0 + right_m * tan(turned_rad) - 5.0, &acted));
                flights++;
            }
        }
    }
    check_report("flights into a wall", flights);
    TEST_ASSERT_TRUE(acted > flights);
}

/* GIVEN a camera that looks to the right of the course, and a wall across the course of which it shows only the part aside WHEN this part is abeam or
 * behind THEN it clears no course that the rest, beyond the image's border, crosses. */
static void a_wall_whose_visible_part_is_passed_may_reach_the_course(void) {
    int flights = 0;
    for (double looks_deg = 60.0; looks_deg <= 90.0; looks_deg += 5.0) {
        for (double turned_rad = 0.6; turned_rad < 1.3;
             turned_rad += 0.15) { /* from ahead on the left to aside on the right */
            for (double ahead_m = 40.0; ahead_m <= 100.0; ahead_m += 30.0) {
                const wall_t wall = {ahead_m, 0.0, 160.0, 4.0, turned_rad};
                const flight_t flight = {looks_deg, 15.0, 6.0, 10.0f, 40.0};
                int acted = 0;
                TEST_ASSERT_EQUAL_INT(0, wrongly_clear(&wall, &flight, ahead_m - 5.0, &acted));
                flights++;
            }
        }
    }
    check_report("flights into a wall aside", flights);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_wall_alongside_is_not_passed);
    RUN_TEST(a_wall_that_fills_the_image_may_reach_the_course);
    RUN_TEST(a_wall_whose_visible_part_is_passed_may_reach_the_course);
    return UNITY_END();
}
