/* Stands in for PX4's: standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

inline hrt_abstime hrt_absolute_time() { return standin::now_us(); }
