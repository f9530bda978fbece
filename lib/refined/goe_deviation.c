/* Operations on the errors of reported quantities. SPDX-License-Identifier: MIT */
#include "refined/goe_deviation.h"

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

GOE_STATIC_ASSERT(GOE_GROUND == GOE_UNWEIGHTED, no_quantity_depends_on_the_attitude_bias);

/* (R21), (R35): sets the part of the augmented states, if they exist. A constant error of the own velocity equals a velocity of the obstacle:
 * it is considered where the latter is not estimated, and part of it where it is. */
static void project_augmented(const goe_filter_t *filter, const goe_widening_t *wider, goe_counted_t counted,
                              goe_deviation_t *error) {
#if GOE_AUGMENTED
    const float direct[GOE_AUGMENTED] = {0.0f, counted.x * counted.at_s, counted.z * counted.at_s};
    goe_srif_augmented(&filter->root, error->by, GOE_UNWEIGHTED, direct, wider->own_m_s, error->augmented);
#else
    (void)filter;
    (void)wider;
    (void)counted;
    error->augmented[0] = 0.0f;
#endif
}

float goe_deviation_project(const goe_filter_t *filter, const goe_widening_t *wider, goe_counted_t counted,
                            goe_deviation_t *error) {
    float variance = goe_srif_project(&filter->root, wider->reciprocal, GOE_UNWEIGHTED, error->by);
    project_augmented(filter, wider, counted, error);
    if (goe_filter_traits(filter)->is_ellipse) {
        float *depth = &error->by[GOE_LOG_DEPTH];
        variance += (goe_square(wider->bend) - 1.0f) * goe_square(*depth);
        *depth *= wider->bend;
    }
    return variance + goe_srif_augmented_dot(error->augmented, error->augmented);
}

float goe_deviation_covariance(const goe_deviation_t *a, const goe_deviation_t *b, float more) {
    return goe_deviation_dot(a->by, b->by, more + goe_srif_augmented_dot(a->augmented, b->augmented));
}

void goe_deviation_sum(const goe_deviation_t *a, float x, const goe_deviation_t *b, float z, goe_deviation_t *sum) {
    for (size_t k = GOE_UNWEIGHTED; k < GOE_STATES; k++) {
        sum->by[k] = x * a->by[k] + z * b->by[k];
    }
    for (int i = 0; i < GOE_AUGMENTED; i++) {
        sum->augmented[i] = x * a->augmented[i] + z * b->augmented[i];
    }
}

void goe_deviation_scale(goe_deviation_t *error, float factor) {
    for (size_t k = GOE_UNWEIGHTED; k < GOE_STATES; k++) {
        error->by[k] *= factor;
    }
    for (int i = 0; i < GOE_AUGMENTED; i++) {
        error->augmented[i] *= factor;
    }
}

#endif
