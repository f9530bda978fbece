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

// Stack of the thread, bytes. The layer's deepest call takes 3,130, by gcc's call graph for a Cortex-M7; the rest is for the
// thread's own frames, for interrupts, and a reserve.
#ifndef AP_GOE_STACK
#define AP_GOE_STACK 5120
#endif

// Constants that are not parameters. All have the layer's or the library's defaults except the drift, which is EKF3's: its heading
// wanders by a degree or two after take-off; assumed constant, this makes obstacles narrow. Degrees per square root of a second.
#ifndef AP_GOE_ATTITUDE_DRIFT
#define AP_GOE_ATTITUDE_DRIFT 0.3f
#endif
