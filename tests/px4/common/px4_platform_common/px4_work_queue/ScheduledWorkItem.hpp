/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

namespace px4 {

struct wq_config_t {
    const char *name;
    uint16_t stacksize;
    int8_t relative_priority;
};

class WorkItem : public standin::Scheduled {
  public:
    void ScheduleNow() { schedule(); }

  protected:
    virtual void Run() = 0;

  private:
    void run_item() override { Run(); }
};

class ScheduledWorkItem : public WorkItem {
  public:
    void ScheduleOnInterval(uint32_t interval_us, uint32_t delay_us = 0) { schedule_every(interval_us + delay_us); }
    void ScheduleClear() { schedule_clear(); }

  protected:
    ScheduledWorkItem(const char *, const wq_config_t &) {}
};

} // namespace px4
