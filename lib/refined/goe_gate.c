/* The outlier gate and the Huber weights. SPDX-License-Identifier: MIT
 *
 * The noise of the attitude moves all points of an image together. Along x, and along y, the gate therefore tests the row with the median
 * residual by itself, and the other rows by their difference from it, in which that noise nearly cancels. */
#include "refined/goe_gate.h"

#include <math.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

typedef struct {
    uint8_t row[GOE_ROWS_MAX]; /* in the order of their residuals */
    size_t count;
    size_t middle; /* row of the median residual */
} group_t;

/*@ requires goe_rows_hold(rows) && row < rows->count; */
static float residual_of(const goe_rows_t *rows, size_t row) { return rows->matrix->row[row][GOE_RESIDUAL]; }

static void gather(const goe_rows_t *rows, goe_axis_t axis, group_t *group) {
    group->count = 0;
    for (size_t i = 0; i < rows->count; i++) {
        if (rows->axis[i] != axis) {
            continue;
        }
        size_t at = group->count++;
        for (; at > 0 && residual_of(rows, group->row[at - 1]) > residual_of(rows, i); at--) {
            group->row[at] = group->row[at - 1];
        }
        group->row[at] = (uint8_t)i;
    }
    const size_t half = group->count / 2;
    const bool even = group->count > 0 && group->count % 2 == 0;
    group->middle = group->count > 0 ? group->row[half] : 0;
    if (even &&
        goe_absolute(residual_of(rows, group->row[half - 1])) < goe_absolute(residual_of(rows, group->middle))) {
        group->middle = group->row[half - 1];
    }
}

#if GOE_AUGMENTED
/* Variance by the augmented states. They move the points of an image nearly equally, so differences of points omit it. */
static float augmented_variance(const goe_filter_t *filter, const float *row, const float projected[GOE_STATES]) {
    float part[GOE_AUGMENTED];
    goe_srif_augmented(&filter->root, projected, 0, &row[GOE_AUGMENTED_COLUMN], 0.0f, part);
    return goe_srif_augmented_dot(part, part);
}
#endif

/* The filter's data for the gate: the state's errors as of the latest rows, and the variance of the process noise since then. */
typedef struct {
    const goe_filter_t *filter;
    float reciprocal[GOE_STATES]; /* of R */
    float drift2;                 /* of each attitude bias */
    float walk2;                  /* of the bearing */
} known_t;

GOE_STATIC_ASSERT(GOE_STATES % 5 == 0, a_difference_of_rows_is_taken_by_five_states_at_a_time);

/* (R14): normalized square of a row's residual or, if `middle` is another row, of the difference of both residuals. */
/*@ requires \valid_read(known) && goe_rows_hold(rows) && row < rows->count && middle < rows->count; */
static float innovation(const known_t *known, const goe_rows_t *rows, size_t row, size_t middle) {
    const goe_filter_t *filter = known->filter;
    float weight[GOE_STATES];
    const float white = rows->white_rad;
    const float other = row == middle ? 0.0f : 1.0f;
    const float *a = rows->matrix->row[row];
    const float *b = rows->matrix->row[middle];
    float attitude = 0.0f;
    for (size_t c = 0; c < GOE_NUISANCES; c++) {
        const float d = a[c] - other * b[c];
        attitude += d * d;
    }
    for (size_t c = 0; c < GOE_STATES; c += 5) { /* partly written out, as in scale_row() */
        weight[c] = a[GOE_STATE_COLUMN + c] - other * b[GOE_STATE_COLUMN + c];
        weight[c + 1] = a[GOE_STATE_COLUMN + c + 1] - other * b[GOE_STATE_COLUMN + c + 1];
        weight[c + 2] = a[GOE_STATE_COLUMN + c + 2] - other * b[GOE_STATE_COLUMN + c + 2];
        weight[c + 3] = a[GOE_STATE_COLUMN + c + 3] - other * b[GOE_STATE_COLUMN + c + 3];
        weight[c + 4] = a[GOE_STATE_COLUMN + c + 4] - other * b[GOE_STATE_COLUMN + c + 4];
    }
    const float residual = a[GOE_RESIDUAL] - other * b[GOE_RESIDUAL];
    const float own = rows->variance[row] + other * rows->variance[middle];
    const float turned = weight[GOE_BIAS_X] * weight[GOE_BIAS_X] + weight[GOE_BIAS_Y] * weight[GOE_BIAS_Y] +
                         weight[GOE_BIAS_Z] * weight[GOE_BIAS_Z];
    const float due = turned * known->drift2 + weight[GOE_BEARING] * weight[GOE_BEARING] * known->walk2;
    float variance = goe_srif_project(&filter->root, known->reciprocal, 0, weight) + due;
#if GOE_AUGMENTED
    if (row == middle && goe_srif_augmented_count(&filter->root) > 0) {
        variance += augmented_variance(filter, a, weight);
    }
#endif
    return residual * residual / (own + white * white * attitude + variance);
}

typedef struct {
    float factor[GOE_FEATURES]; /* Huber weight of each feature */
    goe_verdict_t verdict;
} belief_t;

static void judge(const goe_settings_t *settings, const known_t *known, const goe_rows_t *rows, goe_axis_t axis,
                  belief_t *belief) {
    group_t group;
    const float gate = settings->filter.gate_sigma;
    const float huber = settings->filter.huber_sigma;
    gather(rows, axis, &group);
    const float alone = group.count > 0 ? innovation(known, rows, group.middle, group.middle) : 0.0f;
    const bool common = alone <= gate * gate; /* a wrong median row is no evidence about the others */
    for (size_t i = 0; i < group.count; i++) {
        const size_t row = group.row[i];
        const size_t feature = rows->feature[row];
        const float squared = row == group.middle ? alone : innovation(known, rows, row, common ? group.middle : row);
        if (squared > gate * gate && known->filter->health.adrift == 0u) { /* an adrift track refuses nothing */
            belief->verdict.refused |= 1u << feature;
        } else if (squared > huber * huber) {
            const float factor = huber / sqrtf(squared);
            belief->factor[feature] = factor < belief->factor[feature] ? factor : belief->factor[feature];
        }
    }
}

GOE_STATIC_ASSERT((GOE_COLUMNS - GOE_AUGMENTED) % 7 == 0, a_row_is_scaled_by_seven_columns_at_a_time);

/* Partly written out: for every row of every image, counting would cost as much as multiplying. */
static void scale_row(float row[GOE_COLUMNS], float weight) {
    for (float *c = row; c < row + (GOE_COLUMNS - GOE_AUGMENTED); c += 7) {
        c[0] *= weight;
        c[1] *= weight;
        c[2] *= weight;
        c[3] *= weight;
        c[4] *= weight;
        c[5] *= weight;
        c[6] *= weight;
    }
#if GOE_AUGMENTED
    for (size_t c = GOE_COLUMNS - GOE_AUGMENTED; c < GOE_COLUMNS; c++) {
        row[c] *= weight;
    }
#endif
}

float goe_gate_repeated(const goe_filter_t *filter, float point_correlation) {
    const float correlation = goe_filter_by_boxes(filter) ? 0.0f : point_correlation;
    return (1.0f + correlation) / (1.0f - correlation);
}

goe_verdict_t goe_gate_apply(const goe_settings_t *settings, const goe_filter_t *filter, goe_rows_t *rows) {
    belief_t belief = {{0.0f}, {0u, 0u, 0}};
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        belief.factor[i] = 1.0f;
    }
    const float repeated = goe_gate_repeated(filter, settings->detector.point_correlation);
    known_t known;
    known.filter = filter;
    known.drift2 = goe_filter_due_drift2(filter, &settings->navigation);
    known.walk2 = goe_filter_due_walk2(filter, &settings->navigation);
    goe_srif_reciprocals(&filter->root, known.reciprocal);
    judge(settings, &known, rows, GOE_ALONG_X, &belief);
    judge(settings, &known, rows, GOE_ALONG_Y, &belief);
    for (size_t i = 0; i < rows->count; i++) {
        const unsigned flag = 1u << rows->feature[i];
        const bool refused = (belief.verdict.refused & flag) != 0;
        const float weight = sqrtf(belief.factor[rows->feature[i]] / (rows->variance[i] * repeated));
        belief.verdict.measured |= flag;
        belief.verdict.rows += refused ? 0 : 1;
        rows->weight[i] = refused ? 0.0f : weight;
        scale_row(rows->matrix->row[i], rows->weight[i]);
    }
    return belief.verdict;
}

#endif
