/* Functions built into the compiler but unknown to the analyzer, and all of <math.h> that the library uses. Frama-C's own declarations
 * put conditions on a root, because the root of a negative number is NaN; these do not. SPDX-License-Identifier: MIT */
#ifndef GOE_PROOF_BUILTINS_H
#define GOE_PROOF_BUILTINS_H

#define __FC_MATH /* Frama-C's own is used */

/*@ assigns \result \from x; */
float sqrtf(float x);

float proof_absolute(float x);
#define __builtin_fabsf proof_absolute

#endif
