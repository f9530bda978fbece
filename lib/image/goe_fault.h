/* The faults in one image: each is counted, and the first is returned. SPDX-License-Identifier: MIT */
#ifndef GOE_FAULT_H
#define GOE_FAULT_H

#include "goe.h"

typedef struct {
    uint32_t *fault_counts; /* the estimator's counters */
    goe_status_t first;     /* GOE_OK: no fault so far */
} goe_faults_t;

/*@ predicate goe_faults_are_open(goe_faults_t *faults) =
        \valid_read(faults) && \valid(faults->fault_counts + (0 .. GOE_FAULT_COUNTS - 1)); */

GOE_STATIC_ASSERT(GOE_FAULT_COUNTS == 1 - (int)GOE_NO_HEIGHT, every_fault_has_a_counter);

/* Counts a fault. Counters saturate. */
/*@ requires \valid(fault_counts + (0 .. GOE_FAULT_COUNTS - 1)) && GOE_NO_HEIGHT <= fault <= GOE_OK; */
void goe_count_cause(uint32_t fault_counts[GOE_FAULT_COUNTS], goe_status_t fault);

/* fault: GOE_BEHIND_CAMERA to GOE_NO_HEIGHT; goe_fault_note() ignores GOE_OK. */
/*@ requires goe_faults_are_open(faults) && GOE_NO_HEIGHT <= fault <= GOE_OK; */
void goe_fault_count(goe_faults_t *faults, goe_status_t fault);

/*@ requires goe_faults_are_open(faults) && GOE_NO_HEIGHT <= fault <= GOE_OK; */
static inline void goe_fault_note(goe_faults_t *faults, goe_status_t fault) {
    if (fault != GOE_OK) {
        goe_fault_count(faults, fault);
    }
}

#endif
