/* Bytes as a file, for parsers that take a path. SPDX-License-Identifier: MIT */
#ifndef FUZZ_FILE_H
#define FUZZ_FILE_H

#include <stddef.h>

#define FUZZ_PATH_MAX 256

/* Writes a file into a private folder of this process, in TMPDIR, /dev/shm or /tmp, which is removed at the end. Returns its path, which is
 * valid until the next call for the same `slot`, 0 to 3. */
const char *fuzz_file(int slot, const char *name, const void *bytes, size_t size);

/* Splits text at the first line that is "%%". Returns the size of the part before it; *rest is the part after it, or null. */
size_t fuzz_split(const char *text, size_t size, const char **rest, size_t *rest_size);

#endif
