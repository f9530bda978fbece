/* Counters of the faults in images. SPDX-License-Identifier: MIT */
#include "image/goe_fault.h"

void goe_count_cause(uint32_t fault_counts[GOE_FAULT_COUNTS], goe_status_t fault) {
    uint32_t *counter = &fault_counts[-(int)fault];
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

void goe_fault_count(goe_faults_t *faults, goe_status_t fault) {
    goe_count_cause(faults->fault_counts, fault);
    if (faults->first == GOE_OK) {
        faults->first = fault;
    }
}
