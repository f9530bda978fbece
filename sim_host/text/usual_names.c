/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "usual_names.h"

#include <string.h>

const char *usual_name(const char *name) {
    static const struct {
        const char *name, *ours;
    } names[] = {
#define USUAL(name, ours) {name, ours},
#include "usual_names_list.h"
#undef USUAL
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(names[i].name, name) == 0) {
            return names[i].ours;
        }
    }
    return NULL;
}
