/* Whatever comes in, nothing but finite numbers comes out. SPDX-License-Identifier: MIT
 *
 * Invariants, held after every call on random, extreme and broken input:
 *   - the status is one that goe.h allows for the call;
 *   - every number of the estimate and of the estimator is finite, told by its exponent bits;
 *   - a quantity without its valid bit is 0, one with it lies in its range, sigmas and age are not negative;
 *   - a refused image changes nothing in the estimator but one counter;
 *   - no byte before or behind the estimator and the estimate is touched.
 * Floats are judged by bits and by integer comparison of bits alone: the test must also hold for a library that was
 * compiled, and a program that was linked, with -ffast-math. GOE_TEST_SEED and GOE_TEST_UPDATES set seed and length. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define UPDATES_EACH 60000
#define GUARD_BYTES 64
#define GUARD 0xC3

static struct {
    unsigned char before[GUARD_BYTES];
    goe_estimator_t estimator;
    unsigned char between[GUARD_BYTES];
    goe_estimate_t estimate;
    unsigned char behind[GUARD_BYTES];
} memory;

static check_random_t any;
static uint32_t statuses[32]; /* how often each status came, by status + 16 */

void setUp(void) {
    memset(&memory, GUARD, sizeof memory);
    memset(statuses, 0, sizeof statuses);
}
void tearDown(void) {}

static int updates_each(void) {
    const char *wanted = getenv("GOE_TEST_UPDATES");
    return wanted ? (int)strtol(wanted, NULL, 0) : UPDATES_EACH;
}

static uint32_t below(uint32_t limit) { return check_random_bits(&any) % limit; }
static bool one_in(uint32_t n) { return below(n) == 0u; }
static float between(double low, double high) { return (float)check_random_between(&any, low, high); }

/* -------------------------------------------------------------------------------------------------------- invariants -- */

static void check_guard(const unsigned char *bytes) {
    for (int i = 0; i < GUARD_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(GUARD, bytes[i]);
    }
}

static void check_finite(const float *numbers, size_t count, const char *what) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        TEST_ASSERT_TRUE_MESSAGE((bits & 0x7F800000u) != 0x7F800000u, what);
    }
}

/* |x| <= limit, by the order of the bits. */
static bool within(const float *x, float limit) {
    uint32_t bits;
    uint32_t limit_bits;
    memcpy(&bits, x, sizeof bits);
    memcpy(&limit_bits, &limit, sizeof limit_bits);
    return (bits & 0x7FFFFFFFu) <= limit_bits;
}

static bool is_negative(const float *x) {
    uint32_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits > 0x80000000u;
}

static bool is_zero(const float *x) { return within(x, 0.0f); }

static void check_zero_unless(unsigned has, const float *x) {
    if (!(memory.estimate.valid & has)) {
        TEST_ASSERT_TRUE(is_zero(x));
    }
}

static void check_estimate(void) {
    const goe_estimate_t *e = &memory.estimate;
    const size_t floats = (sizeof(goe_estimate_t) - offsetof(goe_estimate_t, age_s)) / sizeof(float);
    check_finite(&e->age_s, floats, "estimate"); /* age_s and all behind it are floats */
    TEST_ASSERT_TRUE((int)e->model == GOE_MODEL_NONE || (int)e->model == GOE_MODEL_DISC ||
                     (int)e->model == GOE_MODEL_LINE);
    TEST_ASSERT_EQUAL_HEX32(0u, e->valid & ~0x1Fu);
    TEST_ASSERT_TRUE((e->valid & GOE_HAS_POSITION) ? (int)e->model != GOE_MODEL_NONE : (int)e->model == GOE_MODEL_NONE);
    TEST_ASSERT_TRUE(!e->fresh || (e->valid & GOE_HAS_POSITION));
    TEST_ASSERT_TRUE(e->points >= 0 && e->points <= GOE_WINDOW_MAX);
    TEST_ASSERT_TRUE(!is_negative(&e->age_s) && within(&e->age_s, 4000.5f));
    TEST_ASSERT_TRUE(!e->fresh || is_zero(&e->age_s));
    const float *positions[] = {&e->x0_m,     &e->z0_m,       &e->x_m,        &e->z_m,          &e->width_m,
                                &e->residual, &e->baseline_m, &e->sigma.x0_m, &e->sigma.width_m};
    for (size_t i = 0; i < sizeof positions / sizeof positions[0]; i++) {
        check_zero_unless(GOE_HAS_POSITION, positions[i]);
    }
    check_zero_unless(GOE_HAS_LENGTH, &e->length_m);
    check_zero_unless(GOE_HAS_LENGTH, &e->sigma.length_m);
    check_zero_unless(GOE_HAS_HEIGHT, &e->height_m);
    check_zero_unless(GOE_HAS_HEIGHT, &e->sigma.height_m);
    check_zero_unless(GOE_HAS_ORIENTATION, &e->orientation_deg);
    check_zero_unless(GOE_HAS_CENTER, &e->center_north_m);
    check_zero_unless(GOE_HAS_CENTER, &e->sigma.center_east_m);
    const float *never_negative[] = {&e->width_m, &e->length_m, &e->height_m, &e->residual, &e->baseline_m};
    for (size_t i = 0; i < sizeof never_negative / sizeof never_negative[0]; i++) {
        TEST_ASSERT_FALSE(is_negative(never_negative[i]));
    }
    const float *sigmas = &e->sigma.x0_m;
    for (size_t i = 0; i < sizeof e->sigma / sizeof(float); i++) {
        TEST_ASSERT_FALSE(is_negative(&sigmas[i]));
    }
    TEST_ASSERT_TRUE(within(&e->orientation_deg, 90.0f) && within(&e->other_side_deg, 90.0f));
    TEST_ASSERT_TRUE(within(&e->length_axis[0], 1.000001f) && within(&e->width_axis[1], 1.000001f));
}

static void check_state(void) {
    const goe_estimator_t *e = &memory.estimator;
    check_finite(e->camera_to_body, 9, "mounting");
    check_finite(&e->heading_cos, 2, "heading");
    check_finite(e->origin_ne_m, 2, "origin");
    check_finite(&e->dx_m, 2, "displacement");
    check_finite(&e->disc.point[0].dx_m, 4 * GOE_WINDOW_MAX, "disc window");
    check_finite(&e->line.point[0].dx_m, 4 * GOE_WINDOW_MAX, "line window");
    check_finite(e->length.value, GOE_WINDOW_MAX, "lengths");
    check_finite(e->height.value, GOE_WINDOW_MAX, "heights");
    check_finite(&e->orientation.filtered_deg, 3, "orientation");
    TEST_ASSERT_TRUE(e->disc.next >= 0 && e->disc.next < e->settings.window);
    TEST_ASSERT_TRUE(e->line.next >= 0 && e->line.next < e->settings.window);
    TEST_ASSERT_TRUE(e->length.next >= 0 && e->length.next < e->settings.window);
    TEST_ASSERT_TRUE(e->height.next >= 0 && e->height.next < e->settings.window);
}

static void update_and_check(const goe_image_t *image) {
    static goe_estimator_t before;
    memcpy(&before, &memory.estimator, sizeof before);
    memset(&memory.estimate, 0xFF, sizeof memory.estimate); /* NaN, if it were left so */
    const int status = (int)goe_update(&memory.estimator, image, &memory.estimate);
    TEST_ASSERT_TRUE(status >= GOE_BAD_ATTITUDE && status <= GOE_NOTHING_SEEN);
    statuses[status + 16]++;
    if (status <= GOE_NOT_FINITE) {
        before.causes[-status]++;
        TEST_ASSERT_EQUAL_MEMORY(&before, &memory.estimator, sizeof before);
    }
    TEST_ASSERT_EQUAL_INT(status == GOE_OK || status == GOE_PARTIAL, memory.estimate.fresh);
    check_estimate();
    check_state();
    check_guard(memory.before);
    check_guard(memory.between);
    check_guard(memory.behind);
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

static float any_bits(void) { return check_from_bits(check_random_bits(&any)); }

/* A finite number of any size within the limit, its ends and zeros more often than by chance. */
static float any_within(float limit) {
    const float sign = one_in(2) ? -1.0f : 1.0f;
    switch (below(8)) {
        case 0:
            return sign * limit;
        case 1:
            return sign * 0.0f;
        case 2:
            return sign * check_from_bits(1u + below(0x00800000u)); /* subnormal */
        case 3:
        case 4:
            return sign * check_from_bits(0x2F800000u + below(check_bits(limit) - 0x2F800000u)); /* any exponent */
        default:
            return between(-(double)limit, (double)limit);
    }
}

static void start(const goe_settings_t *settings) {
    CHECK_STATUS(GOE_OK, goe_init(&memory.estimator, sizeof memory.estimator, settings, NULL));
}

static goe_settings_t any_settings(void) {
    goe_settings_t s;
    goe_settings_default(&s);
    s.camera.fx_px = one_in(3) ? 1.0f : one_in(3) ? 1.0e5f : between(1.0, 2000.0);
    s.camera.fy_px = one_in(3) ? 1.0f : one_in(3) ? 1.0e5f : between(1.0, 2000.0);
    s.camera.cx_px = any_within(1.0e5f);
    s.camera.cy_px = any_within(1.0e5f);
    if (one_in(2)) {
        s.camera.cx_px = 0.0f;
        s.camera.cy_px = 0.0f;
    }
    if (one_in(3)) {
        s.camera.k1 = any_within(100.0f);
        s.camera.k2 = any_within(100.0f);
        s.camera.p1 = any_within(100.0f);
        s.camera.p2 = any_within(100.0f);
        s.camera.k3 = any_within(100.0f);
    }
    s.camera.mount_yaw_deg = any_within(360.0f);
    s.camera.mount_pitch_deg = any_within(360.0f);
    s.camera.mount_roll_deg = any_within(360.0f);
    for (int i = 0; i < 3; i++) {
        s.camera.offset_m[i] = one_in(2) ? 0.0f : any_within(1.0e4f);
    }
    s.model = (goe_model_t)(GOE_MODEL_AUTO + (int)below(3));
    s.heading_auto = one_in(2);
    s.heading_deg = any_within(360.0f);
    s.window = 3 + (int)below(GOE_WINDOW_MAX - 2);
    s.line_points = 1 + (int)below(one_in(2) ? 5 : 1000);
    s.edge_min_px = one_in(2) ? 0.0f : between(0.0, 20.0);
    s.orientation_min_px = one_in(2) ? 0.0f : between(0.0, 5.0);
    s.side_min_px = one_in(2) ? 0.1f : between(0.1, 20.0);
    s.orientation_memory = 1 + (int)below(one_in(2) ? 3 : 1000);
    s.min_baseline_m = one_in(2) ? 1.0e-3f : between(1.0e-3, 10.0);
    return s;
}

static goe_pixel_t any_pixel(float (*number)(void)) {
    goe_pixel_t pixel;
    pixel.u_px = number();
    pixel.v_px = number();
    pixel.seen = !one_in(8);
    return pixel;
}

static void fill_features(goe_image_t *image, float (*number)(void)) {
    image->left = any_pixel(number);
    image->right = any_pixel(number);
    image->top = any_pixel(number);
    image->base_left = any_pixel(number);
    image->base_near = any_pixel(number);
    image->base_right = any_pixel(number);
}

static void any_attitude(float q[4]) {
    float norm2 = 0.0f;
    do {
        norm2 = 0.0f;
        for (int i = 0; i < 4; i++) {
            q[i] = one_in(4) ? 0.0f : between(-1.0, 1.0);
            norm2 += q[i] * q[i];
        }
    } while (norm2 < 0.01f);
    float root = 1.0f;
    for (int i = 0; i < 30; i++) {
        root = 0.5f * (root + norm2 / root);
    }
    for (int i = 0; i < 4; i++) {
        q[i] /= root;
    }
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static void note_statuses(const char *what) {
    UnityPrint(what);
    UnityPrint(":");
    for (int i = 0; i < 32; i++) {
        if (statuses[i] > 0) {
            UnityPrint(" ");
            UnityPrint(goe_status_text((goe_status_t)(i - 16)));
            UnityPrint(" ");
            UnityPrintNumberUnsigned(statuses[i]);
        }
    }
    UNITY_PRINT_EOL();
}

/* GIVEN images of which every number is a random bit pattern, NaNs and infinities among them */
static void random_bits_do_no_harm(void) {
    any = check_random_start("random bits");
    goe_settings_t settings = any_settings();
    start(&settings);
    const int updates = updates_each();
    for (int n = 0; n < updates; n++) {
        goe_image_t image;
        memset(&image, 0, sizeof image);
        fill_features(&image, any_bits);
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] = any_bits();
            image.pose.reset_delta_ned_m[i] = any_bits();
        }
        for (int i = 0; i < 4; i++) {
            image.pose.attitude[i] = any_bits();
        }
        image.pose.height_m = any_bits();
        image.pose.time_us = (int64_t)(((uint64_t)check_random_bits(&any) << 32) | check_random_bits(&any));
        image.pose.reset_count = (uint8_t)below(256);
        image.pose.reset_delta_known = one_in(2);
        update_and_check(&image);
    }
    note_statuses("random bits");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)updates / 30u, statuses[16 + GOE_NOT_FINITE]);
}

static float pixel_near(void) { return between(-3.0, 3.0); }
static float pixel_anywhere(void) { return any_within(1.0e5f); }
static float pixel_usual(void) { return between(-700.0, 700.0); }

/* GIVEN finite images within the ranges, their extremes preferred, under settings of which the same holds */
static void extremes_do_no_harm(void) {
    static float (*const numbers[])(void) = {pixel_near, pixel_anywhere, pixel_usual};
    any = check_random_start("extremes");
    const int updates = updates_each();
    int64_t now = 0;
    float (*number)(void) = pixel_near;
    float reach = 1.0f;
    bool still = true;
    for (int n = 0; n < updates; n++) {
        goe_image_t image;
        if (n % 50 == 0) {
            goe_settings_t settings = any_settings();
            start(&settings);
            now = one_in(4) ? INT64_MIN + 1 : 0;
            number = numbers[below(3)];
            reach = one_in(3) ? 1.0e6f : between(1.0e-4, 1000.0);
            still = one_in(2);
        }
        memset(&image, 0, sizeof image);
        fill_features(&image, number);
        if (!one_in(4)) { /* in image order, or hardly anything is ever solved */
            float *const order[] = {&image.base_left.u_px, &image.base_near.u_px, &image.base_right.u_px};
            for (int i = 0; i < 3; i++) {
                const int j = i < 2 ? i : 0;
                if (*order[j] > *order[j + 1]) {
                    const float swap = *order[j];
                    *order[j] = *order[j + 1];
                    *order[j + 1] = swap;
                }
            }
            if (image.left.u_px > image.right.u_px) {
                const float swap = image.left.u_px;
                image.left.u_px = image.right.u_px;
                image.right.u_px = swap;
            }
        }
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] = any_within(reach);
            image.pose.reset_delta_ned_m[i] = any_within(1.0e6f);
        }
        image.pose.attitude[0] = 1.0f;
        if (!still) {
            any_attitude(image.pose.attitude);
        }
        image.pose.height_m = any_within(1.0e5f);
        now += one_in(100) && now > INT64_MIN ? -1 : one_in(100) ? INT64_C(1) << 60 : 1 + (int64_t)below(100000);
        now = now > (INT64_C(1) << 62) ? INT64_C(1) << 62 : now;
        image.pose.time_us = now;
        image.pose.reset_count = (uint8_t)(one_in(40) ? below(256) : memory.estimator.reset_count);
        image.pose.reset_delta_known = one_in(2);
        update_and_check(&image);
    }
    note_statuses("extremes");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)updates / 1000u, statuses[16 + GOE_OK] + statuses[16 + GOE_PARTIAL]);
}

static void spoil(float *x) {
    if (one_in(60)) {
        *x = one_in(2) ? any_bits() : any_within(1.0e5f);
    } else {
        *x += between(-1.5, 1.5);
    }
}

/* GIVEN flights that make sense, with pixel noise, broken numbers and missing features now and then */
static void spoiled_flights_do_no_harm(void) {
    any = check_random_start("spoiled flights");
    const int flights = updates_each() / 50;
    for (int f = 0; f < flights; f++) {
        scene_t scene;
        scene_default(&scene);
        scene.shape = one_in(3) ? SCENE_CYLINDER : SCENE_BOX;
        scene.path = (scene_path_t)below(3);
        scene.x0_m = (double)between(-60.0, 60.0);
        scene.z0_m = (double)between(40.0, 200.0);
        scene.alpha_deg = (double)between(-90.0, 90.0);
        scene.width_m = (double)between(1.0, 20.0);
        scene.length_m = (double)between(1.0, 40.0);
        scene.height_m = (double)between(1.0, 60.0);
        scene.speed_mps = (double)between(0.0, 40.0);
        scene.wobble_deg = (double)between(0.0, 20.0);
        goe_settings_t settings = scene_settings(&scene);
        settings.model = (goe_model_t)(GOE_MODEL_AUTO + (int)below(3));
        settings.window = 3 + (int)below(GOE_WINDOW_MAX - 2);
        start(&settings);
        for (int k = 0; k < 50; k++) {
            goe_image_t image;
            scene_image(&scene, k, &image, NULL);
            goe_pixel_t *pixels[] = {&image.left,      &image.right,     &image.top,
                                     &image.base_left, &image.base_near, &image.base_right};
            for (int i = 0; i < 6; i++) {
                spoil(&pixels[i]->u_px);
                spoil(&pixels[i]->v_px);
                pixels[i]->seen = pixels[i]->seen && !one_in(25);
            }
            if (one_in(40)) {
                image.pose.attitude[below(4)] = any_bits();
            }
            if (one_in(40)) {
                image.pose.position_ned_m[below(3)] = any_within(1.0e6f);
            }
            if (one_in(60)) {
                image.pose.time_us -= 200000;
            }
            update_and_check(&image);
        }
    }
    note_statuses("spoiled flights");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)flights * 5u, statuses[16 + GOE_OK]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(random_bits_do_no_harm);
    RUN_TEST(extremes_do_no_harm);
    RUN_TEST(spoiled_flights_do_no_harm);
    return UNITY_END();
}
