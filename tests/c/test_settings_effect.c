/* Every setting does something, and what it says: flights with one setting changed against the same flights without.
 * SPDX-License-Identifier: MIT */
#include <stddef.h>
#include <string.h>

#include "check.h"
#include "goe_settings_list.h"
#include "scene.h"

#define IMAGES 44
#define NOISE_PX 0.5
#define OUTLIER_EACH 5
#define OUTLIER_PX 10.0f
#define COURSE_DEG 20.0

/* Without noise, so that no scatter widens the sigmas: TRUCK by all its points; CHIMNEY by its outline; BOXES: the truck's upright
 * boxes; CUT: a tower's, some of which the image's border cuts. With noise: OUTLIERS: the truck, with outliers; PAPER: the truck, by
 * the window. */
typedef enum { TRUCK, CHIMNEY, BOXES, CUT, OUTLIERS, PAPER } flight_t;
typedef enum { DIFFERS, GROWS } way_t;

typedef struct {
    const char *name;
    flight_t flight;
    float value;
    way_t way;
    size_t shown; /* of goe_estimate_t: what grows */
} effect_t;

#define SHOWN(field) offsetof(goe_estimate_t, field)
#define NOTHING_SHOWN 0

static const effect_t effects[] = {
    {"camera.fx_px", TRUCK, 1000.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.fy_px", TRUCK, 1000.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.cx_px", TRUCK, 645.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.cy_px", TRUCK, 645.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.k1", TRUCK, 0.05f, DIFFERS, NOTHING_SHOWN},
    {"camera.k2", TRUCK, 0.05f, DIFFERS, NOTHING_SHOWN},
    {"camera.p1", TRUCK, 0.01f, DIFFERS, NOTHING_SHOWN},
    {"camera.p2", TRUCK, 0.01f, DIFFERS, NOTHING_SHOWN},
    {"camera.k3", TRUCK, 0.05f, DIFFERS, NOTHING_SHOWN},
    {"camera.mount_yaw_deg", TRUCK, 1.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.mount_pitch_deg", TRUCK, 1.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.mount_roll_deg", TRUCK, 1.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.offset_m[0]", TRUCK, 2.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.offset_m[1]", TRUCK, 2.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.offset_m[2]", BOXES, 2.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.width_px", CUT, 0.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.height_px", CUT, 0.0f, DIFFERS, NOTHING_SHOWN},
    {"camera.border_rel", CUT, 0.3f, DIFFERS, NOTHING_SHOWN},
    {"camera.truncation_rel", CUT, 0.1f, GROWS, SHOWN(sigma.z0_m)},
    {"method", TRUCK, GOE_METHOD_WINDOW, DIFFERS, NOTHING_SHOWN},
    {"model", TRUCK, GOE_MODEL_DISC, DIFFERS, NOTHING_SHOWN},
    {"heading_auto", TRUCK, 0.0f, DIFFERS, NOTHING_SHOWN},
    {"heading_deg", TRUCK, 10.0f, DIFFERS, NOTHING_SHOWN},
    {"navigation.attitude_bias_sd_deg", TRUCK, 5.0f, GROWS, SHOWN(sigma.orientation_deg)},
    {"navigation.attitude_white_sd_deg", TRUCK, 1.0f, GROWS, SHOWN(sigma.z0_m)},
    {"navigation.attitude_walk_sd_deg", TRUCK, 1.0f, GROWS, SHOWN(sigma.z0_m)},
    {"navigation.height_bias_sd_m", CHIMNEY, 5.0f, GROWS, SHOWN(sigma.height_m)},
    {"navigation.velocity_bias_sd_m_s", CHIMNEY, 1.0f, GROWS, SHOWN(sigma.z0_m)},
    {"navigation.position_walk_sd_m", CHIMNEY, 0.5f, GROWS, SHOWN(sigma.z0_m)},
    {"navigation.position_white_sd_m", CHIMNEY, 1.0f, GROWS, SHOWN(sigma.z0_m)},
    {"navigation.height_white_sd_m", CHIMNEY, 5.0f, GROWS, SHOWN(sigma.height_m)},
    {"navigation.terrain_slope_sd", CHIMNEY, 0.2f, GROWS, SHOWN(sigma.height_m)},
    {"navigation.terrain_height_sd_m", BOXES, 20.0f, GROWS, SHOWN(sigma.height_m)},
    {"detector.point_noise_px", TRUCK, 2.0f, GROWS, SHOWN(sigma.z0_m)},
    {"detector.point_noise_rel", CHIMNEY, 0.1f, GROWS, SHOWN(sigma.width_m)},
    {"detector.point_correlation", CHIMNEY, 0.8f, GROWS, SHOWN(sigma.width_m)},
    {"detector.shape_error_rel", CHIMNEY, 0.1f, GROWS, SHOWN(sigma.width_m)},
    {"detector.box_noise_px", BOXES, 5.0f, GROWS, SHOWN(sigma.height_m)},
    {"detector.box_noise_rel", BOXES, 0.2f, GROWS, SHOWN(sigma.z0_m)},
    {"detector.box_correlation_time_s", BOXES, 0.2f, DIFFERS, NOTHING_SHOWN},
    {"detector.truncation_noise_rel", CUT, 5.0f, GROWS, SHOWN(sigma.z0_m)},
    {"filter.prior_width_m", CHIMNEY, 20.0f, DIFFERS, NOTHING_SHOWN},
    {"filter.gate_sigma", OUTLIERS, 100.0f, DIFFERS, NOTHING_SHOWN},
    {"filter.huber_sigma", OUTLIERS, 1.0f, DIFFERS, NOTHING_SHOWN},
    {"filter.nis_ratio_max", OUTLIERS, 0.01f, DIFFERS, NOTHING_SHOWN},
    {"filter.range_sd_rel_max", TRUCK, 0.01f, DIFFERS, NOTHING_SHOWN},
    {"filter.top_is_highest", TRUCK, 1.0f, DIFFERS, NOTHING_SHOWN},
    {"window.points", PAPER, 5.0f, DIFFERS, NOTHING_SHOWN},
    {"window.line_points", PAPER, 20.0f, DIFFERS, NOTHING_SHOWN},
    {"window.edge_min_px", PAPER, 60.0f, DIFFERS, NOTHING_SHOWN},
    {"window.orientation_min_px", PAPER, 20.0f, DIFFERS, NOTHING_SHOWN},
    {"window.side_min_px", PAPER, 200.0f, DIFFERS, NOTHING_SHOWN},
    {"window.orientation_memory", PAPER, 2.0f, DIFFERS, NOTHING_SHOWN},
    {"window.min_baseline_m", PAPER, 50.0f, DIFFERS, NOTHING_SHOWN},
};
#define EFFECTS (sizeof effects / sizeof effects[0])

/* ------------------------------------------------------------------------------------------------------ the settings -- */

typedef enum { REAL, COUNT, TRUTH, CHOICE } kind_t;

typedef struct {
    const char *name;
    size_t at;
    kind_t kind;
} place_t;

#define PLACE(field, kind, unit, low, high, value, text) {#field, offsetof(goe_settings_t, field), kind},
static const place_t places[] = {GOE_SETTINGS(PLACE)};
#define PLACES (sizeof places / sizeof places[0])

static const place_t *place_of(const char *name) {
    for (size_t i = 0; i < PLACES; i++) {
        if (strcmp(places[i].name, name) == 0) {
            return &places[i];
        }
    }
    return NULL;
}

static void set(goe_settings_t *settings, const effect_t *effect) {
    const place_t *place = place_of(effect->name);
    TEST_ASSERT_NOT_NULL_MESSAGE(place, effect->name);
    unsigned char *field = (unsigned char *)settings + place->at;
    const int count = (int)effect->value;
    const bool truth = count != 0;
    if (place->kind == REAL) {
        memcpy(field, &effect->value, sizeof effect->value);
    } else if (place->kind == COUNT) {
        memcpy(field, &count, sizeof count);
    } else if (place->kind == TRUTH) {
        memcpy(field, &truth, sizeof truth);
    } else if (place->at == offsetof(goe_settings_t, method)) {
        settings->method = (goe_method_t)count;
    } else {
        settings->model = (goe_model_t)count;
    }
}

/* ------------------------------------------------------------------------------------------------------- the flights -- */

static scene_t scene;

void setUp(void) {}
void tearDown(void) {}

static goe_settings_t start(flight_t flight) {
    scene_default(&scene);
    scene.course_deg = COURSE_DEG;
    scene.wobble_deg = 2.0;
    scene.boxes = flight == BOXES || flight == CUT;
    if (flight == CHIMNEY || flight == CUT) {
        scene_make_cylinder(&scene);
    }
    goe_settings_t settings = flight == PAPER ? scene_window_settings(&scene) : scene_settings(&scene);
    if (flight == CUT) {
        scene.x0_m = -45.0;
        scene.z0_m = 110.0;
        scene.width_m = 20.0;
        scene.height_m = 90.0;
        settings.camera.width_px = 1280.0f;
        settings.camera.height_px = 1280.0f;
        settings.camera.border_rel = 0.012f;
        settings.camera.truncation_rel = 0.04f;
    }
    return settings;
}

typedef struct {
    goe_estimate_t each[IMAGES];
} answers_t;

static void fly(flight_t flight, const goe_settings_t *settings, answers_t *answers) {
    static goe_estimator_t estimator;
    check_random_t any = {1u};
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        if (flight >= OUTLIERS) {
            scene_add_noise(&image, &any, NOISE_PX);
        }
        if (flight == OUTLIERS && k % OUTLIER_EACH == OUTLIER_EACH - 1) {
            image.base_near.v_px += OUTLIER_PX;
        }
        (void)goe_update(&estimator, &image, &answers->each[k]);
    }
}

static answers_t plain, changed;

/* [A2, (R12), (R21)]
 * GIVEN a flight WHEN one setting alone is changed THEN the answers change; one that configures an error makes the sigma larger
 * that includes that error. */
static void every_setting_does_what_it_says(void) {
    for (size_t i = 0; i < EFFECTS; i++) {
        const effect_t *effect = &effects[i];
        goe_settings_t settings = start(effect->flight);
        settings.heading_auto = strcmp(effect->name, "heading_deg") != 0;
        fly(effect->flight, &settings, &plain);
        set(&settings, effect);
        fly(effect->flight, &settings, &changed);
        TEST_ASSERT_TRUE_MESSAGE(memcmp(&plain, &changed, sizeof plain) != 0, effect->name);
        if (effect->way == GROWS) {
            float before;
            float after;
            memcpy(&before, (unsigned char *)&plain.each[IMAGES - 1] + effect->shown, sizeof before);
            memcpy(&after, (unsigned char *)&changed.each[IMAGES - 1] + effect->shown, sizeof after);
            TEST_ASSERT_TRUE_MESSAGE(before > 0.0f && after > 1.02f * before, effect->name);
        }
    }
}

/* [A11] */
static void without_a_change_the_answers_are_the_same(void) {
    for (int flight = TRUCK; flight <= PAPER; flight++) {
        const goe_settings_t settings = start((flight_t)flight);
        fly((flight_t)flight, &settings, &plain);
        fly((flight_t)flight, &settings, &changed);
        TEST_ASSERT_EQUAL_MEMORY(&plain, &changed, sizeof plain);
        TEST_ASSERT_TRUE(plain.each[IMAGES - 1].valid & GOE_HAS_POSITION);
    }
}

/* [A26] The table above names every setting once. */
static void every_setting_is_tried(void) {
    for (size_t i = 0; i < PLACES; i++) {
        int found = 0;
        for (size_t j = 0; j < EFFECTS; j++) {
            found += strcmp(places[i].name, effects[j].name) == 0 ? 1 : 0;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, found, places[i].name);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_setting_does_what_it_says);
    RUN_TEST(without_a_change_the_answers_are_the_same);
    RUN_TEST(every_setting_is_tried);
    return UNITY_END();
}
