/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include <uORB/Subscription.hpp>

namespace uORB {

class SubscriptionInterval {
  public:
    SubscriptionInterval(orb_id_t topic, uint32_t interval_us = 0, uint8_t instance = 0)
        : _subscription(topic, instance), _interval_us(interval_us) {}
    bool update(void *data) {
        const uint64_t now_us = standin::now_us();
        if ((_interval_us > 0 && now_us - _last_us < _interval_us) || !_subscription.update(data)) {
            return false;
        }
        _last_us = now_us;
        return true;
    }

  private:
    Subscription _subscription;
    uint32_t _interval_us;
    uint64_t _last_us{0};
};

} // namespace uORB
