/* All of <math.h> that lib/ may ask for: embedded C libraries have as little as this. SPDX-License-Identifier: MIT */
#ifndef POOR_MATH_H
#define POOR_MATH_H

float sqrtf(float square);

#endif
