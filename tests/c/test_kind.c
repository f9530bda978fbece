/* Size and shape by the detector's class. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_answer.c lib/refined/goe_kind.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "image/goe_intake.h"
#include "inverse.h"
#include "refined/goe_answer.h"
#include "refined/goe_kind.h"
#include "refined/goe_srif.h"
#include "sighting.h"

static sighting_t sighting;
static goe_kind_t kind;
static goe_filter_t filter;

/* A footprint 100 m away, 4 m wide and 10 m high over its ground, whose range is known to a third. */
void setUp(void) {
    check_random_t any = check_random_start("kind");
    sighting_start(&sighting, &any);
    memset(&kind, 0, sizeof kind);
    memset(&filter, 0, sizeof filter);
    sighting.sight.kind = &kind;
    inverse_start(&filter.root, 1.0e-4);
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 300.0f;
    filter.phase = GOE_PHASE_FOOTPRINT;
    filter.state[GOE_INVERSE_RANGE] = 0.01f;
    filter.state[GOE_HALF] = 0.02f;
    filter.state[GOE_TOP] = 0.09f;
    filter.state[GOE_GROUND] = 0.01f;
}
void tearDown(void) {}

static void state(float width_m, float width_sd_m, float height_m, float height_sd_m) {
    kind.width_m = width_m;
    kind.width_sd_m = width_sd_m;
    kind.height_m = height_m;
    kind.height_sd_m = height_sd_m;
}

/* [goe_kind.c] GIVEN both sizes THEN the one that is known better gives the range; a size whose angle is not visible gives none. */
static void the_better_size_gives_the_range(void) {
    state(4.0f, 1.0f, 10.0f, 1.0f);
    CHECK_CLOSE(1.0e-4, 10.0 / 0.2, goe_kind_range_m(&kind, 0.05f, 0.2f));
    CHECK_CLOSE(1.0e-4, 4.0 / 0.05, goe_kind_range_m(&kind, 0.05f, 0.0f));
    CHECK_CLOSE(1.0e-4, 10.0 / 0.2, goe_kind_range_m(&kind, 0.0f, 0.2f));
    CHECK_SAME(0.0f, goe_kind_range_m(&kind, 0.0f, 0.0f));
    state(4.0f, 0.2f, 10.0f, 1.0f);
    CHECK_CLOSE(1.0e-4, 4.0 / 0.05, goe_kind_range_m(&kind, 0.05f, 0.2f));
    state(0.0f, 0.0f, 0.0f, 0.0f);
    CHECK_SAME(0.0f, goe_kind_range_m(&kind, 0.05f, 0.2f));
}

/* [goe_kind_t.width_m, goe_kind.c] GIVEN a size that the images contradict WHEN three images in a row do THEN it is wrong, and not before; an image
 * that fits begins the count again. What the images do not know contradicts nothing. */
static void three_images_show_a_wrong_size(void) {
    state(0.0f, 0.0f, 10.0f, 0.5f);
    for (int k = 0; k < 10; k++) {
        goe_kind_test(&filter, &sighting.sight);
    }
    TEST_ASSERT_FALSE(filter.kind.wrong);
    state(0.0f, 0.0f, 30.0f, 0.5f); /* the range is known to a third: two sigma */
    for (int k = 0; k < 10; k++) {
        goe_kind_test(&filter, &sighting.sight);
    }
    TEST_ASSERT_FALSE(filter.kind.wrong);
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 1.0e4f; /* to 1 % */
    goe_kind_test(&filter, &sighting.sight);
    goe_kind_test(&filter, &sighting.sight);
    state(0.0f, 0.0f, 10.0f, 0.5f);
    goe_kind_test(&filter, &sighting.sight);
    state(0.0f, 0.0f, 30.0f, 0.5f);
    goe_kind_test(&filter, &sighting.sight);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_FALSE(filter.kind.wrong);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(filter.kind.wrong);
    CHECK_SAME(0.0f, filter.kind.size_m[1]);
}

/* [goe_kind.c] GIVEN a range that images do not know WHEN a size is applied THEN range and sigma are those of a Kalman filter's update by it, in
 * float64; afterwards the state has its bits again. */
static void applied_sizes_are_an_update_and_leave_nothing(void) {
    goe_kind_saved_t saved;
    const goe_filter_t before = filter;
    state(5.0f, 0.5f, 0.0f, 0.0f);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(goe_kind_apply(&filter, &saved));
    /* u = 2 HALF - 5 q, measured as 0 with the sigma 1.2 * 0.5 * q; q is larger than 2 HALF/5 */
    const double prior_q = 1.0 / (300.0 * 300.0);
    const double half2 = 1.0e-8;
    const double u = 2.0 * 0.02 - 5.0 * 0.01;
    const double noise = pow(1.2 * 0.5 * 0.01, 2.0);
    const double gain = -5.0 * prior_q / (4.0 * half2 + 25.0 * prior_q + noise);
    CHECK_CLOSE(1.0e-7, 0.01 - gain * u, filter.state[GOE_INVERSE_RANGE]);
    CHECK_CLOSE(1.0e-9, prior_q * (1.0 + 5.0 * gain), goe_filter_variance(&filter, GOE_INVERSE_RANGE));
    goe_kind_restore(&filter, &saved);
    TEST_ASSERT_EQUAL_MEMORY(before.state, filter.state, sizeof before.state);
    TEST_ASSERT_EQUAL_MEMORY(before.root.element, filter.root.element, sizeof before.root.element);
}

/* [goe_kind.c] GIVEN images that know the range, or a doubtful size, or none THEN no size is applied. */
static void a_size_is_applied_only_where_it_is_needed(void) {
    goe_kind_saved_t saved;
    TEST_ASSERT_FALSE(goe_kind_apply(&filter, &saved)); /* no size */
    state(4.0f, 0.5f, 0.0f, 0.0f);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(goe_kind_apply(&filter, &saved));
    goe_kind_restore(&filter, &saved);
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 600.0f; /* a sixth */
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_FALSE(goe_kind_apply(&filter, &saved));
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 300.0f;
    state(14.0f, 0.5f, 0.0f, 0.0f); /* 2.1 sigma */
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_FALSE(goe_kind_apply(&filter, &saved));
}

/* [goe_kind.c] GIVEN a box by its corners THEN the width of its silhouette is tested, however it is turned. */
static void the_silhouette_of_a_box_is_tested(void) {
    filter.phase = GOE_PHASE_BOX;
    filter.state[GOE_SIDE_X] = -0.03f;
    filter.state[GOE_FRONT_X] = 0.02f;
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 1.0e4f;
    state(5.0f, 0.2f, 0.0f, 0.0f);
    for (int k = 0; k < 10; k++) {
        goe_kind_test(&filter, &sighting.sight);
        filter.state[GOE_SIDE_X] = -filter.state[GOE_SIDE_X]; /* turned the other way */
    }
    TEST_ASSERT_FALSE(filter.kind.wrong);
    state(2.0f, 0.2f, 0.0f, 0.0f);
    for (int k = 0; k < 5; k++) {
        goe_kind_test(&filter, &sighting.sight);
    }
    TEST_ASSERT_TRUE(filter.kind.wrong);
}

/* [goe_kind_t.width_m] GIVEN a number that is not finite, a size that is negative or too large, a sigma below a hundredth of its size or too large, or
 * an unknown shape THEN the image is refused. */
static void what_is_no_class_is_refused(void) {
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_intake_check_kind(&kind));
    state(4.0f, 0.04f, 1000.0f, 1000.0f);
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_intake_check_kind(&kind));
    kind.shape = 3;
    TEST_ASSERT_EQUAL_INT(GOE_OUT_OF_RANGE, goe_intake_check_kind(&kind));
    kind.shape = GOE_KIND_OTHER;
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_intake_check_kind(&kind));
    static const float REFUSED[][2] = {{-1.0f, 1.0f}, {1001.0f, 100.0f}, {4.0f, 0.03f},
                                       {4.0f, 0.0f},  {4.0f, 1001.0f},   {4.0f, -1.0f}};
    for (size_t i = 0; i < sizeof REFUSED / sizeof REFUSED[0]; i++) {
        state(REFUSED[i][0], REFUSED[i][1], 0.0f, 0.0f);
        TEST_ASSERT_EQUAL_INT(GOE_OUT_OF_RANGE, goe_intake_check_kind(&kind));
        state(0.0f, 0.0f, REFUSED[i][0], REFUSED[i][1]);
        TEST_ASSERT_EQUAL_INT(GOE_OUT_OF_RANGE, goe_intake_check_kind(&kind));
    }
    state(NAN, 1.0f, 0.0f, 0.0f);
    TEST_ASSERT_EQUAL_INT(GOE_NOT_FINITE, goe_intake_check_kind(&kind));
    state(0.0f, 0.0f, 4.0f, INFINITY);
    TEST_ASSERT_EQUAL_INT(GOE_NOT_FINITE, goe_intake_check_kind(&kind));
}

/* [goe_kind.c] GIVEN two sizes of which only the first contradicts the images THEN the class is wrong all the same. WHEN an image contradicted a
 * size, or the filter has not started THEN no size is applied. */
static void one_wrong_size_is_enough(void) {
    goe_kind_saved_t saved;
    const uint8_t phase = filter.phase;
    state(4.0f, 0.5f, 10.0f, 1.0f);
    goe_kind_test(&filter, &sighting.sight);
    filter.phase = GOE_PHASE_NONE;
    TEST_ASSERT_FALSE(goe_kind_apply(&filter, &saved));
    filter.phase = phase;
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 1.0e4f;
    state(12.0f, 0.5f, 10.0f, 1.0f);
    goe_kind_test(&filter, &sighting.sight);
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 300.0f;
    TEST_ASSERT_FALSE(goe_kind_apply(&filter, &saved));
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = 1.0e4f;
    goe_kind_test(&filter, &sighting.sight);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(filter.kind.wrong);
}

/* [goe_answer.c] GIVEN a class by whose size the obstacle lies behind the camera, and images by which it does not THEN the class is wrong,
 * nothing is answered, and the filter goes on with what the images know. */
static void a_class_behind_the_camera_is_wrong(void) {
    goe_motion_t motion;
    goe_estimate_t estimate;
    memset(&motion, 0, sizeof motion);
    memset(&estimate, 0, sizeof estimate);
    motion.heading_cos = 1.0f;
    motion.dz_m = 90.0f;
    filter.axes.turn_cos = 1.0f;
    state(0.0f, 0.0f, 7.0f, 0.7f);
    goe_kind_test(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(filter.kind.usable != 0u);
    TEST_ASSERT_FALSE(goe_answer_update(&filter, &sighting.settings, &motion, &estimate));
    TEST_ASSERT_TRUE(filter.kind.wrong);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, filter.phase);
    CHECK_SAME(0.01f, filter.state[GOE_INVERSE_RANGE]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_better_size_gives_the_range);
    RUN_TEST(three_images_show_a_wrong_size);
    RUN_TEST(applied_sizes_are_an_update_and_leave_nothing);
    RUN_TEST(a_size_is_applied_only_where_it_is_needed);
    RUN_TEST(the_silhouette_of_a_box_is_tested);
    RUN_TEST(what_is_no_class_is_refused);
    RUN_TEST(one_wrong_size_is_enough);
    RUN_TEST(a_class_behind_the_camera_is_wrong);
    return UNITY_END();
}
