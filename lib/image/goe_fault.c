/* Counters of faults. SPDX-License-Identifier: MIT */
#include "image/goe_fault.h"

void goe_count_cause(uint32_t causes[GOE_CAUSES], goe_status_t fault) {
    uint32_t *counter = &causes[-(int)fault];
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

void goe_fault_count(goe_faults_t *faults, goe_status_t fault) {
    goe_count_cause(faults->causes, fault);
    if (faults->first == GOE_OK) {
        faults->first = fault;
    }
}
