/* The exponential function. SPDX-License-Identifier: MIT */
#ifndef GOE_EXP_H
#define GOE_EXP_H

/* e^x with a relative error of 1e-5 for |x| <= 6, of 1e-3 for |x| <= 16; x beyond that counts as +-16. */
float goe_exp(float x);

#endif
