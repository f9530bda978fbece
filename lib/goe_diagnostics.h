/* Check of the arithmetic, and names for logs. Included by goe.h. SPDX-License-Identifier: MIT */
#ifndef GOE_DIAGNOSTICS_H
#define GOE_DIAGNOSTICS_H

#ifndef GOE_H
#error "include goe.h, which includes this"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the short lower-case name of a status ("ok", "no_baseline"), never null. Any other number gives "unknown".
 * Cost: at most 1030 instructions, 32 bytes of stack. */
const char *goe_status_text(goe_status_t status);

/* Returns the short lower-case name of a reason ("moves", "none"), never null. Any other number gives "unknown".
 * Cost: at most 910 instructions, 32 bytes of stack. */
const char *goe_reason_text(goe_reason_t reason);

/* Checks the arithmetic of this machine under the flags that goe_self_check.c was compiled with. Compile all files of lib/ with
 * the same flags. Returns 0 if the arithmetic is the IEEE 754 single precision that bit identity needs. Otherwise it returns a
 * sum of GOE_SELF_...
 * Cost: at most 2500 instructions, 160 bytes of stack. */
unsigned goe_self_check(void);
#define GOE_SELF_CONTRACTED 0x01u   /* a*b + c is rounded once (fused): compile with -ffp-contract=off */
#define GOE_SELF_REASSOCIATED 0x02u /* sums or products are reordered: -ffast-math, -fassociative-math */
#define GOE_SELF_RECIPROCAL 0x04u   /* a/b is computed as a*(1/b): -freciprocal-math */
#define GOE_SELF_FLUSHED 0x08u      /* subnormal numbers become zero: FPSCR.FZ, FTZ/DAZ, -ffast-math at link time */
#define GOE_SELF_EXCESS 0x10u       /* intermediate results carry more than float's precision: x87 */
#define GOE_SELF_ROUNDING 0x20u     /* rounding is not to nearest even, or sqrtf is not correctly rounded */

#ifdef __cplusplus
}
#endif

#endif
