/* The key of a signed link. SPDX-License-Identifier: MIT */
#ifndef KEY_FILE_H
#define KEY_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "input_error.h"

#define KEY_BYTES 32

/* Reads a file with 64 hexadecimal digits; only blanks may follow. False on failure: *error gives the reason. */
bool key_file_read(const char *path, uint8_t key[KEY_BYTES], input_error_t *error);

/* Returns whether users other than the owner may read the file. */
bool key_file_is_open_to_others(const char *path);

#endif
