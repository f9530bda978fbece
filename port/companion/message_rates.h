/* Requested rates of the autopilot's messages. SPDX-License-Identifier: MIT
 *
 *   message_rates_want()  each message, once        COMMAND_ACK > message_rates_answer()
 *   message_rates_ask()   one request at a time: an acknowledgement names the command, and not the message
 *
 * A refused message is requested less often, down to LEAST_HZ; if refused then, it is given up. Either is reported once. */
#ifndef MESSAGE_RATES_H
#define MESSAGE_RATES_H

#include "wire.h"

#define MESSAGE_RATES_MAX 16

typedef struct {
    uint32_t message;
    const char *name;
    double wanted_hz, hz;           /* hz: the present request */
    double reported_hz;             /* that was reported last; 0: none was */
    bool refused, refusal_reported; /* at every rate */
} message_rate_t;

typedef struct {
    message_rate_t rate[MESSAGE_RATES_MAX];
    unsigned count, next; /* next: the one being requested; count: all are done */
    unsigned tries;       /* requests for it without an answer */
    int64_t question_us;  /* own time of the latest request */
    bool awaiting;        /* its answer */
} message_rates_t;

/* Forgets everything. */
void message_rates_clear(message_rates_t *rates);

/* Adds a message; beyond MESSAGE_RATES_MAX none is added. */
void message_rates_want(message_rates_t *rates, uint32_t message, const char *name, double hz);

/* Whether every message was accepted, refused or left unanswered. */
bool message_rates_done(const message_rates_t *rates);

/* Begins again with the first message: each at its accepted rate, refused ones at the wanted rate. */
void message_rates_repeat(message_rates_t *rates);

/* Sends the next request, if it is due. */
void message_rates_ask(message_rates_t *rates, wire_t *wire, uint8_t system, int64_t now_us);

/* The result of a COMMAND_ACK for SET_MESSAGE_INTERVAL that is meant for the companion. */
void message_rates_answer(message_rates_t *rates, uint8_t result);

#endif
