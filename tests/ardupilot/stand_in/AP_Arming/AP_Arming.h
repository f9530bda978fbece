/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

class AP_Arming {
  public:
    bool is_armed() const;
};

namespace AP {
AP_Arming &arming();
}
