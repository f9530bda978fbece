/* The key of a signed link. SPDX-License-Identifier: MIT */
#include "key_file.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define DIGITS (2 * KEY_BYTES)
#define TEXT_MAX 100

/* Value of a hexadecimal digit; -1: it is none. */
static int digit(char c) {
    static const char digits[] = "0123456789abcdef";
    const char *found = c != '\0' ? strchr(digits, tolower((unsigned char)c)) : NULL;
    return found != NULL ? (int)(found - digits) : -1;
}

static bool parse(const char *text, size_t size, uint8_t key[KEY_BYTES]) {
    while (size > 0 && isspace((unsigned char)text[size - 1u]) != 0) {
        size--;
    }
    for (size_t i = 0; i < DIGITS && size == DIGITS; i += 2) {
        const int high = digit(text[i]);
        const int low = digit(text[i + 1u]);
        if (high < 0 || low < 0) {
            return false;
        }
        key[i / 2u] = (uint8_t)(high * 16 + low);
    }
    return size == DIGITS;
}

bool key_file_read(const char *path, uint8_t key[KEY_BYTES], input_error_t *error) {
    char text[TEXT_MAX];
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        input_error_set(error, path, 0, NULL, "cannot be opened: %s", strerror(errno));
        return false;
    }
    const size_t size = fread(text, 1, sizeof text, file);
    (void)fclose(file);
    const bool good = parse(text, size, key);
    if (!good) {
        input_error_set(error, path, 0, NULL, "a key is %d hexadecimal digits, as of: openssl rand -hex %d", DIGITS,
                        KEY_BYTES);
    }
    (void)memset(text, 0, sizeof text);
    return good;
}

bool key_file_is_open_to_others(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && (about.st_mode & (S_IRGRP | S_IROTH)) != 0;
}
