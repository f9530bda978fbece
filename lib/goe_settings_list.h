/* The single list of all settings. Defaults, checks, the programs' --set and the documentation come from it.
 * SPDX-License-Identifier: MIT
 *
 *   X(field, kind, unit, low, high, by default, text)
 *
 * field is the path in goe_settings_t. kind is REAL, COUNT (int), TRUTH (bool) or CHOICE (the number of an enumerator). The user
 * must set a setting whose default is outside its range. Settings of a part that was left out are not in the list. */
#ifndef GOE_SETTINGS_LIST_H
#define GOE_SETTINGS_LIST_H

#include "goe.h"

/* A table, formatted by hand. */
/* clang-format off */
#define GOE_SETTINGS_CAMERA(X) \
    X(camera.fx_px, REAL, "px", 1.0f, 1.0e5f, 0.0f, "focal length along x") \
    X(camera.fy_px, REAL, "px", 1.0f, 1.0e5f, 0.0f, "focal length along y") \
    X(camera.cx_px, REAL, "px", -1.0e5f, 1.0e5f, -1.0e6f, "principal point, x") \
    X(camera.cy_px, REAL, "px", -1.0e5f, 1.0e5f, -1.0e6f, "principal point, y") \
    X(camera.k1, REAL, "", -100.0f, 100.0f, 0.0f, "radial lens distortion, in OpenCV's order and meaning") \
    X(camera.k2, REAL, "", -100.0f, 100.0f, 0.0f, "radial lens distortion") \
    X(camera.p1, REAL, "", -100.0f, 100.0f, 0.0f, "tangential lens distortion") \
    X(camera.p2, REAL, "", -100.0f, 100.0f, 0.0f, "tangential lens distortion") \
    X(camera.k3, REAL, "", -100.0f, 100.0f, 0.0f, "radial lens distortion") \
    X(camera.mount_yaw_deg, REAL, "deg", -360.0f, 360.0f, 0.0f, "mounting yaw, negative if the camera looks left") \
    X(camera.mount_pitch_deg, REAL, "deg", -360.0f, 360.0f, 0.0f, "mounting pitch, negative if the camera looks down") \
    X(camera.mount_roll_deg, REAL, "deg", -360.0f, 360.0f, 0.0f, "mounting roll, positive if the camera leans to the right") \
    X(camera.offset_m[0], REAL, "m", -1.0e4f, 1.0e4f, 0.0f, "lever arm, body forward") \
    X(camera.offset_m[1], REAL, "m", -1.0e4f, 1.0e4f, 0.0f, "lever arm, body right") \
    X(camera.offset_m[2], REAL, "m", -1.0e4f, 1.0e4f, 0.0f, "lever arm, body down") \
    X(camera.width_px, REAL, "px", 0.0f, 1.0e5f, -1.0f, "width of the image; 0: unknown, then no box may be cut") \
    X(camera.height_px, REAL, "px", 0.0f, 1.0e5f, -1.0f, "height of the image; 0: unknown, then no box may be cut") \
    X(camera.border_rel, REAL, "", 0.0f, 0.5f, 0.012f, "a side this near to the border is not measured; fraction of the image's width") \
    X(camera.truncation_rel, REAL, "", 0.0f, 0.5f, 0.04f, "a box whose left or right is this near to the border is cut; same fraction")

#define GOE_SETTINGS_GENERAL(X) \
    X(method, CHOICE, "", GOE_METHOD_MIN, GOE_METHOD_MAX, GOE_METHOD_MAX, "1 window, 2 filter") \
    X(model, CHOICE, "", GOE_MODEL_AUTO, GOE_MODEL_LINE, GOE_MODEL_AUTO, "1 auto, 2 disc, 3 line (filter: box)") \
    X(heading_auto, TRUTH, "", 0, 1, 1, "Z takes the yaw of the vehicle at the track's first image") \
    X(heading_deg, REAL, "deg", -360.0f, 360.0f, 0.0f, "heading of Z without heading_auto, clockwise from north")

#if GOE_WITH_FILTER
#define GOE_SETTINGS_FILTER(X) \
    X(navigation.attitude_bias_sd_deg, REAL, "deg", 1.0e-3f, 30.0f, 0.5f, "constant attitude error of each body axis, including the mounting's") \
    X(navigation.attitude_white_sd_deg, REAL, "deg", 1.0e-4f, 30.0f, 0.1f, "attitude error, new in each image") \
    X(navigation.attitude_walk_sd_deg, REAL, "deg/s^0.5", 0.0f, 30.0f, 0.0f, "random walk of the attitude error") \
    X(navigation.height_bias_sd_m, REAL, "m", 1.0e-3f, 1.0e3f, 0.5f, "constant error of pose.height_m") \
    X(navigation.position_walk_sd_m, REAL, "m/s^0.5", 0.0f, 100.0f, 0.05f, "random walk of the aircraft's position") \
    X(navigation.position_white_sd_m, REAL, "m", 0.0f, 100.0f, 0.0f, "error of each position axis, new in each image") \
    X(navigation.height_white_sd_m, REAL, "m", 0.0f, 1.0e3f, 0.5f, "error of pose.height_m, new in each image") \
    X(navigation.terrain_slope_sd, REAL, "", 0.0f, 1.0f, 0.01f, "slope of the ground between aircraft and obstacle at first sight") \
    X(navigation.terrain_height_sd_m, REAL, "m", 0.0f, 1.0e3f, 2.0f, "height error of the obstacle's ground") \
    X(detector.point_noise_px, REAL, "px", 0.05f, 100.0f, 0.5f, "error of an image point, new in each image") \
    X(detector.point_noise_rel, REAL, "", 0.0f, 1.0f, 0.0f, "error of points left, right, top, as a fraction of the obstacle's width in px") \
    X(detector.point_correlation, REAL, "", 0.0f, 0.95f, 0.0f, "correlation of a point's error from image to image") \
    X(detector.shape_error_rel, REAL, "", 0.0f, 1.0f, 0.0f, "model error of a disc or prism by points, as a fraction of its width") \
    X(detector.box_noise_px, REAL, "px", 0.05f, 100.0f, 1.0f, "error of a box's side, new in each image") \
    X(detector.box_noise_rel, REAL, "", 0.0f, 1.0f, 0.07f, "slow error of a side, as a fraction of the box's width or height") \
    X(detector.box_correlation_time_s, REAL, "s", 0.0f, 10.0f, 1.2f, "correlation time of box_noise_rel") \
    X(detector.truncation_noise_rel, REAL, "", 0.0f, 10.0f, 1.0f, "error of a cut box's sides, as a fraction of its width or height") \
    X(filter.prior_width_m, REAL, "m", 0.1f, 1.0e3f, 6.0f, "assumed width where the ground gives no range; sigma: a factor of 5") \
    X(filter.gate_sigma, REAL, "sigma", 1.0f, 100.0f, 5.0f, "a point with a larger innovation is rejected") \
    X(filter.huber_sigma, REAL, "sigma", 0.5f, 100.0f, 2.5f, "a point with a larger innovation counts less") \
    X(filter.nis_ratio_max, REAL, "", 0.01f, 1.0e3f, 1.9f, "NIS ratio above which an estimate is suspect") \
    X(filter.range_sd_rel_max, REAL, "", 0.01f, 10.0f, 0.25f, "largest sigma of a reported range if the ground is level, as a fraction of the range") \
    X(filter.top_is_highest, TRUTH, "", 0, 1, 0, "1: point top is the roof's highest point in the image; 0: it is the roof's nearest point")
#else
#define GOE_SETTINGS_FILTER(X)
#endif

/* Used with every method: the default sigma of an intent's velocity. */
#define GOE_SETTINGS_VELOCITY(X) \
    X(navigation.velocity_bias_sd_m_s, REAL, "m/s", 0.0f, 100.0f, 0.05f, "constant error of the aircraft's velocity, north and east")

#if GOE_WITH_WINDOW
#define GOE_SETTINGS_WINDOW(X) \
    X(window.points, COUNT, "images", 3, GOE_WINDOW_MAX, GOE_WINDOW_DEFAULT, "images in the fit and in the sliding means") \
    X(window.line_points, COUNT, "images", 1, 1000, 8, "model auto: least number of line points before the line replaces the disc") \
    X(window.edge_min_px, REAL, "px", 0.0f, 1.0e4f, 10.0f, "length of the shortest edge that counts") \
    X(window.orientation_min_px, REAL, "px", 0.0f, 1.0e4f, 2.0f, "least vertical distance of an edge's ends that gives an orientation") \
    X(window.side_min_px, REAL, "px", 0.1f, 1.0e4f, 10.0f, "least x distance of a side's ends to its vanishing point that gives a length") \
    X(window.orientation_memory, COUNT, "images", 1, 1000, 20, "memory of the orientation's low-pass") \
    X(window.min_baseline_m, REAL, "m", 1.0e-3f, 1.0e4f, 0.1f, "smallest camera motion over the window that gives a solution")
#else
#define GOE_SETTINGS_WINDOW(X)
#endif
/* clang-format on */

#define GOE_SETTINGS(X)                                                                                                \
    GOE_SETTINGS_CAMERA(X)                                                                                             \
    GOE_SETTINGS_GENERAL(X) GOE_SETTINGS_FILTER(X) GOE_SETTINGS_VELOCITY(X) GOE_SETTINGS_WINDOW(X)

#if GOE_WINDOW_MAX < 8
#define GOE_WINDOW_DEFAULT GOE_WINDOW_MAX
#else
#define GOE_WINDOW_DEFAULT 8
#endif
#define GOE_METHOD_MIN (GOE_WITH_WINDOW ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER)
#define GOE_METHOD_MAX (GOE_WITH_FILTER ? GOE_METHOD_FILTER : GOE_METHOD_WINDOW)

#endif
