/* Which edge is the side, and the low-pass. SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_orientation.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "window/goe_orientation.h"

#define MEMORY 20

static goe_orientation_t orientation;
static goe_edges_t edges;

void setUp(void) {
    memset(&orientation, 0, sizeof orientation);
    memset(&edges, 0, sizeof edges);
}
void tearDown(void) {}

static const float none = 1000.0f; /* an edge without a heading */

static goe_edge_t edge_of(float heading_deg) {
    const bool has = heading_deg < none;
    return (goe_edge_t){NULL, NULL, true, has, has ? heading_deg : 0.0f};
}

static goe_faces_t update(int memory) {
    goe_faces_t faces = {false, NULL, NULL, false};
    goe_orientation_update(&orientation, &edges, memory, &faces);
    return faces;
}

static goe_faces_t see_two(float left_deg, float right_deg) {
    edges.count = 2;
    edges.edge[0] = edge_of(left_deg);
    edges.edge[1] = edge_of(right_deg);
    return update(MEMORY);
}

static goe_faces_t see_one(float heading_deg) {
    edges.count = 1;
    edges.edge[0] = edge_of(heading_deg);
    return update(MEMORY);
}

/* Before any edge had a heading there is nothing to divide by. */
static void no_measurement_has_no_sigma(void) {
    orientation.variance_deg2 = 9.0f;
    TEST_ASSERT_EQUAL_FLOAT(0.0f, goe_orientation_sigma_deg(&orientation));
    orientation.count = 4;
    TEST_ASSERT_EQUAL_FLOAT(1.5f, goe_orientation_sigma_deg(&orientation));
}

/* [W1] */
static void the_side_is_the_edge_nearer_to_the_flight_direction(void) {
    goe_faces_t faces = see_two(-80.0f, 10.0f);
    TEST_ASSERT_TRUE(faces.measured && faces.side_is_right);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[1], faces.side);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[0], faces.front);
    TEST_ASSERT_EQUAL_FLOAT(10.0f, orientation.raw_deg);
    setUp();
    faces = see_two(-5.0f, 85.0f);
    TEST_ASSERT_TRUE(faces.measured && !faces.side_is_right);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[0], faces.side);
    TEST_ASSERT_EQUAL_FLOAT(-5.0f, orientation.raw_deg);
}

/* GIVEN a count or an angle that no image can have left THEN the next measurement is the first. */
static void a_track_without_images_begins_again(void) {
    static const struct {
        int count;
        uint32_t filtered;
    } flipped[] = {{-1, 0u}, {MEMORY + 1, 0u}, {INT32_MIN, 0u}, {3, 0x7FC00000u}, {3, 0xFF800000u}, {3, 0x4E800000u}};
    for (size_t i = 0; i < sizeof flipped / sizeof flipped[0]; i++) {
        setUp();
        orientation.count = flipped[i].count;
        orientation.filtered_deg = check_from_bits(flipped[i].filtered);
        orientation.variance_deg2 = 5.0f;
        (void)see_one(20.0f);
        TEST_ASSERT_EQUAL_INT(1, orientation.count);
        TEST_ASSERT_EQUAL_FLOAT(20.0f, orientation.filtered_deg);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, orientation.variance_deg2);
    }
}

/* [W1] */
static void the_front_gives_the_orientation_if_the_side_cannot(void) {
    (void)see_two(70.0f, none);
    TEST_ASSERT_EQUAL_FLOAT(-20.0f, orientation.raw_deg);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[1], see_two(70.0f, none).side);
    setUp();
    (void)see_two(none, -60.0f);
    TEST_ASSERT_EQUAL_FLOAT(30.0f, orientation.raw_deg);
}

/* [W1] */
static void a_single_edge_is_a_front_beyond_45_degrees(void) {
    goe_faces_t faces = see_one(46.0f);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[0], faces.front);
    TEST_ASSERT_NULL(faces.side);
    TEST_ASSERT_EQUAL_FLOAT(-44.0f, orientation.raw_deg);
    setUp();
    faces = see_one(-46.0f);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[0], faces.front);
    TEST_ASSERT_EQUAL_FLOAT(44.0f, orientation.raw_deg);
    setUp();
    faces = see_one(44.0f);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[0], faces.side);
    TEST_ASSERT_NULL(faces.front);
    TEST_ASSERT_EQUAL_FLOAT(44.0f, orientation.raw_deg);
    setUp();
    (void)see_one(90.0f); /* head-on */
    TEST_ASSERT_EQUAL_FLOAT(0.0f, orientation.raw_deg);
}

/* [W1] */
static void no_heading_leaves_everything_as_it_is(void) {
    (void)see_two(-80.0f, 10.0f);
    const goe_orientation_t before = orientation;
    const goe_faces_t faces = see_two(none, none);
    TEST_ASSERT_FALSE(faces.measured);
    TEST_ASSERT_NULL(faces.front);
    TEST_ASSERT_NULL(faces.side);
    TEST_ASSERT_EQUAL_MEMORY(&before, &orientation, sizeof before);
    edges.count = 0;
    TEST_ASSERT_FALSE(update(MEMORY).measured);
}

/* [W1] GIVEN a box at 44 degrees and noise of 3 degrees, which often makes the other edge's angle the smaller one
 * WHEN 500 images come THEN front and side never change places and the filtered angle stays near 44. */
static void noise_near_45_degrees_does_not_swap_the_faces(void) {
    check_random_t random = check_random_start("near 45 degrees");
    int would_swap = 0;
    (void)see_two(-46.0f, 44.0f);
    for (int i = 0; i < 500; i++) {
        const float front = (float)(-46.0 + 3.0 * check_random_normal(&random));
        const float side = (float)(44.0 + 3.0 * check_random_normal(&random));
        would_swap += fabsf(front) < fabsf(side) ? 1 : 0;
        const goe_faces_t faces = see_two(front, side);
        TEST_ASSERT_EQUAL_PTR(&edges.edge[1], faces.side);
        TEST_ASSERT_FLOAT_WITHIN(5.0f, 44.0f, orientation.filtered_deg);
    }
    TEST_ASSERT_GREATER_THAN_INT(50, would_swap);
}

/* [W1] GIVEN an estimate that was wrong at first WHEN the edges say clearly otherwise THEN they win over the low-pass. */
static void clear_edges_win_over_the_low_pass(void) {
    (void)see_two(-30.0f, 60.0f);
    TEST_ASSERT_EQUAL_FLOAT(-30.0f, orientation.raw_deg);
    const goe_faces_t faces = see_two(-80.0f, 10.0f);
    TEST_ASSERT_EQUAL_PTR(&edges.edge[1], faces.side);
    TEST_ASSERT_EQUAL_FLOAT(10.0f, orientation.raw_deg);
}

/* [goe_estimate_t.orientation_raw_deg, window.orientation_memory]
 * b_k = b_{k-1} + (g_k - b_{k-1})/min(k, memory), and the mean squared step, in double. */
static void the_low_pass_follows_its_formula(void) {
    check_random_t random = check_random_start("low-pass");
    double b = 0.0;
    double variance = 0.0;
    for (int k = 1; k <= 60; k++) {
        const float g = (float)(10.0 + 4.0 * check_random_normal(&random));
        (void)see_two(-80.0f, g);
        const double share = 1.0 / (k < MEMORY ? k : MEMORY);
        const double step = k == 1 ? 0.0 : (double)g - b;
        b = k == 1 ? (double)g : b + step * share;
        variance += (step * step - variance) * share;
        CHECK_CLOSE(2.0e-5, b, orientation.filtered_deg);
        CHECK_CLOSE(1.0e-4, variance, orientation.variance_deg2);
        CHECK_CLOSE(1.0e-4, sqrt(variance * share), goe_orientation_sigma_deg(&orientation));
        TEST_ASSERT_EQUAL_INT(k < MEMORY ? k : MEMORY, orientation.count);
    }
}

/* [window.orientation_memory] */
static void a_memory_of_one_does_not_filter(void) {
    edges.count = 2;
    for (int k = 0; k < 5; k++) {
        edges.edge[0] = edge_of(-80.0f);
        edges.edge[1] = edge_of((float)k * 7.0f);
        (void)update(1);
        TEST_ASSERT_EQUAL_FLOAT((float)k * 7.0f, orientation.filtered_deg);
    }
}

/* [window.orientation_memory]
 * GIVEN single edges that scatter about the boundary WHEN filtered THEN the angle stays within (-90, 90] and is averaged
 * as an undirected line: 44 and -44 of the other face are two degrees apart, not 88. */
static void lines_are_averaged_without_a_direction(void) {
    (void)see_one(44.0f);
    for (int i = 0; i < 40; i++) {
        (void)see_one(i % 2 == 0 ? 46.0f : 44.0f);
        TEST_ASSERT_FLOAT_WITHIN(2.0f, 45.0f, orientation.filtered_deg);
    }
}

/* GIVEN a spread of single images THEN the mean of more is more certain by the root of how many; a memory of one has that of one. */
static void a_mean_of_more_is_more_certain(void) {
    orientation.variance_deg2 = 9.0f;
    orientation.count = 1;
    TEST_ASSERT_EQUAL_FLOAT(3.0f, goe_orientation_sigma_deg(&orientation));
    orientation.count = 4;
    TEST_ASSERT_EQUAL_FLOAT(1.5f, goe_orientation_sigma_deg(&orientation));
}

/* [A32] */
static void nothing_measured_has_no_spread(void) {
    orientation.variance_deg2 = 9.0f;
    TEST_ASSERT_EQUAL_FLOAT(0.0f, goe_orientation_sigma_deg(&orientation));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(no_measurement_has_no_sigma);
    RUN_TEST(the_side_is_the_edge_nearer_to_the_flight_direction);
    RUN_TEST(a_track_without_images_begins_again);
    RUN_TEST(the_front_gives_the_orientation_if_the_side_cannot);
    RUN_TEST(a_single_edge_is_a_front_beyond_45_degrees);
    RUN_TEST(no_heading_leaves_everything_as_it_is);
    RUN_TEST(noise_near_45_degrees_does_not_swap_the_faces);
    RUN_TEST(clear_edges_win_over_the_low_pass);
    RUN_TEST(the_low_pass_follows_its_formula);
    RUN_TEST(a_memory_of_one_does_not_filter);
    RUN_TEST(lines_are_averaged_without_a_direction);
    RUN_TEST(a_mean_of_more_is_more_certain);
    RUN_TEST(nothing_measured_has_no_spread);
    return UNITY_END();
}
