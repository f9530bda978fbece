/* What the estimating thread of the ports' samples does. SPDX-License-Identifier: MIT */
#include "scripted_estimator.h"

#include <stdio.h>
#include <string.h>

#define LINE_TICKS 50u /* a line a second */

bool scripted_message(uint32_t tick, scripted_kind_t kind, scripted_message_t *message) {
    message->kind = kind;
    message->tick = tick;
    switch (kind) {
        case SCRIPTED_POSE:
            scripted_pose(tick, &message->of.pose);
            return true;
        case SCRIPTED_IMAGE:
            return scripted_image(tick, &message->of.image);
        case SCRIPTED_TIMER:
            return tick % SCRIPTED_ASSESS_TICKS == 0u;
        case SCRIPTED_END:
            break;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------------- calls -- */

static void add_cost(scripted_cost_t *cost, uint32_t duration) {
    cost->calls++;
    cost->sum += duration;
    cost->most = duration > cost->most ? duration : cost->most;
}

/* The image that came last. Too new for the poses so far: it is kept, and offered again after the next one. */
static void take_image(scripted_estimator_t *estimator) {
    const uint32_t begun = estimator->clock();
    estimator->image.frame.detection = &estimator->image.detection;
    const goe_flight_status_t status = goe_flight_frame(&estimator->flight, &estimator->image.frame);
    estimator->image_waits = status == GOE_FLIGHT_TOO_NEW;
    if (status == GOE_FLIGHT_OK) {
        add_cost(&estimator->frame, estimator->clock() - begun);
    } else if (!estimator->image_waits) {
        estimator->dropped++;
    }
}

static void take_pose(scripted_estimator_t *estimator, const scripted_pose_t *pose) {
    (void)goe_flight_attitude(&estimator->flight, &pose->attitude);
    (void)goe_flight_position(&estimator->flight, &pose->position);
    if (estimator->image_waits) {
        take_image(estimator);
    }
}

static void assess(scripted_estimator_t *estimator, uint32_t now_us) {
    const uint32_t begun = estimator->clock();
    (void)goe_flight_assess(&estimator->flight, now_us, false, &estimator->assessment);
    add_cost(&estimator->assess, estimator->clock() - begun);
}

/* ------------------------------------------------------------------------------------------------------------- lines -- */

static bool report(scripted_estimator_t *estimator, uint32_t tick, char line[SCRIPTED_LINE]) {
    const goe_flight_assessment_t *found = &estimator->assessment;
    if (tick % LINE_TICKS != 0u && found->action == estimator->reported_action &&
        found->detector_alive == estimator->reported_alive) {
        return false;
    }
    estimator->reported_action = found->action;
    estimator->reported_alive = found->detector_alive;
    scripted_line(&estimator->flight, tick * SCRIPTED_TICK_US, found, line);
    return true;
}

void scripted_first_line(char line[SCRIPTED_LINE]) {
    (void)snprintf(line, SCRIPTED_LINE, "goe %d.%d.%d, self-check 0x%02x", GOE_VERSION_MAJOR, GOE_VERSION_MINOR,
                   GOE_VERSION_PATCH, goe_self_check());
}

/* ------------------------------------------------------------------------------------------------------------ public -- */

bool scripted_start(scripted_estimator_t *estimator, scripted_clock_t clock, char line[SCRIPTED_LINE]) {
    goe_settings_t settings;
    const char *bad_field = NULL;
    memset(estimator, 0, sizeof *estimator);
    estimator->clock = clock;
    scripted_settings(&settings);
    const goe_flight_status_t status =
        goe_flight_init(&estimator->flight, sizeof estimator->flight, &settings, NULL, &bad_field);
    if (status != GOE_FLIGHT_OK) {
        (void)snprintf(line, SCRIPTED_LINE, "goe: no start: status %d, setting %s", (int)status,
                       bad_field != NULL ? bad_field : "(none)");
    }
    return status == GOE_FLIGHT_OK;
}

bool scripted_take(scripted_estimator_t *estimator, const scripted_message_t *message, char line[SCRIPTED_LINE]) {
    switch (message->kind) {
        case SCRIPTED_POSE:
            take_pose(estimator, &message->of.pose);
            return false;
        case SCRIPTED_IMAGE:
            estimator->dropped += estimator->image_waits ? 1u : 0u;
            estimator->image = message->of.image;
            take_image(estimator);
            return false;
        case SCRIPTED_TIMER:
            assess(estimator, message->tick * SCRIPTED_TICK_US);
            return report(estimator, message->tick, line);
        case SCRIPTED_END:
            break;
    }
    return false;
}

uint32_t scripted_mean(const scripted_cost_t *cost) { return cost->calls > 0u ? cost->sum / cost->calls : 0u; }
