/* Settings of an estimator. Included by goe.h. SPDX-License-Identifier: MIT
 *
 * Generated from goe_settings_list.h by python -m ci settings_header --write. Each comment states meaning, range and default of
 * its field. [A26] Errors are one sigma. An error that is "new in each image" is white noise. A "constant" error does not change
 * over a track. DESIGN.md has notes on the choice of values. Fields of a part that was left out are neither read nor checked. */
#ifndef GOE_SETTINGS_H
#define GOE_SETTINGS_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

/* Generated tables. */
/* clang-format off */
typedef enum { GOE_METHOD_WINDOW = 1, GOE_METHOD_FILTER = 2 } goe_method_t;

/* The model of the obstacle. */
typedef enum {
    GOE_MODEL_NONE = 0, /* estimate only: no solution yet */
    GOE_MODEL_AUTO = 1, /* setting only. Window: the disc until window.line_points line points exist, then the line until
                         * goe_reset. Filter: the prism until base corners show a box */
    GOE_MODEL_DISC = 2, /* an upright cylinder; window: also the circle that replaces any other shape; equation (2). As a setting of the
                         * filter: the obstacle is round, so its depth is known */
    GOE_MODEL_LINE = 3, /* the front edge of a box, from base corners; equation (3). As a setting of the filter: a box from
                         * the start */
    GOE_MODEL_BOX = 4,  /* estimate of the filter only: an upright box */
    GOE_MODEL_PRISM = 5 /* estimate of the filter only: an upright solid observed by its silhouette. Its width is across
                         * the line of sight of the filter's first image; its depth along it is unknown, and part of the sigma of
                         * the position, until the line of sight has turned by some 17 degrees */
} goe_model_t;

/* Pinhole camera with a Brown-Conrady lens, in OpenCV's conventions, and its mounting. If all mounting angles are 0, the camera
 * looks along body x, image x is body y, and image y is body z. The mounting turns the camera by yaw about z, then by pitch
 * about the new y, then by roll about the newest x. If the size is not 0, the focal length is at least a twentieth of it, and the
 * principal point at most 1.5 focal lengths outside the image. */
typedef struct {
    float fx_px;           /* focal length along x; 1 to 1e5 px; no default: must be set */
    float fy_px;           /* focal length along y; 1 to 1e5 px; no default: must be set */
    float cx_px;           /* principal point, x; -1e5 to 1e5 px; no default: must be set */
    float cy_px;           /* principal point, y; -1e5 to 1e5 px; no default: must be set */
    float k1;              /* radial lens distortion, in OpenCV's order and meaning; -100 to 100; default 0 */
    float k2;              /* radial lens distortion; -100 to 100; default 0 */
    float p1;              /* tangential lens distortion; -100 to 100; default 0 */
    float p2;              /* tangential lens distortion; -100 to 100; default 0 */
    float k3;              /* radial lens distortion; -100 to 100; default 0 */
    float mount_yaw_deg;   /* mounting yaw, negative if the camera looks left; -360 to 360 deg; default 0 */
    float mount_pitch_deg; /* mounting pitch, negative if the camera looks down; -360 to 360 deg; default 0 */
    float mount_roll_deg;  /* mounting roll, positive if the camera leans to the right; -360 to 360 deg; default 0 */
    float offset_m[3];     /* camera relative to pose.position_ned_m, body FRD; -1e4 to 1e4 m; default 0 */
    float width_px;        /* width of the image; 0: unknown, then no box may be cut; 0 to 1e5 px; no default: must be set */
    float height_px;       /* height of the image; 0: unknown, then no box may be cut; 0 to 1e5 px; no default: must be set */
    float border_rel;      /* a side this near to the border is not measured; fraction of the image's width; 0 to 0.5; default 0.012 */
    float truncation_rel;  /* a box whose left or right is this near to the border is cut; same fraction; 0 to 0.5; default 0.04 */
} goe_camera_t;

/* Errors of the pose, for the filter method. goe_hazard() uses velocity_bias_sd_m_s with both methods. */
typedef struct {
    float attitude_bias_sd_deg;  /* constant attitude error of each body axis, including the mounting's; 1e-3 to 30 deg; default 0.5 */
    float attitude_white_sd_deg; /* attitude error, new in each image; 1e-4 to 30 deg; default 0.1 */
    float attitude_walk_sd_deg;  /* random walk of the attitude error; 0 to 30 deg/s^0.5; default 0 */
    float height_bias_sd_m;      /* constant error of pose.height_m; 1e-3 to 1e3 m; default 0.5 */
    float position_walk_sd_m;    /* random walk of the aircraft's position; 0 to 100 m/s^0.5; default 0.05 */
    float position_white_sd_m;   /* error of each position axis, new in each image; 0 to 100 m; default 0 */
    float height_white_sd_m;     /* error of pose.height_m, new in each image; 0 to 1e3 m; default 0.5 */
    float terrain_slope_sd;      /* slope of the ground between aircraft and obstacle at first sight; 0 to 1; default 0.01 */
    float terrain_height_sd_m;   /* height error of the obstacle's ground; 0 to 1e3 m; default 2 */
    float velocity_bias_sd_m_s;  /* constant error of the aircraft's velocity, north and east; 0 to 100 m/s; default 0.05 */
} goe_navigation_t;

/* Errors of the features, for the filter method. */
typedef struct {
    float point_noise_px;         /* error of an image point, new in each image; 0.05 to 100 px; default 0.5 */
    float point_noise_rel;        /* error of points left, right, top, as a fraction of the obstacle's width in px; 0 to 1; default 0 */
    float point_correlation;      /* correlation of a point's error from image to image; 0 to 0.95; default 0 */
    float shape_error_rel;        /* model error of a disc or prism by points, as a fraction of its width; 0 to 1; default 0 */
    float box_noise_px;           /* error of a box's side, new in each image; 0.05 to 100 px; default 1 */
    float box_noise_rel;          /* slow error of a side, as a fraction of the box's width or height; 0 to 1; default 0.07 */
    float box_correlation_time_s; /* correlation time of box_noise_rel; 0 to 10 s; default 1.2 */
    float truncation_noise_rel;   /* error of a cut box's sides, as a fraction of its width or height; 0 to 10; default 1 */
} goe_detector_t;

/* Settings of the window method, Section 4 of the paper. */
typedef struct {
    int points;               /* images in the fit and in the sliding means; 3 to GOE_WINDOW_MAX; default 8 (at most GOE_WINDOW_MAX) */
    int line_points;          /* model auto: least number of line points before the line replaces the disc; 1 to 1000; default 8 */
    float edge_min_px;        /* length of the shortest edge that counts; 0 to 1e4 px; default 10 */
    float orientation_min_px; /* least vertical distance of an edge's ends that gives an orientation; 0 to 1e4 px; default 2 */
    float side_min_px;        /* least x distance of a side's ends to its vanishing point that gives a length; 0.1 to 1e4 px; default 10 */
    int orientation_memory;   /* memory of the orientation's low-pass; 1 to 1000; default 20 */
    float min_baseline_m;     /* smallest camera motion over the window that gives a solution; 1e-3 to 1e4 m; default 0.1 */
} goe_window_settings_t;

/* Settings of the filter method. */
typedef struct {
    float prior_width_m;    /* assumed width where the ground gives no range; sigma: a factor of 5; 0.1 to 1e3 m; default 6 */
    float gate_sigma;       /* a point with a larger innovation is rejected; 1 to 100 sigma; default 5 */
    float huber_sigma;      /* a point with a larger innovation counts less; 0.5 to 100 sigma; default 2.5 */
    float nis_ratio_max;    /* NIS ratio above which an estimate is suspect; 0.01 to 1e3; default 1.9 */
    float range_sd_rel_max; /* largest sigma of a reported range if the ground is level, as a fraction of the range; 0.01 to 10; default 0.25 */
    bool top_is_highest;    /* 1: point top is the roof's highest point in the image; 0: it is the roof's nearest point; default false */
} goe_filter_settings_t;

typedef struct {
    goe_camera_t camera; /* camera number 0 */
#if GOE_CAMERAS_MAX > 1
    goe_camera_t more_cameras[GOE_CAMERAS_MAX - 1]; /* cameras 1 and up, with the same ranges; default fx_px 0: no camera */
#endif
    goe_method_t method; /* 1 window, 2 filter; default filter (if compiled in) */
    goe_model_t model;   /* 1 auto, 2 disc, 3 line (filter: box); default auto */
    bool heading_auto;   /* Z takes the yaw of the vehicle at the track's first image; default true */
    float heading_deg;   /* heading of Z without heading_auto, clockwise from north; -360 to 360 deg; default 0 */
    goe_navigation_t navigation;
    goe_detector_t detector;
    goe_window_settings_t window;
    goe_filter_settings_t filter;
} goe_settings_t;
/* clang-format on */

#endif
