/* Checks that apply to every answer. SPDX-License-Identifier: MIT */
#include "estimate_checks.h"

#include <math.h>
#include <string.h>

#include "fuzz.h"
#include "fuzz_input.h"

#define ROUNDING 1.0e-3 /* of a sigma or a correlation that was stored as float */
#define SUM_ROUNDING                                                                                                   \
    4.0e-7 /* of the largest variance: a small one is the difference of sums that contain it, in float */
#define UNIT_ROUNDING 2.0e-5f /* of a unit vector's squared norm */
#define AGE_MAX_S 4000.5f     /* 4000 s, rounded to float */
#define METERS_MAX 1.0e6f     /* no position or sigma of the filter method is beyond */
#define ROWS_MAX 9            /* of one image */
#define VALID_BITS 0x7Fu
#define WITH_POSITION (GOE_HAS_CENTER | GOE_HAS_WIDTH | GOE_HAS_VELOCITY) /* not known without a position */

static bool is_zero(float x) { return (fuzz_bits_of(x) & 0x7FFFFFFFu) == 0u; }
static bool is_not_negative(float x) { return x >= 0.0f; }
static bool is_within(float x, float limit) { return x <= limit && x >= -limit; }

bool check_is_image_status(goe_status_t status) {
    return (int)status >= (int)GOE_NO_HEIGHT && (int)status <= (int)GOE_NO_DETECTION;
}

bool check_is_refusal(goe_status_t status) {
    return status == GOE_NOT_FINITE || status == GOE_OUT_OF_RANGE || status == GOE_BAD_TIME ||
           status == GOE_BAD_ATTITUDE;
}

/* ---------------------------------------------------------------------------------------------------------- estimate -- */

static void check_finite(const void *from, size_t size) {
    const unsigned char *bytes = from;
    for (size_t i = 0; i + sizeof(uint32_t) <= size; i += sizeof(uint32_t)) {
        uint32_t bits;
        memcpy(&bits, bytes + i, sizeof bits);
        FUZZ_CHECK((bits & 0x7F800000u) != 0x7F800000u);
    }
}

/* A quantity is 0 if it is not known; its sigma is not negative. */
static void check_quantity(bool known, float value, float sigma) {
    if (known) {
        FUZZ_CHECK(is_not_negative(sigma));
    } else {
        FUZZ_CHECK(is_zero(value));
        FUZZ_CHECK(is_zero(sigma));
    }
}

static void check_unit(bool known, const float axis[2]) {
    const float norm2 = axis[0] * axis[0] + axis[1] * axis[1];
    FUZZ_CHECK(known ? is_within(norm2 - 1.0f, UNIT_ROUNDING) : is_zero(norm2));
}

static void check_quantities(const goe_estimate_t *e) {
    const goe_sigma_t *s = &e->sigma;
    const bool position = (e->valid & GOE_HAS_POSITION) != 0u;
    const bool center = (e->valid & GOE_HAS_CENTER) != 0u;
    const bool velocity = (e->valid & GOE_HAS_VELOCITY) != 0u;
    const bool turn = (e->valid & GOE_HAS_ORIENTATION) != 0u;
    check_quantity(position, e->x0_m, s->x0_m);
    check_quantity(position, e->z0_m, s->z0_m);
    check_quantity(position, e->x_m, s->x_m);
    check_quantity(position, e->z_m, s->z_m);
    check_quantity((e->valid & GOE_HAS_WIDTH) != 0u, e->width_m, s->width_m);
    check_quantity((e->valid & GOE_HAS_LENGTH) != 0u, e->length_m, s->length_m);
    check_quantity((e->valid & GOE_HAS_HEIGHT) != 0u, e->height_m, s->height_m);
    check_quantity(turn, e->orientation_deg, s->orientation_deg);
    check_quantity(center, e->center_north_m, s->center_north_m);
    check_quantity(center, e->center_east_m, s->center_east_m);
    check_quantity(velocity, e->velocity_north_m_s, s->velocity_north_m_s);
    check_quantity(velocity, e->velocity_east_m_s, s->velocity_east_m_s);
    FUZZ_CHECK(center || is_zero(e->center_ne_m2));
    check_unit(turn, e->length_axis);
    check_unit(turn, e->width_axis);
    check_unit(turn, e->length_axis_ne);
    check_unit(turn, e->width_axis_ne);
}

static void check_ranges(const goe_estimate_t *e) {
    FUZZ_CHECK(is_not_negative(e->width_m) && is_not_negative(e->length_m) && is_not_negative(e->height_m));
    FUZZ_CHECK(is_not_negative(e->residual) && is_not_negative(e->baseline_m));
    FUZZ_CHECK(is_not_negative(e->nis) && is_not_negative(e->nis_ratio) && is_not_negative(e->sigma.latency_s));
    FUZZ_CHECK(e->orientation_deg > -90.0f && e->orientation_deg <= 90.0f);
    FUZZ_CHECK(is_within(e->front_orientation_deg, 90.0f) && is_within(e->orientation_raw_deg, 90.0f));
    FUZZ_CHECK(is_within(e->trajectory_heading_deg, 180.0f));
    FUZZ_CHECK(e->nis_rows >= 0 && e->nis_rows <= ROWS_MAX && (e->nis_rows > 0 || is_zero(e->nis)));
    FUZZ_CHECK(is_not_negative(e->age_s) && e->age_s <= AGE_MAX_S);
}

static void check_kind(const goe_settings_t *settings, goe_status_t status, const goe_estimate_t *e) {
    const bool position = (e->valid & GOE_HAS_POSITION) != 0u;
    const bool filter = e->method == GOE_METHOD_FILTER;
    const int model = (int)e->model;
    FUZZ_CHECK((e->valid & ~VALID_BITS) == 0u && (position || (e->valid & WITH_POSITION) == 0u));
    FUZZ_CHECK((int)e->method == 0 || e->method == GOE_METHOD_WINDOW || filter);
    FUZZ_CHECK(!filter || settings->method == GOE_METHOD_FILTER);
    FUZZ_CHECK(model == GOE_MODEL_NONE || model == GOE_MODEL_DISC || (model == GOE_MODEL_LINE && !filter) ||
               ((model == GOE_MODEL_BOX || model == GOE_MODEL_PRISM) && filter));
    FUZZ_CHECK(position == (model != GOE_MODEL_NONE) && (!position || (int)e->method != 0));
    FUZZ_CHECK((int)e->reason >= (int)GOE_REASON_NONE && (int)e->reason <= (int)GOE_REASON_NOISE);
    FUZZ_CHECK(!e->suspect || e->reason != GOE_REASON_NONE);
    FUZZ_CHECK(e->images_used >= 0 && e->images_used <= (filter ? INT16_MAX : GOE_WINDOW_MAX));
    FUZZ_CHECK(e->fresh == (status == GOE_OK || status == GOE_PARTIAL));
    FUZZ_CHECK(!e->fresh || (position && is_zero(e->age_s)));
    FUZZ_CHECK(position || is_zero(e->age_s));
}

/* Properties of a fresh answer of the filter method: each sigma is positive, and nothing is beyond the Earth. */
static void check_refined(const goe_estimate_t *e) {
    const goe_sigma_t *s = &e->sigma;
    if (e->method != GOE_METHOD_FILTER || !e->fresh) {
        return;
    }
    FUZZ_CHECK(s->x0_m > 0.0f && s->z0_m > 0.0f && s->x_m > 0.0f && s->z_m > 0.0f);
    FUZZ_CHECK(!(e->valid & GOE_HAS_WIDTH) || s->width_m > 0.0f);
    FUZZ_CHECK(!(e->valid & GOE_HAS_LENGTH) || s->length_m > 0.0f);
    FUZZ_CHECK(!(e->valid & GOE_HAS_HEIGHT) || s->height_m > 0.0f);
    FUZZ_CHECK(!(e->valid & GOE_HAS_ORIENTATION) || s->orientation_deg > 0.0f);
    FUZZ_CHECK(!(e->valid & GOE_HAS_CENTER) || (s->center_north_m > 0.0f && s->center_east_m > 0.0f));
    FUZZ_CHECK(is_within(e->x0_m, METERS_MAX) && is_within(e->z0_m, METERS_MAX));
    FUZZ_CHECK(is_within(s->x_m, METERS_MAX) && is_within(s->z_m, METERS_MAX));
}

void check_estimate(const goe_settings_t *settings, goe_status_t status, const goe_estimate_t *estimate) {
    check_finite(&estimate->age_s, sizeof *estimate - offsetof(goe_estimate_t, age_s));
    check_kind(settings, status, estimate);
    check_quantities(estimate);
    check_ranges(estimate);
    check_refined(estimate);
}

/* -------------------------------------------------------------------------------------------------------- covariance -- */

static void check_correlations(float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        FUZZ_CHECK(is_not_negative(covariance[i][i]));
        for (int j = 0; j < i; j++) {
            const double both = (double)covariance[i][i] * (double)covariance[j][j];
            const double shared = (double)covariance[i][j];
            FUZZ_CHECK(fuzz_bits_of(covariance[i][j]) == fuzz_bits_of(covariance[j][i]));
            FUZZ_CHECK(shared * shared <= both * (1.0 + ROUNDING) * (1.0 + ROUNDING));
        }
    }
}

static double largest_variance(float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    double largest = 0.0;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        largest = fmax(largest, (double)covariance[i][i]);
    }
    return largest;
}

/* The diagonal equals the squared sigmas: bit by bit for the window method, otherwise up to rounding. For a stale answer it is at least as
 * large. */
static void check_diagonal(const goe_estimate_t *e, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    const goe_sigma_t *s = &e->sigma;
    const float sigma[GOE_QUANTITIES] = {s->x0_m, s->z0_m, s->orientation_deg, s->width_m, s->length_m, s->height_m};
    const unsigned bit[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                          GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};
    const bool of_filter = e->method == GOE_METHOD_FILTER && e->fresh;
    const bool stationary = (e->valid & GOE_HAS_VELOCITY) == 0u;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        if (!(e->valid & bit[i]) || !(e->valid & GOE_HAS_POSITION)) {
            for (int j = 0; j < GOE_QUANTITIES; j++) {
                FUZZ_CHECK(is_zero(covariance[i][j]));
            }
        } else if (of_filter) {
            const double variance = (double)sigma[i] * (double)sigma[i];
            const double rounding = 2.0 * ROUNDING * variance + SUM_ROUNDING * largest_variance(covariance);
            FUZZ_CHECK(fabs((double)covariance[i][i] - variance) <= rounding);
        } else if (e->method == GOE_METHOD_FILTER) {
            FUZZ_CHECK(sqrt((double)covariance[i][i]) >= (double)sigma[i] * (1.0 - ROUNDING));
        } else if (stationary || i > GOE_Z0) {
            FUZZ_CHECK(fuzz_bits_of(covariance[i][i]) == fuzz_bits_of(sigma[i] * sigma[i]));
        }
    }
}

void check_covariance(const goe_estimator_t *estimator, const goe_estimate_t *estimate) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    memset(covariance, 0xFF, sizeof covariance);
    const goe_status_t status = goe_covariance(estimator, covariance);
    FUZZ_CHECK(status == ((estimate->valid & GOE_HAS_POSITION) ? GOE_OK : GOE_CONVERGING));
    check_finite(covariance, sizeof covariance);
    check_correlations(covariance);
    check_diagonal(estimate, covariance);
}

/* ------------------------------------------------------------------------------------------------------------ hazard -- */

void check_hazard(const goe_estimator_t *estimator, const goe_estimate_t *estimate, const goe_intent_t *intent,
                  bool legal) {
    goe_hazard_t h;
    memset(&h, 0xFF, sizeof h);
    const goe_status_t status = goe_hazard(estimator, intent, &h);
    const goe_status_t expected = (estimate->valid & GOE_HAS_POSITION) ? GOE_OK : GOE_CONVERGING;
    FUZZ_CHECK(status == expected || (!legal && (status == GOE_NOT_FINITE || status == GOE_OUT_OF_RANGE)));
    check_finite(&h, offsetof(goe_hazard_t, has_clearance));
    FUZZ_CHECK(h.tcpa_s >= 0.0f && h.tcpa_sd_s >= 0.0f && h.dcpa_m >= 0.0f && h.dcpa_sd_m >= 0.0f);
    FUZZ_CHECK(h.clearance_sd_m >= 0.0f && h.conflict_probability >= 0.0f && h.conflict_probability <= 1.0f);
    FUZZ_CHECK(h.tcpa_s > 0.0f || is_zero(h.tcpa_sd_s));
    FUZZ_CHECK(h.has_clearance || (is_zero(h.clearance_m) && is_zero(h.clearance_sd_m)));
    FUZZ_CHECK(!h.has_clearance || (estimate->valid & GOE_HAS_HEIGHT) != 0u);
    FUZZ_CHECK(status == GOE_OK || (is_zero(h.tcpa_s) && is_zero(h.dcpa_m) && is_zero(h.conflict_probability)));
}

/* -------------------------------------------------------------------------------------------------------------- hash -- */

static uint64_t mixed(uint64_t hash, uint32_t word) { return (hash ^ word) * 0x100000001B3u ^ hash >> 29; }

uint64_t check_hash(uint64_t hash, goe_status_t status, const goe_estimate_t *estimate) {
    const unsigned char *bytes = (const unsigned char *)&estimate->age_s;
    hash = mixed(hash, (uint32_t)status);
    hash = mixed(hash, (uint32_t)estimate->method << 8 | (uint32_t)estimate->model << 4 | (uint32_t)estimate->reason);
    hash = mixed(hash, estimate->valid << 2 | (estimate->fresh ? 2u : 0u) | (estimate->suspect ? 1u : 0u));
    hash = mixed(hash, (uint32_t)estimate->images_used);
    for (size_t i = 0; i < sizeof *estimate - offsetof(goe_estimate_t, age_s); i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, bytes + i, sizeof word);
        hash = mixed(hash, word);
    }
    return hash;
}
