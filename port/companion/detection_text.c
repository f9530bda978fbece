/* A line of JSON with an image's detections. SPDX-License-Identifier: MIT */
#include "detection_text.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "number_text.h"
#include "obstacle_class.h"

#define US_PER_S 1.0e6
#define AHEAD_MAX_S 0.05 /* clocks may be apart by this much before a time counts as one of the future */
#define AGE_MAX_S 60.0   /* an older image is another clock's */
#define SD_MAX_US 1.0e6
#define ID_MAX 4294967295.0

static bool fail(detection_fault_t *fault, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(fault->text, sizeof fault->text, format, arguments);
    va_end(arguments);
    return false;
}

/* ---------------------------------------------------------------------------------------------------------- numbers -- */

/* The first of two keys that is there; null: neither, or JSON's null. */
static const json_t *member(const json_t *object, const char *key, const char *alias) {
    const json_t *value = json_object_get(object, key);
    if (value == NULL && alias != NULL) {
        value = json_object_get(object, alias);
    }
    return json_is_null(value) ? NULL : value;
}

/* A number within limits; without the key the value stays. */
static bool read_number(const json_t *object, const char *key, const char *alias, double low, double high,
                        double *value, detection_fault_t *fault) {
    const json_t *found = member(object, key, alias);
    if (found == NULL) {
        return true;
    }
    if (!json_is_number(found)) {
        return fail(fault, "\"%s\" is not a number", key);
    }
    const double number = json_number_value(found);
    if (!(number >= low && number <= high)) {
        return fail(fault, "\"%s\" is out of range: %g to %g", key, low, high);
    }
    *value = number;
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- time -- */

static bool read_clock(const json_t *object, line_clock_t *clock, detection_fault_t *fault) {
    static const char *const names[] = {"unix", "monotonic", "age", "autopilot"};
    const json_t *found = member(object, "clock", NULL);
    if (found == NULL) {
        return true;
    }
    for (unsigned i = 0; i < sizeof names / sizeof names[0] && json_is_string(found); i++) {
        if (strcmp(json_string_value(found), names[i]) == 0) {
            *clock = (line_clock_t)i;
            return true;
        }
    }
    return fail(fault, "\"clock\" is none of unix, monotonic, age, autopilot");
}

/* How old the image is, by the clock that its time is of. */
static double age_s(line_clock_t clock, double time_s, const detection_now_t *now) {
    switch (clock) {
        case LINE_CLOCK_UNIX:
            return (double)now->unix_us / US_PER_S - time_s;
        case LINE_CLOCK_MONOTONIC:
            return (double)now->monotonic_us / US_PER_S - time_s;
        case LINE_CLOCK_AUTOPILOT:
            return (double)now->autopilot_us / US_PER_S - time_s;
        case LINE_CLOCK_AGE:
        default:
            return time_s;
    }
}

static bool read_time(const json_t *object, const companion_config_t *config, const detection_now_t *now,
                      goe_flight_frame_t *frame, detection_fault_t *fault) {
    line_clock_t clock = config->detections_clock;
    double time_s = 0.0, old_s = config->detections_delay_s, sd_s = 0.0;
    const bool has_time = member(object, "time", NULL) != NULL;
    if (!read_clock(object, &clock, fault) || !read_number(object, "time", NULL, -1e12, 1e12, &time_s, fault) ||
        !read_number(object, "time_sd", NULL, 0.0, 1.0, &sd_s, fault)) {
        return false;
    }
    if (has_time) {
        old_s = age_s(clock, time_s, now);
    } else {
        sd_s = sd_s > 0.0 ? sd_s : config->detections_delay_sd_s;
    }
    if (old_s < -AHEAD_MAX_S || old_s > AGE_MAX_S) {
        return fail(fault, "\"time\" is %.1f s %s", fabs(old_s), old_s < 0.0 ? "ahead of now" : "old");
    }
    sd_s = sd_s > 0.0 ? sd_s : (double)config->flight.delay_sd_s;
    const bool by_offset = !has_time || clock != LINE_CLOCK_AUTOPILOT;
    const double sd_us = hypot(sd_s * US_PER_S, by_offset ? now->autopilot_sd_us : 0.0);
    frame->time_base = GOE_FLIGHT_AUTOPILOT_CLOCK;
    frame->arrival_us = (uint32_t)now->autopilot_us;
    frame->capture_us = (uint32_t)(now->autopilot_us - (int64_t)llround((old_s > 0.0 ? old_s : 0.0) * US_PER_S));
    frame->sent_us = frame->capture_us;
    frame->time_sd_us = (uint32_t)lround(fmin(fmax(sd_us, 1.0), SD_MAX_US));
    return true;
}

/* ------------------------------------------------------------------------------------------------------- detections -- */

static bool read_pair(const json_t *value, const char *name, double pair[2], detection_fault_t *fault) {
    for (size_t i = 0; i < 2; i++) {
        const json_t *number = json_array_get(value, i);
        if (json_array_size(value) != 2 || !json_is_number(number)) {
            return fail(fault, "\"%s\" is not [u, v]", name);
        }
        pair[i] = json_number_value(number);
    }
    return true;
}

static bool read_point(const json_t *object, const char *name, goe_pixel_t *point, detection_fault_t *fault) {
    double pair[2] = {0.0, 0.0};
    const json_t *found = member(object, name, NULL);
    if (found == NULL) {
        return true;
    }
    if (!read_pair(found, name, pair, fault)) {
        return false;
    }
    point->u_px = number_to_float(pair[0]);
    point->v_px = number_to_float(pair[1]);
    point->visible = true;
    return true;
}

static const json_t *side(const json_t *box, size_t i) {
    static const char *const keys[] = {"x1", "y1", "x2", "y2"};
    return json_is_array(box) ? json_array_get(box, i) : json_object_get(box, keys[i]);
}

static bool read_box(const json_t *object, goe_box_t *box, detection_fault_t *fault) {
    const json_t *found = member(object, "box", NULL);
    float *const to[] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    if (found == NULL) {
        return true;
    }
    for (size_t i = 0; i < 4; i++) {
        const json_t *number = side(found, i);
        if (!json_is_number(number) || (json_is_array(found) && json_array_size(found) != 4)) {
            return fail(fault, "\"box\" is not [left, top, right, bottom]");
        }
        *to[i] = number_to_float(json_number_value(number));
    }
    box->sides = GOE_SIDES_ALL;
    return true;
}

typedef struct {
    char name[OBSTACLE_CLASS_NAME_MAX + 1]; /* empty: no name of a usual length */
    bool given;
} class_name_t;

/* The name at a place of a list with blanks between its names; empty: the list is shorter. */
static class_name_t name_at(const char *names, json_int_t place) {
    class_name_t found = {"", true};
    const char *name = names + strspn(names, " ");
    for (json_int_t i = 0; i < place && *name != '\0'; i++) {
        name += strcspn(name, " ");
        name += strspn(name, " ");
    }
    const size_t length = strcspn(name, " ");
    if (place >= 0 && length <= OBSTACLE_CLASS_NAME_MAX) {
        (void)memcpy(found.name, name, length);
    }
    return found;
}

/* A name, or else a number, of which `names` are the names. */
static class_name_t class_of(const json_t *object, const char *names) {
    class_name_t found = {"", false};
    const json_t *number = member(object, "class", NULL);
    const char *name = json_string_value(number);
    name = name != NULL ? name : json_string_value(member(object, "name", NULL));
    if (name == NULL && json_is_integer(number)) {
        return name_at(names, json_integer_value(number));
    }
    found.given = name != NULL;
    if (name != NULL && strlen(name) <= OBSTACLE_CLASS_NAME_MAX) {
        (void)strcpy(found.name, name);
    }
    return found;
}

static bool is_wanted(const class_name_t *class_name, const char *classes) {
    char padded[OBSTACLE_CLASS_NAME_MAX + 3];
    if (*classes == '\0' || *class_name->name == '\0') {
        return *classes == '\0';
    }
    (void)snprintf(padded, sizeof padded, " %s ", class_name->name);
    return strstr(classes, padded) != NULL;
}

static bool read_points(const json_t *object, goe_flight_detection_t *detection, detection_fault_t *fault) {
    return read_point(object, "left", &detection->left, fault) &&
           read_point(object, "right", &detection->right, fault) && read_point(object, "top", &detection->top, fault) &&
           read_point(object, "base_left", &detection->base_left, fault) &&
           read_point(object, "base_near", &detection->base_near, fault) &&
           read_point(object, "base_right", &detection->base_right, fault);
}

static bool read_detection(const json_t *object, goe_flight_detection_t *detection, detection_fault_t *fault) {
    double id = 0.0, score = 1.0, pixel_px = 0.0;
    (void)memset(detection, 0, sizeof *detection);
    if (!read_number(object, "id", "track_id", 0.0, ID_MAX, &id, fault) ||
        !read_number(object, "score", "confidence", 0.0, 1.0, &score, fault) ||
        !read_number(object, "pixel_sd", NULL, 0.0, 100.0, &pixel_px, fault) ||
        !read_box(object, &detection->box, fault) || !read_points(object, detection, fault)) {
        return false;
    }
    if (id - floor(id) > 0.0) {
        return fail(fault, "\"id\" is no whole number");
    }
    detection->id = (uint32_t)id;
    detection->score = (float)score;
    detection->pixel_px = (float)pixel_px;
    const bool marked = detection->left.visible || detection->right.visible || detection->top.visible ||
                        detection->base_left.visible || detection->base_near.visible || detection->base_right.visible;
    return detection->box.sides != 0 || marked || fail(fault, "a detection has neither a box nor points");
}

static bool read_detections(const json_t *list, const companion_config_t *config, camera_image_t *image,
                            detection_fault_t *fault) {
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *object = json_array_get(list, i);
        if (!json_is_object(object)) {
            return fail(fault, "detection %zu is no object", i + 1u);
        }
        const class_name_t class_name = class_of(object, config->detections_class_names);
        if (is_wanted(&class_name, config->detections_classes) && image->detections < CAMERA_IMAGE_DETECTIONS) {
            goe_flight_detection_t *detection = &image->detection[image->detections];
            if (!read_detection(object, detection, fault)) {
                return false;
            }
            const bool known = obstacle_class_kind(class_name.name, &detection->kind);
            image->unknown_classes += class_name.given && !known ? 1u : 0u;
            image->detections++;
        }
    }
    image->frame.number = (uint8_t)image->detections;
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- line -- */

static bool read_image(const json_t *root, const companion_config_t *config, const detection_now_t *now,
                       camera_image_t *image, detection_fault_t *fault) {
    double camera = 0.0;
    const bool bare = json_is_array(root);
    const json_t *list = bare ? root : member(root, "detections", NULL);
    if (!json_is_array(list)) {
        return fail(fault, "\"detections\" is no list");
    }
    if (!read_time(bare ? NULL : root, config, now, &image->frame, fault) ||
        !read_number(bare ? NULL : root, "camera", NULL, 0.0, (double)(GOE_CAMERAS_MAX - 1), &camera, fault)) {
        return false;
    }
    image->frame.camera = (uint8_t)camera;
    return read_detections(list, config, image, fault);
}

bool detection_text_read(const char *line, size_t length, const companion_config_t *config, const detection_now_t *now,
                         camera_image_t *image, detection_fault_t *fault) {
    json_error_t error;
    json_t *root = json_loadb(line, length, JSON_REJECT_DUPLICATES, &error);
    (void)memset(&image->frame, 0, sizeof image->frame);
    image->detections = image->unknown_classes = 0;
    if (root == NULL) {
        return fail(fault, "column %d: %s", error.column, error.text);
    }
    const bool good = read_image(root, config, now, image, fault);
    json_decref(root);
    return good;
}
