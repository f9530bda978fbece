/* Feature switch of AP_GOE. SPDX-License-Identifier: MIT */
#pragma once

#include <AP_HAL/AP_HAL_Boards.h>

#ifndef AP_GOE_ENABLED
#ifdef HAL_BUILD_AP_PERIPH
#define AP_GOE_ENABLED 0
#else
#define AP_GOE_ENABLED (HAL_PROGRAM_SIZE_LIMIT_KB > 1024)
#endif
#endif
