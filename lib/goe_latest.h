/* The estimator as the calls read it: whether it is ready, and by which method. SPDX-License-Identifier: MIT */
#ifndef GOE_LATEST_H
#define GOE_LATEST_H

#include "goe.h"

#define GOE_READY 0x474F4533u /* "GOE3" */

static inline bool goe_is_refined(const goe_estimator_t *estimator) {
#if GOE_WITH_WINDOW && GOE_WITH_REFINED
    return estimator->settings.method == GOE_METHOD_REFINED;
#else
    (void)estimator;
    return GOE_WITH_REFINED != 0;
#endif
}

/* GOE_OK, or GOE_BAD_ARGUMENT of a null pointer, or GOE_NOT_INITIALISED. */
static inline goe_status_t goe_check_ready(const goe_estimator_t *estimator) {
    if (!estimator) {
        return GOE_BAD_ARGUMENT;
    }
    return estimator->ready == GOE_READY ? GOE_OK : GOE_NOT_INITIALISED;
}

#endif
