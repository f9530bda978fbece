/*
 * Vectors, rotations and angles of the simulator, in double precision.
 *
 * Quaternions are Hamilton, (w, x, y, z), and turn body axes into north-east-down, as everywhere in goe.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_ROTATION_H
#define SIM_ROTATION_H

#define SIM_PI 3.14159265358979323846

typedef struct {
    double x, y, z;
} vec3_t;

typedef struct {
    double w, x, y, z;
} quat_t;

typedef struct {
    double m[3][3];
} mat3_t;

double degrees(double radians_in);
double radians(double degrees_in);
double clamp(double value, double low, double high);
double wrap_pi(double radians_in); /* into [-pi, pi] */

vec3_t vec3_add(vec3_t a, vec3_t b);
vec3_t vec3_sub(vec3_t a, vec3_t b);
vec3_t vec3_scale(vec3_t a, double factor);
double vec3_norm(vec3_t a);

vec3_t mat3_apply(const mat3_t *m, vec3_t v);
vec3_t mat3_apply_transposed(const mat3_t *m, vec3_t v);
mat3_t mat3_multiply(const mat3_t *a, const mat3_t *b);
mat3_t mat3_transpose(const mat3_t *m);

quat_t quat_from_euler(double roll, double pitch, double yaw); /* applied yaw, pitch, roll (Z-Y'-X''), radians */
void quat_to_euler(quat_t q, double *roll, double *pitch, double *yaw);
quat_t quat_from_rotation_vector(vec3_t angle); /* radians about each axis */
quat_t quat_multiply(quat_t a, quat_t b);
quat_t quat_normalized(quat_t q);
mat3_t quat_to_matrix(quat_t q);
quat_t quat_interpolate(quat_t a, quat_t b, double fraction); /* the short way round, of constant speed */

#endif
