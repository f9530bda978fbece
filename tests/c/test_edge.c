/* Edges of the base: heading (1) and the gates. SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_edge.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "window/goe_edge.h"

#define RAD_PER_DEG 0.017453292519943295

static goe_settings_t settings;
static goe_image_t image;
static goe_view_t view;
static goe_edges_t edges;

void setUp(void) {
    goe_settings_default(&settings);
    settings.camera.fx_px = 1024.0f; /* so that 2 px of it are an exact float */
    settings.camera.fy_px = 1024.0f;
    memset(&image, 0, sizeof image);
    memset(&view, 0, sizeof view);
    view.image = &image;
    view.camera = &settings.camera;
    memset(&edges, 0xA5, sizeof edges);
}
void tearDown(void) {}

static void set_corner(goe_pixel_t *pixel, goe_point_t *point, float x, float y) {
    *point = (goe_point_t){x, y, true};
    *pixel = (goe_pixel_t){1024.0f * x, 1024.0f * y, true};
}

static void set_left(float x, float y) { set_corner(&image.base_left, &view.point[GOE_POINT_BASE_LEFT], x, y); }
static void set_near(float x, float y) { set_corner(&image.base_near, &view.point[GOE_POINT_BASE_NEAR], x, y); }
static void set_right(float x, float y) { set_corner(&image.base_right, &view.point[GOE_POINT_BASE_RIGHT], x, y); }

static goe_status_t find(void) { return goe_edge_find(&settings, &view, &edges); }

/* [goe_image_t.base_left] */
static void two_edges_meet_at_the_near_corner(void) {
    set_left(-0.2f, 0.1f);
    set_near(0.0f, 0.2f);
    set_right(0.1f, 0.15f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(2, edges.count);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_LEFT], edges.edge[0].left);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_NEAR], edges.edge[0].right);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_NEAR], edges.edge[1].left);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_RIGHT], edges.edge[1].right);
}

/* [window.edge_min_px] */
static void without_a_near_corner_there_is_one_edge(void) {
    set_left(-0.2f, 0.1f);
    set_right(0.1f, 0.15f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(1, edges.count);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_LEFT], edges.edge[0].left);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_RIGHT], edges.edge[0].right);
}

/* [window.edge_min_px] */
static void an_edge_needs_both_its_ends(void) {
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(0, edges.count);
    set_near(0.0f, 0.2f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(0, edges.count);
    set_right(0.1f, 0.1f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(1, edges.count);
    TEST_ASSERT_EQUAL_PTR(&view.point[GOE_POINT_BASE_NEAR], edges.edge[0].left);
    view.point[GOE_POINT_BASE_NEAR].usable = false;
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_EQUAL_INT(0, edges.count);
}

/* [goe_image_t.base_left] */
static void corners_out_of_order_give_no_edge(void) {
    set_left(-0.2f, 0.1f);
    set_near(-0.3f, 0.2f);
    set_right(0.1f, 0.15f);
    CHECK_STATUS(GOE_SWAPPED, find());
    TEST_ASSERT_EQUAL_INT(0, edges.count);
    set_near(0.2f, 0.2f);
    CHECK_STATUS(GOE_SWAPPED, find());
    view.point[GOE_POINT_BASE_NEAR].usable = false;
    CHECK_STATUS(GOE_OK, find());
    set_left(0.11f, 0.1f);
    CHECK_STATUS(GOE_SWAPPED, find());
}

/* [window.edge_min_px]
 * GIVEN the gate of 10 px WHEN the ends are exactly 10 px apart THEN the edge does not count, WHEN a bit more it does. */
static void the_length_gate_is_exact(void) {
    set_left(0.0f, 0.1f);
    set_right(0.1f, 0.2f);
    image.base_left = (goe_pixel_t){100.0f, 200.0f, true};
    image.base_right = (goe_pixel_t){110.0f, 200.0f, true};
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_FALSE(edges.edge[0].counts);
    TEST_ASSERT_FALSE(edges.edge[0].has_heading); /* however steep it is */
    image.base_right.u_px = check_next_away(110.0f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].counts);
    TEST_ASSERT_TRUE(edges.edge[0].has_heading);
    image.base_right = (goe_pixel_t){106.0f, 192.0f, true}; /* 6, 8, 10 */
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_FALSE(edges.edge[0].counts);
    image.base_right.v_px = 191.99f;
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].counts);
}

/* [window.edge_min_px, window.orientation_min_px] The orientation gate of 2 px, in aligned y times fx. */
static void the_orientation_gate_is_exact(void) {
    const float rise = 2.0f / 1024.0f;
    set_left(0.0f, 0.0f);
    set_right(0.1f, rise);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].counts);
    TEST_ASSERT_FALSE(edges.edge[0].has_heading);
    set_right(0.1f, check_next_away(rise));
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].has_heading);
    set_right(0.1f, -check_next_away(rise));
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].has_heading);
}

/* [GOE_NO_EDGE] */
static void the_gates_are_settings(void) {
    settings.window.edge_min_px = 50.0f;
    settings.window.orientation_min_px = 30.0f;
    set_left(0.0f, 0.0f);
    set_right(49.0f / 1024.0f, 9.0f / 1024.0f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_FALSE(edges.edge[0].counts); /* 49.8 px */
    set_right(49.0f / 1024.0f, 11.0f / 1024.0f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].counts); /* 50.2 px */
    TEST_ASSERT_FALSE(edges.edge[0].has_heading);
    set_right(49.0f / 1024.0f, 31.0f / 1024.0f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].has_heading);
}

/* [goe_estimate_t.orientation_deg, (1)]
 * GIVEN a horizontal edge on flat ground h below the camera, of any heading g and at any place THEN (1) finds g. */
static void the_heading_is_that_of_the_vanishing_point(void) {
    check_random_t random = check_random_start("edges");
    double worst = 0.0;
    int found = 0;
    for (int g = -89; g <= 90; g++) {
        for (int i = 0; i < 20; i++) {
            const double h = check_random_between(&random, 5.0, 40.0) * (i % 4 == 0 ? -1.0 : 1.0);
            const double z = check_random_between(&random, 40.0, 90.0);
            const double x = check_random_between(&random, -30.0, 30.0);
            const double half = 8.0;
            const double s = sin(g * RAD_PER_DEG);
            const double c = cos(g * RAD_PER_DEG);
            const double ends[2][2] = {{x - half * s, z - half * c}, {x + half * s, z + half * c}};
            const int left = ends[0][0] / ends[0][1] <= ends[1][0] / ends[1][1] ? 0 : 1;
            set_left((float)(ends[left][0] / ends[left][1]), (float)(h / ends[left][1]));
            set_right((float)(ends[1 - left][0] / ends[1 - left][1]), (float)(h / ends[1 - left][1]));
            CHECK_STATUS(GOE_OK, find());
            const double rise_px = 1024.0 * fabs(h / ends[0][1] - h / ends[1][1]);
            if (edges.edge[0].has_heading && rise_px > 8.0) {
                double error = fmod((double)edges.edge[0].heading_deg - g + 720.0, 180.0);
                error = error > 90.0 ? error - 180.0 : error;
                check_worst(&worst, error * rise_px); /* rounding of y weighs as 1/rise */
                TEST_ASSERT_TRUE(edges.edge[0].heading_deg > -90.0f && edges.edge[0].heading_deg <= 90.0f);
                found++;
            }
        }
    }
    check_report("edge headings, worst error in degrees per px of rise", worst);
    TEST_ASSERT_GREATER_THAN_INT(2000, found);
    TEST_ASSERT_TRUE(worst < 0.05);
}

/* [(1)] An edge parallel to the horizon has no heading by the gate; where the gate lets it through it has 90 degrees. */
static void an_edge_along_the_horizon_heads_aside(void) {
    settings.window.orientation_min_px = 0.0f;
    set_left(-0.1f, 0.2f);
    set_right(0.1f, 0.2f);
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_FALSE(edges.edge[0].has_heading);
    set_right(0.1f, check_next_away(0.2f));
    CHECK_STATUS(GOE_OK, find());
    TEST_ASSERT_TRUE(edges.edge[0].has_heading);
    TEST_ASSERT_FLOAT_WITHIN(0.001f, 90.0f, fabsf(edges.edge[0].heading_deg));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(two_edges_meet_at_the_near_corner);
    RUN_TEST(without_a_near_corner_there_is_one_edge);
    RUN_TEST(an_edge_needs_both_its_ends);
    RUN_TEST(corners_out_of_order_give_no_edge);
    RUN_TEST(the_length_gate_is_exact);
    RUN_TEST(the_orientation_gate_is_exact);
    RUN_TEST(the_gates_are_settings);
    RUN_TEST(the_heading_is_that_of_the_vanishing_point);
    RUN_TEST(an_edge_along_the_horizon_heads_aside);
    return UNITY_END();
}
