/* Noise-free flights past one upright box or cylinder on flat ground. SPDX-License-Identifier: MIT
 *
 * Written from the definitions of the frames alone and in double, independent of the library: its output
 * is exact but for the rounding of each number to float.
 *
 * The obstacle is placed in T of the first image, relative to the camera: a box by the middle of its front edge (length
 * width_m) and the angle alpha of its side edge (length length_m) from Z, clockwise as viewed from above; a cylinder by its
 * center. */
#ifndef SCENE_H
#define SCENE_H

#include "check.h"
#include "goe.h"

typedef enum { SCENE_BOX, SCENE_CYLINDER } scene_shape_t;
typedef enum { SCENE_STRAIGHT, SCENE_ARC, SCENE_WEAVE } scene_path_t;

typedef struct {
    scene_shape_t shape;
    double width_m, length_m, height_m; /* cylinder: width_m is the diameter */
    double x0_m, z0_m;                  /* x0 < 0: left of the flight path */
    double alpha_deg;
    scene_path_t path;
    double arc_radius_m;                      /* > 0 turns right */
    double weave_amplitude_m, weave_period_s; /* > 0 first to the right */
    double speed_mps, acceleration_mps2;
    double image_rate_hz;
    double course_deg; /* of the flight at the first image, clockwise from north */
    double altitude_m; /* vehicle above ground at the first image */
    double glide_deg;  /* > 0 descends */
    double yaw_deg;    /* of the nose from the course */
    double pitch_deg;  /* of the nose from the glide slope */
    double roll_deg;
    double wobble_deg; /* amplitude of an oscillation of all three attitude angles; the yaw starts at 0 */
    double roll_swing_deg, roll_swing_hz; /* amplitude and rate of a sine of the roll alone */
    double start_ned_m[2];
    double ground_d_m;
    bool upright_boxes; /* left, right, top: the middles of the sides of the upright bounding box in the raw image, as a
                           detector gives it; no base corners */
    bool boxes;         /* the upright bounding box, and no points */
    bool top_nearest;   /* top: the roof's point nearest to the camera; otherwise the highest in the image */
    goe_camera_t camera;
} scene_t;

/* What the library should find, and the aligned points that it should see. */
typedef struct {
    double x_m, z_m;              /* reference point relative to the camera now, T axes */
    double dx_m, dz_m;            /* camera since the first image, T axes */
    double height_above_ground_m; /* of the camera */
    double center_north_m, center_east_m;
    double left_x, right_x;                   /* silhouette, aligned */
    double top_y, top_z_m;                    /* aligned y, and its Z */
    double base_x[3], base_y[3], base_z_m[3]; /* left, near, right */
    bool base_visible[3];
} scene_truth_t;

/* A truck on the left of a straight level flight to the north, 1280 x 1280 pixels of 70 degrees, 8 images a second. */
void scene_default(scene_t *scene);

/* The k-th image, k >= 0. truth may be null. Points behind the camera are not visible. */
void scene_image(const scene_t *scene, int k, goe_image_t *image, scene_truth_t *truth);

/* Settings of the library's defaults with the scene's camera; the same for the paper's method. */
goe_settings_t scene_settings(const scene_t *scene);
goe_settings_t scene_window_settings(const scene_t *scene);

/* The obstacle becomes a chimney of 6 m by 30 m. */
void scene_make_cylinder(scene_t *scene);

/* The ground and the altimeter that the scenes have: level, and exact but for a constant error. */
void scene_level_ground(goe_settings_t *settings);

/* The noise that the scenes have: nothing but the rounding of their numbers is wrong. */
void scene_clear_noise(goe_settings_t *settings);

/* No point is visible; a box may be. */
void scene_hide_points(goe_image_t *image);

/* Gaussian noise on every point, visible or not. */
void scene_add_noise(goe_image_t *image, check_random_t *random, double sigma_px);

/* Brown-Conrady distortion of a normalized image point. */
void scene_distort(const goe_camera_t *camera, double x, double y, double *distorted_x, double *distorted_y);

/* The left-right mirror image of a flight to the north with the principal point at u = 0. */
scene_t scene_mirrored(const scene_t *scene);

/* The same flight with every length times scale, in the same time. */
scene_t scene_scaled(const scene_t *scene, double scale);

#endif
