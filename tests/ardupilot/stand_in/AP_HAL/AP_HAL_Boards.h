/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#define HAL_BOARD_SITL 3
#define CONFIG_HAL_BOARD HAL_BOARD_SITL
#define HAL_PROGRAM_SIZE_LIMIT_KB 2048
#define HAL_GCS_ENABLED 1
#define HAL_LOGGING_ENABLED 1
