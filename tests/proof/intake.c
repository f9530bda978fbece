/* Values beyond their ranges and NaN are refused whatever the other fields contain, so accepted values are within. One number at a time,
 * because the analyzer keeps intervals: each is set to the values above its range, below it, and to NaN.
 * SPDX-License-Identifier: MIT */
#include <float.h>

#include "any.h"
#include "goe_guard.h"
#include "goe_settings_internal.h"
#include "goe_settings_list.h"
#include "image/goe_intake.h"

#define JUST_OVER(x) ((x) + ((x) > 1.0f ? (x) * 1.2e-7f : ((x) < -1.0f ? -(x) * 1.2e-7f : 1.5e-7f)))
#define JUST_UNDER(x) (-JUST_OVER(-(x)))

#define SET_BITS(x, low, high) (*(uint32_t *)(void *)&(x) = Frama_C_unsigned_int_interval((low), (high)))

/* Both infinities. The analyzer keeps no bits of a NaN that is passed by value, so the unit tests check that each NaN is refused. */
#define INFINITIES(x, is_refused)                                                                                      \
    SET_BITS(x, 0x7F800000u, 0x7F800000u);                                                                             \
    is_refused;                                                                                                        \
    SET_BITS(x, 0xFF800000u, 0xFF800000u);                                                                             \
    is_refused;

/* ... and every NaN, for code that reads the bits in place. */
#define NO_NUMBERS(x, is_refused)                                                                                      \
    SET_BITS(x, 0x7F800000u, 0x7FFFFFFFu);                                                                             \
    is_refused;                                                                                                        \
    SET_BITS(x, 0xFF800000u, 0xFFFFFFFFu);                                                                             \
    is_refused;

/* -------------------------------------------------------------------------------------------------------------- image -- */

static goe_motion_t motion;
static goe_image_t image;

static void image_is_refused(void) {
    const goe_status_t status = goe_intake_check(&motion, &image);
    //@ check GOE_BAD_ATTITUDE <= status <= GOE_NOT_FINITE;
}

/* The field of the image at this place, with all others as they are. */
static void refuses(float *field, float limit) {
    *field = Frama_C_float_interval(JUST_OVER(limit), FLT_MAX);
    image_is_refused();
    *field = Frama_C_float_interval(-FLT_MAX, -JUST_OVER(limit));
    image_is_refused();
    INFINITIES(*field, image_is_refused())
    ANY_BITS(*field);
}

static void refuses_pixel(goe_pixel_t *pixel) {
    pixel->visible = true;
    refuses(&pixel->u_px, 1.0e5f);
    refuses(&pixel->v_px, 1.0e5f);
    ANY_BITS(pixel->visible);
}

static void refuses_side(float *side, uint8_t bit) {
    image.box.sides = bit;
    refuses(side, 1.0e5f);
    ANY_BITS(image.box.sides);
}

static void refuses_pixels(void) {
    refuses_pixel(&image.left);
    refuses_pixel(&image.right);
    refuses_pixel(&image.top);
    refuses_pixel(&image.base_left);
    refuses_pixel(&image.base_near);
    refuses_pixel(&image.base_right);
    refuses_side(&image.box.left_px, GOE_SIDE_LEFT);
    refuses_side(&image.box.top_px, GOE_SIDE_TOP);
    refuses_side(&image.box.right_px, GOE_SIDE_RIGHT);
    refuses_side(&image.box.bottom_px, GOE_SIDE_BOTTOM);
}

static void refuses_reset(void) {
    motion.time_us = 0; /* an image was taken */
    motion.reset_count = 1;
    image.pose.reset_count = 2;
    image.pose.reset_delta_known = true;
    for (int i = 0; i < 3; i++) {
        refuses(&image.pose.reset_delta_ned_m[i], 1.0e6f);
    }
}

void proof_intake_image(void) {
    ANY_BITS(motion);
    ANY_BITS(image);
    for (int i = 0; i < 3; i++) {
        refuses(&image.pose.position_ned_m[i], 1.0e6f);
    }
    refuses(&image.pose.height_m, 1.0e5f);
    for (int i = 0; i < 4; i++) {
        refuses(&image.pose.attitude[i], 2.0f);
    }
    refuses_pixels();
    refuses_reset();
}

static goe_image_noise_t noise;

static void noise_is_refused(void) {
    const goe_status_t status = goe_intake_check_noise(&noise);
    //@ check status == GOE_NOT_FINITE || status == GOE_OUT_OF_RANGE;
}

static void refuses_noise(float *field, float limit) {
    *field = Frama_C_float_interval(JUST_OVER(limit), FLT_MAX);
    noise_is_refused();
    *field = Frama_C_float_interval(-FLT_MAX, -FLT_MIN);
    noise_is_refused();
    INFINITIES(*field, noise_is_refused())
    ANY_BITS(*field);
}

void proof_intake_noise(void) {
    ANY_BITS(noise);
    refuses_noise(&noise.attitude_sd_deg, 30.0f);
    refuses_noise(&noise.height_sd_m, 1.0e3f);
    refuses_noise(&noise.pixel_sd_px, 100.0f);
}

/* ----------------------------------------------------------------------------------------------------------- settings -- */

static goe_settings_t settings;

static void settings_are_refused(void) {
    const char *bad = goe_settings_first_bad(&settings);
    //@ check bad != \null;
}

static void refuses_REAL(void *field, float low, float high) {
    float *at = field;
    *at = Frama_C_float_interval(JUST_OVER(high), FLT_MAX);
    settings_are_refused();
    *at = Frama_C_float_interval(-FLT_MAX, JUST_UNDER(low));
    settings_are_refused();
    INFINITIES(*at, settings_are_refused())
    ANY_BITS(*at);
}

static void refuses_COUNT(void *field, int low, int high) {
    int *at = field;
    *at = ANY(high + 1, INT32_MAX);
    settings_are_refused();
    *at = ANY(INT32_MIN, low - 1);
    settings_are_refused();
    ANY_BITS(*at);
}

/* The compiler may represent an enumeration as an unsigned number. */
static void refuses_CHOICE(void *field, int low, int high) {
    int *at = field;
    *at = ANY(high + 1, INT32_MAX);
    settings_are_refused();
    *at = ANY(INT32_MIN, -1);
    settings_are_refused();
    *at = ANY(0, low - 1);
    settings_are_refused();
    ANY_BITS(*at);
}

static void refuses_TRUTH(void *field, int low, int high) {
    unsigned char *at = field;
    (void)low;
    *at = (unsigned char)ANY(high + 1, 255);
    settings_are_refused();
    *at = (unsigned char)ANY(0, 255);
}

#define REFUSES(field, kind, unit, low, high, value, text) refuses_##kind(&settings.field, low, high);

void proof_settings_camera(void) {
    ANY_BITS(settings);
    GOE_SETTINGS_CAMERA(REFUSES)
}

void proof_settings_general(void) {
    ANY_BITS(settings);
    GOE_SETTINGS_GENERAL(REFUSES)
    GOE_SETTINGS_VELOCITY(REFUSES)
    GOE_SETTINGS_WINDOW(REFUSES)
}

void proof_settings_refined(void) {
    ANY_BITS(settings);
    GOE_SETTINGS_FILTER(REFUSES)
}

/* ------------------------------------------------------------------------------------------------------------ answers -- */

#define NUMBERS 37 /* more than any one run of floats in an estimate */

static float numbers[NUMBERS];

static void numbers_are_refused(void) {
    const bool finite = goe_guard_finite(numbers, NUMBERS);
    //@ check !finite;
}

/* goe_update() checks each answer before it returns: one infinity or NaN among any other bits is found, at any place. */
void proof_answer(void) {
    for (int i = 0; i < NUMBERS; i++) {
        ANY_BITS(numbers);
        NO_NUMBERS(numbers[i], numbers_are_refused())
    }
}
