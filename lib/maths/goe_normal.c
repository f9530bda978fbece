/* The normal distribution function. SPDX-License-Identifier: MIT */
#include "maths/goe_normal.h"

#include "goe.h" /* defines the parts */

#if GOE_WITH_HAZARD
#include "maths/goe_scalar.h"

/* Minimax polynomial made by `python -m bench minimax`. The upper tail is N(x)^-8, N = N1 + x (N2 + x (N3 + ...)), on 0 <= x <= 5.2, with
 * an error of 2.0e-7. The eighth power needs no exponential, and falls off as fast as the tail. */
#define NORMAL_1 1.09050768f
#define NORMAL_2 0.10876589f
#define NORMAL_3 0.0487788176f
#define NORMAL_4 0.00958711073f
#define NORMAL_5 0.000712073266f
#define NORMAL_6 0.0004315155f
#define NORMAL_7 3.85143606e-05f
#define NORMAL_8 1.60038211e-05f
#define TAIL_END 5.2f /* the tail beyond it is 1e-7 */

float goe_normal_below(float x) {
    const float t = goe_absolute(x);
    if (t > TAIL_END) {
        return x < 0.0f ? 0.0f : 1.0f;
    }
    const float n =
        NORMAL_1 +
        t * (NORMAL_2 +
             t * (NORMAL_3 + t * (NORMAL_4 + t * (NORMAL_5 + t * (NORMAL_6 + t * (t * NORMAL_8 - NORMAL_7))))));
    const float n2 = n * n;
    const float n4 = n2 * n2;
    const float tail = 1.0f / (n4 * n4);
    return x < 0.0f ? tail : 1.0f - tail;
}

#endif
