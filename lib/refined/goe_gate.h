/* Which points of an image are believed, and how much. SPDX-License-Identifier: MIT */
#ifndef GOE_GATE_H
#define GOE_GATE_H

#include "refined/goe_observation.h"

/* Bit i: feature i. */
typedef struct {
    unsigned measured, refused;
    int rows; /* that count */
} goe_verdict_t;

/* Factor on the variances for errors that are correlated from image to image: of points; those of a box's sides are modeled instead. */
float goe_gate_repeated(const goe_filter_t *filter, float point_correlation);

/* Whitens the rows: each divided by its sigma, less if it is suspicious, 0 if its point is refused: rows->weight. */
goe_verdict_t goe_gate_apply(const goe_settings_t *settings, const goe_filter_t *filter, goe_rows_t *rows);

#endif
