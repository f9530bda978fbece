/* A horizontal ellipse that may turn, against many points of it, in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_ellipse.c */
#include "refined/goe_ellipse.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "rim.h"

#define CASES 200
#define STEP 1.0e-3 /* relative, of a state */

static check_random_t any;
static goe_filter_t filter;

void setUp(void) {
    any = check_random_start("ellipses");
    memset(&filter, 0, sizeof filter);
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }

/* A thing of 1 to 25 m at 80 to 150 m, up to three times as deep as wide, or as flat. */
static void any_ellipse(void) {
    const double q = 1.0 / between(80.0, 150.0);
    filter.state[GOE_BEARING] = (float)between(-0.3, 0.3);
    filter.state[GOE_INVERSE_RANGE] = (float)q;
    filter.state[GOE_HALF] = (float)(between(0.5, 12.5) * q);
    filter.state[GOE_SHEAR] = filter.state[GOE_HALF] * (float)between(-1.5, 1.5);
    filter.state[GOE_LOG_DEPTH] = (float)between(-1.1, 1.1);
}

static goe_xz_t any_direction(void) {
    const double turn = between(-3.2, 3.2);
    const goe_xz_t direction = {(float)sin(turn), (float)cos(turn)};
    return direction;
}

/* The same with one state changed. */
static double reach_with(size_t state, double change, goe_xz_t outward) {
    float x[GOE_STATES];
    memcpy(x, filter.state, sizeof x);
    x[state] += (float)change;
    return rim_reach(x, (double)outward.x, (double)outward.z);
}

static double slope_by(size_t state, double scale, goe_xz_t outward) {
    const double step = STEP * scale;
    const float up = filter.state[state] + (float)step;
    const float down = filter.state[state] - (float)step;
    return (reach_with(state, step, outward) - reach_with(state, -step, outward)) / ((double)up - (double)down);
}

static void check_slopes(goe_xz_t outward, goe_by_footprint_t by) {
    const double half = (double)filter.state[GOE_HALF];
    CHECK_CLOSE(2.0e-3, slope_by(GOE_SHEAR, half, outward), by.shear);
    CHECK_CLOSE(4.0e-3, slope_by(GOE_HALF, half, outward), by.half);
    CHECK_CLOSE(4.0e-3 * half, slope_by(GOE_LOG_DEPTH, 1.0, outward), by.depth);
}

/* [(R23), (R25)]
 * GIVEN ellipses of any proportion and turn THEN the contact lies on the rim, no other point of it lies farther along that direction, and
 * the reach is how far that is. */
static void the_contact_is_the_farthest_point(void) {
    for (int n = 0; n < CASES; n++) {
        any_ellipse();
        const goe_xz_t outward = any_direction();
        const goe_ellipse_t ellipse = goe_ellipse_of(filter.state);
        const goe_contact_t contact = goe_ellipse_touch(&ellipse, outward);
        const double farthest = rim_reach(filter.state, (double)outward.x, (double)outward.z);
        const double half = (double)filter.state[GOE_HALF];
        const double right = (double)contact.at.x / half;
        const double depth = half * exp((double)filter.state[GOE_LOG_DEPTH]);
        const double ahead = ((double)contact.at.z - (double)filter.state[GOE_SHEAR] * right) / depth;
        CHECK_CLOSE(2.0e-5 * half, farthest, contact.reach);
        CHECK_CLOSE(2.0e-5 * half, farthest,
                    (double)contact.at.x * (double)outward.x + (double)contact.at.z * (double)outward.z);
        CHECK_CLOSE(3.0e-5, 1.0, right * right + ahead * ahead);
    }
}

/* [(R27)] GIVEN the same THEN the derivatives are those of the reach, though the contact moves along the rim: that adds nothing. */
static void slopes_are_those_of_the_reach(void) {
    for (int n = 0; n < CASES; n++) {
        any_ellipse();
        const goe_xz_t outward = any_direction();
        const goe_ellipse_t ellipse = goe_ellipse_of(filter.state);
        const goe_contact_t contact = goe_ellipse_touch(&ellipse, outward);
        check_slopes(outward, goe_ellipse_slope(&ellipse, &contact, outward));
    }
}

/* GIVEN an ellipse of no extent THEN nothing is divided by it. */
static void a_point_has_a_finite_contact(void) {
    const goe_xz_t ahead = {0.0f, 1.0f};
    const goe_ellipse_t point = goe_ellipse_of(filter.state);
    const goe_contact_t contact = goe_ellipse_touch(&point, ahead);
    CHECK_SAME(0.0f, contact.at.x);
    CHECK_SAME(0.0f, contact.at.z);
    TEST_ASSERT_TRUE(contact.reach > 0.0f && contact.reach < 1.0e-6f);
}

/* [goe_hazard]
 * GIVEN a camera somewhere before the obstacle, or next to it THEN the line of sight leads from the middle to that camera, and the reaches
 * along it and across are those of the rim, with their derivatives. */
static void a_footprint_faces_the_camera(void) {
    for (int n = 0; n < CASES; n++) {
        goe_aspect_t aspect;
        any_ellipse();
        const double q = (double)filter.state[GOE_INVERSE_RANGE];
        const goe_xz_t camera_m = {(float)between(-60.0, 60.0), (float)between(-10.0, 50.0)};
        goe_ellipse_face_camera(&filter, camera_m, &aspect);
        const double half = (double)filter.state[GOE_HALF];
        const double x_m = (double)camera_m.x - (double)filter.state[GOE_BEARING] / q;
        const double z_m = (double)camera_m.z - 1.0 / q;
        const double distance_m = hypot(x_m, z_m);
        CHECK_CLOSE(1.0e-5, x_m / distance_m, aspect.towards.x);
        CHECK_CLOSE(1.0e-5, z_m / distance_m, aspect.towards.z);
        const goe_xz_t across = {-aspect.towards.z, aspect.towards.x};
        CHECK_CLOSE(2.0e-5 * half, rim_reach(filter.state, x_m / distance_m, z_m / distance_m), aspect.before.reach);
        CHECK_CLOSE(2.0e-5 * half, rim_reach(filter.state, -z_m / distance_m, x_m / distance_m), aspect.across.reach);
        check_slopes(aspect.towards, aspect.before.by);
        check_slopes(across, aspect.across.by);
    }
}

/* GIVEN a camera within the footprint, or exactly over its middle THEN the footprint reaches up to the camera and no farther. */
static void what_lies_behind_the_camera_is_not_before_it(void) {
    static const float short_of_middle_m[] = {2.0f, 0.0f};
    goe_aspect_t aspect;
    filter.state[GOE_INVERSE_RANGE] = 0.01f;
    filter.state[GOE_HALF] = 0.1f; /* 10 m, as deep as wide */
    for (int i = 0; i < 2; i++) {
        const goe_xz_t camera_m = {0.0f, 100.0f - short_of_middle_m[i]};
        goe_ellipse_face_camera(&filter, camera_m, &aspect);
        CHECK_CLOSE(1.0e-6, 0.01 * (double)short_of_middle_m[i], aspect.before.reach);
        CHECK_CLOSE(1.0e-6, i == 0 ? 0.1 : 0.0, aspect.across.reach);
        TEST_ASSERT_TRUE(check_is_finite(aspect.towards.x) && check_is_finite(aspect.towards.z));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_contact_is_the_farthest_point);
    RUN_TEST(slopes_are_those_of_the_reach);
    RUN_TEST(a_point_has_a_finite_contact);
    RUN_TEST(a_footprint_faces_the_camera);
    RUN_TEST(what_lies_behind_the_camera_is_not_before_it);
    return UNITY_END();
}
