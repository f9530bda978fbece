/* The exponential. SPDX-License-Identifier: MIT */
#ifndef GOE_EXP_H
#define GOE_EXP_H

/* e^x to 1e-5 of itself for |x| <= 6, to 1e-3 for |x| <= 16; x beyond that counts as +-16. */
float goe_exp(float x);

#endif
