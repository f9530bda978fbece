/* From messages to frames of the flight layer. SPDX-License-Identifier: MIT */
#include <string.h>

#include "goe_flight_maths.h"
#include "goe_mavlink_map.h"

#define NO_CAMERA 255u /* none has this number: goe_flight_frame() refuses it */
#define PX_PER_UNIT 0.1f
#define M_PER_UNIT 0.01f
#define SCORE_UNKNOWN 255u
#define SCORE_MAX 100u
#define SIDE_MAX_PX 1.0e5f                       /* of goe_box_t */
#define ANGLE_MAX_DEG 80.0f                      /* from the axis to a side */
#define ANGLE_MAX_RAD 10.0f                      /* what can be one at all */
#define SINCE_BOOT_MAX_US (UINT64_C(1000) << 32) /* more is UNIX time */
#define TRACKING_ACTIVE 0x01u                    /* CAMERA_TRACKING_STATUS_FLAGS */
#define TRACKING_ERROR 0x02u
#define TRACKING_COASTING 0x08u
#define TRACKING_NONE 0u /* CAMERA_TRACKING_MODE */
#define TRACKING_POINT 1u
#define TRACKING_RECTANGLE 2u

GOE_STATIC_ASSERT((unsigned)GOE_MAVLINK_FEATURE_BOX_LEFT == GOE_SIDE_LEFT, sides_have_the_same_bits);

static void begin(goe_mavlink_sighting_t *sighting, uint8_t camera, uint32_t arrival_us) {
    memset(sighting, 0, sizeof *sighting);
    sighting->frame.detection = &sighting->detection;
    sighting->frame.camera = camera;
    sighting->frame.arrival_us = sighting->frame.capture_us = sighting->frame.sent_us = arrival_us;
}

static bool not_understood(goe_mavlink_sighting_t *sighting) {
    sighting->frame.camera = NO_CAMERA;
    sighting->frame.number = sighting->frame.count = 0;
    return false;
}

/* ------------------------------------------------------------------------------------------------------ GOE_FEATURES -- */

static void read_time(const goe_mavlink_features_t *message, goe_flight_frame_t *frame) {
    frame->time_base = message->time_base;
    frame->time_sd_us = message->time_sd;
    if (message->time_base == GOE_FLIGHT_AGE) {
        frame->capture_us = frame->sent_us = message->age_usec;
    } else {
        frame->capture_us = (uint32_t)(message->time_usec & UINT32_MAX);
        frame->sent_us = frame->capture_us + message->age_usec;
    }
}

static float pixel(uint16_t size_px, int16_t from_middle) {
    return 0.5f * (float)size_px + PX_PER_UNIT * (float)from_middle;
}

static void read_box(const goe_mavlink_features_t *message, goe_box_t *box) {
    box->left_px = pixel(message->image_width, message->box[GOE_MAVLINK_LEFT]);
    box->top_px = pixel(message->image_height, message->box[GOE_MAVLINK_TOP]);
    box->right_px = pixel(message->image_width, message->box[GOE_MAVLINK_RIGHT]);
    box->bottom_px = pixel(message->image_height, message->box[GOE_MAVLINK_BOTTOM]);
    box->sides = (uint8_t)(message->visible & GOE_MAVLINK_FEATURE_BOX);
}

static void read_points(const goe_mavlink_features_t *message, goe_flight_detection_t *detection) {
    goe_pixel_t *const point[GOE_MAVLINK_POINTS] = {&detection->left,      &detection->right,
                                                    &detection->top,       &detection->base_left,
                                                    &detection->base_near, &detection->base_right};
    for (unsigned i = 0; i < GOE_MAVLINK_POINTS; i++) {
        point[i]->u_px = pixel(message->image_width, message->u[i]);
        point[i]->v_px = pixel(message->image_height, message->v[i]);
        point[i]->visible = (message->visible & GOE_MAVLINK_FEATURE_POINT << i) != 0u;
    }
}

static void read_kind(const goe_mavlink_features_t *message, goe_kind_t *kind) {
    kind->width_m = M_PER_UNIT * (float)message->kind_width;
    kind->width_sd_m = M_PER_UNIT * (float)message->kind_width_sd;
    kind->height_m = M_PER_UNIT * (float)message->kind_height;
    kind->height_sd_m = M_PER_UNIT * (float)message->kind_height_sd;
    kind->shape = message->kind_shape;
}

static float read_score(uint8_t score) {
    return score < SCORE_MAX ? 0.01f * (float)score : 1.0f; /* also SCORE_UNKNOWN; the flight layer takes 0 for none */
}

bool goe_mavlink_from_features(const goe_mavlink_features_t *message, uint32_t arrival_us,
                               goe_mavlink_sighting_t *sighting) {
    begin(sighting, message->camera_id, arrival_us);
    if (message->time_base > GOE_FLIGHT_AGE || message->camera_id >= GOE_CAMERAS_MAX) {
        return not_understood(sighting);
    }
    read_time(message, &sighting->frame);
    sighting->frame.number = message->number;
    if (message->number == 0u) {
        return false;
    }
    if (message->image_width == 0u || message->image_height == 0u) {
        return not_understood(sighting);
    }
    sighting->frame.count = 1;
    sighting->detection.id = message->obstacle_id;
    sighting->detection.score = read_score(message->score);
    sighting->detection.pixel_px = PX_PER_UNIT * (float)message->pixel_sd;
    read_box(message, &sighting->detection.box);
    read_points(message, &sighting->detection);
    read_kind(message, &sighting->detection.kind);
    return true;
}

/* ------------------------------------------------------------------------------------------------- standard messages -- */

static bool is_camera(const goe_mavlink_camera_t *camera) {
    const float numbers[6] = {camera->width_px, camera->height_px, camera->fx_px,
                              camera->fy_px,    camera->cx_px,     camera->cy_px};
    return camera->number < GOE_CAMERAS_MAX && goe_flight_all_within(numbers, 6, SIDE_MAX_PX) &&
           camera->width_px > 0.0f && camera->height_px > 0.0f && camera->fx_px > 0.0f && camera->fy_px > 0.0f;
}

static void calibrated_time(const goe_mavlink_camera_t *camera, uint32_t arrival_us, goe_flight_frame_t *frame) {
    frame->time_base = GOE_FLIGHT_AUTOPILOT_CLOCK;
    frame->capture_us = frame->sent_us = arrival_us - camera->delay_us;
    frame->time_sd_us = camera->delay_sd_us;
}

/* The one detection of the frame: a box of all four sides, left, top, right, bottom. */
static bool give_box(const float side_px[4], uint32_t id, goe_mavlink_sighting_t *sighting) {
    goe_box_t *box = &sighting->detection.box;
    if (!goe_flight_all_within(side_px, 4, SIDE_MAX_PX) || !(side_px[0] < side_px[2]) || !(side_px[1] < side_px[3])) {
        return not_understood(sighting);
    }
    box->left_px = side_px[0];
    box->top_px = side_px[1];
    box->right_px = side_px[2];
    box->bottom_px = side_px[3];
    box->sides = GOE_SIDES_ALL;
    sighting->detection.id = id;
    sighting->detection.score = 1.0f;
    sighting->frame.number = sighting->frame.count = 1;
    return true;
}

/* Tangent of an angle of at most ANGLE_MAX_DEG. */
static bool find_tangent(float angle_rad, float *tangent) {
    const float deg = angle_rad * GOE_FLIGHT_DEG_PER_RAD;
    float sine;
    float cosine;
    if (!goe_flight_within(deg, ANGLE_MAX_DEG)) {
        return false;
    }
    goe_flight_sincos_deg(deg, &sine, &cosine);
    *tangent = sine / cosine;
    return true;
}

static bool find_sides(const goe_mavlink_landing_target_t *message, const goe_mavlink_camera_t *camera,
                       float side_px[4]) {
    const float angle[4] = {message->angle_x, message->angle_y, message->size_x, message->size_y};
    float tangent[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    if (!goe_flight_all_within(angle, 4, ANGLE_MAX_RAD) || !find_tangent(angle[0] - 0.5f * angle[2], &tangent[0]) ||
        !find_tangent(angle[1] - 0.5f * angle[3], &tangent[1]) ||
        !find_tangent(angle[0] + 0.5f * angle[2], &tangent[2]) ||
        !find_tangent(angle[1] + 0.5f * angle[3], &tangent[3])) {
        return false;
    }
    for (int i = 0; i < 4; i += 2) {
        side_px[i] = camera->cx_px + camera->fx_px * tangent[i];
        side_px[i + 1] = camera->cy_px + camera->fy_px * tangent[i + 1];
    }
    return true;
}

bool goe_mavlink_from_landing_target(const goe_mavlink_landing_target_t *message, const goe_mavlink_camera_t *camera,
                                     uint32_t arrival_us, goe_mavlink_sighting_t *sighting) {
    float side_px[4];
    begin(sighting, camera->number, arrival_us);
    if (!is_camera(camera) || !find_sides(message, camera, side_px)) {
        return not_understood(sighting);
    }
    calibrated_time(camera, arrival_us, &sighting->frame);
    if (camera->shares_clock && message->time_usec != 0u && message->time_usec < SINCE_BOOT_MAX_US) {
        sighting->frame.capture_us = sighting->frame.sent_us = (uint32_t)(message->time_usec & UINT32_MAX);
        sighting->frame.time_sd_us = 0u;
    }
    return give_box(side_px, (uint32_t)message->target_num + 1u, sighting);
}

bool goe_mavlink_from_tracking(const goe_mavlink_tracking_t *message, const goe_mavlink_camera_t *camera,
                               uint32_t arrival_us, goe_mavlink_sighting_t *sighting) {
    const unsigned state = message->tracking_status;
    float side_px[4] = {message->rec_top_x * camera->width_px, message->rec_top_y * camera->height_px,
                        message->rec_bottom_x * camera->width_px, message->rec_bottom_y * camera->height_px};
    begin(sighting, camera->number, arrival_us);
    if (!is_camera(camera) || (state & TRACKING_ERROR) != 0u || message->tracking_mode > TRACKING_RECTANGLE) {
        return not_understood(sighting);
    }
    calibrated_time(camera, arrival_us, &sighting->frame);
    if ((state & (TRACKING_ACTIVE | TRACKING_COASTING)) != TRACKING_ACTIVE || message->tracking_mode == TRACKING_NONE) {
        return false;
    }
    if (message->tracking_mode == TRACKING_POINT) {
        const float radius_px = message->radius * camera->width_px;
        side_px[0] = message->point_x * camera->width_px - radius_px;
        side_px[1] = message->point_y * camera->height_px - radius_px;
        side_px[2] = message->point_x * camera->width_px + radius_px;
        side_px[3] = message->point_y * camera->height_px + radius_px;
    }
    return give_box(side_px, 0u, sighting);
}
