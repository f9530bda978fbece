/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

namespace uORB {

template <typename T> class Publication {
  public:
    explicit Publication(orb_id_t topic) : _topic(topic) {}
    bool publish(const T &data) {
        standin::publish(_topic, &data);
        return true;
    }

  private:
    orb_id_t _topic;
};

} // namespace uORB
