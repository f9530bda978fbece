/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "parent_folders.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define FOLDER_MODE 0777u /* before the caller's umask */

/* mkdir() may answer otherwise than EEXIST for a folder that is there: on a read-only disk, for one. */
static bool make_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 || mkdir(path, FOLDER_MODE) == 0 || errno == EEXIST;
}

bool parent_folders_make(const char *path) {
    char *part = strdup(path);
    bool done = part != NULL;
    for (char *slash = part; done && (slash = strchr(slash, '/')) != NULL; slash++) {
        *slash = '\0';
        done = *part == '\0' || make_folder(part);
        *slash = '/';
    }
    const int cause = errno;
    free(part);
    errno = cause;
    return done;
}
