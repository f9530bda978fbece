/*
 * Pinhole camera with Brown-Conrady lens on an aircraft, in OpenCV's conventions: camera axes x right, y down, z along
 * the optical axis; the center of the top left pixel is (0, 0), so the image covers -0.5 <= u < width - 0.5.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_CAMERA_MODEL_H
#define SIM_CAMERA_MODEL_H

#include <stdbool.h>

#include "rotation.h"

#define CAMERAS_MAX 2
#define CAMERA_NEAREST_M 1e-3 /* a point nearer to the image plane has no image */

typedef struct {
    double width_px, height_px;
    double fx_px, fy_px, cx_px, cy_px;
    double k1, k2, p1, p2, k3;
    double mount_roll_deg, mount_pitch_deg, mount_yaw_deg; /* applied yaw, pitch, roll; negative yaw looks left */
    vec3_t offset_m;                                       /* of the camera from the pose's reference, body FRD */
    double lens_radius2; /* square of the undistorted radius up to which the lens model maps outwards; set by
                           camera_prepare */
} camera_t;

typedef struct {
    vec3_t position_ned_m;
    quat_t attitude; /* body -> NED */
} pose_t;

/* A camera in the world: where it is and how NED turns into its axes. */
typedef struct {
    vec3_t eye_ned_m;
    mat3_t ned_to_camera;
} view_t;

/* The paper's: 1280 x 1280 px, f = 914 px (70 degrees), looking 30 degrees to the left; ready to use. */
camera_t camera_default(void);

/* To be called after any change of the lens. */
void camera_prepare(camera_t *camera);

/* Null if the camera can be used, otherwise the name of the invalid value. */
const char *camera_fault(const camera_t *camera);

view_t camera_view(const camera_t *camera, const pose_t *pose);

/* Pixel of a point. False: the point is behind the image plane or outside the field in which the lens model holds; u_px is
 * then -HUGE_VAL or HUGE_VAL, the side of the image on which the point lies, and v_px is 0. */
bool camera_project(const camera_t *camera, const view_t *view, vec3_t point_ned_m, double *u_px, double *v_px);

/* Whether straight lines are straight in its images. */
bool camera_has_lens(const camera_t *camera);

bool camera_in_image(const camera_t *camera, double u_px, double v_px);

#endif
