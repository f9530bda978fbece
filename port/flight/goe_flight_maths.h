/* Finite numbers, angles and rotations of the flight layer. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_MATHS_H
#define GOE_FLIGHT_MATHS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define GOE_FLIGHT_DEG_PER_RAD 57.2957795f
#define GOE_FLIGHT_RAD_PER_DEG 0.0174532925f
#define GOE_FLIGHT_S_PER_US 1.0e-6f
#define GOE_FLIGHT_COURSE_MIN_M_S 1.0f /* a slower aircraft has no course */

/* Bits of |x|. They have the same order as the magnitudes, and may be compared under -ffast-math even if x is NaN or infinite. */
static inline uint32_t goe_flight_magnitude(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & 0x7FFFFFFFu;
}

static inline bool goe_flight_finite(float x) { return goe_flight_magnitude(x) < 0x7F800000u; }

/* |x| <= limit; false for NaN and infinity. */
static inline bool goe_flight_within(float x, float limit) {
    return goe_flight_magnitude(x) <= goe_flight_magnitude(limit);
}

static inline float goe_flight_absolute(float x) { return x < 0.0f ? -x : x; }
static inline float goe_flight_larger(float a, float b) { return a > b ? a : b; }
static inline float goe_flight_smaller(float a, float b) { return a < b ? a : b; }
static inline float goe_flight_square(float x) { return x * x; }
static inline float goe_flight_clamped(float x, float least, float most) {
    return x > least ? goe_flight_smaller(x, most) : least;
}

/* Return whether all `count` numbers are finite, or within the limit. */
bool goe_flight_all_finite(const float *numbers, int count);
bool goe_flight_all_within(const float *numbers, int count, float limit);

/* a - b in microseconds of a clock that wraps, for times less than half an hour apart. */
static inline int32_t goe_flight_between_us(uint32_t a, uint32_t b) {
    const uint32_t span = a - b;
    return span <= 0x7FFFFFFFu ? (int32_t)span : -(int32_t)(0xFFFFFFFFu - span) - 1;
}

static inline float goe_flight_between_s(uint32_t a, uint32_t b) {
    const int32_t span_us = goe_flight_between_us(a, b);
    return (float)span_us * GOE_FLIGHT_S_PER_US;
}

/* Returns whether the caller's bool is set; a byte that is neither 0 nor 1 counts as set. */
static inline bool goe_flight_is_set(const bool *truth) { return *(const unsigned char *)truth != 0u; }

/* Increments a counter that saturates. */
static inline void goe_flight_count(uint16_t *counter) {
    *counter = *counter < UINT16_MAX ? (uint16_t)(*counter + 1) : *counter;
}

/* Angle of (y, x) in degrees, -180 to 180, 0 for (0, 0). Error at most 3e-5 degrees. */
float goe_flight_atan2_deg(float y, float x);

/* Sine and cosine of |deg| <= 1e4. Error at most 1e-6. An angle beyond 1e6, or not finite, counts as 0, also in the next function. */
void goe_flight_sincos_deg(float angle_deg, float *sine, float *cosine);

/* The angle in [0, 360), for |deg| <= 1e4. */
float goe_flight_positive_deg(float angle_deg);

/* Rotation matrix from body to NED, row by row, of a quaternion of norm 1. */
void goe_flight_rotation(const float q[4], float r[9]);

/* turned = r v, and turned = r^T v; turned must not overlap v. */
void goe_flight_turn(const float r[9], const float v[3], float turned[3]);
void goe_flight_turn_back(const float r[9], const float v[3], float turned[3]);

#endif
