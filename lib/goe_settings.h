/* Settings of an estimator. Included by goe.h. SPDX-License-Identifier: MIT
 *
 * Generated from goe_settings_list.h by python -m ci settings_header --write. Each field: meaning; range; default. [A26]
 * Errors are one sigma. "New in each image" is white noise; "constant" is the same over a track. DESIGN.md has notes on the
 * choice of values. Fields of a part that was left out are neither read nor checked. */
#ifndef GOE_SETTINGS_H
#define GOE_SETTINGS_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

/* Tables, generated. */
/* clang-format off */
typedef enum { GOE_METHOD_WINDOW = 1, GOE_METHOD_FILTER = 2 } goe_method_t;

/* The model of the obstacle that is reported. */
typedef enum {
    GOE_MODEL_NONE = 0, /* estimate only: nothing solved yet */
    GOE_MODEL_AUTO = 1, /* setting only. Window: the disc until window.line_points line points exist, then the line until
                         * goe_reset. Filter: the disc until the images show a box */
    GOE_MODEL_DISC = 2, /* an upright cylinder, or the circle that replaces anything else; (2) */
    GOE_MODEL_LINE = 3, /* (3): the front edge of a box; needs base corners. As a setting of the filter: a box from the start */
    GOE_MODEL_BOX = 4,  /* estimate only: a box with an upright, level outline. Filter */
    GOE_MODEL_PRISM = 5 /* estimate only: an upright solid by its bounding boxes, whose depth along the line of sight is not
                         * known. Width: across the line of sight of the filter's first image. Filter */
} goe_model_t;

/* Pinhole camera with Brown-Conrady lens, in OpenCV's conventions, and its mounting: the un-mounted camera looks along body x
 * with image x = body y and image y = body z; it is turned by yaw about z, then pitch about the new y, then roll about the
 * newest x. */
typedef struct {
    float fx_px;           /* focal length along x; 1 to 1e5 px; no default: must be set */
    float fy_px;           /* focal length along y; 1 to 1e5 px; no default: must be set */
    float cx_px;           /* principal point; -1e5 to 1e5 px; no default: must be set */
    float cy_px;           /* principal point; -1e5 to 1e5 px; no default: must be set */
    float k1;              /* lens distortion, radial, OpenCV's order and meaning; -100 to 100; default 0 */
    float k2;              /* lens distortion, radial; -100 to 100; default 0 */
    float p1;              /* lens distortion, tangential; -100 to 100; default 0 */
    float p2;              /* lens distortion, tangential; -100 to 100; default 0 */
    float k3;              /* lens distortion, radial; -100 to 100; default 0 */
    float mount_yaw_deg;   /* mounting; a camera that looks left has a negative yaw; -360 to 360 deg; default 0 */
    float mount_pitch_deg; /* mounting; -360 to 360 deg; default 0 */
    float mount_roll_deg;  /* mounting; -360 to 360 deg; default 0 */
    float offset_m[3];     /* camera relative to pose.position_ned_m, body FRD; -1e4 to 1e4 m; default 0 */
    float width_px;        /* width of the image; 0: not known; 0 to 1e5 px; default 0 */
    float height_px;       /* height of the image; 0: not known; 0 to 1e5 px; default 0 */
    float border_rel;      /* a side nearer to the border is not measured, of the image's width; 0 to 0.5; default 0.012 */
    float truncation_rel;  /* a box whose side is nearer to the border is cut, of the image's width; 0 to 0.5; default 0.04 */
} goe_camera_t;

/* Errors of the pose. Filter method, except the velocity's. */
typedef struct {
    float velocity_bias_sd_m_s;  /* constant error of the own velocity, north and east; 0 to 100 m/s; default 0.05 */
    float attitude_bias_sd_deg;  /* constant attitude error, each body axis, mounting included; 1e-3 to 30 deg; default 0.5 */
    float attitude_white_sd_deg; /* attitude error, new in each image; 1e-4 to 30 deg; default 0.1 */
    float attitude_walk_sd_deg;  /* random walk of the attitude error; 0 to 30 deg/s^0.5; default 0 */
    float height_bias_sd_m;      /* constant error of pose.height_m; 1e-3 to 1e3 m; default 0.5 */
    float position_walk_sd_m;    /* random walk of the own position; 0 to 100 m/s^0.5; default 0.05 */
    float position_white_sd_m;   /* error of each axis of the position, new in each image; boxes; 0 to 100 m; default 0 */
    float height_white_sd_m;     /* error of pose.height_m, new in each image; 0: none; 0 to 1e3 m; default 0 */
    float terrain_slope_sd;      /* slope of the ground that the height is above, m per m flown; 0 to 1; default 0 */
    float terrain_height_sd_m;   /* height error of the obstacle's ground; 1000: no altimeter; boxes; 0 to 1e3 m; default 2 */
} goe_navigation_t;

/* Errors of the features. Filter method. */
typedef struct {
    float point_noise_px;         /* error of an image point, new in each image; rounding: 0.3; 0.05 to 100 px; default 0.5 */
    float point_noise_rel;        /* error of left, right, top as points, of the width; 0 to 1; default 0 */
    float point_correlation;      /* correlation of a point's error from image to image; 0 to 0.95; default 0 */
    float shape_error_rel;        /* model error of the disc, of its width; cars: 0.12; 0 to 1; default 0 */
    float box_noise_px;           /* error of a box's side, new in each image; 0.05 to 100 px; default 1 */
    float box_noise_rel;          /* slowly varying error of a side, of the box's width or height; 0 to 1; default 0.07 */
    float box_correlation_time_s; /* correlation time of this error; 0 to 100 s; default 1.2 */
    float truncation_noise_rel;   /* error of every side of a cut box, of its width or height; 0 to 10; default 1 */
} goe_detector_t;

/* The window method, Section 4 of the paper. */
typedef struct {
    int points;               /* images in the fit and the sliding means; 3 to GOE_WINDOW_MAX; default 8 */
    int line_points;          /* model auto: line points before the line replaces the disc; 1 to 1000; default 8 */
    float edge_min_px;        /* shorter edges do not count; 0 to 1e4 px; default 10 */
    float orientation_min_px; /* flatter edges have no orientation; 0 to 1e4 px; default 2 */
    float side_min_px;        /* a side edge nearer to edge-on gives no length; 0.1 to 1e4 px; default 10 */
    int orientation_memory;   /* images that the low-pass of the orientation remembers; 1 to 1000; default 20 */
    float min_baseline_m;     /* less camera motion over the window gives no solution; 1e-3 to 1e4 m; default 0.1 */
} goe_window_settings_t;

/* The filter method. */
typedef struct {
    float prior_width_m;    /* prior width, to a factor of 3, where the ground gives no range; 0.1 to 1e3 m; default 6 */
    float gate_sigma;       /* a point farther off is left out; 1 to 100 sigma; default 5 */
    float huber_sigma;      /* a point farther off counts less; 0.5 to 100 sigma; default 2.5 */
    float nis_ratio_max;    /* NIS ratio above which the obstacle is suspect; 0.01 to 1e3; default 1.9 */
    float range_sd_rel_max; /* sigma over range up to which a position is reported; 0.01 to 10; default 0.25 */
    bool top_is_highest;    /* top, as a point, is the highest one in the image, also from above; default false */
} goe_filter_settings_t;

typedef struct {
    goe_camera_t camera; /* number 0 */
#if GOE_CAMERAS_MAX > 1
    goe_camera_t more_cameras[GOE_CAMERAS_MAX - 1]; /* numbers 1 on, each with the ranges of camera; default: fx_px 0, none */
#endif
    goe_method_t method; /* 1 window, 2 filter; default filter (if compiled in) */
    goe_model_t model;   /* 1 auto, 2 disc, 3 line (filter: a box); default auto */
    bool heading_auto;   /* Z is the vehicle's yaw at the track's first image; default true */
    float heading_deg;   /* otherwise Z has this heading, clockwise from north; -360 to 360 deg; default 0 */
    goe_navigation_t navigation;
    goe_detector_t detector;
    goe_window_settings_t window;
    goe_filter_settings_t filter;
} goe_settings_t;
/* clang-format on */

#endif
