/* What Rust reads of the estimators' memory. SPDX-License-Identifier: MIT */
#include "goe.h"

const uint32_t *goe_rust_causes(const goe_estimator_t *estimator);
const uint32_t *goe_rust_causes(const goe_estimator_t *estimator) { return estimator->causes; }

#ifdef GOE_RUST_FLIGHT
#include "goe_flight.h"

const goe_flight_counters_t *goe_rust_counters(const goe_flight_t *flight);
const goe_flight_counters_t *goe_rust_counters(const goe_flight_t *flight) { return &flight->counters; }

GOE_STATIC_ASSERT(GOE_FLIGHT_SLOTS == 4 && GOE_FLIGHT_DETECTIONS == 32 && GOE_FLIGHT_SECTORS == 72,
                  limits_are_those_of_ffi_rs);
GOE_STATIC_ASSERT(offsetof(goe_flight_frame_t, count) == 19 &&
                      offsetof(goe_flight_frame_t, detection) ==
                          (19 + sizeof(void *)) / sizeof(void *) * sizeof(void *),
                  frame_is_that_of_ffi_rs);
#endif

GOE_STATIC_ASSERT(GOE_CAUSES == 14 && GOE_QUANTITIES == 6 && GOE_CAMERAS_MAX == 1, counts_are_those_of_ffi_rs);
GOE_STATIC_ASSERT(sizeof(goe_status_t) == sizeof(int) && sizeof(goe_model_t) == sizeof(int),
                  enumerations_are_ints_by_no_short_enums);
