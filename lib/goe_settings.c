/* Default values and range checks of the settings, taken from goe_settings_list.h. SPDX-License-Identifier: MIT */
#include "goe_settings_internal.h"

#include <string.h>

#include "goe_settings_list.h"
#include "maths/goe_scalar.h"

#define FOCAL_MIN 0.05f /* in image sizes: a view of 169 degrees, which no lens model here describes */
#define BEYOND_MAX 1.5f /* focal lengths from image to principal point: the image may be a part of the sensor's */

enum { SETTING_REAL, SETTING_COUNT, SETTING_TRUTH, SETTING_CHOICE };

/* Separate arrays, because entries of mixed sizes would be padded; names in one string. Counts, truth values and choices are exact in a
 * float. */
#define NAME(field, kind, unit, low, high, value, text) #field "\0"
#define PLACE(field, kind, unit, low, high, value, text) (uint16_t)offsetof(goe_settings_t, field),
#define KIND(field, kind, unit, low, high, value, text) (uint8_t)SETTING_##kind,
#define RANGE(field, kind, unit, low, high, value, text) {(float)(low), (float)(high), (float)(value)},

static const char names[] = GOE_SETTINGS(NAME);
static const uint16_t places[] = {GOE_SETTINGS(PLACE)};
static const uint8_t kinds[] = {GOE_SETTINGS(KIND)};
static const struct {
    float low, high, value;
} ranges[] = {GOE_SETTINGS(RANGE)};
#define SETTINGS (sizeof places / sizeof places[0])

GOE_STATIC_ASSERT(sizeof(goe_settings_t) <= UINT16_MAX, a_place_fits_its_type);
GOE_STATIC_ASSERT(sizeof(goe_method_t) == sizeof(goe_model_t), choices_are_of_one_size);

/*@ requires \valid(field + (0 .. 3)); */
static void write_field(unsigned char *field, uint8_t kind, float value) {
    const int count = (int)value;
    const goe_method_t choice = (goe_method_t)count;
    const bool truth = count != 0;
    switch (kind) {
        case SETTING_REAL:
            memcpy(field, &value, sizeof value);
            break;
        case SETTING_COUNT:
            memcpy(field, &count, sizeof count);
            break;
        case SETTING_TRUTH:
            memcpy(field, &truth, sizeof truth);
            break;
        default:
            memcpy(field, &choice, sizeof choice);
            break;
    }
}

/*@ requires \valid_read(field + (0 .. 3)); */
static float read_field(const unsigned char *field, uint8_t kind) {
    float value;
    int count;
    goe_method_t choice;
    switch (kind) {
        case SETTING_REAL:
            memcpy(&value, field, sizeof value);
            return value;
        case SETTING_COUNT:
            memcpy(&count, field, sizeof count);
            return (float)count;
        case SETTING_TRUTH: /* not read as a bool: the byte may be neither 0 nor 1 */
            return (float)*field;
        default:
            memcpy(&choice, field, sizeof choice);
            return (float)choice;
    }
}

void goe_settings_default(goe_settings_t *settings) {
    if (!settings) {
        return;
    }
    memset(settings, 0, sizeof *settings);
    for (size_t i = 0; i < SETTINGS; i++) {
        write_field((unsigned char *)settings + places[i], kinds[i], ranges[i].value);
    }
#if GOE_CAMERAS_MAX > 1
    for (size_t i = 0; i + 1 < GOE_CAMERAS_MAX; i++) {
        settings->more_cameras[i] = settings->camera;
    }
#endif
}

/* Name of the first bad one of the first `count` settings, at `from`; null: none. */
/*@ requires \valid_read(from + (0 .. sizeof(goe_settings_t) - 1));
    requires count <= sizeof(places) / sizeof(places[0]); */
static const char *first_bad(const unsigned char *from, size_t count) {
    const char *name = names;
    for (size_t i = 0; i < count; i++) {
        const float value = read_field(from + places[i], kinds[i]);
        if (goe_magnitude(value) >= GOE_INFINITY_BITS || !(value >= ranges[i].low && value <= ranges[i].high)) {
            return name;
        }
        while (*name++ != '\0') {
        }
    }
    return NULL;
}

static bool is_too_short(float focal_px, float size_px) { return focal_px < FOCAL_MIN * size_px; }

static bool is_beyond(float center_px, float focal_px, float size_px) {
    return size_px > 0.0f && goe_larger(-center_px, center_px - size_px) > BEYOND_MAX * focal_px;
}

/* Name of a value that no camera has: a focal length in millimeters, or the principal point of another image size. Null: none. */
static const char *implausible(const goe_camera_t *camera) {
    if (is_too_short(camera->fx_px, camera->width_px)) {
        return "camera.fx_px";
    }
    if (is_too_short(camera->fy_px, camera->height_px)) {
        return "camera.fy_px";
    }
    if (is_beyond(camera->cx_px, camera->fx_px, camera->width_px)) {
        return "camera.cx_px";
    }
    return is_beyond(camera->cy_px, camera->fy_px, camera->height_px) ? "camera.cy_px" : NULL;
}

#if GOE_CAMERAS_MAX > 1
#define ONE_BYTE(field, kind, unit, low, high, value, text) (uint8_t)0,
#define CAMERA_SETTINGS (sizeof((const uint8_t[]){GOE_SETTINGS_CAMERA(ONE_BYTE)}))

GOE_STATIC_ASSERT(offsetof(goe_settings_t, camera) == 0, the_settings_of_the_camera_come_first);

static const char *first_bad_camera(const goe_settings_t *settings) {
    const char *bad = NULL;
    for (size_t i = 0; !bad && i + 1 < GOE_CAMERAS_MAX; i++) {
        const goe_camera_t *camera = &settings->more_cameras[i];
        if (goe_magnitude(camera->fx_px) != 0u) {
            bad = first_bad((const unsigned char *)camera, CAMERA_SETTINGS);
            bad = bad ? bad : implausible(camera);
        }
    }
    return bad;
}
#else
static const char *first_bad_camera(const goe_settings_t *settings) {
    (void)settings;
    return NULL;
}
#endif

const char *goe_settings_first_bad(const goe_settings_t *settings) {
    const char *bad = first_bad((const unsigned char *)settings, SETTINGS);
    bad = bad ? bad : implausible(&settings->camera);
    return bad ? bad : first_bad_camera(settings);
}

GOE_STATIC_ASSERT(offsetof(goe_settings_t, filter) + sizeof(goe_filter_settings_t) == sizeof(goe_settings_t) &&
                      sizeof(goe_filter_settings_t) - offsetof(goe_filter_settings_t, top_is_highest) == sizeof(float),
                  the_settings_end_in_a_truth_value);

void goe_settings_copy(goe_settings_t *to, const goe_settings_t *from) {
    unsigned char *bytes = (unsigned char *)to;
    const size_t heading = offsetof(goe_settings_t, heading_auto) + sizeof(bool);
    const size_t end = offsetof(goe_settings_t, filter.top_is_highest) + sizeof(bool);
    *to = *from;
    memset(bytes + heading, 0, offsetof(goe_settings_t, heading_deg) - heading);
    memset(bytes + end, 0, sizeof *to - end);
}
