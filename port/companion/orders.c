/* The flight layer's decision as commands. SPDX-License-Identifier: MIT */
#include "orders.h"

#include <math.h>
#include <string.h>

#include "events.h"

#define US_PER_S 1000000
#define REPEAT_US 500000        /* without an acknowledgement */
#define TARGET_EVERY_US 1000000 /* a target that moves is sent at most that often ... */
#define TARGET_MOVED_M 5.0f     /* ... and only when it has moved by so much */
#define RESUMES_MAX 5           /* requests for the previous mode, until acknowledged */
#define BEATS_TO_RESUME 2u      /* heartbeats that may still show the mode of the order before */
#define BEATS_TO_HOLD 2u        /* heartbeats after the end of an order within which Hold may still show */
#define SURE_SIGMA 2.0f         /* of a top */
#define LEFT_OFF_US 2000000     /* by which both clocks may disagree on the time since an order that was left */
#define LEFT_OLD_US 120000000   /* an order that was left longer ago is forgotten */

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

/* Whether the aircraft is where the order, or one of before a restart, has led it, and may go back by itself. Of an order that was never
 * sent or that the autopilot denied, Hold is a pilot's choice. */
static bool is_led(const orders_t *orders) {
    const bool is_obeyed = orders->left.active || (orders->sent && !orders->denied);
    return is_obeyed && !orders->overruled && !orders->gave_up && !orders->from_landing && !orders->had_failsafe;
}

/* A row of the log. */
static void put_log(orders_t *orders, const char *what, const char *why) {
    const goe_flight_assessment_t *a = &orders->assessment;
    goe_flight_obstacle_t obstacle;
    (void)goe_flight_obstacle(orders->flight, orders->slot, &obstacle);
    order_row_t row = {
        .event = what,
        .left = orders->active,
        .mode = orders->autopilot->custom_mode,
        .obstacle_id = obstacle.id,
        .slot = orders->slot,
        .tcpa_s = a->hazard.tcpa_s,
        .dcpa_m = a->hazard.dcpa_m,
        .target_lat_e7 = a->target_lat_e7,
        .target_lon_e7 = a->target_lon_e7,
        .target_alt_m = orders->autopilot->origin_alt_m - a->target_ned_m[2],
        .why = why,
    };
    row.left.unix_us = orders->unix_us;
    row.left.boot_us = orders->boot_us;
    row.left.action = (unsigned)orders->action;
    row.left.mode_before = orders->watch.mode_before;
    row.left.active = orders->active.active && is_led(orders);
    order_log_put(orders->log, &row);
}

static bool is_place(goe_flight_action_t action) {
    return action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT || action == GOE_FLIGHT_CLIMB ||
           action == GOE_FLIGHT_HOLD;
}

static void send_command(orders_t *orders, uint16_t command, float first, float second, float third, int64_t now_us) {
    mavlink_message_t message;
    orders->command = command;
    orders->sent_us = now_us;
    orders->sent = true;
    (void)mavlink_msg_command_long_pack(orders->wire->system, orders->wire->component, &message,
                                        orders->autopilot->system, MAV_COMP_ID_AUTOPILOT1, command, 0, first, second,
                                        third, 0.0f, 0.0f, 0.0f, 0.0f);
    wire_send(orders->wire, &message);
}

static bool is_unanswered(const orders_t *orders, uint16_t command, int64_t now_us) {
    return orders->command == command && now_us - orders->sent_us >= REPEAT_US;
}

/* ----------------------------------------------------------------------------------------------------- who may be led -- */

static bool suits_kind(const orders_t *orders) {
    const bool is_px4 = orders->autopilot->kind == MAV_AUTOPILOT_PX4;
    const bool is_ardupilot = orders->autopilot->kind == MAV_AUTOPILOT_ARDUPILOTMEGA;
    return orders->config->reaction_mode == REACTION_PX4 ? is_px4 : is_ardupilot;
}

/* A go-around is for a landing: there it is requested in every mode. */
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

/* PX4 waits in Hold before it flies a failsafe, and a command may cancel that. In Mission a failsafe is only a warning: PX4 1.14 reports
 * that, too. ArduPlane reports its own avoidance of traffic as critical. */
static bool in_failsafe(const orders_t *orders) {
    const uint8_t status = orders->autopilot->system_status;
    const bool warns = status == MAV_STATE_CRITICAL && orders->autopilot->custom_mode == px4_modes[0];
    return orders->config->reaction_mode == REACTION_PX4 && status >= MAV_STATE_CRITICAL && !warns;
}

/* Why nothing can be sent now; null: it can. Once an order has led to its mode, that in which it was given counts. */
static const char *find_hindrance(const orders_t *orders, goe_flight_action_t action) {
    const uint32_t mode = orders->sent ? orders->watch.mode_before : orders->autopilot->custom_mode;
    if (!suits_kind(orders)) {
        return "reaction.mode is for others";
    }
    if ((orders->autopilot->base_mode & MAV_MODE_FLAG_SAFETY_ARMED) == 0) {
        return "not armed";
    }
    if (orders->autopilot->on_ground) {
        return "on the ground";
    }
    if (in_failsafe(orders)) {
        return "failsafe";
    }
    if (!is_mode_allowed(orders, mode, action)) {
        return "mode is not in reaction.modes";
    }
    if (action != GOE_FLIGHT_GO_AROUND && !orders->autopilot->origin_given) {
        return "no origin of its frame";
    }
    return NULL;
}

/* While the autopilot lands, a side that is hindered becomes a go-around: the landing leads into the obstacle. */
static goe_flight_action_t find_flown(const orders_t *orders, goe_flight_action_t action) {
    const bool is_up = orders->autopilot->landing && is_place(action) && find_hindrance(orders, action) != NULL &&
                       find_hindrance(orders, GOE_FLIGHT_GO_AROUND) == NULL;
    return is_up ? GOE_FLIGHT_GO_AROUND : action;
}

/* --------------------------------------------------------------------------------------------------------------- px4 -- */

/* PX4 flies DO_GO_AROUND only while it lands. After a side it holds: there the target rises, and its place, which the flight layer found
 * clear, stays. */
static bool is_raised(const orders_t *orders) {
    return orders->flown == GOE_FLIGHT_GO_AROUND && orders->placed && orders->autopilot->custom_mode == PX4_AUTO_LOITER;
}

static void reposition(orders_t *orders, const goe_flight_assessment_t *assessment, int64_t now_us) {
    mavlink_message_t message;
    orders->command = MAV_CMD_DO_REPOSITION;
    orders->sent_us = now_us;
    orders->sent = orders->placed = true;
    if (orders->flown != GOE_FLIGHT_GO_AROUND) {
        orders->target_lat_e7 = assessment->target_lat_e7;
        orders->target_lon_e7 = assessment->target_lon_e7;
    }
    orders->target_alt_m = orders->autopilot->origin_alt_m - assessment->target_ned_m[2];
    (void)mavlink_msg_command_int_pack(orders->wire->system, orders->wire->component, &message,
                                       orders->autopilot->system, MAV_COMP_ID_AUTOPILOT1, MAV_FRAME_GLOBAL_INT,
                                       MAV_CMD_DO_REPOSITION, 0, 0, -1.0f, MAV_DO_REPOSITION_FLAGS_CHANGE_MODE, 0.0f,
                                       NAN, orders->target_lat_e7, orders->target_lon_e7, orders->target_alt_m);
    wire_send(orders->wire, &message);
    put_log(orders, "reposition", "");
}

static bool has_moved(const orders_t *orders, const goe_flight_assessment_t *assessment, int64_t now_us) {
    const float aside_m = orders->flown == GOE_FLIGHT_GO_AROUND
                              ? 0.0f
                              : mode_watch_apart_m(assessment->target_lat_e7, assessment->target_lon_e7,
                                                   orders->target_lat_e7, orders->target_lon_e7);
    const float up_m = orders->autopilot->origin_alt_m - assessment->target_ned_m[2] - orders->target_alt_m;
    return now_us - orders->sent_us >= TARGET_EVERY_US && hypotf(aside_m, up_m) > TARGET_MOVED_M;
}

/* Over home, with the clearance: where the flight layer aims; the target of a side only keeps the present height, there the top at
 * two sigma counts. 0: no top is known, the autopilot's own height counts. */
static float go_around_height_m(const orders_t *orders, const goe_flight_assessment_t *assessment) {
    goe_flight_obstacle_t obstacle;
    const bool has_top = goe_flight_obstacle(orders->flight, orders->slot, &obstacle) == GOE_FLIGHT_OK &&
                         (obstacle.valid & GOE_HAS_HEIGHT) != 0u;
    const float over_top_m = orders->config->flight.clearance_m + SURE_SIGMA * obstacle.height_sd_m;
    const float down_m = assessment->action == GOE_FLIGHT_GO_AROUND
                             ? assessment->target_ned_m[2]
                             : obstacle.center_ned_m[2] - obstacle.height_m - over_top_m;
    const float height_m = orders->autopilot->home_down_m - down_m;
    return has_top && orders->autopilot->has_home && height_m > 0.0f ? height_m : 0.0f;
}

static void go_around(orders_t *orders, const goe_flight_assessment_t *assessment, bool at_once, int64_t now_us) {
    if (at_once || is_unanswered(orders, MAV_CMD_DO_GO_AROUND, now_us)) {
        send_command(orders, MAV_CMD_DO_GO_AROUND, go_around_height_m(orders, assessment), 0.0f, 0.0f, now_us);
        put_log(orders, "go around", "");
    }
}

static void follow_px4(orders_t *orders, const goe_flight_assessment_t *assessment, bool at_once, int64_t now_us) {
    const bool is_placed = is_place(orders->flown) || is_raised(orders);
    if (!is_placed) {
        go_around(orders, assessment, at_once, now_us);
    } else if (at_once || is_unanswered(orders, MAV_CMD_DO_REPOSITION, now_us) ||
               has_moved(orders, assessment, now_us)) {
        reposition(orders, assessment, now_us);
    }
}

static void ask_for_mode_before(orders_t *orders, int64_t now_us) {
    orders->resumes_left--;
    orders->resumed_at = orders->autopilot->heartbeats;
    send_command(orders, MAV_CMD_DO_SET_MODE, (float)MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
                 (float)PX4_MAIN(orders->watch.mode_before), (float)PX4_SUB(orders->watch.mode_before), now_us);
}

/* The flight layer ends an order when its obstacle lies behind or the course back is clear, and then still knows where it is; or when it
 * gives the obstacle up, or its track ends, as by a reset of the heading. */
static bool is_known(const orders_t *orders, int slot, goe_flight_obstacle_t *obstacle) {
    return goe_flight_obstacle(orders->flight, slot, obstacle) == GOE_FLIGHT_OK &&
           (obstacle->valid & GOE_HAS_POSITION) != 0u;
}

/* Along a course, by the outline and the margin. */
static bool is_behind(const orders_t *orders, const float course_ne[2], const float obstacle_ne_m[2], float radius_m) {
    const mavlink_local_position_ned_t *own = &orders->autopilot->position;
    const float ahead_m = (obstacle_ne_m[0] - own->x) * course_ne[0] + (obstacle_ne_m[1] - own->y) * course_ne[1];
    return ahead_m < -(radius_m + orders->config->flight.margin_m);
}

/* Why the autopilot stays where it loiters; null: it need not. An obstacle that is only out of view may be ahead in the previous mode. A
 * landing would be continued from next to the runway. */
static const char *find_stay(const orders_t *orders, goe_flight_action_t ended) {
    goe_flight_obstacle_t obstacle;
    const bool is_past = is_known(orders, orders->slot, &obstacle) && !orders->gave_up &&
                         (ended == GOE_FLIGHT_LEFT || ended == GOE_FLIGHT_RIGHT || ended == GOE_FLIGHT_CLIMB);
    if (!is_past) {
        return "the obstacle is not known to be passed";
    }
    if (orders->from_landing) {
        return "a landing was broken off";
    }
    return orders->had_failsafe || in_failsafe(orders) ? "the autopilot had a failsafe" : NULL;
}

/* Back into the previous mode, once the obstacle is behind. */
static void resume(orders_t *orders, goe_flight_action_t ended, int64_t now_us) {
    const char *stay = find_stay(orders, ended);
    const uint32_t mode = orders->autopilot->custom_mode;
    const bool may_follow = orders->placed && !orders->watch.led && mode == orders->watch.mode_before;
    orders->resumes_left = 0;
    if (orders->config->reaction_resume == 0 || orders->silenced || orders->watch.mode_before == PX4_AUTO_LOITER ||
        (mode != PX4_AUTO_LOITER && !may_follow)) {
        return;
    }
    if (stay != NULL) {
        event("%s: the autopilot stays where it loiters", stay);
        return;
    }
    orders->resumes_left = RESUMES_MAX;
    orders->awaits_hold = may_follow;
    orders->awaited_at = orders->autopilot->heartbeats;
    if (!may_follow) {
        ask_for_mode_before(orders, now_us);
    }
}

/* Heartbeats come once a second: an order may end before one shows the Hold that it leads to. */
static void await_hold(orders_t *orders, int64_t now_us) {
    const uint32_t mode = orders->autopilot->custom_mode;
    const bool is_late = orders->autopilot->heartbeats - orders->awaited_at > BEATS_TO_HOLD;
    orders->resumed_at = orders->autopilot->heartbeats; /* Hold is not the mode before an order that comes with it */
    if (orders->resumes_left > 0 && mode == PX4_AUTO_LOITER) {
        orders->awaits_hold = false;
        ask_for_mode_before(orders, now_us);
    } else if (orders->resumes_left == 0 || mode != orders->watch.mode_before || is_late) {
        orders->awaits_hold = false;
        orders->resumes_left = 0;
        event("the order ended before Hold: the mode before is not requested");
    }
}

static void go_on_resuming(orders_t *orders, int64_t now_us) {
    orders->resumes_left = in_failsafe(orders) ? 0 : orders->resumes_left;
    if (orders->awaits_hold) {
        await_hold(orders, now_us);
    }
    if (orders->resumes_left > 0 && is_unanswered(orders, MAV_CMD_DO_SET_MODE, now_us) &&
        orders->autopilot->custom_mode == PX4_AUTO_LOITER) {
        ask_for_mode_before(orders, now_us);
    }
}

/* --------------------------------------------------------------------------------------------------------- arduplane -- */

static void send_one(orders_t *orders, int slot, const goe_mavlink_own_t *own) {
    goe_flight_obstacle_t obstacle;
    goe_mavlink_adsb_vehicle_t traffic;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    if (goe_flight_obstacle(orders->flight, slot, &obstacle) == GOE_FLIGHT_OK &&
        goe_mavlink_to_adsb_vehicle(&obstacle, slot, orders->config->reaction_icao, own, &traffic)) {
        wire_send_payload(orders->wire, GOE_MAVLINK_ADSB_VEHICLE, payload,
                          goe_mavlink_pack_adsb_vehicle(&traffic, payload));
    }
}

/* Every obstacle that is known: out of one's way the autopilot may turn into another's. */
static void send_traffic(orders_t *orders, const goe_mavlink_own_t *own, bool at_once, int64_t now_us) {
    if (!at_once && (double)(now_us - orders->traffic_us) < US_PER_S / orders->config->reaction_adsb_hz) {
        return;
    }
    orders->traffic_us = now_us;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        send_one(orders, slot, own);
    }
    if (!orders->has_traffic) {
        orders->sent = orders->has_traffic = true;
        put_log(orders, "traffic", "");
    }
}

/* While it lands ArduPlane takes no notice of traffic. */
static void break_off_landing(orders_t *orders, const goe_flight_assessment_t *assessment, int64_t now_us) {
    const bool is_landing = orders->autopilot->landing;
    if (is_landing) {
        go_around(orders, assessment, !orders->broke_off, now_us);
    }
    orders->broke_off = is_landing;
}

static void follow_arduplane(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                             bool at_once, int64_t now_us) {
    const bool is_up = orders->flown == GOE_FLIGHT_GO_AROUND;
    if (is_up) {
        go_around(orders, assessment, at_once, now_us);
    } else {
        break_off_landing(orders, assessment, now_us);
    }
    if (!is_up || orders->has_traffic) { /* when traffic ends, ArduPlane flies back towards the obstacle */
        send_traffic(orders, own, at_once, now_us);
    }
}

/* ---------------------------------------------------------------------------------------------------------- silence -- */

static void watch_pilot(orders_t *orders) {
    const bool leads = orders->flown != GOE_FLIGHT_GO_AROUND || orders->placed;
    const bool is_px4 = orders->config->reaction_mode == REACTION_PX4;
    if (orders->overruled || !orders->sent) {
        return;
    }
    const bool by_mode = mode_watch_is_overruled(&orders->watch, orders->autopilot, orders->config->reaction_mode,
                                                 orders->command != 0, leads);
    const bool by_target =
        is_px4 && leads && orders->command == 0 &&
        mode_watch_is_target_another(&orders->watch, orders->autopilot, orders->target_lat_e7, orders->target_lon_e7);
    if (by_mode || by_target) {
        orders->overruled = true;
        event("another %s was chosen: the order is left to whoever did", by_mode ? "mode" : "place");
        put_log(orders, "overruled", by_mode ? "mode" : "place");
        screen_show(orders->screen, SCREEN_SILENCE, MAV_SEVERITY_NOTICE, "GOE: order left to the pilot");
    }
}

/* Both what begins to hinder an order and its end are reported. */
static void watch_hindrance(orders_t *orders, goe_flight_action_t action, bool is_new) {
    const char *before = orders->hindrance;
    orders->hindrance = orders->overruled ? NULL : find_hindrance(orders, action);
    if (orders->hindrance != NULL && (is_new || orders->hindrance != before)) {
        event("the order is not sent to the autopilot: %s", orders->hindrance);
        put_log(orders, "hindered", orders->hindrance);
        screen_show(orders->screen, SCREEN_SILENCE, MAV_SEVERITY_WARNING, "GOE not sent: %s", orders->hindrance);
    } else if (orders->hindrance == NULL && before != NULL && !is_new && !orders->overruled) {
        event("nothing hinders the order now: it is sent");
    }
}

/* Returns whether a silence has ended: the order is sent at once. */
static bool watch(orders_t *orders, goe_flight_action_t action, bool is_new) {
    const bool was_silenced = orders->silenced;
    watch_pilot(orders);
    watch_hindrance(orders, action, is_new);
    if (!orders->sent) { /* while nothing is sent the mode is the pilot's */
        const bool may_be_old =
            orders->resumed_at != 0 && orders->autopilot->heartbeats - orders->resumed_at < BEATS_TO_RESUME;
        if (!may_be_old) {
            mode_watch_begin(&orders->watch, orders->autopilot, orders->autopilot->custom_mode);
        }
    }
    orders->silenced = orders->overruled || orders->denied || orders->hindrance != NULL;
    orders->command = orders->silenced ? 0 : orders->command;
    return was_silenced && !orders->silenced;
}

/* --------------------------------------------------------------------------------------------- an order that was left -- */

void orders_take_over(orders_t *orders, const order_left_t *left) { orders->left = *left; }

/* Of this flight: both clocks have gone on by as much, and not by long. */
static bool is_of_this_flight(const orders_t *orders, const order_left_t *left) {
    const int64_t unix_us = orders->unix_us - left->unix_us;
    const int64_t off_us = unix_us - (orders->boot_us - left->boot_us);
    return unix_us >= 0 && unix_us < LEFT_OLD_US && off_us < LEFT_OFF_US && off_us > -LEFT_OFF_US;
}

/* Once; and into this log, for a companion after this one. */
static void report_left(orders_t *orders) {
    if (orders->left_reported) {
        return;
    }
    orders->left_reported = true;
    orders->active = orders->left;
    orders->watch.mode_before = orders->left.mode_before;
    put_log(orders, "taken over", "");
    event("the log has an active order from before the restart: %s",
          goe_flight_action_text((goe_flight_action_t)orders->left.action));
    screen_show(orders->screen, SCREEN_SILENCE, MAV_SEVERITY_NOTICE, "GOE restarted in an order: Hold until passed");
}

static void end_left(orders_t *orders, const char *how) {
    orders->left.active = orders->active.active = false;
    if (orders->left_reported) {
        put_log(orders, how, "after a restart");
    }
}

/* Without an active order of its own: back, once the obstacle of the log is behind. */
static void follow_left(orders_t *orders, int64_t now_us) {
    const order_left_t *left = &orders->left;
    if (!left->active) {
        return;
    }
    if (orders->config->reaction_mode != REACTION_PX4 || orders->config->reaction_resume == 0 ||
        orders->autopilot->custom_mode != PX4_AUTO_LOITER || in_failsafe(orders) || !is_of_this_flight(orders, left)) {
        end_left(orders, "end");
        return;
    }
    report_left(orders);
    if (is_behind(orders, left->course_ne, left->obstacle_ne_m, left->radius_m)) {
        event("the obstacle of the order before the restart is passed");
        orders->resumes_left = RESUMES_MAX;
        ask_for_mode_before(orders, now_us);
        end_left(orders, "resume");
    }
}

/* --------------------------------------------------------------------------------------------------------- interface -- */

/* The mode before is the one of the latest heartbeat, unless that may still be of the order that has just ended, or is of an order
 * before a restart. */
static uint32_t find_mode_before(orders_t *orders) {
    const autopilot_t *autopilot = orders->autopilot;
    const bool may_be_old = orders->resumed_at != 0 && autopilot->heartbeats - orders->resumed_at < BEATS_TO_RESUME;
    const bool is_left =
        orders->left.active && autopilot->custom_mode == PX4_AUTO_LOITER && is_of_this_flight(orders, &orders->left);
    if (is_left) {
        return orders->left.mode_before;
    }
    return may_be_old ? orders->watch.mode_before : autopilot->custom_mode;
}

/* What a restarted companion needs to go back: the obstacle of the order, and the course. */
static void keep_obstacle(orders_t *orders) {
    goe_flight_obstacle_t obstacle;
    if (goe_flight_obstacle(orders->flight, orders->slot, &obstacle) == GOE_FLIGHT_OK) {
        orders->active.obstacle_ne_m[0] = obstacle.center_ned_m[0];
        orders->active.obstacle_ne_m[1] = obstacle.center_ned_m[1];
        orders->active.radius_m = obstacle.radius_m;
    }
}

static void keep_course(orders_t *orders) {
    const mavlink_local_position_ned_t *own = &orders->autopilot->position;
    const float speed_m_s = hypotf(own->vx, own->vy);
    if (speed_m_s > 0.0f) {
        orders->active.course_ne[0] = own->vx / speed_m_s;
        orders->active.course_ne[1] = own->vy / speed_m_s;
    }
}

/* The order is about another obstacle now, or an obstacle of it was given up. */
static void turn(orders_t *orders) {
    keep_obstacle(orders);
    put_log(orders, "turn", orders->gave_up ? "an obstacle was given up" : "");
}

/* The first of the active orders. Its course is the way to go back to: later orders come while the aircraft turns, and an order after a
 * restart while it circles. */
static void begin_first(orders_t *orders) {
    mode_watch_begin(&orders->watch, orders->autopilot, find_mode_before(orders));
    orders->broke_off = orders->placed = orders->has_traffic = false;
    orders->sent = orders->left.active && orders->watch.mode_before == orders->left.mode_before &&
                   orders->autopilot->custom_mode == PX4_AUTO_LOITER;
    if (orders->sent) {
        orders->active = orders->left;
    } else {
        keep_course(orders);
    }
    orders->left.active = false;
    orders->overruled = false;
}

/* ArduPlane turns where its own avoidance leads it: no side is named. */
static void show_order(orders_t *orders, const goe_flight_assessment_t *assessment) {
    const bool is_traffic =
        orders->config->reaction_mode == REACTION_ARDUPLANE && assessment->action != GOE_FLIGHT_GO_AROUND;
    screen_show(orders->screen, SCREEN_ORDER, assessment->late ? MAV_SEVERITY_CRITICAL : MAV_SEVERITY_WARNING,
                "GOE order, %s: obstacle in %.0f s%s",
                is_traffic ? "as traffic" : goe_flight_action_text(assessment->action),
                (double)assessment->hazard.tcpa_s, assessment->late ? ", late" : "");
}

static void begin(orders_t *orders, const goe_flight_assessment_t *assessment) {
    if (orders->action == GOE_FLIGHT_NONE) {
        begin_first(orders);
    }
    orders->awaits_hold = false;
    orders->denied = false; /* a side that is denied says nothing of a go-around */
    orders->resumes_left = 0;
    orders->orders++;
    event("order: %s; on this course %.0f m past it in %.1f s%s", goe_flight_action_text(assessment->action),
          (double)assessment->hazard.dcpa_m, (double)assessment->hazard.tcpa_s, assessment->late ? ", late" : "");
    show_order(orders, assessment);
    orders->action = assessment->action;
    orders->active.active = true;
    keep_obstacle(orders);
    put_log(orders, "order", assessment->late ? "late" : "");
}

static void end(orders_t *orders, int64_t now_us) {
    const goe_flight_action_t ended = orders->action;
    event("the order ends");
    screen_show(orders->screen, SCREEN_ORDER, MAV_SEVERITY_INFO, "GOE: order ends");
    orders->command = 0;
    if (orders->config->reaction_mode == REACTION_PX4) {
        resume(orders, ended, now_us);
    }
    orders->active.active = false;
    orders->action = GOE_FLIGHT_NONE;
    put_log(orders, "end", orders->resumes_left > 0 ? "back into the mode before" : "");
    orders->slot = -1;
    orders->hindrance = NULL;
}

/* An autopilot that has restarted knows of no order. */
static void forget_after_restart(orders_t *orders) {
    if (orders->restarts_counted != orders->autopilot->restarts) {
        orders->restarts_counted = orders->autopilot->restarts;
        orders->action = GOE_FLIGHT_NONE;
        orders->command = 0;
        orders->resumes_left = 0;
        orders->slot = -1;
        orders->left.active = orders->active.active = orders->sent = false;
    }
}

/* Those that the order was about before this assessment: one that is neither passed nor known any more may be ahead. A slot in use gets
 * another obstacle by an eviction alone: without one, another id is a new one of the same obstacle. */
static void watch_obstacles(orders_t *orders) {
    const bool evicted = orders->flight->counters.evicted != orders->evicted;
    orders->evicted = orders->flight->counters.evicted;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t obstacle;
        const bool known = is_known(orders, slot, &obstacle);
        const bool is_another = evicted && (obstacle.id == 0u || obstacle.id != orders->ids[slot]);
        const uint32_t bit = UINT32_C(1) << (unsigned)slot;
        orders->gave_up = orders->gave_up || ((orders->named & bit) != 0u && (!known || is_another));
        if (known && is_behind(orders, orders->active.course_ne, obstacle.center_ned_m, obstacle.radius_m)) {
            orders->named &= ~bit;
        }
        orders->ids[slot] = obstacle.id;
    }
}

/* Of an order, since its begin. After an obstacle was given up, another one may take its slot. */
static void note_obstacle_and_landing(orders_t *orders, const goe_flight_assessment_t *assessment) {
    const bool goes_on = orders->action != GOE_FLIGHT_NONE;
    orders->gave_up = (goes_on && orders->gave_up) || assessment->avoided < 0;
    orders->from_landing = (goes_on && orders->from_landing) || orders->autopilot->landing;
    orders->had_failsafe = goes_on && (orders->had_failsafe || (orders->sent && in_failsafe(orders)));
    orders->slot = assessment->avoided < 0 ? -1 : (int)(uint8_t)assessment->avoided;
    orders->named = goes_on ? orders->named : 0u;
    orders->named |= orders->slot < 0 ? 0u : UINT32_C(1) << (unsigned)orders->slot;
}

void orders_follow(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us) {
    if (orders->config->reaction_mode == REACTION_OFF) {
        return;
    }
    forget_after_restart(orders);
    const bool is_new = assessment->action != orders->action;
    const int slot_before = orders->slot;
    const bool gave_up_before = orders->gave_up;
    watch_obstacles(orders);
    if (assessment->action != GOE_FLIGHT_NONE) {
        note_obstacle_and_landing(orders, assessment);
    }
    orders->assessment = *assessment;
    orders->unix_us = (int64_t)own->unix_usec;
    orders->boot_us = (int64_t)own->time_usec;
    if (is_new && assessment->action == GOE_FLIGHT_NONE) {
        end(orders, now_us);
    } else if (is_new) {
        begin(orders, assessment);
    } else if (assessment->action != GOE_FLIGHT_NONE &&
               (orders->slot != slot_before || orders->gave_up != gave_up_before)) {
        turn(orders);
    }
    if (assessment->action == GOE_FLIGHT_NONE) {
        orders->flown = GOE_FLIGHT_NONE;
        go_on_resuming(orders, now_us);
        follow_left(orders, now_us);
        return;
    }
    const goe_flight_action_t flown = find_flown(orders, assessment->action);
    const bool is_other = is_new || flown != orders->flown;
    orders->flown = flown;
    const bool at_once = watch(orders, flown, is_other) || is_other;
    if (orders->silenced) {
        return;
    }
    if (orders->config->reaction_mode == REACTION_PX4) {
        follow_px4(orders, assessment, at_once, now_us);
    } else {
        follow_arduplane(orders, assessment, own, at_once, now_us);
    }
}

void orders_take(orders_t *orders, const mavlink_message_t *message) {
    mavlink_command_ack_t answer;
    if (message->msgid != MAVLINK_MSG_ID_COMMAND_ACK || !autopilot_is_from(orders->autopilot, message) ||
        orders->command == 0) {
        return;
    }
    mavlink_msg_command_ack_decode(message, &answer);
    if (answer.command != orders->command || !wire_is_for_us(orders->wire, &answer)) {
        return;
    }
    if (answer.result == MAV_RESULT_ACCEPTED || answer.result == MAV_RESULT_IN_PROGRESS) {
        orders->command = 0;
        mode_watch_answered(&orders->watch, orders->autopilot);
        put_log(orders, "acknowledged", "");
        return;
    }
    orders->refused++;
    event("the autopilot refuses the order (result %u)", answer.result);
    screen_show(orders->screen, SCREEN_SILENCE, MAV_SEVERITY_WARNING, "GOE: autopilot refuses the order");
    if (answer.result == MAV_RESULT_DENIED || answer.result == MAV_RESULT_UNSUPPORTED) {
        orders->placed = orders->placed && orders->watch.led;
        orders->denied = orders->silenced = true; /* it will not think better of it; others may be tried again */
        orders->command = 0;
    }
    put_log(orders, "refused", "");
}
