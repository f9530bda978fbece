/*
 * goe - Ground Obstacle Estimator
 *
 * A camera views a building, truck or chimney, which stands still or moves straight. From its features in the images and the
 * motion of the aircraft, goe estimates the obstacle's position, size and orientation, each with a 1-sigma uncertainty. [A1] It
 * also predicts the closest approach and decides when to act.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 *     static goe_estimator_t estimator;
 *     goe_settings_t settings;
 *     goe_settings_default(&settings);
 *     settings.camera.fx_px = settings.camera.fy_px = 914.0f;
 *     settings.camera.cx_px = settings.camera.cy_px = 640.0f;
 *     settings.camera.width_px = settings.camera.height_px = 1280.0f;
 *     if (goe_init(&estimator, sizeof estimator, &settings, NULL) != GOE_OK) {
 *         return;
 *     }
 *     goe_image_t image = {0};
 *     double taken_s = 0.0;
 *     while (tenth_of_a_second_passed()) {
 *         if (next_image(&image.pose, &image.box)) {
 *             goe_estimate_t estimate;
 *             taken_s = GOE_IMAGE_TAKEN(goe_update(&estimator, &image, &estimate)) ? exposure_s() : taken_s;
 *         }
 *         const float since_s = (float)(now_s() - taken_s);
 *         const goe_intent_t intent = {{20.0f, 0.0f, 1.0f}, 15.0f, 10.0f, since_s, 0.0f};
 *         const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
 *         go_around = decision == GOE_DECISION_ACT || (go_around && decision != GOE_DECISION_CLEAR);
 *     }
 *
 * Order of calls: goe_settings_default, goe_init; then goe_update for every image, and goe_decide or goe_hazard at 5 to 50 Hz,
 * because a camera may stop. Call goe_reset before another obstacle. goe.h includes goe_limits.h (compile-time options),
 * goe_settings.h, goe_hazard.h, goe_class.h and goe_diagnostics.h (self-check). See DESIGN.md and GLOSSARY.md.
 *
 * Frames
 *   earth       north, east, down (NED), meters, local, any origin
 *   body        forward, right, down (FRD); the attitude is a Hamilton quaternion (w, x, y, z), body to NED
 *   camera      x right, y down, z along the optical axis; pixel (u, v) = (right, down) from the top left corner
 *   trajectory  "T": X right, Y down, Z forward along the flight direction. T is ALWAYS LEVEL, also on a glide slope. [A4]
 *               X0 and Z0 count from the camera at the track's first image with a feature, X and Z from the camera now. By
 *               default Z has the nose's heading at that first image. In a crosswind the course differs from that heading:
 *               set heading_auto to false and heading_deg to define T exactly
 *
 *   view from above, north up; the aircraft flies along Z; an obstacle on its left has X < 0
 *
 *                      ______________                  orientation: angle of the SIDE edge (length L) from Z,
 *                     /             /                               clockwise from above, -90 < b <= 90 degrees
 *                    /             / side              width W:     the FRONT edge, more across Z than along
 *                   /  front      /  (length L)        length L:    the SIDE edge
 *                  /_____________/                     reference point of each model (goe_model_t):
 *                        ^   near corner                 disc, prism  the center
 *                        |                               line, box    the middle of the front edge
 *            reference point (X0, Z0)
 *                        .          Z forward
 *                          .        ^
 *                            .      |
 *                              .    o-----> X right
 *                                 camera
 *
 *   Example: the aircraft is at north 0, east 0, heading north; a chimney of 6 m diameter is at north 200, east -30. Then
 *   Z0 = 200 m, X0 = -30 m, width = 6 m. After 50 m of flight, Z = 150 m.
 *
 * Memory      The caller owns goe_estimator_t, which contains all state: at most 2.1 KiB with default options. [A9] The
 *             library uses no heap, static variables or recursion. [A10] Each obstacle has its own estimator and decision.
 * Threads     A function accesses only its arguments' memory. Threads may share an estimator under the caller's lock. [A11]
 * Arithmetic  The library uses float, sqrtf, memcpy and memset only. [A12] With -ffp-contract=off all IEEE 754 targets
 *             compute the same bits. [A13]
 * Failure     A call with a negative status changes only counters and the age that goe_decide() uses. The exceptions are each
 *             status that says "image taken", and GOE_CORRUPTED of goe_update(). [A21] Every output is finite. [A16] A quantity
 *             without its bit in goe_estimate_t.valid means nothing. Non-finite input is refused, also under -ffast-math. [A17]
 * Cost        Each function states its highest cost on a Cortex-M4F with gcc -O2 -fno-math-errno -ffp-contract=off, one camera and 8
 *             images in the window method (GOE_WINDOW_MAX). Both are proved: instructions (not cycles), bytes of stack. [A23]
 */
#ifndef GOE_H
#define GOE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GOE_VERSION_MAJOR 0
#define GOE_VERSION_MINOR 4
#define GOE_VERSION_PATCH 0

#include "goe_limits.h"
#include "goe_settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------- status -- */

/* Result of an image or of a call. GOE_OK and GOE_PARTIAL mean a new solution. The other positive statuses mean no new
 * solution, but no fault. The negative ones mean a fault and no new solution. "Image taken" means that goe stored the image:
 * later images build on it. Numbers above 4, -16 to -31 and below -35 are unused. [A25] */
typedef enum {
    GOE_OK = 0,           /* new solution from this image and earlier ones; a call: success */
    GOE_PARTIAL = 1,      /* new solution, but part of the image was refused or unusable: see fault_counts */
    GOE_CONVERGING = 2,   /* image taken; no solution yet: few images, or sigma of the range above range_sd_rel_max */
    GOE_STALE = 3,        /* image taken; adds nothing or comes too soon; earlier solution remains */
    GOE_NO_DETECTION = 4, /* image taken for its pose: no feature is visible. Not a fault */
    /* faults of a feature; the image is taken */
    GOE_BEHIND_CAMERA = -1, /* a ray points backward or sideways: its third component in T is <= 0.05 of its norm */
    GOE_LENS_FAILED = -2,   /* a pixel is too far from the axis: the inversion of the lens model does not converge */
    GOE_SWAPPED = -3,       /* points or box sides are out of order, or (window) left is within 1e-4 focal lengths of right */
    GOE_EDGE_ON = -4,       /* no length: the camera views the front edge from its end or from behind */
    GOE_NO_EDGE = -5,       /* model line: no edge reaches both window.edge_min_px and orientation_min_px */
    GOE_BAD_HEIGHT = -6,    /* window: no obstacle height, because the camera's height is <= 0. Counted, never returned */
    /* faults of the window's solution; the image is taken */
    GOE_NO_BASELINE = -7, /* the camera moved less than window.min_baseline_m */
    GOE_NO_PARALLAX = -8, /* the obstacle does not grow in the images: it moves, is not ahead, or noise prevails */
    GOE_ABEAM = -9,       /* the solution is abeam or behind: Z <= 0 */
    /* faults of an image; the image is refused */
    GOE_NOT_FINITE = -10,   /* a NaN or an infinity in the pose or in a visible feature */
    GOE_OUT_OF_RANGE = -11, /* a number outside the range stated at its field */
    GOE_BAD_TIME = -12,     /* the time is unknown, repeated or runs backward. After a false jump ahead call goe_reset */
    GOE_BAD_ATTITUDE = -13, /* the quaternion's norm differs from 1 by more than 1 % */
    /* faults of a box; the image is taken */
    GOE_BOX_INCOMPLETE = -14, /* fewer than two sides are in box.sides and not at the image border */
    GOE_NO_HEIGHT = -15,      /* filter: height_m is exactly 0 with a box; goe treats it as unknown, sigma 1000 m */
    /* faults of a call */
    GOE_BAD_SETTINGS = -32,    /* goe_init: the setting bad_field is outside its range */
    GOE_BAD_ARGUMENT = -33,    /* a null pointer, or an estimator size that differs from the library's */
    GOE_NOT_INITIALIZED = -34, /* goe_init has not succeeded */
    GOE_CORRUPTED = -35        /* the memory was changed from outside. Not "safe": keep the last warning. If goe_reset
                                * returns it, too, the settings have changed: call goe_init */
} goe_status_t;

/* goe_estimator_t.fault_counts[-status] counts the faults GOE_BEHIND_CAMERA to GOE_NO_HEIGHT. fault_counts[0] counts resets of
 * unknown size and jumps without a reset. Counters saturate. */
#define GOE_FAULT_COUNTS 16

/* Whether goe_update() took the image: bit 35 + status, set for -15, -14 and -9 to 4. Of a refused image goe stores only
 * the time. If its reset_count changed, set reset_delta_ned_m again in the next image. */
#define GOE_IMAGE_TAKEN(status) ((((uint64_t)0xFFFC300000 >> (((unsigned)(status) + 35u) & 63u)) & 1u) != 0u)

/* ----------------------------------------------------------------------------------------------------------- image -- */

#define GOE_TIME_UNKNOWN INT64_MIN

/* Pose of the aircraft AT THE TIME OF EXPOSURE. A jump of the autopilot's filter is not motion. [A27] Supply the filter's reset
 * counter and, if known, the jump: new minus old position, summed since the last image that was taken. A jump of unknown size,
 * also of attitude, starts a new track. height_m may jump or not. The filter compensates single, horizontal, unannounced jumps. */
typedef struct {
    int64_t time_us;         /* any origin; increases (equal: by camera number); not GOE_TIME_UNKNOWN */
    float position_ned_m[3]; /* the vehicle's reference point, each +-1e6; choose an origin within 10 km */
    float height_m;          /* camera above the ground at the obstacle, +-1e5. Exactly 0 means "not set", except with
                              * points alone. goe averages readings and moves the height by changes of down; window:
                              * each reading as it is */
    float attitude[4];       /* quaternion w, x, y, z from body FRD to NED; its norm is 1 within 1 % */
    uint8_t reset_count;     /* reset counter of the autopilot's filter; it may wrap */
    bool reset_delta_known;  /* whether reset_delta_ned_m is set; read only after a change of reset_count */
    float reset_delta_ned_m[3]; /* jump of position_ned_m, each +-1e6 */
} goe_pose_t;

/* An image point in raw pixels, each +-1e5. goe reads it only if visible is true. */
typedef struct {
    float u_px, v_px;
    bool visible;
} goe_pixel_t;

/* A detector's upright bounding box in raw pixels. Do not supply a tracker's smoothed boxes: they lag. */
typedef struct {
    float left_px, top_px, right_px, bottom_px; /* read only with its bit in sides; each +-1e5; left < right, top < bottom */
    uint8_t sides; /* GOE_SIDE_...; 0: no box. Bits: sides not cut, hidden or unreliable; all if the box fills the image */
} goe_box_t;

#define GOE_SIDE_LEFT 0x01u
#define GOE_SIDE_TOP 0x02u
#define GOE_SIDE_RIGHT 0x04u
#define GOE_SIDE_BOTTOM 0x08u
#define GOE_SIDES_ALL 0x0Fu /* all four */

/* Errors of this image alone, one sigma each, for the filter method. With 0 the setting applies. */
typedef struct {
    float attitude_sd_deg; /* replaces navigation.attitude_white_sd_deg; 0 to 30 */
    float height_sd_m;     /* replaces navigation.height_bias_sd_m, in the first image of a track with a height; 0 to 1e3 */
    float pixel_sd_px;     /* replaces detector.point_noise_px and box_noise_px; 0 to 100 */
} goe_image_noise_t;

#include "goe_class.h"
/* One image of one obstacle: a box, points or both, with any subset of the features.
 * Box: it replaces the points left, right and top. The box model ignores its bottom. [A29]
 * Points: supply left and right for a disc or prism, two or three base corners for a line or a box, and top for the height. Do not
 * supply the middles of a box's sides as points: when the camera rolls, the estimated width is too large. */
typedef struct {
    goe_pose_t pose;
    goe_pixel_t left, right; /* leftmost and rightmost point of the silhouette */
    goe_pixel_t top;         /* point of the roof's edge above the nearest base corner; disc: nearest point of the upper rim */
    goe_pixel_t base_left, base_near, base_right; /* corners of the base on the ground, in image order; base_near is
                                                   * between two visible faces */
    goe_box_t box;
    goe_image_noise_t noise;
    goe_kind_t kind;
    uint8_t camera; /* number of the camera; GOE_OUT_OF_RANGE if no camera has it */
} goe_image_t;

/* -------------------------------------------------------------------------------------------------------- estimate -- */

/* Bits of goe_estimate_t.valid. A quantity without its bit is 0 and means nothing. */
#define GOE_HAS_POSITION 0x01u    /* x0, z0, x, z, residual, baseline */
#define GOE_HAS_LENGTH 0x02u      /* length: a line or box whose side edge is visible */
#define GOE_HAS_HEIGHT 0x04u      /* height */
#define GOE_HAS_ORIENTATION 0x08u /* orientations and axes */
#define GOE_HAS_CENTER 0x10u      /* center: a disc or prism, or a line or box with length */
#define GOE_HAS_WIDTH 0x20u       /* width */
#define GOE_HAS_VELOCITY 0x40u    /* velocity: the obstacle moves, and the filter estimates its velocity */

/* One sigma of each quantity, in its unit. Filter: the sigma of the true error, if the settings describe the sensors. Window:
 * the sigma from residuals alone, without the constant errors of attitude and height. [A32] */
typedef struct {
    float x0_m, z0_m, x_m, z_m, width_m, length_m, height_m, orientation_deg, center_north_m, center_east_m;
    float velocity_north_m_s, velocity_east_m_s, latency_s;
} goe_sigma_t;

/* The most significant reason why an estimate is suspect. Filter method only. */
typedef enum {
    GOE_REASON_NONE,
    GOE_REASON_CONVENTION, /* the filter restarted twice within 24 images: the inputs contradict each other (axes, signs,
                            * order of the quaternion, mounting, time) */
    GOE_REASON_MOVES,      /* the obstacle moves, or inputs contradict each other. Without GOE_HAS_VELOCITY the reported position is wrong */
    GOE_REASON_BASE,       /* the points supplied as base corners are other points; the filter no longer uses them */
    GOE_REASON_SHAPE,      /* the obstacle has another shape or size than the settings or goe_image_t.kind state */
    GOE_REASON_LATE,       /* poses are late or early by latency_s. The filter corrects this; suspect may be false */
    GOE_REASON_NOISE       /* errors exceed the settings, or the obstacle has another shape */
} goe_reason_t;

typedef struct {
    goe_method_t method;   /* method of this estimate; 0 if none */
    goe_model_t model;     /* model of position, sizes and center */
    unsigned valid;        /* mask of GOE_HAS_... */
    bool fresh;            /* position and width are solved from the latest image; false: stale, from an earlier image */
    bool suspect;          /* filter: residuals do not fit; sigmas may be too small. Widen margins, keep warnings */
    goe_reason_t reason;   /* most significant reason */
    int images_used;       /* number of images, 0 to 32767 */
    float age_s;           /* time since the image of the last solution; 0 to 4000 */
    float x0_m, z0_m;      /* reference point relative to the camera at the track's first image, T axes */
    float x_m, z_m;        /* reference point relative to the camera at the latest image, also if stale */
    float width_m;         /* disc: diameter; line, box: length of the front edge; prism: across the first line of sight */
    float length_m;        /* length of the side edge */
    float height_m;        /* top above the ground */
    float orientation_deg; /* angle of the side edge (length axis) from Z, clockwise from above, -90 < b <= 90 */
    float orientation_raw_deg;   /* window: orientation from the latest image alone; filter: orientation_deg */
    float front_orientation_deg; /* angle of the front edge (width axis) from Z */
    float length_axis[2], width_axis[2]; /* unit vectors (X, Z) along the side edge, and 90 degrees right of it */
    float length_axis_ne[2], width_axis_ne[2]; /* the same unit vectors in (north, east) */
    float trajectory_heading_deg; /* heading of Z, clockwise from north, -180 to 180; constant over the track */
    float center_north_m, center_east_m; /* middle of the base in the NED frame of the latest pose ... */
    float center_ne_m2;                  /* ... and the covariance of north and east */
    float velocity_north_m_s, velocity_east_m_s; /* velocity of a moving obstacle */
    float latency_s;  /* filter: delay of the poses relative to the images (corrected) */
    float residual;   /* window: RMS residual of the least-squares fit; filter: 0 */
    float baseline_m; /* window: spread of the camera's path; filter: distance of the camera from the track's start */
    float nis;        /* filter: normalized innovation squared of the latest image ... */
    int nis_rows;     /* ... and its expected value */
    float nis_ratio;  /* filter: running mean of nis / nis_rows over 64 images; 1 if the settings are correct */
    goe_sigma_t sigma;
} goe_estimate_t;

/* The estimator's memory. All fields are private, except fault_counts. [A33] */
#include "goe_state.h"

/* ------------------------------------------------------------------------------------------------------- functions -- */

/* Sets the defaults for a small aircraft's sensors. Set fx_px, fy_px, cx_px, cy_px, width_px, height_px yourself. settings may be null.
 * Cost: at most 1010 instructions, 40 bytes of stack. */
void goe_settings_default(goe_settings_t *settings);

/* Checks and copies *settings. The track is then empty, and all counters are 0.
 *   estimator_size  sizeof(goe_estimator_t) as the caller compiles it
 *   bad_field       receives the name of the first bad setting ("camera.fx_px"), otherwise null. May be null
 * Returns GOE_OK, GOE_BAD_ARGUMENT, GOE_BAD_SETTINGS. A failure changes nothing.
 * Cost: at most 8200 instructions, 160 bytes of stack. */
GOE_NODISCARD goe_status_t goe_init(goe_estimator_t *estimator, size_t estimator_size, const goe_settings_t *settings,
                                    const char **bad_field);

/* Processes one image and reports the estimate after it. Judge it by valid, fresh, age_s and sigma, not by the status.
 *   estimate  always written; a null pointer returns GOE_BAD_ARGUMENT. It is all zero with GOE_BAD_ARGUMENT,
 *             GOE_NOT_INITIALIZED and GOE_CORRUPTED. With any other negative status it is the last estimate, marked stale
 * Returns GOE_OK, a positive status, GOE_BEHIND_CAMERA to GOE_NO_HEIGHT (except GOE_BAD_HEIGHT), GOE_BAD_ARGUMENT,
 * GOE_NOT_INITIALIZED, GOE_CORRUPTED. Faults of images are counted. The solution's status has priority over a feature's.
 * Cost: at most 59150 instructions, 2048 bytes of stack; 82100 with lens distortion; window: 5700.
 * The window method's figure excludes lens distortion. */
goe_status_t goe_update(goe_estimator_t *estimator, const goe_image_t *image, goe_estimate_t *estimate);

/* Ends the track; keeps settings and counters. Call it before another obstacle, after a teleport, after a turn of over 60 degrees.
 * Returns GOE_OK, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 1640 instructions, 64 bytes of stack. */
goe_status_t goe_reset(goe_estimator_t *estimator);

#ifdef __cplusplus
}
#endif

#include "goe_diagnostics.h"
#include "goe_hazard.h"

#endif /* GOE_H */
