/* Names of the statuses. SPDX-License-Identifier: MIT */
#include "goe.h"

#define CALLS_FROM GOE_BAD_SETTINGS /* the numbers of the calls' statuses begin here, apart from those of images */

/* One after the other, so that no addresses have to be kept: from the highest number down. */
static const char of_images[] =
    "nothing_seen\0held\0collecting\0partial\0ok\0behind_camera\0lens_failed\0swapped\0edge_on\0"
    "no_edge\0bad_height\0no_baseline\0no_parallax\0passed\0not_finite\0out_of_range\0"
    "bad_time\0bad_attitude\0";
static const char of_calls[] = "bad_settings\0bad_argument\0not_initialised\0";

const char *goe_status_text(goe_status_t status) {
    const int number = (int)status;
    const bool of_image = number >= GOE_BAD_ATTITUDE && number <= GOE_NOTHING_SEEN;
    const bool of_call = number >= GOE_NOT_INITIALISED && number <= CALLS_FROM;
    const char *name = of_image ? of_images : of_calls;
    if (!of_image && !of_call) {
        return "unknown";
    }
    for (int k = of_image ? GOE_NOTHING_SEEN : CALLS_FROM; k > number; k--) {
        while (*name++ != '\0') {
        }
    }
    return name;
}
