/* Gets the defaults, initializes an estimator and passes it an image without detections. */
#include <stdio.h>

#include "goe.h"

int main(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = 800.0f;
    settings.camera.fy_px = 800.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;

    goe_estimator_t estimator;
    if (goe_init(&estimator, sizeof estimator, &settings, NULL) != GOE_OK) {
        return 1;
    }
    goe_image_t image = {0};
    image.pose.attitude[0] = 1.0f;
    goe_estimate_t estimate;
    const goe_status_t status = goe_update(&estimator, &image, &estimate);
    printf("%s, self-check 0x%02x\n", goe_status_text(status), goe_self_check());
    return status == GOE_NO_DETECTION && estimate.model == GOE_MODEL_NONE ? 0 : 1;
}
