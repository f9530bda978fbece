/* Texts for the pilot, sent as STATUSTEXT. SPDX-License-Identifier: MIT
 *
 * For each kind of text only the latest one waits to be sent, and the most severe one is sent first. The latest text of a kind thus always
 * gives the present state. */
#ifndef SCREEN_H
#define SCREEN_H

#include "wire.h"

#define SCREEN_TEXT_MAX 50 /* characters of a STATUSTEXT without chunks */

typedef enum {
    SCREEN_ORDER,
    SCREEN_SILENCE,
    SCREEN_DETECTOR,
    SCREEN_BOXES,
    SCREEN_POSE,
    SCREEN_NAVIGATION,
    SCREEN_KINDS
} screen_kind_t;

typedef struct {
    char text[SCREEN_TEXT_MAX];
    uint8_t severity; /* MAV_SEVERITY_... */
    bool waits;
    int64_t shown_us; /* own time when the latest text of this kind was sent; 0: none */
} screen_line_t;

typedef struct {
    bool on;
    screen_line_t line[SCREEN_KINDS];
    int64_t shown_us; /* own time when the latest text of any kind was sent */
} screen_t;

/* Adds a text of this kind, which replaces a waiting text of this kind. Does nothing if the screen is null or off. */
void screen_show(screen_t *screen, screen_kind_t kind, uint8_t severity, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Sends a due text: at most two texts a second, and one of each kind in two seconds. */
void screen_go_on(screen_t *screen, wire_t *wire, int64_t now_us);

#endif
