/* The module goe of PX4. SPDX-License-Identifier: MIT */
#include "Goe.hpp"

#include <math.h>
#include <px4_platform_common/log.h>
#include <string.h>

namespace {

/* Its own work queue. Stack: the deepest call is an image's update; README.md has the figures. Priority: as PX4's low one. */
constexpr px4::wq_config_t work_queue{"wq:goe", 4600, -50};

constexpr uint32_t CYCLE_US = 100000; /* assessments and publications; also while no attitude comes */
constexpr uint64_t RANGE_FRESH_US = 300000;
constexpr uint64_t DEAD_RECKONING_US =
    3000000; /* after which its end is believed: PX4's flag flickers once a second at first */
constexpr float CM_PER_M = 100.f;
constexpr float US_PER_S = 1.0e6f;
constexpr float DISTANCE_MAX_M = 200.f;        /* of obstacle_distance: its readers need no more */
constexpr uint32_t TARGET_DELAY_SD_US = 20000; /* one sigma of GOE_LT_DELAY */

uint32_t whole_us(float s) { return static_cast<uint32_t>(US_PER_S * s); }

/* Before the first assessment: no pose, which contradicts nothing. */
goe_flight_assessment_t nothing_known() {
    goe_flight_assessment_t nothing{};
    nothing.worst = nothing.avoided = -1;
    nothing.pose_agrees = true;
    return nothing;
}

} // namespace

#ifdef GOE_MODULE_DESCRIPTOR
ModuleBase::Descriptor Goe::desc{task_spawn, custom_command, print_usage};
#endif

Goe::Goe() : ScheduledWorkItem(MODULE_NAME, work_queue), _assessment(nothing_known()) {
    pthread_mutex_init(&_overview_lock, nullptr);
    _self_check = static_cast<uint8_t>(goe_self_check());
}

Goe::~Goe() {
    perf_free(_cycle_perf);
    pthread_mutex_destroy(&_overview_lock);
}

bool Goe::init() {
    if (_self_check != 0) {
        PX4_ERR("arithmetic is not bit-identical to other targets: self-check 0x%02x", _self_check);
    }
    (void)_vehicle_status_sub.update(&_vehicle_status);
    read_parameters();
    use_parameters();
    if (!_attitude_sub.registerCallback() || !_tunnel_sub.registerCallback()) {
        PX4_ERR("callback registration failed");
        return false;
    }
    ScheduleOnInterval(CYCLE_US);
    return true;
}

/* ------------------------------------------------------------------------------------------------------- parameters -- */

bool Goe::has_wings() const { return _vehicle_status.vehicle_type == vehicle_status_s::VEHICLE_TYPE_FIXED_WING; }

void Goe::read_parameters() {
    const float reported_m = _parameters.narrow_loiter_m;
    _had_wings = has_wings();
    goe_parameters_read(_parameters, _had_wings);
    if (_parameters.narrow_loiter_m > 0.f && fabsf(_parameters.narrow_loiter_m - reported_m) > 0.f) {
        mavlink_log_critical(&_mavlink_log_pub, "goe: NAV_LOITER_RAD %.0f too small, %.0f used",
                             static_cast<double>(_parameters.narrow_loiter_m),
                             static_cast<double>(_parameters.flight.loiter_m));
    }
}

void Goe::use_parameters() {
    const char *bad_field = nullptr;
    /* The layer's own checks judge them. On failure it cannot be used any more: the settings before, if any, are taken again. */
    if (goe_flight_init(&_flight, sizeof _flight, &_parameters.estimator, &_parameters.flight, &bad_field) ==
        GOE_FLIGHT_OK) {
        _used = _parameters;
        _in_use = true;
    } else if (_in_use) {
        _in_use = goe_flight_init(&_flight, sizeof _flight, &_used.estimator, &_used.flight, nullptr) == GOE_FLIGHT_OK;
    }
    _bad_field = bad_field;
    _waiting = false;
    _images.forget();
    if (_bad_field != nullptr) {
        mavlink_log_critical(&_mavlink_log_pub, "goe: bad parameter %s", goe_text_parameter(_bad_field));
    }
}

/* A change that ends tracks waits while armed: a parameter must not make the module forget an obstacle that is followed or an
 * active order. */
void Goe::follow_parameters() {
    parameter_update_s update;
    if (_parameter_update_sub.update(&update) || _had_wings != has_wings()) {
        const GoeParameters before = _parameters;
        read_parameters();
        if (goe_parameters_differ(_parameters, before)) {
            _waiting = !_in_use || goe_parameters_differ(_parameters, _used);
            _bad_field = _waiting ? _bad_field : nullptr;
        }
    }
    const bool idle = _assessment.obstacles == 0 && _assessment.unplaced == 0 && _assessment.action == GOE_FLIGHT_NONE;
    if (_waiting && (!is_armed() || !_in_use || idle)) {
        use_parameters();
    }
}

/* ----------------------------------------------------------------------------------------------------------- poses -- */

void Goe::take_attitude() {
    vehicle_attitude_s topic;
    if (_attitude_sub.update(&topic)) {
        const goe_flight_attitude_t sample = goe_px4::attitude(topic);
        memcpy(_attitude_q, topic.q, sizeof _attitude_q);
        (void)goe_flight_attitude(&_flight, &sample);
    }
}

void Goe::take_heights() {
    home_position_s home;
    distance_sensor_s sensor;
    for (uORB::Subscription &subscription : _distance_sensor_sub) {
        float height_m = 0.f;
        if (subscription.update(&sensor) && goe_px4::height_by_range(sensor, _attitude_q, height_m)) {
            _heights.range_m = height_m;
            _range_us = sensor.timestamp;
        }
    }
    if (_home_sub.update(&home)) {
        _heights.has_home = goe_px4::home_down(home, _heights.home_down_m);
    }
}

void Goe::take_position() {
    goe_flight_position_t sample;
    if (!_local_position_sub.update(&_position)) {
        return;
    }
    _heights.has_range = _range_us != 0 && _position.timestamp < _range_us + RANGE_FRESH_US;
    if (goe_px4::position(_position, _heights, sample)) {
        (void)goe_flight_position(&_flight, &sample);
    }
}

/* ---------------------------------------------------------------------------------------------------------- images -- */

void Goe::take_features(uint32_t now_us) {
    goe_features_s topic;
    unsigned before = _features_sub.get_last_generation();
    while (_features_sub.update(&topic)) {
        const unsigned latest = _features_sub.get_last_generation();
        if (before != 0 && latest != before) {
            _images.note_lost(latest - before - 1u); /* the topic's queue was full */
        }
        before = latest;
        goe_px4::sighting(topic, _images.free_place());
        _images.keep(now_us);
    }
}

void Goe::take_tunnel(uint32_t now_us) {
    mavlink_tunnel_s topic;
    unsigned offset = 0;
    if (_tunnel_sub.update(&topic) && (_parameters.inputs & GOE_IN_TUNNEL) != 0 &&
        goe_px4::is_addressed(topic, _vehicle_status.system_id, _vehicle_status.component_id)) {
        while (goe_px4::next_of_tunnel(topic, offset, _images.free_place())) {
            _images.keep(now_us);
        }
    }
}

void Goe::take_landing_target(uint32_t now_us) {
    irlock_report_s topic;
    if (_landing_target_sub.update(&topic) && (_parameters.inputs & GOE_IN_LANDING_TARGET) != 0 &&
        goe_px4::sighting(topic, _used.estimator, whole_us(_parameters.target_delay_s), TARGET_DELAY_SD_US,
                          _images.free_place())) {
        _images.keep(now_us);
    }
}

void Goe::take_images() {
    const uint32_t now_us = goe_px4::time_us(hrt_absolute_time());
    take_features(now_us);
    take_tunnel(now_us);
    take_landing_target(now_us);
    _images.take(_flight, now_us);
}

/* ---------------------------------------------------------------------------------------------------------- answers -- */

void Goe::take_vehicle() {
    position_setpoint_triplet_s setpoint;
    vehicle_command_ack_s answer;
    (void)_vehicle_status_sub.update(&_vehicle_status);
    (void)_land_detected_sub.update(&_ground);
    (void)_landing_sub.update(&_landing);
    if (_setpoint_sub.update(&setpoint)) {
        _setpoint = setpoint.current;
    }
    while (_command_ack_sub.update(&answer)) {
        if (answer.target_system == _vehicle_status.system_id &&
            answer.target_component == _vehicle_status.component_id) { /* not of another sender's command */
            _orders.take(answer);
        }
    }
}

void Goe::publish_obstacles(uint64_t now_us) {
    uint8_t count = 0;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        if (goe_flight_obstacle(&_flight, slot, &found) != GOE_FLIGHT_OK || (found.valid & GOE_HAS_POSITION) == 0u) {
            continue;
        }
        const goe_obstacle_s topic = goe_px4::obstacle(_flight, found, slot, _assessment, now_us);
        (void)_obstacle_pub.publish(topic);
        _overview.obstacle[count++] = topic;
#ifdef GOE_HAS_DETECT_AND_AVOID
        if ((_parameters.outputs & GOE_OUT_DETECT_AND_AVOID) != 0) {
            const float own_ned_m[3] = {_position.x, _position.y, _position.z};
            (void)_detect_and_avoid_pub.publish(goe_px4::detect_and_avoid(
                found, slot, _assessment, own_ned_m, _used.flight.conflict_probability_max, now_us));
        }
#endif
    }
    _overview.obstacles = count;
}

void Goe::publish_distances(uint64_t now_us) {
    if ((_parameters.outputs & GOE_OUT_DISTANCES) != 0) {
        constexpr uint16_t MAX_CM = static_cast<uint16_t>(CM_PER_M * DISTANCE_MAX_M);
        (void)_obstacle_distance_pub.publish(goe_px4::distances(_flight, MAX_CM, now_us));
    }
}

void Goe::publish_status(uint64_t now_us) {
    goe_status_s topic{};
    const GoeImages::Delays delays = _images.delays(goe_px4::time_us(now_us));
    goe_px4::status(_flight, _assessment, topic);
    topic.timestamp = now_us;
    topic.self_check = _self_check;
    topic.settings_in_use = _in_use;
    topic.settings_waiting = _waiting;
    topic.dead_reckoning = _dead_reckoning;
    topic.flown = _assessment.action != GOE_FLIGHT_NONE && _orders.flown();
    topic.overruled = _orders.overruled();
    topic.overdue = _images.overdue();
    topic.commands_refused = _orders.refused();
    topic.delay_mean = delays.known ? delays.mean_ms : NAN;
    topic.delay_max = delays.known ? delays.max_ms : NAN;
    topic.image_rate = delays.rate_hz;
    (void)_status_pub.publish(topic);
    _overview.status = topic;
    _overview.north_m = _position.x;
    _overview.east_m = _position.y;
    _overview.react = _parameters.react;
    _overview.bad_field = _bad_field;
    _overview.phase = _phase;
}

bool Goe::is_armed() const { return _vehicle_status.arming_state == vehicle_status_s::ARMING_STATE_ARMED; }

bool Goe::is_followed(int slot, goe_flight_obstacle_t &obstacle) const {
    return goe_flight_obstacle(&_flight, slot, &obstacle) == GOE_FLIGHT_OK && (obstacle.valid & GOE_HAS_POSITION) != 0u;
}

/* By its outline and the margin. The aircraft turns during an order, so the course before counts. */
bool Goe::is_behind(const goe_flight_obstacle_t &obstacle) const {
    const float north_m = obstacle.center_ned_m[0] - _position.x;
    const float east_m = obstacle.center_ned_m[1] - _position.y;
    const float clear_m = obstacle.radius_m + _used.flight.margin_m;
    const float speed_m_s = sqrtf(_course_m_s[0] * _course_m_s[0] + _course_m_s[1] * _course_m_s[1]);
    return _course_m_s[0] * north_m + _course_m_s[1] * east_m < -clear_m * speed_m_s;
}

/* A slot in use gets another obstacle by an eviction alone: without one, another id is a new one of the same obstacle. */
void Goe::watch_obstacles(GoeOrders::Vehicle &vehicle) {
    const bool evicted = _flight.counters.evicted != _evicted;
    _evicted = _flight.counters.evicted;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t obstacle;
        const bool is_known = is_followed(slot, obstacle);
        const bool is_another = evicted && (obstacle.id == 0u || obstacle.id != _ids[slot]);
        const uint32_t bit = 1u << static_cast<unsigned>(slot);
        vehicle.gone |= !is_known || is_another ? bit : 0u;
        vehicle.behind |= is_known && is_behind(obstacle) ? bit : 0u;
        _ids[slot] = obstacle.id;
    }
}

void Goe::follow_orders(uint64_t now_us) {
    vehicle_command_s command;
    goe_flight_obstacle_t avoided;
    GoeOrders::Vehicle vehicle{};
    vehicle.armed = is_armed();
    vehicle.has_wings = has_wings();
    vehicle.lands = _setpoint.valid && _setpoint.type == position_setpoint_s::SETPOINT_TYPE_LAND;
    vehicle.setpoint_alt_m = _setpoint.alt;
    vehicle.nav_state = _vehicle_status.nav_state;
    vehicle.failsafe = _vehicle_status.failsafe && !_vehicle_status.failsafe_and_user_took_over;
    vehicle.origin_known = _flight.origin_known;
    vehicle.obstacle_known = is_followed(_orders.slot(), avoided);
    watch_obstacles(vehicle);
    vehicle.altitude_known = _position.z_global;
    vehicle.origin_alt_m = _position.ref_alt;
    vehicle.now_us = now_us;
    if (_orders.follow(_assessment, vehicle, _parameters.react, _parameters.resume != 0, command)) {
        command.target_system = command.source_system = _vehicle_status.system_id;
        command.target_component = _vehicle_status.component_id;
        command.source_component = _vehicle_status.component_id;
        (void)_command_pub.publish(command);
    }
}

/* Orders, once each; at most 50 characters go to a ground station. */
void Goe::report_operator() {
    if (_assessment.action == static_cast<goe_flight_action_t>(_reported_action)) {
        return;
    }
    _reported_action = static_cast<uint8_t>(_assessment.action);
    if (_assessment.action == GOE_FLIGHT_NONE) {
        mavlink_log_info(&_mavlink_log_pub, "goe: the order ends");
    } else {
        const char *const who = _orders.overruled() ? " (overruled)" : _orders.flown() ? "" : " (reported only)";
        mavlink_log_critical(&_mavlink_log_pub, "goe: obstacle in %.0f s, %s%s",
                             static_cast<double>(_assessment.hazard.tcpa_s), goe_flight_action_text(_assessment.action),
                             who);
    }
}

/* The filter of a fixed wing goes on by the airspeed when GPS is lost, and says so here alone. */
void Goe::report_dead_reckoning(uint64_t now_us) {
    const bool says_so = _position.xy_valid && _position.dead_reckoning;
    _dead_reckoning_us = says_so ? now_us : _dead_reckoning_us;
    const bool is_dead = says_so || (_dead_reckoning && now_us - _dead_reckoning_us < DEAD_RECKONING_US);
    if (is_dead == _dead_reckoning) {
        return;
    }
    _dead_reckoning = is_dead;
    if (is_dead) {
        mavlink_log_warning(&_mavlink_log_pub, "goe: position by dead reckoning");
    } else {
        mavlink_log_info(&_mavlink_log_pub, "goe: dead reckoning ends");
    }
}

/* A layer that cannot assess, as without a position after a reset of the heading, has not ended its order. The order stays,
 * and nothing is clear. */
void Goe::take_assessment(const goe_flight_assessment_t &assessment, goe_flight_status_t status, uint64_t now_us) {
    if (status != GOE_FLIGHT_OK) {
        _assessment.pose_alive = false;
        return;
    }
    _assessment = assessment;
    if (assessment.action == GOE_FLIGHT_NONE) {
        _course_m_s[0] = _position.vx;
        _course_m_s[1] = _position.vy;
    }
    follow_orders(now_us);
    report_operator();
}

void Goe::assess(uint64_t now_us) {
    goe_flight_assessment_t assessment;
    _assessed_us = now_us;
    _phase = goe_px4::phase(_setpoint, _ground, _landing, now_us);
    const goe_flight_status_t status = goe_flight_assess(&_flight, goe_px4::time_us(now_us), _phase, &assessment);
    if (status == GOE_FLIGHT_CORRUPTED) {
        mavlink_log_critical(&_mavlink_log_pub, "goe: memory was corrupted, restarted");
        _in_use = goe_flight_init(&_flight, sizeof _flight, &_used.estimator, &_used.flight, nullptr) == GOE_FLIGHT_OK;
    }
    take_assessment(assessment, status, now_us);
    report_dead_reckoning(now_us);
    pthread_mutex_lock(&_overview_lock);
    publish_obstacles(now_us);
    publish_status(now_us);
    pthread_mutex_unlock(&_overview_lock);
    publish_distances(now_us);
}

/* ------------------------------------------------------------------------------------------------------------ cycle -- */

void Goe::Run() {
    if (should_exit()) {
        leave();
        return;
    }
    perf_begin(_cycle_perf);
    take_vehicle();
    follow_parameters();
    take_attitude();
    take_heights();
    take_position();
    take_images();
    const uint64_t now_us = hrt_absolute_time();
    if (now_us >= _assessed_us + CYCLE_US || now_us < _assessed_us) {
        assess(now_us);
    }
    perf_end(_cycle_perf);
}

void Goe::leave() {
    _attitude_sub.unregisterCallback();
    _tunnel_sub.unregisterCallback();
    ScheduleClear();
#ifdef GOE_MODULE_DESCRIPTOR
    exit_and_cleanup(desc);
#else
    exit_and_cleanup();
#endif
}

/* --------------------------------------------------------------------------------------------------------- commands -- */

int Goe::task_spawn(int argc, char *argv[]) {
    Goe *const instance = new Goe();
    if (instance == nullptr) {
        PX4_ERR("alloc failed");
        return PX4_ERROR;
    }
#ifdef GOE_MODULE_DESCRIPTOR
    desc.object.store(instance);
    desc.task_id = task_id_is_work_queue;
#else
    _object.store(instance);
    _task_id = task_id_is_work_queue;
#endif
    if (instance->init()) {
        return PX4_OK;
    }
    delete instance;
#ifdef GOE_MODULE_DESCRIPTOR
    desc.object.store(nullptr);
    desc.task_id = -1;
#else
    _object.store(nullptr);
    _task_id = -1;
#endif
    return PX4_ERROR;
}

int Goe::print_status() {
    char line[GOE_TEXT_LINE];
    bool more = true;
    for (unsigned i = 0; more; i++) { /* line by line: a copy of all would be much for the stack of a shell's command */
        pthread_mutex_lock(&_overview_lock);
        more = goe_text_status(_overview, i, line);
        pthread_mutex_unlock(&_overview_lock);
        PX4_INFO_RAW("%s%s", line, more ? "\n" : "");
    }
    perf_print_counter(_cycle_perf);
    return 0;
}

int Goe::custom_command(int argc, char *argv[]) { return print_usage("unknown command"); }

int Goe::print_usage(const char *reason) {
    if (reason != nullptr) {
        PX4_WARN("%s\n", reason);
    }
    PRINT_MODULE_DESCRIPTION(
        "### Description\n"
        "Estimates the position and size of obstacles on the ground from the boxes of a camera's detector.\n"
        "Reports whether the present course leads too near to them, and the order that avoids them.\n"
        "Set the camera's parameters first: GOE_CAM_W, GOE_CAM_H, GOE_CAM_FX.\n");
    PRINT_MODULE_USAGE_NAME("goe", "estimator");
    PRINT_MODULE_USAGE_COMMAND("start");
    PRINT_MODULE_USAGE_DEFAULT_COMMANDS();
    return 0;
}

extern "C" __EXPORT int goe_main(int argc, char *argv[]) {
#ifdef GOE_MODULE_DESCRIPTOR
    return ModuleBase::main(Goe::desc, argc, argv);
#else
    return Goe::main(argc, argv);
#endif
}
