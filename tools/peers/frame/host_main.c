/* Times one solver on the host. Prints the answer to each case, then for each group:
 *   picoseconds <per solve>
 * SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 199309L
#include <time.h>

#include "console.h"

#define ROUNDS_LEAST 20 /* in case the process is suspended for long */

static double seconds(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1.0e-9 * (double)now.tv_nsec;
}

/* Seconds for solving a group once; without cases: the cost of reading the clock. */
static double time_round(int first, int count) {
    for (int i = 0; i < count; i++) {
        peer_prepare(i, &peer_cases[first + i]);
    }
    const double start = seconds();
    for (int repeat = 0; repeat < PEER_REPEATS; repeat++) {
        for (int i = 0; i < count; i++) {
            peer_solve(i);
        }
    }
    return (seconds() - start) / PEER_REPEATS;
}

/* The best of all rounds within PEER_SECONDS, at least ROUNDS_LEAST: other load on the machine only adds time. */
static double best_round(int first, int count) {
    const double end = seconds() + PEER_SECONDS;
    double best = time_round(first, count);
    for (int round = 1; round < ROUNDS_LEAST || seconds() < end; round++) {
        const double time = time_round(first, count);
        best = time < best ? time : best;
    }
    return best;
}

int main(void) {
    peer_answer_t answer;
    for (int i = 0; i < peer_first[peer_groups]; i++) {
        peer_prepare(0, &peer_cases[i]);
        peer_solve(0);
        peer_answer(0, &answer);
        console_answer(&answer);
    }
    for (int group = 0; group < peer_groups; group++) {
        const int first = peer_first[group];
        const int count = peer_first[group + 1] - first;
        const double time = best_round(first, count) - best_round(first, 0);
        console_count("picoseconds", time > 0.0 ? (unsigned long)(time * 1.0e12 / count) : 0u);
    }
    return 0;
}
