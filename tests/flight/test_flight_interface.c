/* What goe_flight.h promises of single calls, by flights and by slots. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_geometry.h"
#include "goe_slot.h"

#define RAD_PER_DEG 0.017453292519943295
#define OFFSET_US 123456789u /* of the autopilot's clock before the sender's */
#define SD_US 50000u

static flown_t flown;
static flown_t other;

void setUp(void) {
    flown_start(&flown, NULL);
    flown_start(&other, NULL);
}
void tearDown(void) {}

static goe_flight_obstacle_t obstacle_of(const flown_t *of) {
    goe_flight_obstacle_t obstacle;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&of->flight, 0, &obstacle));
    return obstacle;
}

/* -------------------------------------------------------------------------------------------------------------- time -- */

/* GIVEN a clock of the sender and its offset by a two-way exchange WHEN frames come late, by more and less THEN each counts from its
 * exposure in the autopilot's clock; without the offset the least delay is all there is. */
static void a_two_way_offset_dates_every_frame(void) {
    for (int synced = 0; synced < 2; synced++) {
        setUp();
        flown.sample = 0;
        int exact = 0;
        for (int k = 0; k < 100; k++) {
            goe_flight_attitude_t attitude;
            goe_flight_position_t position;
            flown_samples(&flown, k, &attitude, &position);
            flown.sample = k + 1;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
            if (synced && k == 0) {
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_timesync(&flown.flight, OFFSET_US, 300u));
            }
            if (k < 20 || k % 5 != 0) {
                continue;
            }
            const goe_flight_detection_t detection = flown_detection(&flown, k - 10);
            goe_flight_frame_t frame = flown_frame(&flown, k - 10, &detection, 1);
            const uint32_t exposed_us = frame.capture_us;
            frame.time_base = GOE_FLIGHT_SENDER_CLOCK;
            frame.capture_us = exposed_us - OFFSET_US;
            frame.sent_us = frame.capture_us + 20000u; /* and 180 ms on its way, of which delay_s is a part */
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            exact += flown.flight.capture_us == exposed_us ? 1 : 0;
        }
        TEST_ASSERT_EQUAL(synced ? 16 : 0, exact);
    }
}

/* The clock's update before an exchange is forgotten when the exchange is withdrawn. */
static void a_withdrawn_offset_leaves_nothing_behind(void) {
    const goe_flight_detection_t detection = flown_detection(&flown, 0);
    goe_flight_clock_t fresh;
    memset(&fresh, 0, sizeof fresh);
    (void)flown_fly(&flown, 1.0);
    for (int k = 0; k < 5; k++) {
        goe_flight_frame_t frame = flown_frame(&flown, 40, &detection, 1);
        frame.time_base = GOE_FLIGHT_SENDER_CLOCK;
        frame.capture_us -= OFFSET_US;
        frame.sent_us = frame.capture_us + 20000u;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    }
    TEST_ASSERT_TRUE(flown.flight.clock[0].count > 0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_timesync(&flown.flight, 0u, UINT32_MAX));
    TEST_ASSERT_EQUAL(0, flown.flight.clock[0].count);
    TEST_ASSERT_FALSE(flown.flight.clock[0].synced);
}

/* -------------------------------------------------------------------------------------------------------------- pose -- */

/* An attitude that turns by 20 degrees a second about down. */
static void turn_steadily(goe_flight_t *flight) {
    for (int k = 0; k < 40; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, k, &attitude, &position);
        const double half = 0.5 * 20.0 * RAD_PER_DEG * k / FLOWN_POSE_HZ;
        attitude.q[0] = (float)cos(half);
        attitude.q[1] = attitude.q[2] = 0.0f;
        attitude.q[3] = (float)sin(half);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(flight, &position));
    }
}

/* One sigma of the attitude: of each image, and what the aircraft turns in one sigma of the time. */
static void doubt_about_the_time_is_doubt_about_the_attitude(void) {
    goe_pose_t pose;
    float sd_deg;
    turn_steadily(&flown.flight);
    const uint32_t at_us = flown.start_us + 30u * (1000000u / FLOWN_POSE_HZ);
    const double white_deg = (double)flown.flight.attitude_white_sd_deg;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, at_us, 0u, &pose, &sd_deg));
    CHECK_CLOSE(0.01, white_deg, sd_deg);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, at_us, SD_US, &pose, &sd_deg));
    CHECK_CLOSE(0.01, sqrt(white_deg * white_deg + 1.0), sd_deg);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, at_us, 3u * SD_US, &pose, &sd_deg));
    CHECK_CLOSE(0.01, sqrt(white_deg * white_deg + 9.0), sd_deg);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, at_us, UINT32_MAX, &pose, &sd_deg));
    TEST_ASSERT_TRUE(sd_deg <= 30.0f);
}

static goe_flight_status_t give_heights(unsigned valid, float range_finder_m, float terrain_m, float home_m,
                                        float *height_m) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    goe_pose_t pose;
    flown_samples(&flown, 0, &attitude, &position);
    attitude.q[0] = 1.0f;
    attitude.q[1] = attitude.q[2] = attitude.q[3] = 0.0f;
    position.height_valid = (uint8_t)valid;
    position.height_m[GOE_FLIGHT_RANGE_FINDER] = range_finder_m;
    position.height_m[GOE_FLIGHT_TERRAIN] = terrain_m;
    position.height_m[GOE_FLIGHT_HOME] = home_m;
    (void)goe_flight_attitude(&flown.flight, &attitude);
    const goe_flight_status_t status = goe_flight_position(&flown.flight, &position);
    *height_m = -1.0f;
    if (status == GOE_FLIGHT_OK) {
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, attitude.time_us, 0u, &pose, NULL));
        *height_m = pose.height_m + flown.flight.camera[0].offset_m[2];
    }
    return status;
}

/* Heights: the best of those that are valid; one that is not valid may be anything, one that is must be a number. */
static void a_height_counts_only_where_it_is_valid(void) {
    static const float best_m[8] = {-1.0f, 20.0f, 21.0f, 20.0f, 22.0f, 20.0f, 21.0f, 20.0f};
    for (unsigned valid = 1u; valid < 8u; valid++) {
        float height_m;
        setUp();
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                          give_heights(valid, (valid & 1u) ? 20.0f : NAN, (valid & 2u) ? 21.0f : INFINITY,
                                       (valid & 4u) ? 22.0f : 1.0e30f, &height_m));
        CHECK_CLOSE(1.0e-3, (double)best_m[valid], height_m);
        for (unsigned bit = 0u; bit < 3u; bit++) {
            const bool counts = ((valid >> bit) & 1u) != 0u;
            const goe_flight_status_t bad = give_heights(valid, bit == 0u ? NAN : 20.0f, bit == 1u ? NAN : 21.0f,
                                                         bit == 2u ? NAN : 22.0f, &height_m);
            TEST_ASSERT_EQUAL(counts, bad == GOE_FLIGHT_NOT_FINITE);
            setUp();
            const goe_flight_status_t far =
                give_heights(valid, bit == 0u ? 1.0e30f : 20.0f, bit == 1u ? 1.0e30f : 21.0f,
                             bit == 2u ? 1.0e30f : 22.0f, &height_m);
            TEST_ASSERT_EQUAL(counts, far == GOE_FLIGHT_OUT_OF_RANGE);
        }
    }
}

/* GIVEN a valid height of exactly 0, as a range finder out of its reach reports it THEN the next best height counts. */
static void a_height_of_exactly_0_is_none(void) {
    float height_m;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, give_heights(7u, 0.0f, 21.0f, 22.0f, &height_m));
    CHECK_CLOSE(1.0e-3, 21.0, height_m);
    setUp();
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, give_heights(7u, -0.0f, 0.0f, 22.0f, &height_m));
    CHECK_CLOSE(1.0e-3, 22.0, height_m);
    setUp();
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, give_heights(7u, 0.01f, 21.0f, 22.0f, &height_m));
    CHECK_CLOSE(1.0e-3, 0.01, height_m);
}

/* Each refusal has its reason, is counted, and leaves the history as it was. */
static void an_invalid_pose_is_refused_for_its_reason(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    (void)flown_fly(&flown, 1.0);
    const goe_flight_history_t before = flown.flight.history;
    flown_samples(&flown, flown.sample, &attitude, &position);
    attitude.q[0] = 3.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ATTITUDE, goe_flight_attitude(&flown.flight, &attitude));
    memset(attitude.q, 0, sizeof attitude.q);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ATTITUDE, goe_flight_attitude(&flown.flight, &attitude));
    position.reset_horizontal++;
    position.reset_delta_known = true;
    position.reset_delta_ned_m[1] = NAN;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOT_FINITE, goe_flight_position(&flown.flight, &position));
    position.reset_delta_ned_m[1] = 2.0e6f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OUT_OF_RANGE, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_EQUAL(4, flown.flight.counters.refused);
    TEST_ASSERT_EQUAL_MEMORY(&before, &flown.flight.history, sizeof before);
    position.reset_horizontal--;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position)); /* the mark did not change */
}

/* Both samples, attitude and position, are to be fresh. */
static void a_pose_is_alive_while_both_its_parts_are(void) {
    for (int lacking = 0; lacking < 3; lacking++) {
        goe_flight_assessment_t now;
        setUp();
        (void)flown_fly(&flown, 1.0);
        for (int k = 0; k < FLOWN_POSE_HZ; k++) {
            goe_flight_attitude_t attitude;
            goe_flight_position_t position;
            flown_samples(&flown, flown.sample, &attitude, &position);
            flown.sample++;
            if (lacking != 1) {
                (void)goe_flight_attitude(&flown.flight, &attitude);
            }
            if (lacking != 2) {
                (void)goe_flight_position(&flown.flight, &position);
            }
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), 0u, &now));
        TEST_ASSERT_EQUAL(lacking == 0, now.pose_alive);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown) + 1000000u, 0u, &now));
        TEST_ASSERT_FALSE(now.pose_alive);
    }
}

/* An order begins where the aircraft is at the time of the assessment, not where its newest sample was. */
static void an_order_begins_where_the_aircraft_is(void) {
    goe_flight_assessment_t now;
    memset(&now, 0, sizeof now);
    flown.scene.width_m = flown.scene.length_m = 4.0; /* a mast on the course */
    flown.scene.height_m = 40.0;
    flown.scene.altitude_m = 20.0;
    flown.scene.x0_m = 1.0;
    flown.scene.z0_m = 140.0;
    while (now.action == GOE_FLIGHT_NONE && flown.sample < 400) {
        (void)flown_step(&flown);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown) + 200000u, 0u, &now));
    }
    TEST_ASSERT_TRUE(now.action != GOE_FLIGHT_NONE);
    const goe_flight_history_t *h = &flown.flight.history;
    const float *newest = h->position[(h->position_next + GOE_FLIGHT_SAMPLES - 1) % GOE_FLIGHT_SAMPLES].ned_m;
    const float *velocity = flown.flight.velocity_ned_m_s;
    TEST_ASSERT_TRUE(hypot((double)velocity[0], (double)velocity[1]) > 5.0);
    for (int i = 0; i < 2; i++) {
        CHECK_CLOSE(0.01, (double)newest[i] + 0.2 * (double)velocity[i], flown.flight.reaction.from_ned_m[i]);
    }
}

/* --------------------------------------------------------------------------------------------------------- obstacles -- */

/* The circle holds the outline; a model that there is not is none. */
static void an_obstacle_is_reported_as_the_header_says(void) {
    (void)flown_fly(&flown, 4.0);
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    slot->width_m = 6.0f;
    slot->length_m = 8.0f;
    goe_flight_obstacle_t obstacle = obstacle_of(&flown);
    CHECK_CLOSE(1.0e-4, 5.0, obstacle.radius_m);
    TEST_ASSERT_TRUE(obstacle.model != GOE_MODEL_NONE);
    slot->model = 99u;
    obstacle = obstacle_of(&flown);
    TEST_ASSERT_EQUAL(GOE_MODEL_NONE, obstacle.model);
}

/* The nearest point lies on the circle, at the aircraft's height; on the top where the aircraft is above that. */
static void the_nearest_point_of_an_obstacle_below_lies_on_its_top(void) {
    (void)flown_fly(&flown, 4.0);
    const goe_flight_history_t *h = &flown.flight.history;
    const float *own = h->position[(h->position_next + GOE_FLIGHT_SAMPLES - 1) % GOE_FLIGHT_SAMPLES].ned_m;
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    slot->valid |= GOE_HAS_HEIGHT;
    for (int below = 0; below < 2; below++) {
        slot->top_m = slot->ground_down_m - own[2] + (below ? -4.0f : 4.0f);
        const goe_flight_obstacle_t obstacle = obstacle_of(&flown);
        CHECK_CLOSE(1.0e-3, (double)own[2] + (below ? 4.0 : 0.0), obstacle.nearest_ned_m[2]);
        const double north = (double)(obstacle.nearest_ned_m[0] - slot->center_ne_m[0]);
        const double east = (double)(obstacle.nearest_ned_m[1] - slot->center_ne_m[1]);
        CHECK_CLOSE(0.01, (double)obstacle.radius_m, hypot(north, east));
    }
}

/* GIVEN the same flight on other courses, by boxes and by points THEN the obstacle is the same one, turned: place, covariance and axis. */
static void an_obstacle_turns_with_the_course(void) {
    for (int n = 0; n < 8; n++) {
        setUp();
        const double turn_deg = 50.0 + 73.0 * (n / 2);
        flown.points = other.points = n % 2 == 1;
        flown.scene.course_deg = 10.0;
        other.scene.course_deg = 10.0 + turn_deg;
        (void)flown_fly(&flown, n < 4 ? 2.0 : 4.0);
        (void)flown_fly(&other, n < 4 ? 2.0 : 4.0);
        const goe_flight_obstacle_t a = obstacle_of(&flown);
        const goe_flight_obstacle_t b = obstacle_of(&other);
        const double c = cos(turn_deg * RAD_PER_DEG);
        const double s = sin(turn_deg * RAD_PER_DEG);
        const double v[3] = {(double)a.covariance_ne_m2[0], (double)a.covariance_ne_m2[1],
                             (double)a.covariance_ne_m2[2]};
        const double off_m2 = 0.02 * (v[0] + v[2]);
        TEST_ASSERT_EQUAL_HEX(a.valid, b.valid);
        TEST_ASSERT_TRUE((a.valid & GOE_HAS_POSITION) != 0u);
        CHECK_CLOSE(0.1, c * (double)a.center_ned_m[0] - s * (double)a.center_ned_m[1], b.center_ned_m[0]);
        CHECK_CLOSE(0.1, s * (double)a.center_ned_m[0] + c * (double)a.center_ned_m[1], b.center_ned_m[1]);
        CHECK_CLOSE(off_m2, c * c * v[0] - 2.0 * c * s * v[1] + s * s * v[2], b.covariance_ne_m2[0]);
        CHECK_CLOSE(off_m2, c * s * (v[0] - v[2]) + (c * c - s * s) * v[1], b.covariance_ne_m2[1]);
        CHECK_CLOSE(off_m2, s * s * v[0] + 2.0 * c * s * v[1] + c * c * v[2], b.covariance_ne_m2[2]);
        if ((a.valid & GOE_HAS_ORIENTATION) != 0u) {
            const double off_deg = (double)(b.length_heading_deg - a.length_heading_deg) - turn_deg;
            CHECK_CLOSE(0.5, 0.0, remainder(off_deg, 180.0));
            TEST_ASSERT_TRUE(b.length_heading_deg >= 0.0f && b.length_heading_deg < 180.0f);
        }
    }
}

/* A track that begins in a slot that another one had used keeps nothing of it. */
static void a_new_track_begins_with_nothing(void) {
    (void)flown_fly(&flown, 4.0);
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    TEST_ASSERT_TRUE(slot->assessed && slot->in_view && slot->valid != 0u && slot->hazard.tcpa_s > 0.0f);
    slot->remembered = slot->suspect = true;
    goe_flight_slot_begin(slot, 9u, 5000000u);
    TEST_ASSERT_EQUAL_UINT32(9u, slot->id);
    TEST_ASSERT_TRUE(slot->used && slot->fresh_track);
    TEST_ASSERT_FALSE(slot->assessed || slot->in_view || slot->remembered || slot->suspect);
    TEST_ASSERT_EQUAL_HEX(0u, slot->valid);
    CHECK_CLOSE(0.0, 0.0, slot->hazard.tcpa_s);
    CHECK_CLOSE(0.0, 0.0, slot->hazard.conflict_probability);
}

/* -------------------------------------------------------------------------------------------------------------- boxes -- */

/* The box of points: from the least to the largest of the visible ones, in any order; nothing without any. */
static void points_make_a_box(void) {
    goe_flight_detection_t detection;
    int16_t box_px[4];
    memset(&detection, 0, sizeof detection);
    TEST_ASSERT_FALSE(goe_flight_slot_box_of(&detection, box_px));
    goe_pixel_t *const points[6] = {&detection.left,      &detection.right,     &detection.top,
                                    &detection.base_left, &detection.base_near, &detection.base_right};
    for (int first = 0; first < 6; first++) {
        for (int i = 0; i < 6; i++) {
            goe_pixel_t *point = points[(first + i) % 6];
            point->visible = i < 4;
            point->u_px = i == 0 ? 300.0f : i == 1 ? 100.0f : i == 2 ? 200.0f : 150.0f;
            point->v_px = i == 0 ? 410.0f : i == 1 ? 450.0f : i == 2 ? 500.0f : 400.0f;
        }
        TEST_ASSERT_TRUE(goe_flight_slot_box_of(&detection, box_px));
        TEST_ASSERT_EQUAL(100, box_px[0]);
        TEST_ASSERT_EQUAL(400, box_px[1]);
        TEST_ASSERT_EQUAL(300, box_px[2]);
        TEST_ASSERT_EQUAL(500, box_px[3]);
    }
}

/* A box that is more than three times as large or as small as the last one is of something else, wherever it lies. */
static void a_box_of_another_size_claims_nothing(void) {
    goe_flight_slot_view_t view;
    (void)flown_fly(&flown, 3.0);
    const goe_flight_slot_t *slot = &flown.flight.slot[0];
    memset(&view, 0, sizeof view);
    const int exposed = flown.sample - 1;
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, exposed, &attitude, &position);
    memcpy(view.pose.q, attitude.q, sizeof view.pose.q);
    memcpy(view.pose.ned_m, position.position_ned_m, sizeof view.pose.ned_m);
    TEST_ASSERT_TRUE(goe_flight_slot_claims(slot, flown.flight.camera, &view, slot->box_px) > 0.3f);
    const int middle_px = (slot->box_px[0] + slot->box_px[2]) / 2;
    const int half_px = (slot->box_px[2] - slot->box_px[0]) / 2;
    for (int larger = 2; larger <= 5; larger += 3) {
        int16_t box_px[4];
        memcpy(box_px, slot->box_px, sizeof box_px);
        box_px[0] = (int16_t)(middle_px - larger * half_px);
        box_px[2] = (int16_t)(middle_px + larger * half_px);
        const float claim = goe_flight_slot_claims(slot, flown.flight.camera, &view, box_px);
        TEST_ASSERT_EQUAL(larger < 3, claim > 0.0f);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_two_way_offset_dates_every_frame);
    RUN_TEST(a_withdrawn_offset_leaves_nothing_behind);
    RUN_TEST(doubt_about_the_time_is_doubt_about_the_attitude);
    RUN_TEST(a_height_counts_only_where_it_is_valid);
    RUN_TEST(a_height_of_exactly_0_is_none);
    RUN_TEST(an_invalid_pose_is_refused_for_its_reason);
    RUN_TEST(a_pose_is_alive_while_both_its_parts_are);
    RUN_TEST(an_order_begins_where_the_aircraft_is);
    RUN_TEST(an_obstacle_is_reported_as_the_header_says);
    RUN_TEST(the_nearest_point_of_an_obstacle_below_lies_on_its_top);
    RUN_TEST(an_obstacle_turns_with_the_course);
    RUN_TEST(a_new_track_begins_with_nothing);
    RUN_TEST(points_make_a_box);
    RUN_TEST(a_box_of_another_size_claims_nothing);
    return UNITY_END();
}
