/* The key of a signed link. SPDX-License-Identifier: MIT */
#ifndef KEY_FILE_H
#define KEY_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "input_error.h"

#define KEY_BYTES 32

/* Reads 64 hexadecimal digits, and nothing else but blanks at the end. False on failure: *error gives the reason. */
bool key_file_read(const char *path, uint8_t key[KEY_BYTES], input_error_t *error);

/* Whether others than its owner may read it. */
bool key_file_is_open_to_others(const char *path);

#endif
