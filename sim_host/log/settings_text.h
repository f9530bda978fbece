/* The library's settings by name. SPDX-License-Identifier: MIT */
#ifndef SETTINGS_TEXT_H
#define SETTINGS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "goe.h"

typedef struct {
    char text[512];
} setting_fault_t;

/* Sets any field by its name in goe_settings_t ("noise.pixel_px", "camera.fx_px", "method", ...). Whole numbers, truth
 * values (0 or 1) and enumerations as numbers too. Ranges are goe_init()'s affair.
 * False, and nothing set, if there is no such field or the value is not of its kind. */
bool setting_put(goe_settings_t *settings, const char *name, double value);

/* Takes "NAME=VALUE" of the settings to be tuned: all but the camera, the heading, method, model and window, which logs and
 * options have places of their own for. False, and nothing set: *fault says why. */
bool setting_assign(goe_settings_t *settings, const char *assignment, setting_fault_t *fault);

/* The name of the first setting, beside the camera, that goe_init() refuses; null if it refuses none. */
const char *settings_out_of_range(const goe_settings_t *settings);

/* The names of the settings to be tuned with their values, in lines. False if they could not be written. */
bool settings_print(FILE *stream, const goe_settings_t *settings);

#endif
