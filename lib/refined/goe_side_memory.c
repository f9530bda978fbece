/* The memory of the slowly varying error of a box's side. SPDX-License-Identifier: MIT */
#include "refined/goe_side_memory.h"

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

void goe_side_memory_fade(goe_side_memory_t *side, float fade, float variance) {
    if (!(side->variance > 0.0f)) {
        side->variance = -variance;
        return;
    }
    const float now = fade * fade * side->variance + (1.0f - fade * fade) * variance;
    side->variance = now < variance ? now : variance;
    side->value *= fade;
    for (size_t i = 0; i < GOE_UNKNOWNS; i++) {
        side->by[i] *= fade;
    }
}

void goe_side_memory_recall(const goe_side_memory_t *side, float row[GOE_COLUMNS], float *variance) {
    float *by = &row[GOE_STATE_COLUMN];
    for (size_t i = 0; i < GOE_UNKNOWNS; i++) {
        by[i] -= side->by[i];
    }
    row[GOE_RESIDUAL] -= side->value;
    *variance += goe_absolute(side->variance);
}

void goe_side_memory_learn(goe_side_memory_t *side, const float row[GOE_COLUMNS], float weight, float own,
                           const float opposite[GOE_COLUMNS], float both) {
    if (!(weight > 0.0f)) {
        return;
    }
    const float variance = goe_absolute(side->variance);
    const float gain = variance * weight * (1.0f - own);
    const float opposite_gain = variance * weight * both;
    for (size_t i = 0; i < GOE_UNKNOWNS; i++) {
        side->by[i] += gain * row[GOE_STATE_COLUMN + i] - opposite_gain * opposite[GOE_STATE_COLUMN + i];
    }
    side->value += gain * row[GOE_RESIDUAL] - opposite_gain * opposite[GOE_RESIDUAL];
    side->variance = variance - gain * variance * weight;
}

void goe_side_memory_follow(goe_side_memory_t *side, const float change[GOE_UNKNOWNS]) {
    for (size_t i = 0; i < GOE_UNKNOWNS; i++) {
        side->value -= side->by[i] * change[i];
    }
}

#endif
