/* Check of the arithmetic, and names for logs. Included by goe.h. SPDX-License-Identifier: MIT */
#ifndef GOE_DIAGNOSTICS_H
#define GOE_DIAGNOSTICS_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A short lower-case name for a status ("ok", "no_baseline"), never null; "unknown" for any other number.
 * Cost: at most 1030 instructions, 32 bytes of stack. */
const char *goe_status_text(goe_status_t status);

/* The same for a reason: "moves", "late"; "none" for GOE_REASON_NONE.
 * Cost: at most 910 instructions, 32 bytes of stack. */
const char *goe_reason_text(goe_reason_t reason);

/* Checks the arithmetic of this machine, with the flags that goe_self_check.c was compiled with; compile all of lib/ with the
 * same. Returns 0 for the IEEE 754 single precision arithmetic that bit identity needs, otherwise a sum of GOE_SELF_...
 * Cost: at most 2500 instructions, 160 bytes of stack. */
unsigned goe_self_check(void);
#define GOE_SELF_CONTRACTED 0x01u   /* a*b + c is rounded once (fused): compile with -ffp-contract=off */
#define GOE_SELF_REASSOCIATED 0x02u /* sums or products are reordered: -ffast-math, -fassociative-math */
#define GOE_SELF_RECIPROCAL 0x04u   /* a/b is computed as a*(1/b): -freciprocal-math */
#define GOE_SELF_FLUSHED 0x08u      /* subnormal numbers become zero: FPSCR.FZ, FTZ/DAZ, -ffast-math at link time */
#define GOE_SELF_EXCESS 0x10u       /* intermediate results carry more than float's precision: x87 */
#define GOE_SELF_ROUNDING 0x20u     /* not round-to-nearest-even, or sqrtf is not correctly rounded */

#ifdef __cplusplus
}
#endif

#endif
