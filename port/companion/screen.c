/* What the pilot reads. SPDX-License-Identifier: MIT */
#include "screen.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define EVERY_US 500000       /* between two texts */
#define KIND_EVERY_US 2000000 /* ... of a kind */

void screen_show(screen_t *screen, screen_kind_t kind, uint8_t severity, const char *format, ...) {
    va_list arguments;
    if (screen == NULL || !screen->on) {
        return;
    }
    screen_line_t *line = &screen->line[kind];
    va_start(arguments, format);
    (void)vsnprintf(line->text, sizeof line->text, format, arguments);
    va_end(arguments);
    line->severity = severity;
    line->waits = true;
}

/* The most severe of those that are due; null: none is. */
static screen_line_t *find_due(screen_t *screen, int64_t now_us) {
    screen_line_t *due = NULL;
    for (int kind = 0; kind < SCREEN_KINDS; kind++) {
        screen_line_t *line = &screen->line[kind];
        const bool may = line->waits && (line->shown_us == 0 || now_us - line->shown_us >= KIND_EVERY_US);
        due = may && (due == NULL || line->severity < due->severity) ? line : due;
    }
    return due;
}

void screen_go_on(screen_t *screen, wire_t *wire, int64_t now_us) {
    mavlink_message_t message;
    char text[SCREEN_TEXT_MAX + 1] = "";
    screen_line_t *line = now_us - screen->shown_us >= EVERY_US ? find_due(screen, now_us) : NULL;
    if (line == NULL || wire->autopilot_system == 0) {
        return;
    }
    line->waits = false;
    line->shown_us = screen->shown_us = now_us;
    (void)memcpy(text, line->text, sizeof line->text);
    (void)mavlink_msg_statustext_pack(wire->system, wire->component, &message, line->severity, text, 0, 0);
    wire_send(wire, &message);
}
