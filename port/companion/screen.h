/* What the pilot reads: STATUSTEXT. SPDX-License-Identifier: MIT
 *
 * Of each kind of text the latest waits for its turn, the most severe first: what a kind shows last is how things are. */
#ifndef SCREEN_H
#define SCREEN_H

#include "wire.h"

#define SCREEN_TEXT_MAX 50 /* of STATUSTEXT, without chunks */

typedef enum {
    SCREEN_ORDER,
    SCREEN_SILENCE,
    SCREEN_DETECTOR,
    SCREEN_POSE,
    SCREEN_NAVIGATION,
    SCREEN_KINDS
} screen_kind_t;

typedef struct {
    char text[SCREEN_TEXT_MAX];
    uint8_t severity; /* MAV_SEVERITY_... */
    bool waits;
    int64_t shown_us; /* own time when the latest of this kind went out; 0: none did */
} screen_line_t;

typedef struct {
    bool on;
    screen_line_t line[SCREEN_KINDS];
    int64_t shown_us; /* of any kind */
} screen_t;

/* A text of this kind; one that still waits is given up for it. Null or a screen that is off: nothing is shown. */
void screen_show(screen_t *screen, screen_kind_t kind, uint8_t severity, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Sends due texts: two a second at most, and of a kind one in two seconds. */
void screen_go_on(screen_t *screen, wire_t *wire, int64_t now_us);

#endif
