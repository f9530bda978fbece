/* Bytes as a file, for parsers that take a path. SPDX-License-Identifier: MIT */
#ifndef FUZZ_FILE_H
#define FUZZ_FILE_H

#include <stddef.h>

#define FUZZ_PATH_MAX 256

/* Writes a file into a folder of this process's own, in TMPDIR, /dev/shm or /tmp, that goes with it. Returns its path, which lives until the
 * next call for the same `slot`, 0 to 3. */
const char *fuzz_file(int slot, const char *name, const void *bytes, size_t size);

/* Splits text at the first line that is "%%": the size of what comes before it; *rest is what comes behind, or null. */
size_t fuzz_split(const char *text, size_t size, const char **rest, size_t *rest_size);

#endif
