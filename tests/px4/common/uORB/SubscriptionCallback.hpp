/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include <px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp>
#include <uORB/SubscriptionInterval.hpp>

namespace uORB {

class SubscriptionCallbackWorkItem : public SubscriptionInterval {
  public:
    SubscriptionCallbackWorkItem(px4::WorkItem *item, orb_id_t topic, uint8_t instance = 0)
        : SubscriptionInterval(topic, 0, instance), _item(item), _topic(topic), _instance(instance) {}
    bool registerCallback() {
        standin::on_publish(_topic, _instance, _item);
        return true;
    }
    void unregisterCallback() { standin::off_publish(_topic, _instance, _item); }

  private:
    px4::WorkItem *_item;
    orb_id_t _topic;
    uint8_t _instance;
};

} // namespace uORB
