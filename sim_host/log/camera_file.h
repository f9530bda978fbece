/* Reads camera.ini. SPDX-License-Identifier: MIT */
#ifndef CAMERA_FILE_H
#define CAMERA_FILE_H

#include <stdbool.h>

#include "goe.h"
#include "input_error.h"

/* Reads the cameras and the trajectory's heading into *settings, whose other fields stay as they are. There is a second camera
 * as soon as one key of it is given. Unknown, repeated and missing keys, text in place of a number and numbers that the
 * library refuses are errors; so is an image without size, which the library would take for one of unknown size.
 * False on failure: *error gives the fault and its position. */
bool camera_file_read(const char *path, goe_settings_t *settings, input_error_t *error);

/* How many cameras the settings hold, 1 or 2. */
int camera_file_cameras(const goe_settings_t *settings);

#endif
