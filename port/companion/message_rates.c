/* How often the autopilot is to send what. SPDX-License-Identifier: MIT */
#include "message_rates.h"

#include <math.h>
#include <string.h>

#include "events.h"

#define US_PER_S 1000000
#define ANSWER_US 1000000 /* an answer that takes longer is lost */
#define HZ_SAME 0.5
#define TRIES_MAX 5 /* requests without an answer, after which the next message follows */

/* Rates that are tried after a refusal, Hz. ArduPilot sends a message at most in 80 % of its main loops: at 50 loops a second, the
 * least for a plane, in 40. Below the last one a pose counts as dead: 0.5 s. */
static const double ladder_hz[] = {40.0, 25.0, 20.0, 10.0, 5.0};
#define STEPS (sizeof ladder_hz / sizeof ladder_hz[0])

void message_rates_clear(message_rates_t *rates) { (void)memset(rates, 0, sizeof *rates); }

void message_rates_want(message_rates_t *rates, uint32_t message, const char *name, double hz) {
    if (rates->count < MESSAGE_RATES_MAX) {
        const message_rate_t rate = {.message = message, .name = name, .wanted_hz = hz, .hz = hz};
        rates->rate[rates->count] = rate;
        rates->count++;
    }
}

bool message_rates_done(const message_rates_t *rates) { return rates->next >= rates->count; }

void message_rates_repeat(message_rates_t *rates) {
    rates->next = rates->tries = 0;
    rates->awaiting = false;
    for (unsigned i = 0; i < rates->count; i++) {
        message_rate_t *rate = &rates->rate[i];
        rate->hz = rate->refused ? rate->wanted_hz : rate->hz;
        rate->refused = false;
    }
}

/* 0: there is none. */
static double lower_hz(double hz) {
    for (size_t i = 0; i < STEPS; i++) {
        if (ladder_hz[i] < hz) {
            return ladder_hz[i];
        }
    }
    return 0.0;
}

static void go_on(message_rates_t *rates) {
    rates->next++;
    rates->tries = 0;
    rates->awaiting = false;
}

void message_rates_ask(message_rates_t *rates, wire_t *wire, uint8_t system, int64_t now_us) {
    mavlink_message_t message;
    if (rates->awaiting && now_us - rates->question_us < ANSWER_US) {
        return;
    }
    if (rates->tries >= TRIES_MAX) {
        go_on(rates);
    }
    if (message_rates_done(rates)) {
        return;
    }
    const message_rate_t *rate = &rates->rate[rates->next];
    rates->awaiting = true;
    rates->tries++;
    rates->question_us = now_us;
    (void)mavlink_msg_command_long_pack(wire->system, wire->component, &message, system, MAV_COMP_ID_AUTOPILOT1,
                                        MAV_CMD_SET_MESSAGE_INTERVAL, 0, (float)rate->message,
                                        (float)(US_PER_S / rate->hz), 0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
    wire_send(wire, &message);
}

static void accept(message_rates_t *rates) {
    message_rate_t *rate = &rates->rate[rates->next];
    if (rate->hz < rate->wanted_hz && !(fabs(rate->hz - rate->reported_hz) < HZ_SAME)) {
        event("%s at %.0f Hz is refused: %.0f Hz", rate->name, rate->wanted_hz, rate->hz);
        rate->reported_hz = rate->hz;
    }
    go_on(rates);
}

static void refuse(message_rates_t *rates) {
    message_rate_t *rate = &rates->rate[rates->next];
    const double hz = lower_hz(rate->hz);
    rates->awaiting = false;
    rates->tries = 0;
    if (hz > 0.0) {
        rate->hz = hz;
        return;
    }
    rate->refused = true;
    if (!rate->refusal_reported) {
        event("the autopilot does not send %s", rate->name);
    }
    rate->refusal_reported = true;
    go_on(rates);
}

void message_rates_answer(message_rates_t *rates, uint8_t result) {
    if (!rates->awaiting || message_rates_done(rates)) {
        return;
    }
    switch (result) {
        case MAV_RESULT_ACCEPTED:
            accept(rates);
            break;
        case MAV_RESULT_IN_PROGRESS: /* it is requested again after ANSWER_US */
            break;
        default: /* whatever it says of a rate that is beyond it: versions differ */
            refuse(rates);
            break;
    }
}
