/* Realistic flights, from a few numbers. SPDX-License-Identifier: MIT
 *
 * An aircraft on a swaying path, upright obstacles that may move, a camera with its lens and its mounting. Without noise except for
 * float rounding; no code is shared with the library. */
#ifndef FUZZ_SCENE_H
#define FUZZ_SCENE_H

#include "fuzz_input.h"
#include "goe.h"

typedef struct {
    float speed_m_s, climb_m_s, height_m, course_rad; /* of the mean path, height over the ground at t = 0 */
    float sway_m, sway_rad_s;                         /* to the side */
    float yaw_rad, pitch_rad, roll_rad;               /* of the body relative to the course: means ... */
    float swing_rad, swing_rad_s;                     /* ... and the amplitude of all three */
    float north_m, east_m, ground_down_m;             /* start of the path, and the ground */
} fuzz_path_t;

/* An upright box, or a cylinder of diameter width_m. */
typedef struct {
    bool round;
    float width_m, length_m, height_m, turn_rad; /* length axis from north, clockwise */
    float north_m, east_m;                       /* middle at t = 0 ... */
    float north_m_s, east_m_s;                   /* ... and its velocity */
    float ground_down_m;
} fuzz_solid_t;

/* A ring of four corners on the ground, then the same on the roof. For a cylinder: its tangents and the near and far side. */
#define FUZZ_CORNERS 8
typedef struct {
    float u_px[FUZZ_CORNERS], v_px[FUZZ_CORNERS];
    int nearest; /* index in the ring */
    bool round;
} fuzz_sight_t;

/* Paths and obstacles by the bytes; an obstacle is ahead of the path. */
fuzz_path_t fuzz_any_path(fuzz_input_t *in);
fuzz_solid_t fuzz_any_solid(fuzz_input_t *in, const fuzz_path_t *path);

/* Position, attitude and height over ground; the rest of the pose is 0. */
void fuzz_path_pose(const fuzz_path_t *path, float t_s, goe_pose_t *pose);

/* The image of a solid from that pose. False, and nothing is written, if a part of it is not well ahead. */
bool fuzz_look(const goe_camera_t *camera, const goe_pose_t *pose, const fuzz_solid_t *solid, float t_s,
               fuzz_sight_t *sight);

/* Moves a solid into the camera's line of sight, at this distance. */
void fuzz_put_ahead(const goe_camera_t *camera, const goe_pose_t *pose, float distance_m, float t_s,
                    fuzz_solid_t *solid);

/* Adds noise of this size in pixels to every corner. */
void fuzz_blur(fuzz_sight_t *sight, fuzz_noise_t *noise, float pixel_px);

/* The bounding box, cut by the image's border. */
goe_box_t fuzz_box(const goe_camera_t *camera, const fuzz_sight_t *sight);

/* left, right, top and, with `base`, base corners: the points inside the image are visible. */
void fuzz_points(const goe_camera_t *camera, const fuzz_sight_t *sight, bool base, goe_image_t *image);

#endif
