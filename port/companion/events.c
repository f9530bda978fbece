/* What happened, a line each. SPDX-License-Identifier: MIT */
#include "events.h"

#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define KINDS 64
#define TEXT_MAX 256
#define TIME_MAX 32
#define NS_PER_MS 1000000

static int line_shown; /* a status line, on the terminal: it is cleared before the next event */

/* Kinds of events are distinguished by their format, each a constant of its own. */
static struct {
    const char *format;
    time_t reported_s;
    unsigned long left_out;
} kinds[KINDS];

/* At once, or not at all: at most PIPE_BUF bytes, which a pipe takes whole. */
static void put(const char *text) {
    struct pollfd request = {.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    if (poll(&request, 1, 0) > 0 && (request.revents & POLLOUT) != 0) {
        const ssize_t written = write(STDERR_FILENO, text, strlen(text));
        (void)written; /* no one can read it */
    }
}

void events_show_line(const char *line, int on_terminal) {
    char text[TEXT_MAX + 16];
    (void)snprintf(text, sizeof text, "%s%s%s", on_terminal ? "\r\033[K" : "", line, on_terminal ? "" : "\n");
    put(text);
    line_shown = on_terminal;
}

/* Whether an event of this kind is due; *left_out: how many were dropped since. */
static int is_due(const char *format, unsigned long *left_out) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    int i = 0;
    while (i < KINDS - 1 && kinds[i].format != NULL && kinds[i].format != format) {
        i++;
    }
    if (kinds[i].format == format && now.tv_sec - kinds[i].reported_s < 1) {
        kinds[i].left_out++;
        return 0;
    }
    *left_out = kinds[i].format == format ? kinds[i].left_out : 0;
    kinds[i].format = format;
    kinds[i].reported_s = now.tv_sec;
    kinds[i].left_out = 0;
    return 1;
}

/* Texts quote what others sent: no escape sequence of theirs reaches the terminal. */
static void make_printable(char *text) {
    for (; *text != '\0'; text++) {
        if (*text < ' ' || *text > '~') {
            *text = '?';
        }
    }
}

/* UTC, to the millisecond. */
static void put_time(char text[TIME_MAX]) {
    struct timespec now;
    struct tm day;
    char seconds[TIME_MAX];
    (void)clock_gettime(CLOCK_REALTIME, &now);
    (void)gmtime_r(&now.tv_sec, &day);
    (void)strftime(seconds, sizeof seconds, "%Y-%m-%dT%H:%M:%S", &day);
    (void)snprintf(text, TIME_MAX, "%.20s.%03uZ", seconds, (unsigned)(now.tv_nsec / NS_PER_MS) % 1000u);
}

void event(const char *format, ...) {
    char text[TEXT_MAX], line[2 * TEXT_MAX], more[48] = "", time[TIME_MAX];
    unsigned long left_out = 0;
    va_list arguments;
    if (!is_due(format, &left_out)) {
        return;
    }
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    make_printable(text);
    if (left_out > 0) {
        (void)snprintf(more, sizeof more, " (and %lu more)", left_out);
    }
    put_time(time);
    (void)snprintf(line, sizeof line, "%s%s goe_companion: %s%s\n", line_shown ? "\r\033[K" : "", time, text, more);
    put(line);
    line_shown = 0;
}
