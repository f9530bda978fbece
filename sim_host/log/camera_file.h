/* Reads camera.ini. SPDX-License-Identifier: MIT */
#ifndef CAMERA_FILE_H
#define CAMERA_FILE_H

#include <stdbool.h>

#include "goe.h"
#include "input_error.h"

/* Reads the camera and the trajectory's heading into *settings, whose other fields stay as they are. Unknown, repeated and
 * missing keys, text in place of a number and numbers that the library refuses are errors; so is an image without size,
 * which the library would take for one of unknown size.
 * False on failure: *error says what is wrong and where. */
bool camera_file_read(const char *path, goe_settings_t *settings, input_error_t *error);

#endif
