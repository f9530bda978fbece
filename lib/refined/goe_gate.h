/* The outlier gate: which points of an image count, and with which weight. SPDX-License-Identifier: MIT */
#ifndef GOE_GATE_H
#define GOE_GATE_H

#include "refined/goe_observation.h"

/* Result of the gate. Bit i: feature i. */
typedef struct {
    unsigned measured, refused;
    int rows; /* rows that are not refused */
} goe_verdict_t;

/* Factor on the variances of points for errors that are correlated from image to image; 1 for a footprint by upright boxes, because the
 * errors of their sides are modeled. */
float goe_gate_repeated(const goe_filter_t *filter, float point_correlation);

/* Whitens the rows: multiplies each by rows->weight, which is 1/sigma, less for a suspicious point, and 0 for a refused one. */
goe_verdict_t goe_gate_apply(const goe_settings_t *settings, const goe_filter_t *filter, goe_rows_t *rows);

#endif
