/* The two files of a counting plugin: the map and the output. SPDX-License-Identifier: MIT */
#ifndef PLUGIN_FILES_H
#define PLUGIN_FILES_H

#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct {
    const char *map; /* path; null if it was not given */
    FILE *out;       /* open for writing; null if it was not given or cannot be written */
} plugin_files_t;

/* From the arguments "map=FILE" and "out=FILE". */
static inline plugin_files_t plugin_files(int argc, char **argv) {
    plugin_files_t files = {NULL, NULL};
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "map=", 4) == 0) {
            files.map = argv[i] + 4;
        } else if (strncmp(argv[i], "out=", 4) == 0) {
            files.out = fopen(argv[i] + 4, "w");
        }
    }
    return files;
}

#endif
