/* What an operator reads. SPDX-License-Identifier: MIT */
#ifndef STATUS_LINE_H
#define STATUS_LINE_H

#include "companion.h"

/* Once a second: renewed in place on a terminal, else a line of its own every ten seconds. */
void status_line_show(const companion_t *companion);

/* All that came and was lost, at the end. */
void status_line_summary(const companion_t *companion);

#endif
