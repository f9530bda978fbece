/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. What happens behind them is in scripted.h. SPDX-License-Identifier: MIT */
#pragma once

#include <cstddef>
#include <cstdint>

#include "AP_HAL_Boards.h"

namespace AP_HAL {

class Util {
  public:
    int snprintf(char *text, size_t size, const char *format, ...);
};

class HAL {
  public:
    Util *util;
};

uint32_t micros();
uint64_t micros64();
uint32_t millis();

} // namespace AP_HAL
