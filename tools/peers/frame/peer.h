/* A solver, whoever's is linked, and the cases that it is given. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_H
#define GOE_PEER_H

#include "job.h" /* of the problem at hand: peer_case_t and peer_answer_t, floats alone; PEER_REPEATS */

#ifdef __cplusplus
extern "C" {
#endif

#define PEER_SLOTS 64 /* cases that are prepared at once: the most of a group */

/* Written by `bench peers`, group after group, so that each machine gets the same bits. */
extern const peer_case_t peer_cases[];
extern const int peer_first[]; /* case of each group, and the end of the last */
extern const int peer_groups;

/* Puts a case into the form in which the solver holds such things. Neither timed nor counted. */
void peer_prepare(int slot, const peer_case_t *given);

/* Solves what was prepared. */
void peer_solve(int slot);

/* Neither timed nor counted. */
void peer_answer(int slot, peer_answer_t *answer);

#ifdef __cplusplus
}
#endif

#endif
