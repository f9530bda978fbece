/* Interface for Python in addition to goe.h: settings by number, and whole tracks in one call. The package `goe` compiles it; so does
 * sim_host, in double precision, for the tools that measure the rounding of floats. SPDX-License-Identifier: MIT */
#ifndef GOE_PYTHON_H
#define GOE_PYTHON_H

#include "goe.h"

enum { GOE_PYTHON_REAL, GOE_PYTHON_COUNT, GOE_PYTHON_TRUTH, GOE_PYTHON_CHOICE };

/* A row of goe_settings_list.h. A setting whose default is outside its range must be set. */
typedef struct {
    const char *name, *unit, *text;
    int kind; /* GOE_PYTHON_REAL, ... */
    double low, high, value;
} goe_python_setting_t;

/* Rows from 0 on, those of the camera first; null after the last. */
const goe_python_setting_t *goe_python_setting(int row);

/* How many of them are of the camera. */
int goe_python_camera_settings(void);

/* values: of every row; after them those of the camera's rows for each further camera. */
void goe_python_settings(const double *values, int cameras, goe_settings_t *settings);

/* goe_init() with such settings; the estimator is of goe_python_estimator_size() bytes. */
goe_status_t goe_python_init(goe_estimator_t *estimator, const double *values, int cameras, const char **bad_field);
size_t goe_python_estimator_size(void);

/* Bytes of goe_image_t, goe_estimate_t and goe_hazard_t, for callers that lay them out by themselves. */
void goe_python_sizes(size_t sizes[3]);

/* What goe_decide() gets after each image: of goe_intent_t all but the velocity, and goe_rule_t. */
typedef struct {
    float margin_m, clearance_m;
    float suspect_factor;   /* 1: both as they are, also while the estimate is suspect */
    float stale_growth_m_s; /* 0: both as they are, also if it is old */
    float since_image_s;
    float conflict_probability_max, act_within_s;
    float velocity_sd_m_s;
} goe_python_rule_t;

/* Takes the images in order, and writes the estimate after each.
 *   velocity_ned_m_s  [images] planned; read if there are rules
 *   covariance        [images]; null: not wanted
 *   decision, hazard_status, hazard  [images][rules]; written if there are rules. hazard_status: GOE_OK with a hazard, otherwise
 *                     the reason for none: that of goe_hazard(), or GOE_OUT_OF_RANGE of a rule that goe_decide() refuses */
void goe_python_update(goe_estimator_t *estimator, size_t images, const goe_image_t *image, int32_t *status,
                       goe_estimate_t *estimate, float (*covariance)[GOE_QUANTITIES][GOE_QUANTITIES], size_t rules,
                       const goe_python_rule_t *rule, const float (*velocity_ned_m_s)[3], int32_t *decision,
                       int32_t *hazard_status, goe_hazard_t *hazard);

/* GOE_IMAGE_TAKEN of a status. */
bool goe_python_image_taken(int status);

#endif /* GOE_PYTHON_H */
