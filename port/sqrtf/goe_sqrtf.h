/* A correctly rounded square root, for C libraries whose own is not. SPDX-License-Identifier: MIT
 *
 * The same bits everywhere, and a result of 0 by goe_self_check(), depend on a sqrtf that rounds correctly. Zephyr's minimal C library
 * and NuttX's own do not. README.md describes how to compile lib/ and port/flight/ with this one. */
#ifndef GOE_SQRTF_H
#define GOE_SQRTF_H

#ifdef __cplusplus
extern "C" {
#endif

/* 1: a processor's instruction is the root, as far as the compiler shows; without -fno-math-errno it may call sqrtf. */
#if defined(GOE_SQRTF_IN_INTEGERS) || !defined(__NO_MATH_ERRNO__)
#define GOE_SQRTF_IS_INSTRUCTION 0
#elif defined(__ARM_FP)
#define GOE_SQRTF_IS_INSTRUCTION ((__ARM_FP & 4) != 0)
#elif defined(__riscv_fsqrt) || defined(__SSE2__)
#define GOE_SQRTF_IS_INSTRUCTION 1
#else
#define GOE_SQRTF_IS_INSTRUCTION 0
#endif

/* As IEEE 754 requires, in round to nearest: NaN of NaN and of numbers below 0, -0 of -0, infinity of infinity. By the processor's
 * instruction where there is one; otherwise in integers, bit by bit: 124 bytes of code on a Cortex-M3 (gcc 12.2.1, -Os). */
float goe_sqrtf(float square);
#if GOE_SQRTF_IS_INSTRUCTION
extern inline __attribute__((gnu_inline, always_inline)) float goe_sqrtf(float square) {
    return __builtin_sqrtf(square);
}
#endif

#ifdef __cplusplus
}
#endif

#endif
