/* The fields of the estimator's memory by name. SPDX-License-Identifier: MIT */
#ifndef FIELDS_H
#define FIELDS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    const char *name;
    size_t offset, bytes;
    bool decides; /* an index, a count, an enumeration, a bool or a setting: every bit of it is always flipped */
} field_t;

extern const field_t fields[];
extern const size_t field_count; /* the last entry covers the bytes between the others */

/* Number of the field that contains the byte. */
size_t field_at(size_t byte);

#endif
