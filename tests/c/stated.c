/* An answer that is written into an estimator. SPDX-License-Identifier: MIT */
#include "stated.h"

#define NOW_US 5000000

void stated_start(goe_estimator_t *estimator, goe_method_t method) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
    settings.method = method;
    settings.navigation.velocity_bias_sd_m_s = 0.0f;
    CHECK_STATUS(GOE_OK, goe_init(estimator, sizeof *estimator, &settings, NULL));
    estimator->motion.heading_cos = 1.0f;
}

void stated_answer(goe_estimator_t *estimator, const stated_t *cylinder) {
    stated_start(estimator, GOE_WITH_FILTER ? GOE_METHOD_FILTER : GOE_METHOD_WINDOW);
    estimator->motion.time_us = NOW_US;
    estimator->motion.height_m = cylinder->camera_m;
    estimator->estimate_time_us = NOW_US;
    goe_estimate_t *e = &estimator->estimate;
    e->method = GOE_METHOD_WINDOW;
    e->model = GOE_MODEL_DISC;
    e->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
    e->fresh = true;
    e->x_m = e->x0_m = cylinder->x_m;
    e->z_m = e->z0_m = cylinder->z_m;
    e->width_m = cylinder->width_m;
    e->height_m = cylinder->height_m;
    e->sigma.x0_m = e->sigma.z0_m = cylinder->place_sd_m;
    e->sigma.height_m = cylinder->height_sd_m;
}
