/* The autopilot as its messages show it. SPDX-License-Identifier: MIT */
#include "autopilot.h"

#include <math.h>
#include <string.h>

#include "events.h"

#define US_PER_MS 1000
#define US_PER_S 1000000
#define ASK_US 250000        /* between two questions for the clock */
#define REQUEST_US 5000000   /* between two rounds of requests for rates, while no samples come */
#define ORIGIN_US 5000000    /* between two requests for the origin */
#define SILENT_US 3000000    /* without a sample for this long the rates are requested again */
#define CLOCK_OFF_US 1000000 /* a sample's time that far from the clock is another clock's */
#define STRANGE_MAX 3
#define UNANSWERED 40u        /* unanswered requests before a report: ten seconds */
#define HEIGHT_OLD_US 2000000 /* a range finder or terrain that is older counts as none */

/* A step between two positions that the velocities do not explain is a reset of the autopilot's filter: beyond what an
 * acceleration that nobody flies makes of the time between, and the noise of a filter that corrects itself. */
#define STEP_FLOOR_M 1.0f
#define STEP_ACCELERATION 15.0f /* m/s^2 */
#define STEP_GAP_S 1.0f         /* after a longer gap nothing can be said: counts as none */

/* The same of two attitudes: the rates of both, half again, and the noise. */
#define TURN_FLOOR_RAD 0.1f
#define TURN_RATES 0.75f /* share of the sum of both rates over the time between */

#define RESET_WAIT_US 300000   /* a jump may show in the samples this long after ODOMETRY's counter has risen ... */
#define RESET_BEFORE_US 500000 /* ... or before it */
#define POSITION_MAX_M 1.0e6f
#define SPEED_MAX_M_S 1.0e3f
#define HEIGHT_MAX_M 1.0e5f
#define HERE_M 200.0f       /* a report of the terrain farther off is of another place */
#define M_PER_E7 0.0111195f /* of 1e-7 degrees on a sphere of 6371 km */
#define RAD_PER_E7 1.7453293e-9f
#define DOWNWARD MAV_SENSOR_ROTATION_PITCH_270
#define UPRIGHT_MIN 0.7f  /* cosine of the tilt up to which a distance downwards is a height */
#define SIGNAL_INVALID 1u /* of DISTANCE_SENSOR.signal_quality; 0 is unknown */

void autopilot_init(autopilot_t *autopilot, const companion_config_t *config, goe_flight_t *flight, wire_t *wire) {
    (void)memset(autopilot, 0, sizeof *autopilot);
    autopilot->config = config;
    autopilot->flight = flight;
    autopilot->wire = wire;
    autopilot->system = (uint8_t)config->link_system;
    wire->autopilot_system = autopilot->system;
}

int64_t autopilot_clock_us(const autopilot_t *autopilot, int64_t now_us) {
    return clock_sync_known(&autopilot->clock) ? clock_sync_autopilot_us(&autopilot->clock, now_us) : 0;
}

double autopilot_clock_sd_us(const autopilot_t *autopilot) {
    return clock_sync_sd_us(&autopilot->clock, (double)autopilot->config->flight.delay_sd_s * US_PER_S);
}

const char *autopilot_kind_text(const autopilot_t *autopilot) {
    switch (autopilot->kind) {
        case MAV_AUTOPILOT_ARDUPILOTMEGA:
            return "ArduPilot";
        case MAV_AUTOPILOT_PX4:
            return "PX4";
        default:
            return "autopilot";
    }
}

float autopilot_heading_deg(const autopilot_t *autopilot) {
    const mavlink_attitude_quaternion_t *q = &autopilot->attitude;
    const float north = q->q1 * q->q1 + q->q2 * q->q2 - q->q3 * q->q3 - q->q4 * q->q4;
    const float east = 2.0f * (q->q2 * q->q3 + q->q1 * q->q4);
    const float heading = atan2f(east, north) * 57.29578f;
    return isfinite(heading) ? fmodf(heading + 360.0f, 360.0f) : 0.0f;
}

/* ------------------------------------------------------------------------------------------------------------- clock -- */

static void count_reset(autopilot_t *autopilot, bool known) {
    autopilot->resets++;
    autopilot->last_reset_known = known;
}

/* All that was known of another run of the autopilot. A clock that merely slips against the own one (a simulator that is starved
 * of its processor, a computer that was suspended) ends nothing: poses and tracks are of the autopilot's clock alone. */
static void start_again(autopilot_t *autopilot) {
    clock_sync_reset(&autopilot->clock);
    (void)goe_flight_restart(autopilot->flight);
    count_reset(autopilot, false);
    autopilot->has_attitude = autopilot->has_position = false;
    autopilot->has_range_finder = autopilot->has_terrain = false;
    autopilot->has_origin = autopilot->origin_given = autopilot->has_home = autopilot->has_home_alt = false;
    autopilot->has_odometry_resets = autopilot->answered = false;
    autopilot->landing = autopilot->flaring = autopilot->on_ground = false;
    autopilot->report_us = autopilot->jump_us = 0;
    autopilot->strange_times = 0;
    message_rates_clear(&autopilot->rates);
    autopilot->requested_us = autopilot->origin_requested_us = 0;
}

/* Whether a sample's time goes on from the latest. A few that do not, or that lie ahead of the clock, mean a restart. One that
 * lies behind the clock but goes on is merely late: a link or this computer was held up. */
static bool is_of_the_clock(autopilot_t *autopilot, int64_t time_us, int64_t latest_us, int64_t now_us) {
    if (!clock_sync_known(&autopilot->clock)) {
        clock_sync_one_way(&autopilot->clock, now_us, time_us);
        return true;
    }
    const int64_t off_us = time_us - autopilot_clock_us(autopilot, now_us);
    const bool goes_on = time_us > latest_us - CLOCK_OFF_US;
    if (off_us < CLOCK_OFF_US && goes_on) {
        autopilot->strange_times = 0;
        clock_sync_one_way(&autopilot->clock, now_us, time_us);
        return true;
    }
    autopilot->strange_times++;
    if (autopilot->strange_times >= STRANGE_MAX) {
        autopilot->restarts++;
        event("the autopilot's clock jumped by %+.1f s: all tracks end", (double)off_us / US_PER_S);
        start_again(autopilot);
    }
    return false;
}

static bool was_requested(const autopilot_t *autopilot, int64_t question_us) {
    for (unsigned i = 0; i < AUTOPILOT_QUESTIONS; i++) {
        if (autopilot->question_us[i] == question_us && question_us != 0) {
            return true;
        }
    }
    return false;
}

static void take_timesync(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_timesync_t sync;
    mavlink_message_t answer;
    mavlink_msg_timesync_decode(message, &sync);
    if (sync.tc1 == 0) { /* a question of the autopilot's */
        (void)mavlink_msg_timesync_pack(autopilot->wire->system, autopilot->wire->component, &answer, now_us * 1000,
                                        sync.ts1);
        wire_send(autopilot->wire, &answer);
        return;
    }
    const int64_t question_us = sync.ts1 / 1000;
    if (!was_requested(autopilot, question_us)) {
        return; /* an answer to somebody else */
    }
    autopilot->answered = true;
    const int64_t before_us = autopilot_clock_us(autopilot, now_us);
    if (!clock_sync_answer(&autopilot->clock, question_us, now_us, sync.tc1 / 1000)) {
        (void)clock_sync_answer(&autopilot->clock, question_us, now_us, sync.tc1 / 1000);
        autopilot->slips++;
        event("the autopilot's clock slipped by %+.0f ms against this one",
              (double)(autopilot_clock_us(autopilot, now_us) - before_us) / US_PER_MS);
    }
}

/* -------------------------------------------------------------------------------------------------------------- pose -- */

static void count_sample(autopilot_t *autopilot, goe_flight_status_t status, unsigned long *taken, int64_t *taken_us,
                         int64_t now_us) {
    if (status == GOE_FLIGHT_OK) {
        (*taken)++;
        *taken_us = now_us;
    } else {
        autopilot->bad_samples++;
    }
}

static float rate_of(const mavlink_attitude_quaternion_t *a) {
    return sqrtf(a->rollspeed * a->rollspeed + a->pitchspeed * a->pitchspeed + a->yawspeed * a->yawspeed);
}

/* Whether the attitude turned farther than the rates explain. */
static bool has_turned(const mavlink_attitude_quaternion_t *from, const mavlink_attitude_quaternion_t *to,
                       float span_s) {
    const float cosine = fabsf(from->q1 * to->q1 + from->q2 * to->q2 + from->q3 * to->q3 + from->q4 * to->q4);
    const float angle = 2.0f * acosf(fminf(cosine, 1.0f));
    return angle > TURN_FLOOR_RAD + TURN_RATES * (rate_of(from) + rate_of(to)) * span_s;
}

static void take_attitude(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_attitude_quaternion_t now;
    mavlink_msg_attitude_quaternion_decode(message, &now);
    const int64_t latest_us =
        autopilot->has_attitude ? (int64_t)autopilot->attitude.time_boot_ms * US_PER_MS : INT64_MIN / 2;
    if (!is_of_the_clock(autopilot, (int64_t)now.time_boot_ms * US_PER_MS, latest_us, now_us)) {
        return;
    }
    const float span_s = (float)(int32_t)(now.time_boot_ms - autopilot->attitude.time_boot_ms) * 1e-3f;
    const bool turned = autopilot->has_attitude && span_s > 0.0f && span_s < STEP_GAP_S &&
                        has_turned(&autopilot->attitude, &now, span_s);
    const goe_flight_attitude_t sample = {
        now.time_boot_ms * US_PER_MS, {now.q1, now.q2, now.q3, now.q4}, autopilot->reset_attitude + (turned ? 1u : 0u)};
    const goe_flight_status_t status = goe_flight_attitude(autopilot->flight, &sample);
    count_sample(autopilot, status, &autopilot->attitudes, &autopilot->attitude_us, now_us);
    if (status != GOE_FLIGHT_OK) {
        return;
    }
    if (turned) {
        autopilot->jump_us = now_us;
        autopilot->reset_attitude++;
        autopilot->jumps++;
        count_reset(autopilot, false);
        event("the autopilot's attitude jumped: all tracks end");
    }
    autopilot->attitude = now;
    autopilot->has_attitude = true;
}

/* What of the step from one position to the next the mean velocity does not explain, where that is too much. */
static bool find_step(const mavlink_local_position_ned_t *from, const mavlink_local_position_ned_t *to, float span_s,
                      float step_m[3]) {
    const float allowed_m = STEP_FLOOR_M + 0.5f * STEP_ACCELERATION * span_s * span_s;
    const float half_s = 0.5f * span_s;
    step_m[0] = to->x - from->x - half_s * (from->vx + to->vx);
    step_m[1] = to->y - from->y - half_s * (from->vy + to->vy);
    step_m[2] = to->z - from->z - half_s * (from->vz + to->vz);
    return hypotf(step_m[0], step_m[1]) > allowed_m || fabsf(step_m[2]) > allowed_m;
}

/* Heights come more rarely than positions: the ground's altitude is kept. */
static void put_heights(const autopilot_t *autopilot, int64_t time_us, goe_flight_position_t *sample) {
    const float down_m = sample->position_ned_m[2];
    sample->height_m[GOE_FLIGHT_RANGE_FINDER] = autopilot->range_finder_down_m - down_m;
    sample->height_m[GOE_FLIGHT_TERRAIN] = autopilot->terrain_down_m - down_m;
    sample->height_m[GOE_FLIGHT_HOME] = autopilot->home_down_m - down_m;
    if (autopilot->has_range_finder && time_us - autopilot->range_finder_us < HEIGHT_OLD_US) {
        sample->height_valid |= (uint8_t)(1u << GOE_FLIGHT_RANGE_FINDER);
    }
    if (autopilot->has_terrain && time_us - autopilot->terrain_us < HEIGHT_OLD_US) {
        sample->height_valid |= (uint8_t)(1u << GOE_FLIGHT_TERRAIN);
    }
    if (autopilot->has_home) {
        sample->height_valid |= (uint8_t)(1u << GOE_FLIGHT_HOME);
    }
}

static goe_flight_position_t position_sample(const autopilot_t *autopilot, const mavlink_local_position_ned_t *now) {
    goe_flight_position_t sample;
    (void)memset(&sample, 0, sizeof sample);
    sample.time_us = now->time_boot_ms * US_PER_MS;
    sample.position_ned_m[0] = now->x;
    sample.position_ned_m[1] = now->y;
    sample.position_ned_m[2] = now->z;
    sample.velocity_ned_m_s[0] = now->vx;
    sample.velocity_ned_m_s[1] = now->vy;
    sample.velocity_ned_m_s[2] = now->vz;
    put_heights(autopilot, (int64_t)now->time_boot_ms * US_PER_MS, &sample);
    sample.origin_known = autopilot->has_origin;
    sample.origin_lat_e7 = autopilot->origin_lat_e7;
    sample.origin_lon_e7 = autopilot->origin_lon_e7;
    sample.reset_horizontal = autopilot->reset_horizontal;
    sample.reset_vertical = autopilot->reset_vertical;
    sample.reset_delta_known = autopilot->reset_delta_known;
    (void)memcpy(sample.reset_delta_ned_m, autopilot->reset_delta_ned_m, sizeof sample.reset_delta_ned_m);
    return sample;
}

/* The mark of a step, before the sample that has it is given. */
static void mark_step(autopilot_t *autopilot, const float step_m[3], int64_t now_us) {
    autopilot->jump_us = now_us;
    (void)memcpy(autopilot->reset_delta_ned_m, step_m, sizeof autopilot->reset_delta_ned_m);
    autopilot->reset_delta_known = true;
    autopilot->reset_horizontal++;
    autopilot->reset_vertical++;
    autopilot->jumps++;
    count_reset(autopilot, true);
    event("the autopilot's position jumped by %.1f, %.1f, %.1f m", (double)step_m[0], (double)step_m[1],
          (double)step_m[2]);
}

/* The flight layer's requirement, checked here already to keep an invalid value from becoming a step. NaN is in no range. */
static bool is_in_range(const mavlink_local_position_ned_t *p) {
    return fabsf(p->x) <= POSITION_MAX_M && fabsf(p->y) <= POSITION_MAX_M && fabsf(p->z) <= POSITION_MAX_M &&
           fabsf(p->vx) <= SPEED_MAX_M_S && fabsf(p->vy) <= SPEED_MAX_M_S && fabsf(p->vz) <= SPEED_MAX_M_S;
}

static void take_position(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_local_position_ned_t now;
    float step_m[3];
    mavlink_msg_local_position_ned_decode(message, &now);
    if (!is_in_range(&now)) {
        autopilot->bad_samples++;
        return;
    }
    const int64_t latest_us =
        autopilot->has_position ? (int64_t)autopilot->position.time_boot_ms * US_PER_MS : INT64_MIN / 2;
    if (!is_of_the_clock(autopilot, (int64_t)now.time_boot_ms * US_PER_MS, latest_us, now_us)) {
        return;
    }
    const float span_s = (float)(int32_t)(now.time_boot_ms - autopilot->position.time_boot_ms) * 1e-3f;
    if (autopilot->has_position && span_s > 0.0f && span_s < STEP_GAP_S &&
        find_step(&autopilot->position, &now, span_s, step_m)) {
        mark_step(autopilot, step_m, now_us);
    }
    const goe_flight_position_t sample = position_sample(autopilot, &now);
    const goe_flight_status_t status = goe_flight_position(autopilot->flight, &sample);
    count_sample(autopilot, status, &autopilot->positions, &autopilot->position_us, now_us);
    if (status == GOE_FLIGHT_OK) {
        autopilot->position = now;
        autopilot->has_position = true;
        autopilot->origin_given = autopilot->has_origin;
    }
}

/* Of ODOMETRY only the reset counter, which does not give the size of the jump. A large jump is found in the samples, a
 * moment before or after: then the counter adds nothing. */
static void take_odometry(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    const uint8_t resets = mavlink_msg_odometry_get_reset_counter(message);
    if (autopilot->has_odometry_resets && resets != autopilot->odometry_resets) {
        autopilot->report_us = now_us;
    }
    autopilot->odometry_resets = resets;
    autopilot->has_odometry_resets = true;
}

static void judge_reported_reset(autopilot_t *autopilot, int64_t now_us) {
    if (autopilot->report_us == 0 || now_us - autopilot->report_us < RESET_WAIT_US) {
        return;
    }
    if (autopilot->jump_us == 0 || autopilot->report_us - autopilot->jump_us > RESET_BEFORE_US) {
        autopilot->reset_attitude++;
        count_reset(autopilot, false);
        event("the autopilot reports a reset of unknown size: all tracks end");
    }
    autopilot->report_us = 0;
}

/* ----------------------------------------------------------------------------------------------------------- heights -- */

/* Share of a distance along body's down that is vertical. */
static float upright(const autopilot_t *autopilot) {
    const mavlink_attitude_quaternion_t *q = &autopilot->attitude;
    return autopilot->has_attitude ? 1.0f - 2.0f * (q->q2 * q->q2 + q->q3 * q->q3) : 1.0f;
}

static void take_distance(autopilot_t *autopilot, const mavlink_message_t *message) {
    mavlink_distance_sensor_t sensor;
    mavlink_msg_distance_sensor_decode(message, &sensor);
    const float share = upright(autopilot);
    const float height_m = 0.01f * (float)sensor.current_distance * share;
    if (sensor.orientation != DOWNWARD || sensor.signal_quality == SIGNAL_INVALID || !(share >= UPRIGHT_MIN) ||
        sensor.current_distance <= sensor.min_distance || sensor.current_distance >= sensor.max_distance ||
        !autopilot->has_position) {
        return;
    }
    autopilot->range_finder_down_m = autopilot->position.z + height_m;
    autopilot->range_finder_us = (int64_t)sensor.time_boot_ms * US_PER_MS;
    autopilot->has_range_finder = true;
}

static void put_terrain(autopilot_t *autopilot, float height_m, int64_t now_us) {
    if (fabsf(height_m) <= HEIGHT_MAX_M && autopilot->has_position) {
        autopilot->terrain_down_m = autopilot->position.z + height_m;
        autopilot->terrain_us = autopilot_clock_us(autopilot, now_us);
        autopilot->has_terrain = true;
    }
}

/* A ground station may ask the autopilot for the terrain of any place. */
static bool is_here(const autopilot_t *autopilot, int32_t lat_e7, int32_t lon_e7) {
    const float north_m = M_PER_E7 * (float)((int64_t)lat_e7 - autopilot->origin_lat_e7) - autopilot->position.x;
    const float east_m =
        M_PER_E7 * cosf((float)lat_e7 * RAD_PER_E7) * (float)((int64_t)lon_e7 - autopilot->origin_lon_e7) -
        autopilot->position.y;
    return !autopilot->has_origin || !autopilot->has_position || hypotf(north_m, east_m) <= HERE_M;
}

static void take_terrain(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_terrain_report_t report;
    mavlink_msg_terrain_report_decode(message, &report);
    if (report.spacing > 0 && is_here(autopilot, report.lat, report.lon)) { /* 0: no terrain is known there */
        put_terrain(autopilot, report.current_height, now_us);
    }
}

static void take_altitude(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_altitude_t altitude;
    mavlink_msg_altitude_decode(message, &altitude);
    const float height_m = altitude.bottom_clearance;
    if (height_m > 0.0f) {
        put_terrain(autopilot, height_m, now_us);
    }
}

/* ArduPilot reports home in its own frame as the origin whatever its height: there the altitudes of both count. */
static void place_home(autopilot_t *autopilot) {
    if (autopilot->kind == MAV_AUTOPILOT_ARDUPILOTMEGA && autopilot->has_home_alt && autopilot->has_origin) {
        autopilot->home_down_m = autopilot->origin_alt_m - autopilot->home_alt_m;
        autopilot->has_home = fabsf(autopilot->home_down_m) <= HEIGHT_MAX_M;
    }
}

static void take_home(autopilot_t *autopilot, const mavlink_message_t *message) {
    mavlink_home_position_t home;
    mavlink_msg_home_position_decode(message, &home);
    const float down_m = home.z;
    autopilot->home_alt_m = 1e-3f * (float)home.altitude;
    autopilot->has_home_alt = true;
    if (autopilot->kind != MAV_AUTOPILOT_ARDUPILOTMEGA && fabsf(down_m) <= HEIGHT_MAX_M) {
        autopilot->home_down_m = down_m;
        autopilot->has_home = true;
    }
    place_home(autopilot);
}

static void take_origin(autopilot_t *autopilot, const mavlink_message_t *message) {
    mavlink_gps_global_origin_t origin;
    mavlink_msg_gps_global_origin_decode(message, &origin);
    if (origin.latitude < -890000000 || origin.latitude > 890000000 || origin.longitude < -1800000000 ||
        origin.longitude > 1800000000) {
        return;
    }
    autopilot->origin_lat_e7 = origin.latitude;
    autopilot->origin_lon_e7 = origin.longitude;
    autopilot->origin_alt_m = 1e-3f * (float)origin.altitude;
    autopilot->has_origin = true;
    place_home(autopilot);
}

/* ---------------------------------------------------------------------------------------------------------- identity -- */

static void take_heartbeat(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    mavlink_heartbeat_t beat;
    mavlink_msg_heartbeat_decode(message, &beat);
    if (message->compid != MAV_COMP_ID_AUTOPILOT1 || beat.autopilot == MAV_AUTOPILOT_INVALID ||
        (autopilot->system != 0 && message->sysid != autopilot->system)) {
        return;
    }
    if (autopilot->heartbeat_us != 0 && !link_is_answered(autopilot->wire->link)) {
        event("the autopilot now sends from another address");
    }
    if (autopilot->heartbeat_us == 0) {
        autopilot->system = message->sysid;
        autopilot->kind = beat.autopilot;
        autopilot->wire->autopilot_system = message->sysid;
        autopilot->wire->system = message->sysid;
        event("%s found: system %u", autopilot_kind_text(autopilot), message->sysid);
    }
    autopilot->custom_mode = beat.custom_mode;
    autopilot->base_mode = beat.base_mode;
    autopilot->system_status = beat.system_status;
    autopilot->heartbeat_us = now_us;
    autopilot->heartbeats++;
    link_answer(autopilot->wire->link);
}

/* One address is believed, until nothing came from there for a while. */
static bool is_from_elsewhere(const autopilot_t *autopilot, int64_t now_us) {
    return autopilot->heartbeat_us != 0 && now_us - autopilot->heartbeat_us < SILENT_US &&
           !link_is_answered(autopilot->wire->link);
}

static void take_landed_state(autopilot_t *autopilot, uint8_t state) {
    autopilot->landing = state == MAV_LANDED_STATE_LANDING;
    autopilot->on_ground = state == MAV_LANDED_STATE_ON_GROUND;
    autopilot->flaring = autopilot->flaring && autopilot->landing;
}

/* ArduPlane reports by a text alone that its avoidance of traffic ends without a pilot, and that it flares. Its landed state is
 * LANDING from the approach until it stands still. */
static void take_text(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    static const char recovery[] = "Avoid: Resuming";
    static const char flare[] = "Flare ";
    char text[MAVLINK_MSG_STATUSTEXT_FIELD_TEXT_LEN];
    (void)mavlink_msg_statustext_get_text(message, text);
    if (memcmp(text, recovery, sizeof recovery - 1u) == 0) {
        autopilot->recovered_us = now_us;
    } else if (memcmp(text, flare, sizeof flare - 1u) == 0) {
        autopilot->flaring = autopilot->landing;
    }
}

uint8_t autopilot_phase(const autopilot_t *autopilot) {
    if (autopilot->on_ground) {
        return GOE_FLIGHT_LANDED;
    }
    if (autopilot->flaring) {
        return GOE_FLIGHT_FLARE;
    }
    return autopilot->landing ? GOE_FLIGHT_APPROACH : GOE_FLIGHT_FLYING;
}

static void take_target(autopilot_t *autopilot, const mavlink_message_t *message) {
    mavlink_position_target_global_int_t target;
    mavlink_msg_position_target_global_int_decode(message, &target);
    autopilot->target_lat_e7 = target.lat_int;
    autopilot->target_lon_e7 = target.lon_int;
    autopilot->targets++;
}

static void take_acknowledgement(autopilot_t *autopilot, const mavlink_message_t *message) {
    mavlink_command_ack_t answer;
    mavlink_msg_command_ack_decode(message, &answer);
    if (answer.command == MAV_CMD_SET_MESSAGE_INTERVAL && wire_is_for_us(autopilot->wire, &answer)) {
        message_rates_answer(&autopilot->rates, answer.result);
    }
}

bool autopilot_is_from(const autopilot_t *autopilot, const mavlink_message_t *message) {
    return autopilot->heartbeat_us != 0 && message->sysid == autopilot->system &&
           message->compid == MAV_COMP_ID_AUTOPILOT1;
}

bool autopilot_is_stranger(autopilot_t *autopilot, int64_t now_us) {
    const bool is_stranger = is_from_elsewhere(autopilot, now_us);
    autopilot->strangers += is_stranger ? 1u : 0u;
    return is_stranger;
}

void autopilot_take(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us) {
    if (message->msgid == MAVLINK_MSG_ID_HEARTBEAT) {
        take_heartbeat(autopilot, message, now_us);
        return;
    }
    if (!autopilot_is_from(autopilot, message)) {
        return;
    }
    switch (message->msgid) {
        case MAVLINK_MSG_ID_ATTITUDE_QUATERNION:
            take_attitude(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_LOCAL_POSITION_NED:
            take_position(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_ODOMETRY:
            take_odometry(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_TIMESYNC:
            take_timesync(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_DISTANCE_SENSOR:
            take_distance(autopilot, message);
            break;
        case MAVLINK_MSG_ID_TERRAIN_REPORT:
            take_terrain(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_ALTITUDE:
            take_altitude(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_HOME_POSITION:
            take_home(autopilot, message);
            break;
        case MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN:
            take_origin(autopilot, message);
            break;
        case MAVLINK_MSG_ID_STATUSTEXT:
            take_text(autopilot, message, now_us);
            break;
        case MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT:
            take_target(autopilot, message);
            break;
        case MAVLINK_MSG_ID_COMMAND_ACK:
            take_acknowledgement(autopilot, message);
            break;
        case MAVLINK_MSG_ID_EXTENDED_SYS_STATE:
            take_landed_state(autopilot, mavlink_msg_extended_sys_state_get_landed_state(message));
            break;
        default:
            break;
    }
}

/* --------------------------------------------------------------------------------------------------------- questions -- */

static void command(autopilot_t *autopilot, uint16_t number, float first, float second) {
    mavlink_message_t message;
    (void)mavlink_msg_command_long_pack(autopilot->wire->system, autopilot->wire->component, &message,
                                        autopilot->system, MAV_COMP_ID_AUTOPILOT1, number, 0, first, second, 0.0f, 0.0f,
                                        0.0f, 0.0f, 0.0f);
    wire_send(autopilot->wire, &message);
}

static int64_t latest_question_us(const autopilot_t *autopilot) {
    return autopilot->questions == 0 ? 0 : autopilot->question_us[(autopilot->questions - 1u) % AUTOPILOT_QUESTIONS];
}

static void ask_clock(autopilot_t *autopilot, int64_t now_us) {
    mavlink_message_t message;
    autopilot->question_us[autopilot->questions % AUTOPILOT_QUESTIONS] = now_us;
    autopilot->questions++;
    if (!autopilot->answered && autopilot->questions % UNANSWERED == 0) {
        event("the autopilot does not answer TIMESYNC: the link's delay is taken as flight.delay_sd_s");
    }
    (void)mavlink_msg_timesync_pack(autopilot->wire->system, autopilot->wire->component, &message, 0, now_us * 1000);
    wire_send(autopilot->wire, &message);
}

static void want_messages(autopilot_t *autopilot) {
    const companion_config_t *config = autopilot->config;
    message_rates_t *rates = &autopilot->rates;
    message_rates_want(rates, MAVLINK_MSG_ID_ATTITUDE_QUATERNION, "ATTITUDE_QUATERNION", config->link_attitude_hz);
    message_rates_want(rates, MAVLINK_MSG_ID_LOCAL_POSITION_NED, "LOCAL_POSITION_NED", config->link_position_hz);
    message_rates_want(rates, MAVLINK_MSG_ID_DISTANCE_SENSOR, "DISTANCE_SENSOR", 10.0);
    message_rates_want(rates, MAVLINK_MSG_ID_EXTENDED_SYS_STATE, "EXTENDED_SYS_STATE", 2.0);
    message_rates_want(rates, MAVLINK_MSG_ID_HOME_POSITION, "HOME_POSITION", 0.5);
    message_rates_want(rates, MAVLINK_MSG_ID_ODOMETRY, "ODOMETRY", 10.0);
    message_rates_want(rates, MAVLINK_MSG_ID_GPS_RAW_INT, "GPS_RAW_INT", 2.0);
    if (autopilot->kind == MAV_AUTOPILOT_PX4) {
        message_rates_want(rates, MAVLINK_MSG_ID_ESTIMATOR_STATUS, "ESTIMATOR_STATUS", 2.0);
        message_rates_want(rates, MAVLINK_MSG_ID_ALTITUDE, "ALTITUDE", 10.0);
        message_rates_want(rates, MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT, "POSITION_TARGET_GLOBAL_INT", 2.0);
    } else {
        message_rates_want(rates, MAVLINK_MSG_ID_EKF_STATUS_REPORT, "EKF_STATUS_REPORT", 2.0);
        message_rates_want(rates, MAVLINK_MSG_ID_TERRAIN_REPORT, "TERRAIN_REPORT", 2.0);
    }
}

/* One round after the other, for as long as samples are missing. */
static void ask_rates(autopilot_t *autopilot, int64_t now_us) {
    const bool no_attitude = now_us - autopilot->attitude_us > SILENT_US;
    const bool no_position = now_us - autopilot->position_us > SILENT_US;
    if (autopilot->rates.count == 0) {
        autopilot->requested_us = now_us;
        want_messages(autopilot);
    } else if (message_rates_done(&autopilot->rates) && (no_attitude || no_position) &&
               now_us - autopilot->requested_us >= REQUEST_US) {
        event("no %s: asked for again", no_attitude ? "ATTITUDE_QUATERNION comes" : "LOCAL_POSITION_NED comes");
        autopilot->requested_us = now_us;
        message_rates_repeat(&autopilot->rates);
    }
    message_rates_ask(&autopilot->rates, autopilot->wire, autopilot->system, now_us);
}

static void ask_origin(autopilot_t *autopilot, int64_t now_us) {
    if (!autopilot->has_origin && now_us - autopilot->origin_requested_us >= ORIGIN_US) {
        autopilot->origin_requested_us = now_us;
        command(autopilot, MAV_CMD_REQUEST_MESSAGE, (float)MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN, 0.0f);
        command(autopilot, MAV_CMD_REQUEST_MESSAGE, (float)MAVLINK_MSG_ID_HOME_POSITION, 0.0f);
    }
}

void autopilot_ask(autopilot_t *autopilot, int64_t now_us) {
    judge_reported_reset(autopilot, now_us);
    if (autopilot->heartbeat_us == 0) {
        return;
    }
    if (now_us - autopilot->heartbeat_us >= SILENT_US) { /* it may come back from another address */
        link_release(autopilot->wire->link);
    }
    if (now_us - latest_question_us(autopilot) >= ASK_US) {
        ask_clock(autopilot, now_us);
    }
    if (autopilot->config->link_request_rates != 0) {
        ask_rates(autopilot, now_us);
        ask_origin(autopilot, now_us);
    }
}
