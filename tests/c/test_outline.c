/* Reach, ends and ways of an outline: each derivative against differences of the value. SPDX-License-Identifier: MIT
 *
 * A wrong derivative moves no distance, but the sigmas of time and miss, and with them the probability of a violation. */
/* tests: lib/hazard/goe_outline.c */
#include "hazard/goe_outline.h"

#include <math.h>
#include <string.h>

#include "check.h"

#define CASES 600
#define DIRECTIONS 720
#define RAD_PER_DEG 0.017453292519943295
#define STEP_M 0.02
#define STEP_DEG 0.1

static check_random_t any;
static goe_xz_t around[DIRECTIONS]; /* all directions, half a degree apart */

/* By GOE_X0 to GOE_LENGTH. */
typedef struct {
    double quantity[GOE_QUANTITIES];
    bool box;
} obstacle_t;

typedef struct {
    goe_xz_t m;
    goe_course_t course;
    float way;
} question_t;

typedef void (*answer_t)(const goe_outline_t *o, const question_t *question, goe_affine_t *answer);

void setUp(void) {}
void tearDown(void) {}

static goe_xz_t direction(double rad) {
    const goe_xz_t d = {(float)sin(rad), (float)cos(rad)};
    return d;
}

static goe_outline_t outline_of(const obstacle_t *obstacle) {
    const double *q = obstacle->quantity;
    goe_outline_t o;
    o.reference.x = (float)q[GOE_X0];
    o.reference.z = (float)q[GOE_Z0];
    o.length_axis = direction(q[GOE_ORIENTATION] * RAD_PER_DEG);
    o.width_axis = goe_outline_right_of(o.length_axis);
    o.half = (float)(0.5 * q[GOE_WIDTH]);
    o.length = (float)q[GOE_LENGTH];
    o.box = obstacle->box;
    return o;
}

static void set_course(goe_course_t *course, double rad) {
    memset(course, 0, sizeof *course);
    course->speed_m_s = 10.0f;
    course->ahead = direction(rad);
    course->back = goe_xz_negative(course->ahead);
    course->side[GOE_RIGHT] = goe_outline_right_of(course->ahead);
    course->side[GOE_LEFT] = goe_outline_right_of(course->back);
}

static void any_obstacle(obstacle_t *obstacle, bool box) {
    double *q = obstacle->quantity;
    obstacle->box = box;
    q[GOE_X0] = check_random_between(&any, -40.0, 40.0);
    q[GOE_Z0] = check_random_between(&any, -40.0, 40.0);
    q[GOE_ORIENTATION] = check_random_between(&any, -90.0, 90.0);
    q[GOE_WIDTH] = check_random_between(&any, 4.0, 20.0);
    q[GOE_LENGTH] = check_random_between(&any, 4.0, 30.0);
    q[GOE_HEIGHT] = 10.0;
}

/* Towards a point within the obstacle, off its middle by at most a third of the radius or of the smaller edge. */
static void cross_it(const obstacle_t *obstacle, question_t *question) {
    const double *q = obstacle->quantity;
    const double half = obstacle->box ? 0.5 * q[GOE_LENGTH] : 0.0;
    const double s = sin(q[GOE_ORIENTATION] * RAD_PER_DEG);
    const double c = cos(q[GOE_ORIENTATION] * RAD_PER_DEG);
    const double off =
        check_random_between(&any, -0.3, 0.3) * fmin(q[GOE_WIDTH], obstacle->box ? q[GOE_LENGTH] : 1e9) / 2.0;
    const double x = q[GOE_X0] + half * s;
    const double z = q[GOE_Z0] + half * c;
    const double range = hypot(x, z) + 1.0e-3;
    set_course(&question->course, atan2(x + off * z / range, z - off * x / range));
}

static double value_at(const obstacle_t *obstacle, const question_t *question, answer_t answer, int quantity,
                       double step) {
    obstacle_t moved = *obstacle;
    goe_affine_t at;
    moved.quantity[quantity] += step;
    const goe_outline_t o = outline_of(&moved);
    answer(&o, question, &at);
    return (double)at.value;
}

/* Where the value has a corner the differences to both sides differ, and so does the derivative. */
static void check_derivatives(const obstacle_t *obstacle, const question_t *question, answer_t answer) {
    const goe_outline_t o = outline_of(obstacle);
    goe_affine_t at;
    memset(&at, 0xFF, sizeof at); /* whatever is not written shows */
    answer(&o, question, &at);
    for (int i = 0; i < GOE_HEIGHT; i++) {
        const double step = i == GOE_ORIENTATION ? STEP_DEG : STEP_M;
        const double before = value_at(obstacle, question, answer, i, -step);
        const double behind = value_at(obstacle, question, answer, i, step);
        const double up = (behind - (double)at.value) / step;
        const double down = ((double)at.value - before) / step;
        const double slope = 0.5 * (up + down);
        if (fabs(up - down) < 0.02 + 0.02 * fabs(slope)) {
            CHECK_CLOSE(0.015 + 0.02 * fabs(slope), slope, at.by[i]);
        }
    }
    TEST_ASSERT_TRUE(at.by[GOE_HEIGHT] >= 0.0f && at.by[GOE_HEIGHT] <= 0.0f);
}

/* ------------------------------------------------------------------------------------------------------------ answers -- */

static void reach(const goe_outline_t *o, const question_t *question, goe_affine_t *at) {
    goe_outline_reach(o, &question->m, at);
}

static void distance(const goe_outline_t *o, const question_t *question, goe_affine_t *at) {
    goe_outline_distance(o, &question->m, at);
}

static void along(const goe_outline_t *o, const question_t *question, goe_affine_t *at) {
    goe_outline_along(o, &question->course.ahead, &question->m, at);
}

static void end(const goe_outline_t *o, const question_t *question, goe_affine_t *at) {
    goe_outline_end(o, &question->course, question->way, 1.0e-6f, at);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

/* GIVEN any outline and direction THEN reach and distance, and the place along a course, move with each quantity as their
 * derivatives say. */
static void the_support_point_moves_as_its_derivatives_say(void) {
    any = check_random_start("reach");
    for (int n = 0; n < CASES; n++) {
        obstacle_t obstacle;
        question_t question;
        any_obstacle(&obstacle, n % 3 != 0);
        set_course(&question.course, check_random_between(&any, -3.14, 3.14));
        question.m = direction(check_random_between(&any, -3.14, 3.14));
        check_derivatives(&obstacle, &question, reach);
        check_derivatives(&obstacle, &question, distance);
        check_derivatives(&obstacle, &question, along);
    }
}

/* GIVEN a course across an outline THEN the places where it enters and leaves move with each quantity as their derivatives
 * say: those of a disc along the chord, those of a box with the face. */
static void a_crossing_moves_as_its_derivatives_say(void) {
    any = check_random_start("crossing");
    for (int n = 0; n < CASES; n++) {
        obstacle_t obstacle;
        question_t question;
        any_obstacle(&obstacle, n % 2 != 0);
        cross_it(&obstacle, &question);
        question.way = n % 4 < 2 ? 1.0f : -1.0f;
        check_derivatives(&obstacle, &question, end);
    }
}

/* The end of a crossing lies on the outline: half a step on it is without or within. */
static double depth_at(const obstacle_t *obstacle, double x, double z) {
    const double *q = obstacle->quantity;
    const double s = sin(q[GOE_ORIENTATION] * RAD_PER_DEG);
    const double c = cos(q[GOE_ORIENTATION] * RAD_PER_DEG);
    const double dx = x - q[GOE_X0];
    const double dz = z - q[GOE_Z0];
    if (!obstacle->box) {
        return 0.5 * q[GOE_WIDTH] - hypot(dx, dz);
    }
    const double across = fabs(dx * c - dz * s) - 0.5 * q[GOE_WIDTH];
    const double lengthwise = dx * s + dz * c;
    return -fmax(across, fmax(-lengthwise, lengthwise - q[GOE_LENGTH]));
}

/* GIVEN a course across an outline THEN where it enters and leaves the outline is passed. */
static void a_crossing_ends_on_the_outline(void) {
    any = check_random_start("ends");
    for (int n = 0; n < CASES; n++) {
        obstacle_t obstacle;
        question_t question;
        any_obstacle(&obstacle, n % 2 != 0);
        cross_it(&obstacle, &question);
        const goe_outline_t o = outline_of(&obstacle);
        for (int i = 0; i < 2; i++) {
            goe_affine_t at;
            goe_outline_end(&o, &question.course, i == 0 ? -1.0f : 1.0f, 1.0e-6f, &at);
            const double x = (double)at.value * (double)question.course.ahead.x;
            const double z = (double)at.value * (double)question.course.ahead.z;
            CHECK_CLOSE(1.0e-3, 0.0, depth_at(&obstacle, x, z));
        }
    }
}

/* GIVEN a camera next to, before or in an outline THEN the way from it is a unit vector; outside, straight away from the nearest
 * point, and so far from the outline as that point is; inside, never out through the part behind. */
static void the_way_from_an_outline_is_the_shortest(void) {
    any = check_random_start("way");
    for (int k = 0; k < DIRECTIONS; k++) {
        around[k] = direction(k * 0.5 * RAD_PER_DEG);
    }
    for (int n = 0; n < CASES; n++) {
        obstacle_t obstacle;
        question_t question;
        goe_affine_t least;
        any_obstacle(&obstacle, n % 2 != 0);
        if (n % 3 == 0) { /* within, or near */
            obstacle.quantity[GOE_X0] *= 0.1;
            obstacle.quantity[GOE_Z0] *= 0.1;
        }
        set_course(&question.course, check_random_between(&any, -3.14, 3.14));
        const goe_outline_t o = outline_of(&obstacle);
        const goe_xz_t m = goe_outline_way_from(&o, &question.course);
        const double depth = depth_at(&obstacle, 0.0, 0.0);
        CHECK_CLOSE(1.0e-4, 1.0, sqrt((double)m.x * (double)m.x + (double)m.z * (double)m.z));
        goe_outline_distance(&o, &m, &least);
        double most =
            -1.0e9; /* the greatest of all distances is the true one; inside, by faces that do not look back */
        for (int k = 0; k < (depth < 0.0 ? DIRECTIONS : 4); k++) {
            goe_affine_t other;
            const goe_xz_t face = k < 2 ? o.length_axis : o.width_axis;
            const goe_xz_t normal = k % 2 == 0 ? face : goe_xz_negative(face);
            const goe_xz_t d = depth < 0.0 ? around[k] : normal;
            goe_outline_distance(&o, &d, &other);
            if (depth < 0.0 || goe_xz_dot(d, question.course.ahead) >= 0.0f) {
                most = fmax(most, (double)other.value);
            }
        }
        if (depth < 0.0 || obstacle.box) {
            CHECK_CLOSE(depth < 0.0 ? 0.15 : 1.0e-3, most, least.value); /* half a step along half an edge */
        }
        TEST_ASSERT_TRUE(depth <= 0.0 || !obstacle.box || goe_xz_dot(m, question.course.ahead) >= -1.0e-5f);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_support_point_moves_as_its_derivatives_say);
    RUN_TEST(a_crossing_moves_as_its_derivatives_say);
    RUN_TEST(a_crossing_ends_on_the_outline);
    RUN_TEST(the_way_from_an_outline_is_the_shortest);
    return UNITY_END();
}
