/* Writes the quantities and the fit of the images into the estimate. SPDX-License-Identifier: MIT */
#include "refined/goe_report.h"

#include <math.h>
#include <string.h>

#include "image/goe_ego_motion.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_footprint.h"
#include "refined/goe_mover.h"

#if GOE_WITH_FILTER

#define SUSPECT_IMAGES 8 /* fewer images do not show a misfit */

static void report_position(const goe_quantities_t *q, const goe_motion_t *motion, goe_estimate_t *estimate) {
    estimate->x0_m = q->value[GOE_X0];
    estimate->z0_m = q->value[GOE_Z0];
    estimate->sigma.x0_m = sqrtf(goe_larger(goe_square(q->sigma[GOE_X0]) + q->began_m2[0], 0.0f) + q->before_m2);
    estimate->sigma.z0_m = sqrtf(goe_larger(goe_square(q->sigma[GOE_Z0]) + q->began_m2[1], 0.0f) + q->before_m2);
    goe_motion_relate(motion, estimate);
    estimate->sigma.x_m = q->sigma[GOE_X0];
    estimate->sigma.z_m = q->sigma[GOE_Z0];
    estimate->baseline_m = sqrtf(goe_square(motion->dx_m) + goe_square(motion->dz_m));
}

static void report_orientation(const goe_quantities_t *q, goe_estimate_t *estimate) {
    estimate->orientation_deg = goe_fold_deg(q->value[GOE_ORIENTATION] * GOE_DEG_PER_RAD);
    estimate->sigma.orientation_deg = q->sigma[GOE_ORIENTATION] * GOE_DEG_PER_RAD;
    estimate->front_orientation_deg = goe_fold_deg(estimate->orientation_deg + 90.0f);
    estimate->orientation_raw_deg = estimate->orientation_deg;
    estimate->length_axis[0] = q->length_axis.x;
    estimate->length_axis[1] = q->length_axis.z;
    estimate->width_axis[0] = q->length_axis.z;
    estimate->width_axis[1] = -q->length_axis.x;
}

static void report_known(const goe_quantities_t *q, const goe_motion_t *motion, goe_estimate_t *estimate) {
    estimate->model = q->model;
    estimate->fresh = true;
    estimate->valid = q->known;
    report_position(q, motion, estimate);
    if ((q->known & GOE_HAS_WIDTH) != 0u) {
        estimate->width_m = q->value[GOE_WIDTH];
        estimate->sigma.width_m = q->sigma[GOE_WIDTH];
    }
    if ((q->known & GOE_HAS_LENGTH) != 0u) {
        estimate->length_m = q->value[GOE_LENGTH];
        estimate->sigma.length_m = q->sigma[GOE_LENGTH];
    }
    if ((q->known & GOE_HAS_HEIGHT) != 0u) {
        estimate->height_m = q->value[GOE_HEIGHT];
        estimate->sigma.height_m = q->sigma[GOE_HEIGHT];
    }
    if ((q->known & GOE_HAS_ORIENTATION) != 0u) {
        report_orientation(q, estimate);
    }
    if ((q->known & GOE_HAS_CENTER) != 0u) {
        estimate->center_north_m = q->center_m[0];
        estimate->center_east_m = q->center_m[1];
        estimate->center_ne_m2 = q->center_ne_m2;
        estimate->sigma.center_north_m = q->center_sd_m[0];
        estimate->sigma.center_east_m = q->center_sd_m[1];
    }
}

/* Reports the velocity of a followed obstacle. Like the position, it is known no better than the own motion. */
static void report_velocity(const goe_quantities_t *q, goe_estimate_t *estimate) {
    if (!q->moves) {
        return;
    }
    estimate->valid |= GOE_HAS_VELOCITY;
    estimate->velocity_north_m_s = q->velocity_m_s[0];
    estimate->velocity_east_m_s = q->velocity_m_s[1];
    estimate->sigma.velocity_north_m_s = q->velocity_sd_m_s[0];
    estimate->sigma.velocity_east_m_s = q->velocity_sd_m_s[1];
}

bool goe_report_quantities(const goe_quantities_t *quantities, const goe_motion_t *motion, goe_estimate_t *estimate) {
    const bool is_known = (quantities->known & GOE_HAS_POSITION) != 0;
    if (is_known || !(estimate->valid & GOE_HAS_POSITION)) {
        memset(estimate, 0, sizeof *estimate);
        estimate->method = GOE_METHOD_FILTER;
    }
    if (is_known) {
        report_known(quantities, motion, estimate);
        report_velocity(quantities, estimate);
    }
    return is_known;
}

static bool is_misfit(const goe_health_t *health, float most) {
    return health->images >= SUSPECT_IMAGES && health->mean_nis > most;
}

/* Whether images contradict the size or the shape that the class or the settings state. */
static bool is_forced(const goe_filter_t *filter) {
    return filter->kind.wrong ||
           (filter->kind.is_round && goe_filter_traits(filter)->is_ellipse && goe_footprint_is_forced(filter));
}

static bool moves(const goe_filter_t *filter) {
#if GOE_AUGMENTED
    return filter->mover.moves;
#else
    (void)filter;
    return false;
#endif
}

static bool is_late(const goe_filter_t *filter) {
#if GOE_AUGMENTED
    return filter->mover.late;
#else
    (void)filter;
    return false;
#endif
}

static goe_reason_t reason_of(const goe_filter_t *filter, const goe_settings_t *settings) {
    const goe_health_t *health = &filter->health;
    if (moves(filter)) {
        return GOE_REASON_MOVES;
    }
    if (health->base_refused) {
        return GOE_REASON_BASE;
    }
    if (is_forced(filter)) {
        return GOE_REASON_SHAPE;
    }
    if (is_late(filter)) {
        return GOE_REASON_LATE;
    }
    if (!is_misfit(health, settings->filter.nis_ratio_max)) {
        return GOE_REASON_NONE;
    }
    return health->adrift ? GOE_REASON_CONVENTION : GOE_REASON_NOISE;
}

void goe_report_fit(const goe_filter_t *filter, const goe_settings_t *settings, goe_estimate_t *estimate) {
    const goe_health_t *health = &filter->health;
    estimate->reason = reason_of(filter, settings);
    estimate->suspect = is_misfit(health, settings->filter.nis_ratio_max) ||
                        (estimate->reason != GOE_REASON_NONE && estimate->reason != GOE_REASON_LATE);
#if GOE_AUGMENTED
    estimate->latency_s = filter->mover.augmented[GOE_AUGMENTED_LATENCY];
    estimate->sigma.latency_s = goe_mover_latency_sd(filter);
#endif
    if (estimate->method == GOE_METHOD_FILTER) {
        estimate->images_used = health->images;
        estimate->nis = health->nis;
        estimate->nis_rows = health->nis_rows;
        estimate->nis_ratio = health->mean_nis;
    }
}

#endif
