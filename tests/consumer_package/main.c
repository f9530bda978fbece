/* Flies 40 m towards a chimney of 6 m diameter at north 200, east -30 and prints its position. */
#include <goe_flight.h>
#include <math.h>
#include <stdio.h>

#define FOCAL_PX 800.0f
#define CENTER_U_PX 640.0f
#define CENTER_V_PX 360.0f

/* The flight layer accepts the same settings. */
static bool flight_layer_starts(const goe_settings_t *settings) {
    static goe_flight_t flight;
    const char *bad = NULL;
    return goe_flight_init(&flight, sizeof flight, settings, NULL, &bad) == GOE_FLIGHT_OK && bad == NULL;
}

static goe_pixel_t horizon(float u_px) {
    goe_pixel_t pixel;
    pixel.u_px = u_px;
    pixel.v_px = CENTER_V_PX;
    pixel.visible = true;
    return pixel;
}

int main(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = FOCAL_PX;
    settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = CENTER_U_PX;
    settings.camera.cy_px = CENTER_V_PX;
    settings.camera.width_px = 2.0f * CENTER_U_PX;
    settings.camera.height_px = 2.0f * CENTER_V_PX;

    goe_estimator_t estimator;
    const char *bad_field;
    if (goe_init(&estimator, sizeof estimator, &settings, &bad_field) != GOE_OK) {
        printf("bad setting %s\n", bad_field);
        return 1;
    }
    if (!flight_layer_starts(&settings)) {
        printf("the flight layer does not start\n");
        return 1;
    }

    goe_status_t status = GOE_CONVERGING;
    goe_estimate_t estimate = {0};
    for (int i = 0; i <= 8; i++) {
        const float north_m = 5.0f * (float)i;
        const float x_m = -30.0f;
        const float z_m = 200.0f - north_m;
        const float range_m = sqrtf(x_m * x_m + z_m * z_m);
        const float bearing = atan2f(x_m, z_m);
        const float half = asinf(3.0f / range_m); /* half the angle of the chimney's width */
        goe_image_t image = {0};
        image.pose.time_us = 100000 * i;
        image.pose.position_ned_m[0] = north_m;
        image.pose.position_ned_m[2] = -40.0f;
        image.pose.height_m = 40.0f;
        image.pose.attitude[0] = 1.0f;
        image.left = horizon(CENTER_U_PX + FOCAL_PX * tanf(bearing - half));
        image.right = horizon(CENTER_U_PX + FOCAL_PX * tanf(bearing + half));
        status = goe_update(&estimator, &image, &estimate);
    }
    printf("%s: X0 = %.2f m, Z0 = %.2f m, width = %.2f m\n", goe_status_text(status), (double)estimate.x0_m,
           (double)estimate.z0_m, (double)estimate.width_m);
    return status == GOE_OK && fabsf(estimate.x0_m + 30.0f) < 0.3f && fabsf(estimate.z0_m - 200.0f) < 2.0f &&
                   fabsf(estimate.width_m - 6.0f) < 0.06f
               ? 0
               : 1;
}
