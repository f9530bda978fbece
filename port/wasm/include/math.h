/* All of <math.h> that lib/ needs: one instruction, correctly rounded by WebAssembly's own rules. SPDX-License-Identifier: MIT */
#ifndef GOE_WASM_MATH_H
#define GOE_WASM_MATH_H

static inline float sqrtf(float square) { return __builtin_sqrtf(square); }

#endif
