/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

#define mavlink_log_info(advert, ...) (static_cast<void>(advert), standin::mavlink_text(__VA_ARGS__))
#define mavlink_log_warning(advert, ...) (static_cast<void>(advert), standin::mavlink_text(__VA_ARGS__))
#define mavlink_log_critical(advert, ...) (static_cast<void>(advert), standin::mavlink_text(__VA_ARGS__))
