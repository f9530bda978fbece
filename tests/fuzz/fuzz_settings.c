/* Settings by the fuzzer's bytes. SPDX-License-Identifier: MIT */
#include "fuzz_settings.h"

#include "goe_settings_list.h"

enum { KIND_REAL, KIND_COUNT, KIND_TRUTH, KIND_CHOICE };

typedef struct {
    size_t place;
    int kind;
    float low, high, usual;
} field_t;

#define FIELD(field, kind, unit, low, high, value, text)                                                               \
    {offsetof(goe_settings_t, field), KIND_##kind, (float)(low), (float)(high), (float)(value)},

static const field_t fields[] = {GOE_SETTINGS(FIELD)};
#define FIELDS (sizeof fields / sizeof fields[0])
#define ONE(field, kind, unit, low, high, value, text) +1u
#define CAMERA_FIELDS ((size_t)(0u GOE_SETTINGS_CAMERA(ONE)))

static void put(const field_t *field, float value, goe_settings_t *settings) {
    unsigned char *at = (unsigned char *)settings + field->place;
    const int whole = value > 2.0e9f || value < -2.0e9f || !fuzz_is_finite(value) ? -1 : (int)value;
    const goe_method_t choice = (goe_method_t)whole;
    const unsigned char truth = (unsigned char)(whole & 0xFF);
    switch (field->kind) {
        case KIND_REAL:
            memcpy(at, &value, sizeof value);
            break;
        case KIND_TRUTH:
            memcpy(at, &truth, sizeof truth);
            break;
        case KIND_CHOICE:
            memcpy(at, &choice, sizeof choice);
            break;
        default:
            memcpy(at, &whole, sizeof whole);
            break;
    }
}

/* Near the default, by a factor of up to 8 up or down, or anywhere in the range. */
static float within(fuzz_input_t *in, const field_t *field) {
    float value = fuzz_between(in, field->low, field->high);
    if (field->kind == KIND_REAL && field->usual > 0.0f && fuzz_below(in, 4) != 3) {
        const uint32_t shift = fuzz_below(in, 7); /* in steps of a factor of 2 */
        value = field->usual * 0.125f * (float)(1u << shift);
    }
    if (field->kind != KIND_REAL) {
        value = (float)(int)(value + 0.5f);
    }
    return value < field->low ? field->low : (value > field->high ? field->high : value);
}

void fuzz_change_settings(fuzz_input_t *in, bool legal, goe_settings_t *settings) {
    const uint32_t changes = 1u + fuzz_below(in, 6);
    for (uint32_t i = 0; i < changes; i++) {
        const uint32_t which = fuzz_byte(in);
        const bool camera = !legal || which % 16u == 15u; /* most other values leave no obstacle in view */
        const size_t first = camera ? 0u : CAMERA_FIELDS;
        const field_t *field = &fields[first + which % (FIELDS - first)];
        const bool inside = legal || fuzz_below(in, 4) != 3;
        put(field, inside ? within(in, field) : fuzz_any(in, field->low, field->high), settings);
    }
}

static void usual_camera(fuzz_input_t *in, goe_camera_t *camera) {
    const uint32_t kind = fuzz_byte(in);
    camera->fx_px = fuzz_between(in, 250.0f, 1500.0f);
    camera->fy_px = camera->fx_px;
    camera->cx_px = fuzz_between(in, 300.0f, 1000.0f);
    camera->cy_px = camera->cx_px * 0.75f;
    camera->width_px = camera->height_px = 0.0f;
    if ((kind & 1u) == 0) {
        camera->width_px = 2.0f * camera->cx_px;
        camera->height_px = 2.0f * camera->cy_px;
    }
    if ((kind & 6u) == 6u) {
        camera->k1 = fuzz_between(in, -0.15f, 0.15f);
        camera->k2 = fuzz_between(in, -0.02f, 0.02f);
        camera->p1 = fuzz_between(in, -0.002f, 0.002f);
    }
    if ((kind & 24u) == 24u) {
        camera->mount_yaw_deg = fuzz_between(in, -30.0f, 30.0f);
        camera->mount_pitch_deg = fuzz_between(in, -20.0f, 10.0f);
        camera->mount_roll_deg = (kind & 96u) == 96u ? fuzz_between(in, -180.0f, 180.0f) : 0.0f;
        camera->offset_m[0] = fuzz_between(in, -1.0f, 3.0f);
    }
}

void fuzz_usual_settings(fuzz_input_t *in, goe_settings_t *settings) {
    const uint32_t kind = fuzz_byte(in);
    goe_settings_default(settings);
    usual_camera(in, &settings->camera);
#if GOE_CAMERAS_MAX > 1
    if ((kind & 3u) == 3u) {
        usual_camera(in, &settings->more_cameras[0]);
    }
#endif
    settings->method = (kind & 12u) == 12u ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER;
    settings->model = (goe_model_t)(GOE_MODEL_AUTO + (int)((kind >> 4) % 6u == 4u   ? 1
                                                           : (kind >> 4) % 6u == 5u ? 2
                                                                                    : 0));
    settings->heading_auto = fuzz_below(in, 8) != 7u;
}
