/* Which detections are taken, which obstacles are given up for them, and whose they are. SPDX-License-Identifier: MIT
 *
 * Each rule of the layer's manual against a plain model of it, for any table of obstacles. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_candidate.h"
#include "goe_geometry.h"
#include "goe_slot.h"
#include "goe_table.h"

#define TRIALS 2000
#define NEW_ID 77u
#define BOX_MIN_PX 8.0

static check_random_t any;
static flown_t flown;
static goe_flight_t *flight;

void setUp(void) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.confirm_images = 1.0f;
    any = check_random_start("flight taken");
    flown_start(&flown, &settings);
    flown.detects = false;
    (void)flown_fly(&flown, 1.0);
    flight = &flown.flight;
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }
static bool one_in(int n) { return between(0.0, (double)n) < 1.0; }

static goe_flight_detection_t good_detection(void) {
    goe_flight_detection_t d;
    memset(&d, 0, sizeof d);
    d.id = NEW_ID;
    d.score = 0.9f;
    d.box.left_px = 1000.0f;
    d.box.top_px = 100.0f;
    d.box.right_px = 1040.0f;
    d.box.bottom_px = 160.0f;
    d.box.sides = GOE_SIDES_ALL;
    return d;
}

/* ---------------------------------------------------------------------------------------------------------- readable -- */

/* Whether the detection was left out and counted, in a frame that announces another one. */
static bool is_refused(const goe_flight_detection_t *detection) {
    flown_t copy = flown;
    goe_flight_frame_t frame = flown_frame(&copy, copy.sample - 1, detection, 1);
    const uint16_t before = copy.flight.counters.refused;
    frame.number = 2;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&copy.flight, &frame));
    const bool refused = copy.flight.counters.refused == before + 1;
    TEST_ASSERT_EQUAL(!refused, copy.flight.had_frame != 0u); /* a sign of life is what can be read */
    return refused;
}

static void sides_count_by_their_visible_part(void) {
    flight->had_frame = 0u;
    const float bad[] = {NAN, INFINITY, -INFINITY, 2.0e5f, -2.0e5f};
    for (unsigned seen = 0u; seen < 32u; seen++) {
        for (int side = 0; side < 4; side++) {
            for (int k = 0; k < 5; k++) {
                goe_flight_detection_t d = good_detection();
                float *const sides[4] = {&d.box.left_px, &d.box.top_px, &d.box.right_px, &d.box.bottom_px};
                const unsigned bits[4] = {GOE_SIDE_LEFT, GOE_SIDE_TOP, GOE_SIDE_RIGHT, GOE_SIDE_BOTTOM};
                *sides[side] = bad[k];
                d.box.sides = (uint8_t)seen;
                TEST_ASSERT_EQUAL((seen & bits[side]) != 0u || seen > GOE_SIDES_ALL, is_refused(&d));
            }
        }
    }
}

/* Left of right, and top above bottom, where both are visible. */
static void a_box_has_an_inside(void) {
    flight->had_frame = 0u;
    for (unsigned seen = 0u; seen <= GOE_SIDES_ALL; seen++) {
        for (int k = 0; k < 4; k++) {
            goe_flight_detection_t d = good_detection();
            d.box.sides = (uint8_t)seen;
            if (k < 2) {
                d.box.right_px = d.box.left_px - (float)k;
            } else {
                d.box.bottom_px = d.box.top_px - (float)(k - 2);
            }
            const unsigned both = k < 2 ? GOE_SIDE_LEFT | GOE_SIDE_RIGHT : GOE_SIDE_TOP | GOE_SIDE_BOTTOM;
            TEST_ASSERT_EQUAL((seen & both) == both, is_refused(&d));
        }
    }
}

static void points_and_numbers_have_their_ranges(void) {
    flight->had_frame = 0u;
    const float bad[] = {NAN, INFINITY, 2.0e5f, -2.0e5f};
    for (int point = 0; point < 6; point++) {
        for (int k = 0; k < 16; k++) {
            goe_flight_detection_t d = good_detection();
            goe_pixel_t *const points[6] = {&d.left, &d.right, &d.top, &d.base_left, &d.base_near, &d.base_right};
            points[point]->visible = k < 8;
            *(k % 2 == 0 ? &points[point]->u_px : &points[point]->v_px) = bad[(k / 2) % 4];
            TEST_ASSERT_EQUAL(k < 8, is_refused(&d));
        }
    }
    const float score[] = {0.0f, 1.0f, -0.01f, 1.01f, NAN};
    const float pixel_px[] = {0.0f, 100.0f, -0.01f, 100.1f, NAN};
    for (int k = 0; k < 5; k++) {
        goe_flight_detection_t d = good_detection();
        d.score = score[k];
        TEST_ASSERT_EQUAL(k >= 2, is_refused(&d));
        d = good_detection();
        d.pixel_px = pixel_px[k];
        TEST_ASSERT_EQUAL(k >= 2, is_refused(&d));
    }
}

/* The kind that reaches the estimator, of a detection whose box is good; *counted: by how much `refused` grew. */
static void give_kind(goe_kind_t kind, int *counted) {
    flown_t copy = flown;
    goe_flight_detection_t d = good_detection();
    d.kind = kind;
    const goe_flight_frame_t frame = flown_frame(&copy, copy.sample - 1, &d, 1);
    const int before = copy.flight.counters.refused;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&copy.flight, &frame));
    *counted = copy.flight.counters.refused - before;
    const goe_flight_slot_t *slot = &copy.flight.slot[0];
    TEST_ASSERT_TRUE(slot->used && slot->id == NEW_ID && !slot->fresh_track); /* the estimator took the image */
}

/* [goe_flight_detection_t.kind] A bad kind is counted, and the box is used without it. */
static void a_bad_kind_loses_no_box(void) {
    static const struct {
        goe_kind_t kind;
        int refused;
    } cases[] = {
        {{0.0f, 0.0f, 0.0f, 0.0f, GOE_KIND_UNKNOWN}, 0},
        {{2.0f, 0.02f, 1000.0f, 1000.0f, GOE_KIND_OTHER}, 0},
        {{0.0f, -1.0f, 1.7f, 0.1f, GOE_KIND_ROUND}, 0}, /* the sigma of no size is not read */
        {{NAN, 1.0f, 1.7f, 0.1f, 0u}, 1},
        {{3.2f, NAN, 1.7f, 0.1f, 0u}, 1},
        {{0.0f, NAN, 1.7f, 0.1f, 0u}, 1},
        {{3.2f, 0.9f, INFINITY, 0.1f, 0u}, 1},
        {{3.2f, 0.9f, 1.7f, INFINITY, 0u}, 1},
        {{-0.1f, 1.0f, 1.7f, 0.1f, 0u}, 1},
        {{3.2f, 0.9f, 1000.1f, 100.0f, 0u}, 1},
        {{3.2f, 1000.1f, 1.7f, 0.1f, 0u}, 1},
        {{3.2f, 0.9f, 1.7f, 0.016f, 0u}, 1},
        {{3.2f, 0.0f, 1.7f, 0.1f, 0u}, 1},
        {{3.2f, 0.9f, 1.7f, 0.1f, 3u}, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int counted;
        give_kind(cases[i].kind, &counted);
        TEST_ASSERT_EQUAL(cases[i].refused, counted);
    }
}

/* -------------------------------------------------------------------------------------------------------------- free place -- */

static void put_any(goe_flight_t *to, int i, uint32_t now_us) {
    goe_flight_slot_t *slot = &to->slot[i];
    slot->used = !one_in(8);
    slot->id = 100u + (uint32_t)i;
    slot->detected_us = slot->taken_us = now_us - (uint32_t)between(0.2e6, 4.0e6);
    slot->valid = (uint8_t)(one_in(3) ? 0 : GOE_HAS_POSITION);
    slot->assessed = slot->valid != 0u && !one_in(5);
    slot->hazard.conflict_probability = (float)between(0.0, 0.7);
    slot->hazard.tcpa_s = one_in(3) ? 0.0f : (float)between(0.5, 40.0);
    slot->fresh_track = false;
}

/* The less, the sooner it is given up: a free slot; a track without a position, or a passed one, undetected for 2 s; the least violation
 * and nearness in time, below a half. */
static double worth(const goe_flight_t *of, int i, uint32_t now_us) {
    const goe_flight_slot_t *slot = &of->slot[i];
    const bool undetected = (now_us - slot->detected_us) > 2000000u;
    if (!slot->used) {
        return -3.0;
    }
    if (i == of->reaction.slot) {
        return 1.0;
    }
    if (undetected && slot->valid == 0u) {
        return -2.0;
    }
    if (!slot->assessed) {
        return 1.0;
    }
    const double tcpa_s = (double)slot->hazard.tcpa_s;
    const double nearness = tcpa_s > 0.0 ? 1.0 / (1.0 + tcpa_s) : 0.0;
    return undetected && !(tcpa_s > 0.0) ? -1.0 : (double)slot->hazard.conflict_probability + nearness;
}

/* [goe_flight_counters_t.evicted, goe_flight_counters_t.full]
 * GIVEN any table WHEN a new obstacle is confirmed THEN it gets the slot of the least worth, and none while all are worth a half. */
static void a_new_obstacle_takes_the_place_of_the_least_worth(void) {
    int ends[3] = {0, 0, 0};
    const goe_flight_detection_t detection = good_detection();
    for (int n = 0; n < TRIALS; n++) {
        static goe_flight_t copy;
        goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &detection, 1);
        int expected = -1;
        double least = 0.5;
        copy = *flight;
        frame.number = 2; /* the others are not in this part of the image */
        copy.reaction.slot = (int8_t)(one_in(2) ? -1 : (int)between(0.0, 3.99));
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            put_any(&copy, i, frame.capture_us);
            const double value = worth(&copy, i, frame.capture_us);
            expected = value < least ? i : expected;
            least = fmin(value, least);
        }
        const bool was_used = expected >= 0 && copy.slot[expected].used;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&copy, &frame));
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            TEST_ASSERT_EQUAL(i == expected, copy.slot[i].id == NEW_ID && copy.slot[i].used);
        }
        TEST_ASSERT_EQUAL(expected < 0 ? 1 : 0, copy.counters.full);
        TEST_ASSERT_EQUAL(was_used ? 1 : 0, copy.counters.evicted);
        ends[expected < 0 ? 0 : was_used ? 1 : 2]++;
    }
    TEST_ASSERT_TRUE(ends[0] > 20 && ends[1] > 20 && ends[2] > 20);
}

/* GIVEN a full table of obstacles that are passed and still in view WHEN a new one is confirmed THEN it gets a slot if it is ahead on the
 * course, but not from an obstacle that is violated at present; if it is behind, or the aircraft hovers, they keep their slots. */
static void a_passed_obstacle_in_view_makes_room_for_one_ahead(void) {
    const float speeds_m_s[] = {20.0f, -20.0f, 0.0f};
    const goe_flight_detection_t detection = good_detection();
    for (int n = 0; n < 6; n++) {
        static goe_flight_t copy;
        goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &detection, 1);
        copy = *flight;
        frame.number = 2;
        copy.velocity_ned_m_s[0] = speeds_m_s[n % 3];
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            put_any(&copy, i, frame.capture_us);
            copy.slot[i].used = copy.slot[i].assessed = copy.slot[i].in_view = true;
            copy.slot[i].valid = GOE_HAS_POSITION;
            copy.slot[i].detected_us = frame.capture_us;
            copy.slot[i].hazard.conflict_probability = n < 3 ? 0.1f : 0.9f;
            copy.slot[i].hazard.tcpa_s = 0.0f;
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&copy, &frame));
        TEST_ASSERT_EQUAL(n == 0 ? 1 : 0, copy.counters.evicted);
        TEST_ASSERT_EQUAL(n == 0 ? 0 : 1, copy.counters.full);
    }
}

/* [flight.track_timeout_s]
 * GIVEN any table THEN a track undetected for track_timeout_s is given up; while an order is active for 120 s, that of the order's obstacle for
 * 600 s; when an order has just ended for 600 s; that of one that moves for 30 s; but not an obstacle ahead. The order forgets a track that is
 * given up. */
static void an_old_track_is_given_up(void) {
    int given_up = 0;
    int kept = 0;
    for (int n = 0; n < TRIALS; n++) {
        static goe_flight_t copy;
        const uint32_t now_us = 1000000000u;
        copy = *flight;
        copy.settings.track_timeout_s = one_in(3) ? 40.0f : 10.0f;
        copy.reaction.action = (uint8_t)(one_in(2) ? GOE_FLIGHT_NONE : GOE_FLIGHT_LEFT);
        copy.reaction.falling = one_in(2);
        copy.reaction.slot = (int8_t)(one_in(2) ? -1 : (int)between(0.0, 3.99));
        copy.reaction.edge = (int8_t)(one_in(2) ? -1 : (int)between(0.0, 3.99));
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            put_any(&copy, i, now_us);
            copy.slot[i].valid |= (uint8_t)(one_in(3) ? GOE_HAS_VELOCITY : 0);
            copy.slot[i].detected_us = now_us - (uint32_t)between(1.0e6, one_in(2) ? 60.0e6 : 900.0e6);
        }
        const goe_flight_t before = copy;
        goe_flight_table_age(&copy, now_us);
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            const goe_flight_slot_t *slot = &before.slot[i];
            const double undetected_s = 1.0e-6 * (double)(now_us - slot->detected_us);
            const bool ordered = before.reaction.action != GOE_FLIGHT_NONE || before.reaction.falling;
            const bool moves = (slot->valid & GOE_HAS_VELOCITY) != 0u;
            const bool avoided = before.reaction.slot == i || before.reaction.action == GOE_FLIGHT_NONE;
            const double standing_s = avoided ? 600.0 : 120.0;
            const double timeout_s = (double)copy.settings.track_timeout_s;
            const double most_s = ordered ? fmax(moves ? 30.0 : standing_s, timeout_s) : timeout_s;
            const bool ahead = slot->assessed && slot->hazard.tcpa_s > 0.0f &&
                               slot->hazard.conflict_probability >= copy.settings.conflict_probability_max;
            const bool stays = slot->used && (ahead || undetected_s <= most_s);
            TEST_ASSERT_EQUAL(stays, copy.slot[i].used);
            TEST_ASSERT_EQUAL(stays && before.reaction.slot == i, copy.reaction.slot == i);
            TEST_ASSERT_EQUAL(stays && before.reaction.edge == i, copy.reaction.edge == i);
            given_up += slot->used && !stays ? 1 : 0;
            kept += stays ? 1 : 0;
        }
    }
    TEST_ASSERT_TRUE(given_up > TRIALS / 4 && kept > TRIALS / 4);
}

/* -------------------------------------------------------------------------------------------------------- candidates -- */

/* Share of the union of two boxes that both cover; boxes may have no inside. */
static void overlap_is_the_share_of_the_union(void) {
    int some = 0;
    for (int n = 0; n < TRIALS; n++) {
        int16_t a[4];
        int16_t b[4];
        double area[2] = {1.0, 1.0};
        double both = 1.0;
        for (int axis = 0; axis < 2; axis++) {
            a[axis] = (int16_t)between(-20.0, 20.0);
            b[axis] = (int16_t)between(-20.0, 20.0);
            a[axis + 2] = (int16_t)(a[axis] + (int)between(-2.0, 30.0));
            b[axis + 2] = (int16_t)(b[axis] + (int)between(-2.0, 30.0));
            area[0] *= fmax((double)(a[axis + 2] - a[axis]), 0.0);
            area[1] *= fmax((double)(b[axis + 2] - b[axis]), 0.0);
            both *= fmax(fmin((double)a[axis + 2], (double)b[axis + 2]) - fmax((double)a[axis], (double)b[axis]), 0.0);
        }
        const double all = area[0] + area[1] - both;
        CHECK_CLOSE(1.0e-5, all > 0.0 ? both / all : 0.0, goe_flight_candidate_overlap(a, b));
        some += both > 0.0 ? 1 : 0;
    }
    TEST_ASSERT_TRUE(some > TRIALS / 10);
}

static bool seen(goe_flight_waiting_t *table, uint32_t id, uint32_t time_us, uint8_t camera, int left_px, int images) {
    const goe_flight_candidate_t candidate = {id,     time_us, {(int16_t)left_px, 0, (int16_t)(left_px + 10), 10},
                                              camera, 0,       {0, 0}};
    return goe_flight_candidate_confirm(table, &candidate, images);
}

/* [flight.confirm_images, GOE_FLIGHT_CANDIDATES] */
static void images_of_one_candidate_lie_at_most_a_second_apart(void) {
    goe_flight_waiting_t table;
    const uint32_t start_us = 0xFFFFFFFFu - 500000u; /* the clock wraps on the way */
    for (int late = 0; late < 2; late++) {
        memset(&table, 0, sizeof table);
        TEST_ASSERT_FALSE(seen(&table, 5u, start_us, 0, 0, 2));
        TEST_ASSERT_EQUAL(!late, seen(&table, 5u, start_us + (late ? 1000001u : 1000000u), 0, 0, 2));
    }
    memset(&table, 0, sizeof table);
    TEST_ASSERT_FALSE(seen(&table, 5u, start_us, 0, 0, 2));
    TEST_ASSERT_FALSE(seen(&table, 5u, start_us, 0, 0, 2));        /* twice in one image */
    TEST_ASSERT_FALSE(seen(&table, 6u, start_us + 100u, 0, 0, 2)); /* another id, another camera */
    TEST_ASSERT_FALSE(seen(&table, 5u, start_us + 100u, 1, 0, 2));
    TEST_ASSERT_FALSE(
        seen(&table, 0u, start_us + 100u, 0, 0, 2)); /* without an id the place decides: 3 of 10 in common */
    TEST_ASSERT_FALSE(seen(&table, 0u, start_us + 200u, 0, 6, 2));
    TEST_ASSERT_TRUE(seen(&table, 0u, start_us + 300u, 0, 4, 2));
    TEST_ASSERT_TRUE(seen(&table, 5u, start_us + 300u, 0, 90, 2));  /* an id may be anywhere */
    TEST_ASSERT_FALSE(seen(&table, 5u, start_us + 400u, 0, 90, 2)); /* confirmed: it is no candidate any more */
    TEST_ASSERT_TRUE(seen(&table, 9u, start_us + 400u, 0, 90, 1));
}

/* A full table forgets the one undetected for the longest. */
static void a_full_table_forgets_the_oldest(void) {
    for (int oldest = 0; oldest < GOE_FLIGHT_CANDIDATES; oldest++) {
        goe_flight_waiting_t table;
        memset(&table, 0, sizeof table);
        for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
            const uint32_t time_us = i == oldest ? 100000u : 200000u + 10000u * (uint32_t)((i * 5) % 6);
            TEST_ASSERT_FALSE(seen(&table, 10u + (uint32_t)i, time_us, 0, 0, 3));
        }
        TEST_ASSERT_FALSE(seen(&table, 50u, 300000u, 0, 0, 3));
        for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
            TEST_ASSERT_EQUAL_UINT32(i == oldest ? 50u : 10u + (uint32_t)i, table.place[i].id);
        }
    }
}

/* GIVEN a crowded table WHEN a detection of an older image has no place THEN the mark lasts as long as before. */
static void an_older_image_shortens_no_crowd(void) {
    goe_flight_waiting_t table;
    memset(&table, 0, sizeof table);
    goe_flight_candidate_crowd(&table, 20000000u);
    goe_flight_candidate_crowd(&table, 10500000u);
    goe_flight_candidate_expire(&table, 0u, 20900000u);
    TEST_ASSERT_EQUAL(1, goe_flight_candidate_count(&table));
}

/* GIVEN an obstacle that has lost its slot THEN it waits for another one if it was detected in the latest second. */
static void an_undetected_obstacle_does_not_wait(void) {
    for (int late = 0; late < 2; late++) {
        static goe_flight_t copy;
        const goe_flight_detection_t detection = good_detection();
        goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &detection, 1);
        copy = *flight;
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            put_any(&copy, i, frame.capture_us);
            copy.slot[i].used = copy.slot[i].assessed = true;
            copy.slot[i].camera = 0;
            copy.slot[i].hazard.conflict_probability = 0.0f;
            copy.slot[i].hazard.tcpa_s = 40.0f;
            copy.slot[i].detected_us = frame.capture_us - (late ? 1000001u : 1000000u);
        }
        frame.number = 2;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&copy, &frame));
        TEST_ASSERT_EQUAL(1, copy.counters.evicted);
        TEST_ASSERT_EQUAL(late ? 0 : 1, goe_flight_candidate_count(&copy.waiting));
    }
}

/* ------------------------------------------------------------------------------------------------------------- claims -- */

/* From the least to the largest of the visible points, and no smaller than 8 px. */
static void any_points_make_their_box(void) {
    for (int n = 0; n < TRIALS; n++) {
        goe_flight_detection_t d;
        int16_t box_px[4];
        memset(&d, 0, sizeof d);
        goe_pixel_t *const points[6] = {&d.left, &d.right, &d.top, &d.base_left, &d.base_near, &d.base_right};
        double low[2] = {1.0e9, 1.0e9};
        double high[2] = {-1.0e9, -1.0e9};
        const double size_px = one_in(2) ? 6.0 : 300.0;
        for (int i = 0; i < 6; i++) {
            points[i]->u_px = (float)between(-size_px, size_px);
            points[i]->v_px = (float)between(-size_px, size_px);
            points[i]->visible = one_in(2);
            for (int axis = 0; axis < 2 && points[i]->visible; axis++) {
                low[axis] = fmin(low[axis], (double)(axis == 0 ? points[i]->u_px : points[i]->v_px));
                high[axis] = fmax(high[axis], (double)(axis == 0 ? points[i]->u_px : points[i]->v_px));
            }
        }
        const bool found = goe_flight_slot_box_of(&d, box_px);
        TEST_ASSERT_EQUAL(low[0] < 1.0e8, found);
        for (int axis = 0; axis < 2 && found; axis++) {
            const double lacking = fmax(BOX_MIN_PX - (high[axis] - low[axis]), 0.0);
            CHECK_CLOSE(1.0, low[axis] - 0.5 * lacking, box_px[axis]);
            CHECK_CLOSE(1.0, high[axis] + 0.5 * lacking, box_px[axis + 2]);
        }
    }
}

/* A box claims an obstacle by how near its middle the predicted place lies, as a share of three quarters of the box, in both axes. */
static void a_box_claims_predictions_inside_it(void) {
    int some = 0;
    int none = 0;
    goe_flight_slot_t *slot = &flight->slot[0];
    goe_flight_slot_view_t view;
    goe_pose_t pose;
    memset(&view, 0, sizeof view);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(flight, flown_now_us(&flown), 0u, &pose, NULL));
    memcpy(view.pose.q, pose.attitude, sizeof view.pose.q);
    memcpy(view.pose.ned_m, pose.position_ned_m, sizeof view.pose.ned_m);
    for (int n = 0; n < TRIALS; n++) {
        float pixel[2];
        int16_t box_px[4];
        double claim = 1.0;
        slot->valid = (uint8_t)(GOE_HAS_POSITION | (one_in(2) ? GOE_HAS_HEIGHT : 0));
        slot->ground_down_m = view.pose.ned_m[2] + (float)between(-3.0, 30.0);
        slot->top_m = (float)between(2.0, 20.0);
        slot->center_ne_m[0] = view.pose.ned_m[0] + (float)between(40.0, 100.0);
        slot->center_ne_m[1] = view.pose.ned_m[1] + (float)between(-20.0, 20.0);
        const float own_m = fmaxf(slot->ground_down_m - view.pose.ned_m[2], 0.0f);
        const float up_m = 0.5f * ((slot->valid & GOE_HAS_HEIGHT) != 0u ? slot->top_m : own_m);
        const float point[3] = {slot->center_ne_m[0], slot->center_ne_m[1], slot->ground_down_m - up_m};
        if (!goe_flight_geometry_project(&flight->camera[0], &view.pose, point, pixel)) {
            continue;
        }
        for (int axis = 0; axis < 2; axis++) {
            const int half_px = 10 + (int)between(0.0, 30.0);
            const int middle_px = (int)pixel[axis] + (int)between(-60.0, 60.0);
            box_px[axis] = (int16_t)(middle_px - half_px);
            box_px[axis + 2] = (int16_t)(middle_px + half_px);
            claim *= fmax(1.0 - fabs((double)pixel[axis] - middle_px) / (1.5 * half_px), 0.0);
        }
        memcpy(slot->box_px, box_px, sizeof slot->box_px);
        CHECK_CLOSE(1.0e-3, claim, goe_flight_slot_claims(slot, flight->camera, &view, box_px));
        some += claim > 0.0 ? 1 : 0;
        none += claim > 0.0 ? 0 : 1;
    }
    TEST_ASSERT_TRUE(some > 200 && none > 200);
}

/* The box of a cylinder in this view, from many points of its surface, clipped to the image. Returns the area in square pixels. */
static double box_of_cylinder(const goe_flight_slot_view_t *view, const float center_ne_m[2], float ground_down_m,
                              float radius_m, float top_m, int16_t box_px[4]) {
    const goe_flight_camera_t *camera = &flight->camera[0];
    double extent[4] = {1.0e9, 1.0e9, -1.0e9, -1.0e9};
    for (int k = 0; k < 50 * 24; k++) {
        const double around = 2.0 * 3.14159265358979 * (k % 24) / 24.0;
        const float point[3] = {center_ne_m[0] + radius_m * (float)cos(around),
                                center_ne_m[1] + radius_m * (float)sin(around),
                                ground_down_m - top_m * (float)(k / 24) / 49.0f};
        float pixel[2] = {-1.0e6f, -1.0e6f};
        (void)goe_flight_geometry_project(camera, &view->pose, point, pixel);
        for (int i = 0; i < 4 && pixel[0] > -1.0e5f; i++) {
            extent[i] = i < 2 ? fmin(extent[i], (double)pixel[i]) : fmax(extent[i], (double)pixel[i % 2]);
        }
    }
    for (int i = 0; i < 4; i++) {
        box_px[i] = (int16_t)fmin(fmax(extent[i], 0.0), (double)camera->size_px[i % 2]);
    }
    return fmax(box_px[2] - box_px[0], 0.0) * fmax(box_px[3] - box_px[1], 0.0);
}

/* GIVEN a rolled camera, and an obstacle that comes back into view with another number, whole or cut by the border WHEN its size in the image has
 * changed THEN its box claims it, and claims it more than an obstacle 60 m to its side. */
static void a_box_claims_its_obstacle_in_a_rolled_camera(void) {
    int boxes = 0;
    int claimed = 0;
    int cut = 0;
    int wrong = 0;
    goe_flight_slot_view_t view;
    goe_pose_t pose;
    memset(&view, 0, sizeof view);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(flight, flown_now_us(&flown), 0u, &pose, NULL));
    memcpy(view.pose.ned_m, pose.position_ned_m, sizeof view.pose.ned_m);
    for (int n = 0; n < TRIALS; n++) {
        int16_t box_px[4];
        goe_flight_slot_t other;
        goe_flight_slot_t *slot = &flight->slot[0];
        const double roll = between(-0.6, 0.6);
        const double yaw = between(-0.8, 0.8);
        view.pose.q[0] = (float)(cos(0.5 * roll) * cos(0.5 * yaw));
        view.pose.q[1] = (float)(sin(0.5 * roll) * cos(0.5 * yaw));
        view.pose.q[2] = (float)(-sin(0.5 * roll) * sin(0.5 * yaw)); /* yaw first, then roll */
        view.pose.q[3] = (float)(cos(0.5 * roll) * sin(0.5 * yaw));
        slot->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
        slot->camera = 0;
        slot->ground_down_m = view.pose.ned_m[2] + 30.0f;
        slot->top_m = (float)between(20.0, 60.0);
        slot->width_m = (float)between(6.0, 15.0);
        slot->center_ne_m[0] = view.pose.ned_m[0] + (float)between(80.0, 250.0);
        slot->center_ne_m[1] = view.pose.ned_m[1] + (float)between(-60.0, 60.0);
        for (int i = 0; i < 4; i++) {
            slot->box_px[i] = (int16_t)(i < 2 ? 0 : 900); /* of a long time ago */
        }
        other = *slot;
        other.center_ne_m[1] += one_in(2) ? 60.0f : -60.0f;
        const double area =
            box_of_cylinder(&view, slot->center_ne_m, slot->ground_down_m, 0.5f * slot->width_m, slot->top_m, box_px);
        if (area < 400.0) {
            continue;
        }
        const float own = goe_flight_slot_claims(slot, flight->camera, &view, box_px);
        boxes++;
        claimed += own > 0.0f ? 1 : 0;
        cut += box_px[0] == 0 || box_px[1] == 0 || (float)box_px[2] >= flight->camera[0].size_px[0] ? 1 : 0;
        wrong += goe_flight_slot_claims(&other, flight->camera, &view, box_px) >= own ? 1 : 0;
    }
    TEST_ASSERT_TRUE(boxes > TRIALS / 4 && cut > boxes / 10);
    TEST_ASSERT_TRUE(claimed > 95 * boxes / 100);
    TEST_ASSERT_TRUE(wrong < 5 * boxes / 100);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(sides_count_by_their_visible_part);
    RUN_TEST(a_box_has_an_inside);
    RUN_TEST(points_and_numbers_have_their_ranges);
    RUN_TEST(a_bad_kind_loses_no_box);
    RUN_TEST(a_new_obstacle_takes_the_place_of_the_least_worth);
    RUN_TEST(a_passed_obstacle_in_view_makes_room_for_one_ahead);
    RUN_TEST(an_old_track_is_given_up);
    RUN_TEST(overlap_is_the_share_of_the_union);
    RUN_TEST(images_of_one_candidate_lie_at_most_a_second_apart);
    RUN_TEST(a_full_table_forgets_the_oldest);
    RUN_TEST(an_older_image_shortens_no_crowd);
    RUN_TEST(an_undetected_obstacle_does_not_wait);
    RUN_TEST(any_points_make_their_box);
    RUN_TEST(a_box_claims_predictions_inside_it);
    RUN_TEST(a_box_claims_its_obstacle_in_a_rolled_camera);
    return UNITY_END();
}
