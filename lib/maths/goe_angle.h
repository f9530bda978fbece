/* Arctangent, sine and cosine without a C library: the same bits on every target. SPDX-License-Identifier: MIT */
#ifndef GOE_ANGLE_H
#define GOE_ANGLE_H

#define GOE_DEG_PER_RAD 57.2957795f
#define GOE_RAD_PER_DEG 0.0174532925f

/* Arctangent of y/x in radians, -pi/2 to pi/2, for x >= 0 and not both zero. Error at most 2e-7 rad. */
float goe_arctan_rad(float y, float x);

/* Sine and cosine of an angle in degrees. An angle beyond 1e6, or not finite, counts as 0. Error at most 2e-7 for |deg| <= 720. */
void goe_sincos_deg(float angle_deg, float *sine, float *cosine);

/* The angle of the same undirected line in (-90, 90] degrees, for -270 < deg <= 270. */
static inline float goe_fold_deg(float deg) {
    if (deg > 90.0f) {
        return deg - 180.0f;
    }
    return deg <= -90.0f ? deg + 180.0f : deg;
}

#endif
