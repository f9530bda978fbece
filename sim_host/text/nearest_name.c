/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "nearest_name.h"

#include <ctype.h>
#include <string.h>

#define EDITS_SHARE 3u /* at most this part of the characters */

nearest_name_t nearest_name_of(const char *word, size_t length) {
    const nearest_name_t nearest = {word, length, NULL, 0};
    return nearest;
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

static int at(const char *text, size_t i) { return tolower((unsigned char)text[i]); }

/* Optimal string alignment: as Levenshtein's, and a swap of two neighbors is one edit. Neither longer than
 * NEAREST_WORD_MAX. */
static size_t edits_between(const char *a, size_t a_length, const char *b, size_t b_length) {
    size_t rows[3][NEAREST_WORD_MAX + 1]; /* of two characters ago, of the one before, of this one */
    for (size_t j = 0; j <= b_length; j++) {
        rows[1][j] = j;
    }
    for (size_t i = 1; i <= a_length; i++) {
        size_t *const now = rows[2];
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            const size_t change = rows[1][j - 1] + (at(a, i - 1) == at(b, j - 1) ? 0u : 1u);
            now[j] = least(change, least(rows[1][j], now[j - 1]) + 1u);
            if (i > 1 && j > 1 && at(a, i - 1) == at(b, j - 2) && at(a, i - 2) == at(b, j - 1)) {
                now[j] = least(now[j], rows[0][j - 2] + 1u);
            }
        }
        (void)memcpy(rows[0], rows[1], sizeof rows[0]);
        (void)memcpy(rows[1], rows[2], sizeof rows[1]);
    }
    return rows[1][b_length];
}

void nearest_name_try(nearest_name_t *nearest, const char *name) {
    const size_t length = strlen(name);
    if (nearest->length == 0 || nearest->length > NEAREST_WORD_MAX || length > NEAREST_WORD_MAX) {
        return;
    }
    const size_t edits = edits_between(nearest->word, nearest->length, name, length);
    const size_t longer = length > nearest->length ? length : nearest->length;
    if (edits * EDITS_SHARE <= longer && (nearest->name == NULL || edits < nearest->edits)) {
        nearest->name = name;
        nearest->edits = edits;
    }
}
