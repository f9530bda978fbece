/* What happened, a line each on standard error. SPDX-License-Identifier: MIT */
#ifndef EVENTS_H
#define EVENTS_H

/* Tells a change. Of one kind of text (`format`) at most one line a second; the next one says how many were left out. */
void event(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A status line stands on the terminal: it is cleared before the next event. */
void events_line_stands(int stands);

#endif
