/* What happened, a line each. SPDX-License-Identifier: MIT */
#include "events.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>

#define KINDS 32
#define TEXT_MAX 256

static int line_stands;

/* Kinds of events are told apart by their format, each a constant of its own. */
static struct {
    const char *format;
    time_t told_s;
    unsigned long left_out;
} kinds[KINDS];

void events_line_stands(int stands) { line_stands = stands; }

/* Whether an event of this kind is due; *left_out: how many were not told since. */
static int is_due(const char *format, unsigned long *left_out) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    int i = 0;
    while (i < KINDS - 1 && kinds[i].format != NULL && kinds[i].format != format) {
        i++;
    }
    if (kinds[i].format == format && now.tv_sec - kinds[i].told_s < 1) {
        kinds[i].left_out++;
        return 0;
    }
    *left_out = kinds[i].format == format ? kinds[i].left_out : 0;
    kinds[i].format = format;
    kinds[i].told_s = now.tv_sec;
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

void event(const char *format, ...) {
    char text[TEXT_MAX];
    unsigned long left_out = 0;
    va_list arguments;
    if (!is_due(format, &left_out)) {
        return;
    }
    if (line_stands) {
        (void)fputs("\r\033[K", stderr);
    }
    (void)fputs("goe_companion: ", stderr);
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    make_printable(text);
    (void)fputs(text, stderr);
    if (left_out > 0) {
        (void)fprintf(stderr, " (and %lu more)", left_out);
    }
    (void)fputc('\n', stderr);
}
