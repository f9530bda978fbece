/* The sides of a box: which count, and the points that replace them, against leaning rectangles in double.
 * SPDX-License-Identifier: MIT */
/* tests: lib/image/goe_sides.c */
#include "image/goe_sides.h"

#include <math.h>
#include <string.h>

#include "check.h"

#define CASES 500
#define RAD_PER_DEG 0.017453292519943295
#define WIDTH_PX 1000.0f
#define HEIGHT_PX 800.0f
#define BORDER 0.01f /* share of the width: 10 px */
#define CUT 0.05f    /* ... 50 px */

static check_random_t any;
static goe_camera_t camera;
static goe_image_t image;
static goe_view_t view;
static goe_faults_t faults;
static uint32_t fault_counts[GOE_FAULT_COUNTS];
static goe_pixel_t left, right, top;

static void look(double roll_deg, double down_deg);

void setUp(void) {
    memset(&camera, 0, sizeof camera);
    memset(&image, 0, sizeof image);
    memset(&view, 0, sizeof view);
    memset(fault_counts, 0, sizeof fault_counts);
    camera.fx_px = 800.0f;
    camera.fy_px = 500.0f;
    camera.cx_px = 500.0f;
    camera.cy_px = 400.0f;
    camera.width_px = WIDTH_PX;
    camera.height_px = HEIGHT_PX;
    camera.border_rel = BORDER;
    camera.truncation_rel = CUT;
    faults.fault_counts = fault_counts;
    faults.first = GOE_OK;
    view.image = &image;
    look(0.0, 0.0);
}
void tearDown(void) {}

/* The camera, rolled to the right about its axis, which then points down by that. */
static void look(double roll_deg, double down_deg) {
    const double c = cos(roll_deg * RAD_PER_DEG);
    const double s = sin(roll_deg * RAD_PER_DEG);
    const double cd = cos(down_deg * RAD_PER_DEG);
    const double sd = sin(down_deg * RAD_PER_DEG);
    const double r[9] = {c, -s, 0.0, cd * s, cd * c, sd, -sd * s, -sd * c, cd};
    for (int i = 0; i < 9; i++) {
        view.camera_to_trajectory[i] = (float)r[i];
    }
}

static void see(float l, float t, float r, float b, unsigned seen) {
    image.box.left_px = l;
    image.box.top_px = t;
    image.box.right_px = r;
    image.box.bottom_px = b;
    image.box.sides = (uint8_t)seen;
    faults.first = GOE_OK;
    goe_sides_read(&camera, &view, &faults);
    goe_sides_points(&camera, &view, &left, &right, &top);
}

/* ----------------------------------------------------------------------------------------------------------- sides -- */

/* [GOE_SIDES_ALL, goe_box_t.sides] GIVEN bits beyond those of the four sides THEN they are none. */
static void a_bit_that_is_no_side_is_none(void) {
    see(400.0f, 300.0f, 600.0f, 500.0f, 0xF0u | GOE_SIDE_LEFT);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT, view.sides.usable);
}

/* [camera.width_px, goe_box_t.sides] GIVEN a left or right side that is not measured, whatever it holds THEN the visible part ends at the
 * image's border there; without the camera's width that lies as far from the principal point as the other. */
static void a_missing_side_ends_at_the_border(void) {
    camera.cx_px = 450.0f;
    for (int known = 0; known < 2; known++) {
        camera.width_px = known == 1 ? WIDTH_PX : 0.0f;
        see(NAN, 300.0f, 600.0f, 500.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_LEFT);
        CHECK_SAME(0.0f, view.sides.px[GOE_BOX_LEFT]);
        CHECK_SAME(600.0f, view.sides.px[GOE_BOX_RIGHT]);
        see(400.0f, 300.0f, NAN, 500.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_RIGHT);
        CHECK_SAME(400.0f, view.sides.px[GOE_BOX_LEFT]);
        CHECK_SAME(known == 1 ? WIDTH_PX : 900.0f, view.sides.px[GOE_BOX_RIGHT]);
    }
}

/* [camera.border_rel, camera.height_px, camera.width_px]
 * GIVEN a side nearer to its border than the share of the width THEN it does not count, and no other side is the worse. */
static void a_side_at_the_border_is_not_measured(void) {
    static const float in_px[] = {12.0f, 12.0f, WIDTH_PX - 13.0f, HEIGHT_PX - 13.0f};
    static const float out_px[] = {9.0f, 9.0f, WIDTH_PX - 10.0f, HEIGHT_PX - 10.0f};
    for (unsigned set = 0; set <= GOE_SIDES_ALL; set++) {
        const float l = set & GOE_SIDE_LEFT ? in_px[0] : out_px[0];
        const float t = set & GOE_SIDE_TOP ? in_px[1] : out_px[1];
        const float r = set & GOE_SIDE_RIGHT ? in_px[2] : out_px[2];
        const float b = set & GOE_SIDE_BOTTOM ? in_px[3] : out_px[3];
        see(l, t, r, b, GOE_SIDES_ALL);
        TEST_ASSERT_EQUAL_HEX(set, view.sides.usable);
        TEST_ASSERT_EQUAL_UINT32(0u, fault_counts[-GOE_SWAPPED]);
    }
}

/* [detector.box_noise_rel]
 * GIVEN a side that is nearer to the border than 3 times the slow error of a box which ends there THEN the border may have cut it: it is
 * doubtful, and so are the obstacle's ends. A side that is not measured is not doubtful. Where the opposite one is not measured, the box's
 * size is not known, and without slow error or without the image's size there is no such distance. */
static void a_side_that_may_be_cut_is_doubtful(void) {
    const unsigned wide = GOE_SIDE_LEFT | GOE_SIDE_RIGHT;
    static const struct {
        float left_px, top_px, right_px, bottom_px, noise_rel;
        unsigned doubtful;
    } cases[] = {
        {200.0f, 101.0f, 600.0f, 500.0f, 0.0666667f, 0u}, /* 3 times, of 500 px: 100 px */
        {200.0f, 99.0f, 600.0f, 500.0f, 0.0666667f, GOE_SIDE_TOP},
        {201.0f, 299.0f, 798.0f, 698.0f, 0.0666667f, 0u},
        {201.0f, 299.0f, 798.0f, 700.0f, 0.0666667f, GOE_SIDE_BOTTOM},
        {99.0f, 200.0f, 500.0f, 600.0f, 0.0666667f, GOE_SIDE_LEFT}, /* of 500 px: 100 px */
        {101.0f, 200.0f, 500.0f, 600.0f, 0.0666667f, 0u},
        {500.0f, 200.0f, 900.0f, 600.0f, 0.0666667f, GOE_SIDE_RIGHT}, /* of 499 px */
        {500.0f, 200.0f, 898.0f, 600.0f, 0.0666667f, 0u},
        {200.0f, 20.0f, 600.0f, 780.0f, 0.0666667f, GOE_SIDE_TOP | GOE_SIDE_BOTTOM},
        {200.0f, 5.0f, 600.0f, 795.0f, 0.0666667f, 0u}, /* at the border: not measured */
        {200.0f, 20.0f, 600.0f, 780.0f, 0.0f, 0u},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        view.box_noise_rel = cases[i].noise_rel;
        see(cases[i].left_px, cases[i].top_px, cases[i].right_px, cases[i].bottom_px, GOE_SIDES_ALL);
        TEST_ASSERT_EQUAL_HEX(cases[i].doubtful, view.sides.doubtful);
        TEST_ASSERT_EQUAL_HEX(cases[i].top_px < 10.0f ? wide : GOE_SIDES_ALL, view.sides.usable);
        TEST_ASSERT_EQUAL_HEX(cases[i].doubtful & wide, view.sides.ends);
        TEST_ASSERT_FALSE(view.sides.truncated);
    }
    view.box_noise_rel = 0.0666667f;
    see(200.0f, 299.0f, 600.0f, 700.0f, wide | GOE_SIDE_BOTTOM);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.doubtful);
    see(200.0f, 50.0f, 600.0f, 500.0f, wide | GOE_SIDE_TOP);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.doubtful);
    camera.height_px = 0.0f;
    see(200.0f, 20.0f, 600.0f, 780.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.doubtful);
}

static void a_border_that_is_not_known_is_none(void) {
    camera.width_px = camera.height_px = 0.0f;
    see(-5.0f, -5.0f, 5000.0f, 5000.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDES_ALL, view.sides.usable);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.cut);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.ends);
}

/* [camera.truncation_rel, detector.truncation_noise_rel]
 * GIVEN a side that is missing, or nearer to the border than truncation_rel THEN it counts as cut. */
static void a_side_near_the_border_is_cut(void) {
    see(200.0f, 200.0f, 600.0f, 600.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.cut);
    see(40.0f, 200.0f, 600.0f, 600.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT, view.sides.cut);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDES_ALL, view.sides.usable);
    see(200.0f, 30.0f, 960.0f, 600.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_TOP | GOE_SIDE_RIGHT, view.sides.cut);
    see(200.0f, 200.0f, 600.0f, 600.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_RIGHT);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_RIGHT, view.sides.cut);
    see(200.0f, 200.0f, 600.0f, 780.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_BOTTOM, view.sides.cut);
    TEST_ASSERT_FALSE(view.sides.truncated);
    see(960.0f, 200.0f, 980.0f, 600.0f, GOE_SIDES_ALL); /* all of it is at the border */
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT | GOE_SIDE_RIGHT, view.sides.cut);
    TEST_ASSERT_TRUE(view.sides.truncated);
}

/* [camera.mount_roll_deg]
 * GIVEN a camera at any roll THEN a cut side of the image hides the end of the obstacle that lies there: the right end in the direction that
 * is to the right of the obstacle's vertical, none above and below. With a lean, two borders cut each end of a wide obstacle. */
static void a_cut_side_hides_the_end_that_lies_there(void) {
    static const double outward[GOE_BOX_SIDES][2] = {{-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
    static const float cut_at[GOE_BOX_SIDES] = {40.0f, 40.0f, 960.0f, 760.0f};
    for (int roll_deg = -180; roll_deg < 180; roll_deg += 10) {
        look((double)roll_deg, 5.0);
        const float *right_of = view.camera_to_trajectory; /* the axis to the right, in the image */
        for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
            float px[GOE_BOX_SIDES] = {200.0f, 200.0f, 600.0f, 600.0f};
            px[side] = cut_at[side];
            see(px[0], px[1], px[2], px[3], GOE_SIDES_ALL);
            const double lies = outward[side][0] * (double)right_of[0] + outward[side][1] * (double)right_of[1];
            const unsigned expected =
                fabs(lies) < 0.1961 ? 0u : (unsigned)(lies > 0.0 ? GOE_SIDE_RIGHT : GOE_SIDE_LEFT);
            TEST_ASSERT_EQUAL_HEX(expected, view.sides.ends);
            TEST_ASSERT_TRUE(view.sides.truncated || expected == 0u);
        }
    }
}

/* [goe_box_t.left_px] GIVEN sides out of order THEN none counts, and that is reported; invisible sides may be in any order. */
static void sides_out_of_order_do_not_count(void) {
    see(600.0f, 200.0f, 600.0f, 600.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.usable);
    TEST_ASSERT_EQUAL_INT(GOE_SWAPPED, faults.first);
    see(200.0f, 600.0f, 600.0f, 500.0f, GOE_SIDES_ALL);
    TEST_ASSERT_EQUAL_HEX(0u, view.sides.usable);
    TEST_ASSERT_EQUAL_UINT32(2u, fault_counts[-GOE_SWAPPED]);
    see(600.0f, 600.0f, 200.0f, 500.0f, GOE_SIDE_LEFT | GOE_SIDE_TOP);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT | GOE_SIDE_TOP, view.sides.usable);
    see(600.0f, 200.0f, 200.0f, 500.0f, GOE_SIDE_LEFT | GOE_SIDE_TOP | GOE_SIDE_BOTTOM);
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT | GOE_SIDE_TOP | GOE_SIDE_BOTTOM, view.sides.usable);
    TEST_ASSERT_EQUAL_UINT32(2u, fault_counts[-GOE_SWAPPED]);
}

/* ---------------------------------------------------------------------------------------------------------- points -- */

static void check_pixel(double u_px, double v_px, const goe_pixel_t *pixel) {
    TEST_ASSERT_TRUE(pixel->visible);
    CHECK_CLOSE(0.02, u_px, pixel->u_px);
    CHECK_CLOSE(0.02, v_px, pixel->v_px);
}

/* [goe_image_t.box]
 * GIVEN rectangles that lean with the camera's roll WHEN their upright boxes are given THEN the points are the middles of the
 * rectangles' own sides. */
static void a_leaning_box_is_turned_back(void) {
    any = check_random_start("leaning");
    for (int n = 0; n < CASES; n++) {
        const double roll_deg = check_random_between(&any, -25.0, 25.0);
        const double c = cos(roll_deg * RAD_PER_DEG);
        const double s = sin(roll_deg * RAD_PER_DEG);
        const double w = check_random_between(&any, 0.03, 0.15); /* half, focal lengths */
        const double h = check_random_between(&any, 0.03, 0.15);
        const double x = check_random_between(&any, -0.2, 0.2);
        const double y = check_random_between(&any, -0.2, 0.2);
        const double wide = w * c + h * fabs(s);
        const double high = w * fabs(s) + h * c;
        look(roll_deg, 0.0); /* down lies in the image at (sin roll, cos roll) */
        see((float)(500.0 + 800.0 * (x - wide)), (float)(400.0 + 500.0 * (y - high)),
            (float)(500.0 + 800.0 * (x + wide)), (float)(400.0 + 500.0 * (y + high)), GOE_SIDES_ALL);
        if (fabs(s) < 0.011) {
            continue; /* taken as upright */
        }
        check_pixel(500.0 + 800.0 * (x - w * c), 400.0 + 500.0 * (y + w * s), &left);
        check_pixel(500.0 + 800.0 * (x + w * c), 400.0 + 500.0 * (y - w * s), &right);
        check_pixel(500.0 + 800.0 * (x - h * s), 400.0 + 500.0 * (y - h * c), &top);
    }
}

/* GIVEN an upright box THEN its points are the middles of its visible sides: without bottom at the top's height,
 * without both at the image's middle. */
static void an_upright_box_gives_the_middles_of_its_sides(void) {
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDES_ALL);
    check_pixel(300.0, 200.0, &left);
    check_pixel(500.0, 200.0, &right);
    check_pixel(400.0, 100.0, &top);
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_BOTTOM);
    check_pixel(300.0, 100.0, &left);
    check_pixel(400.0, 100.0, &top);
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDE_LEFT | GOE_SIDE_RIGHT);
    check_pixel(500.0, 400.0, &right);
    TEST_ASSERT_FALSE(top.visible);
}

static void check_no_points(void) { TEST_ASSERT_FALSE(left.visible || right.visible || top.visible); }

/* [goe_image_t.box] GIVEN a box too narrow for the lean of its content THEN it gives no points. */
static void missing_sides_of_a_box_give_no_points(void) {
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_LEFT);
    check_no_points();
    look(20.0, 0.0); /* without its height */
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_BOTTOM);
    check_no_points();
    look(40.0, 0.0); /* leaning too far */
    see(300.0f, 100.0f, 500.0f, 300.0f, GOE_SIDES_ALL);
    check_no_points();
    look(20.0, 0.0); /* too flat, and too narrow, for any rectangle that leans so */
    see(300.0f, 190.0f, 700.0f, 210.0f, GOE_SIDES_ALL);
    check_no_points();
    see(480.0f, 100.0f, 520.0f, 700.0f, GOE_SIDES_ALL);
    check_no_points();
    look(0.0, 90.0); /* from straight above there is no down in the image */
    see(400.0f, 300.0f, 600.0f, 500.0f, GOE_SIDES_ALL);
    check_no_points();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_bit_that_is_no_side_is_none);
    RUN_TEST(a_side_at_the_border_is_not_measured);
    RUN_TEST(a_missing_side_ends_at_the_border);
    RUN_TEST(a_side_that_may_be_cut_is_doubtful);
    RUN_TEST(a_border_that_is_not_known_is_none);
    RUN_TEST(a_side_near_the_border_is_cut);
    RUN_TEST(a_cut_side_hides_the_end_that_lies_there);
    RUN_TEST(sides_out_of_order_do_not_count);
    RUN_TEST(a_leaning_box_is_turned_back);
    RUN_TEST(an_upright_box_gives_the_middles_of_its_sides);
    RUN_TEST(missing_sides_of_a_box_give_no_points);
    return UNITY_END();
}
