/* Writes estimates as CSV. SPDX-License-Identifier: MIT */
#ifndef ESTIMATE_WRITER_H
#define ESTIMATE_WRITER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "goe.h"

/* The header line. False if it could not be written: errno says why. */
bool estimate_write_header(FILE *stream);

/* One row; a quantity that is not valid leaves its field and that of its sigma empty. time_text: at most 63 characters.
 * False if it could not be written: errno says why. */
bool estimate_write_row(FILE *stream, const char *time_text, int64_t id, goe_status_t status,
                        const goe_estimate_t *estimate);

#endif
