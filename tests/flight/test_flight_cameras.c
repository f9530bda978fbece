/* Two cameras with a detector each. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"

#define CAMERAS 2
#define VISIBLE_DEG 30.0 /* off the axis of a camera: the image reaches 35 */
#define Z0_M 60.0
#define X0_M (-18.0)
#define DEG_PER_RAD 57.29577951308232
#define MAX_CM 20000u

static flown_t flown;
static goe_camera_t mounted[CAMERAS];
static bool alive[CAMERAS];
static uint32_t id[CAMERAS];

static int phase[CAMERAS]; /* sample of the first image */
static int delay[CAMERAS];

void setUp(void) {
    flown_start(&flown, NULL);
    flown.scene.speed_mps = 8.0;
    flown.scene.height_m = 12.0;
    for (int c = 0; c < CAMERAS; c++) {
        mounted[c] = flown.scene.camera;
        alive[c] = true;
    }
    id[0] = 7u;
    id[1] = 3u;
    phase[0] = 0;
    phase[1] = 2;
    delay[0] = 6; /* the pictures of the second are taken later and come earlier */
    delay[1] = 2;
    mounted[0].mount_yaw_deg = -25.0f;
    mounted[1].mount_yaw_deg = -75.0f;
    mounted[1].fx_px *= 0.8f;
    mounted[1].fy_px *= 0.8f;
    mounted[1].offset_m[0] = 0.6f;
    mounted[1].offset_m[1] = -0.4f;
    goe_settings_t estimator = scene_settings(&flown.scene);
    estimator.camera = mounted[0];
    estimator.more_cameras[0] = mounted[1];
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown.flight, sizeof flown.flight, &estimator, NULL, NULL));
}
void tearDown(void) {}

/* The scene places the obstacle from the camera that it has. */
static void look_through(int c) {
    flown.scene.camera = mounted[c];
    flown.scene.z0_m = Z0_M - (double)mounted[c].offset_m[0];
    flown.scene.x0_m = X0_M - (double)mounted[c].offset_m[1];
}

static bool detects(int c, int k) {
    goe_image_t image;
    scene_truth_t truth;
    look_through(c);
    scene_image(&flown.scene, k, &image, &truth);
    return fabs(atan2(truth.x_m, truth.z_m) * DEG_PER_RAD - (double)mounted[c].mount_yaw_deg) < VISIBLE_DEG;
}

static void give_frame(int c, int k, const goe_flight_detection_t *more) {
    goe_flight_detection_t detections[2];
    int count = 0;
    if (detects(c, k)) {
        flown.id = id[c];
        detections[count++] = flown_detection(&flown, k);
    }
    if (more) {
        detections[count++] = *more;
    }
    goe_flight_frame_t frame = flown_frame(&flown, k, detections, count);
    frame.camera = (uint8_t)c;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
}

/* One sample on, and the frames that arrive then; `more` is the additional detection of the second camera. */
static void step(const goe_flight_detection_t *more) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    look_through(0);
    flown_samples(&flown, flown.sample, &attitude, &position);
    flown.sample++;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    for (int c = 0; c < CAMERAS; c++) {
        const int exposed = flown.sample - 1 - delay[c];
        if (alive[c] && exposed >= 0 && exposed % FLOWN_IMAGE_EVERY == phase[c]) {
            give_frame(c, exposed, c == 1 ? more : NULL);
        }
    }
}

static int slots_used(void) {
    int used = 0;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        used += flown.flight.slot[i].used ? 1 : 0;
    }
    return used;
}

/* By another id, or by the same one. */
static void an_obstacle_flies_from_one_camera_into_the_other(void) {
    for (int same = 0; same < 2; same++) {
        setUp();
        id[1] = same ? id[0] : id[1];
        int points[CAMERAS] = {0, 0};
        for (int k = 0; k < 350; k++) {
            goe_flight_obstacle_t obstacle;
            step(NULL);
            if (goe_flight_obstacle(&flown.flight, 0, &obstacle) == GOE_FLIGHT_OK && obstacle.in_view) {
                points[flown.flight.slot[0].camera]++;
            }
        }
        goe_flight_obstacle_t obstacle;
        goe_flight_assessment_t now;
        goe_image_t image;
        scene_truth_t truth;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), false, &now));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
        look_through(0);
        scene_image(&flown.scene, 0, &image, &truth);
        TEST_ASSERT_EQUAL(1, slots_used());
        TEST_ASSERT_EQUAL_UINT32(id[1], obstacle.id);
        TEST_ASSERT_EQUAL(1, flown.flight.slot[0].camera);
        TEST_ASSERT_TRUE(points[0] > 200 && points[1] > 50);
        TEST_ASSERT_TRUE(obstacle.in_view && obstacle.age_s < 0.2f && !obstacle.suspect);
        const double sd_m = sqrt((double)(obstacle.covariance_ne_m2[0] + obstacle.covariance_ne_m2[2]));
        check_report("off, m", hypot((double)obstacle.center_ned_m[0] - truth.center_north_m,
                                     (double)obstacle.center_ned_m[1] - truth.center_east_m));
        CHECK_CLOSE(2.0 * sd_m, truth.center_north_m, obstacle.center_ned_m[0]);
        CHECK_CLOSE(2.0 * sd_m, truth.center_east_m, obstacle.center_ned_m[1]);
    }
}

/* GIVEN two cameras that see the obstacle at once WHEN the images of one come later than newer ones of the other THEN the track keeps the
 * id of the camera of its latest detection, and is not renumbered. */
static void a_late_image_takes_no_id_over(void) {
    for (int late = 0; late < CAMERAS; late++) {
        setUp();
        mounted[1] = mounted[0];
        goe_settings_t estimator = scene_settings(&flown.scene);
        estimator.camera = estimator.more_cameras[0] = mounted[0];
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown.flight, sizeof flown.flight, &estimator, NULL, NULL));
        delay[late] = 12;
        delay[1 - late] = 2;
        alive[late] = false;
        for (int k = 0; k < 100; k++) {
            step(NULL);
        }
        alive[late] = true;
        for (int k = 0; k < 100; k++) {
            step(NULL);
            TEST_ASSERT_EQUAL(1 - late, flown.flight.slot[0].camera);
            TEST_ASSERT_EQUAL_UINT32(id[1 - late], flown.flight.slot[0].id);
        }
        TEST_ASSERT_EQUAL(1, slots_used());
        TEST_ASSERT_EQUAL(0, flown.flight.counters.renumbered);
    }
}

/* A box around that of the scene's obstacle at sample k, ten times as wide: of something behind it. */
static goe_flight_detection_t backdrop(int k) {
    flown.id = 9u;
    goe_flight_detection_t detection = flown_detection(&flown, k);
    const float width_px = detection.box.right_px - detection.box.left_px;
    detection.box.left_px -= 4.5f * width_px;
    detection.box.right_px += 4.5f * width_px;
    return detection;
}

/* GIVEN an obstacle that one camera tracks WHEN the other one shows a much wider object in the same direction, in a newer image, in one of the
 * same time or in an older one THEN that is another obstacle, and the track stays with its camera. */
static void a_wider_object_of_another_camera_is_another_obstacle(void) {
    for (int late = -1; late <= 1; late++) {
        setUp();
        flown.scene.z0_m = 120.0;
        phase[0] = 2;
        delay[0] = 4;
        delay[1] = 4 + late;
        phase[1] = 2 - late;
        mounted[1] = mounted[0];
        goe_settings_t estimator = scene_settings(&flown.scene);
        estimator.camera = estimator.more_cameras[0] = mounted[0];
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown.flight, sizeof flown.flight, &estimator, NULL, NULL));
        alive[1] = false;
        for (int k = 0; k < 120; k++) {
            step(NULL);
        }
        TEST_ASSERT_EQUAL(1, slots_used());
        for (int k = 0; k < 30; k++) {
            step(NULL);
            const int exposed = flown.sample - 1 - delay[1];
            if (exposed % FLOWN_IMAGE_EVERY == phase[1]) {
                const goe_flight_detection_t seen = backdrop(exposed);
                goe_flight_frame_t frame = flown_frame(&flown, exposed, &seen, 1);
                frame.camera = 1;
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            }
        }
        TEST_ASSERT_EQUAL(2, slots_used());
        TEST_ASSERT_EQUAL(0, flown.flight.slot[0].camera);
        TEST_ASSERT_EQUAL_UINT32(id[0], flown.flight.slot[0].id);
        TEST_ASSERT_EQUAL(0, flown.flight.counters.renumbered);
    }
}

/* GIVEN an obstacle that leaves the view of one camera WHEN the images of the other one come later THEN that one takes it over all the same. */
static void a_late_camera_takes_an_obstacle_over(void) {
    delay[0] = 2;
    delay[1] = 12;
    int points = 0;
    for (int k = 0; k < 350; k++) {
        goe_flight_obstacle_t obstacle;
        step(NULL);
        const bool seen = goe_flight_obstacle(&flown.flight, 0, &obstacle) == GOE_FLIGHT_OK && obstacle.in_view;
        points += seen && obstacle.age_s < 0.3f && flown.flight.slot[0].camera == 1 ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(1, slots_used());
    TEST_ASSERT_EQUAL_UINT32(id[1], flown.flight.slot[0].id);
    TEST_ASSERT_EQUAL(1, flown.flight.slot[0].camera);
    TEST_ASSERT_TRUE(points > 30);
}

static goe_flight_detection_t something(uint32_t number) {
    goe_flight_detection_t detection;
    memset(&detection, 0, sizeof detection);
    detection.id = number;
    detection.score = 0.9f;
    detection.box.left_px = 200.0f;
    detection.box.right_px = 240.0f;
    detection.box.top_px = 600.0f;
    detection.box.bottom_px = 700.0f;
    detection.box.sides = GOE_SIDES_ALL;
    return detection;
}

/* Each detector counts on its own: one number of both is two obstacles. */
static void one_id_of_two_cameras_is_two_obstacles(void) {
    const goe_flight_detection_t aside = something(id[0]);
    for (int k = 0; k < 50; k++) {
        step(&aside);
    }
    TEST_ASSERT_EQUAL(2, slots_used());
    TEST_ASSERT_EQUAL_UINT32(flown.flight.slot[0].id, flown.flight.slot[1].id);
    TEST_ASSERT_TRUE(flown.flight.slot[0].camera != flown.flight.slot[1].camera);
}

/* Two images of one and two of the other are not the three that a slot takes. */
static void each_camera_confirms_its_own(void) {
    alive[0] = alive[1] = false;
    for (int k = 0; k < 20; k++) {
        step(NULL);
        if (k % FLOWN_IMAGE_EVERY == 0) {
            const goe_flight_detection_t seen = something(9u);
            goe_flight_frame_t frame = flown_frame(&flown, k, &seen, 1);
            frame.camera = (uint8_t)(k / FLOWN_IMAGE_EVERY % CAMERAS);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        }
    }
    TEST_ASSERT_EQUAL(4, flown.flight.counters.taken);
    TEST_ASSERT_EQUAL(0, slots_used());
}

/* A sector is clear only by a camera whose detector is alive, and the whole is alive only if all are. */
static void the_view_of_a_dead_detector_is_unknown(void) {
    goe_flight_assessment_t now;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    const int by_first = 3;   /* 15 degrees */
    const int by_second = 53; /* 265 */
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < 100; k++) {
            step(NULL);
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), false, &now));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
        TEST_ASSERT_EQUAL(round == 0, now.detector_alive);
        TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[by_first]);
        TEST_ASSERT_EQUAL_UINT16(MAX_CM + 1u, sector_cm[0]);
        TEST_ASSERT_EQUAL_UINT16(round == 0 ? MAX_CM + 1u : GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[by_second]);
        alive[1] = false;
    }
}

/* [GOE_FLIGHT_SENDER_CLOCK] GIVEN two cameras whose senders have clocks of their own WHEN these are apart by less or more than a second, and no
 * exchange gives their offsets THEN each image counts from its exposure; one exchange applies to the images of both. */
static void each_sender_has_its_own_clock(void) {
    const uint32_t apart_us[] = {150000u, 300000u, 495000000u};
    for (int n = 0; n < 4; n++) {
        setUp();
        alive[0] = alive[1] = false;
        for (int k = 0; k < 150; k++) {
            step(NULL);
            if (n == 3 && k == 0) {
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_timesync(&flown.flight, 5000000u, 200u));
            }
            const int c = k % 5 == 3 ? 1 : 0;
            if (k < 20 || (k % 5 != 3 && k % 5 != 0)) {
                continue;
            }
            goe_flight_frame_t frame = flown_frame(&flown, k - 5, NULL, 0);
            const uint32_t exposed_us = frame.capture_us;
            frame.camera = (uint8_t)c;
            frame.time_base = GOE_FLIGHT_SENDER_CLOCK;
            frame.sent_us = frame.arrival_us - 5000000u - (c == 1 && n < 3 ? apart_us[n] : 0u);
            frame.capture_us = frame.sent_us - (frame.arrival_us - exposed_us);
            frame.sent_us -= 5000u; /* delay_s */
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            TEST_ASSERT_EQUAL_UINT32(exposed_us, flown.flight.capture_us);
        }
    }
}

static void a_camera_that_is_not_set_is_refused(void) {
    step(NULL);
    goe_flight_frame_t frame = flown_frame(&flown, 0, NULL, 0);
    frame.camera = CAMERAS;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OUT_OF_RANGE, goe_flight_frame(&flown.flight, &frame));
    goe_settings_t estimator = scene_settings(&flown.scene);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown.flight, sizeof flown.flight, &estimator, NULL, NULL));
    flown.sample = 0;
    step(NULL);
    frame.camera = 1;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OUT_OF_RANGE, goe_flight_frame(&flown.flight, &frame));
    frame.camera = 0;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
}

static void each_camera_needs_its_size(void) {
    const char *bad = NULL;
    goe_settings_t estimator = scene_settings(&flown.scene);
    estimator.more_cameras[0] = mounted[1];
    estimator.more_cameras[0].height_px = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS,
                      goe_flight_init(&flown.flight, sizeof flown.flight, &estimator, NULL, &bad));
    TEST_ASSERT_EQUAL_STRING("camera.height_px", bad);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_obstacle_flies_from_one_camera_into_the_other);
    RUN_TEST(a_late_image_takes_no_id_over);
    RUN_TEST(a_wider_object_of_another_camera_is_another_obstacle);
    RUN_TEST(a_late_camera_takes_an_obstacle_over);
    RUN_TEST(one_id_of_two_cameras_is_two_obstacles);
    RUN_TEST(each_camera_confirms_its_own);
    RUN_TEST(the_view_of_a_dead_detector_is_unknown);
    RUN_TEST(each_sender_has_its_own_clock);
    RUN_TEST(a_camera_that_is_not_set_is_refused);
    RUN_TEST(each_camera_needs_its_size);
    return UNITY_END();
}
