/* Proves that goe_self_check() detects changes of the library's bits. SPDX-License-Identifier: MIT
 *
 *   EXPECTED  the bits that it must report ...
 *   ALLOWED   ... and bits that it may report in addition; any other is a failure
 *   GOLDEN    if given, 0 is accepted instead, provided that the replay's hash is this one: a flag that this compiler does
 *             not use changes nothing
 *   MODE      change of the floating-point unit's mode before the check, see below */
#include "replay.h"

#define MODE_NONE 0
#define MODE_FLUSH 1 /* subnormal results and operands become zero */
#define MODE_UP 2    /* round towards plus infinity */
#define MODE_DOWN 3
#define MODE_TO_ZERO 4
#define MODE_FLUSH_OPERANDS 5 /* x86: operands alone */

#ifndef EXPECTED
#define EXPECTED 0u
#endif
#ifndef ALLOWED
#define ALLOWED 0u
#endif
#ifndef MODE
#define MODE MODE_NONE
#endif

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#endif

#if defined(__ARM_FP)
#define FPSCR_FZ (1u << 24)
#define FPSCR_ROUNDING_AT 22
static void set_mode(void) {
    static const unsigned rounding[] = {0u, 0u, 1u, 2u, 3u, 0u};
    unsigned fpscr;
    __asm__ volatile("vmrs %0, fpscr" : "=r"(fpscr));
    fpscr |= (MODE == MODE_FLUSH ? FPSCR_FZ : 0u) | (rounding[MODE] << FPSCR_ROUNDING_AT);
    __asm__ volatile("vmsr fpscr, %0" ::"r"(fpscr));
}
#elif defined(__riscv_flen)
static void set_mode(void) {
    static const unsigned rounding[] = {0u, 0u, 3u, 2u, 1u, 0u};
    __asm__ volatile("fsrm %0" ::"r"(rounding[MODE]));
}
#elif defined(__SSE__)
#include <xmmintrin.h>
#define MXCSR_FTZ 0x8000u
#define MXCSR_DAZ 0x0040u
#define MXCSR_ROUNDING_AT 13
static void set_mode(void) {
    static const unsigned rounding[] = {0u, 0u, 2u, 1u, 3u, 0u};
    const unsigned flush = MODE == MODE_FLUSH ? MXCSR_FTZ : MODE == MODE_FLUSH_OPERANDS ? MXCSR_DAZ : 0u;
    _mm_setcsr(_mm_getcsr() | flush | (rounding[MODE] << MXCSR_ROUNDING_AT));
}
#else
static void set_mode(void) {}
#endif

static void write_byte(unsigned byte) {
    static const char digits[] = "0123456789abcdef";
    const char text[] = {digits[(byte >> 4) & 0xFu], digits[byte & 0xFu], '\0'};
    port_write_text("0x");
    port_write_text(text);
}

#if defined(GOLDEN)
static bool bits_are_unchanged(void) {
    replay_t replay = replay_start();
    replay_all(&replay);
    return replay.hash == GOLDEN;
}
#else
static bool bits_are_unchanged(void) { return false; }
#endif

int main(void) {
    set_mode();
    const unsigned found = goe_self_check();
    const bool reported = (found & (EXPECTED)) == (EXPECTED) && (found & ~((EXPECTED) | (ALLOWED))) == 0u;
    const bool good = reported || (found == 0u && bits_are_unchanged());
    port_write_text("self_check ");
    write_byte(found);
    port_write_text(", expected ");
    write_byte(EXPECTED);
    port_write_text(reported ? "\n" : good ? ": unchanged bits\n" : ": FAILED\n");
    return good ? 0 : 1;
}
