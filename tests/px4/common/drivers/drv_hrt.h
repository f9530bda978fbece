/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

inline hrt_abstime hrt_absolute_time() { return standin::now_us(); }
