/* The module goe of PX4: obstacles on the ground from the boxes of a camera's detector. SPDX-License-Identifier: MIT
 *
 *   vehicle_attitude (callback) ----.
 *   vehicle_local_position ---------+--> GoeConversion --> goe_flight_t --> goe_obstacle, goe_status, obstacle_distance
 *   distance_sensor, home_position -'                          ^    '-----> GoeOrders --> vehicle_command (GOE_REACT)
 *   goe_features, mavlink_tunnel, irlock_report --> GoeImages -'
 *
 * It runs on a work queue of its own: the estimator's frames are deeper than those of PX4's shared queues allow in all its
 * versions. */
#pragma once

#include <drivers/drv_hrt.h>
#include <lib/perf/perf_counter.h>
#include <pthread.h>
#include <px4_platform_common/defines.h>
#include <px4_platform_common/module.h>
#include <px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp>
#include <systemlib/mavlink_log.h>
#include <uORB/Publication.hpp>
#include <uORB/Subscription.hpp>
#include <uORB/SubscriptionCallback.hpp>
#include <uORB/SubscriptionInterval.hpp>
#include <uORB/topics/parameter_update.h>

#include "GoeConversion.hpp"
#include "GoeImages.hpp"
#include "GoeOrders.hpp"
#include "GoeParameters.hpp"
#include "GoeText.hpp"

#ifdef GOE_MODULE_DESCRIPTOR
using GoeModuleBase = ModuleBase;
#else
class Goe;
using GoeModuleBase = ModuleBase<Goe>;
#endif

class Goe final : public GoeModuleBase, public px4::ScheduledWorkItem {
  public:
#ifdef GOE_MODULE_DESCRIPTOR
    static Descriptor desc;
#endif

    Goe();
    ~Goe() override;

    static int task_spawn(int argc, char *argv[]);
    static int custom_command(int argc, char *argv[]);
    static int print_usage(const char *reason = nullptr);

    bool init();
    int print_status() override;

  private:
    static constexpr int DISTANCE_SENSORS = 4;

    void Run() override;
    void leave();

    bool is_armed() const;
    bool has_wings() const;
    void read_parameters();
    bool is_followed(int slot, goe_flight_obstacle_t &obstacle) const;
    bool is_behind(const goe_flight_obstacle_t &obstacle) const;
    void watch_obstacles(GoeOrders::Vehicle &vehicle);
    void follow_parameters();
    void use_parameters();
    void take_attitude();
    void take_heights();
    void take_position();
    void take_images();
    void take_features(uint32_t now_us);
    void take_tunnel(uint32_t now_us);
    void take_landing_target(uint32_t now_us);
    void take_vehicle();
    void assess(uint64_t now_us);
    void take_assessment(const goe_flight_assessment_t &assessment, goe_flight_status_t status, uint64_t now_us);
    void publish_obstacles(uint64_t now_us);
    void publish_distances(uint64_t now_us);
    void publish_status(uint64_t now_us);
    void follow_orders(uint64_t now_us);
    void report_operator();
    void report_dead_reckoning(uint64_t now_us);

    uORB::SubscriptionCallbackWorkItem _attitude_sub{this, ORB_ID(vehicle_attitude)};
    uORB::SubscriptionCallbackWorkItem _tunnel_sub{this, ORB_ID(mavlink_tunnel)};
    uORB::SubscriptionInterval _parameter_update_sub{ORB_ID(parameter_update), 1000000};
    uORB::Subscription _features_sub{ORB_ID(goe_features)};
    uORB::Subscription _landing_target_sub{ORB_ID(irlock_report)};
    uORB::Subscription _local_position_sub{ORB_ID(vehicle_local_position)};
    uORB::Subscription _distance_sensor_sub[DISTANCE_SENSORS]{{ORB_ID(distance_sensor), 0},
                                                              {ORB_ID(distance_sensor), 1},
                                                              {ORB_ID(distance_sensor), 2},
                                                              {ORB_ID(distance_sensor), 3}};
    uORB::Subscription _home_sub{ORB_ID(home_position)};
    uORB::Subscription _setpoint_sub{ORB_ID(position_setpoint_triplet)};
    uORB::Subscription _land_detected_sub{ORB_ID(vehicle_land_detected)};
    uORB::Subscription _landing_sub{ORB_ID(position_controller_landing_status)};
    uORB::Subscription _vehicle_status_sub{ORB_ID(vehicle_status)};
    uORB::Subscription _command_ack_sub{ORB_ID(vehicle_command_ack)};

    uORB::Publication<goe_obstacle_s> _obstacle_pub{ORB_ID(goe_obstacle)};
    uORB::Publication<goe_status_s> _status_pub{ORB_ID(goe_status)};
    uORB::Publication<obstacle_distance_s> _obstacle_distance_pub{ORB_ID(obstacle_distance)};
    uORB::Publication<vehicle_command_s> _command_pub{ORB_ID(vehicle_command)};
#ifdef GOE_HAS_DETECT_AND_AVOID
    uORB::Publication<detect_and_avoid_s> _detect_and_avoid_pub{ORB_ID(detect_and_avoid)};
#endif
    orb_advert_t _mavlink_log_pub{nullptr};

    GoeParameters _parameters{};     /* as PX4 has them */
    bool _in_use{false};             /* the layer runs with some ... */
    GoeParameters _used{};           /* ... which are these, for what the layer holds */
    bool _had_wings{false};          /* when they were read */
    bool _waiting{false};            /* _parameters differ, and wait for the end of the tracks */
    const char *_bad_field{nullptr}; /* of the parameters that were refused */

    goe_flight_t _flight{};
    goe_flight_assessment_t _assessment; /* the latest one that did not fail; pose_alive is false since one did */
    GoeImages _images;
    GoeOrders _orders;
    uint32_t _ids[GOE_FLIGHT_SLOTS]{}; /* of the obstacles, at the assessment before */
    uint16_t _evicted{0};              /* the layer's count, then */
    float _course_m_s[2]{};            /* velocity at the latest assessment without an order */
    goe_px4::Heights _heights{};
    uint64_t _range_us{0}; /* of the height by a distance sensor */
    float _attitude_q[4]{1.f, 0.f, 0.f, 0.f};
    vehicle_local_position_s _position{};
    vehicle_status_s _vehicle_status{};
    position_setpoint_s _setpoint{}; /* the present one */
    vehicle_land_detected_s _ground{};
    position_controller_landing_status_s _landing{};
    uint8_t _phase{GOE_FLIGHT_FLYING};
    uint8_t _self_check{0};
    uint64_t _assessed_us{0};
    uint8_t _reported_action{GOE_FLIGHT_NONE};
    bool _dead_reckoning{false};
    uint64_t _dead_reckoning_us{0}; /* when PX4 last said so */
    GoeOverview _overview{};        /* for `goe status`: written and read under the lock */
    pthread_mutex_t _overview_lock;
    perf_counter_t _cycle_perf{perf_alloc(PC_ELAPSED, MODULE_NAME ": cycle")};
};
