/* Numbers as text. SPDX-License-Identifier: MIT */
#include "number_text.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DECIMAL 10

/* strtod() also takes leading blanks, hexadecimal and "nan(text)", which are slips in a table of measurements. */
static bool looks_decimal(const char *text, size_t length) {
    if (length == 0 || isspace((unsigned char)text[0]) || text[length - 1] == ')') {
        return false;
    }
    const char *digits = text + (text[0] == '+' || text[0] == '-' ? 1 : 0);
    return !(digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X'));
}

bool number_parse(const char *text, size_t length, double *value) {
    if (!looks_decimal(text, length)) {
        return false;
    }
    char *end = NULL;
    const double number = strtod(text, &end);
    if (end != text + length) {
        return false;
    }
    *value = number;
    return true;
}

bool integer_parse(const char *text, size_t length, int64_t *value) {
    if (!looks_decimal(text, length)) {
        return false;
    }
    char *end = NULL;
    errno = 0;
    const long long number = strtoll(text, &end, DECIMAL);
    if (end != text + length || errno == ERANGE) {
        return false;
    }
    *value = (int64_t)number;
    return true;
}

float number_to_float(double value) {
    if (value > (double)FLT_MAX) {
        return HUGE_VALF;
    }
    if (value < -(double)FLT_MAX) {
        return -HUGE_VALF;
    }
    return (float)value;
}

/* ---------------------------------------------------------------------------------------------------------- format -- */

/* %.9g of a float in exact integer arithmetic. A float is m 2^e with m < 2^24. Its 9 digits are m 2^e 10^p, rounded to
 * nearest even, p = 8 - (decimal exponent). With 10^p = 5^p 2^p the only product is m 5^p, below 2^52 for the p <= 12 of
 * the range below, and the rest is a shift: no step rounds but the last. */
#define FIXED_MIN 1.0e-4f /* the float below 1/10000; from there down %g turns to an exponent */
#define FIXED_MAX 9.99e8f /* above, likewise; a little less, so that rounding up cannot reach it */
#define DIGITS 9
#define DIGITS_END 1000000000u  /* first number of ten digits */
#define DIGITS_BEGIN 100000000u /* first number of nine digits */
#define MANTISSA_BITS 24
#define MAX_POWER 12

static const uint64_t power_of_five[MAX_POWER + 1] = {1,     5,      25,      125,     625,      3125,     15625,
                                                      78125, 390625, 1953125, 9765625, 48828125, 244140625};

/* magnitude 10^power to the nearest integer, ties to even. */
static uint64_t scaled(float magnitude, int power) {
    int exponent = 0;
    const float fraction = frexpf(magnitude, &exponent);
    const uint64_t product = (uint64_t)ldexpf(fraction, MANTISSA_BITS) * power_of_five[power];
    const int shift = MANTISSA_BITS - exponent - power;
    if (shift <= 0) {
        return product << -shift;
    }
    const uint64_t quotient = product >> shift;
    const uint64_t remainder = product & ((UINT64_C(1) << shift) - 1u);
    const uint64_t half = UINT64_C(1) << (shift - 1);
    return quotient + (remainder > half || (remainder == half && (quotient & 1u) != 0) ? 1u : 0u);
}

/* Decimal exponent of a number of the fixed range. A power of ten below 1 is no float: the nearest double above is
 * between the same two floats. */
static int decimal_exponent(float magnitude) {
    static const double power_of_ten[] = {1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
    int exponent = -4;
    while (exponent < DIGITS - 1 && (double)magnitude >= power_of_ten[exponent + 4]) {
        exponent++;
    }
    return exponent;
}

/* Nine digits with the decimal point where exponent puts it, closing zeros dropped. */
static size_t place_point(char *text, uint64_t number, int exponent) {
    char digits[DIGITS];
    int count = DIGITS;
    for (int i = DIGITS - 1; i >= 0; i--) {
        digits[i] = (char)('0' + (char)(number % DECIMAL));
        number /= DECIMAL;
    }
    while (count > 1 && digits[count - 1] == '0' && count - 1 > exponent) {
        count--;
    }
    char *out = text;
    if (exponent < 0) {
        static const char zeros[] = {'0', '.', '0', '0', '0', '0'};
        (void)memcpy(out, zeros, sizeof zeros);
        out += 1 - exponent;
        (void)memcpy(out, digits, (size_t)count);
        return (size_t)(out - text) + (size_t)count;
    }
    const int whole = exponent + 1;
    (void)memcpy(out, digits, (size_t)whole);
    out += whole;
    if (count > whole) {
        *out++ = '.';
        (void)memcpy(out, digits + whole, (size_t)(count - whole));
        out += count - whole;
    }
    return (size_t)(out - text);
}

size_t number_format(char text[NUMBER_TEXT_MAX], float value) {
    const float magnitude = fabsf(value);
    if (!(magnitude > FIXED_MIN && magnitude <= FIXED_MAX)) {
        const int length = snprintf(text, NUMBER_TEXT_MAX, "%.9g", (double)value);
        return length < 0 ? 0u : (size_t)length;
    }
    int exponent = decimal_exponent(magnitude);
    uint64_t number = scaled(magnitude, DIGITS - 1 - exponent);
    if (number >= DIGITS_END) { /* rounded up to the next power of ten */
        number = DIGITS_BEGIN;
        exponent++;
    }
    size_t sign = 0;
    if (value < 0.0f) {
        text[sign++] = '-';
    }
    return sign + place_point(text + sign, number, exponent);
}
