/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct parameter_update_s {
    uint64_t timestamp;
};

STANDIN_TOPIC(parameter_update, 1)
