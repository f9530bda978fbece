/* The test of an obstacle's growth in the image, (R34). SPDX-License-Identifier: MIT */
#include "refined/goe_growth.h"

#include "maths/goe_scalar.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define LEVEL (GOE_SIDE_TOP | GOE_SIDE_BOTTOM)
#define AHEAD_MIN 0.7f /* least Z over Z0: nearer, the line of sight may have turned, and another face may be visible */

/* Uses the height if a box shows it, because it does not change with the direction of view; otherwise the width. */
float goe_growth_find(const goe_observation_t *obs, const goe_rows_t *rows) {
    const bool tall = goe_sides_see(obs->sides, LEVEL);
    const goe_feature_t low = tall ? GOE_POINT_TOP : GOE_POINT_LEFT;
    const goe_feature_t high = tall ? GOE_POINT_BASE_NEAR : GOE_POINT_RIGHT;
    const float ahead = goe_observation_reference(obs).z;
    const float size = goe_touch_size(obs, tall ? GOE_BOX_TOP : GOE_BOX_LEFT, 2.0f * obs->state[GOE_HALF]);
    const float nearest = goe_larger(ahead, AHEAD_MIN);
    const float drift = obs->settings->navigation.velocity_bias_sd_m_s * obs->elapsed_s * obs->state[GOE_INVERSE_RANGE];
    const float share2 = 2.0f * goe_square(obs->settings->detector.box_noise_rel) +
                         (obs->range_variance * goe_square(obs->camera_m.z) + goe_square(drift)) / goe_square(nearest);
    float variance = share2 * goe_square(size);
    const bool whole = tall && (obs->sides->cut & LEVEL) == 0u; /* a cut at left or right does not change the height */
    const float uncut = whole ? goe_touch_cut_variance(obs, size) : 0.0f;
    float excess = 0.0f;
    unsigned ends = 0;
    for (size_t i = 0; i < rows->remembered; i++) { /* sides of a box, or left and right */
        if (rows->feature[i] == low || rows->feature[i] == high) {
            excess = rows->matrix->row[i][GOE_RESIDUAL] - excess; /* the low end comes first */
            variance += rows->variance[i] - uncut;
            ends++;
        }
    }
    if (ends < 2u) {
        return GOE_GROWTH_UNSEEN;
    }
    return ahead > AHEAD_MIN && excess > 0.0f ? goe_square(excess) / variance : 0.0f;
}

#endif
