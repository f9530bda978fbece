/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

namespace uORB {

class Subscription {
  public:
    Subscription(orb_id_t topic, uint8_t instance = 0)
        : _topic(topic), _instance(instance), _generation(standin::first_generation(topic, instance)) {}
    unsigned get_last_generation() const { return _generation; }
    bool update(void *data) { return standin::copy(_topic, _instance, _generation, data); }

  private:
    orb_id_t _topic;
    uint8_t _instance;
    unsigned _generation;
};

} // namespace uORB
