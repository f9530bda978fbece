/* "Did you mean ...?": the one of some names that a mistyped word was probably meant to be. SPDX-License-Identifier: MIT */
#ifndef NEAREST_NAME_H
#define NEAREST_NAME_H

#include <stddef.h>

#define NEAREST_WORD_MAX 64 /* characters; of longer words nothing is guessed */

typedef struct {
    const char *word;
    size_t length;
    const char *name; /* the nearest so far; null: none near enough */
    size_t edits;     /* characters to change, insert or leave out, and neighbors to swap, from word to name */
} nearest_name_t;

/* The word need not end with a zero; it must outlive the search. */
nearest_name_t nearest_name_of(const char *word, size_t length);

/* The first of equally near names stays. Farther than a third of the longer one's characters is not near. */
void nearest_name_try(nearest_name_t *nearest, const char *name);

#endif
