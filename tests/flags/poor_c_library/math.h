/* All of <math.h> that lib/ may use: some embedded C libraries have only this much. SPDX-License-Identifier: MIT */
#ifndef POOR_MATH_H
#define POOR_MATH_H

float sqrtf(float square);

#endif
