/* All of <string.h> that lib/ needs: WebAssembly copies and fills memory itself (memory.copy, memory.fill).
 * SPDX-License-Identifier: MIT */
#ifndef GOE_WASM_STRING_H
#define GOE_WASM_STRING_H

#include <stddef.h>

static inline void *memcpy(void *to, const void *from, size_t count) { return __builtin_memcpy(to, from, count); }
static inline void *memset(void *to, int byte, size_t count) { return __builtin_memset(to, byte, count); }

#endif
