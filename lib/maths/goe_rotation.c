/* Rotation matrix from yaw, pitch and roll. SPDX-License-Identifier: MIT */
#include "maths/goe_rotation.h"

#include "maths/goe_angle.h"

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
