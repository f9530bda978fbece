/* Closest approach: against brute force in double, and its sigmas and probability against random truths.
 * SPDX-License-Identifier: MIT
 *
 * The answers that goe_hazard works on are written into the estimator, so that every number of them is known. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_covariance.h"
#include "goe_guard.h"
#include "inverse.h"
#include "refined/goe_observation.h"
#include "refined/goe_refined.h"
#include "scene.h"
#include "stated.h"

#define RAD_PER_DEG 0.017453292519943295
#define SAMPLES 8000

/* An obstacle as the reference sees it: relative to the camera, T axes. */
typedef struct {
    bool box;
    double x_m, z_m, width_m, length_m, orientation_deg, height_m;
} obstacle_t;

typedef struct {
    double tcpa_s, dcpa_m, clearance_m;
} truth_t;

static goe_estimator_t estimator;
static check_random_t any;

static void start(void) {
    stated_start(&estimator, GOE_METHOD_WINDOW);
    estimator.motion.height_m = 50.0f;
}

void setUp(void) { start(); }
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- the answer -- */

static void give(goe_estimate_t *e, const obstacle_t *o) {
    memset(e, 0, sizeof *e);
    e->model = o->box ? GOE_MODEL_LINE : GOE_MODEL_DISC;
    e->method = GOE_METHOD_WINDOW;
    e->fresh = true;
    e->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
    e->x0_m = e->x_m = (float)o->x_m;
    e->z0_m = e->z_m = (float)o->z_m;
    e->width_m = (float)o->width_m;
    e->height_m = (float)o->height_m;
    if (o->box) {
        e->valid |= GOE_HAS_ORIENTATION | GOE_HAS_LENGTH;
        e->length_m = (float)o->length_m;
        e->orientation_deg = (float)o->orientation_deg;
        e->length_axis[0] = (float)sin(o->orientation_deg * RAD_PER_DEG);
        e->length_axis[1] = (float)cos(o->orientation_deg * RAD_PER_DEG);
        e->width_axis[0] = e->length_axis[1];
        e->width_axis[1] = -e->length_axis[0];
    }
}

static goe_hazard_t foresee(const goe_intent_t *intent) {
    goe_hazard_t hazard;
    const goe_estimator_t before = estimator;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, intent, &hazard));
    TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
    return hazard;
}

/* heading north: T's X is east, its Z north */
static goe_intent_t intent_of(double z_m_s, double x_m_s, double climb_m_s) {
    const goe_intent_t intent = {{(float)z_m_s, (float)x_m_s, (float)-climb_m_s}, 5.0f, 10.0f, 0.0f, 0.0f};
    return intent;
}

/* -------------------------------------------------------------------------------------------------------- the reference -- */

static double distance_to_segment(double px, double pz, const double a[2], const double b[2]) {
    const double dx = b[0] - a[0];
    const double dz = b[1] - a[1];
    const double norm2 = dx * dx + dz * dz;
    double t = norm2 > 0.0 ? ((px - a[0]) * dx + (pz - a[1]) * dz) / norm2 : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    return hypot(px - a[0] - t * dx, pz - a[1] - t * dz);
}

static void corners(const obstacle_t *o, double corner[4][2]) {
    const double s = sin(o->orientation_deg * RAD_PER_DEG);
    const double c = cos(o->orientation_deg * RAD_PER_DEG);
    static const double across[4] = {-0.5, -0.5, 0.5, 0.5};
    static const double along[4] = {0.0, 1.0, 1.0, 0.0};
    for (int i = 0; i < 4; i++) {
        corner[i][0] = o->x_m + across[i] * o->width_m * c + along[i] * o->length_m * s;
        corner[i][1] = o->z_m - across[i] * o->width_m * s + along[i] * o->length_m * c;
    }
}

/* Horizontal distance of a point from the outline, 0 inside. */
static double distance_from(const obstacle_t *o, double px, double pz) {
    double corner[4][2];
    double least = 1e30;
    bool inside = true;
    if (!o->box) {
        return fmax(hypot(px - o->x_m, pz - o->z_m) - 0.5 * o->width_m, 0.0);
    }
    corners(o, corner);
    for (int i = 0; i < 4; i++) {
        const double *a = corner[i];
        const double *b = corner[(i + 1) % 4];
        inside = inside && (b[0] - a[0]) * (pz - a[1]) - (b[1] - a[1]) * (px - a[0]) <= 0.0;
        least = fmin(least, distance_to_segment(px, pz, a, b));
    }
    return inside ? 0.0 : least;
}

static double distance_at(const obstacle_t *o, const goe_intent_t *intent, double t) {
    return distance_from(o, t * (double)intent->velocity_ned_m_s[1], t * (double)intent->velocity_ned_m_s[0]);
}

/* End of the flight over the outline next to `in`, which is over it; `out` is not. */
static double outline_end(const obstacle_t *o, const goe_intent_t *intent, double out, double in) {
    for (int i = 0; i < 35; i++) {
        const double t = 0.5 * (out + in);
        if (distance_at(o, intent, t) > 0.0) {
            out = t;
        } else {
            in = t;
        }
    }
    return in;
}

/* The distance is convex in time: nested intervals, then the ends of the crossing. */
static truth_t truth_of(const obstacle_t *o, const goe_intent_t *intent) {
    const double climb = -(double)intent->velocity_ned_m_s[2];
    const double longest = 400.0;
    double low = 0.0;
    double high = longest;
    double over = distance_at(o, intent, 0.0) > 0.0 ? -1.0 : 0.0; /* a time over the outline */
    for (int i = 0; i < 60 && over < 0.0; i++) {
        const double a = low + (high - low) / 3.0;
        const double b = high - (high - low) / 3.0;
        const double at_a = distance_at(o, intent, a);
        const double at_b = distance_at(o, intent, b);
        over = at_a > 0.0 ? at_b > 0.0 ? -1.0 : b : a;
        if (at_a <= at_b) {
            high = b;
        } else {
            low = a;
        }
    }
    truth_t truth = {low, distance_at(o, intent, low), 0.0};
    double lowest = truth.tcpa_s;
    if (over >= 0.0) {
        truth.dcpa_m = 0.0;
        truth.tcpa_s = over > 0.0 ? outline_end(o, intent, 0.0, over) : 0.0;
        lowest = climb < 0.0 ? outline_end(o, intent, longest, over) : truth.tcpa_s;
    }
    truth.clearance_m = (double)estimator.motion.height_m + climb * lowest - o->height_m;
    return truth;
}

static obstacle_t random_obstacle(check_random_t *random, bool box) {
    const obstacle_t o = {box,
                          check_random_between(random, -60.0, 60.0),
                          check_random_between(random, -80.0, 200.0),
                          check_random_between(random, 1.0, 40.0),
                          check_random_between(random, 1.0, 60.0),
                          check_random_between(random, -89.9, 90.0),
                          check_random_between(random, 2.0, 80.0)};
    return o;
}

/* [goe_approach.c, goe_hazard, goe_outline.c] */
static void any_obstacle_is_met_as_brute_force_says(void) {
    check_random_t random = check_random_start("closest approach");
    double worst_time = 0.0;
    double worst_miss = 0.0;
    double worst_clearance = 0.0;
    for (int i = 0; i < 20000; i++) {
        const obstacle_t o = random_obstacle(&random, i % 3 != 0);
        const goe_intent_t intent =
            intent_of(check_random_between(&random, -30.0, 30.0), check_random_between(&random, -30.0, 30.0),
                      check_random_between(&random, -4.0, 4.0));
        const double speed = hypot((double)intent.velocity_ned_m_s[0], (double)intent.velocity_ned_m_s[1]);
        const truth_t truth = truth_of(&o, &intent);
        if (speed < 1.0 || (truth.dcpa_m > 0.0 && truth.dcpa_m < 0.01)) {
            continue; /* a graze: rounding decides on which side, and the time jumps from a corner to an entry */
        }
        give(&estimator.estimate, &o);
        const goe_hazard_t hazard = foresee(&intent);
        check_worst(&worst_miss, (double)hazard.dcpa_m - truth.dcpa_m);
        check_worst(&worst_time, ((double)hazard.tcpa_s - truth.tcpa_s) * speed);
        check_worst(&worst_clearance, (double)hazard.clearance_m - truth.clearance_m);
    }
    check_report("worst miss, m", worst_miss);
    check_report("worst time times speed, m", worst_time);
    check_report("worst clearance, m", worst_clearance);
    TEST_ASSERT_TRUE(worst_miss < 1e-3);
    TEST_ASSERT_TRUE(worst_time < 0.05);
    TEST_ASSERT_TRUE(worst_clearance < 0.05);
}

/* ------------------------------------------------------------------------------------------------------- known places -- */

static void a_chimney_ahead_is_reached_at_its_near_side(void) {
    const obstacle_t chimney = {false, 0.0, 103.0, 6.0, 0.0, 0.0, 60.0};
    const goe_intent_t intent = intent_of(20.0, 0.0, 1.0);
    give(&estimator.estimate, &chimney);
    const goe_hazard_t hazard = foresee(&intent);
    CHECK_CLOSE(1e-5, 5.0, hazard.tcpa_s);
    CHECK_CLOSE(0.0, 0.0, hazard.dcpa_m);
    CHECK_CLOSE(1e-4, 50.0 + 5.0 - 60.0, hazard.clearance_m);
    TEST_ASSERT_TRUE(hazard.has_clearance);
    CHECK_CLOSE(0.0, 1.0, hazard.conflict_probability); /* no sigma, no doubt */
}

/* [goe_outline.c] */
static void turning_t_turns_the_answer_along(void) {
    /* GIVEN T at 30 degrees from north THEN the same flight relative to T meets the same obstacle */
    const obstacle_t o = {true, -15.0, 80.0, 8.0, 20.0, 25.0, 12.0};
    goe_intent_t intent = intent_of(25.0, 3.0, -1.0);
    give(&estimator.estimate, &o);
    const goe_hazard_t before = foresee(&intent);
    const double angle = 30.0 * RAD_PER_DEG;
    estimator.motion.heading_cos = (float)cos(angle);
    estimator.motion.heading_sin = (float)sin(angle);
    intent.velocity_ned_m_s[0] = (float)(25.0 * cos(angle) - 3.0 * sin(angle));
    intent.velocity_ned_m_s[1] = (float)(25.0 * sin(angle) + 3.0 * cos(angle));
    const goe_hazard_t after = foresee(&intent);
    CHECK_CLOSE(1e-4, before.tcpa_s, after.tcpa_s);
    CHECK_CLOSE(1e-4, before.dcpa_m, after.dcpa_m);
    CHECK_CLOSE(1e-4, before.clearance_m, after.clearance_m);
}

static void an_obstacle_behind_is_as_far_as_now(void) {
    const obstacle_t behind = {true, 10.0, -60.0, 8.0, 20.0, 0.0, 12.0};
    const goe_intent_t intent = intent_of(25.0, 0.0, 2.0);
    give(&estimator.estimate, &behind);
    estimator.estimate.sigma.x0_m = estimator.estimate.sigma.z0_m = 1.0f;
    const goe_hazard_t hazard = foresee(&intent);
    CHECK_CLOSE(0.0, 0.0, hazard.tcpa_s);
    CHECK_CLOSE(0.0, 0.0, hazard.tcpa_sd_s);
    CHECK_CLOSE(1e-4, hypot(6.0, 40.0), hazard.dcpa_m);
    CHECK_CLOSE(1e-4, 1.0, hazard.dcpa_sd_m);
    CHECK_CLOSE(1e-5, 38.0, hazard.clearance_m);
    CHECK_CLOSE(1e-6, 0.0, hazard.conflict_probability);
}

/* [goe_hazard_t.clearance_m] */
static void over_the_roof_the_distance_is_none(void) {
    const obstacle_t o = {true, 0.0, -10.0, 20.0, 30.0, 0.0, 45.0};
    const goe_intent_t level = intent_of(10.0, 0.0, 0.0);
    const goe_intent_t descending = intent_of(10.0, 0.0, -2.0);
    give(&estimator.estimate, &o);
    const goe_hazard_t now = foresee(&level);
    CHECK_CLOSE(0.0, 0.0, now.tcpa_s);
    CHECK_CLOSE(0.0, 0.0, now.dcpa_m);
    CHECK_CLOSE(1e-5, 5.0, now.clearance_m);
    CHECK_CLOSE(0.0, 1.0, now.conflict_probability);
    /* AND descending, the roof's far edge counts, 20 m on */
    CHECK_CLOSE(1e-4, 5.0 - 4.0, foresee(&descending).clearance_m);
}

/* [goe_intent_t.velocity_ned_m_s] */
static void standing_still_the_distance_is_that_of_now(void) {
    const obstacle_t boxes[2] = {{true, 30.0, 0.0, 20.0, 40.0, 0.0, 20.0}, {false, 26.0, 0.0, 12.0, 0.0, 0.0, 20.0}};
    const goe_intent_t still = intent_of(0.0, 0.0, -3.0);
    for (int i = 0; i < 2; i++) {
        give(&estimator.estimate, &boxes[i]);
        estimator.estimate.sigma.x0_m = 10.0f;
        estimator.estimate.sigma.height_m = 10.0f;
        const goe_hazard_t hazard = foresee(&still);
        CHECK_CLOSE(0.0, 0.0, hazard.tcpa_s);
        CHECK_CLOSE(1e-5, 20.0, hazard.dcpa_m);
        CHECK_CLOSE(1e-5, 10.0, hazard.dcpa_sd_m);
        CHECK_CLOSE(1e-5, 30.0, hazard.clearance_m);
        CHECK_CLOSE(2e-6, 0.0668072 * 0.0227501, hazard.conflict_probability); /* 1.5 and 2 sigma off */
    }
}

/* [goe_intent_t.velocity_ned_m_s] GIVEN less than 0.1 m/s over the ground THEN the aircraft stands still; GIVEN more THEN it moves. */
static void a_creep_is_taken_as_standing_still(void) {
    const obstacle_t chimney = {false, 0.0, 103.0, 6.0, 0.0, 0.0, 60.0};
    const goe_intent_t creeping = intent_of(0.0999, 0.0, 1.0);
    const goe_intent_t moving = intent_of(0.1001, 0.0, 1.0);
    give(&estimator.estimate, &chimney);
    CHECK_CLOSE(0.0, 0.0, foresee(&creeping).tcpa_s);
    CHECK_CLOSE(1e-4, 100.0, foresee(&creeping).dcpa_m);
    CHECK_CLOSE(0.1, 100.0 / 0.1001, foresee(&moving).tcpa_s);
    CHECK_CLOSE(0.0, 0.0, foresee(&moving).dcpa_m);
}

/* GIVEN an image that is two seconds old THEN the aircraft has flown on, and climbed, and times count from now. */
static void since_the_image_the_aircraft_has_flown_on(void) {
    const obstacle_t chimney = {false, 0.0, 143.0, 6.0, 0.0, 0.0, 60.0};
    goe_intent_t intent = intent_of(20.0, 0.0, 1.0);
    give(&estimator.estimate, &chimney);
    CHECK_CLOSE(1e-5, 7.0, foresee(&intent).tcpa_s);
    intent.since_image_s = 2.0f;
    const goe_hazard_t hazard = foresee(&intent);
    CHECK_CLOSE(1e-5, 5.0, hazard.tcpa_s);
    CHECK_CLOSE(1e-4, 50.0 + 7.0 - 60.0, hazard.clearance_m);
    intent.since_image_s = 8.0f; /* 17 m behind the far side */
    CHECK_CLOSE(0.0, 0.0, foresee(&intent).tcpa_s);
    CHECK_CLOSE(1e-4, 14.0, foresee(&intent).dcpa_m);
}

/* [goe_hazard_t.tcpa_s] */
static void a_camera_in_the_middle_of_a_disc_has_an_answer(void) {
    const obstacle_t o = {false, 0.0, 0.0, 10.0, 0.0, 0.0, 45.0};
    const goe_intent_t plans[2] = {intent_of(0.0, 0.0, 0.0), intent_of(0.0, 15.0, 0.0)};
    give(&estimator.estimate, &o);
    for (int i = 0; i < 2; i++) {
        const goe_hazard_t hazard = foresee(&plans[i]);
        CHECK_CLOSE(0.0, 0.0, hazard.dcpa_m);
        CHECK_CLOSE(0.0, 1.0, hazard.conflict_probability);
    }
}

/* [goe_hazard] */
static void unknown_dimensions_leave_a_circle_or_a_point(void) {
    const obstacle_t o = {true, 20.0, 100.0, 10.0, 40.0, 0.0, 12.0};
    const goe_intent_t intent = intent_of(20.0, 0.0, 0.0);
    give(&estimator.estimate, &o);
    estimator.estimate.valid &= ~(GOE_HAS_LENGTH | GOE_HAS_HEIGHT);
    estimator.estimate.length_m = 0.0f;
    estimator.estimate.height_m = 0.0f;
    const goe_hazard_t circle = foresee(&intent);
    CHECK_CLOSE(1e-4, 15.0, circle.dcpa_m);
    CHECK_CLOSE(1e-5, 5.0, circle.tcpa_s);
    TEST_ASSERT_FALSE(circle.has_clearance);
    CHECK_CLOSE(0.0, 0.0, circle.clearance_m);
    CHECK_CLOSE(0.0, 0.0, circle.clearance_sd_m);
    estimator.estimate.valid &= ~GOE_HAS_WIDTH;
    estimator.estimate.width_m = 0.0f;
    CHECK_CLOSE(1e-4, 20.0, foresee(&intent).dcpa_m);
}

/* [goe_hazard_t.clearance_sd_m] */
static void without_a_height_the_margin_alone_counts(void) {
    const obstacle_t o = {false, 14.0, 100.0, 10.0, 0.0, 0.0, 12.0};
    const goe_intent_t intent = intent_of(20.0, 0.0, 0.0);
    give(&estimator.estimate, &o);
    estimator.estimate.sigma.x0_m = 4.0f;
    CHECK_CLOSE(1e-6, 0.0, foresee(&intent).conflict_probability); /* 28 m above an obstacle that requires 10 */
    estimator.estimate.valid &= ~GOE_HAS_HEIGHT;
    CHECK_CLOSE(2e-6, 0.1586553, foresee(&intent).conflict_probability); /* 9 m off, 5 wanted: 1 sigma */
}

/* ------------------------------------------------------------------------------------------------ against random truths -- */

typedef struct {
    double sum, squares;
} spread_t;

static void spread_add(spread_t *s, double x) {
    s->sum += x;
    s->squares += x * x;
}

static double spread_sd(const spread_t *s, int n) {
    return sqrt(fmax(s->squares / n - (s->sum / n) * (s->sum / n), 0.0));
}

typedef struct {
    double tcpa_sd_s, dcpa_sd_m, clearance_sd_m, conflict_probability;
} drawn_t;

typedef void draw_t(check_random_t *random, const obstacle_t *mean, obstacle_t *o);

/* Independent errors, as the window's. */
static void draw_from_sigmas(check_random_t *random, const obstacle_t *mean, obstacle_t *o) {
    const goe_sigma_t *sigma = &estimator.estimate.sigma;
    *o = *mean;
    o->x_m += (double)sigma->x0_m * check_random_normal(random);
    o->z_m += (double)sigma->z0_m * check_random_normal(random);
    o->width_m = fabs(o->width_m + (double)sigma->width_m * check_random_normal(random));
    o->length_m = fabs(o->length_m + (double)sigma->length_m * check_random_normal(random));
    o->orientation_deg += (double)sigma->orientation_deg * check_random_normal(random);
    o->height_m += (double)sigma->height_m * check_random_normal(random);
}

static drawn_t draw(const obstacle_t *mean, const goe_intent_t *intent, draw_t *one) {
    spread_t time = {0.0, 0.0};
    spread_t miss = {0.0, 0.0};
    spread_t clearance = {0.0, 0.0};
    int violated = 0;
    for (int i = 0; i < SAMPLES; i++) {
        obstacle_t o;
        one(&any, mean, &o);
        const truth_t truth = truth_of(&o, intent);
        spread_add(&time, truth.tcpa_s);
        spread_add(&miss, truth.dcpa_m);
        spread_add(&clearance, truth.clearance_m);
        violated += truth.dcpa_m < (double)intent->margin_m && truth.clearance_m < (double)intent->clearance_m ? 1 : 0;
    }
    const drawn_t drawn = {spread_sd(&time, SAMPLES), spread_sd(&miss, SAMPLES), spread_sd(&clearance, SAMPLES),
                           (double)violated / SAMPLES};
    return drawn;
}

static void give_sigmas(double position, double range, double extent, double orientation_deg, double height) {
    goe_sigma_t *sigma = &estimator.estimate.sigma;
    sigma->x0_m = (float)position;
    sigma->z0_m = (float)range;
    sigma->width_m = sigma->length_m = (float)extent;
    sigma->orientation_deg = (float)orientation_deg;
    sigma->height_m = (float)height;
}

/* Within 5 % or 2 cm: the rest of the curvature of corners and circles, and of the draw. */
static void check_sd(double expected, float actual) { CHECK_CLOSE(fmax(0.05 * expected, 0.02), expected, actual); }

/* [goe_affine.c] */
static void sigmas_of_a_miss_are_those_of_random_truths(void) {
    static const obstacle_t missed[4] = {{false, 30.0, 150.0, 10.0, 0.0, 0.0, 30.0},
                                         {true, -40.0, 120.0, 12.0, 30.0, 25.0, 45.0},
                                         {true, 35.0, 160.0, 20.0, 10.0, -40.0, 45.0},
                                         {true, 30.0, -20.0, 8.0, 15.0, 20.0, 45.0}};
    for (int i = 0; i < 4; i++) {
        const goe_intent_t intent = intent_of(20.0, -1.0, i % 2 ? 1.5 : -1.5);
        give(&estimator.estimate, &missed[i]);
        give_sigmas(1.5, 4.0, 1.0, 1.5, 1.2);
        const goe_hazard_t hazard = foresee(&intent);
        const drawn_t drawn = draw(&missed[i], &intent, draw_from_sigmas);
        check_sd(drawn.tcpa_sd_s, hazard.tcpa_sd_s);
        check_sd(drawn.dcpa_sd_m, hazard.dcpa_sd_m);
        check_sd(drawn.clearance_sd_m, hazard.clearance_sd_m);
    }
}

/* [goe_approach.c, goe_hazard_t.dcpa_sd_m] */
static void sigmas_of_a_crossing_are_those_of_random_truths(void) {
    static const obstacle_t crossed[3] = {{false, 5.0, 150.0, 60.0, 0.0, 0.0, 30.0},
                                          {true, -2.0, 120.0, 40.0, 50.0, 25.0, 45.0},
                                          {true, 4.0, 160.0, 60.0, 20.0, -15.0, 45.0}};
    for (int i = 0; i < 3; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const goe_intent_t intent = intent_of(20.0, 0.5, 1.5 * sign);
            give(&estimator.estimate, &crossed[i]);
            give_sigmas(1.5, 4.0, 1.0, 1.5, 1.2);
            const goe_hazard_t hazard = foresee(&intent);
            const drawn_t drawn = draw(&crossed[i], &intent, draw_from_sigmas);
            check_sd(drawn.tcpa_sd_s, hazard.tcpa_sd_s);
            check_sd(drawn.clearance_sd_m, hazard.clearance_sd_m);
        }
    }
}

static void a_grazed_edge_does_not_blow_the_sigma_of_the_time_up(void) {
    /* GIVEN a path 1 cm inside of the rim, or along a side THEN the time is spread over no more than half the outline and the
     * range's sigma, nor over much less than random truths are */
    static const obstacle_t grazed[3] = {{false, 9.99, 150.0, 20.0, 0.0, 0.0, 30.0},
                                         {true, 9.99, 150.0, 20.0, 40.0, 0.01, 30.0},
                                         {true, 12.0, 150.0, 20.0, 40.0, 0.01, 30.0}};
    static const double half_m[3] = {10.0, 20.0, 20.0};
    const goe_intent_t intent = intent_of(20.0, 0.0, -2.0);
    for (int i = 0; i < 3; i++) {
        give(&estimator.estimate, &grazed[i]);
        give_sigmas(2.0, 4.0, 1.0, 1.0, 1.0);
        const drawn_t drawn = draw(&grazed[i], &intent, draw_from_sigmas);
        const goe_hazard_t hazard = foresee(&intent);
        check_report("graze: time sd, s", (double)hazard.tcpa_sd_s);
        check_report("graze: drawn, s", drawn.tcpa_sd_s);
        TEST_ASSERT_TRUE((double)hazard.tcpa_sd_s <= (half_m[i] + 4.6) / 20.0);
        TEST_ASSERT_TRUE((double)hazard.tcpa_sd_s > 0.7 * drawn.tcpa_sd_s);
        TEST_ASSERT_TRUE((double)hazard.clearance_sd_m > 0.7 * drawn.clearance_sd_m);
    }
}

/* [goe_hazard, goe_intent_t.clearance_m, goe_intent_t.margin_m, goe_conflict.c]
 * The reported probability may exceed the drawn one, as goe.h allows, but hardly fall short of it. */
static void the_probability_is_that_of_random_truths(void) {
    check_random_t random = check_random_start("violation");
    double least = 0.0;
    double most = 0.0;
    double sum = 0.0;
    int cases = 0;
    for (int i = 0; i < 60; i++) {
        const obstacle_t o = {i % 3 != 0,
                              check_random_between(&random, -25.0, 25.0),
                              check_random_between(&random, 40.0, 200.0),
                              check_random_between(&random, 3.0, 30.0),
                              check_random_between(&random, 3.0, 40.0),
                              check_random_between(&random, -89.0, 89.0),
                              check_random_between(&random, 30.0, 50.0)};
        const goe_intent_t intent =
            intent_of(20.0, check_random_between(&random, -2.0, 2.0), check_random_between(&random, -2.0, 2.0));
        give(&estimator.estimate, &o);
        give_sigmas(check_random_between(&random, 0.5, 8.0), check_random_between(&random, 1.0, 10.0),
                    check_random_between(&random, 0.1, 1.0), check_random_between(&random, 0.2, 4.0),
                    check_random_between(&random, 0.5, 5.0));
        const double off =
            (double)foresee(&intent).conflict_probability - draw(&o, &intent, draw_from_sigmas).conflict_probability;
        least = fmin(least, off);
        most = fmax(most, off);
        sum += fabs(off);
        cases++;
    }
    check_report("violation, reported less drawn, least", least);
    check_report("violation, reported less drawn, most", most);
    check_report("violation, reported less drawn, mean magnitude", sum / cases);
    TEST_ASSERT_TRUE(least > -0.05 && most < 0.05 && sum / cases < 0.005);
}

/* ------------------------------------------------------------------------------------- the filter's own covariance -- */

static double root_of[GOE_QUANTITIES][GOE_QUANTITIES]; /* lower triangular, of the covariance */

static void factorise(float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    memset(root_of, 0, sizeof root_of);
    for (int j = 0; j < GOE_QUANTITIES; j++) {
        for (int i = j; i < GOE_QUANTITIES; i++) {
            double sum = (double)covariance[i][j];
            for (int k = 0; k < j; k++) {
                sum -= root_of[i][k] * root_of[j][k];
            }
            if (i == j) {
                root_of[j][j] = sum > 0.0 ? sqrt(sum) : 0.0; /* 0: not known */
            } else {
                root_of[i][j] = root_of[j][j] > 0.0 ? sum / root_of[j][j] : 0.0;
            }
        }
    }
}

static void draw_from_covariance(check_random_t *random, const obstacle_t *mean, obstacle_t *o) {
    double *quantity[GOE_QUANTITIES] = {&o->x_m, &o->z_m, &o->orientation_deg, &o->width_m, &o->length_m, &o->height_m};
    *o = *mean;
    for (int k = 0; k < GOE_QUANTITIES; k++) {
        const double w = check_random_normal(random);
        for (int i = k; i < GOE_QUANTITIES; i++) {
            *quantity[i] += root_of[i][k] * w;
        }
    }
}

/* A filter that holds a round footprint 150 m ahead, 30 m to the right and 35 m high, whose direction and top share their error. */
static void give_round(float shared) {
    goe_filter_t *f = &estimator.filter;
    memset(f, 0, sizeof *f);
    f->phase = GOE_PHASE_FOOTPRINT;
    f->axes.turn_cos = 1.0f;
    f->datum.height_m = estimator.motion.height_m;
    f->state[GOE_INVERSE_RANGE] = 1.0f / 150.0f;
    f->state[GOE_BEARING] = 30.0f / 150.0f;
    f->state[GOE_HALF] = 5.0f / 150.0f;
    f->state[GOE_TOP] = 35.0f / 150.0f;
    inverse_start(&f->root, 1.0e-9);
    inverse_set(&f->root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE, 1.0e-4);
    inverse_set(&f->root, GOE_HALF, GOE_HALF, 5.0e-4);
    inverse_set(&f->root, GOE_BEARING, GOE_BEARING, 0.02 * sqrt(1.0 - (double)shared * (double)shared));
    inverse_set(&f->root, GOE_BEARING, GOE_TOP, 0.02 * (double)shared);
    inverse_set(&f->root, GOE_TOP, GOE_TOP, 0.02);
    estimator.settings.method = GOE_METHOD_FILTER;
    goe_guard_seal(&estimator);
    estimator.motion.time_us = estimator.filter.axes.start_time_us = 0;
}

static void correlation_moves_the_probability(void) {
    static const float shared[5] = {-0.95f, -0.5f, 0.0f, 0.5f, 0.95f};
    const obstacle_t mean = {false, 30.0, 150.0, 10.0, 0.0, 0.0, 35.0};
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    for (int i = 0; i < 5; i++) {
        give_round(shared[i]);
        give(&estimator.estimate, &mean);
        estimator.estimate.method = GOE_METHOD_FILTER;
        goe_covariance_ahead(&estimator, true, 0.0f, covariance);
        factorise(covariance);
        goe_intent_t intent = intent_of(20.0, 0.0, 0.0);
        intent.margin_m = 23.0f;
        intent.clearance_m = 14.0f;
        const double reported = (double)foresee(&intent).conflict_probability;
        const double drawn = draw(&mean, &intent, draw_from_covariance).conflict_probability;
        check_report("shared errors: violation reported", reported);
        check_report("shared errors: violation drawn", drawn);
        TEST_ASSERT_TRUE(reported > drawn - 0.03);
        TEST_ASSERT_TRUE(reported < drawn + 0.15);
        if (fabs((double)shared[i]) < 0.6) {
            CHECK_CLOSE(0.1, drawn, reported);
        }
    }
}

/* 4 m higher than the flight, so that the highest point in the image is over the nearest corner */
static scene_t tower(void) {
    scene_t scene;
    scene_default(&scene);
    scene.width_m = 6.0;
    scene.height_m = 24.0;
    return scene;
}

/* The own velocity is exact: its error, which moves range and side together, is that of test_quantities.c. */
static void fly_towards_a_tower(float reported_too_high_m) {
    const scene_t scene = tower();
    goe_settings_t settings = scene_settings(&scene);
    goe_estimate_t estimate;
    settings.navigation.velocity_bias_sd_m_s = 0.0f;
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 40; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        image.pose.height_m += reported_too_high_m;
        (void)goe_update(&estimator, &image, &estimate);
    }
    TEST_ASSERT_EQUAL_HEX32(0x3Fu, estimate.valid & 0x3Fu);
    TEST_ASSERT_TRUE(estimate.fresh);
}

/* [goe_conflict.c] */
static void correlated_errors_are_accounted_for(void) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    fly_towards_a_tower(0.0f);
    const goe_estimate_t *e = &estimator.estimate;
    goe_covariance_ahead(&estimator, true, 0.0f, covariance);
    factorise(covariance);
    const double datum_m =
        (double)estimator.filter.state[GOE_GROUND] / (double)estimator.filter.state[GOE_INVERSE_RANGE];
    const obstacle_t mean = {true,
                             (double)e->x_m,
                             (double)e->z_m,
                             (double)e->width_m,
                             (double)e->length_m,
                             (double)e->orientation_deg,
                             (double)e->height_m - datum_m};
    for (int i = 0; i < 2; i++) {
        /* to the middle of the front edge and past it, its margin grazed; the clearance that is likely */
        const double aside_m = i == 0 ? 0.0 : 0.5 * mean.width_m + 5.0;
        goe_intent_t intent = intent_of(20.0, 20.0 * (mean.x_m + aside_m) / mean.z_m, 6.0);
        intent.clearance_m = (float)truth_of(&mean, &intent).clearance_m;
        const goe_hazard_t hazard = foresee(&intent);
        const drawn_t drawn = draw(&mean, &intent, draw_from_covariance);
        check_report("filter: violation reported", (double)hazard.conflict_probability);
        check_report("filter: violation drawn", drawn.conflict_probability);
        CHECK_CLOSE(1e-3, truth_of(&mean, &intent).clearance_m, hazard.clearance_m);
        check_sd(drawn.tcpa_sd_s, hazard.tcpa_sd_s);
        check_sd(drawn.clearance_sd_m, hazard.clearance_sd_m);
        if (i == 1) {
            check_sd(drawn.dcpa_sd_m, hazard.dcpa_sd_m);
        }
        CHECK_CLOSE(0.06, drawn.conflict_probability, hazard.conflict_probability);
    }
}

/* [goe_covariance.c] */
static void the_altimeters_bias_does_not_part_camera_and_top(void) {
    /* GIVEN a height that is given 1 m too large THEN the clearance is the true one all the same */
    goe_intent_t intent = intent_of(0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        const scene_t scene = tower();
        goe_image_t image;
        scene_image(&scene, 39, &image, NULL);
        fly_towards_a_tower((float)i);
        const goe_hazard_t hazard = foresee(&intent);
        check_report("clearance, m", (double)hazard.clearance_m);
        CHECK_CLOSE(3.0 * (double)hazard.clearance_sd_m, (double)image.pose.height_m - scene.height_m,
                    hazard.clearance_m);
    }
}

/* -------------------------------------------------------------------------------------------------------------- refusals -- */

static void check_refused(goe_status_t expected, const goe_estimator_t *e, const goe_intent_t *intent) {
    goe_hazard_t hazard;
    goe_hazard_t zero;
    memset(&hazard, 0xC3, sizeof hazard);
    memset(&zero, 0, sizeof zero);
    CHECK_STATUS(expected, goe_hazard(e, intent, &hazard));
    TEST_ASSERT_EQUAL_MEMORY(&zero, &hazard, sizeof zero);
}

/* [goe_hazard.c] */
static void a_refusal_leaves_zeros(void) {
    const obstacle_t o = {false, 0.0, 100.0, 6.0, 0.0, 0.0, 12.0};
    const goe_intent_t good = intent_of(20.0, 0.0, 0.0);
    check_refused(GOE_CONVERGING, &estimator, &good);
    check_refused(GOE_BAD_ARGUMENT, NULL, &good);
    check_refused(GOE_BAD_ARGUMENT, &estimator, NULL);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_hazard(&estimator, &good, NULL));
    give(&estimator.estimate, &o);
    for (int field = 0; field < 6; field++) {
        static const float most[6] = {1e3f, 1e3f, 1e3f, 1e4f, 1e4f, 1e3f};
        goe_intent_t intent = good;
        float *const rest[] = {&intent.margin_m, &intent.clearance_m, &intent.since_image_s};
        float *x = field < 3 ? &intent.velocity_ned_m_s[field] : rest[field - 3];
        goe_hazard_t hazard;
        *x = most[field];
        CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
        *x = check_next_away(most[field]);
        check_refused(GOE_OUT_OF_RANGE, &estimator, &intent);
        *x = check_from_bits(0x7FC00000u);
        check_refused(GOE_NOT_FINITE, &estimator, &intent);
        *x = check_from_bits(0xFF800000u);
        check_refused(GOE_NOT_FINITE, &estimator, &intent);
        *x = -1e-3f;
        if (field >= 3) {
            check_refused(GOE_OUT_OF_RANGE, &estimator, &intent);
        }
    }
    estimator.ready = 0u;
    check_refused(GOE_CORRUPTED, &estimator, &good);
    estimator.seal.sum++;
    check_refused(GOE_NOT_INITIALIZED, &estimator, &good);
}

int main(void) {
    UNITY_BEGIN();
    any = check_random_start("truths");
    RUN_TEST(any_obstacle_is_met_as_brute_force_says);
    RUN_TEST(a_chimney_ahead_is_reached_at_its_near_side);
    RUN_TEST(turning_t_turns_the_answer_along);
    RUN_TEST(an_obstacle_behind_is_as_far_as_now);
    RUN_TEST(over_the_roof_the_distance_is_none);
    RUN_TEST(standing_still_the_distance_is_that_of_now);
    RUN_TEST(a_creep_is_taken_as_standing_still);
    RUN_TEST(since_the_image_the_aircraft_has_flown_on);
    RUN_TEST(a_camera_in_the_middle_of_a_disc_has_an_answer);
    RUN_TEST(unknown_dimensions_leave_a_circle_or_a_point);
    RUN_TEST(without_a_height_the_margin_alone_counts);
    RUN_TEST(sigmas_of_a_miss_are_those_of_random_truths);
    RUN_TEST(sigmas_of_a_crossing_are_those_of_random_truths);
    RUN_TEST(a_grazed_edge_does_not_blow_the_sigma_of_the_time_up);
    RUN_TEST(the_probability_is_that_of_random_truths);
    RUN_TEST(correlation_moves_the_probability);
    RUN_TEST(correlated_errors_are_accounted_for);
    RUN_TEST(the_altimeters_bias_does_not_part_camera_and_top);
    RUN_TEST(a_refusal_leaves_zeros);
    return UNITY_END();
}
