/* What Rust reads of the estimators' memory. SPDX-License-Identifier: MIT */
#include "goe.h"

const uint32_t *goe_rust_fault_counts(const goe_estimator_t *estimator);
const uint32_t *goe_rust_fault_counts(const goe_estimator_t *estimator) { return estimator->fault_counts; }

#ifdef GOE_RUST_FLIGHT
#include "goe_flight.h"

const goe_flight_counters_t *goe_rust_counters(const goe_flight_t *flight);
const goe_flight_counters_t *goe_rust_counters(const goe_flight_t *flight) { return &flight->counters; }
#endif

GOE_STATIC_ASSERT(GOE_CAMERAS_MAX == 1, image_rs_knows_one_camera);
GOE_STATIC_ASSERT(sizeof(goe_status_t) == sizeof(int) && sizeof(goe_model_t) == sizeof(int),
                  enumerations_are_ints_by_no_short_enums);
