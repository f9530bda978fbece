/* How clear an order is flown: against the region that goe_clear.c describes, traced point by point. SPDX-License-Identifier: MIT
 *
 * The places of obstacles, the ways and the turns are random; the trace knows nothing of the formulas under test. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_clear.h"

#define PI 3.14159265358979
#define STEP_M 0.25
#define TRACED_M 0.3 /* by what a trace of such steps may be off */
#define TRIALS 150

static check_random_t any;
static goe_flight_clear_own_t own;
static goe_flight_clear_way_t way;
static goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS];

void setUp(void) { any = check_random_start("flight clear"); }
void tearDown(void) {}

static float between(double low, double high) { return (float)check_random_between(&any, low, high); }

/* One obstacle without doubt about its place, and an order to the right or to the left of the course. */
static void any_encounter(void) {
    memset(&own, 0, sizeof own);
    memset(&way, 0, sizeof way);
    memset(slots, 0, sizeof slots);
    own.course_ne[0] = 1.0f;
    own.turn_m = between(40.0, 100.0);
    own.early_m = between(0.0, 15.0);
    own.late_m = own.early_m + between(0.0, 30.0);
    own.through_m = between(50.0, 150.0);
    way.target_m[0] = between(own.late_m + 10.0, 250.0);
    way.target_m[1] = between(-60.0, 60.0);
    way.line_m[0] = 1.0f;
    slots[0].counts = true;
    slots[0].at_m[0] = between(-60.0, 350.0);
    slots[0].at_m[1] = between(-150.0, 150.0);
    slots[0].radius_m = between(0.0, 10.0);
    slots[0].margin_m = 1000.0f; /* no share is cut off */
}

static double spare_m(void) {
    int nearest;
    const float share = goe_flight_clear_share(&own, slots, &way, -GOE_FLIGHT_CLEAR_MAX, &nearest);
    TEST_ASSERT_EQUAL(0, nearest);
    return (double)share * 1000.0;
}

/* ------------------------------------------------------------------------------------------------------------- trace -- */

static double least_m;
static double here_m[2];
static double heading;

static void look_from(double x, double y) {
    const double off_m = hypot((double)slots[0].at_m[0] - x, (double)slots[0].at_m[1] - y);
    least_m = off_m < least_m ? off_m : least_m;
}

static void fly_to(double x, double y) {
    const double way_m = hypot(x - here_m[0], y - here_m[1]);
    const double begin_m[2] = {here_m[0], here_m[1]};
    for (double flown_m = 0.0; flown_m <= way_m; flown_m += STEP_M) {
        const double share = way_m > 0.0 ? flown_m / way_m : 0.0;
        look_from(begin_m[0] + share * (x - begin_m[0]), begin_m[1] + share * (y - begin_m[1]));
    }
    here_m[0] = x;
    here_m[1] = y;
}

static void begin_trace(void) {
    least_m = 1.0e9;
    here_m[0] = here_m[1] = heading = 0.0;
}

/* Straight on to where the turn begins, by the turn's radius until the place lies ahead, and straight to it. Steers, as an autopilot
 * does: the turn ends when the place comes to lie ahead. */
static void fly_turn(double begin_m, double x, double y) {
    const double hand = y > 0.0 ? 1.0 : -1.0;
    const double turn_m = (double)own.turn_m;
    fly_to(begin_m, 0.0);
    for (double turned = 0.0; turned < 2.0 * PI; turned += STEP_M / turn_m) {
        const double at_x = begin_m + turn_m * sin(turned);
        const double at_y = hand * turn_m * (1.0 - cos(turned));
        const double ahead = (x - at_x) * cos(turned) + hand * (y - at_y) * sin(turned);
        const double aside = hand * (y - at_y) * cos(turned) - (x - at_x) * sin(turned);
        if (ahead > 0.0 && aside <= 0.0) {
            fly_to(x, y);
            return;
        }
        look_from(at_x, at_y);
        here_m[0] = at_x;
        here_m[1] = at_y;
    }
}

/* All straight ways from one place to another line, as a fan. */
static void fly_fan(const double from_m[2], const double a_m[2], const double b_m[2]) {
    for (int i = 0; i <= 400; i++) {
        const double share = (double)i / 400.0;
        here_m[0] = from_m[0];
        here_m[1] = from_m[1];
        fly_to(a_m[0] + share * (b_m[0] - a_m[0]), a_m[1] + share * (b_m[1] - a_m[1]));
    }
}

/* Within a fan the distance is that of the obstacle's middle: 0. */
static void check_spare(double within_m) {
    const double traced_m = least_m - within_m - (double)slots[0].radius_m;
    const double limit_m = traced_m < -(double)slots[0].radius_m ? -(double)slots[0].radius_m : traced_m;
    const double found_m = spare_m();
    TEST_ASSERT_TRUE_MESSAGE(fabs(found_m - limit_m) < TRACED_M + 0.5 * within_m / 400.0, "spare");
}

/* ------------------------------------------------------------------------------------------------------------- tests -- */

/* GIVEN a target that is flown through THEN the least distance is that of the late turn, the fan of early ones and the line behind. */
static void a_target_is_flown_through_by_turns_of_every_delay(void) {
    for (int n = 0; n < TRIALS; n++) {
        any_encounter();
        if (n % 2 == 1) { /* almost abeam: more than a quarter of a circle */
            way.target_m[0] = between(own.late_m + 1.0, own.late_m + 30.0);
            way.target_m[1] = (n % 4 == 1 ? 1.0f : -1.0f) * between(100.0, 260.0);
        }
        const double early_m[2] = {(double)own.early_m, 0.0};
        const double target_m[2] = {(double)way.target_m[0], (double)way.target_m[1]};
        begin_trace();
        fly_turn((double)own.late_m, target_m[0], target_m[1]);
        if (here_m[0] != target_m[0]) { /* within the turn's circle: it is flown */
            continue;
        }
        here_m[0] = early_m[0];
        here_m[1] = 0.0;
        fly_to(target_m[0], target_m[1]);
        fly_to(target_m[0] + (double)own.through_m, target_m[1]);
        check_spare(0.0);
    }
}

/* ... and where an autopilot may leave its line at once by 45 degrees, of everything between that and the straight way. */
static void a_line_may_be_left_at_once(void) {
    for (int n = 0; n < TRIALS; n++) {
        any_encounter();
        const double angle = check_random_between(&any, -0.3, 0.3);
        const double line[2] = {cos(angle), sin(angle)};
        way.line_m[0] = (float)line[0];
        way.line_m[1] = (float)line[1];
        way.shifts = true;
        const double early_m[2] = {(double)own.early_m, 0.0};
        const double target_m[2] = {(double)way.target_m[0], (double)way.target_m[1]};
        const double to[2] = {target_m[0] - early_m[0], target_m[1]};
        const double aside = line[0] * to[1] - line[1] * to[0];
        const double along = line[0] * to[0] + line[1] * to[1];
        const double ahead = along < fabs(aside) ? (along > 0.0 ? along : 0.0) : fabs(aside);
        const double sideways_m[2] = {early_m[0] + ahead * line[0] - aside * line[1],
                                      early_m[1] + ahead * line[1] + aside * line[0]};
        begin_trace();
        fly_turn((double)own.late_m, target_m[0], target_m[1]);
        if (here_m[0] != target_m[0]) {
            continue;
        }
        fly_fan(early_m, target_m, sideways_m);
        here_m[0] = target_m[0];
        here_m[1] = target_m[1];
        fly_to(target_m[0] + (double)own.through_m * line[0], target_m[1] + (double)own.through_m * line[1]);
        check_spare(0.0);
    }
}

/* GIVEN a target that is circled THEN also the disc about it is the way, and the fan reaches to both sides of the disc. */
static void a_circle_is_flown_about_the_target(void) {
    for (int n = 0; n < TRIALS; n++) {
        any_encounter();
        way.circle_m = between(20.0, 60.0);
        const double early_m[2] = {(double)own.early_m, 0.0};
        const double to[2] = {(double)way.target_m[0] - early_m[0], (double)way.target_m[1]};
        const double off_m = hypot(to[0], to[1]);
        const double circle_m = (double)way.circle_m;
        const double nearer = (way.target_m[1] > 0.0f ? 1.0 : -1.0) * circle_m / off_m;
        const double inner_m[2] = {(double)way.target_m[0] + nearer * to[1], (double)way.target_m[1] - nearer * to[0]};
        const double outer_m[2] = {(double)way.target_m[0] - nearer * to[1], (double)way.target_m[1] + nearer * to[0]};
        const double from_disc_m = hypot((double)slots[0].at_m[0] - (double)way.target_m[0],
                                         (double)slots[0].at_m[1] - (double)way.target_m[1]) -
                                   circle_m;
        begin_trace();
        if (off_m <= circle_m) { /* on the circle already */
            fly_to((double)own.late_m, 0.0);
        } else {
            fly_turn((double)own.late_m, inner_m[0], inner_m[1]);
            if (here_m[0] != inner_m[0]) {
                continue;
            }
            fly_fan(early_m, inner_m, outer_m);
        }
        const double traced_m = (least_m < from_disc_m ? least_m : from_disc_m) - (double)slots[0].radius_m;
        CHECK_CLOSE(TRACED_M + 0.1, traced_m, spare_m());
    }
}

#define BEGINS 100

/* GIVEN a target abeam or behind THEN the turns of every delay are the way, of more than half a circle where that is needed. On the ground of
 * the turns between, the distance is that of the obstacle's middle. */
static void a_turn_away_is_flown_from_every_delay(void) {
    int swept = 0;
    int missed = 0;
    for (int n = 0; n < TRIALS * 10; n++) {
        any_encounter();
        own.late_m = own.early_m + between(0.0, n % 2 == 0 ? 30.0 : 120.0);
        way.turns_away = true;
        way.target_m[0] = between(-150.0, 10.0);
        way.target_m[1] = between(-250.0, 250.0);
        slots[0].at_m[0] = between(-60.0, 250.0);
        begin_trace();
        fly_turn((double)own.early_m, (double)way.target_m[0], (double)way.target_m[1]);
        here_m[0] = here_m[1] = 0.0;
        fly_turn((double)own.late_m, (double)way.target_m[0], (double)way.target_m[1]);
        const double edge_m = least_m;
        const double step_m = (double)(own.late_m - own.early_m) / BEGINS;
        for (int i = 1; i < BEGINS; i++) {
            here_m[0] = here_m[1] = 0.0;
            fly_turn((double)own.early_m + step_m * i, (double)way.target_m[0], (double)way.target_m[1]);
        }
        const double found_m = spare_m() + (double)slots[0].radius_m;
        if (edge_m > TRACED_M + step_m && least_m < 0.25) {
            missed +=
                fabs(found_m) > TRACED_M ? 1 : 0; /* the ends of the arcs lie on a curve, just outside the triangle */
            swept++;
        } else if (least_m > TRACED_M + step_m) {
            CHECK_CLOSE(TRACED_M, edge_m, found_m);
        }
    }
    check_report("between the turns", (double)swept);
    TEST_ASSERT_TRUE(swept > 40 && swept > 20 * missed);
}

/* GIVEN an aircraft that is slow for its delay WHEN it turns away to circle at once THEN early turns lead to the target and late ones around
 * it: no path is called clear on the ground of any of them. */
static void a_turn_away_at_once_is_flown_from_every_delay(void) {
    int swept = 0;
    for (int n = 0; n < TRIALS * 10; n++) {
        any_encounter();
        own.turn_m = between(15.0, 60.0);
        own.early_m = between(5.0, 20.0);
        own.late_m = own.early_m + own.turn_m * between(1.0, 2.5);
        way.turns_away = true;
        way.target_m[0] = own.late_m;
        way.target_m[1] = n % 2 == 0 ? own.turn_m : -own.turn_m;
        slots[0].at_m[0] = own.late_m + own.turn_m * between(-3.0, 1.0);
        slots[0].at_m[1] = way.target_m[1] * between(0.0, 2.0);
        begin_trace();
        const double step_m = (double)(own.late_m - own.early_m) / BEGINS;
        for (int i = 0; i <= BEGINS; i++) {
            here_m[0] = here_m[1] = 0.0;
            fly_turn((double)own.early_m + step_m * i, (double)way.target_m[0], (double)way.target_m[1]);
        }
        if (least_m < 0.25) {
            TEST_ASSERT_TRUE(spare_m() + (double)slots[0].radius_m < 2.0);
            swept++;
        }
    }
    TEST_ASSERT_TRUE(swept > 100);
}

/* Doubt about the place: before it along the nearest distance, on the way past it also across the line of sight: the less of both. */
static void doubt_about_the_place_is_taken_off(void) {
    for (int n = 0; n < TRIALS; n++) {
        any_encounter();
        own.late_m = 0.0f;
        own.early_m = 0.0f;
        way.turns_away = n % 2 == 0;
        way.target_m[0] = 200.0f; /* straight on */
        way.target_m[1] = 0.0f;
        slots[0].at_m[0] = between(20.0, 180.0);
        slots[0].radius_m = 0.0f;
        slots[0].across_sd_m = between(0.0, 5.0);
        slots[0].variance_m2[0] = between(0.0, 25.0);
        slots[0].variance_m2[2] = between(0.0, 25.0);
        way.circle_m = 0.0f;
        const double exact_m = spare_m();
        way.sigmas = between(1.0, 3.0);
        const double nearest_sd_m = sqrt((double)slots[0].variance_m2[2]);
        const double sd_m = way.turns_away ? nearest_sd_m : fmin(nearest_sd_m, (double)slots[0].across_sd_m);
        if (fabs(exact_m) > 0.5) {
            CHECK_CLOSE(0.02, exact_m - (double)way.sigmas * sd_m, spare_m());
        }
    }
}

/* ... abeam of a turn along the line from its center: half of a variance that lies ahead. */
static void doubt_abeam_of_a_turn_lies_along_its_radius(void) {
    for (int side = -1; side <= 1; side += 2) {
        any_encounter();
        own.early_m = own.late_m = 0.0f;
        own.turn_m = 60.0f;
        way.turns_away = true;
        way.target_m[0] = -100.0f;
        way.target_m[1] = 120.0f * (float)side;
        slots[0].at_m[0] = 90.0f * 0.70710678f; /* 30 m outside of the turn, ahead and on its outer side */
        slots[0].at_m[1] = (60.0f - 90.0f * 0.70710678f) * (float)side;
        slots[0].radius_m = 0.0f;
        CHECK_CLOSE(0.01, 30.0, spare_m());
        slots[0].variance_m2[0] = 8.0f;
        way.sigmas = 1.0f;
        CHECK_CLOSE(0.01, 28.0, spare_m());
        slots[0].variance_m2[0] = 0.0f;
        slots[0].variance_m2[2] = 18.0f;
        CHECK_CLOSE(0.01, 27.0, spare_m());
    }
}

/* The share is that of the margin wanted; the nearest is of the least share, and none is named where all is clear. */
static void the_nearest_is_that_of_the_least_share(void) {
    int nearest;
    any_encounter();
    way.target_m[1] = 0.0f;
    for (int i = 0; i < 3; i++) {
        slots[i].counts = true;
        slots[i].at_m[0] = 20.0f;
        slots[i].at_m[1] = 30.0f;
        slots[i].radius_m = 10.0f;
        slots[i].margin_m = i == 1 ? 40.0f : 25.0f;
    }
    CHECK_CLOSE(1.0e-4, 0.5, goe_flight_clear_share(&own, slots, &way, -GOE_FLIGHT_CLEAR_MAX, &nearest));
    TEST_ASSERT_EQUAL(1, nearest);
    slots[1].counts = false;
    CHECK_CLOSE(1.0e-4, 0.8, goe_flight_clear_share(&own, slots, &way, -GOE_FLIGHT_CLEAR_MAX, &nearest));
    TEST_ASSERT_EQUAL(0, nearest);
    slots[0].at_m[1] = slots[2].at_m[1] = 1000.0f;
    CHECK_CLOSE(0.0, (double)GOE_FLIGHT_CLEAR_MAX,
                goe_flight_clear_share(&own, slots, &way, -GOE_FLIGHT_CLEAR_MAX, &nearest));
    TEST_ASSERT_EQUAL(-1, nearest);
}

/* Places and directions, ahead and to the right of any course. */
static void the_frame_is_that_of_the_course(void) {
    for (int n = 0; n < 50; n++) {
        const double course = check_random_between(&any, -PI, PI);
        const double ahead = check_random_between(&any, -100.0, 100.0);
        const double right = check_random_between(&any, -100.0, 100.0);
        any_encounter();
        own.course_ne[0] = (float)cos(course);
        own.course_ne[1] = (float)sin(course);
        own.ned_m[0] = 30.0f;
        own.ned_m[1] = -40.0f;
        const float direction[2] = {(float)(ahead * cos(course) - right * sin(course)),
                                    (float)(ahead * sin(course) + right * cos(course))};
        const float place[2] = {30.0f + direction[0], -40.0f + direction[1]};
        float turned[2];
        goe_flight_clear_direct(&own, direction, turned);
        CHECK_CLOSE(1.0e-3, ahead, turned[0]);
        CHECK_CLOSE(1.0e-3, right, turned[1]);
        goe_flight_clear_relate(&own, place, turned);
        CHECK_CLOSE(1.0e-3, ahead, turned[0]);
        CHECK_CLOSE(1.0e-3, right, turned[1]);
    }
}

/* GIVEN an obstacle of unlike sigmas ahead and aside, on any course THEN they are its sigmas in the frame of the course. */
static void the_covariance_turns_with_the_course(void) {
    static goe_flight_t flight;
    for (int n = 0; n < 50; n++) {
        const double c = cos(0.1 * n);
        const double s = sin(0.1 * n);
        memset(&flight, 0, sizeof flight);
        any_encounter();
        goe_flight_settings_default(&flight.settings);
        own.course_ne[0] = (float)c;
        own.course_ne[1] = (float)s;
        goe_flight_slot_t *slot = &flight.slot[0];
        slot->used = true;
        slot->valid = GOE_HAS_POSITION;
        slot->center_ne_m[0] = (float)(100.0 * c); /* ahead: 4 m^2 there, 9 across, -2 between */
        slot->center_ne_m[1] = (float)(100.0 * s);
        slot->covariance_ne_m2[0] = (float)(4.0 * c * c + 9.0 * s * s + 4.0 * c * s);
        slot->covariance_ne_m2[1] = (float)(-5.0 * c * s - 2.0 * (c * c - s * s));
        slot->covariance_ne_m2[2] = (float)(4.0 * s * s + 9.0 * c * c - 4.0 * c * s);
        goe_flight_clear_slots(&flight, &own, slots);
        TEST_ASSERT_TRUE(slots[0].counts);
        TEST_ASSERT_FALSE(slots[1].counts);
        CHECK_CLOSE(1.0e-4, 4.0, slots[0].variance_m2[0]);
        CHECK_CLOSE(1.0e-4, -2.0, slots[0].variance_m2[1]);
        CHECK_CLOSE(1.0e-4, 9.0, slots[0].variance_m2[2]);
        CHECK_CLOSE(1.0e-4, 3.0, slots[0].across_sd_m);
        CHECK_CLOSE(1.0e-3, 100.0, slots[0].at_m[0]);
        CHECK_CLOSE(1.0e-3, 0.0, slots[0].at_m[1]);
    }
}

/* On the way itself the distance is nothing, whichever sigma counts; and no share is below the least. */
static void an_obstacle_on_the_way_has_no_distance(void) {
    for (int turns = 0; turns < 2; turns++) {
        int nearest;
        any_encounter();
        own.late_m = 30.0f;
        way.turns_away = turns != 0;
        way.target_m[0] = turns ? -100.0f : 200.0f;
        way.target_m[1] = turns ? 200.0f : 0.0f;
        way.sigmas = 2.0f;
        slots[0].at_m[0] = 20.0f;
        slots[0].at_m[1] = 0.0f;
        slots[0].radius_m = 10.0f;
        slots[0].margin_m = 100.0f;
        slots[0].across_sd_m = 0.0f;
        CHECK_CLOSE(1.0e-3, -0.1, goe_flight_clear_share(&own, slots, &way, -10.0f, &nearest));
        TEST_ASSERT_EQUAL(0, nearest);
        slots[0].margin_m = 1.0f;
        CHECK_SAME(-GOE_FLIGHT_CLEAR_MAX, goe_flight_clear_share(&own, slots, &way, -10.0f, &nearest));
    }
}

/* Over an obstacle's middle no line of sight is known; its sigma is a number all the same. */
static void over_the_middle_a_sigma_is_a_number(void) {
    static goe_flight_t flight;
    memset(&flight, 0, sizeof flight);
    any_encounter();
    goe_flight_settings_default(&flight.settings);
    flight.slot[0].used = true;
    flight.slot[0].valid = GOE_HAS_POSITION;
    flight.slot[0].covariance_ne_m2[0] = flight.slot[0].covariance_ne_m2[2] = 4.0f;
    goe_flight_clear_slots(&flight, &own, slots);
    TEST_ASSERT_TRUE(slots[0].counts && check_is_finite(slots[0].across_sd_m));
}

/* [flight.margin_m] Shares are those of the margin; without one, of a meter. */
static void a_margin_is_at_least_a_meter(void) {
    static goe_flight_t flight;
    static const float wanted_m[] = {0.0f, 0.5f, 1.0f, 15.0f};
    for (int i = 0; i < 4; i++) {
        memset(&flight, 0, sizeof flight);
        any_encounter();
        goe_flight_settings_default(&flight.settings);
        flight.settings.margin_m = wanted_m[i];
        flight.slot[0].used = true;
        flight.slot[0].valid = GOE_HAS_POSITION;
        goe_flight_clear_slots(&flight, &own, slots);
        CHECK_SAME(wanted_m[i] > 1.0f ? wanted_m[i] : 1.0f, slots[0].margin_m);
    }
}

/* GIVEN a turn of less than a meter to a place abeam THEN it is a quarter of a circle, whose other three quarters are not flown. */
static void a_small_turn_is_no_whole_circle(void) {
    for (int side = -1; side <= 1; side += 2) {
        any_encounter();
        own.early_m = own.late_m = 10.0f;
        own.turn_m = 0.95f;
        way.turns_away = true;
        way.target_m[0] = 10.0f;
        way.target_m[1] = 20.0f * (float)side;
        slots[0].at_m[0] = 8.9f;
        slots[0].at_m[1] = 0.75f * (float)side;
        slots[0].radius_m = 0.0f;
        begin_trace();
        fly_turn(10.0, (double)way.target_m[0], (double)way.target_m[1]);
        const double from_circle_m = hypot(8.9 - 10.0, 0.75 - 0.95) - 0.95;
        TEST_ASSERT_TRUE(least_m > from_circle_m + 1.5 * TRACED_M);
        CHECK_CLOSE(TRACED_M, least_m, spare_m());
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_margin_is_at_least_a_meter);
    RUN_TEST(a_small_turn_is_no_whole_circle);
    RUN_TEST(an_obstacle_on_the_way_has_no_distance);
    RUN_TEST(over_the_middle_a_sigma_is_a_number);
    RUN_TEST(a_target_is_flown_through_by_turns_of_every_delay);
    RUN_TEST(a_line_may_be_left_at_once);
    RUN_TEST(a_circle_is_flown_about_the_target);
    RUN_TEST(a_turn_away_is_flown_from_every_delay);
    RUN_TEST(a_turn_away_at_once_is_flown_from_every_delay);
    RUN_TEST(doubt_about_the_place_is_taken_off);
    RUN_TEST(doubt_abeam_of_a_turn_lies_along_its_radius);
    RUN_TEST(the_nearest_is_that_of_the_least_share);
    RUN_TEST(the_frame_is_that_of_the_course);
    RUN_TEST(the_covariance_turns_with_the_course);
    return UNITY_END();
}
