/* Prints the answers of each part of the library as hashes, and checks that a missing part is refused. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "replay.h"

static void print(const char *name, const replay_t *replay, bool present) {
    char text[17];
    replay_hash_text(replay->hash, text);
    if (present) {
        printf("%s %s images %ld\n", name, text, replay->images);
    }
}

/* goe_init names a method that is not compiled in. */
static bool refuses(goe_method_t method) {
    goe_estimator_t estimator;
    goe_settings_t settings;
    const char *bad = NULL;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;
    if (goe_init(&estimator, sizeof estimator, &settings, &bad) != GOE_OK) {
        return false; /* the default method is a compiled one */
    }
    settings.method = method;
    return goe_init(&estimator, sizeof estimator, &settings, &bad) == GOE_BAD_SETTINGS && bad &&
           strcmp(bad, "method") == 0;
}

/* Settings of a missing part are neither read nor checked; those of an existing one are. */
static bool ignores(bool present, void (*spoil)(goe_settings_t *settings)) {
    goe_estimator_t estimator;
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;
    spoil(&settings);
    return (goe_init(&estimator, sizeof estimator, &settings, NULL) == GOE_OK) != present;
}

static void spoil_window(goe_settings_t *settings) { settings->window.points = -1; }
static void spoil_refined(goe_settings_t *settings) { settings->filter.gate_sigma = -1.0f; }

int main(void) {
    replay_parts_t parts;
    replay_parts(&parts);
    print("window", &parts.window, GOE_WITH_WINDOW);
    print("filter", &parts.filter, GOE_WITH_FILTER);
    print("window_hazard", &parts.window_hazard, GOE_WITH_WINDOW && GOE_WITH_HAZARD);
    print("refined_hazard", &parts.refined_hazard, GOE_WITH_FILTER && GOE_WITH_HAZARD);
    printf("bytes %zu\n", sizeof(goe_estimator_t));
    const bool refused =
        (GOE_WITH_WINDOW || refuses(GOE_METHOD_WINDOW)) && (GOE_WITH_FILTER || refuses(GOE_METHOD_FILTER));
    const bool ignored = ignores(GOE_WITH_WINDOW, spoil_window) && ignores(GOE_WITH_FILTER, spoil_refined);
    return refused && ignored ? 0 : 1;
}
