/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#define PX4_OK 0
#define PX4_ERROR (-1)
#define __EXPORT
