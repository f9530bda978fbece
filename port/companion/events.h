/* Reports of events, one line each on standard error. SPDX-License-Identifier: MIT
 *
 * If the terminal is stopped or nobody reads the pipe, lines are lost, and the program continues without delay. */
#ifndef EVENTS_H
#define EVENTS_H

/* Reports an event with its UTC time. For each `format` it writes at most one line a second; the next line gives the number of dropped
 * lines. */
void event(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Shows the status line: a terminal's line is replaced, elsewhere a new line is written. */
void events_show_line(const char *line, int on_terminal);

#endif
