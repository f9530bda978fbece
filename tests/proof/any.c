/* Memory with unknown content. SPDX-License-Identifier: MIT */
#include "any.h"

#include "builtins.h"

#define MEMORY_MAX 1000 /* images; settings.window */

float proof_absolute(float x) { return x < 0.0f ? -x : x; }

void any_settings(goe_settings_t *settings) {
    ANY_BITS(*settings);
    settings->method = (goe_method_t)ANY(GOE_METHOD_WINDOW, GOE_METHOD_FILTER);
    settings->model = (goe_model_t)ANY(GOE_MODEL_AUTO, GOE_MODEL_LINE);
    settings->heading_auto = ANY_TRUTH();
    settings->window.points = ANY(3, GOE_WINDOW_MAX);
    settings->window.line_points = ANY(1, MEMORY_MAX);
    settings->window.orientation_memory = ANY(1, MEMORY_MAX);
    settings->filter.top_is_highest = ANY_TRUTH();
}

void any_estimator(goe_estimator_t *estimator, int method) {
    ANY_BITS(*estimator);
    any_settings(&estimator->settings);
    if (method != 0) {
        estimator->settings.method = (goe_method_t)method;
    }
}
