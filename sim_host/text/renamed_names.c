/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "renamed_names.h"

#include <string.h>

const char *renamed_name(const char *name, size_t length) {
    static const struct {
        const char *before, *now;
    } names[] = {
#define RENAMED(before, now) {before, now},
#include "renamed_names_list.h"
#undef RENAMED
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strlen(names[i].before) == length && memcmp(names[i].before, name, length) == 0) {
            return names[i].now;
        }
    }
    return NULL;
}
