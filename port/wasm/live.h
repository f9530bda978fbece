/*
 * What JavaScript calls: a flight's controls in, image after image out.
 *
 * Controls and reports are arrays of floats in the order of the two lists below. JavaScript reads the names from the module, so
 * that no number is at home in two languages.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef GOE_WASM_LIVE_H
#define GOE_WASM_LIVE_H

#include "goe.h"

/* kind, detector: approach_kind_t and approach_detector_t. knows: 1 if the true noise and offset are configured,
 * 0 if it has its defaults. The others as in approach_plan_t; seed: 0 to 2^24. */
/* Tables, laid out by hand. */
/* clang-format off */
#define LIVE_CONTROLS(X) X(kind) X(detector) X(roll_deg) X(pixel_px) X(height_offset_m) X(side_m) X(knows) X(seed)

/* Meters, seconds, degrees, pixels. A sigma of 0 with a value of 0: not known.
 *   true_...   the aircraft, and the obstacle as in approach.h
 *   box_...    in the image: the box, or the hull of the visible points; 0 if none
 *   valid, model, suspect, fresh, age_s, nis_ratio, images_used   of goe_estimate_t
 *   ahead_m, right_m   the middle of the estimate's outline, relative to the aircraft; of a face alone the middle of that
 *   ahead_ahead_m2, ahead_right_m2, right_right_m2   the covariance of these two
 *   across_.., along_..   unit vectors (north, east) of width and length; 0 of a round obstacle
 *   order      0 nothing known yet, 1 clear, 2 the margin is in doubt but there is time, 3 go around, 4 too uncertain to say; by
 *              goe_decide: only "clear" ends 3
 *   the rest of goe_hazard_t, by the margins of goe_decide */
#define LIVE_FIELDS(X) \
    X(time_s) X(true_north_m) X(true_height_m) X(true_roll_deg) X(true_ahead_m) X(true_right_m) \
    X(true_width_m) X(true_length_m) X(true_width_in_view_m) X(true_obstacle_height_m) X(true_orientation_deg) X(true_round) \
    X(box_seen) X(box_left_px) X(box_top_px) X(box_right_px) X(box_bottom_px) \
    X(valid) X(model) X(suspect) X(fresh) X(age_s) X(nis_ratio) X(images_used) \
    X(ahead_m) X(right_m) X(ahead_ahead_m2) X(ahead_right_m2) X(right_right_m2) \
    X(width_m) X(width_sd_m) X(length_m) X(length_sd_m) X(height_m) X(height_sd_m) X(orientation_deg) X(orientation_sd_deg) \
    X(across_north) X(across_east) X(along_north) X(along_east) \
    X(order) X(conflict_probability) X(tcpa_s) X(tcpa_sd_s) X(dcpa_m) X(dcpa_sd_m) X(clearance_m) X(clearance_sd_m) X(has_clearance)
/* clang-format on */

/* The version of the library, "0.4.0". */
const char *live_version(void);

/* Names one after the other, each with its ending zero; an empty one ends the list. */
const char *live_control_names(void);
const char *live_field_names(void);

/* To be written before live_start; to be read after live_next. */
float *live_controls(void);
const float *live_fields(void);

/* Begins the flight that the controls say. Returns how many images it has; 0: the settings were refused. */
int live_start(void);

/* Flies on by one image. Returns 1, or 0 after the last. */
int live_next(void);

/* Of the latest image: goe_status_text, goe_reason_text. */
const char *live_status(void);
const char *live_reason(void);

#endif
