/* Defaults and ranges of the settings. SPDX-License-Identifier: MIT */
/* tests: lib/goe_settings.c */
#include <stddef.h>
#include <string.h>

#include "check.h"

#define SENTINEL 0xA5

static goe_settings_t settings;
static goe_estimator_t estimator;

void setUp(void) {
    goe_settings_default(&settings);
    settings.camera.fx_px = 2.0e4f; /* which no size contradicts */
    settings.camera.fy_px = 2.0e4f;
    settings.camera.cx_px = settings.camera.cy_px = 0.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
}
void tearDown(void) {}

typedef struct {
    const char *name;
    size_t at;
    float smallest, largest, standard;
} number_t;

typedef struct {
    const char *name;
    size_t at;
    int smallest, largest, standard;
} count_t;

#define NUMBER(field, smallest, largest, standard)                                                                     \
    {#field, offsetof(goe_settings_t, field), smallest, largest, standard}
#define COUNT(field, smallest, largest, standard) {#field, offsetof(goe_settings_t, field), smallest, largest, standard}

/* As goe.h states them. */
static const number_t numbers[] = {
    NUMBER(camera.fx_px, 1.0f, 1.0e5f, 0.0f),
    NUMBER(camera.fy_px, 1.0f, 1.0e5f, 0.0f),
    NUMBER(camera.cx_px, -1.0e5f, 1.0e5f, -1.0e6f),
    NUMBER(camera.cy_px, -1.0e5f, 1.0e5f, -1.0e6f),
    NUMBER(camera.k1, -100.0f, 100.0f, 0.0f),
    NUMBER(camera.k2, -100.0f, 100.0f, 0.0f),
    NUMBER(camera.p1, -100.0f, 100.0f, 0.0f),
    NUMBER(camera.p2, -100.0f, 100.0f, 0.0f),
    NUMBER(camera.k3, -100.0f, 100.0f, 0.0f),
    NUMBER(camera.mount_yaw_deg, -360.0f, 360.0f, 0.0f),
    NUMBER(camera.mount_pitch_deg, -360.0f, 360.0f, 0.0f),
    NUMBER(camera.mount_roll_deg, -360.0f, 360.0f, 0.0f),
    NUMBER(camera.offset_m[0], -1.0e4f, 1.0e4f, 0.0f),
    NUMBER(camera.offset_m[1], -1.0e4f, 1.0e4f, 0.0f),
    NUMBER(camera.offset_m[2], -1.0e4f, 1.0e4f, 0.0f),
    NUMBER(camera.width_px, 0.0f, 1.0e5f, -1.0f),
    NUMBER(camera.height_px, 0.0f, 1.0e5f, -1.0f),
    NUMBER(camera.border_rel, 0.0f, 0.5f, 0.012f),
    NUMBER(camera.truncation_rel, 0.0f, 0.5f, 0.04f),
    NUMBER(heading_deg, -360.0f, 360.0f, 0.0f),
    NUMBER(window.edge_min_px, 0.0f, 1.0e4f, 10.0f),
    NUMBER(window.orientation_min_px, 0.0f, 1.0e4f, 2.0f),
    NUMBER(window.side_min_px, 0.1f, 1.0e4f, 10.0f),
    NUMBER(window.min_baseline_m, 1.0e-3f, 1.0e4f, 0.1f),
    NUMBER(detector.point_noise_px, 0.05f, 100.0f, 0.5f),
    NUMBER(detector.point_noise_rel, 0.0f, 1.0f, 0.0f),
    NUMBER(detector.point_correlation, 0.0f, 0.95f, 0.0f),
    NUMBER(detector.shape_error_rel, 0.0f, 1.0f, 0.0f),
    NUMBER(detector.box_noise_px, 0.05f, 100.0f, 1.0f),
    NUMBER(detector.box_noise_rel, 0.0f, 1.0f, 0.07f),
    NUMBER(detector.box_correlation_time_s, 0.0f, 10.0f, 1.2f),
    NUMBER(detector.truncation_noise_rel, 0.0f, 10.0f, 1.0f),
    NUMBER(navigation.attitude_bias_sd_deg, 1.0e-3f, 30.0f, 0.5f),
    NUMBER(navigation.attitude_white_sd_deg, 1.0e-4f, 30.0f, 0.1f),
    NUMBER(navigation.attitude_walk_sd_deg, 0.0f, 30.0f, 0.0f),
    NUMBER(navigation.height_bias_sd_m, 1.0e-3f, 1.0e3f, 0.5f),
    NUMBER(navigation.velocity_bias_sd_m_s, 0.0f, 100.0f, 0.05f),
    NUMBER(navigation.position_walk_sd_m, 0.0f, 100.0f, 0.05f),
    NUMBER(navigation.position_white_sd_m, 0.0f, 100.0f, 0.0f),
    NUMBER(navigation.height_white_sd_m, 0.0f, 1.0e3f, 0.5f),
    NUMBER(navigation.terrain_slope_sd, 0.0f, 1.0f, 0.01f),
    NUMBER(navigation.terrain_height_sd_m, 0.0f, 1.0e3f, 2.0f),
    NUMBER(filter.prior_width_m, 0.1f, 1.0e3f, 6.0f),
    NUMBER(filter.gate_sigma, 1.0f, 100.0f, 5.0f),
    NUMBER(filter.huber_sigma, 0.5f, 100.0f, 2.5f),
    NUMBER(filter.nis_ratio_max, 1.0e-2f, 1.0e3f, 1.9f),
    NUMBER(filter.range_sd_rel_max, 1.0e-2f, 10.0f, 0.25f),
};

static const count_t counts[] = {
    COUNT(method, GOE_METHOD_WINDOW, GOE_METHOD_FILTER, GOE_METHOD_FILTER),
    COUNT(model, GOE_MODEL_AUTO, GOE_MODEL_LINE, GOE_MODEL_AUTO),
    COUNT(window.points, 3, GOE_WINDOW_MAX, 8),
    COUNT(window.line_points, 1, 1000, 8),
    COUNT(window.orientation_memory, 1, 1000, 20),
};

#define NUMBERS (sizeof numbers / sizeof numbers[0])
#define COUNTS (sizeof counts / sizeof counts[0])

static void set_number(const number_t *field, float value) {
    memcpy((unsigned char *)&settings + field->at, &value, sizeof value);
}

/* An enumeration is smaller than an int on some machines. */
static void set_count(const count_t *field, int value) {
    if (field->at == offsetof(goe_settings_t, method)) {
        settings.method = (goe_method_t)value;
    } else if (field->at == offsetof(goe_settings_t, model)) {
        settings.model = (goe_model_t)value;
    } else {
        memcpy((unsigned char *)&settings + field->at, &value, sizeof value);
    }
}

static int get_count(const count_t *field) {
    int value;
    if (field->at == offsetof(goe_settings_t, method)) {
        return (int)settings.method;
    }
    if (field->at == offsetof(goe_settings_t, model)) {
        return (int)settings.model;
    }
    memcpy(&value, (unsigned char *)&settings + field->at, sizeof value);
    return value;
}

static goe_status_t init(const char **bad) { return goe_init(&estimator, sizeof estimator, &settings, bad); }

static void check_good(void) {
    const char *bad = "untouched";
    CHECK_STATUS(GOE_OK, init(&bad));
    TEST_ASSERT_NULL(bad);
    CHECK_STATUS(GOE_OK, init(NULL));
}

/* GIVEN an estimator of which every byte is known WHEN goe_init refuses THEN it names the field and touches no byte. */
static void check_bad(const char *name) {
    static goe_estimator_t before;
    const char *bad = NULL;
    memset(&estimator, SENTINEL, sizeof estimator);
    memset(&before, SENTINEL, sizeof before);
    CHECK_STATUS(GOE_BAD_SETTINGS, init(&bad));
    TEST_ASSERT_EQUAL_STRING(name, bad);
    CHECK_STATUS(GOE_BAD_SETTINGS, init(NULL));
    TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
}

/* [A26] GIVEN settings full of a sentinel WHEN defaults are requested THEN no field is left out. */
static void the_defaults_set_every_field(void) {
    goe_settings_t again;
    unsigned char heading_auto;
    unsigned char top_is_highest;
    memset(&settings, SENTINEL, sizeof settings);
    memset(&again, (unsigned char)~SENTINEL, sizeof again);
    goe_settings_default(&settings);
    goe_settings_default(&again);
    for (size_t i = 0; i < NUMBERS; i++) {
        float value;
        memcpy(&value, (unsigned char *)&settings + numbers[i].at, sizeof value);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(numbers[i].standard, value, numbers[i].name);
    }
    for (size_t i = 0; i < COUNTS; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(counts[i].standard, get_count(&counts[i]), counts[i].name);
    }
    memcpy(&heading_auto, &settings.heading_auto, 1);
    memcpy(&top_is_highest, &settings.filter.top_is_highest, 1);
    TEST_ASSERT_EQUAL_UINT8(1, heading_auto);
    TEST_ASSERT_EQUAL_UINT8(0, top_is_highest);
    /* a field that this test does not know of would differ between the two fills */
    TEST_ASSERT_EQUAL_MEMORY(&again, &settings, sizeof settings);
}

/* [A26] The tables above cover the whole structure: 4 bytes a field, but for the enumerations and the flags next to them. */
static void the_tables_of_this_test_are_complete(void) {
    const size_t head = offsetof(goe_settings_t, heading_deg) - offsetof(goe_settings_t, method);
    const size_t tail = sizeof settings - offsetof(goe_settings_t, filter.top_is_highest);
    TEST_ASSERT_EQUAL_size_t(sizeof settings, 4u * (NUMBERS + COUNTS - 2u) + head + tail);
}

/* [GOE_BAD_SETTINGS] */
static void the_defaults_lack_only_the_camera(void) {
    goe_settings_default(&settings);
    check_bad("camera.fx_px");
    settings.camera.fx_px = 500.0f;
    check_bad("camera.fy_px");
    settings.camera.fy_px = 500.0f;
    check_bad("camera.cx_px");
    settings.camera.cx_px = 0.0f;
    check_bad("camera.cy_px");
    settings.camera.cy_px = 0.0f;
    check_bad("camera.width_px");
    settings.camera.width_px = 640.0f;
    check_bad("camera.height_px");
    settings.camera.height_px = 480.0f;
    check_good();
}

/* GIVEN a size THEN a focal length in millimeters and the principal point of another sensor are refused, but not a part of the sensor's
 * image; without a size they pass. */
static void a_camera_fits_its_size(void) {
    static const struct {
        const char *field;
        size_t at;
        float good[2], bad[2];
    } cases[] = {{"camera.fx_px", offsetof(goe_settings_t, camera.fx_px), {64.0f, 9.0e4f}, {63.9f, 4.2f}},
                 {"camera.fy_px", offsetof(goe_settings_t, camera.fy_px), {36.0f, 9.0e4f}, {35.9f, 4.2f}},
                 {"camera.cx_px", offsetof(goe_settings_t, camera.cx_px), {-1350.0f, 2630.0f}, {-1351.0f, 2631.0f}},
                 {"camera.cy_px", offsetof(goe_settings_t, camera.cy_px), {-1350.0f, 2070.0f}, {-1351.0f, 2071.0f}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int k = 0; k < 2; k++) {
            setUp();
            settings.camera.width_px = 1280.0f;
            settings.camera.height_px = 720.0f;
            settings.camera.fx_px = settings.camera.fy_px = 900.0f;
            memcpy((char *)&settings + cases[i].at, &cases[i].good[k], sizeof(float));
            check_good();
            memcpy((char *)&settings + cases[i].at, &cases[i].bad[k], sizeof(float));
            check_bad(cases[i].field);
            settings.camera.width_px = settings.camera.height_px = 0.0f;
            check_good();
        }
    }
}

static void no_settings_are_no_crash(void) { goe_settings_default(NULL); }

/* [A21, A26, GOE_BAD_SETTINGS, goe_init] */
static void every_number_may_reach_its_limits_and_no_farther(void) {
    for (size_t i = 0; i < NUMBERS; i++) {
        const number_t *field = &numbers[i];
        const float below = field->smallest > 0.0f   ? check_from_bits(check_bits(field->smallest) - 1u)
                            : field->smallest < 0.0f ? check_next_away(field->smallest)
                                                     : -1.0e-45f;
        setUp();
        set_number(field, field->smallest);
        check_good();
        set_number(field, field->largest);
        check_good();
        set_number(field, check_next_away(field->largest));
        check_bad(field->name);
        set_number(field, below);
        check_bad(field->name);
    }
}

/* [GOE_BAD_SETTINGS] */
static void every_number_must_be_finite(void) {
    static const uint32_t patterns[] = {0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFC00001u, 0x7F800001u, 0xFFFFFFFFu};
    for (size_t i = 0; i < NUMBERS; i++) {
        for (size_t p = 0; p < sizeof patterns / sizeof patterns[0]; p++) {
            setUp();
            set_number(&numbers[i], check_from_bits(patterns[p]));
            check_bad(numbers[i].name);
        }
    }
}

/* [GOE_BAD_SETTINGS, GOE_MODEL_NONE, goe_init] */
static void every_count_may_reach_its_limits_and_no_farther(void) {
    for (size_t i = 0; i < COUNTS; i++) {
        const count_t *field = &counts[i];
        setUp();
        set_count(field, field->smallest);
        check_good();
        set_count(field, field->largest);
        check_good();
        set_count(field, field->largest + 1);
        check_bad(field->name);
        set_count(field, field->smallest - 1);
        check_bad(field->name);
        set_count(field, INT32_MIN);
        check_bad(field->name);
        set_count(field, INT32_MAX);
        check_bad(field->name);
    }
}

static void init_checks_its_arguments(void) {
    const char *bad = "untouched";
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_init(NULL, sizeof estimator, &settings, &bad));
    TEST_ASSERT_NULL(bad);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_init(&estimator, sizeof estimator, NULL, &bad));
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_init(&estimator, sizeof estimator - 1, &settings, &bad));
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_init(&estimator, sizeof estimator + 4, &settings, NULL));
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_init(NULL, 0, NULL, NULL));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_defaults_set_every_field);
    RUN_TEST(the_tables_of_this_test_are_complete);
    RUN_TEST(the_defaults_lack_only_the_camera);
    RUN_TEST(a_camera_fits_its_size);
    RUN_TEST(no_settings_are_no_crash);
    RUN_TEST(every_number_may_reach_its_limits_and_no_farther);
    RUN_TEST(every_number_must_be_finite);
    RUN_TEST(every_count_may_reach_its_limits_and_no_farther);
    RUN_TEST(init_checks_its_arguments);
    return UNITY_END();
}
