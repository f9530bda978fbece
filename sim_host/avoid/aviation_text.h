/*
 * The figures of aviation.h as tables: of all flights, and of those with one, two, and three or more obstacles.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_AVIATION_TEXT_H
#define SIM_AVIATION_TEXT_H

#include "aviation.h"

/* scratch has a place for every flight. */
void aviation_text_tables(const aviation_flight_t *flight, int flights, double *scratch);

#endif
