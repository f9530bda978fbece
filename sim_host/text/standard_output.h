/* Checks that printed text arrived. SPDX-License-Identifier: MIT */
#ifndef STANDARD_OUTPUT_H
#define STANDARD_OUTPUT_H

#include <stdbool.h>

/* Writes out what standard output still holds. False, and a line on standard error, if not all of it could be written: a full
 * disk, a closed pipe. */
bool standard_output_written(const char *program);

/* Checks it when the program ends, also where popt ends it (--help), and then ends it with this status. The program must not close
 * standard output. */
void standard_output_watch(const char *program, int failed_status);

#endif
