/* The scatter of the residuals beyond the configured noise. SPDX-License-Identifier: MIT */
#include "refined/goe_scatter.h"

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define KEPT 0.985f          /* share of the sums kept from image to image: some 67 images count */
#define RESIDUAL_MAX 10.0f   /* limit of a residual in sigmas: one outlier must not decide */
#define SEED 10.0f           /* added to the sum of squares: few images alone are not informative */
#define CHANCE 0.07f         /* one sigma by chance of the mean of NIS, and of the correlation, over their memory */
#define CORRELATION_MAX 0.9f /* largest correlation: beyond it the sums are not informative */

/* A normalized residual for the sums of the scatter: limited, and 0 if it is not finite. */
static float clipped(float normalized) {
    if (goe_within(normalized, RESIDUAL_MAX)) {
        return normalized;
    }
    if (goe_magnitude(normalized) >= GOE_INFINITY_BITS) {
        return 0.0f;
    }
    return normalized > 0.0f ? RESIDUAL_MAX : -RESIDUAL_MAX;
}

/* A refused row adds nothing to the sums. */
void goe_scatter_take(goe_scatter_t *scatter, const goe_rows_t *rows) {
    const unsigned previous = scatter->seen;
    unsigned seen = 0;
    float products = scatter->products * KEPT;
    float squares = scatter->squares * KEPT;
    for (size_t i = 0; i < rows->count; i++) {
        const size_t series = rows->series[i];
        const float residual = clipped(rows->matrix->row[i][GOE_RESIDUAL]);
        const float before = scatter->before[series];
        if ((previous >> series & 1u) != 0 && rows->weight[i] > 0.0f) {
            products += residual * before;
            squares += residual * residual;
        }
        scatter->before[series] = residual;
        seen |= rows->weight[i] > 0.0f ? 1u << series : 0u;
    }
    scatter->products = products;
    scatter->squares = squares;
    scatter->seen = (uint16_t)seen;
}

/* The part of an excess that is not chance: nothing of a small excess, nearly all of a large one. */
static float beyond_chance(float excess) { return excess > CHANCE ? excess - CHANCE * CHANCE / excess : 0.0f; }

float goe_scatter_factor(const goe_filter_t *filter, float repeated) {
    const goe_scatter_t *scatter = &filter->scatter;
    const float excess = goe_larger(filter->health.mean_nis - 1.0f, filter->health.excess);
    const float scale = 1.0f + (excess > 0.0f ? beyond_chance(excess) : excess);
    const float correlation = beyond_chance(scatter->products / (scatter->squares + SEED));
    const float limited = correlation < CORRELATION_MAX ? correlation : CORRELATION_MAX;
    const float series = goe_larger((1.0f + limited) / ((1.0f - limited) * repeated), 1.0f);
    return goe_larger(scale * series, 1.0f);
}

#endif
