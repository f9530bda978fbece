/* The exponential function. SPDX-License-Identifier: MIT */
#include "maths/goe_exp.h"

#define ARGUMENT_MAX 16.0f
#define DOUBLINGS 6 /* e^x = (e^(x/64))^64: for x/64 the series is short */

float goe_exp(float x) {
    const float bounded = x > ARGUMENT_MAX ? ARGUMENT_MAX : (x > -ARGUMENT_MAX ? x : -ARGUMENT_MAX);
    const float y = bounded * (1.0f / (float)(1u << DOUBLINGS));
    float power = 1.0f + y * (1.0f + y * (0.5f + y * (1.0f / 6.0f + y * (1.0f / 24.0f))));
    for (int i = 0; i < DOUBLINGS; i++) {
        power *= power;
    }
    return power;
}
