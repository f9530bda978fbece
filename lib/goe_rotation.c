/* Rotations. SPDX-License-Identifier: MIT */
#include "goe_rotation.h"

#include "goe_angle.h"

void goe_rotation_from_quaternion(const float q[4], float r[9]) {
    const float w = q[0];
    const float x = q[1];
    const float y = q[2];
    const float z = q[3];
    /* 2/|q|^2 instead of 2 normalises without a square root */
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

void goe_rotation_from_euler(float yaw_deg, float pitch_deg, float roll_deg, float r[9]) {
    float sy;
    float cy;
    float sp;
    float cp;
    float sr;
    float cr;
    goe_sincos_deg(yaw_deg, &sy, &cy);
    goe_sincos_deg(pitch_deg, &sp, &cp);
    goe_sincos_deg(roll_deg, &sr, &cr);
    r[0] = cy * cp;
    r[1] = cy * sp * sr - sy * cr;
    r[2] = cy * sp * cr + sy * sr;
    r[3] = sy * cp;
    r[4] = sy * sp * sr + cy * cr;
    r[5] = sy * sp * cr - cy * sr;
    r[6] = -sp;
    r[7] = cp * sr;
    r[8] = cp * cr;
}

void goe_rotation_multiply(const float a[9], const float b[9], float product[9]) {
    for (int row = 0; row < 9; row += 3) { /* the inner loop is written out: half the instructions */
        const float x = a[row];
        const float y = a[row + 1];
        const float z = a[row + 2];
        product[row] = x * b[0] + y * b[3] + z * b[6];
        product[row + 1] = x * b[1] + y * b[4] + z * b[7];
        product[row + 2] = x * b[2] + y * b[5] + z * b[8];
    }
}

void goe_rotation_apply(const float r[9], const float v[3], float turned[3]) {
    for (int row = 0; row < 3; row++) {
        turned[row] = r[3 * row] * v[0] + r[3 * row + 1] * v[1] + r[3 * row + 2] * v[2];
    }
}
