/* A correctly rounded square root, for C libraries whose own is not. SPDX-License-Identifier: MIT
 *
 * The same bits everywhere, and an answer of 0 by goe_self_check(), rest on a sqrtf that rounds correctly. Zephyr's minimal C library
 * and NuttX's own do not. Compile lib/ and port/flight/ with -Dsqrtf=goe_sqrtf, and goe_sqrtf.c with them. */
#ifndef GOE_SQRTF_H
#define GOE_SQRTF_H

/* As IEEE 754 asks, in round to nearest: NaN of NaN and of numbers below 0, -0 of -0, infinity of infinity. By the processor's
 * instruction where the compiler says that there is one (compile with -fno-math-errno), otherwise in integers, bit
 * by bit: 172 bytes of code on a Cortex-M3 (gcc 12.2.1, -Os). */
float goe_sqrtf(float square);

#endif
