/* Settings: defaults and ranges. SPDX-License-Identifier: MIT */
#include "goe_settings.h"

#include "maths/goe_scalar.h"

#define PIXELS_MAX 1.0e5f
#define TURN_MAX_DEG 360.0f
#define LENS_MAX 100.0f
#define ARM_MAX_M 1.0e4f
#define GATE_MAX_PX 1.0e4f
#define COUNT_MAX 1000
#define WINDOW_MIN 3

#if GOE_WINDOW_MAX < 3 || GOE_WINDOW_MAX > 64
#error "GOE_WINDOW_MAX must be 3 to 64"
#endif

typedef struct {
    const char *name;
    uint16_t offset; /* in goe_settings_t */
    float smallest, largest;
} number_range_t;

typedef struct {
    const char *name;
    int value, smallest, largest;
} count_range_t;

#define NUMBER(field, smallest, largest) {#field, (uint16_t)offsetof(goe_settings_t, field), smallest, largest}

static const number_range_t number_ranges[] = {
    NUMBER(camera.fx_px, 1.0f, PIXELS_MAX),
    NUMBER(camera.fy_px, 1.0f, PIXELS_MAX),
    NUMBER(camera.cx_px, -PIXELS_MAX, PIXELS_MAX),
    NUMBER(camera.cy_px, -PIXELS_MAX, PIXELS_MAX),
    NUMBER(camera.k1, -LENS_MAX, LENS_MAX),
    NUMBER(camera.k2, -LENS_MAX, LENS_MAX),
    NUMBER(camera.p1, -LENS_MAX, LENS_MAX),
    NUMBER(camera.p2, -LENS_MAX, LENS_MAX),
    NUMBER(camera.k3, -LENS_MAX, LENS_MAX),
    NUMBER(camera.mount_yaw_deg, -TURN_MAX_DEG, TURN_MAX_DEG),
    NUMBER(camera.mount_pitch_deg, -TURN_MAX_DEG, TURN_MAX_DEG),
    NUMBER(camera.mount_roll_deg, -TURN_MAX_DEG, TURN_MAX_DEG),
    NUMBER(camera.offset_m[0], -ARM_MAX_M, ARM_MAX_M),
    NUMBER(camera.offset_m[1], -ARM_MAX_M, ARM_MAX_M),
    NUMBER(camera.offset_m[2], -ARM_MAX_M, ARM_MAX_M),
    NUMBER(heading_deg, -TURN_MAX_DEG, TURN_MAX_DEG),
    NUMBER(edge_min_px, 0.0f, GATE_MAX_PX),
    NUMBER(orientation_min_px, 0.0f, GATE_MAX_PX),
    NUMBER(side_min_px, 0.1f, GATE_MAX_PX),
    NUMBER(min_baseline_m, 1.0e-3f, 1.0e4f),
    NUMBER(noise.pixel_px, 0.05f, 100.0f),
    NUMBER(noise.size_share, 0.0f, 1.0f),
    NUMBER(noise.correlation, 0.0f, 0.95f),
    NUMBER(noise.shape_share, 0.0f, 1.0f),
    NUMBER(noise.attitude_bias_deg, 1.0e-3f, 30.0f),
    NUMBER(noise.attitude_white_deg, 1.0e-4f, 30.0f),
    NUMBER(noise.attitude_drift_deg, 0.0f, 30.0f),
    NUMBER(noise.height_m, 1.0e-3f, 1.0e3f),
    NUMBER(noise.velocity_bias_m_s, 0.0f, 100.0f),
    NUMBER(noise.position_walk_m, 0.0f, 100.0f),
    NUMBER(typical_size_m, 0.1f, 1.0e3f),
    NUMBER(gate_sigma, 1.0f, 100.0f),
    NUMBER(huber_sigma, 0.5f, 100.0f),
    NUMBER(misfit_max, 1.0e-2f, 1.0e3f),
};

void goe_settings_default(goe_settings_t *settings) {
    if (!settings) {
        return;
    }
    memset(settings, 0, sizeof *settings);
    settings->method = GOE_METHOD_REFINED;
    settings->model = GOE_MODEL_AUTO;
    settings->heading_auto = true;
    settings->window = 8; /* Section 4 of the paper, and so are all down to orientation_memory */
    settings->line_points = 8;
    settings->edge_min_px = 10.0f;
    settings->orientation_min_px = 2.0f;
    settings->side_min_px = 10.0f;
    settings->orientation_memory = 20;
    settings->min_baseline_m = 0.1f;
    settings->noise.pixel_px = 0.5f;
    settings->noise.attitude_bias_deg = 0.5f;
    settings->noise.attitude_white_deg = 0.1f;
    settings->noise.height_m = 0.5f;
    settings->noise.velocity_bias_m_s = 0.05f;
    settings->noise.position_walk_m = 0.05f;
    settings->typical_size_m = 6.0f;
    settings->gate_sigma = 5.0f;
    settings->huber_sigma = 2.5f;
    settings->misfit_max = 1.9f;
}

static const char *first_bad_number(const goe_settings_t *settings) {
    for (size_t i = 0; i < sizeof number_ranges / sizeof number_ranges[0]; i++) {
        const number_range_t *range = &number_ranges[i];
        float value;
        memcpy(&value, (const unsigned char *)settings + range->offset, sizeof value);
        if (goe_magnitude(value) >= GOE_INFINITY_BITS || value < range->smallest || value > range->largest) {
            return range->name;
        }
    }
    return NULL;
}

static const char *first_bad_count(const goe_settings_t *s) {
    const count_range_t counts[] = {
        {"method", (int)s->method, GOE_METHOD_WINDOW, GOE_METHOD_REFINED},
        {"model", (int)s->model, GOE_MODEL_AUTO, GOE_MODEL_LINE},
        {"window", s->window, WINDOW_MIN, GOE_WINDOW_MAX},
        {"line_points", s->line_points, 1, COUNT_MAX},
        {"orientation_memory", s->orientation_memory, 1, COUNT_MAX},
    };
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        if (counts[i].value < counts[i].smallest || counts[i].value > counts[i].largest) {
            return counts[i].name;
        }
    }
    return NULL;
}

const char *goe_settings_first_bad(const goe_settings_t *settings) {
    const char *bad = first_bad_number(settings);
    return bad ? bad : first_bad_count(settings);
}
