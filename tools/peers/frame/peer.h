/* The linked solver, and its cases. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_H
#define GOE_PEER_H

#include "job.h" /* of the problem: peer_case_t and peer_answer_t, floats only; PEER_REPEATS */

#ifdef __cplusplus
extern "C" {
#endif

#define PEER_SLOTS 64 /* cases prepared at once: largest size of a group */

/* Written by `bench peers`, group after group; each machine gets the same bits. */
extern const peer_case_t peer_cases[];
extern const int peer_first[]; /* case of each group, and the end of the last */
extern const int peer_groups;

/* Converts a case to the solver's form. Neither timed nor counted. */
void peer_prepare(int slot, const peer_case_t *given);

/* Solves a prepared case. */
void peer_solve(int slot);

/* Neither timed nor counted. */
void peer_answer(int slot, peer_answer_t *answer);

#ifdef __cplusplus
}
#endif

#endif
