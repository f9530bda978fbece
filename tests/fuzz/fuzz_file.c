/* Bytes as a file. SPDX-License-Identifier: MIT */
#include "fuzz_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"

#define SLOTS 4

static char folder[FUZZ_PATH_MAX / 2];
static char paths[SLOTS][FUZZ_PATH_MAX];

static void remove_all(void) {
    for (int i = 0; i < SLOTS; i++) {
        if (paths[i][0] != '\0') {
            (void)unlink(paths[i]);
        }
    }
    (void)rmdir(folder);
}

static void make_folder(void) {
    const char *parent = getenv("TMPDIR");
    if (parent == NULL) {
        parent = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp"; /* in memory where possible */
    }
    (void)snprintf(folder, sizeof folder, "%s/goe-fuzz-XXXXXX", parent);
    FUZZ_CHECK(mkdtemp(folder) != NULL);
    FUZZ_CHECK(atexit(remove_all) == 0);
}

const char *fuzz_file(int slot, const char *name, const void *bytes, size_t size) {
    if (folder[0] == '\0') {
        make_folder();
    }
    (void)snprintf(paths[slot], sizeof paths[slot], "%s/%s", folder, name);
    FILE *to = fopen(paths[slot], "wb");
    FUZZ_CHECK(to != NULL);
    FUZZ_CHECK(fwrite(bytes, 1, size, to) == size);
    FUZZ_CHECK(fclose(to) == 0);
    return paths[slot];
}

size_t fuzz_split(const char *text, size_t size, const char **rest, size_t *rest_size) {
    static const char mark[] = "%%\n";
    const size_t length = sizeof mark - 1u;
    *rest = NULL;
    *rest_size = 0;
    for (size_t i = 0; i + length <= size; i++) {
        if ((i == 0 || text[i - 1] == '\n') && memcmp(&text[i], mark, length) == 0) {
            *rest = &text[i + length];
            *rest_size = size - i - length;
            return i;
        }
    }
    return size;
}
