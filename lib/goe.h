/*
 * goe - Ground Obstacle Estimator
 *
 * From one camera's view of a static ground obstacle (a building, a truck, a chimney) and the aircraft's own motion:
 * the position, size and orientation of the obstacle, each with a 1-sigma uncertainty. [A1]
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * Two methods, chosen by goe_settings_t.method:
 *   filter  (default) a square-root information filter over the whole track: maximum likelihood in fixed memory. The errors of
 *            the sensors (goe_navigation_t, goe_detector_t) are its weights and nuisance states, so that its sigmas are of the
 *            true error. [A2] lib/refined/README.md holds its theory.
 *   window   the paper: P. Bauer, "Position, Size and Orientation Estimation of Ground Obstacles in Sense and Avoid", IFAC
 *            ACA 2019, equation by equation (lib/window/README.md). [A3] Where both methods are compiled in it answers while the
 *            filter cannot start, until that first answers.
 * "(1)" to "(8)" below and in the .c files are the equations of that paper.
 *
 * THIS HEADER IS THE MANUAL. The .c files give reasons and equation numbers only; lib/README.md shows the source layout.
 * "Given" is what the caller hands in, "reported" what the library answers.
 *
 * ---------------------------------------------------------------------------------------------------------------------
 * Frames
 *
 *   earth       north, east, down (NED), meters, local, origin anywhere
 *   body        forward, right, down (FRD); attitude = Hamilton quaternion (w, x, y, z) that turns body into NED
 *   camera      x right, y down, z along the optical axis; pixel (u, v) = (right, down) from the top left corner
 *   trajectory  "T": X right, Y down, Z forward along the intended flight direction, ALWAYS LEVEL, also on a glide slope;
 *               its origin moves with the camera. [A4] By default Z is where the nose points at the track's first image,
 *               which in a crosswind is not the course: set heading_deg to know T exactly
 *
 *   view from above, north up; the aircraft flies along Z, an obstacle on its left has X < 0
 *
 *                              far corner
 *                      ______________                  orientation: angle of the SIDE edge (length L) from Z,
 *                     /             /                               clockwise from above, -90 < b <= 90 degrees
 *                    /             / side              width W:     the FRONT edge
 *                   /  front      /  (length L)        length L:    the SIDE edge
 *                  /_____________/                     reference point:
 *                        ^   near corner                 disc       the center of the disc
 *                        |                               line, box  the middle of the front edge
 *            reference point (X0, Z0)
 *                        .
 *                          .          Z forward
 *                            .        ^
 *                              .      |
 *                                .    |
 *                                  .  o-----> X right
 *                                   camera
 *
 *   Worked example (tests/c/test_readme.c flies it): the aircraft is at north 0, east 0, heading north; a chimney of
 *   6 m diameter is at north 200, east -30. Then Z0 = 200 m, X0 = -30 m, width = 6 m.
 *   After 50 m of flight: Z = 150 m, X = -30 m, and X0, Z0 stay as they were.
 *
 *   The track begins with the first image that shows a feature: that image fixes T and its origin. Images without a feature fix
 *   nothing. [A5] Features more than 87 degrees from Z cannot be used. [A6] With heading_auto the track begins again, by itself, while no
 *   position is known and the nose has turned by more than 45 degrees: if every feature then lies more than 60 degrees from Z.
 *   Once a position is known T stays: after a turn of more than 60 degrees call goe_reset when the obstacle is in view again. Until
 *   then the last answer, stale, follows the motion. [A7]
 *
 *   Jumps: x0, z0, x and z move by half the obstacle's size when a disc becomes a line or box. Filter: front and side keep
 *   their names until the side lies more than 52 degrees (tan b = 1.3) from Z; then width and length, their sigmas,
 *   orientation, both axes and the reference point change at once. [A8] The center does not jump.
 *
 * ---------------------------------------------------------------------------------------------------------------------
 * Memory      goe_estimator_t is owned by the caller, fixed in size (at most 2.9 KiB at the default window, 2.3 KiB without
 *             GOE_WITH_TARGET_MOTION) [A9], and all there is: no heap, no hidden statics, no recursion. [A10] One estimator follows one
 *             obstacle; several obstacles take several estimators, which share nothing.
 * Threads     Every function touches only what its arguments point at. Two threads may work on two estimators; one
 *             estimator needs the caller's lock. [A11]
 * Arithmetic  float only; of the C library sqrtf, memcpy and memset, no more. [A12] sqrtf must be correctly rounded, as IEEE 754
 *             requires: goe_self_check() tests it. Compiled with the library's own flags (-ffp-contract=off) the results are
 *             bit-identical on every IEEE 754 target; goe_self_check() verifies it at run time. [A13]
 *             Under -ffast-math and the like the library stays safe (below) and loses only bit identity. [A14]
 *             What float rounds, against double precision, stays below one and a half sigma of any quantity of the filter method
 *             with positions within 10 km of their origin, for lever arms of meters, 300 to 3000 px of focal length and sensors'
 *             usual noise, until a decision falls otherwise: the worst that a search found is 1.1, of an obstacle that moves. [A15] The
 *             window's sigmas are of its residuals alone, and rounding may be several of them. At the ends of the ranges stated
 *             below, all at once, it is hundreds to thousands: choose an origin near the flight, and give no less noise than the
 *             sensors have.
 * Safety      Every output is finite. [A16] Input that is not finite is refused by its exponent bits, so also under -ffast-math. [A17]
 *             No argument leads to a trap, an endless loop or a write outside the estimator. [A18] A bool that is given as neither 0
 *             nor 1 counts as 1. [A19]
 * Bit flips   One flipped bit anywhere in goe_estimator_t, between two calls, leads to none of these either, nor to an output
 *             that is not finite or not of its enumeration. Settings and mounting are sealed by goe_init(): GOE_CORRUPTED. In the
 *             rest most flips are found by the images that follow (suspect, a new start, GOE_CORRUPTED); some are not, and the
 *             answer is wrong: tests/flips counts them, field by field. [A20]
 * Failure     A call that returns a negative status changed nothing in the estimator but its counters, unless the
 *             status says "image taken" below. [A21] The last good estimate is kept and marked stale. Two things end a track, as
 *             goe_reset does: a filter reset of unknown size (goe_pose_t), and GOE_CORRUPTED. [A22]
 * Cost        is stated at each function: the most that a call can take on a Cortex-M4F with gcc -O2, in instructions (not
 *             cycles) and bytes of stack, proved by the longest path through the machine code, at a window of 8, with one
 *             camera and intact memory. [A23] Measured, it is less: tests/targets has that, for every processor and compiler.
 */
#ifndef GOE_H
#define GOE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GOE_VERSION_MAJOR 0
#define GOE_VERSION_MINOR 4
#define GOE_VERSION_PATCH 0

/* ------------------------------------------------------------------------------------------------- compile-time limits -- */

/* They may come from a header of the firmware's own: -DGOE_CONFIG_HEADER='"my_goe_config.h"'. [A24] All translation units of a
 * program must agree; goe_init() refuses an estimator of another size. */
#ifdef GOE_CONFIG_HEADER
#include GOE_CONFIG_HEADER
#endif

/* Parts that may be left out, code and state: 1 or 0. At least one method is needed. */
#ifndef GOE_WITH_WINDOW
#define GOE_WITH_WINDOW 1 /* the window method; without it the filter answers nothing until it has started */
#endif
#ifndef GOE_WITH_FILTER
#define GOE_WITH_FILTER 1 /* the filter method */
#endif
#ifndef GOE_WITH_HAZARD
#define GOE_WITH_HAZARD 1 /* goe_hazard() */
#endif
#ifndef GOE_WITH_TARGET_MOTION
#define GOE_WITH_TARGET_MOTION 1 /* filter: detects and corrects pose latency, and estimates the velocity of an obstacle that moves */
#endif
#if !GOE_WITH_WINDOW && !GOE_WITH_FILTER
#error "GOE_WITH_WINDOW or GOE_WITH_FILTER must be 1"
#endif

/* Largest window that goe_settings_t.window.points may ask for, in image points; 3 to 64. Each point costs 40 bytes. */
#ifndef GOE_WINDOW_MAX
#define GOE_WINDOW_MAX 8
#endif
#if GOE_WINDOW_MAX < 3 || GOE_WINDOW_MAX > 64
#error "GOE_WINDOW_MAX must be 3 to 64"
#endif

/* Cameras of one aircraft, 1 to 8. Each further one costs 112 bytes. */
#ifndef GOE_CAMERAS_MAX
#define GOE_CAMERAS_MAX 1
#endif
#if GOE_CAMERAS_MAX < 1 || GOE_CAMERAS_MAX > 8
#error "GOE_CAMERAS_MAX must be 1 to 8"
#endif

#if defined(__GNUC__) || defined(__clang__)
#define GOE_NODISCARD __attribute__((warn_unused_result))
#else
#define GOE_NODISCARD
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------- status -- */

/* What became of one image, or of a call. 0: nominal. Positive: the image was good, but gave less than a whole new
 * solution. Negative: no new solution. "Image taken": the image was stored although the status is negative, because the
 * next images build on it; otherwise it was refused whole.
 * Numbers that are free: 5 to 31 for images that were good, -16 to -31 for faults of images, from -36 on for calls. A later
 * version may use them, and renumbers nothing. [A25] */
typedef enum {
    GOE_OK = 0,             /* solved from this image and those before it */
    GOE_PARTIAL = 1,        /* solved, but a part of the image was refused or could not be used: see the counters */
    GOE_CONVERGING = 2,     /* image taken; no solution yet: too few points, or the range is not known to 25 % (1 sigma) */
    GOE_STALE = 3,          /* image taken; it adds no point to the reported model, whose older solution remains */
    GOE_NO_DETECTION = 4,   /* image taken for its pose; no feature is marked as visible. Not a fault: nothing is in view */
    /* a feature of an image that was taken; no new solution */
    GOE_BEHIND_CAMERA = -1, /* a ray points backwards or sideways: third component in T <= 0.05 of its norm */
    GOE_LENS_FAILED = -2,   /* the iteration that inverts the lens model does not settle at a pixel: too far off the axis */
    GOE_SWAPPED = -3,       /* after alignment left is not left of right by 1e-4 focal lengths, or base corners are not in
                               image order */
    GOE_EDGE_ON = -4,       /* the camera views the front edge from its end or from behind; as GOE_PARTIAL: no length from this
                               image, the side edge points at the camera */
    GOE_NO_EDGE = -5,       /* line model forced and no line point: the front edge is too short or no edge has a
                               measurable orientation (10 px and 2 px gates), as when the obstacle is met head-on */
    GOE_BAD_HEIGHT = -6,    /* camera's height above ground <= 0; as GOE_PARTIAL: no obstacle height from this image.
                               Window */
    /* the solution; image taken. Window, also while it answers for the filter method */
    GOE_NO_BASELINE = -7,   /* the camera moved too little over the window: goe_settings_t.window.min_baseline_m */
    GOE_NO_PARALLAX = -8,   /* the image does not grow as it must (1/W <= 0, or lost in rounding): not a static obstacle
                               ahead, or far too noisy */
    GOE_ABEAM = -9,         /* the solution lies abeam or behind: Z <= 0 somewhere in the window */
    /* an image that was refused whole */
    GOE_NOT_FINITE = -10,   /* a NaN or an infinity in the pose or in a visible feature */
    GOE_OUT_OF_RANGE = -11, /* a number outside the range stated at its field */
    GOE_BAD_TIME = -12,     /* time unknown, repeated or running backwards; after a wild jump ahead: goe_reset */
    GOE_BAD_ATTITUDE = -13, /* the quaternion's norm is off 1 by more than 1 % (a zero quaternion among them) */
    /* a box of an image that was taken; no new solution. With one: GOE_PARTIAL */
    GOE_BOX_INCOMPLETE = -14, /* fewer than two sides of the box can be used: not marked in box.sides, which is a mask (true marks
                                 the left side alone), cut by the image's border, or out of order */
    GOE_NO_HEIGHT = -15,    /* height_m is exactly 0 with a box: taken as not set. The height counts as unknown to 1000 m, and
                               the bottom of the box measures no range. Filter */
    /* a call */
    GOE_BAD_SETTINGS = -32, /* goe_init: a setting is outside its range; bad_field names it */
    GOE_BAD_ARGUMENT = -33, /* a null pointer, or an estimator of another size than the library's (GOE_WINDOW_MAX, parts) */
    GOE_NOT_INITIALIZED = -34, /* goe_init has not succeeded on this estimator */
    GOE_CORRUPTED = -35 /* its memory is not what the library left there. Nothing is known of the obstacle any more, which does
                           not make it safe: keep the last warning. If goe_reset says so, too, settings or mounting have changed,
                           and every call does until goe_init; otherwise the track has ended, and the next image begins one */
} goe_status_t;

/* Whether goe_update() took the image with this status. Of an image that it refused nothing is kept: a reset's delta must be given
 * again. */
#define GOE_IMAGE_TAKEN(status)                                                                                        \
    (((int)(status) > (int)GOE_NOT_FINITE) |                                                                           \
     (((int)(status) < (int)GOE_BAD_ATTITUDE) & ((int)(status) > (int)GOE_BAD_SETTINGS)))

/* goe_estimator_t.fault_counts counts every fault, for the flight log: fault_counts[-status] for GOE_BEHIND_CAMERA to
 * GOE_NO_HEIGHT; fault_counts[0] the tracks that a filter reset of unknown size ended. Counters saturate. */
#define GOE_FAULT_COUNTS 16

/* -------------------------------------------------------------------------------------------------------- settings -- */

/* The projection model that is reported. */
typedef enum {
    GOE_MODEL_NONE = 0, /* estimate only: nothing solved yet. As a setting: refused */
    GOE_MODEL_AUTO = 1, /* setting only. Window: disc until window.line_points line points exist, the line from then on: when
                           no more base corners come its last solution is held, until goe_reset. Filter: disc until the
                           images show a box */
    GOE_MODEL_DISC = 2, /* an upright cylinder, or the circle that replaces anything else; (2) */
    GOE_MODEL_LINE = 3, /* (3): the front edge of a box; needs base corners. As a setting of the filter method: a box,
                           and no disc before it */
    GOE_MODEL_BOX = 4,  /* estimate only: a box with an upright, level outline. Filter method */
    GOE_MODEL_PRISM = 5 /* estimate only: something upright by its bounding boxes, whose depth along the line of sight is not
                           known: the sigmas cover a mast as well as a house. Width: across the line of sight of the image
                           that the filter started with; its sigma grows as that turns. Filter method */
} goe_model_t;

typedef enum { GOE_METHOD_WINDOW = 1, GOE_METHOD_FILTER = 2 } goe_method_t;

/* Each field: its meaning; its range; its default. goe_settings_list.h has the same as one table, which sets the defaults and
 * checks the ranges. Fields of a part that was left out are neither read nor checked. [A26] */

/* Pinhole camera with Brown-Conrady lens, in OpenCV's conventions, and how it sits on the aircraft.
 * Mounting: the un-mounted camera looks along body x with image x = body y and image y = body z; it is turned by yaw
 * about z, then pitch about the new y, then roll about the newest x. A camera that looks left has a negative yaw. */
typedef struct {
    float fx_px;           /* focal length along x, px; 1 to 1e5; no default: must be set. No image shows that it is off. By
                              3 %, W is within 2 sigma in 51 % of the answers only, H in 68 %, Z0 in 91 % */
    float fy_px;           /* ... along y; 1 to 1e5; no default: must be set */
    float cx_px;           /* principal point, px; -1e5 to 1e5; no default: must be set */
    float cy_px;           /* principal point, px; -1e5 to 1e5; no default: must be set */
    float k1;              /* lens distortion, radial; -100 to 100; default 0 */
    float k2;              /* lens distortion, radial; -100 to 100; default 0 */
    float p1;              /* lens distortion, tangential; -100 to 100; default 0 */
    float p2;              /* lens distortion, tangential; -100 to 100; default 0 */
    float k3;              /* lens distortion, radial; -100 to 100; default 0 */
    float mount_yaw_deg;   /* mounting, degrees; -360 to 360; default 0. A camera that looks more than 45 degrees aside of the nose
                              needs heading_auto false and heading_deg, where it looks */
    float mount_pitch_deg; /* mounting, degrees; -360 to 360; default 0 */
    float mount_roll_deg;  /* mounting, degrees; -360 to 360; default 0 */
    float offset_m[3];     /* camera relative to the pose's reference point, body FRD, m; -1e4 to 1e4; default 0 */
    float width_px;        /* size of the image, for sides of boxes near its border, px; 0 to 1e5; default 0: not known */
    float height_px;       /* ... its height; 0 to 1e5; default 0: not known */
    float border_rel;      /* a side nearer to the border than this is not measured, fraction of the image's width; 0 to 0.5;
                              default 0.012. Detectors draw the side of a cut obstacle 4 to 25 px inside a 1242 px image */
    float truncation_rel;  /* while left or right is not measured, or nearer to the border than this, the other sides count
                              less: detector.truncation_noise_rel; 0 to 0.5; default 0.04 */
} goe_camera_t;

/* How wrong the pose is, for the filter method: one-sigma each, as a data sheet or a look at a log gives them. Too large a
 * figure wastes data; too small a one makes the sigmas too small by as much, refuses good points and makes obstacles
 * suspect. A constant error is the same over a track: the filter estimates it together with the obstacle. */
typedef struct {
    float attitude_bias_sd_deg; /* constant attitude error about each body axis, mounting included, degrees; 1e-3 to 30;
                                 default 0.5 */
    float attitude_white_sd_deg; /* attitude error that is new in each image, degrees; 1e-4 to 30; default 0.1 */
    float attitude_walk_sd_deg; /* random walk of the attitude error, degrees per square root of a second; 0 to 30; default 0 */
    float height_bias_sd_m;   /* constant error of goe_pose_t.height_m over the obstacle's ground, m; 1e-3 to 1e3;
                                 default 0.5. No image shows that it is larger: ground 5 m off but configured as 0.5, by base
                                 corners, leaves Z0 within 2 sigma in 45 % of the answers, H in 15 %, and 59 % of the tracks suspect */
    float velocity_bias_sd_m_s; /* constant error of the own horizontal velocity, each axis, m/s; 0 to 100; default 0.05 */
    float position_walk_sd_m; /* random walk of the own position, m per square root of a second; 0 to 100; default 0.05 */
    float position_white_sd_m; /* error of the own position that is new in each image, each axis, m; 0 to 100; default 0.
                                 Upright boxes only */
    float height_white_sd_m;  /* error of height_m that is new in each image, m; 0 to 1e3; default 0: none, and points take each
                                 image's height as it is. Otherwise the height moves by the changes of down, and every image's
                                 height is a reading of where it began, whose mean the filter learns */
    float terrain_slope_sd;   /* slope of the ground that height_m is above, m per m flown; 0 to 1; default 0. It lets the height's
                                 error grow on the way. Its initial error, terrain_slope_sd times range, belongs to height_bias_sd_m */
    float terrain_height_sd_m; /* upright boxes, also with base corners: how far the obstacle's ground may lie off that which height_m
                                 is above, added to height_bias_sd_m, m; 0 to 1e3; default 2. 1000: no altimeter */
} goe_navigation_t;

/* How wrong the features are, for the filter method: one-sigma each. */
typedef struct {
    float point_noise_px; /* error of an image point, new in each image, px; 0.05 to 100; default 0.5. Rounding alone: 0.3 */
    float point_noise_rel; /* error of left, right and top as points, added to it, as a fraction of the silhouette's width;
                          0 to 1; default 0 */
    float point_correlation; /* of a point's error from image to image; 0 to 0.95; default 0 */
    float shape_error_rel; /* model error of the disc: how far a real silhouette departs from a cylinder's, as a fraction of its
                          width; 0 to 1; default 0. Cars as discs: about 0.12. Points only */
    float box_noise_px;  /* error of a box's side that is new in each image, px; 0.05 to 100; default 1 */
    float box_noise_rel; /* error of a side that is correlated from image to image, as a fraction of the box's width (left,
                            right) or height (top, bottom); 0 to 1; default 0.07, right for real detectors */
    float box_correlation_time_s; /* time constant of that correlation, s; 0 to 100; default 1.2 */
    float truncation_noise_rel; /* error of every side, new in each image, while the image's border cuts the box (camera.truncation_rel),
                            as a fraction of the same; 0 to 10; default 1 */
} goe_detector_t;

/* The window method, Section 4 of the paper. The filter method uses none of these. */
typedef struct {
    int points;               /* image points in the window of (5), also of the sliding means; 3 to GOE_WINDOW_MAX; default 8
                                 (or GOE_WINDOW_MAX, if that is less) */
    int line_points;          /* model auto: line points before the line is reported, at least `points`; 1 to 1000; default 8 */
    float edge_min_px;        /* an edge counts if its ends are farther apart in the raw image, px; 0 to 1e4; default 10 */
    float orientation_min_px; /* ... and has an orientation if they differ by more in aligned y, px; 0 to 1e4; default 2 */
    float side_min_px;        /* length is skipped while an end of the side edge is nearer to x' = 0, px; 0.1 to 1e4;
                                 default 10 */
    int orientation_memory;   /* images that the low-pass of the orientation remembers; 1 to 1000; default 20 */
    float min_baseline_m;     /* least spread of the flown baseline, root of its summed squares, m; 1e-3 to 1e4;
                                 default 0.1 */
} goe_window_settings_t;

typedef struct {
    float prior_width_m;  /* width that the range is first guessed from, to a factor of 3, m; 0.1 to 1e3; default 6 */
    float gate_sigma;     /* a point farther off than this is left out, sigmas; 1 to 100; default 5 */
    float huber_sigma;    /* a point farther off than this counts less, sigmas; 0.5 to 100; default 2.5 */
    float nis_ratio_max;  /* goe_estimate_t.nis_ratio above which the obstacle is suspect; 0.01 to 1e3; default 1.9. Less where
                             shape_error_rel or box_noise_rel describe errors that are the same in every image */
    float range_sd_rel_max; /* a position is reported once its sigma is below this share of the range, not counting depth that no
                             image shows (GOE_MODEL_PRISM); 0.01 to 10; default 0.25 */
    bool top_is_highest;  /* `top`, as a point, is the highest one in the image also from above the roof: see
                             goe_image_t.top; a box's top always is the highest, whatever is set here; default false */
} goe_filter_settings_t;

typedef struct {
    goe_camera_t camera; /* number 0 */
#if GOE_CAMERAS_MAX > 1
    goe_camera_t more_cameras[GOE_CAMERAS_MAX - 1]; /* numbers 1 on, each with the ranges of camera; default: fx_px 0, none.
                                                       They are taken as mounted exactly to one another: what that is off by
                                                       belongs into navigation.attitude_white_sd_deg */
#endif
    goe_method_t method; /* window or filter; default filter (if compiled in) */
    goe_model_t model;   /* auto, disc or line; default auto */
    bool heading_auto;   /* T's Z axis = the vehicle's yaw at the track's first image; default true */
    float heading_deg;   /* otherwise this: clockwise from north, degrees; -360 to 360; default 0 */
    goe_navigation_t navigation;
    goe_detector_t detector;
    goe_window_settings_t window;
    goe_filter_settings_t filter;
} goe_settings_t;

/* ----------------------------------------------------------------------------------------------------------- input -- */

#define GOE_TIME_UNKNOWN INT64_MIN

/* Where the aircraft was AT THE TIME OF EXPOSURE, not when the image arrived.
 * A jump of the autopilot's own filter is not motion. [A27] Whenever the filter resets, increment reset_count; give the
 * position it jumped by, when it is known: new minus old, summed over all resets since the last image that was taken,
 * that is, not refused whole (GOE_NOT_FINITE to GOE_BAD_ATTITUDE): after a refusal the same delta must be given again.
 * Known: compensated, the track goes on. Unknown, and also when heading or attitude jumped: reset_delta_known = false,
 * a new track starts with this image.
 * A known jump of down is compensated in the height, too. A height_m of the same filter jumps by minus that delta; a range finder's
 * does not jump. goe compares the step of position_ned_m and height_m with both in the first image after the jump, and takes the
 * nearer one. If height_m jumped, goe takes the jump off every height_m of the rest of the track. So the camera's height, the
 * obstacle's height and the clearance go on above the ground as it was known before the jump. If the errors of height_m in that image
 * and in the one before differ by more than half the delta, goe may take the wrong one: the heights of the rest of the track are
 * then off by the delta. [A28] */
typedef struct {
    int64_t time_us;         /* any origin; strictly increasing; GOE_TIME_UNKNOWN is refused */
    float position_ned_m[3]; /* vehicle's reference point, each +-1e6, in steps of 6 cm out there and of 1 mm within 1e4;
                                with points, down counts at a jump of the filter only; with boxes it changes the height */
    float height_m;          /* of the camera itself above the ground at the obstacle, +-1e5; exactly 0 with a box: not set
                                (GOE_NO_HEIGHT); window: no obstacle height if it is <= 0. Boxes: that of the first image with a
                                box counts, from then on the changes of down; with navigation.height_white_sd_m the mean of all,
                                boxes and points. A known jump of the filter is taken off it: see above */
    float attitude[4];       /* w, x, y, z; body FRD to NED; normalized here, refused if its norm is off by over 1 % */
    uint8_t reset_count;     /* the filter's reset counter, any start, wraps */
    bool reset_delta_known;  /* read only when reset_count changed */
    float reset_delta_ned_m[3]; /* each +-1e6; read only when reset_count changed and reset_delta_known. Down: give it as
                                   position_ned_m jumped, whether height_m jumped along or not */
} goe_pose_t;

/* An image point. u_px and v_px are read only if visible; each +-1e5. */
typedef struct {
    float u_px, v_px;
    bool visible;
} goe_pixel_t;

/* The upright bounding box of a detector in the raw image, each side a straight line of the raw pixels. Feed raw detections, not
 * a tracker's smoothed boxes: smoothing lags, and shrinks boxes that grow, which no sigma knows of. */
typedef struct {
    float left_px, top_px, right_px, bottom_px; /* read only if marked; each +-1e5; left < right, top < bottom */
    uint8_t sides;                              /* mask of GOE_SIDE_..., GOE_SIDES_ALL for a whole box; 0: no box. Without the bit: cut,
                                                   hidden or not believed */
} goe_box_t;

#define GOE_SIDE_LEFT 0x01u
#define GOE_SIDE_TOP 0x02u
#define GOE_SIDE_RIGHT 0x04u
#define GOE_SIDE_BOTTOM 0x08u
#define GOE_SIDES_ALL 0x0Fu /* all four */

/* What autopilot or detector know of this image's own errors, one sigma each; 0: as in the settings; less than the least that
 * the setting takes counts as that. A pose that is late belongs here: 20 ms at 24 degrees a second are 0.5 degrees. Filter
 * method. */
typedef struct {
    float attitude_sd_deg; /* instead of navigation.attitude_white_sd_deg; 0 to 30 */
    float height_sd_m;  /* instead of navigation.height_bias_sd_m, in the first image with a box, whose height counts (with
                           navigation.height_white_sd_m: in the track's first); 0 to 1e3 */
    float pixel_sd_px;  /* instead of detector.point_noise_px, and of box_noise_px; 0 to 100 */
} goe_image_noise_t;

/* One image of one obstacle: a box, or points, or both. Any subset of the features may be visible.
 * Box: what detectors give. It is exact at any attitude, as every side is a plane through the camera that touches the obstacle
 * at its roof or at its foot. A box replaces left, right and top, which are not read then; base corners are. With base
 * corners, too, left, right and top of the box touch roof or foot, wherever the solid ends in the raw image: the top is the
 * highest point of the roof in it, not the one over the nearest corner. The box's bottom is not used then. [A29]
 * Disc: left and right. Line and box: two or three base corners; filter also finds a box by left and right alone when one of
 * its faces turns away in flight: before that it is reported as a disc about its middle, whose width is the lateral extent of
 * its visible part, which changes on the way. The sigmas of such a disc include that it may be something else, and are
 * wider for that, until the images show that it is none; those of goe_settings_t.model disc are a disc's alone. [A30] Height: top,
 * and a solution of any model.
 * Do not give the middles of a box's sides as points: when the camera rolls, the sides touch the top and the foot of a tall
 * obstacle, and the width comes out too large (a mast of 6 m by 30 m: 11 m at 10 degrees of roll). */
typedef struct {
    goe_pose_t pose;
    goe_pixel_t left, right; /* leftmost and rightmost point of the silhouette */
    goe_pixel_t top;         /* point of the roof's edge over the nearest base corner, of a disc the nearest point of the
                                upper rim. From below the roof and not far from the axis it is the highest point in
                                the image; from above, the highest one is another: filter.top_is_highest */
    goe_pixel_t base_left, base_near, base_right; /* visible corners of the base on the ground, in image order;
                                base_near lies between two visible faces, and is not visible when only one face is.
                                Filter: for eight images after it was visible it counts as missed; left and right
                                alone are a face only where one face would be visible alone, and the sigmas cover
                                that they may be the outer ends of two */
    goe_box_t box;
    goe_image_noise_t noise;
    uint8_t camera; /* number of the camera that took it; GOE_OUT_OF_RANGE if there is none of that number. A track passes from
                       one to the other: pose.height_m is that of the camera at hand */
} goe_image_t;

/* ---------------------------------------------------------------------------------------------------------- output -- */

/* Which quantities of an estimate hold an answer. A quantity without its bit is 0 and means nothing. */
#define GOE_HAS_POSITION 0x01u    /* x0, z0, x, z, residual, baseline */
#define GOE_HAS_LENGTH 0x02u      /* length: line or box, side edge visible from aside */
#define GOE_HAS_HEIGHT 0x04u      /* height */
#define GOE_HAS_ORIENTATION 0x08u /* orientation, front_orientation, both axes in T and in north and east */
#define GOE_HAS_CENTER 0x10u      /* center: disc; or line or box with length */
#define GOE_HAS_WIDTH 0x20u       /* width */
#define GOE_HAS_VELOCITY 0x40u    /* velocity: the obstacle moves, and is followed */

/* One-sigma of each quantity; units as the quantity.
 * Filter: of the true error, as far as goe_navigation_t and goe_detector_t describe the sensors; and wider, never narrower, if
 * the track itself scatters more than they say, or its residuals are correlated from image to image, as those of late poses are. A
 * quantity is valid once its sigma, without that, was below filter.range_sd_rel_max (25 %; x0, z0: of the range at the filter's
 * start), 30 % (width, length, height) or 10 degrees in two images in a row; of a prism (GOE_MODEL_PRISM) not counting depth that no
 * image shows. [A31]
 * Window: from the residuals of the fits, and only as good as the assumption that errors are independent from image to
 * image: constant errors of attitude or altitude are not in it. After one single measurement the spread is not known:
 * then the orientation's is 0, and those of length and height contain only what the solution contributes. [A32] */
typedef struct {
    float x0_m, z0_m, x_m, z_m, width_m, length_m, height_m, orientation_deg, center_north_m, center_east_m;
    float velocity_north_m_s, velocity_east_m_s, latency_s;
} goe_sigma_t;

/* Why an estimate is suspect, the most significant one. Filter method. */
typedef enum {
    GOE_REASON_NONE,
    GOE_REASON_CONVENTION, /* the filter had to start again twice within 24 images: the inputs contradict each other (axes,
                              signs or order of the attitude, the mounting, a pose half a second late), or it is of quite
                              another shape */
    GOE_REASON_MOVES,      /* the obstacle moves. GOE_HAS_VELOCITY: it is followed, and so are position and hazard. Without it,
                              where neither base corners nor the bottom of a box are visible, the position is that of an obstacle
                              which stands still, and wrong */
    GOE_REASON_BASE,       /* the points given as base corners proved not to be corners, and are left out */
    GOE_REASON_SHAPE,      /* the settings require a disc, and the silhouette is not that of one */
    GOE_REASON_LATE,       /* poses are late (or early) against the images: latency_s. Also of an estimate that is not
                              suspect: the latency is taken off */
    GOE_REASON_NOISE       /* the errors are larger than given, or the obstacle is of another shape */
} goe_reason_t;

typedef struct {
    goe_method_t method;   /* behind this estimate; filter once the filter has started, even while no quantity is valid yet;
                              0 if none */
    goe_model_t model;     /* none (nothing solved), disc, line or box: the model behind x0 to width and the center */
    unsigned valid;        /* GOE_HAS_... */
    bool fresh;            /* x0 to width are solved from the latest image; false: stale, the last good answer. Window:
                              length, height and orientation are the latest measured, and have no age of their own */
    bool suspect;          /* filter: the residuals do not fit a static obstacle of this model (nis_ratio > nis_ratio_max): it
                              moves, or it is of another shape, or the errors are larger than given; or the settings require a
                              disc and the silhouette is not that of one; or points given as base corners proved not to be
                              corners and are left out. The sigmas may then be too small: widen the margins, never drop a warning. Motion
                              along the line of sight looks like another size: oncoming at 15 m/s, 60 % of the tracks with
                              base corners are reported as moving within 4 s and 72 % ever, of outlines 19 % ever. All lengths in
                              another unit are never noticed */
    goe_reason_t reason;   /* of that; GOE_REASON_LATE also of an estimate that is not suspect */
    int images_used;       /* images behind the answer: the window, or all that were used; at most 32767; 0 if none */
    float age_s;           /* since the image of the last solution, refused images included; 0 if fresh or none; at
                              most 4000. It stands still when goe_update is not called, and falls if a refused image had a
                              time that lay ahead of the next one's */
    float x0_m, z0_m;      /* reference point at the track's first image, T axes */
    float x_m, z_m;        /* the same relative to the camera at the latest image taken: follows the motion also if stale, and
                              its sigma grows with the age by velocity_bias_sd_m_s and position_walk_sd_m (filter) */
    float width_m;         /* disc: diameter; line, box: length of the front edge */
    float length_m;        /* of the side edge */
    float height_m;        /* top above ground */
    float orientation_deg; /* side edge (length axis) from Z, clockwise from above, -90 < b <= 90 */
    float orientation_raw_deg; /* window: the same from the latest image that measured it alone, not filtered; filter:
                                  orientation_deg again */
    float front_orientation_deg; /* front edge (width axis), same convention */
    float length_axis[2];  /* unit vector (X, Z) along the side edge */
    float width_axis[2];   /* unit vector (X, Z) along the front edge, to the right of length_axis */
    float length_axis_ne[2], width_axis_ne[2]; /* the same in (north, east) */
    float trajectory_heading_deg; /* of T's Z axis, clockwise from north, -180 to 180; holds from the track's first image on */
    float center_north_m, center_east_m; /* middle of the base, NED as of the latest pose ... */
    float center_ne_m2;                  /* ... and the covariance of the two, whose variances are the sigmas squared */
    float velocity_north_m_s, velocity_east_m_s; /* of an obstacle that moves; its place is that at the image behind the
                                                    estimate, in x_m and z_m at the latest one */
    float latency_s;       /* filter: what the poses are late by against the images (negative: early), as far as rotation and
                              turns have shown; it is corrected. 0 if nothing is known, or without GOE_WITH_TARGET_MOTION */
    float residual;        /* window: root mean square residual of (5), in the rows' own unit m/S; filter: 0 */
    float baseline_m;      /* window: root of the summed squared spread of the camera's path over the window; filter:
                              distance of the camera from where the track began */
    float nis;             /* filter: normalized innovation squared of the latest image ... */
    int nis_rows;          /* ... and how many rows made it, which is its expectation; 0 if the image gave none */
    float nis_ratio;       /* filter: running mean of nis / nis_rows over the last 64 images, seeded with eight zeros; 1 is
                              what the settings predict */
    goe_sigma_t sigma;
} goe_estimate_t;

/* ----------------------------------------------------------------------------------------------------------- state -- */

/* goe_estimator_t, transparent, to be placed and counted by the caller: its fields are private to the library, except fault_counts,
 * which may be read. [A33] */
#include "goe_state.h"

/* ------------------------------------------------------------------------------------------------------- functions -- */

/* Sets every field of *settings to its default: the filter method (if compiled in), for the errors of a small aircraft's
 * usual sensors; the paper's values for the window; no lens distortion, no lever arm. fx_px, fy_px, cx_px and cy_px are 0 and
 * must be set by the caller. A null pointer is ignored.
 * Cost: at most 1010 instructions, 40 bytes of stack. */
void goe_settings_default(goe_settings_t *settings);

/* Checks *settings, copies them and starts with an empty track and zeroed counters.
 *   estimator_size  sizeof(goe_estimator_t) as the caller's compiler sees it
 *   bad_field       where to put the name of the first bad setting ("camera.fx_px", ...); null if not wanted.
 *                   Set to null unless GOE_BAD_SETTINGS is returned.
 * Returns GOE_OK, GOE_BAD_ARGUMENT or GOE_BAD_SETTINGS (a method that was left out among these); on failure the estimator is
 * left as it was.
 * Cost: at most 7900 instructions, 160 bytes of stack. */
GOE_NODISCARD goe_status_t goe_init(goe_estimator_t *estimator, size_t estimator_size, const goe_settings_t *settings,
                                    const char **bad_field);

/* Takes one image and reports the estimate after it.
 *   estimate  written by every call; all zero (valid = 0) with GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED and GOE_CORRUPTED. If it
 *             is null the image is not taken: GOE_BAD_ARGUMENT
 * Returns GOE_OK, a positive status, or one of GOE_BEHIND_CAMERA to GOE_BAD_ATTITUDE (GOE_BAD_HEIGHT is never returned, only
 * counted: GOE_PARTIAL is), GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED, GOE_CORRUPTED. If several faults meet in one image all are
 * counted; a failed solution is reported rather than a feature's fault, and of the features the first.
 * Use the estimate by its own valid, fresh, age_s and sigma, whatever the status.
 * Cost: at most 48000 instructions, 1408 bytes of stack; 70000 with lens distortion; window: 5500. No loop runs longer than
 * GOE_WINDOW_MAX or 20. */
goe_status_t goe_update(goe_estimator_t *estimator, const goe_image_t *image, goe_estimate_t *estimate);

/* The quantities of goe_covariance, in this order. */
enum { GOE_X0, GOE_Z0, GOE_ORIENTATION, GOE_WIDTH, GOE_LENGTH, GOE_HEIGHT, GOE_QUANTITIES };

/* Covariance of x0_m, z0_m, orientation_deg, width_m, length_m, height_m of the latest estimate: meters and degrees. Rows
 * and columns of a quantity that is not valid there are 0. The diagonal holds the sigmas squared, whatever the method and the
 * model. Of a stale answer x0 and z0 include what its age adds to x_m and z_m, and no variance is below its sigma squared. Of the
 * window's answer, and once the filter has started again or changed its model, there is nothing off the diagonal.
 *   covariance  written by every call unless null; all zero on failure
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED or GOE_CORRUPTED.
 * Cost: at most 10600 instructions, 880 bytes of stack. */
goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

/* What the aircraft is about to do: fly on at constant velocity. Slower than 0.1 m/s over the ground, or relative to an obstacle
 * that is followed, it is taken as standing still, also when it climbs or descends. */
typedef struct {
    float velocity_ned_m_s[3]; /* relative to the ground, each +-1e3 */
    float margin_m;            /* the outline of the obstacle must stay farther away than this, horizontally; 0 to 1e4 */
    float clearance_m;         /* ... or its top must lie deeper than this below the aircraft; 0 to 1e4 */
    float since_image_s;       /* how long ago the latest image was taken: the detector's latency, or its silence. It has flown at
                                  that velocity since, and times count from now; 0 to 1e3; 0: from that image */
    float velocity_sd_m_s;     /* one sigma of velocity_ned_m_s, each axis; 0 to 100; 0: navigation.velocity_bias_sd_m_s */
} goe_intent_t;

/* What will become of it. Sigmas are to first order, from the covariance of the estimate and the error of the intent's velocity.
 * Filter: a constant error of goe_pose_t.height_m moves camera and top by the same amount, and is not in the clearance. */
typedef struct {
    float tcpa_s;      /* until the horizontal distance to the obstacle's outline is smallest for the first time; if the
                          path crosses the outline: until it enters. 0: the distance grows already, or it is inside */
    float dcpa_m;      /* that distance; 0 if the path crosses the outline */
    float clearance_m; /* camera above the top at that time; negative: below it. Descending across the outline: where it
                          leaves it, which is the least. 0 if the height is not known */
    float tcpa_sd_s;   /* 0 if tcpa_s is. If a face is so nearly parallel to the path that either end may be the closest, it
                          spans the whole face */
    float dcpa_sd_m;   /* if the path crosses the outline: one sigma of the penetration depth */
    float clearance_sd_m;
    float conflict_probability; /* probability, 0 to 1, that the margin and the clearance are both violated; if the height is not
                          known: that the margin is. The clearance is that of clearance_m: within the margin, but before
                          or after that time, a slope costs up to climb * margin_m / speed more, which is for
                          goe_intent_t.clearance_m to allow for. Conservative (too high, never too low) when the errors of
                          distance and clearance are negatively correlated */
    bool has_clearance; /* the obstacle's height is known */
} goe_hazard_t;

/* Closest approach to the obstacle of the latest estimate, stale or not, suspect or not. The outline is the disc, or the box
 * as far as it is known: without orientation or length the circle of its width about the reference point, filter also while
 * the width is not valid yet; window, without width: that point alone, so that margin_m has to cover the obstacle's size. An image
 * without a detection changes nothing but the time, and a new start of the filter keeps position and size until a new answer
 * replaces them: uncertainty only grows. [A34] A suspect or stale estimate needs wider margins, not silence: goe_decide().
 *   hazard  written by every call unless null; all zero on failure: conflict_probability = 0 is not "safe" then
 * Returns GOE_OK, GOE_CONVERGING if there is no position, GOE_NOT_FINITE or GOE_OUT_OF_RANGE for the intent,
 * GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED or GOE_CORRUPTED.
 * Cost: at most 21300 instructions, 1110 bytes of stack. No loop runs longer than 10. */
#if GOE_WITH_HAZARD
GOE_NODISCARD goe_status_t goe_hazard(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_hazard_t *hazard);

/* When to act. goe_intent_t holds margin and clearance. */
typedef struct {
    float conflict_probability_max; /* act from this probability on; 0 to 1; default 0.1 */
    float act_within_s;  /* ... if the obstacle may be reached within this time, which is what the manoeuvre takes and some
                            seconds to decide; 0 to 1e4; default 12 */
    float suspect_factor; /* factor on margin and clearance while the estimate is suspect; 1 to 100; default 1.5 */
    float stale_growth_m_s; /* margin and clearance grow by this for each second without a new answer; 0 to 100; default 1 */
} goe_rule_t;

typedef enum {
    GOE_DECISION_UNKNOWN = 0, /* no position, or one so uncertain that neither distance is kept by one sigma although the
                                 probability is small, or that the obstacle may be reached within act_within_s at two sigma of the time, or
                                 one without a new answer for two seconds of detections: this does not make it safe; keep the
                                 previous decision */
    GOE_DECISION_CLEAR = 1,   /* no reason to act now */
    GOE_DECISION_ACT = 2,     /* go around, or avoid */
    GOE_DECISION_KEEP = 3     /* the call failed: keep the previous decision */
} goe_decision_t;

/* Sets *rule to its defaults. A null pointer is ignored.
 * Cost: at most 40 instructions, 16 bytes of stack. */
void goe_rule_default(goe_rule_t *rule);

/* The decision rule: goe_hazard() with the intent's margin and clearance widened by suspect_factor and age, and the rule's thresholds. Only
 * GOE_DECISION_CLEAR ends an action; no failure returns it.
 *   rule    null: the defaults
 *   hazard  the hazard with the widened distances, all zero without one; null if not wanted
 * Returns GOE_DECISION_KEEP for a bad argument, a intent or rule that is not finite or out of range, and an estimator that is not
 * initialized or corrupted.
 * Cost: at most 21800 instructions, 1200 bytes of stack. */
GOE_NODISCARD goe_decision_t goe_decide(const goe_estimator_t *estimator, const goe_intent_t *intent, const goe_rule_t *rule,
                                        goe_hazard_t *hazard);

/* The earliest time of the closest approach at two sigma, s: time^2 / (time + 2 sigma). 0 if *hazard is null or not finite.
 * Cost: at most 30 instructions, 16 bytes of stack. */
float goe_earliest_tcpa_s(const goe_hazard_t *hazard);
#endif

/* Forgets the track: windows, orientation, filter, estimate. Keeps settings and counters. For another obstacle, or a new
 * view of the same one. Returns GOE_OK, GOE_BAD_ARGUMENT, GOE_NOT_INITIALIZED or GOE_CORRUPTED.
 * Cost: at most 1640 instructions, 64 bytes of stack. */
goe_status_t goe_reset(goe_estimator_t *estimator);

/* A short lower-case name for a status ("ok", "no_baseline", ...), never null; "unknown" for any other number.
 * Cost: at most 1030 instructions, 32 bytes of stack. */
const char *goe_status_text(goe_status_t status);

/* The same for a reason: "moves", "late", ...; "none" for GOE_REASON_NONE.
 * Cost: at most 910 instructions, 32 bytes of stack. */
const char *goe_reason_text(goe_reason_t reason);

/* What the arithmetic of the library does on this machine, with the flags that goe_self_check.c was compiled with (give all
 * of lib/ the same): 0 if it is the IEEE 754 single precision arithmetic that bit identity rests on, otherwise a sum of
 * GOE_SELF_...
 * Cost: at most 2500 instructions, 160 bytes of stack. */
unsigned goe_self_check(void);
#define GOE_SELF_CONTRACTED 0x01u   /* a*b + c is rounded once (fused): compile with -ffp-contract=off */
#define GOE_SELF_REASSOCIATED 0x02u /* sums or products are reordered: -ffast-math, -fassociative-math */
#define GOE_SELF_RECIPROCAL 0x04u   /* a/b is computed as a*(1/b): -freciprocal-math */
#define GOE_SELF_FLUSHED 0x08u      /* subnormal numbers become zero: FPSCR.FZ, FTZ/DAZ, -ffast-math at link time */
#define GOE_SELF_EXCESS 0x10u       /* intermediate results carry more than float's precision: x87 */
#define GOE_SELF_ROUNDING 0x20u     /* not round-to-nearest-even, or sqrtf is not correctly rounded */

#ifdef __cplusplus
}
#endif

#endif /* GOE_H */
