/*
 * goe - Ground Obstacle Estimator
 *
 * One camera views a static ground obstacle: a building, a truck, a chimney. From the images' features and the aircraft's own
 * motion goe estimates the obstacle's position, size and orientation, each with a 1-sigma uncertainty. [A1] It predicts the
 * closest approach and decides when to act.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 *     static goe_estimator_t estimator;
 *     goe_settings_t settings;
 *     goe_settings_default(&settings);
 *     settings.camera.fx_px = settings.camera.fy_px = 914.0f;
 *     settings.camera.cx_px = settings.camera.cy_px = 640.0f;
 *     if (goe_init(&estimator, sizeof estimator, &settings, NULL) != GOE_OK) {
 *         return;
 *     }
 *     goe_image_t image = {0};
 *     while (next_image(&image.pose, &image.box)) {
 *         goe_estimate_t estimate;
 *         goe_update(&estimator, &image, &estimate);
 *         if (estimate.valid & GOE_HAS_POSITION) {
 *             show(estimate.x_m, estimate.z_m, estimate.sigma.z_m);
 *         }
 *         const goe_intent_t intent = {{20.0f, 0.0f, 1.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
 *         const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
 *         go_around = decision == GOE_DECISION_ACT || (go_around && decision != GOE_DECISION_CLEAR);
 *     }
 *
 * Order of calls: goe_settings_default, goe_init; for every image goe_update, then goe_decide or goe_hazard; goe_reset before
 * another obstacle. This header has the images and the estimate. It includes goe_limits.h (parts, compile-time limits),
 * goe_settings.h (settings), goe_hazard.h (closest approach, decision, covariance) and goe_diagnostics.h (self-check).
 * DESIGN.md explains the methods and measures their limits; GLOSSARY.md defines the terms.
 *
 * Frames
 *   earth       north, east, down (NED), meters, local, any origin
 *   body        forward, right, down (FRD); the attitude is a Hamilton quaternion (w, x, y, z), body to NED
 *   camera      x right, y down, z along the optical axis; pixel (u, v) = (right, down) from the top left corner
 *   trajectory  "T": X right, Y down, Z forward along the flight direction, ALWAYS LEVEL, also on a glide slope; its
 *               origin moves with the camera. [A4] By default Z is the nose's heading at the track's first image with a
 *               feature. In a crosswind that is not the course: set heading_deg to know T exactly
 *
 *   view from above, north up; the aircraft flies along Z; an obstacle on its left has X < 0
 *
 *                      ______________                  orientation: angle of the SIDE edge (length L) from Z,
 *                     /             /                               clockwise from above, -90 < b <= 90 degrees
 *                    /             / side              width W:     the FRONT edge
 *                   /  front      /  (length L)        length L:    the SIDE edge
 *                  /_____________/                     reference point:
 *                        ^   near corner                 disc       the center
 *                        |                               line, box  the middle of the front edge
 *            reference point (X0, Z0)
 *                        .          Z forward
 *                          .        ^
 *                            .      |
 *                              .    o-----> X right
 *                                 camera
 *
 *   Example: the aircraft is at north 0, east 0, heading north; a chimney of 6 m diameter is at north 200, east -30. Then
 *   Z0 = 200 m, X0 = -30 m, width = 6 m. After 50 m of flight Z = 150 m, X = -30 m; X0 and Z0 stay.
 *
 * Memory      The caller owns goe_estimator_t, which is all state: at most 2.9 KiB at the default window [A9]; no heap, no
 *             statics, no recursion. [A10] One estimator follows one obstacle.
 * Threads     A function touches only what its arguments point at; an estimator needs the caller's lock. [A11]
 * Arithmetic  float, sqrtf, memcpy, memset. [A12] With -ffp-contract=off all IEEE 754 targets compute the same bits. [A13]
 * Failure     A call with a negative status changes only counters, unless the status says "image taken". [A21] The last answer
 *             stays, marked stale. Every output is finite. [A16] Non-finite input is refused, also under -ffast-math. [A17]
 * Cost        At each function: the most on a Cortex-M4F with gcc -O2, window of 8, one camera; proved, instructions (not
 *             cycles) and bytes of stack. [A23]
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

/* Result of an image or of a call. 0: nominal; positive: the image was good, but gave less than a new solution; negative: no
 * new solution. "Image taken": stored, as later images build on it. Free numbers: 5 to 31, -16 to -31, from -36 on. [A25] */
typedef enum {
    GOE_OK = 0,           /* solved from this image and those before it */
    GOE_PARTIAL = 1,      /* solved; a part of the image was refused or could not be used: see fault_counts */
    GOE_CONVERGING = 2,   /* image taken; no solution yet: too few images, or range uncertain by over 25 % (1 sigma) */
    GOE_STALE = 3,        /* image taken; it adds nothing to the model, whose older solution remains */
    GOE_NO_DETECTION = 4, /* image taken for its pose; no feature is visible. Not a fault */
    /* a feature; image taken */
    GOE_BEHIND_CAMERA = -1, /* a ray points backwards or sideways: third component in T <= 0.05 of its norm */
    GOE_LENS_FAILED = -2,   /* the inversion of the lens model does not converge at a pixel: too far off the axis */
    GOE_SWAPPED = -3,       /* left is not left of right by 1e-4 focal lengths, or base corners are out of order */
    GOE_EDGE_ON = -4,       /* the camera views the front edge from its end or from behind; no length */
    GOE_NO_EDGE = -5,       /* line model set and no line point: no edge is long enough (10 px, 2 px) */
    GOE_BAD_HEIGHT = -6,    /* window: the camera's height is <= 0: no obstacle height. Only counted */
    /* the solution of the window method; image taken */
    GOE_NO_BASELINE = -7, /* the camera moved less than window.min_baseline_m */
    GOE_NO_PARALLAX = -8, /* the image does not grow: no static obstacle ahead, or far too noisy */
    GOE_ABEAM = -9,       /* the solution lies abeam or behind: Z <= 0 */
    /* the image was refused */
    GOE_NOT_FINITE = -10,   /* a NaN or an infinity in the pose or in a visible feature */
    GOE_OUT_OF_RANGE = -11, /* a number outside the range stated at its field */
    GOE_BAD_TIME = -12,     /* time unknown, repeated or running backwards; after a wild jump ahead: goe_reset */
    GOE_BAD_ATTITUDE = -13, /* the quaternion's norm differs from 1 by more than 1 % */
    /* a box; image taken */
    GOE_BOX_INCOMPLETE = -14, /* fewer than two usable sides: not marked in box.sides, cut by the border, or out of order */
    GOE_NO_HEIGHT = -15,      /* filter: height_m is exactly 0 with a box: taken as unknown to 1000 m */
    /* a call */
    GOE_BAD_SETTINGS = -32,    /* goe_init: a setting is outside its range; bad_field names it */
    GOE_BAD_ARGUMENT = -33,    /* a null pointer, or an estimator of another size than the library's */
    GOE_NOT_INITIALIZED = -34, /* goe_init has not succeeded on this estimator */
    GOE_CORRUPTED = -35        /* the memory was changed from outside: the track has ended. That is not "safe": keep the last
                                * warning. If goe_reset returns it, too, call goe_init: the settings have changed */
} goe_status_t;

/* goe_estimator_t.fault_counts[-status] counts faults; [0]: tracks that a reset of unknown size ended. Counters saturate. */
#define GOE_FAULT_COUNTS 16

/* Whether goe_update() took the image. A refused image leaves nothing: supply its reset's delta again. */
#define GOE_IMAGE_TAKEN(status)                                                                                        \
    (((int)(status) > (int)GOE_NOT_FINITE) |                                                                           \
     (((int)(status) < (int)GOE_BAD_ATTITUDE) & ((int)(status) > (int)GOE_BAD_SETTINGS)))

/* ----------------------------------------------------------------------------------------------------------- image -- */

#define GOE_TIME_UNKNOWN INT64_MIN

/* Where the aircraft was AT THE TIME OF EXPOSURE. A jump of the autopilot's own filter is not motion [A27]: supply its reset
 * counter, and the jump (new minus old, summed since the last image taken) where it is known. An unknown jump, also of
 * attitude, starts a new track. DESIGN.md describes jumps of down. */
typedef struct {
    int64_t time_us;         /* any origin; strictly increasing; GOE_TIME_UNKNOWN is refused */
    float position_ned_m[3]; /* vehicle's reference point, each +-1e6; choose an origin within 10 km */
    float height_m;          /* camera above the ground at the obstacle, +-1e5; exactly 0 with a box: not set. With boxes the
                              * first height counts, then the changes of down (see navigation.height_white_sd_m) */
    float attitude[4];       /* w, x, y, z; body FRD to NED; its norm 1 within 1 % */
    uint8_t reset_count;     /* reset counter of the autopilot's filter; wraps */
    bool reset_delta_known;  /* read when reset_count changed: the next field holds */
    float reset_delta_ned_m[3]; /* each +-1e6, as position_ned_m jumped */
} goe_pose_t;

/* An image point in raw pixels, each +-1e5; read only if visible. */
typedef struct {
    float u_px, v_px;
    bool visible;
} goe_pixel_t;

/* A detector's upright bounding box in raw pixels. Do not supply a tracker's smoothed boxes: they lag. */
typedef struct {
    float left_px, top_px, right_px, bottom_px; /* read only if marked; each +-1e5; left < right, top < bottom */
    uint8_t sides; /* mask of GOE_SIDE_...; 0: no box. Without its bit a side is cut, hidden or not reliable */
} goe_box_t;

#define GOE_SIDE_LEFT 0x01u
#define GOE_SIDE_TOP 0x02u
#define GOE_SIDE_RIGHT 0x04u
#define GOE_SIDE_BOTTOM 0x08u
#define GOE_SIDES_ALL 0x0Fu /* all four */

/* This image's own errors, one sigma each, for the filter method; 0: as in the settings. */
typedef struct {
    float attitude_sd_deg; /* replaces navigation.attitude_white_sd_deg; 0 to 30 */
    float height_sd_m;     /* replaces navigation.height_bias_sd_m in the first image with a box; 0 to 1e3 */
    float pixel_sd_px;     /* replaces detector.point_noise_px and box_noise_px; 0 to 100 */
} goe_image_noise_t;

/* One image of one obstacle: a box, or points, or both; any subset of the features.
 * Box: replaces left, right and top. With base corners its bottom is not used. [A29]
 * Points: left and right for a disc; two or three base corners for a line or a box; top for the height. Do not supply the
 * middles of a box's sides as points: when the camera rolls, the width comes out too large. */
typedef struct {
    goe_pose_t pose;
    goe_pixel_t left, right; /* leftmost and rightmost point of the silhouette */
    goe_pixel_t top;         /* point of the roof's edge over the nearest base corner; disc: nearest point of the upper rim */
    goe_pixel_t base_left, base_near, base_right; /* corners of the base on the ground, in image order; base_near lies
                                                   * between two visible faces */
    goe_box_t box;
    goe_image_noise_t noise;
    uint8_t camera; /* number of the camera; GOE_OUT_OF_RANGE if there is none of that number */
} goe_image_t;

/* -------------------------------------------------------------------------------------------------------- estimate -- */

/* goe_estimate_t.valid: a quantity without its bit is 0 and means nothing. */
#define GOE_HAS_POSITION 0x01u    /* x0, z0, x, z, residual, baseline */
#define GOE_HAS_LENGTH 0x02u      /* length: line or box whose side edge is visible */
#define GOE_HAS_HEIGHT 0x04u      /* height */
#define GOE_HAS_ORIENTATION 0x08u /* orientations and axes */
#define GOE_HAS_CENTER 0x10u      /* center: disc; line or box with length */
#define GOE_HAS_WIDTH 0x20u       /* width */
#define GOE_HAS_VELOCITY 0x40u    /* velocity: the obstacle moves, and the filter follows it */

/* One sigma of each quantity, in its unit. Filter: of the true error, if the settings describe the sensors. Window: from
 * residuals alone; constant errors of attitude and height are not in it. [A32] */
typedef struct {
    float x0_m, z0_m, x_m, z_m, width_m, length_m, height_m, orientation_deg, center_north_m, center_east_m;
    float velocity_north_m_s, velocity_east_m_s, latency_s;
} goe_sigma_t;

/* Why an estimate is suspect: the most significant reason. Filter method. */
typedef enum {
    GOE_REASON_NONE,
    GOE_REASON_CONVENTION, /* the filter restarted twice within 24 images: the inputs contradict each other (axes, signs, order
                            * of the quaternion, mounting, time) */
    GOE_REASON_MOVES,      /* the obstacle moves. Without GOE_HAS_VELOCITY its position is wrong */
    GOE_REASON_BASE,       /* base corners proved to be none, and are not used */
    GOE_REASON_SHAPE,      /* the settings require a disc, and the silhouette is none */
    GOE_REASON_LATE,       /* poses are late or early by latency_s, which is corrected; also if not suspect */
    GOE_REASON_NOISE       /* errors exceed the settings, or the obstacle has another shape */
} goe_reason_t;

typedef struct {
    goe_method_t method;   /* behind this estimate; 0 if none */
    goe_model_t model;     /* behind x0 to width and the center */
    unsigned valid;        /* GOE_HAS_... */
    bool fresh;            /* x0 to width are solved from the latest image; false: stale, the last good answer */
    bool suspect;          /* filter: the residuals do not fit. The sigmas may be too small: widen margins, keep warnings */
    goe_reason_t reason;   /* why */
    int images_used;       /* 0 to 32767 */
    float age_s;           /* since the image of the last solution; 0 to 4000 */
    float x0_m, z0_m;      /* reference point at the track's first image, T axes */
    float x_m, z_m;        /* the same relative to the camera at the latest image; follows the motion also if stale */
    float width_m;         /* disc: diameter; line, box: length of the front edge */
    float length_m;        /* of the side edge */
    float height_m;        /* top above ground */
    float orientation_deg; /* side edge (length axis) from Z, clockwise from above, -90 < b <= 90 */
    float orientation_raw_deg;   /* window: from the latest image alone; filter: orientation_deg */
    float front_orientation_deg; /* front edge (width axis) */
    float length_axis[2], width_axis[2]; /* unit vectors (X, Z): along the side edge; along the front edge, to its right */
    float length_axis_ne[2], width_axis_ne[2]; /* the same in (north, east) */
    float trajectory_heading_deg; /* of Z, clockwise from north, -180 to 180; constant over the track */
    float center_north_m, center_east_m; /* middle of the base, NED of the latest pose ... */
    float center_ne_m2;                  /* ... and their covariance */
    float velocity_north_m_s, velocity_east_m_s; /* of an obstacle that moves */
    float latency_s;  /* filter: how late poses are against images; it is corrected */
    float residual;   /* window: RMS residual of (5), m/S; filter: 0 */
    float baseline_m; /* window: spread of the camera's path; filter: distance from the track's start */
    float nis;        /* filter: normalized innovation squared of the latest image ... */
    int nis_rows;     /* ... and its expectation */
    float nis_ratio;  /* filter: running mean of nis / nis_rows over 64 images; 1 is what the settings predict */
    goe_sigma_t sigma;
} goe_estimate_t;

/* The estimator's memory. All fields are private, except fault_counts. [A33] */
#include "goe_state.h"

/* ------------------------------------------------------------------------------------------------------- functions -- */

/* Sets the defaults of a small aircraft's usual sensors. The caller must set fx_px, fy_px, cx_px, cy_px. Null is ignored.
 * Cost: at most 1010 instructions, 40 bytes of stack. */
void goe_settings_default(goe_settings_t *settings);

/* Checks and copies *settings; starts with an empty track and zeroed counters.
 *   estimator_size  sizeof(goe_estimator_t) as the caller compiles it
 *   bad_field       gets the name of the first bad setting ("camera.fx_px"), otherwise null; null: not wanted
 * Returns GOE_OK, GOE_BAD_ARGUMENT, GOE_BAD_SETTINGS; a failure leaves the estimator as it was.
 * Cost: at most 7900 instructions, 160 bytes of stack. */
GOE_NODISCARD goe_status_t goe_init(goe_estimator_t *estimator, size_t estimator_size, const goe_settings_t *settings,
                                    const char **bad_field);

/* Takes one image and reports the estimate after it. Whatever the status, use the estimate by its valid, fresh, age_s, sigma.
 *   estimate  always written; all zero with GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED. Null: GOE_BAD_ARGUMENT
 * Returns GOE_OK, a positive status, GOE_BEHIND_CAMERA to GOE_NO_HEIGHT (except GOE_BAD_HEIGHT), GOE_BAD_ARGUMENT,
 * GOE_NOT_INITIALIZED, GOE_CORRUPTED. Of several faults all are counted; it returns the solution's before a feature's.
 * Cost: at most 48000 instructions, 1408 bytes of stack; 70000 with lens distortion; window: 5500. */
goe_status_t goe_update(goe_estimator_t *estimator, const goe_image_t *image, goe_estimate_t *estimate);

/* Ends the track; keeps settings and counters. For another obstacle, or a new view of the same one.
 * Returns GOE_OK, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED.
 * Cost: at most 1640 instructions, 64 bytes of stack. */
goe_status_t goe_reset(goe_estimator_t *estimator);

#ifdef __cplusplus
}
#endif

#include "goe_diagnostics.h"
#include "goe_hazard.h"

#endif /* GOE_H */
