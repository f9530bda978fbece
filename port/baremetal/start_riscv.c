/* Start-up of a RISC-V image: stack, floating-point unit, memory, main. SPDX-License-Identifier: MIT */
#include <stdint.h>

#include "semihosting.h"

#define EXIT_FAULT 99 /* exit status of an image that met a trap */

extern uint32_t port_data_load[], port_data_start[], port_data_end[], port_bss_start[], port_bss_end[];

int main(void);
void port_entry(void);
void port_start(void);
void port_fault(void);

__attribute__((aligned(4))) void port_fault(void) {
    port_write_text("FAULT: trap\n");
    port_exit(EXIT_FAULT);
}

void port_start(void) {
    const uint32_t *load = port_data_load;
    if (load != port_data_start) {
        for (uint32_t *word = port_data_start; word < port_data_end; word++) {
            *word = *load++;
        }
    }
    for (uint32_t *word = port_bss_start; word < port_bss_end; word++) {
        *word = 0u;
    }
    port_exit(main());
}

/* The first instructions. mstatus.FS = 1 (0x2000) switches the floating-point unit on, fcsr = 0 rounds to nearest. */
__attribute__((naked, used, section(".vectors"))) void port_entry(void) {
    __asm__ volatile(".option arch, +zicsr\n"
                     ".option push\n"
                     ".option norelax\n"
                     "la gp, __global_pointer$\n"
                     ".option pop\n"
                     "la sp, port_stack_top\n"
                     "la t0, port_fault\n"
                     "csrw mtvec, t0\n"
#if defined(__riscv_flen)
                     "li t0, 0x2000\n"
                     "csrs mstatus, t0\n"
                     "csrw fcsr, zero\n"
#endif
                     "j port_start\n");
}
