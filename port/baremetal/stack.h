/* Measures the stack depth by the rest of a painted pattern. SPDX-License-Identifier: MIT */
#ifndef GOE_PORT_STACK_H
#define GOE_PORT_STACK_H

#include <stddef.h>
#include <stdint.h>

#define PORT_STACK_PAINT 0xA5A5A5A5u

extern uint32_t port_stack_bottom[]; /* lowest word, from the linker script */

__attribute__((always_inline)) static inline volatile uint32_t *port_stack_pointer(void) {
    volatile uint32_t *pointer;
#if defined(__arm__)
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
#else
    __asm__ volatile("mv %0, sp" : "=r"(pointer));
#endif
    return pointer;
}

/* Paints all that lies below the caller's frame. */
__attribute__((always_inline)) static inline void port_stack_paint(void) {
    volatile uint32_t *const end = port_stack_pointer();
    for (volatile uint32_t *word = port_stack_bottom; word < end; word++) {
        *word = PORT_STACK_PAINT;
    }
}

/* Bytes below the caller's frame that were written since. */
__attribute__((always_inline)) static inline size_t port_stack_used(void) {
    volatile uint32_t *const end = port_stack_pointer();
    volatile uint32_t *word = port_stack_bottom;
    while (word < end && *word == PORT_STACK_PAINT) {
        word++;
    }
    return (size_t)((uintptr_t)end - (uintptr_t)word);
}

#endif
