/* What happened, a line each on standard error. SPDX-License-Identifier: MIT
 *
 * A terminal that is stopped, or a pipe that nobody reads, costs the lines and holds nothing up. */
#ifndef EVENTS_H
#define EVENTS_H

/* Reports a change, with the time (UTC). Of one kind of text (`format`) at most one line a second; the next one says how many were left out. */
void event(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The status line: renewed in place on a terminal, else a line. */
void events_show_line(const char *line, int on_terminal);

#endif
