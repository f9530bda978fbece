/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

#define PX4_INFO_RAW(...) standin::print(__VA_ARGS__)
#define PX4_INFO(...) (standin::print("INFO "), standin::print(__VA_ARGS__), standin::print("\n"))
#define PX4_WARN(...) (standin::print("WARN "), standin::print(__VA_ARGS__), standin::print("\n"))
#define PX4_ERR(...) (standin::print("ERROR "), standin::print(__VA_ARGS__), standin::print("\n"))
