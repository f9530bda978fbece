/* A flight of tests/flight/flown.h as PX4's topics, the module on the stand-in's work queue, and a reference flight layer that gets the
 * same input directly. SPDX-License-Identifier: MIT */
#pragma once

#include <cmath>
#include <cstring>

extern "C" {
#include "flown.h"
}

#include "GoeConversion.hpp"
#include "GoeParameters.hpp"
#include "standin.hpp"

#include <px4_platform_common/param.h>

#include <uORB/topics/vehicle_command.h>
#include <uORB/topics/vehicle_command_ack.h>
#include <uORB/topics/vehicle_status.h>

extern "C" int goe_main(int argc, char *argv[]);

constexpr uint64_t STEP_US = 1000000 / FLOWN_POSE_HZ;

/* "goe <word>". */
int goe_command(const char *word);

class Px4Flight {
  public:
    /* Sets the camera's parameters and starts the module. clock_us: of the first sample. */
    void begin(uint64_t clock_us = 5000000u, bool set_camera = true);
    void end();

    /* Advances by one sample: 20 ms, and the image of 100 ms ago if one was taken then. */
    void step();
    void fly(double seconds);

    void publish_pose();                            /* of the present sample, at the present time */
    void publish_image(int k, uint64_t capture_us); /* of sample k */
    goe_features_s features_of(int k) const;
    void set_mode(bool armed, uint8_t nav_state);
    bool has_wings{true};
    uint8_t system{1};                           /* 0: the vehicle does not know its number yet */
    bool failsafe{false}, user_took_over{false}; /* as set_mode() reports them */

    goe_status_s status() const;
    bool obstacle(goe_obstacle_s &topic) const; /* the latest one */
    uint64_t time_of(int k) const { return _start_us + STEP_US * static_cast<uint64_t>(k); }

    flown_t flown;
    goe_flight_t reference; /* false: the test publishes this itself */
    bool sends_pose{true}, sends_images{true}, in_step{true};
    bool sends_position{true}; /* false: attitudes alone */
    bool follows{true};        /* the reference runs, and is compared at each status */
    vehicle_local_position_s position{};
    uint8_t quat_reset_counter{0};
    unsigned compared{0}; /* obstacles */

  private:
    void follow_status();
    void compare(const goe_flight_assessment_t &assessment, const goe_status_s &topic);

    uint64_t _start_us;
    unsigned _statuses, _obstacles;
    goe_flight_assessment_t _assessment; /* the reference's latest one that did not fail */
};
