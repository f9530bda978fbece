/* One row of frames.csv: one obstacle in one image. SPDX-License-Identifier: MIT */
#include "frame.h"

#include <math.h>

#include "number_text.h"

#define US_PER_S 1.0e6
#define TIME_LIMIT_US 9.2e18 /* just inside 64 bits */

const char *const frame_value_name[FRAME_VALUES] = {
    "n_m",
    "e_m",
    "d_m",
    "agl_m",
    "qw",
    "qx",
    "qy",
    "qz",
    "left_u",
    "left_v",
    "right_u",
    "right_v",
    "top_u",
    "top_v",
    "base_left_u",
    "base_left_v",
    "base_near_u",
    "base_near_v",
    "base_right_u",
    "base_right_v",
    "box_left_px",
    "box_top_px",
    "box_right_px",
    "box_bottom_px",
    "reset_n_m",
    "reset_e_m",
    "reset_d_m",
    "kind_width_m",
    "kind_width_sd_m",
    "kind_height_m",
    "kind_height_sd_m",
};

static int64_t time_to_us(double time_s) {
    const double time_us = time_s * US_PER_S;
    return fabs(time_us) < TIME_LIMIT_US ? (int64_t)llrint(time_us) : GOE_TIME_UNKNOWN; /* NaN is not less either */
}

static float pose_value(const frame_t *frame, frame_value_t name) {
    return frame->given[name] ? number_to_float(frame->value[name]) : NAN;
}

static goe_pixel_t image_point(const frame_t *frame, frame_value_t name_u) {
    const frame_value_t name_v = (frame_value_t)(name_u + 1);
    goe_pixel_t point = {0.0f, 0.0f, frame->given[name_u] && frame->given[name_v]};
    if (point.visible) {
        point.u_px = number_to_float(frame->value[name_u]);
        point.v_px = number_to_float(frame->value[name_v]);
    }
    return point;
}

/* A side of the box: returns its bit, 0 if it is not visible. */
static unsigned box_side(const frame_t *frame, frame_value_t name, unsigned bit, float *side_px) {
    if (!frame->given[name]) {
        return 0;
    }
    *side_px = number_to_float(frame->value[name]);
    return bit;
}

static void read_box(const frame_t *frame, goe_box_t *box) {
    unsigned seen = box_side(frame, FRAME_BOX_LEFT_PX, GOE_SIDE_LEFT, &box->left_px);
    seen |= box_side(frame, FRAME_BOX_TOP_PX, GOE_SIDE_TOP, &box->top_px);
    seen |= box_side(frame, FRAME_BOX_RIGHT_PX, GOE_SIDE_RIGHT, &box->right_px);
    seen |= box_side(frame, FRAME_BOX_BOTTOM_PX, GOE_SIDE_BOTTOM, &box->bottom_px);
    box->sides = (uint8_t)seen;
}

static void read_reset(const frame_t *frame, goe_pose_t *pose) {
    pose->reset_count = (uint8_t)((uint64_t)frame->reset_count & UINT8_MAX);
    pose->reset_delta_known = true;
    for (int i = 0; i < 3; i++) {
        pose->reset_delta_ned_m[i] = pose_value(frame, (frame_value_t)(FRAME_RESET_N_M + i));
        pose->reset_delta_known = pose->reset_delta_known && frame->given[FRAME_RESET_N_M + i];
    }
}

/* Without its size a sigma is not read. */
static void read_size(const frame_t *frame, frame_value_t name, float *size_m, float *sd_m) {
    if (frame->given[name]) {
        *size_m = number_to_float(frame->value[name]);
        *sd_m = frame->given[name + 1] ? number_to_float(frame->value[name + 1]) : 0.0f;
    }
}

static uint8_t camera_number(int64_t number) { return number >= 0 && number < UINT8_MAX ? (uint8_t)number : UINT8_MAX; }

void frame_to_image(const frame_t *frame, goe_image_t *image) {
    const goe_image_t empty = {0};
    *image = empty;
    image->pose.time_us = time_to_us(frame->time_s);
    for (int i = 0; i < 3; i++) {
        image->pose.position_ned_m[i] = pose_value(frame, (frame_value_t)(FRAME_N_M + i));
    }
    for (int i = 0; i < 4; i++) {
        image->pose.attitude[i] = pose_value(frame, (frame_value_t)(FRAME_QW + i));
    }
    image->pose.height_m = frame->given[FRAME_AGL_M] ? pose_value(frame, FRAME_AGL_M) : -pose_value(frame, FRAME_D_M);
    read_reset(frame, &image->pose);
    image->left = image_point(frame, FRAME_LEFT_U);
    image->right = image_point(frame, FRAME_RIGHT_U);
    image->top = image_point(frame, FRAME_TOP_U);
    image->base_left = image_point(frame, FRAME_BASE_LEFT_U);
    image->base_near = image_point(frame, FRAME_BASE_NEAR_U);
    image->base_right = image_point(frame, FRAME_BASE_RIGHT_U);
    read_box(frame, &image->box);
    read_size(frame, FRAME_KIND_WIDTH_M, &image->kind.width_m, &image->kind.width_sd_m);
    read_size(frame, FRAME_KIND_HEIGHT_M, &image->kind.height_m, &image->kind.height_sd_m);
    image->kind.shape = (uint8_t)frame->kind_shape;
    image->camera = camera_number(frame->camera);
}
