/* Which points of an image are believed, and how much. SPDX-License-Identifier: MIT */
#ifndef GOE_GATE_H
#define GOE_GATE_H

#include "refined/goe_observation.h"

/* Bit i: feature i. */
typedef struct {
    unsigned measured, refused;
    int rows; /* that count */
    /* if there are two rows along x, the outer one's point, held against the other: */
    size_t held;        /* feature; GOE_FEATURES if there are not two */
    float held_sigmas2; /* normalised square of their difference */
    bool held_outward;  /* they lie farther apart than predicted */
} goe_verdict_t;

/* Whitens the rows: each divided by its sigma, less if it is suspicious, 0 if its point is refused. */
goe_verdict_t goe_gate_apply(const goe_settings_t *settings, const goe_filter_t *filter, goe_rows_t *rows);

#endif
