/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. What happens behind them is in scripted.h. SPDX-License-Identifier: MIT */
#pragma once

#include <cstdint>

#define AP_ARMING_AUX_AUTH_ENABLED 1

class AP_Arming {
  public:
    bool is_armed() const;
    bool get_aux_auth_id(uint8_t &id);
    void set_aux_auth_passed(uint8_t id);
    void set_aux_auth_failed(uint8_t id, const char *why);
};

namespace AP {
AP_Arming &arming();
}
