/* The package's estimator starts, which it does only if header and library agree on the parts. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include <goe.h>

#ifdef CONSUMER_HAS_LAYERS
#include <goe_flight.h>
#include <goe_mavlink.h>

static const char *layers(const goe_settings_t *settings) {
    static goe_flight_t flight;
    const char *bad = NULL;
    if (goe_flight_init(&flight, sizeof flight, settings, NULL, &bad) != GOE_FLIGHT_OK) {
        return NULL;
    }
    return goe_mavlink_info(GOE_MAVLINK_STATUS)->name;
}
#else
static const char *layers(const goe_settings_t *settings) {
    (void)settings;
    return "no layers";
}
#endif

int main(void) {
    static goe_estimator_t estimator;
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 914.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;
    const goe_status_t status = goe_init(&estimator, sizeof estimator, &settings, NULL);
    const char *layer = layers(&settings);
    printf("goe %d.%d.%d: %s, %u bytes, self check 0x%02X, %s\n", GOE_VERSION_MAJOR, GOE_VERSION_MINOR,
           GOE_VERSION_PATCH, goe_status_text(status), (unsigned)sizeof estimator, goe_self_check(),
           layer ? layer : "bad settings");
    return status == GOE_OK && goe_self_check() == 0u && layer != NULL ? 0 : 1;
}
