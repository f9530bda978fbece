/* Start-up of a Cortex-M image: vectors, floating-point unit, memory, main. SPDX-License-Identifier: MIT */
#include <stdint.h>

#include "semihosting.h"

#define CPACR (*(volatile uint32_t *)0xE000ED88u) /* coprocessor access control */
#define CPACR_FPU_FULL (0xFu << 20)               /* CP10 and CP11; on an M55 this enables Helium too */
#define EXIT_FAULT 99                             /* exit status of an image that met an exception */

extern uint32_t port_data_load[], port_data_start[], port_data_end[], port_bss_start[], port_bss_end[];
extern uint32_t port_stack_top[];

int main(void);
void port_start(void);
void port_fault(void);

/* One answer to every exception: none is expected. */
void port_fault(void) {
    port_write_text("FAULT: exception\n");
    port_exit(EXIT_FAULT);
}

void port_start(void) {
#if defined(__ARM_FP)
    CPACR |= CPACR_FPU_FULL;
    __asm__ volatile("dsb\n isb" ::: "memory");
#endif
    const uint32_t *load = port_data_load;
    for (uint32_t *word = port_data_start; word < port_data_end; word++) {
        *word = *load++;
    }
    for (uint32_t *word = port_bss_start; word < port_bss_end; word++) {
        *word = 0u;
    }
    port_exit(main());
}

typedef union {
    void *stack;
    void (*handler)(void);
} vector_t;

/* Initial stack, reset, and the fourteen exceptions of the architecture; no interrupt is ever enabled. */
__attribute__((section(".vectors"), used)) static const vector_t vectors[16] = {
    {.stack = port_stack_top}, {.handler = port_start}, {.handler = port_fault}, {.handler = port_fault},
    {.handler = port_fault},   {.handler = port_fault}, {.handler = port_fault}, {.handler = port_fault},
    {.handler = port_fault},   {.handler = port_fault}, {.handler = port_fault}, {.handler = port_fault},
    {.handler = port_fault},   {.handler = port_fault}, {.handler = port_fault}, {.handler = port_fault},
};
