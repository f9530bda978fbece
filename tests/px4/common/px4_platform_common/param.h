/* A stand-in for PX4's header: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include <parameters/px4_parameters.hpp>

using param_t = uint16_t;

inline param_t param_handle(px4::params parameter) { return static_cast<param_t>(parameter); }
void param_set_used(param_t parameter);
/* PX4 logs a wrong type; here it ends the test. */
int param_get(param_t parameter, float *value);
int param_get(param_t parameter, int32_t *value);
/* Parameters of other modules, by name: see standin::set_other(). */
constexpr param_t PARAM_INVALID = 0xFFFF;
param_t param_find(const char *name);
