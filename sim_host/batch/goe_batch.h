/* The library over whole tracks at once, for callers that are not C: flat arrays in, flat arrays out, settings by name.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_BATCH_H
#define GOE_BATCH_H

#include <stddef.h>
#include <stdint.h>

#include "goe.h"

#define GOE_BATCH_POSE 8    /* north, east, down, height in m; quaternion w, x, y, z */
#define GOE_BATCH_PIXELS 12 /* u, v in px of left, right, top, base_left, base_near, base_right */
#define GOE_BATCH_FEATURES 6
#define GOE_BATCH_BOX 4      /* left, top, right, bottom in px */
#define GOE_BATCH_LABELS 9   /* goe_batch_label() names them */
#define GOE_BATCH_NUMBERS 20 /* goe_batch_number() names them */
#define GOE_BATCH_HAZARD 9   /* goe_batch_hazard() names them */

/* Of the arrays: float, also where double_precision.h makes doubles of the library's floats. */
#ifndef GOE_BATCH_FLOAT
typedef float goe_batch_float_t;
#define GOE_BATCH_FLOAT
#endif

size_t goe_batch_settings_size(void);
void goe_batch_default(goe_settings_t *settings);

/* Sets a field by its name in goe_settings_t ("detector.point_px", "camera.fx_px", "more_cameras[0].fx_px", "method", ...);
 * whole numbers and truth values as numbers too. Returns 0, or -1 if there is no such field or the value does not fit it. */
int goe_batch_set(goe_settings_t *settings, const char *name, double value);

/* Names of the columns of labels, numbers and hazards, in order; null after the last. */
const char *goe_batch_label(int column);
const char *goe_batch_number(int column);
const char *goe_batch_hazard(int column);

/* Names of what the label "reason" tells, from 0 on; null after the last. */
const char *goe_batch_reason(int number);

/* What goe_hazard() is asked after each image, by the README's rule: margin and clearance grow with doubt and age. */
typedef struct {
    goe_batch_float_t margin_m, clearance_m;
    goe_batch_float_t doubt;     /* times both while the estimate is suspect; 1: as they are */
    goe_batch_float_t drift_m_s; /* times the estimate's age, added to both; 0: as they are */
} goe_batch_plan_t;

typedef struct {
    int images;
    const int64_t *time_us;            /* [images] */
    const goe_batch_float_t *pose;     /* [images][GOE_BATCH_POSE] */
    const goe_batch_float_t *pixel_px; /* [images][GOE_BATCH_PIXELS] */
    const uint8_t *seen;               /* [images][GOE_BATCH_FEATURES] */
    const goe_batch_float_t *box_px;   /* [images][GOE_BATCH_BOX]; null: no boxes */
    const uint8_t *box_seen;           /* [images] GOE_SEES_...; null only if box_px is */
    const uint8_t *reset_count;        /* [images] of the autopilot's filter; null: no reset */
    const goe_batch_float_t
        *reset_m; /* [images][3] by how much it jumped, NaN: not known; null only if reset_count is */
    const goe_batch_float_t *velocity; /* [images][3] planned, NED, m/s; null only if there are no plans */
    int plans;
    const goe_batch_plan_t *plan; /* [plans] */
    const uint8_t *camera;        /* [images] number of that which took it; null: the first */
} goe_batch_track_t;

typedef struct {
    int32_t *label;                /* [images][GOE_BATCH_LABELS] */
    goe_batch_float_t *number;     /* [images][GOE_BATCH_NUMBERS] */
    goe_batch_float_t *covariance; /* [images][GOE_QUANTITIES][GOE_QUANTITIES], m and deg; null: not wanted */
    goe_batch_float_t *hazard;     /* [images][plans][GOE_BATCH_HAZARD]; null only if there are no plans */
} goe_batch_answer_t;

/* Runs one estimator over a track. Returns GOE_OK, GOE_BAD_ARGUMENT or GOE_BAD_SETTINGS with the field's name. */
int goe_batch_run(const goe_settings_t *settings, const goe_batch_track_t *track, const goe_batch_answer_t *answer,
                  const char **bad_field);

#endif /* GOE_BATCH_H */
