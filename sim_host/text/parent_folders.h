/* The folders that a path leads through. SPDX-License-Identifier: MIT */
#ifndef PARENT_FOLDERS_H
#define PARENT_FOLDERS_H

#include <stdbool.h>

/* Makes those that are missing; the last part of the path is not made. False on failure: errno says why. */
bool parent_folders_make(const char *path);

#endif
