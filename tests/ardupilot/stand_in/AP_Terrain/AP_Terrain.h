/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#define AP_TERRAIN_AVAILABLE 1

class AP_Terrain {
  public:
    bool height_above_terrain(float &height, bool extrapolate = false);
};

namespace AP {
AP_Terrain *terrain();
}
