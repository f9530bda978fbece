/* What the compiler has built in and the analyser has not, and all of <math.h> that the library takes: without the conditions that
 * Frama-C's own puts on a root, as that of a negative number is no number, and nothing else. SPDX-License-Identifier: MIT */
#ifndef GOE_PROOF_BUILTINS_H
#define GOE_PROOF_BUILTINS_H

#define __FC_MATH /* Frama-C's own is there */

/*@ assigns \result \from x; */
float sqrtf(float x);

float proof_absolute(float x);
#define __builtin_fabsf proof_absolute

#endif
