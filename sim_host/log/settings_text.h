/* The library's settings by name. SPDX-License-Identifier: MIT */
#ifndef SETTINGS_TEXT_H
#define SETTINGS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "goe.h"

typedef struct {
    char text[1024];
} setting_fault_t;

/* Takes "NAME=VALUE" of the settings to be tuned: navigation, detector, filter and window; the others have places of their own
 * in logs and options. False, and nothing set: *fault says why. */
bool setting_assign(goe_settings_t *settings, const char *assignment, setting_fault_t *fault);

/* Whether goe_init() takes the settings, the camera aside. Otherwise *fault names the first bad one and its range. */
bool settings_in_range(const goe_settings_t *settings, setting_fault_t *fault);

/* The range of the setting at an offset in goe_settings_t. False: there is none. */
bool setting_range(size_t offset, double *low, double *high);

/* The names of the settings to be tuned with their values, in lines. False if they could not be written. */
bool settings_print(FILE *stream, const goe_settings_t *settings);

/* All settings, a line each: name, unit, low, high, default, text, between tabs. False if they could not be written. */
bool settings_list(FILE *stream);

#endif
