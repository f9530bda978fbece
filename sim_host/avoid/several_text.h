/*
 * Flights among several obstacles: who flies which, and the tables of what came of them.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_SEVERAL_TEXT_H
#define SIM_SEVERAL_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "several.h"

/* Flight k of a campaign: geometry, delay, autopilot and how late its boxes are follow from k, everything else from the seed.
 * new_ids: see several_case_t. */
several_case_t several_case(int k, uint64_t seed, bool new_ids);

/* Flies so many, with seeds from first on, every step. lists: a line for every flight that misses a goal. Prints the tables by geometry,
 * number of obstacles, and delay, then the goals, then the figures of aviation.h. False: one could not be flown. *met: whether every goal
 * is met. */
bool several_campaign(int flights, uint64_t first, uint64_t step, bool lists, bool new_ids, bool *met);

#endif
