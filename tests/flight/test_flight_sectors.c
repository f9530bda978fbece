/* Sectors by the boxes of the latest image. SPDX-License-Identifier: MIT */
#include <math.h>

#include "flown.h"

#define DEG_PER_RAD 57.295779513082321
#define MAX_CM 15000u
#define STEP_M 0.5

static flown_t flown;

void setUp(void) { flown_start(&flown, NULL); }
void tearDown(void) {}

/* Bearing of a column of the image: the flights are level and go north. */
static double bearing_deg(float u_px) {
    const goe_camera_t *camera = &flown.scene.camera;
    return DEG_PER_RAD * atan((double)((u_px - camera->cx_px) / camera->fx_px));
}

/* Whether a ray from the aircraft meets the wall within the sectors' reach. */
static bool meets(const goe_flight_position_t *own, double bearing) {
    const scene_t *scene = &flown.scene;
    for (double m = STEP_M; m < MAX_CM / 100.0; m += STEP_M) {
        const double north = (double)own->position_ned_m[0] + m * cos(bearing / DEG_PER_RAD);
        const double east = (double)own->position_ned_m[1] + m * sin(bearing / DEG_PER_RAD);
        if (fabs(east - scene->x0_m) < 0.5 * scene->width_m && north > scene->z0_m &&
            north < scene->z0_m + scene->length_m) {
            return true;
        }
    }
    return false;
}

/* Clear sectors whose middle lies in the box of the latest image and meets the wall. */
static int wrong_sectors(const goe_box_t *box) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    goe_flight_attitude_t attitude;
    goe_flight_position_t own;
    int wrong = 0;
    flown_samples(&flown, flown.sample - 1, &attitude, &own);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
    for (int i = -18; i <= 18; i++) {
        const double bearing = 5.0 * i;
        const bool inside = bearing > bearing_deg(box->left_px) && bearing < bearing_deg(box->right_px);
        const int sector = (i + GOE_FLIGHT_SECTORS) % GOE_FLIGHT_SECTORS;
        wrong += inside && sector_cm[sector] == MAX_CM + 1u && meets(&own, bearing) ? 1 : 0;
    }
    return wrong;
}

/* GIVEN a long wall along the course, whose images show its near end best, THEN no sector is clear in which the latest image shows a part of
 * it that is near enough. */
static void no_sector_is_clear_behind_the_near_end_of_a_wall(void) {
    static const double lengths_m[] = {20.0, 60.0, 100.0};
    static const double asides_m[] = {-30.0, 20.0, 50.0};
    int images = 0;
    for (int k = 0; k < 9; k++) {
        setUp();
        flown.scene.width_m = 6.0;
        flown.scene.length_m = lengths_m[k / 3];
        flown.scene.height_m = 40.0;
        flown.scene.alpha_deg = 0.0;
        flown.scene.z0_m = 250.0;
        flown.scene.x0_m = asides_m[k % 3];
        while (flown.sample < 14 * FLOWN_POSE_HZ) {
            goe_flight_assessment_t now;
            if (!flown_step(&flown)) {
                continue;
            }
            const goe_flight_detection_t latest = flown_detection(&flown, flown.sample - 1 - FLOWN_DELAY);
            if (latest.box.sides != GOE_SIDES_ALL) {
                continue;
            }
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), 0u, &now));
            TEST_ASSERT_EQUAL(0, wrong_sectors(&latest.box));
            images++;
        }
    }
    TEST_ASSERT_TRUE(images > 900);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(no_sector_is_clear_behind_the_near_end_of_a_wall);
    return UNITY_END();
}
