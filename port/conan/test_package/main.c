/* The package's estimator starts, which it does only if header and library agree on the parts. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include <goe.h>

int main(void) {
    static goe_estimator_t estimator;
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 914.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    const goe_status_t status = goe_init(&estimator, sizeof estimator, &settings, NULL);
    printf("goe %d.%d.%d: %s, %u bytes, self check 0x%02X\n", GOE_VERSION_MAJOR, GOE_VERSION_MINOR, GOE_VERSION_PATCH,
           goe_status_text(status), (unsigned)sizeof estimator, goe_self_check());
    return status == GOE_OK && goe_self_check() == 0u ? 0 : 1;
}
