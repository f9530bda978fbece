// The public header in a C++ translation unit, with a call of every function.
#include "goe.h"

int main() {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 800.0f;

    goe_estimator_t estimator;
    const char *bad_field = nullptr;
    if (goe_init(&estimator, sizeof estimator, &settings, &bad_field) != GOE_OK) {
        return 1;
    }
    goe_image_t image = goe_image_t();
    image.pose.time_us = GOE_TIME_UNKNOWN;
    image.pose.attitude[0] = 1.0f;
    goe_estimate_t estimate;
    const bool refused = goe_update(&estimator, &image, &estimate) == GOE_BAD_TIME;
    const bool empty = (estimate.valid & (GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_HEIGHT | GOE_HAS_ORIENTATION |
                                          GOE_HAS_CENTER)) == 0u;
    const bool reset = goe_reset(&estimator) == GOE_OK;
    const bool named = goe_status_text(GOE_OK)[0] == 'o';
    return refused && empty && reset && named && goe_self_check() <= 0x3Fu ? 0 : 1;
}
