/* The exponential. SPDX-License-Identifier: MIT */
#ifndef GOE_EXP_H
#define GOE_EXP_H

/* e^x to 1e-5 of itself; x beyond +-16 counts as that. */
float goe_exp(float x);

#endif
