/*
 * Values after a word on the command line: "box:15,40,89".
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_TEXT_NUMBERS_H
#define SIM_TEXT_NUMBERS_H

#include <stdbool.h>

/* True if text is the prefix and then exactly count finite numbers with commas between them. */
bool text_numbers(const char *text, const char *prefix, double *values, int count);

#endif
