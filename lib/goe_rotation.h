/* Rotation matrices, row by row: r[3 * row + column]. SPDX-License-Identifier: MIT */
#ifndef GOE_ROTATION_H
#define GOE_ROTATION_H

/* Body -> NED of a Hamilton quaternion (w, x, y, z) of any non-zero norm. */
void goe_rotation_from_quaternion(const float q[4], float r[9]);

/* Rotation by yaw about z, then pitch about the new y, then roll about the newest x, in degrees. */
void goe_rotation_from_euler(float yaw_deg, float pitch_deg, float roll_deg, float r[9]);

/* product = a b; product may not overlap a or b. */
void goe_rotation_multiply(const float a[9], const float b[9], float product[9]);

/* turned = r v; turned may not overlap v. */
void goe_rotation_apply(const float r[9], const float v[3], float turned[3]);

#endif
