/* Checks of the settings. SPDX-License-Identifier: MIT */
#ifndef GOE_SETTINGS_H
#define GOE_SETTINGS_H

#include "goe.h"

/* Name of the first setting outside its range, null if there is none. */
/*@ requires \valid_read(settings); */
const char *goe_settings_first_bad(const goe_settings_t *settings);

#endif
