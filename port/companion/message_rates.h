/* Requests for the rates of the autopilot's messages. SPDX-License-Identifier: MIT
 *
 *   message_rates_want()  each message, once        COMMAND_ACK > message_rates_answer()
 *   message_rates_ask()   one request at a time, because an acknowledgement does not name the message
 *
 * If the autopilot refuses a rate, the companion requests lower rates, down to 5 Hz. It reports the accepted rate, or the refusal of all
 * rates, once. */
#ifndef MESSAGE_RATES_H
#define MESSAGE_RATES_H

#include "wire.h"

#define MESSAGE_RATES_MAX 16

typedef struct {
    uint32_t message;
    const char *name;
    double wanted_hz, hz;           /* wanted rate; requested rate */
    double reported_hz;             /* rate that was reported last; 0: none */
    bool refused, refusal_reported; /* every rate was refused; this was reported */
} message_rate_t;

typedef struct {
    message_rate_t rate[MESSAGE_RATES_MAX];
    unsigned count, next; /* number of messages; index of the message being requested (count: all are done) */
    unsigned tries;       /* unanswered requests for this message */
    int64_t question_us;  /* own time of the latest request */
    bool awaiting;        /* the latest request awaits its answer */
} message_rates_t;

/* Deletes all messages. */
void message_rates_clear(message_rates_t *rates);

/* Adds a message, if there are fewer than MESSAGE_RATES_MAX. */
void message_rates_want(message_rates_t *rates, uint32_t message, const char *name, double hz);

/* Returns whether the requests for all messages have ended: accepted, refused or without an answer. */
bool message_rates_done(const message_rates_t *rates);

/* Requests all messages again: each at its accepted rate, a refused one at its wanted rate. */
void message_rates_repeat(message_rates_t *rates);

/* Sends the next request, if it is due. */
void message_rates_ask(message_rates_t *rates, wire_t *wire, uint8_t system, int64_t now_us);

/* Processes the result of a COMMAND_ACK for the companion's SET_MESSAGE_INTERVAL. */
void message_rates_answer(message_rates_t *rates, uint8_t result);

#endif
