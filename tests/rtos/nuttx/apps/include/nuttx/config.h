/* A stand-in for nuttx/config.h: the output of Kconfig, if a test has run it. SPDX-License-Identifier: MIT */
#ifndef STAND_IN_NUTTX_CONFIG_H
#define STAND_IN_NUTTX_CONFIG_H

#if __has_include("autoconf.h")
#include "autoconf.h"
#endif

#endif
