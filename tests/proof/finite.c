/* Finite results for finite arguments within their ranges: analyzed with an alarm for every result that is not finite.
 * SPDX-License-Identifier: MIT */
#include <float.h>

#include "any.h"
#include "image/goe_camera.h"
#include "image/goe_intake.h"
#include "maths/goe_angle.h"
#include "maths/goe_exp.h"
#include "maths/goe_normal.h"
#include "maths/goe_rotation.h"
#include "maths/goe_time.h"
#include "window/goe_mean.h"

#define BETWEEN(low, high) Frama_C_float_interval((low), (high))
#define FINITE() BETWEEN(-FLT_MAX, FLT_MAX)
#define METERS_MAX 1.0e9f

void proof_finite_angle(void) {
    float sine;
    float cosine;
    goe_sincos_deg(BETWEEN(-720.0f, 720.0f), &sine, &cosine);
    goe_sincos_deg(BETWEEN(-1.0e6f, 1.0e6f), &sine, &cosine);
    goe_sincos_deg(BETWEEN(1000000.1f, FLT_MAX), &sine, &cosine);
    //@ check -1.1 <= sine <= 1.1 && -1.1 <= cosine <= 1.1;
    goe_sincos_deg(BETWEEN(-FLT_MAX, -1000000.1f), &sine, &cosine);
    //@ check -1.1 <= sine <= 1.1 && -1.1 <= cosine <= 1.1;
    const float folded = goe_fold_deg(BETWEEN(-269.0f, 270.0f));
    //@ check -90 <= folded <= 90;
}

void proof_finite_exp(void) {
    const float power = goe_exp(FINITE());
    //@ check 0 < power <= 1e7;
}

void proof_finite_normal(void) {
    const float below = goe_normal_below(FINITE());
    //@ check -1e-6 <= below <= 1.000001;
}

void proof_finite_rotation(void) {
    goe_camera_t camera;
    float camera_to_body[9];
    camera.mount_yaw_deg = BETWEEN(-360.0f, 360.0f);
    camera.mount_pitch_deg = BETWEEN(-360.0f, 360.0f);
    camera.mount_roll_deg = BETWEEN(-360.0f, 360.0f);
    goe_camera_mounting(&camera, camera_to_body);
}

void proof_finite_time(void) {
    int64_t from_us;
    int64_t to_us;
    ANY_BITS(from_us);
    ANY_BITS(to_us);
    const float s = goe_time_between_s(from_us, to_us, 4000000000u);
    //@ check 0 <= s <= 4001;
}

void proof_finite_mean(void) {
    goe_mean_t mean;
    ANY_BITS(mean.next);
    ANY_BITS(mean.count);
    for (int i = 0; i < GOE_WINDOW_MAX; i++) {
        mean.value[i] = BETWEEN(-METERS_MAX, METERS_MAX);
    }
    const goe_average_t average = goe_mean_add(&mean, ANY(3, GOE_WINDOW_MAX), BETWEEN(-METERS_MAX, METERS_MAX));
    //@ check \is_finite(average.mean) && \is_finite(average.variance);
    //@ check 0 <= average.variance;
}
