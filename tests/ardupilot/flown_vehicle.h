/* AP_GOE in a vehicle that flies past the test scene's obstacle, and a reference flight layer that gets the same input
 * directly. SPDX-License-Identifier: MIT */
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <AP_Common/AP_Common.h>
#include <AP_HAL/AP_HAL.h>
#include <AP_Param/AP_Param.h>
#include <GCS_MAVLink/GCS_MAVLink.h>

#define private public // only the thread uses its flight layer
#include <AP_GOE.h>
#undef private

extern "C" {
#include "flown.h"
}
#include "scripted.h"

struct Parameter {
    const char *name;
    float value;
};

/* As in the firmware, objects begin as zeros. */
AP_GOE *new_goe();

/* Writes a parameter as a ground station does. */
void set_parameter(AP_GOE &goe, const char *name, float value);
float get_parameter(const AP_GOE &goe, const char *name);

/* A GOE_FEATURES as the parser of a link delivers it that does not know the message. */
mavlink_message_t features_message(const goe_mavlink_features_t &features, uint8_t system = 1);

class FlownVehicle {
  public:
    FlownVehicle();

    /* Advances by one sample: pose, update, and an image with every fifth one. Compares. */
    void step();
    void fly(double seconds);

    /* AP_GOE and the reference layer have the same state. */
    void compare();

    /* Restarts the reference layer with these parameters, as AP_GOE should have done. */
    void restart_layer();

    const goe_flight_t &flight() const { return goe->_state->flight; } // of the thread, which waits
    const goe_flight_assessment_t &seen() const { return goe->_state->shown.assessment; }

    AP_GOE *goe;
    goe_flight_t layer;
    goe_flight_assessment_t assessment; // the layer's latest one that did not fail
    flown_t flown;
    bool compares;
    bool steps_database{true};

    // the detector
    int delay;         // samples from exposure to arrival
    int ahead_us;      // error of the sender's clock
    bool sends;        // it is alive
    uint8_t copies;    // obstacles in the image, side by side
    uint64_t first_us; // of the vehicle's clock at sample 0
    Vector3f jump;     // of the position, from now on
    unsigned images;
    uint32_t compared; // number of the latest assessment that was compared

  private:
    struct Kept {
        goe_mavlink_features_t features;
        uint32_t arrival_us;
    };
    void take_sample();
    void send_image();
    void send(const goe_mavlink_features_t &features);
    void step_layer();
    bool take_layer_image(const Kept &kept);

    std::vector<Kept> waiting;
    uint32_t assessed_ms;
};
