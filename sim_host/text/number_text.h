/* Numbers as text. SPDX-License-Identifier: MIT */
#ifndef NUMBER_TEXT_H
#define NUMBER_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The whole of text[0..length) as a decimal number, "nan" or "inf"; too large becomes infinite. text[length] must be 0.
 * False, and *value untouched, if it is anything else: empty, blanks around it, hexadecimal, a unit behind it. */
bool number_parse(const char *text, size_t length, double *value);

/* The same for a whole number without a fraction or exponent that fits 64 bits. */
bool integer_parse(const char *text, size_t length, int64_t *value);

/* The nearest float; infinite beyond float's range. */
float number_to_float(double value);

#define NUMBER_TEXT_MAX 24 /* bytes that number_format() needs */

/* Writes exactly what printf("%.9g") writes, so that a float survives the round trip, several times faster.
 * Returns the number of characters; no NUL is written. */
size_t number_format(char text[NUMBER_TEXT_MAX], float value);

#endif
