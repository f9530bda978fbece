/* A file that appears whole or not at all. SPDX-License-Identifier: MIT */
#ifndef OUTPUT_FILE_H
#define OUTPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>

typedef struct {
    FILE *stream;    /* write here */
    char *target;    /* null: standard output, a device or a pipe, which cannot be replaced and is streamed to */
    char *temporary; /* next to the target; removed when the program is interrupted */
} output_file_t;

/* path null: standard output. A regular file is left as it is until output_file_commit(); a symbolic link to one stays a link.
 * Folders on the way that are missing are made.
 * A link that leads nowhere is refused (ENOENT): neither the link is to be replaced nor a file to be made in an unnamed place.
 * One output at a time. False on failure: errno says why. */
bool output_file_open(output_file_t *output, const char *path);

/* All is written: the file takes its place. False on failure, then nothing is left behind: errno says why. */
bool output_file_commit(output_file_t *output);

/* Whether both paths lead to one regular file, by links of any kind: an input that the output would replace. */
bool output_file_is(const char *path, const char *input);

/* Drops the written text. */
void output_file_discard(output_file_t *output);

#endif
