/* Rotation matrices, stored row by row: r[3 * row + column]. SPDX-License-Identifier: MIT */
#ifndef GOE_ROTATION_H
#define GOE_ROTATION_H

/* Rotation body -> NED from a Hamilton quaternion (w, x, y, z) of any non-zero norm. */
static inline void goe_rotation_from_quaternion(const float q[4], float r[9]) {
    const float w = q[0];
    const float x = q[1];
    const float y = q[2];
    const float z = q[3];
    /* 2/|q|^2 instead of 2 normalizes without a square root */
    const float s = 2.0f / (w * w + x * x + y * y + z * z);
    r[0] = 1.0f - s * (y * y + z * z);
    r[1] = s * (x * y - w * z);
    r[2] = s * (x * z + w * y);
    r[3] = s * (x * y + w * z);
    r[4] = 1.0f - s * (x * x + z * z);
    r[5] = s * (y * z - w * x);
    r[6] = s * (x * z - w * y);
    r[7] = s * (y * z + w * x);
    r[8] = 1.0f - s * (x * x + y * y);
}

/* Rotation by yaw about z, then by pitch about the rotated y, then by roll about the x that both rotated, in degrees. */
void goe_rotation_from_euler(float yaw_deg, float pitch_deg, float roll_deg, float r[9]);

/* turned = r v; turned must not overlap v. */
/*@ requires \valid_read(r + (0 .. 8)) && \valid_read(v + (0 .. 2)) && \valid(turned + (0 .. 2));
    requires \separated(turned + (0 .. 2), r + (0 .. 8), v + (0 .. 2)); */
static inline void goe_rotation_apply(const float r[9], const float v[3], float turned[3]) {
    turned[0] = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
    turned[1] = r[3] * v[0] + r[4] * v[1] + r[5] * v[2];
    turned[2] = r[6] * v[0] + r[7] * v[1] + r[8] * v[2];
}

#endif
