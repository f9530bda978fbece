/* The exponential. SPDX-License-Identifier: MIT */
#ifndef GOE_EXP_H
#define GOE_EXP_H

/* e^x to 1e-5 of itself up to +-6, and to 7e-4 up to +-16; x beyond counts as that. */
float goe_exp(float x);

#endif
