/* The flight layer's decision as commands. SPDX-License-Identifier: MIT */
#include "orders.h"

#include <math.h>
#include <string.h>

#include "events.h"

#define US_PER_S 1000000
#define REPEAT_US 500000        /* without an acknowledgement */
#define TARGET_EVERY_US 1000000 /* a target that moves is sent at most that often ... */
#define TARGET_MOVED_M 5.0f     /* ... and only when it has moved by so much */
#define RESUMES_MAX 5           /* the mode before is asked for as often, until it is acknowledged */
#define BEATS_TO_LEAD 2u        /* heartbeats after the acknowledgement within which the mode follows */
#define BEATS_TO_RESUME 2u      /* heartbeats that may still show the mode of the order before */
#define M_PER_E7 0.0111195f     /* of 1e-7 degrees on a sphere of 6371 km */
#define RAD_PER_E7 1.7453293e-9f

/* PX4's custom mode: main mode in the third byte, sub mode in the fourth. */
#define PX4_MODE(main, sub) ((uint32_t)(main) << 16 | (uint32_t)(sub) << 24)
#define PX4_MAIN(mode) ((mode) >> 16 & 0xFFu)
#define PX4_SUB(mode) ((mode) >> 24 & 0xFFu)
#define PX4_AUTO_LOITER PX4_MODE(4, 3) /* where DO_REPOSITION leads to */

/* By the bits of reaction.modes. */
static const uint32_t px4_modes[] = {PX4_MODE(4, 4), PX4_AUTO_LOITER, PX4_MODE(6, 0), PX4_MODE(3, 0),
                                     PX4_MODE(2, 0), PX4_MODE(4, 5),  PX4_MODE(4, 6), PX4_MODE(4, 2)};
#define PX4_MODES (sizeof px4_modes / sizeof px4_modes[0])

void orders_init(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                 const goe_flight_t *flight) {
    (void)memset(orders, 0, sizeof *orders);
    orders->wire = wire;
    orders->config = config;
    orders->autopilot = autopilot;
    orders->flight = flight;
    orders->slot = -1;
}

static bool is_place(goe_flight_action_t action) {
    return action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT || action == GOE_FLIGHT_CLIMB ||
           action == GOE_FLIGHT_HOLD;
}

static void send_command(orders_t *orders, uint16_t command, float first, float second, float third, int64_t now_us) {
    mavlink_message_t message;
    orders->command = command;
    orders->sent_us = now_us;
    (void)mavlink_msg_command_long_pack(orders->wire->system, orders->wire->component, &message,
                                        orders->autopilot->system, MAV_COMP_ID_AUTOPILOT1, command, 0, first, second,
                                        third, 0.0f, 0.0f, 0.0f, 0.0f);
    wire_send(orders->wire, &message);
}

static bool is_unanswered(const orders_t *orders, uint16_t command, int64_t now_us) {
    return orders->command == command && now_us - orders->sent_us >= REPEAT_US;
}

static void silence(orders_t *orders) {
    orders->silenced = true;
    orders->command = 0;
}

/* ----------------------------------------------------------------------------------------------------- who may be led -- */

static bool suits_kind(const orders_t *orders) {
    const bool is_px4 = orders->autopilot->kind == MAV_AUTOPILOT_PX4;
    const bool is_ardupilot = orders->autopilot->kind == MAV_AUTOPILOT_ARDUPILOTMEGA;
    return orders->config->reaction_mode == REACTION_PX4 ? is_px4 : is_ardupilot;
}

/* A go-around is for a landing: there it is asked for in every mode. */
static bool is_mode_allowed(const orders_t *orders, uint32_t mode, goe_flight_action_t action) {
    if (orders->config->reaction_mode != REACTION_PX4 || action == GOE_FLIGHT_GO_AROUND) {
        return true;
    }
    for (unsigned i = 0; i < PX4_MODES; i++) {
        if (px4_modes[i] == mode) {
            return (orders->config->reaction_modes >> i & 1u) != 0;
        }
    }
    return false;
}

/* Why nothing is sent for a new order; null: it is. */
static const char *why_not(const orders_t *orders, goe_flight_action_t action) {
    if (!suits_kind(orders)) {
        return "reaction.mode is for another kind of autopilot";
    }
    if ((orders->autopilot->base_mode & MAV_MODE_FLAG_SAFETY_ARMED) == 0) {
        return "it is not armed";
    }
    if (!is_mode_allowed(orders, orders->mode_before, action)) {
        return "it is in a mode that reaction.modes does not name";
    }
    if (action != GOE_FLIGHT_GO_AROUND && !orders->autopilot->origin_given) {
        return "the origin of its local frame is not known";
    }
    return NULL;
}

/* --------------------------------------------------------------------------------------------------------------- px4 -- */

static void reposition(orders_t *orders, const goe_flight_assessment_t *assessment, int64_t now_us) {
    mavlink_message_t message;
    orders->command = MAV_CMD_DO_REPOSITION;
    orders->sent_us = now_us;
    orders->target_lat_e7 = assessment->target_lat_e7;
    orders->target_lon_e7 = assessment->target_lon_e7;
    orders->target_alt_m = orders->autopilot->origin_alt_m - assessment->target_ned_m[2];
    (void)mavlink_msg_command_int_pack(orders->wire->system, orders->wire->component, &message,
                                       orders->autopilot->system, MAV_COMP_ID_AUTOPILOT1, MAV_FRAME_GLOBAL_INT,
                                       MAV_CMD_DO_REPOSITION, 0, 0, -1.0f, MAV_DO_REPOSITION_FLAGS_CHANGE_MODE, 0.0f,
                                       NAN, orders->target_lat_e7, orders->target_lon_e7, orders->target_alt_m);
    wire_send(orders->wire, &message);
}

static bool has_moved(const orders_t *orders, const goe_flight_assessment_t *assessment, int64_t now_us) {
    const float north_m = (float)((int64_t)assessment->target_lat_e7 - orders->target_lat_e7) * M_PER_E7;
    const float east_m = (float)((int64_t)assessment->target_lon_e7 - orders->target_lon_e7) * M_PER_E7 *
                         cosf((float)assessment->target_lat_e7 * RAD_PER_E7);
    const float up_m = orders->autopilot->origin_alt_m - assessment->target_ned_m[2] - orders->target_alt_m;
    return now_us - orders->sent_us >= TARGET_EVERY_US && hypotf(hypotf(north_m, east_m), up_m) > TARGET_MOVED_M;
}

/* A pilot, or a failsafe, that chose another mode than the order leads to is not fought. By heartbeats: those that came after the
 * acknowledgement show where the order has led, earlier ones may still show the mode before. */
static void watch_mode(orders_t *orders) {
    const autopilot_t *autopilot = orders->autopilot;
    const uint32_t mode = autopilot->custom_mode;
    if (orders->judged_at == autopilot->heartbeats) {
        return;
    }
    orders->judged_at = autopilot->heartbeats;
    const bool may_be_old = orders->command != 0 || autopilot->heartbeats - orders->answered_at <= BEATS_TO_LEAD;
    if (mode != PX4_AUTO_LOITER && !(may_be_old && mode == orders->mode_before)) {
        orders->overruled = true;
        silence(orders);
        event("another mode was chosen: the order is left to whoever did");
    }
}

static void follow_px4(orders_t *orders, const goe_flight_assessment_t *assessment, bool is_new, int64_t now_us) {
    if (assessment->action == GOE_FLIGHT_GO_AROUND) {
        if (is_new || is_unanswered(orders, MAV_CMD_DO_GO_AROUND, now_us)) {
            send_command(orders, MAV_CMD_DO_GO_AROUND, 0.0f, 0.0f, 0.0f, now_us);
        }
        return;
    }
    watch_mode(orders);
    if (!orders->silenced && is_place(assessment->action) &&
        (is_new || is_unanswered(orders, MAV_CMD_DO_REPOSITION, now_us) || has_moved(orders, assessment, now_us))) {
        reposition(orders, assessment, now_us);
    }
}

static void ask_for_mode_before(orders_t *orders, int64_t now_us) {
    orders->resumes_left--;
    orders->resumed_at = orders->autopilot->heartbeats;
    send_command(orders, MAV_CMD_DO_SET_MODE, (float)MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
                 (float)PX4_MAIN(orders->mode_before), (float)PX4_SUB(orders->mode_before), now_us);
}

/* The flight layer ends an order when its obstacle lies behind or the course back is clear, and then still knows where it is; or when it
 * gives the obstacle up, or its track ends, as by a reset of the heading. */
static bool is_obstacle_known(const orders_t *orders) {
    goe_flight_obstacle_t obstacle;
    return orders->slot >= 0 && goe_flight_obstacle(orders->flight, orders->slot, &obstacle) == GOE_FLIGHT_OK &&
           (obstacle.valid & GOE_HAS_POSITION) != 0u;
}

/* Back into the mode before, once the obstacle lies behind. What is only lost from sight may lie ahead there. */
static void resume(orders_t *orders, goe_flight_action_t ended, int64_t now_us) {
    const bool is_past = is_obstacle_known(orders) &&
                         (ended == GOE_FLIGHT_LEFT || ended == GOE_FLIGHT_RIGHT || ended == GOE_FLIGHT_CLIMB);
    orders->resumes_left = 0;
    if (orders->config->reaction_resume == 0 || orders->silenced || orders->mode_before == PX4_AUTO_LOITER ||
        orders->autopilot->custom_mode != PX4_AUTO_LOITER) {
        return;
    }
    if (!is_past) {
        event("the obstacle is not known to be passed: the autopilot stays where it loiters");
        return;
    }
    orders->resumes_left = RESUMES_MAX;
    ask_for_mode_before(orders, now_us);
}

static void go_on_resuming(orders_t *orders, int64_t now_us) {
    if (orders->resumes_left > 0 && is_unanswered(orders, MAV_CMD_DO_SET_MODE, now_us) &&
        orders->autopilot->custom_mode == PX4_AUTO_LOITER) {
        ask_for_mode_before(orders, now_us);
    }
}

/* --------------------------------------------------------------------------------------------------------- arduplane -- */

/* The obstacle that the order is about; if that was given up, the worst. */
static void send_traffic(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                         int64_t now_us) {
    goe_flight_obstacle_t obstacle;
    goe_mavlink_adsb_vehicle_t traffic;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    const int slot = assessment->avoided >= 0 ? assessment->avoided : assessment->worst;
    if ((double)(now_us - orders->sent_us) < US_PER_S / orders->config->reaction_adsb_hz || slot < 0 ||
        goe_flight_obstacle(orders->flight, slot, &obstacle) != GOE_FLIGHT_OK ||
        !goe_mavlink_to_adsb_vehicle(&obstacle, slot, orders->config->reaction_icao, own, &traffic)) {
        return;
    }
    orders->sent_us = now_us;
    wire_send_payload(orders->wire, GOE_MAVLINK_ADSB_VEHICLE, payload,
                      goe_mavlink_pack_adsb_vehicle(&traffic, payload));
}

static void follow_arduplane(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                             bool is_new, int64_t now_us) {
    if (assessment->action != GOE_FLIGHT_GO_AROUND) {
        send_traffic(orders, assessment, own, now_us);
    } else if (is_new || is_unanswered(orders, MAV_CMD_DO_GO_AROUND, now_us)) {
        send_command(orders, MAV_CMD_DO_GO_AROUND, 0.0f, 0.0f, 0.0f, now_us);
    }
}

/* --------------------------------------------------------------------------------------------------------- interface -- */

/* The mode before is the one of the latest heartbeat, unless that may still be of the order that has just ended. */
static void begin(orders_t *orders, const goe_flight_assessment_t *assessment) {
    const unsigned beats = orders->autopilot->heartbeats;
    const bool may_be_old = orders->resumed_at != 0 && beats - orders->resumed_at < BEATS_TO_RESUME;
    if (orders->action == GOE_FLIGHT_NONE) {
        orders->mode_before = may_be_old ? orders->mode_before : orders->autopilot->custom_mode;
        orders->overruled = false;
        orders->judged_at = orders->answered_at = beats;
    }
    orders->silenced = orders->overruled; /* a side that the mode forbids says nothing of a go-around */
    orders->resumes_left = 0;
    orders->orders++;
    event("order: %s; on this course %.0f m beside it in %.1f s%s", goe_flight_action_text(assessment->action),
          (double)assessment->hazard.miss_m, (double)assessment->hazard.time_s, assessment->late ? ", late" : "");
    const char *why = orders->silenced ? NULL : why_not(orders, assessment->action);
    if (why != NULL) {
        silence(orders);
        event("the order is not sent to the autopilot: %s", why);
    }
}

static void end(orders_t *orders, int64_t now_us) {
    const goe_flight_action_t ended = orders->action;
    event("the order ends");
    orders->command = 0;
    if (orders->config->reaction_mode == REACTION_PX4) {
        resume(orders, ended, now_us);
    }
    orders->slot = -1;
}

/* An autopilot that has started anew knows of no order. */
static void forget_after_restart(orders_t *orders) {
    if (orders->restarts_seen != orders->autopilot->restarts) {
        orders->restarts_seen = orders->autopilot->restarts;
        orders->action = GOE_FLIGHT_NONE;
        orders->command = 0;
        orders->resumes_left = 0;
        orders->slot = -1;
    }
}

void orders_follow(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us) {
    if (orders->config->reaction_mode == REACTION_OFF) {
        return;
    }
    forget_after_restart(orders);
    const bool is_new = assessment->action != orders->action;
    orders->slot = assessment->avoided >= 0 ? assessment->avoided : orders->slot;
    if (is_new && assessment->action == GOE_FLIGHT_NONE) {
        end(orders, now_us);
    } else if (is_new) {
        begin(orders, assessment);
    }
    orders->action = assessment->action;
    if (assessment->action == GOE_FLIGHT_NONE) {
        go_on_resuming(orders, now_us);
    } else if (!orders->silenced && orders->config->reaction_mode == REACTION_PX4) {
        follow_px4(orders, assessment, is_new, now_us);
    } else if (!orders->silenced) {
        follow_arduplane(orders, assessment, own, is_new, now_us);
    }
}

void orders_take(orders_t *orders, const mavlink_message_t *message) {
    mavlink_command_ack_t answer;
    if (message->msgid != MAVLINK_MSG_ID_COMMAND_ACK || message->sysid != orders->autopilot->system ||
        orders->command == 0) {
        return;
    }
    mavlink_msg_command_ack_decode(message, &answer);
    if (answer.command != orders->command || !wire_is_for_us(orders->wire, &answer)) {
        return;
    }
    if (answer.result == MAV_RESULT_ACCEPTED || answer.result == MAV_RESULT_IN_PROGRESS) {
        orders->command = 0;
        orders->answered_at = orders->autopilot->heartbeats;
        return;
    }
    orders->refused++;
    event("the autopilot refuses the order (result %u)", answer.result);
    if (answer.result == MAV_RESULT_DENIED || answer.result == MAV_RESULT_UNSUPPORTED) {
        silence(orders); /* it will not think better of it; others may be tried again */
    }
}
