/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026; those of threads with public copies of other commits, on 24 Nov 2026. scripted.cpp implements them.
 * SPDX-License-Identifier: MIT */
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

/* In turns, no thread may wait for a lock: the running one releases its locks before its turn ends. */
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

/* signal() lets the waiting thread run until it waits again; or, for tests of parallel threads, from now on. */
class ScriptedBinarySemaphore {
  public:
    void signal();
    bool wait_blocking();
};

#define HAL_Semaphore ScriptedSemaphore
#define HAL_BinarySemaphore ScriptedBinarySemaphore
#define WITH_SEMAPHORE(semaphore) ScriptedHold scripted_hold(semaphore)
