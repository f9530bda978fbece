/* Range check and copy of the settings, for the library's own files. SPDX-License-Identifier: MIT */
#ifndef GOE_SETTINGS_INTERNAL_H
#define GOE_SETTINGS_INTERNAL_H

#include "goe.h"

/* Returns the name of the first setting outside its range; null if there is none. */
const char *goe_settings_first_bad(const goe_settings_t *settings);

/* Copies valid settings. The padding between their fields becomes 0, because the seal covers every byte. */
void goe_settings_copy(goe_settings_t *to, const goe_settings_t *from);

#endif
