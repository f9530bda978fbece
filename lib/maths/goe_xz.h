/* Horizontal vectors as viewed from above: X to the right, Z ahead. SPDX-License-Identifier: MIT */
#ifndef GOE_XZ_H
#define GOE_XZ_H

typedef struct {
    float x, z;
} goe_xz_t;

static inline float goe_xz_dot(goe_xz_t a, goe_xz_t b) { return a.x * b.x + a.z * b.z; }

static inline goe_xz_t goe_xz_negative(goe_xz_t v) {
    const goe_xz_t negative = {-v.x, -v.z};
    return negative;
}

/* Coordinates of the same vector in axes turned by the angle of c, s, clockwise as viewed from above. */
static inline goe_xz_t goe_xz_into(goe_xz_t v, float c, float s) {
    const goe_xz_t turned = {c * v.x - s * v.z, s * v.x + c * v.z};
    return turned;
}

/* The inverse of goe_xz_into(). */
static inline goe_xz_t goe_xz_out_of(goe_xz_t v, float c, float s) {
    const goe_xz_t turned = {c * v.x + s * v.z, c * v.z - s * v.x};
    return turned;
}

#endif
