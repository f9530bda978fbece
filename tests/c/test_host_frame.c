/* What the library is shown of a row of frames.csv: boxes, resets and cameras. SPDX-License-Identifier: MIT
 * The columns' way through goe_replay is tested in tests/host. */
/* tests: sim_host/log/frame.c */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "check.h"
#include "frame.h"

static frame_t frame;
static goe_image_t image;

void setUp(void) { (void)memset(&frame, 0, sizeof frame); }
void tearDown(void) {}

static void give(frame_value_t name, double value) {
    frame.value[name] = value;
    frame.given[name] = true;
}

/* One side after the other, so that no side can replace another. */
static void each_side_given_is_visible(void) {
    static const struct {
        frame_value_t name;
        unsigned bit;
        size_t at;
    } sides[] = {{FRAME_BOX_LEFT_PX, GOE_SIDE_LEFT, offsetof(goe_box_t, left_px)},
                 {FRAME_BOX_TOP_PX, GOE_SIDE_TOP, offsetof(goe_box_t, top_px)},
                 {FRAME_BOX_RIGHT_PX, GOE_SIDE_RIGHT, offsetof(goe_box_t, right_px)},
                 {FRAME_BOX_BOTTOM_PX, GOE_SIDE_BOTTOM, offsetof(goe_box_t, bottom_px)}};
    unsigned seen = 0;
    frame_to_image(&frame, &image);
    TEST_ASSERT_EQUAL_HEX8(0u, image.box.sides);
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        float side_px;
        give(sides[i].name, 100.5 + (double)i);
        seen |= sides[i].bit;
        frame_to_image(&frame, &image);
        TEST_ASSERT_EQUAL_HEX8(seen, image.box.sides);
        (void)memcpy(&side_px, (const char *)&image.box + sides[i].at, sizeof side_px);
        CHECK_SAME(100.5f + (float)i, side_px);
    }
    TEST_ASSERT_EQUAL_HEX8(GOE_SIDES_ALL, image.box.sides);
    TEST_ASSERT_FALSE(image.left.visible || image.right.visible || image.top.visible);
}

/* As of a point: the library must refuse NaN, and the reader must not hide it. */
static void a_side_that_is_no_number_is_shown(void) {
    give(FRAME_BOX_TOP_PX, (double)NAN);
    frame_to_image(&frame, &image);
    TEST_ASSERT_EQUAL_HEX8(GOE_SIDE_TOP, image.box.sides);
    TEST_ASSERT_TRUE(isnan(image.box.top_px));
}

static void a_jump_is_known_by_all_three_numbers(void) {
    give(FRAME_RESET_N_M, 3.0);
    give(FRAME_RESET_E_M, -2.0);
    frame_to_image(&frame, &image);
    TEST_ASSERT_FALSE(image.pose.reset_delta_known);
    give(FRAME_RESET_D_M, 0.5);
    frame_to_image(&frame, &image);
    TEST_ASSERT_TRUE(image.pose.reset_delta_known);
    CHECK_SAME(3.0f, image.pose.reset_delta_ned_m[0]);
    CHECK_SAME(-2.0f, image.pose.reset_delta_ned_m[1]);
    CHECK_SAME(0.5f, image.pose.reset_delta_ned_m[2]);
}

/* A size without a number is unknown, and so is its sigma. */
static void a_kind_is_passed_on(void) {
    give(FRAME_KIND_WIDTH_SD_M, 0.5);
    frame_to_image(&frame, &image);
    CHECK_SAME(0.0f, image.kind.width_m);
    CHECK_SAME(0.0f, image.kind.width_sd_m);
    give(FRAME_KIND_WIDTH_M, 3.25);
    give(FRAME_KIND_HEIGHT_M, 1.5);
    give(FRAME_KIND_HEIGHT_SD_M, 0.25);
    frame.kind_shape = GOE_KIND_OTHER;
    frame_to_image(&frame, &image);
    CHECK_SAME(3.25f, image.kind.width_m);
    CHECK_SAME(0.5f, image.kind.width_sd_m);
    CHECK_SAME(1.5f, image.kind.height_m);
    CHECK_SAME(0.25f, image.kind.height_sd_m);
    TEST_ASSERT_EQUAL_UINT8(GOE_KIND_OTHER, image.kind.shape);
}

static void a_wider_counter_goes_on_in_eight_bits(void) {
    static const struct {
        int64_t count;
        uint8_t shown;
    } cases[] = {{0, 0u}, {255, 255u}, {256, 0u}, {65537, 1u}, {-1, 255u}, {INT64_MAX, 255u}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        frame.reset_count = cases[i].count;
        frame_to_image(&frame, &image);
        TEST_ASSERT_EQUAL_UINT8(cases[i].shown, image.pose.reset_count);
    }
}

/* What fits no number of a camera must not become that of one. */
static void the_camera_s_number_is_shown_as_it_is(void) {
    static const struct {
        int64_t number;
        uint8_t shown;
    } cases[] = {{0, 0u}, {1, 1u}, {254, 254u}, {255, 255u}, {256, 255u}, {257, 255u}, {-1, 255u}, {INT64_MAX, 255u}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        frame.camera = cases[i].number;
        frame_to_image(&frame, &image);
        TEST_ASSERT_EQUAL_UINT8(cases[i].shown, image.camera);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(each_side_given_is_visible);
    RUN_TEST(a_side_that_is_no_number_is_shown);
    RUN_TEST(a_jump_is_known_by_all_three_numbers);
    RUN_TEST(a_kind_is_passed_on);
    RUN_TEST(a_wider_counter_goes_on_in_eight_bits);
    RUN_TEST(the_camera_s_number_is_shown_as_it_is);
    return UNITY_END();
}
