/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "rotation.h"

#include <math.h>

/* Below this angle (radians) the arc and its chord agree to rounding, and sin(angle) is not divided by. */
#define SMALL_ANGLE 1e-9

double degrees(double radians_in) { return radians_in * (180.0 / SIM_PI); }

double radians(double degrees_in) { return degrees_in * (SIM_PI / 180.0); }

double clamp(double value, double low, double high) { return value < low ? low : (value > high ? high : value); }

double wrap_pi(double radians_in) { return remainder(radians_in, 2.0 * SIM_PI); }

vec3_t vec3_add(vec3_t a, vec3_t b) {
    vec3_t sum = {a.x + b.x, a.y + b.y, a.z + b.z};
    return sum;
}

vec3_t vec3_sub(vec3_t a, vec3_t b) {
    vec3_t difference = {a.x - b.x, a.y - b.y, a.z - b.z};
    return difference;
}

vec3_t vec3_scale(vec3_t a, double factor) {
    vec3_t scaled = {a.x * factor, a.y * factor, a.z * factor};
    return scaled;
}

double vec3_norm(vec3_t a) { return sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

vec3_t mat3_apply(const mat3_t *m, vec3_t v) {
    vec3_t r = {m->m[0][0] * v.x + m->m[0][1] * v.y + m->m[0][2] * v.z,
                m->m[1][0] * v.x + m->m[1][1] * v.y + m->m[1][2] * v.z,
                m->m[2][0] * v.x + m->m[2][1] * v.y + m->m[2][2] * v.z};
    return r;
}

vec3_t mat3_apply_transposed(const mat3_t *m, vec3_t v) {
    vec3_t r = {m->m[0][0] * v.x + m->m[1][0] * v.y + m->m[2][0] * v.z,
                m->m[0][1] * v.x + m->m[1][1] * v.y + m->m[2][1] * v.z,
                m->m[0][2] * v.x + m->m[1][2] * v.y + m->m[2][2] * v.z};
    return r;
}

mat3_t mat3_multiply(const mat3_t *a, const mat3_t *b) {
    mat3_t product;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            product.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        }
    }
    return product;
}

mat3_t mat3_transpose(const mat3_t *m) {
    mat3_t t;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            t.m[i][j] = m->m[j][i];
        }
    }
    return t;
}

quat_t quat_from_euler(double roll, double pitch, double yaw) {
    const double cr = cos(0.5 * roll), sr = sin(0.5 * roll);
    const double cp = cos(0.5 * pitch), sp = sin(0.5 * pitch);
    const double cy = cos(0.5 * yaw), sy = sin(0.5 * yaw);
    quat_t q = {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
                sy * cp * cr - cy * sp * sr};
    return q;
}

void quat_to_euler(quat_t q, double *roll, double *pitch, double *yaw) {
    *roll = atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    *pitch = asin(clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0));
    *yaw = atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

quat_t quat_from_rotation_vector(vec3_t angle) {
    const double norm = vec3_norm(angle);
    const double factor = norm < SMALL_ANGLE ? 0.5 : sin(0.5 * norm) / norm;
    quat_t q = {cos(0.5 * norm), factor * angle.x, factor * angle.y, factor * angle.z};
    return q;
}

quat_t quat_multiply(quat_t a, quat_t b) {
    quat_t q = {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
    return q;
}

quat_t quat_normalized(quat_t q) {
    const double scale = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    quat_t unit = {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
    return unit;
}

mat3_t quat_to_matrix(quat_t q) {
    const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    mat3_t m = {{{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
                 {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
                 {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}}};
    return m;
}

quat_t quat_interpolate(quat_t a, quat_t b, double fraction) {
    double cosine = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
    const double sign = cosine < 0.0 ? -1.0 : 1.0; /* q and -q are the same attitude */
    cosine = fmin(sign * cosine, 1.0);
    const double angle = acos(cosine);
    double share_a = 1.0 - fraction, share_b = fraction;
    if (angle > SMALL_ANGLE) {
        share_a = sin((1.0 - fraction) * angle) / sin(angle);
        share_b = sin(fraction * angle) / sin(angle);
    }
    share_b *= sign;
    quat_t q = {share_a * a.w + share_b * b.w, share_a * a.x + share_b * b.x, share_a * a.y + share_b * b.y,
                share_a * a.z + share_b * b.z};
    return quat_normalized(q);
}
