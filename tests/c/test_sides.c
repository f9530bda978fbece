/* Sides of a box: which count, and what points they make. SPDX-License-Identifier: MIT */
#include "image/goe_sides.h"

#include <math.h>
#include <string.h>

#include "check.h"

#define CASES 300

static goe_camera_t camera;
static goe_view_t view;
static goe_image_t image;
static goe_motion_t motion;
static uint32_t causes[GOE_CAUSES];
static check_random_t any;

void setUp(void) {
    memset(&camera, 0, sizeof camera);
    memset(&view, 0, sizeof view);
    memset(&image, 0, sizeof image);
    memset(&motion, 0, sizeof motion);
    memset(causes, 0, sizeof causes);
    camera.fx_px = 900.0f;
    camera.fy_px = 800.0f;
    camera.cx_px = 700.0f;
    camera.cy_px = 500.0f;
    view.image = &image;
    view.motion = &motion;
    view.camera = &camera;
    image.box.seen = GOE_SEES_BOX;
}
void tearDown(void) {}

/* A camera that looks along Z, rolled to the right. */
static void roll(double rad) {
    const float r[9] = {
        (float)cos(rad), (float)-sin(rad), 0.0f, (float)sin(rad), (float)cos(rad), 0.0f, 0.0f, 0.0f, 1.0f};
    memcpy(view.camera_to_trajectory, r, sizeof r);
}

static void read_sides(void) {
    goe_faults_t faults = {causes, GOE_OK};
    goe_sides_read(&camera, &view, &faults);
}

/* GIVEN an upright rectangle in the world, of the middle (x, y) and half sides w and h, focal lengths, seen by a rolled camera WHEN its
 * upright bounding box in the image is read THEN the points made of it are the rectangle's: the middles of its sides and of its top,
 * and not those of the larger box. */
static void a_leaning_box_is_turned_back(void) {
    any = check_random_start("leaning");
    for (int n = 0; n < CASES; n++) {
        const double lean = (n % 2 == 0 ? -1.0 : 1.0) * check_random_between(&any, 0.02, 0.45);
        const double c = cos(lean);
        const double s = sin(lean);
        const double x = check_random_between(&any, -0.3, 0.3);
        const double y = check_random_between(&any, -0.3, 0.3);
        const double w = check_random_between(&any, 0.05, 0.1);
        const double h = check_random_between(&any, 0.08, 0.15);
        const double half[2] = {w * c + h * fabs(s), w * fabs(s) + h * c};
        goe_pixel_t left;
        goe_pixel_t right;
        goe_pixel_t top;
        roll(lean);
        image.box.left_px = (float)(700.0 + 900.0 * (x - half[0]));
        image.box.right_px = (float)(700.0 + 900.0 * (x + half[0]));
        image.box.top_px = (float)(500.0 + 800.0 * (y - half[1]));
        image.box.bottom_px = (float)(500.0 + 800.0 * (y + half[1]));
        read_sides();
        goe_sides_points(&camera, &view, &left, &right, &top);
        const double down[2] = {s, c}; /* of the world, in the image */
        TEST_ASSERT_TRUE(left.seen && right.seen && top.seen);
        CHECK_CLOSE(0.05, 700.0 + 900.0 * (x - w * down[1]), left.u_px);
        CHECK_CLOSE(0.05, 500.0 + 800.0 * (y + w * down[0]), left.v_px);
        CHECK_CLOSE(0.05, 700.0 + 900.0 * (x + w * down[1]), right.u_px);
        CHECK_CLOSE(0.05, 500.0 + 800.0 * (y - w * down[0]), right.v_px);
        CHECK_CLOSE(0.05, 700.0 + 900.0 * (x - h * down[0]), top.u_px);
        CHECK_CLOSE(0.05, 500.0 + 800.0 * (y - h * down[1]), top.v_px);
    }
}

/* GIVEN an upright box of which some sides are not seen THEN the points are level with what is: the middle of its height, or its top, or
 * the principal point; without both of left and right there are none, and without the top no top. */
static void missing_sides_leave_what_is_seen(void) {
    static const struct {
        unsigned seen;
        double v_px;
        bool points, top;
    } cases[] = {{GOE_SEES_BOX, 400.0, true, true},
                 {GOE_SEES_LEFT | GOE_SEES_RIGHT | GOE_SEES_TOP, 300.0, true, true},
                 {GOE_SEES_LEFT | GOE_SEES_RIGHT | GOE_SEES_BOTTOM, 500.0, true, false},
                 {GOE_SEES_LEFT | GOE_SEES_RIGHT, 500.0, true, false},
                 {GOE_SEES_LEFT | GOE_SEES_TOP | GOE_SEES_BOTTOM, 0.0, false, false}};
    roll(0.0);
    image.box.left_px = 600.0f;
    image.box.right_px = 700.0f;
    image.box.top_px = 300.0f;
    image.box.bottom_px = 500.0f;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        goe_pixel_t left;
        goe_pixel_t right;
        goe_pixel_t top;
        image.box.seen = (uint8_t)cases[i].seen;
        read_sides();
        goe_sides_points(&camera, &view, &left, &right, &top);
        TEST_ASSERT_EQUAL_INT(cases[i].points, left.seen && right.seen);
        TEST_ASSERT_EQUAL_INT(cases[i].top, top.seen);
        if (cases[i].points) {
            CHECK_CLOSE(1.0e-3, 600.0, left.u_px);
            CHECK_CLOSE(1.0e-3, 700.0, right.u_px);
            CHECK_CLOSE(1.0e-3, cases[i].v_px, left.v_px);
            CHECK_CLOSE(1.0e-3, cases[i].v_px, right.v_px);
        }
        if (cases[i].top) {
            CHECK_CLOSE(1.0e-3, 650.0, top.u_px);
            CHECK_CLOSE(1.0e-3, 300.0, top.v_px);
        }
    }
}

/* GIVEN a box that leans by so much that it hardly tells its width from its height, or without a height, or that no upright rectangle
 * fits into THEN it makes no points. */
static void a_box_that_tells_no_width_makes_no_points(void) {
    for (int n = 0; n < 3; n++) {
        goe_pixel_t left;
        goe_pixel_t right;
        goe_pixel_t top;
        setUp();
        roll(n == 0 ? 0.6 : 0.3);
        image.box.left_px = 600.0f;
        image.box.right_px = 700.0f;
        image.box.top_px = n == 2 ? 100.0f : 300.0f;
        image.box.bottom_px = n == 2 ? 900.0f : 500.0f;
        image.box.seen = n == 1 ? GOE_SEES_LEFT | GOE_SEES_RIGHT | GOE_SEES_TOP : GOE_SEES_BOX;
        read_sides();
        goe_sides_points(&camera, &view, &left, &right, &top);
        TEST_ASSERT_FALSE(left.seen || right.seen || top.seen);
    }
}

/* GIVEN the size of the image THEN a side nearer to the border than its share is not measured, and left and right near it mark the box as
 * cut; of an image whose size is not known nothing is near. */
static void sides_at_the_border_are_not_measured(void) {
    camera.border_share = 0.01f;
    camera.cut_share = 0.05f;
    image.box.left_px = 14.0f;
    image.box.right_px = 700.0f;
    image.box.top_px = 13.0f;
    image.box.bottom_px = 985.0f;
    roll(0.0);
    read_sides();
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_BOX, view.sides.usable);
    TEST_ASSERT_FALSE(view.sides.cut);
    camera.width_px = 1400.0f; /* 14 px, and 70 px */
    camera.height_px = 1000.0f;
    read_sides();
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_LEFT | GOE_SEES_RIGHT | GOE_SEES_BOTTOM, view.sides.usable);
    TEST_ASSERT_TRUE(view.sides.cut);
    image.box.left_px = 70.0f;
    image.box.bottom_px = 986.0f;
    read_sides();
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_LEFT | GOE_SEES_RIGHT, view.sides.usable);
    TEST_ASSERT_FALSE(view.sides.cut);
    image.box.right_px = 1330.0f;
    read_sides();
    TEST_ASSERT_TRUE(view.sides.cut);
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_LEFT | GOE_SEES_RIGHT, view.sides.usable);
    image.box.seen = GOE_SEES_LEFT | GOE_SEES_TOP; /* a side that is missing was cut */
    read_sides();
    TEST_ASSERT_TRUE(view.sides.cut);
}

/* GIVEN sides out of their order THEN none counts, and the fault is; where one of a pair is not seen there is no order. */
static void sides_out_of_order_do_not_count(void) {
    for (int n = 0; n < 2; n++) {
        setUp();
        roll(0.0);
        image.box = (goe_box_t){n == 0 ? 700.0f : 600.0f, 300.0f, 700.0f, n == 1 ? 300.0f : 500.0f, GOE_SEES_BOX};
        read_sides();
        TEST_ASSERT_EQUAL_HEX(0u, view.sides.usable);
        TEST_ASSERT_EQUAL_UINT32(1u, causes[-GOE_SWAPPED]);
        image.box.seen =
            n == 0 ? GOE_SEES_LEFT | GOE_SEES_TOP | GOE_SEES_BOTTOM : GOE_SEES_LEFT | GOE_SEES_RIGHT | GOE_SEES_TOP;
        read_sides();
        TEST_ASSERT_EQUAL_HEX(image.box.seen, view.sides.usable);
        TEST_ASSERT_EQUAL_UINT32(1u, causes[-GOE_SWAPPED]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_leaning_box_is_turned_back);
    RUN_TEST(missing_sides_leave_what_is_seen);
    RUN_TEST(a_box_that_tells_no_width_makes_no_points);
    RUN_TEST(sides_at_the_border_are_not_measured);
    RUN_TEST(sides_out_of_order_do_not_count);
    return UNITY_END();
}
