/* Flights that make sense, from a few numbers. SPDX-License-Identifier: MIT
 *
 * An aircraft on a swaying path, upright obstacles that may move, a camera with its lens and its mounting. Noise-free but for
 * float; nothing is shared with the library. */
#ifndef FUZZ_SCENE_H
#define FUZZ_SCENE_H

#include "fuzz_input.h"
#include "goe.h"

typedef struct {
    float speed_m_s, climb_m_s, height_m, course_rad; /* of the mean path, height over the ground at t = 0 */
    float sway_m, sway_rad_s;                         /* to the side */
    float yaw_rad, pitch_rad, roll_rad;               /* of the body from the course: means ... */
    float swing_rad, swing_rad_s;                     /* ... and what all three swing by */
    float north_m, east_m, ground_down_m;             /* where it begins, and the ground */
} fuzz_path_t;

/* An upright box, or a cylinder of diameter width_m. */
typedef struct {
    bool round;
    float width_m, length_m, height_m, turn_rad; /* length axis from north, clockwise */
    float north_m, east_m;                       /* middle at t = 0 ... */
    float north_m_s, east_m_s;                   /* ... and its velocity */
    float ground_down_m;
} fuzz_solid_t;

/* A ring of four corners on the ground, then the same on the roof. Of a cylinder: its tangents and the near and far side. */
#define FUZZ_CORNERS 8
typedef struct {
    float u_px[FUZZ_CORNERS], v_px[FUZZ_CORNERS];
    int nearest; /* of the ring */
    bool round;
} fuzz_sight_t;

/* Paths and obstacles that bytes ask for; an obstacle lies ahead of the path. */
fuzz_path_t fuzz_any_path(fuzz_input_t *in);
fuzz_solid_t fuzz_any_solid(fuzz_input_t *in, const fuzz_path_t *path);

/* Position, attitude and height over ground; the rest of the pose is 0. */
void fuzz_path_pose(const fuzz_path_t *path, float t_s, goe_pose_t *pose);

/* Where a solid is seen from there; false, and nothing written, if a part of it is not well ahead. */
bool fuzz_look(const goe_camera_t *camera, const goe_pose_t *pose, const fuzz_solid_t *solid, float t_s,
               fuzz_sight_t *sight);

/* Moves a solid to where the camera looks, so far away. */
void fuzz_put_ahead(const goe_camera_t *camera, const goe_pose_t *pose, float distance_m, float t_s,
                    fuzz_solid_t *solid);

/* Noise of so many pixels on every corner. */
void fuzz_blur(fuzz_sight_t *sight, fuzz_noise_t *noise, float pixel_px);

/* The bounding box, cut by the image's border. */
goe_box_t fuzz_box(const goe_camera_t *camera, const fuzz_sight_t *sight);

/* left, right, top and, if asked for, base corners: what lies in the image is seen. */
void fuzz_points(const goe_camera_t *camera, const fuzz_sight_t *sight, bool base, goe_image_t *image);

#endif
