/* Which sides of a bounding box are measured, and the points that stand for them. SPDX-License-Identifier: MIT */
#include "image/goe_sides.h"

#include <math.h>
#include <string.h>

#include "check.h"

#define RAD_PER_DEG 0.017453292519943295
#define FOCAL_PX 800.0f
#define WIDTH_PX 1000.0f
#define HEIGHT_PX 800.0f

static goe_camera_t camera;
static goe_image_t image;
static goe_view_t view;
static uint32_t causes[GOE_CAUSES];
static goe_faults_t faults;

/* A box in the middle of the image; a level camera that looks along T's Z axis. */
void setUp(void) {
    static const float level[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    memset(&camera, 0, sizeof camera);
    memset(&image, 0, sizeof image);
    memset(&view, 0, sizeof view);
    memset(causes, 0, sizeof causes);
    camera.fx_px = camera.fy_px = FOCAL_PX;
    camera.cx_px = 0.5f * WIDTH_PX;
    camera.cy_px = 0.5f * HEIGHT_PX;
    camera.width_px = WIDTH_PX;
    camera.height_px = HEIGHT_PX;
    camera.border_share = 0.01f; /* 10 px */
    camera.cut_share = 0.05f;    /* 50 px */
    image.box = (goe_box_t){400.0f, 300.0f, 600.0f, 500.0f, GOE_SEES_BOX};
    view.image = &image;
    memcpy(view.camera_to_trajectory, level, sizeof level);
    faults.causes = causes;
    faults.first = GOE_OK;
}
void tearDown(void) {}

static unsigned read(void) {
    faults.first = GOE_OK;
    goe_sides_read(&camera, &view, &faults);
    return view.sides.usable;
}

/* ------------------------------------------------------------------------------------------------------------ border -- */

/* GIVEN a side nearer to the border than border_share of the image's width THEN it is not measured; at that distance it is. */
static void a_side_near_the_border_is_not_measured(void) {
    float *const side[GOE_BOX_SIDES] = {&image.box.left_px, &image.box.top_px, &image.box.right_px,
                                        &image.box.bottom_px};
    static const float at_px[GOE_BOX_SIDES] = {10.0f, 10.0f, WIDTH_PX - 1.0f - 10.0f, HEIGHT_PX - 1.0f - 10.0f};
    for (unsigned i = 0; i < GOE_BOX_SIDES; i++) {
        setUp();
        *side[i] = at_px[i];
        TEST_ASSERT_EQUAL_HEX(GOE_SEES_BOX, read());
        *side[i] += i < 2u ? -0.5f : 0.5f;
        TEST_ASSERT_EQUAL_HEX(GOE_SEES_BOX & ~(1u << i), read());
        *side[i] += i < 2u ? -1000.0f : 1000.0f; /* beyond it */
        TEST_ASSERT_EQUAL_HEX(GOE_SEES_BOX & ~(1u << i), read());
    }
    TEST_ASSERT_EQUAL_UINT32(0u, causes[-GOE_SWAPPED]);
}

static void near_a_border_that_is_not_known_every_side_is_measured(void) {
    camera.width_px = camera.height_px = 0.0f;
    image.box = (goe_box_t){-50.0f, -50.0f, 5000.0f, 5000.0f, GOE_SEES_BOX};
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_BOX, read());
    TEST_ASSERT_FALSE(view.sides.cut);
}

/* GIVEN left or right not measured, or nearer to the border than cut_share THEN the box is a cut one; top and bottom cut none. */
static void a_box_near_the_border_is_cut(void) {
    (void)read();
    TEST_ASSERT_FALSE(view.sides.cut);
    image.box.left_px = 50.0f;
    (void)read();
    TEST_ASSERT_FALSE(view.sides.cut);
    image.box.left_px = 49.5f;
    (void)read();
    TEST_ASSERT_TRUE(view.sides.cut);
    setUp();
    image.box.right_px = WIDTH_PX - 1.0f - 49.5f;
    (void)read();
    TEST_ASSERT_TRUE(view.sides.cut);
    setUp();
    image.box.top_px = 20.0f;
    image.box.bottom_px = HEIGHT_PX - 21.0f;
    (void)read();
    TEST_ASSERT_FALSE(view.sides.cut);
    setUp();
    image.box.seen = GOE_SEES_BOX & ~GOE_SEES_RIGHT;
    (void)read();
    TEST_ASSERT_TRUE(view.sides.cut);
}

/* ------------------------------------------------------------------------------------------------------------- order -- */

static void a_box_inside_out_is_swapped(void) {
    image.box.left_px = image.box.right_px;
    TEST_ASSERT_EQUAL_HEX(0u, read());
    CHECK_STATUS(GOE_SWAPPED, faults.first);
    TEST_ASSERT_EQUAL_UINT32(1u, causes[-GOE_SWAPPED]);
    setUp();
    image.box.top_px = image.box.bottom_px + 1.0f;
    TEST_ASSERT_EQUAL_HEX(0u, read());
    TEST_ASSERT_EQUAL_UINT32(1u, causes[-GOE_SWAPPED]);
    image.box.seen = GOE_SEES_LEFT | GOE_SEES_TOP | GOE_SEES_RIGHT; /* without the bottom nothing is out of order */
    TEST_ASSERT_EQUAL_HEX(image.box.seen, read());
}

static void a_bit_that_is_no_side_is_none(void) {
    image.box.seen = 0xF0u | GOE_SEES_LEFT;
    TEST_ASSERT_EQUAL_HEX(GOE_SEES_LEFT, read());
}

/* ------------------------------------------------------------------------------------------------------------ points -- */

typedef struct {
    goe_pixel_t left, right, top;
} points_t;

static points_t points(void) {
    points_t p;
    memset(&p, 0, sizeof p);
    (void)read();
    goe_sides_points(&camera, &view, &p.left, &p.right, &p.top);
    return p;
}

/* GIVEN a rectangle whose verticals lean in the image, by less than 30 degrees THEN left, right and top are the middles of its
 * edges; leaning more, there are none. */
static void points_are_those_of_the_leaning_rectangle(void) {
    for (int deg = -40; deg <= 40; deg += 8) {
        const double s = sin(deg * RAD_PER_DEG);
        const double c = cos(deg * RAD_PER_DEG);
        const double half_width = 60.0;
        const double half_height = 90.0;
        const double wide = half_width * c + half_height * fabs(s);
        const double high = half_width * fabs(s) + half_height * c;
        setUp();
        view.camera_to_trajectory[3] = (float)s; /* down in the image is (s, c) */
        view.camera_to_trajectory[4] = (float)c;
        image.box = (goe_box_t){(float)(500.0 - wide), (float)(400.0 - high), (float)(500.0 + wide),
                                (float)(400.0 + high), GOE_SEES_BOX};
        const points_t p = points();
        if (deg < -30 || deg > 30) {
            TEST_ASSERT_FALSE(p.left.seen || p.right.seen || p.top.seen);
            continue;
        }
        TEST_ASSERT_TRUE(p.left.seen && p.right.seen && p.top.seen);
        CHECK_CLOSE(0.01, 500.0 - half_width * c, p.left.u_px);
        CHECK_CLOSE(0.01, 400.0 + half_width * s, p.left.v_px);
        CHECK_CLOSE(0.01, 500.0 + half_width * c, p.right.u_px);
        CHECK_CLOSE(0.01, 400.0 - half_width * s, p.right.v_px);
        CHECK_CLOSE(0.01, 500.0 - half_height * s, p.top.u_px);
        CHECK_CLOSE(0.01, 400.0 - half_height * c, p.top.v_px);
    }
}

/* GIVEN an upright one THEN left and right do without top and bottom; GIVEN a leaning one THEN it takes all four sides. */
static void what_is_not_measured_gives_no_point(void) {
    image.box.seen = GOE_SEES_LEFT | GOE_SEES_RIGHT;
    points_t p = points();
    TEST_ASSERT_TRUE(p.left.seen && p.right.seen && !p.top.seen);
    CHECK_CLOSE(1.0e-3, 400.0, p.left.u_px);
    CHECK_CLOSE(1.0e-3, 600.0, p.right.u_px);
    view.camera_to_trajectory[3] = 0.2f;
    p = points();
    TEST_ASSERT_FALSE(p.left.seen || p.right.seen || p.top.seen);
    setUp();
    image.box.seen = GOE_SEES_BOX & ~GOE_SEES_LEFT;
    p = points();
    TEST_ASSERT_FALSE(p.left.seen || p.right.seen || p.top.seen);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_side_near_the_border_is_not_measured);
    RUN_TEST(near_a_border_that_is_not_known_every_side_is_measured);
    RUN_TEST(a_box_near_the_border_is_cut);
    RUN_TEST(a_box_inside_out_is_swapped);
    RUN_TEST(a_bit_that_is_no_side_is_none);
    RUN_TEST(points_are_those_of_the_leaning_rectangle);
    RUN_TEST(what_is_not_measured_gives_no_point);
    return UNITY_END();
}
