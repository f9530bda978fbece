/* Names of the statuses. SPDX-License-Identifier: MIT */
#include "goe.h"

const char *goe_status_text(goe_status_t status) {
    switch (status) {
        case GOE_OK:
            return "ok";
        case GOE_PARTIAL:
            return "partial";
        case GOE_COLLECTING:
            return "collecting";
        case GOE_HELD:
            return "held";
        case GOE_NOTHING_SEEN:
            return "nothing_seen";
        case GOE_BEHIND_CAMERA:
            return "behind_camera";
        case GOE_LENS_FAILED:
            return "lens_failed";
        case GOE_SWAPPED:
            return "swapped";
        case GOE_EDGE_ON:
            return "edge_on";
        case GOE_NO_EDGE:
            return "no_edge";
        case GOE_BAD_HEIGHT:
            return "bad_height";
        case GOE_NO_BASELINE:
            return "no_baseline";
        case GOE_NO_PARALLAX:
            return "no_parallax";
        case GOE_PASSED:
            return "passed";
        case GOE_NOT_FINITE:
            return "not_finite";
        case GOE_OUT_OF_RANGE:
            return "out_of_range";
        case GOE_BAD_TIME:
            return "bad_time";
        case GOE_BAD_ATTITUDE:
            return "bad_attitude";
        case GOE_BAD_SETTINGS:
            return "bad_settings";
        case GOE_BAD_ARGUMENT:
            return "bad_argument";
        case GOE_NOT_INITIALISED:
            return "not_initialised";
        default:
            return "unknown";
    }
}
