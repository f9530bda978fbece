/* Semihosting: text out, exit status. SPDX-License-Identifier: MIT */
#include "semihosting.h"

#include <stdbool.h>
#include <stdint.h>

/* operations of "Semihosting for AArch32 and AArch64", which "RISC-V Semihosting" shares */
#define SYS_WRITEC 0x03u
#define SYS_WRITE0 0x04u
#define SYS_EXIT_EXTENDED 0x20u
#define ADP_STOPPED_APPLICATION_EXIT 0x20026u

#if defined(__arm__)
static void ask(uintptr_t operation, const void *argument) {
    register uintptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}
#elif defined(__riscv)
/* The three instructions together are the call; they must not be compressed and must lie in one page. */
__attribute__((noinline)) static void ask(uintptr_t operation, const void *argument) {
    register uintptr_t a0 __asm__("a0") = operation;
    register const void *a1 __asm__("a1") = argument;
    __asm__ volatile(".option push\n"
                     ".option norvc\n"
                     ".balign 16\n"
                     "slli zero, zero, 0x1f\n"
                     "ebreak\n"
                     "srai zero, zero, 7\n"
                     ".option pop\n"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
}
#else
#error "unknown architecture"
#endif

void port_write_text(const char *text) { ask(SYS_WRITE0, text); }

void port_write_char(char character) { ask(SYS_WRITEC, &character); }

void port_exit(int status) {
    const uintptr_t block[2] = {ADP_STOPPED_APPLICATION_EXIT, (uintptr_t)status};
    while (true) {
        ask(SYS_EXIT_EXTENDED, block);
    }
}
