/* Writes estimates as CSV. SPDX-License-Identifier: MIT */
#ifndef ESTIMATE_WRITER_H
#define ESTIMATE_WRITER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "goe.h"

/* The header line; suspect (0 or 1) and reason (goe_reason_text) follow the quantities. residuals: with the columns nis, nis_rows,
 * nis_ratio, and of velocity north and east and of the latency the value and its sigma, at the end.
 * False if it could not be written: errno says why. */
bool estimate_write_header(FILE *stream, bool residuals);

/* One row; a quantity that is not valid leaves its field and that of its sigma empty. residuals: as in the header; nis is
 * empty where no rows made it, nis_ratio until there is one. time_text: at most 63 characters.
 * False if it could not be written: errno says why. */
bool estimate_write_row(FILE *stream, const char *time_text, int64_t id, goe_status_t status,
                        const goe_estimate_t *estimate, bool residuals);

#endif
