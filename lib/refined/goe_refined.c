/* One image through the refined method. SPDX-License-Identifier: MIT
 *
 *   time -> start, change of model -> rows of the model -> gate -> square-root update -> recovery
 *
 * One Gauss-Newton step per image, linearised at the predicted state: in these states the image is so nearly linear that
 * linearising older images anew gains next to nothing. */
#include "refined/goe_refined.h"

#include <math.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_box.h"
#include "refined/goe_change.h"
#include "refined/goe_chord.h"
#include "refined/goe_disc.h"
#include "refined/goe_gate.h"

#define S_PER_US 1.0e-6f
#define GAP_MOST_US 1000000000 /* a longer gap between images counts as this one */
#define AHEAD_LEAST 0.02f
#define EXTENT_LEAST 0.03f /* of the sum of all extents */
#define DEPTH_LEAST 0.3f   /* sz over |sx| */
#define LEVEL_MEMORY 0.125f
#define MISFIT_IMAGES 64 /* that the misfit remembers */
#define MISFIT_START 8   /* images without any misfit that it is begun with: the first ones alone say little */
#define RATIO_MOST 20.0f
#define LEVEL_MOST 6.0f /* mean NIS over rows that only a captured state reaches */
#define POOR_IMAGES 3
#define REFUSED_IMAGES 4 /* images in a row in which a point is refused before the state is doubted */
#define REFUSED_ENDS 8   /* the same while an end may leave the chord */
#define REFUSED_TOPS 3
#define EARLY_IMAGES 32 /* of the track: what does not fit in them began with an outlier */
#define FAILURES_MOST 2 /* times that a box of base corners may prove wrong */
#define TOP_FREEDOM 2.0f
#define STATE_MOST 1.0e6f
#define NIS_MOST 1.0e6f

/* --------------------------------------------------------------------------------------------------------------- time -- */

static float seconds_since(int64_t then_us, int64_t now_us) {
    const uint64_t gap = (uint64_t)now_us - (uint64_t)then_us;
    return (float)(uint32_t)(gap < GAP_MOST_US ? gap : GAP_MOST_US) * S_PER_US;
}

static void let_time_pass(goe_filter_t *filter, const goe_noise_t *noise, int64_t time_us) {
    const float root_s = sqrtf(seconds_since(filter->time_us, time_us));
    const float drift = noise->attitude_drift_deg * GOE_RAD_PER_DEG * root_s;
    const float walk = noise->position_walk_m * root_s * filter->state[GOE_Q];
    filter->time_us = time_us;
    filter->drift_rad2 += drift * drift;
    filter->walk2 += walk * walk;
    for (size_t i = GOE_BX; drift > 0.0f && i <= GOE_BZ; i++) {
        goe_srif_spread_state(&filter->root, i, drift);
    }
    if (walk > 0.0f) {
        goe_srif_spread_state(&filter->root, GOE_A, walk);
    }
}

/* Extents of too different size make a box that the next image cannot be linearised at. */
static void clip_box(float x[GOE_STATES]) {
    const float least = EXTENT_LEAST * (goe_absolute(x[GOE_SX]) + goe_absolute(x[GOE_FX]) + goe_absolute(x[GOE_D]));
    x[GOE_FX] = goe_larger(x[GOE_FX], least);
    x[GOE_D] = goe_larger(x[GOE_D], DEPTH_LEAST * goe_absolute(x[GOE_SX]) - x[GOE_FX] / DEPTH_LEAST);
    if (goe_box_depth(x).side < least) {
        x[GOE_D] = least - goe_absolute(x[GOE_SX]) * x[GOE_FX] / least;
    }
}

/* ------------------------------------------------------------------------------------------------------------- update -- */

/* What linearising at an uncertain range may miss: the second order of 1/Z. */
static void allow_for_curvature(const goe_filter_t *filter, const goe_observation_t *sight, goe_rows_t *rows) {
    const float ahead = goe_larger(goe_observation_reference_z(sight), AHEAD_LEAST);
    const float missed = sight->dz_m * goe_inverse_variance(&filter->inverse, GOE_Q) / ahead;
    for (size_t i = 0; i < rows->count; i++) {
        rows->variance[i] += goe_square(goe_rows_get(rows, i, GOE_Q) * missed);
    }
}

/* One image's share in a mean of NIS over rows, limited so that one outlier does not decide. */
static void average(float *mean, float ratio, float memory) {
    *mean += ((ratio < RATIO_MOST ? ratio : RATIO_MOST) - *mean) * memory;
}

static unsigned bits_of(unsigned set) {
    unsigned count = 0;
    for (; set != 0; set &= set - 1u) {
        count++;
    }
    return count;
}

/* Half of the points or more do not fit. */
static bool is_poor(goe_verdict_t verdict) {
    return verdict.measured != 0 && 2u * bits_of(verdict.refused) >= bits_of(verdict.measured);
}

static void remember_misfit(goe_filter_t *filter, float ratio) {
    filter->images = (int16_t)(filter->images < INT16_MAX ? filter->images + 1 : INT16_MAX);
    const int heard = filter->images + MISFIT_START;
    average(&filter->misfit, ratio, 1.0f / (float)(heard < MISFIT_IMAGES ? heard : MISFIT_IMAGES));
}

static void remember(goe_filter_t *filter, goe_verdict_t verdict, float nis) {
    filter->nis = goe_within(nis, NIS_MOST) ? nis : NIS_MOST;
    filter->nis_rows = (int16_t)verdict.rows;
    const float ratio = filter->nis / (float)verdict.rows;
    remember_misfit(filter, is_poor(verdict) ? RATIO_MOST : ratio); /* what is left fits, and says nothing */
    if (filter->level < 0.0f) {
        filter->level = 1.0f;
    } else {
        average(&filter->level, ratio, LEVEL_MEMORY);
    }
}

static bool measure(goe_filter_t *filter, goe_observation_t *sight, goe_verdict_t *verdict) {
    goe_rows_t rows;
    float change[GOE_STATES];
    const float white = sight->settings->noise.attitude_white_deg * GOE_RAD_PER_DEG;
    goe_rows_clear(&rows, &filter->rows);
    if (filter->phase == GOE_PHASE_BOX) {
        sight->depth_variance = goe_inverse_variance(&filter->inverse, GOE_D);
        goe_box_rows(sight, &rows);
    } else if (filter->phase == GOE_PHASE_CHORD) {
        goe_chord_free_top(filter, sight);
        goe_chord_rows(sight, &rows);
    } else {
        goe_disc_rows(sight, &rows);
    }
    goe_rows_end(&rows);
    goe_rows_turn(&rows, sight);
    allow_for_curvature(filter, sight, &rows);
    *verdict = goe_gate_apply(sight->settings, filter, &rows);
    if (filter->phase == GOE_PHASE_CHORD) {
        goe_chord_follow(filter, verdict);
    }
    if (verdict->rows == 0) {
        if (verdict->measured != 0) { /* all refused: nothing could fit worse */
            remember_misfit(filter, RATIO_MOST);
        }
        return false;
    }
    const float nis = goe_srif_update(&filter->root, 1.0f / white, rows.matrix, change);
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter->state[i] += change[i];
    }
    /* the weights count a correlated error as a larger one; its own spread is what it was */
    const float correlation = sight->settings->noise.correlation;
    remember(filter, *verdict, nis * ((1.0f + correlation) / (1.0f - correlation)));
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- recovery -- */

/* A point that is refused image after image: the state was captured by an outlier, not the other way round. */
static bool is_captured(goe_filter_t *filter, goe_verdict_t verdict) {
    const bool chord = filter->phase == GOE_PHASE_CHORD;
    const unsigned most = chord ? REFUSED_ENDS : REFUSED_IMAGES;
    bool captured = false;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        const unsigned flag = 1u << i;
        if ((verdict.refused & flag) != 0) {
            captured = goe_refined_count(&filter->refused[i]) >= most || captured;
        } else if ((verdict.measured & flag) != 0) {
            filter->refused[i] = 0;
        }
    }
    if (is_poor(verdict)) {
        captured = goe_refined_count(&filter->poor) >= POOR_IMAGES || captured;
    } else if (verdict.measured != 0) {
        filter->poor = 0;
    }
    if (chord && goe_chord_is_left(filter)) {
        filter->poor = 0;
        return false;
    }
    return captured;
}

/* The top alone hangs on nothing else. */
static void free_top(goe_filter_t *filter) {
    const float *x = filter->state;
    const float size = goe_larger(goe_absolute(x[GOE_E]), goe_larger(x[GOE_FX], goe_absolute(x[GOE_D])));
    goe_srif_spread_state(&filter->root, GOE_E, TOP_FREEDOM * size);
    filter->refused[GOE_TOP] = 0;
}

static bool is_sane(const goe_filter_t *filter) {
    bool sane = filter->state[GOE_FX] > 0.0f;
    for (size_t i = 0; i < GOE_STATES; i++) {
        sane = goe_within(filter->state[i], STATE_MOST) &&
               goe_magnitude(filter->root.element[goe_srif_row(i) + i]) < GOE_INFINITY_BITS && sane;
    }
    return sane;
}

/* A box of base corners that proved wrong more than once: they are those of something else. Residuals alone do not decide:
 * noise that is told too small must not cost a true box its corners. */
static void count_failure(goe_filter_t *filter, const goe_settings_t *settings) {
    if (filter->phase == GOE_PHASE_BOX && !filter->outline && settings->model == GOE_MODEL_AUTO &&
        filter->images >= EARLY_IMAGES) {
        filter->base_refused = goe_refined_count(&filter->failed) >= FAILURES_MOST;
    }
}

static void recover(goe_filter_t *filter, const goe_settings_t *settings, goe_verdict_t verdict) {
    const bool captured = is_captured(filter, verdict);
    if (filter->refused[GOE_TOP] >= REFUSED_TOPS) {
        free_top(filter);
    }
    if (captured || filter->level > LEVEL_MOST || !is_sane(filter)) {
        count_failure(filter, settings);
        goe_refined_enter(filter, GOE_PHASE_NONE);
        memset(filter->refused, 0, sizeof filter->refused);
    }
}

/* -------------------------------------------------------------------------------------------------------------- image -- */

static bool start(goe_estimator_t *estimator, const goe_observation_t *sight) {
    goe_filter_t *filter = &estimator->filter;
    if (!goe_disc_start(sight, filter->state, &filter->root)) {
        return false;
    }
    goe_refined_enter(filter, GOE_PHASE_DISC);
    filter->stand_in = false;
    filter->outline = false;
    goe_srif_invert_diagonal(&filter->root, &filter->inverse);
    goe_refined_settle(filter);
    filter->time_us = estimator->time_us;
    return true;
}

static void leave_out_base(goe_view_t *view) {
    view->base_left.usable = false;
    view->base_near.usable = false;
    view->base_right.usable = false;
}

static bool change_model(goe_filter_t *filter, const goe_observation_t *sight) {
    switch (filter->phase) {
        case GOE_PHASE_DISC:
            return goe_change_to_box(filter, sight) || goe_chord_start(filter, sight);
        case GOE_PHASE_CHORD:
            return goe_change_to_box(filter, sight) || goe_chord_change(filter, sight);
        default:
            return goe_change_box(filter, sight);
    }
}

bool goe_refined_update(goe_estimator_t *estimator, const float camera_to_trajectory[9], goe_view_t *view,
                        unsigned *swapped) {
    goe_filter_t *filter = &estimator->filter;
    goe_observation_t sight;
    goe_verdict_t verdict;
    filter->nis = 0.0f;
    filter->nis_rows = 0;
    if (filter->phase == GOE_PHASE_NONE) { /* T's own axes */
        filter->turn_cos = 1.0f;
        filter->turn_sin = 0.0f;
        filter->start_dx_m = estimator->dx_m;
        filter->start_dz_m = estimator->dz_m;
    }
    if (filter->base_refused) {
        leave_out_base(view);
    }
    *swapped = goe_observation_open(&sight, estimator, camera_to_trajectory, view);
    if (filter->phase == GOE_PHASE_NONE && !start(estimator, &sight)) {
        return false;
    }
    let_time_pass(filter, &estimator->settings.noise, estimator->time_us);
    goe_observation_look(&sight);
    filter->stand_in = filter->stand_in || (sight.base && estimator->settings.model != GOE_MODEL_DISC);
    if (change_model(filter, &sight)) {
        return false;
    }
    (void)goe_refined_count(&filter->since);
    sight.deep = filter->deep;
    const bool measured = measure(filter, &sight, &verdict);
    if (filter->phase == GOE_PHASE_BOX) {
        clip_box(filter->state);
    }
    recover(filter, &estimator->settings, verdict);
    if (!measured || filter->phase == GOE_PHASE_NONE) {
        return false;
    }
    goe_refined_invert(filter);
    return true;
}
