// Flies towards a mast of 6 m by 30 m, 200 m ahead, and prints its estimate.
// In an aircraft the pose is the autopilot's at the time of exposure, and the box is the detector's.
#include <goe.h>

static goe_estimator_t mast; // one per obstacle, all the memory there is

static const float FOCAL_PX = 914.0f;
static const float CENTER_PX = 640.0f;

void setup() {
    Serial.begin(115200);
    const unsigned wrong = goe_self_check();
    if (wrong != 0u) {
        Serial.print("not the same bits as elsewhere: self check 0x");
        Serial.println(wrong, HEX);
    }
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = settings.camera.cy_px = CENTER_PX;
    settings.camera.width_px = settings.camera.height_px = 2.0f * CENTER_PX;
    const char *bad = nullptr;
    if (goe_init(&mast, sizeof mast, &settings, &bad) != GOE_OK) {
        Serial.print("bad setting: ");
        Serial.println(bad ? bad : "another library than this header's");
        while (true) {
            delay(1000);
        }
    }
}

void loop() {
    static int k = 0;
    if (k == 80) { // from the start again
        k = 0;
        (void)goe_reset(&mast);
    }
    const float ahead_m = 200.0f - 2.0f * (float)k;
    goe_image_t image = {};
    image.pose.time_us = 125000LL * k;
    image.pose.position_ned_m[0] = 2.0f * (float)k;
    image.pose.height_m = 15.0f;
    image.pose.attitude[0] = 1.0f;
    image.box.left_px = CENTER_PX - FOCAL_PX * 3.0f / ahead_m;
    image.box.right_px = CENTER_PX + FOCAL_PX * 3.0f / ahead_m;
    image.box.top_px = CENTER_PX - FOCAL_PX * 15.0f / ahead_m;
    image.box.bottom_px = CENTER_PX + FOCAL_PX * 15.0f / ahead_m;
    image.box.sides = GOE_SIDES_ALL;
    goe_estimate_t now;
    const goe_status_t status = goe_update(&mast, &image, &now);
    Serial.print(goe_status_text(status));
    if (now.valid & GOE_HAS_POSITION) {
        Serial.print(": ");
        Serial.print(now.z_m);
        Serial.print(" m ahead, one sigma ");
        Serial.print(now.sigma.z_m);
    }
    Serial.println();
    k++;
    delay(125);
}
