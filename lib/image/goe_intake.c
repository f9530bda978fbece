/* Input checks: whether each number of an image is finite and in range. SPDX-License-Identifier: MIT */
#include "image/goe_intake.h"

#include <stddef.h>

#include "image/goe_ego_motion.h"
#include "image/goe_view.h"
#include "maths/goe_scalar.h"

#define POSITION_MAX_M 1.0e6f
#define HEIGHT_MAX_M 1.0e5f
#define PIXEL_MAX_PX 1.0e5f
#define ATTITUDE_MAX 2.0f /* of each element: keeps the squares finite */
#define NOISE_MAX_DEG 30.0f
#define NOISE_MAX_M 1.0e3f
#define NOISE_MAX_PX 100.0f
#define SIZE_MAX_M 1.0e3f
#define SIZE_SHARE_MIN 0.01f      /* least sigma of a class's size, over the size */
#define NORM2_MIN (0.99f * 0.99f) /* the norm may be off by 1 % */
#define NORM2_MAX (1.01f * 1.01f)

/* The largest magnitude of at most four numbers. */
static uint32_t largest_of(const float *x, size_t count) {
    uint32_t largest = 0u;
    for (size_t i = 0; i < count; i++) {
        largest = goe_larger_bits(largest, goe_magnitude(x[i]));
    }
    return largest;
}

static uint32_t with_pixel(uint32_t so_far, const goe_pixel_t *pixel) {
    const uint32_t largest = goe_larger_bits(goe_magnitude(pixel->u_px), goe_magnitude(pixel->v_px));
    return goe_is_set(&pixel->visible) ? goe_larger_bits(so_far, largest) : so_far;
}

static uint32_t largest_pixel(const goe_image_t *image) {
    const goe_pixel_t *pixels = goe_image_pixels(image);
    uint32_t largest = 0u;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        largest = with_pixel(largest, &pixels[i]);
    }
    return largest;
}

/* The sides that are measured. */
static uint32_t largest_side(const goe_box_t *box) {
    const float *px = goe_box_sides(box);
    uint32_t largest = 0u;
    for (size_t i = 0; i < GOE_BOX_SIDES; i++) {
        largest = (box->sides >> i & 1u) != 0u ? goe_larger_bits(largest, goe_magnitude(px[i])) : largest;
    }
    return largest;
}

/* Not finite has priority over out of range, and this over a bad attitude. */
static goe_status_t check_numbers(const goe_image_t *image, uint32_t attitude, bool reset) {
    const goe_pose_t *pose = &image->pose;
    const uint32_t height = goe_magnitude(pose->height_m);
    uint32_t pixel = largest_pixel(image);
    if (image->box.sides != 0) {
        pixel = goe_larger_bits(pixel, largest_side(&image->box));
    }
    uint32_t position = largest_of(pose->position_ned_m, 3);
    if (reset && goe_is_set(&pose->reset_delta_known)) {
        position = goe_larger_bits(position, largest_of(pose->reset_delta_ned_m, 3));
    }
    if (goe_larger_bits(goe_larger_bits(height, attitude), goe_larger_bits(position, pixel)) >= GOE_INFINITY_BITS) {
        return GOE_NOT_FINITE;
    }
    const bool within = height <= goe_magnitude(HEIGHT_MAX_M) && position <= goe_magnitude(POSITION_MAX_M) &&
                        pixel <= goe_magnitude(PIXEL_MAX_PX);
    return within ? GOE_OK : GOE_OUT_OF_RANGE;
}

static bool is_unit(const float q[4], uint32_t largest) {
    if (largest > goe_magnitude(ATTITUDE_MAX)) {
        return false;
    }
    const float norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return norm2 >= NORM2_MIN && norm2 <= NORM2_MAX;
}

/* Whether an image comes after the latest one: later, or at the same time from a camera with a higher number. */
static bool is_next(const goe_motion_t *motion, const goe_image_t *image) {
    const int64_t time_us = image->pose.time_us;
#if GOE_CAMERAS_MAX > 1
    if (time_us == motion->time_us && time_us != GOE_TIME_UNKNOWN) {
        return image->camera > motion->camera;
    }
#endif
    return time_us > motion->time_us; /* GOE_TIME_UNKNOWN is the smallest of all times */
}

goe_status_t goe_intake_check(const goe_motion_t *motion, const goe_image_t *image) {
    const float *q = image->pose.attitude;
    const uint32_t attitude = largest_of(q, 4);
    const goe_status_t status = check_numbers(image, attitude, goe_motion_reset(motion, &image->pose));
    if (status != GOE_OK) {
        return status;
    }
    if (!is_next(motion, image)) {
        return GOE_BAD_TIME;
    }
    return is_unit(q, attitude) ? GOE_OK : GOE_BAD_ATTITUDE;
}

goe_status_t goe_intake_check_noise(const goe_image_noise_t *noise) {
    if (largest_of(&noise->attitude_sd_deg, sizeof *noise / sizeof(float)) >= GOE_INFINITY_BITS) {
        return GOE_NOT_FINITE;
    }
    const bool within = goe_between(noise->attitude_sd_deg, 0.0f, NOISE_MAX_DEG) &&
                        goe_between(noise->height_sd_m, 0.0f, NOISE_MAX_M) &&
                        goe_between(noise->pixel_sd_px, 0.0f, NOISE_MAX_PX);
    return within ? GOE_OK : GOE_OUT_OF_RANGE;
}

static bool is_size(float size_m, float sd_m) {
    return goe_between(size_m, 0.0f, SIZE_MAX_M) &&
           (!(size_m > 0.0f) || goe_between(sd_m, SIZE_SHARE_MIN * size_m, SIZE_MAX_M));
}

goe_status_t goe_intake_check_kind(const goe_kind_t *kind) {
    if (largest_of(&kind->width_m, offsetof(goe_kind_t, shape) / sizeof(float)) >= GOE_INFINITY_BITS) {
        return GOE_NOT_FINITE;
    }
    const bool within = is_size(kind->width_m, kind->width_sd_m) && is_size(kind->height_m, kind->height_sd_m) &&
                        kind->shape <= GOE_KIND_OTHER;
    return within ? GOE_OK : GOE_OUT_OF_RANGE;
}
