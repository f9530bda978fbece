/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026; those of threads with public copies of other commits, on 24 Nov 2026. What happens behind them is
 * in scripted.h. SPDX-License-Identifier: MIT */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>

#include "AP_HAL_Boards.h"

namespace AP_HAL {

class Util {
  public:
    int snprintf(char *text, size_t size, const char *format, ...);
};

typedef std::function<void()> MemberProc;

class Scheduler {
  public:
    enum priority_base { PRIORITY_IO };
    bool thread_create(MemberProc proc, const char *name, uint32_t stack_size, priority_base base, int8_t priority);
};

class HAL {
  public:
    Scheduler *scheduler;
    Util *util;
};

uint32_t micros();
uint64_t micros64();
uint32_t millis();

} // namespace AP_HAL

#define FUNCTOR_BIND_MEMBER(method, result) ([this]() { (this->*method)(); })

/* In turns nobody may wait for one: who has the turn gives back what it takes before it ends. */
class ScriptedSemaphore {
  public:
    void take();
    void give();

  private:
    std::mutex _mutex;
};

class ScriptedHold {
  public:
    explicit ScriptedHold(ScriptedSemaphore &semaphore) : _semaphore(semaphore) { _semaphore.take(); }
    ~ScriptedHold() { _semaphore.give(); }

  private:
    ScriptedSemaphore &_semaphore;
};

/* signal() lets the thread that waits run until it waits again; or, if the test wants both to run at once, from now on. */
class ScriptedBinarySemaphore {
  public:
    void signal();
    bool wait_blocking();
};

#define HAL_Semaphore ScriptedSemaphore
#define HAL_BinarySemaphore ScriptedBinarySemaphore
#define WITH_SEMAPHORE(semaphore) ScriptedHold scripted_hold(semaphore)
