/* Names of the statuses and of the reasons, as text. SPDX-License-Identifier: MIT */
#include "goe.h"

#define CALLS_FROM GOE_BAD_SETTINGS /* first number of the statuses of calls, which are apart from those of images */

/* The names follow one another, so no addresses are kept; from the highest number down. */
static const char of_images[] =
    "no_detection\0stale\0converging\0partial\0ok\0behind_camera\0lens_failed\0swapped\0edge_on\0"
    "no_edge\0bad_height\0no_baseline\0no_parallax\0abeam\0not_finite\0out_of_range\0"
    "bad_time\0bad_attitude\0box_incomplete\0no_height\0";
static const char of_calls[] = "bad_settings\0bad_argument\0not_initialized\0corrupted\0";

static const char of_reasons[] = "none\0convention\0moves\0base\0shape\0late\0noise\0";

static const char *name_at(const char *name, int steps) {
    for (; steps > 0; steps--) {
        while (*name++ != '\0') {
        }
    }
    return name;
}

const char *goe_reason_text(goe_reason_t reason) {
    const int number = (int)reason;
    return number >= GOE_REASON_NONE && number <= GOE_REASON_NOISE ? name_at(of_reasons, number) : "unknown";
}

const char *goe_status_text(goe_status_t status) {
    const int number = (int)status;
    const bool of_image = number >= GOE_NO_HEIGHT && number <= GOE_NO_DETECTION;
    const bool of_call = number >= GOE_CORRUPTED && number <= CALLS_FROM;
    if (!of_image && !of_call) {
        return "unknown";
    }
    return of_image ? name_at(of_images, GOE_NO_DETECTION - number) : name_at(of_calls, CALLS_FROM - number);
}
