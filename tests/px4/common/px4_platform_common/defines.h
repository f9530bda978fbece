/* Stands in for PX4's: standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#define PX4_OK 0
#define PX4_ERROR (-1)
#define __EXPORT
