/* Status line and summary for the operator. SPDX-License-Identifier: MIT */
#ifndef STATUS_LINE_H
#define STATUS_LINE_H

#include "companion.h"

/* Shows the status; to be called once a second. A terminal's line is replaced; elsewhere a new line is written every ten seconds. */
void status_line_show(const companion_t *companion);

/* Prints the numbers of received and lost messages, at the end. */
void status_line_summary(const companion_t *companion);

#endif
