/* The flight layer's decision as commands. SPDX-License-Identifier: MIT */
#include "orders.h"

#include <math.h>

#include "events.h"

#define US_PER_S 1000000
#define REPEAT_US 500000    /* without an acknowledgement */
#define RESUMES_MAX 5       /* the mode before is asked for as often, until it is acknowledged */
#define TARGET_MOVED_M 5.0f /* from which on it is sent anew */
#define M_PER_E7 0.0111195f /* of 1e-7 degrees on a sphere of 6371 km */

/* PX4's custom mode: main mode in the third byte, sub mode in the fourth. */
#define PX4_MAIN(mode) ((mode) >> 16 & 0xFFu)
#define PX4_SUB(mode) ((mode) >> 24 & 0xFFu)
#define PX4_AUTO_LOITER (4u << 16 | 3u << 24) /* where DO_REPOSITION leads to */

static bool is_place(goe_flight_action_t action) {
    return action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT || action == GOE_FLIGHT_CLIMB ||
           action == GOE_FLIGHT_HOLD;
}

static void go_around(orders_t *orders, wire_t *wire, const autopilot_t *autopilot, int64_t now_us) {
    mavlink_message_t message;
    orders->command = MAV_CMD_DO_GO_AROUND;
    orders->sent_us = now_us;
    (void)mavlink_msg_command_long_pack(wire->system, wire->component, &message, autopilot->system,
                                        MAV_COMP_ID_AUTOPILOT1, MAV_CMD_DO_GO_AROUND, 0, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                        0.0f, 0.0f);
    wire_send(wire, &message);
}

/* --------------------------------------------------------------------------------------------------------------- px4 -- */

static void reposition(orders_t *orders, wire_t *wire, const autopilot_t *autopilot,
                       const goe_flight_assessment_t *assessment, int64_t now_us) {
    mavlink_message_t message;
    orders->command = MAV_CMD_DO_REPOSITION;
    orders->sent_us = now_us;
    orders->target_lat_e7 = assessment->target_lat_e7;
    orders->target_lon_e7 = assessment->target_lon_e7;
    orders->target_alt_m = autopilot->origin_alt_m - assessment->target_ned_m[2];
    (void)mavlink_msg_command_int_pack(wire->system, wire->component, &message, autopilot->system,
                                       MAV_COMP_ID_AUTOPILOT1, MAV_FRAME_GLOBAL, MAV_CMD_DO_REPOSITION, 0, 0, -1.0f,
                                       MAV_DO_REPOSITION_FLAGS_CHANGE_MODE, 0.0f, NAN, orders->target_lat_e7,
                                       orders->target_lon_e7, orders->target_alt_m);
    wire_send(wire, &message);
}

static bool has_moved(const orders_t *orders, const autopilot_t *autopilot, const goe_flight_assessment_t *assessment) {
    const float north_m = (float)((int64_t)assessment->target_lat_e7 - orders->target_lat_e7) * M_PER_E7;
    const float east_m = (float)((int64_t)assessment->target_lon_e7 - orders->target_lon_e7) * M_PER_E7 *
                         cosf((float)assessment->target_lat_e7 * 1.7453293e-9f);
    const float up_m = autopilot->origin_alt_m - assessment->target_ned_m[2] - orders->target_alt_m;
    return hypotf(hypotf(north_m, east_m), up_m) > TARGET_MOVED_M;
}

/* A pilot, or a failsafe, that chose another mode than the order led to is not fought. */
static void watch_mode(orders_t *orders, const autopilot_t *autopilot) {
    if (autopilot->custom_mode == PX4_AUTO_LOITER) {
        orders->has_led = true;
    } else if ((orders->has_led || autopilot->custom_mode != orders->mode_before) && !orders->overruled) {
        orders->overruled = true;
        event("another mode was chosen: the order is left to whoever did");
    }
}

/* Back into the mode before. */
static bool may_resume(const orders_t *orders, const companion_config_t *config, const autopilot_t *autopilot) {
    return config->reaction_resume != 0 && orders->has_led && !orders->overruled &&
           autopilot->custom_mode == PX4_AUTO_LOITER && orders->mode_before != PX4_AUTO_LOITER;
}

static void resume(orders_t *orders, wire_t *wire, const autopilot_t *autopilot, int64_t now_us) {
    mavlink_message_t message;
    orders->command = MAV_CMD_DO_SET_MODE;
    orders->sent_us = now_us;
    orders->resumes_left--;
    (void)mavlink_msg_command_long_pack(wire->system, wire->component, &message, autopilot->system,
                                        MAV_COMP_ID_AUTOPILOT1, MAV_CMD_DO_SET_MODE, 0,
                                        (float)MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, (float)PX4_MAIN(orders->mode_before),
                                        (float)PX4_SUB(orders->mode_before), 0.0f, 0.0f, 0.0f, 0.0f);
    wire_send(wire, &message);
}

static void go_on_resuming(orders_t *orders, wire_t *wire, const companion_config_t *config,
                           const autopilot_t *autopilot, int64_t now_us) {
    if (orders->resumes_left > 0 && orders->command == MAV_CMD_DO_SET_MODE && now_us - orders->sent_us >= REPEAT_US &&
        may_resume(orders, config, autopilot)) {
        resume(orders, wire, autopilot, now_us);
    }
}

static void follow_px4(orders_t *orders, wire_t *wire, const autopilot_t *autopilot,
                       const goe_flight_assessment_t *assessment, bool is_new, int64_t now_us) {
    const bool unanswered = orders->command != 0 && now_us - orders->sent_us >= REPEAT_US;
    watch_mode(orders, autopilot);
    if (orders->overruled) {
        return;
    }
    if (assessment->action == GOE_FLIGHT_GO_AROUND) {
        if (is_new || unanswered) {
            go_around(orders, wire, autopilot, now_us);
        }
    } else if (autopilot->has_origin && is_place(assessment->action) &&
               (is_new || unanswered || has_moved(orders, autopilot, assessment))) {
        reposition(orders, wire, autopilot, assessment, now_us);
    }
}

/* --------------------------------------------------------------------------------------------------------- arduplane -- */

/* The obstacle that the order is about; if that was given up, the worst. */
static void send_traffic(orders_t *orders, wire_t *wire, const companion_config_t *config, const goe_flight_t *flight,
                         const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own, int64_t now_us) {
    goe_flight_obstacle_t obstacle;
    goe_mavlink_adsb_vehicle_t traffic;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    const int slot = assessment->avoided >= 0 ? assessment->avoided : assessment->worst;
    if ((double)(now_us - orders->sent_us) < US_PER_S / config->reaction_adsb_hz || slot < 0 ||
        goe_flight_obstacle(flight, slot, &obstacle) != GOE_FLIGHT_OK ||
        !goe_mavlink_to_adsb_vehicle(&obstacle, slot, config->reaction_icao, own, &traffic)) {
        return;
    }
    orders->sent_us = now_us;
    wire_send_payload(wire, GOE_MAVLINK_ADSB_VEHICLE, payload, goe_mavlink_pack_adsb_vehicle(&traffic, payload));
}

/* --------------------------------------------------------------------------------------------------------- interface -- */

static void begin(orders_t *orders, const autopilot_t *autopilot, const goe_flight_assessment_t *assessment) {
    if (orders->action == GOE_FLIGHT_NONE) {
        orders->mode_before = autopilot->custom_mode;
        orders->has_led = orders->overruled = false;
    }
    orders->orders++;
    event("order: %s; on this course %.0f m beside it in %.1f s%s", goe_flight_action_text(assessment->action),
          (double)assessment->hazard.miss_m, (double)assessment->hazard.time_s, assessment->late ? ", late" : "");
}

void orders_follow(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                   const goe_flight_t *flight, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us) {
    const bool is_new = assessment->action != orders->action;
    if (config->reaction_mode == REACTION_OFF) {
        return;
    }
    if (is_new && assessment->action == GOE_FLIGHT_NONE) {
        event("the order is taken back");
        orders->command = 0;
        orders->resumes_left = RESUMES_MAX;
        if (config->reaction_mode == REACTION_PX4 && may_resume(orders, config, autopilot)) {
            resume(orders, wire, autopilot, now_us);
        }
    } else if (is_new) {
        begin(orders, autopilot, assessment);
    }
    orders->action = assessment->action;
    if (assessment->action == GOE_FLIGHT_NONE) {
        go_on_resuming(orders, wire, config, autopilot, now_us);
        return;
    }
    if (config->reaction_mode == REACTION_PX4) {
        follow_px4(orders, wire, autopilot, assessment, is_new, now_us);
    } else if (assessment->action == GOE_FLIGHT_GO_AROUND) {
        if (is_new || (orders->command != 0 && now_us - orders->sent_us >= REPEAT_US)) {
            go_around(orders, wire, autopilot, now_us);
        }
    } else {
        send_traffic(orders, wire, config, flight, assessment, own, now_us);
    }
}

void orders_take(orders_t *orders, const mavlink_message_t *message, const autopilot_t *autopilot) {
    mavlink_command_ack_t answer;
    if (message->msgid != MAVLINK_MSG_ID_COMMAND_ACK || message->sysid != autopilot->system || orders->command == 0) {
        return;
    }
    mavlink_msg_command_ack_decode(message, &answer);
    if (answer.command != orders->command) {
        return;
    }
    if (answer.result == MAV_RESULT_ACCEPTED || answer.result == MAV_RESULT_IN_PROGRESS) {
        orders->command = 0;
    } else {
        orders->refused++;
        event("the autopilot refuses the order (result %u)", answer.result);
    }
}
