/* The rim of a footprint, by many points of it, in double. SPDX-License-Identifier: MIT */
#ifndef RIM_H
#define RIM_H

#include "refined/goe_filter.h"

/* How far the rim reaches from its middle along the unit vector (nx, nz), the state's axes, units of Z0. */
double rim_reach(const float state[GOE_STATES], double nx, double nz);

#endif
