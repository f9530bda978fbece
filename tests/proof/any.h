/* Memory with unknown content, for the drivers of the proof. SPDX-License-Identifier: MIT */
#ifndef GOE_PROOF_ANY_H
#define GOE_PROOF_ANY_H

#include "__fc_builtin.h"
#include "goe.h"

/* Any bits: every number may have any value including NaN and the infinities, and every bool may be neither 0 nor 1. */
#define ANY_BITS(object) Frama_C_make_unknown((char *)&(object), sizeof(object))
#define ANY(low, high) Frama_C_interval((low), (high))
#define ANY_TRUTH() ((bool)ANY(0, 1))

/* Settings whose integers are within their ranges, and whose floats have any value. */
void any_settings(goe_settings_t *settings);

/* Any bits except in the settings, which are sealed: `method` GOE_METHOD_WINDOW, GOE_METHOD_FILTER or 0, which is either. */
void any_estimator(goe_estimator_t *estimator, int method);

#endif
