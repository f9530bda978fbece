/* Runs one solver on a target, for counting its instructions. Prints the answer to each case, and for each group:
 *   stack <bytes, the most of any case>
 * SPDX-License-Identifier: MIT */
#include "console.h"
#include "stack.h"

__attribute__((noinline)) static size_t depth_of_solve(void) {
    port_stack_paint();
    peer_solve(0);
    return port_stack_used();
}

int main(void) {
    peer_answer_t answer;
    for (int group = 0; group < peer_groups; group++) {
        size_t deepest = 0;
        for (int i = peer_first[group]; i < peer_first[group + 1]; i++) {
            peer_prepare(0, &peer_cases[i]);
            const size_t depth = depth_of_solve();
            deepest = depth > deepest ? depth : deepest;
            peer_answer(0, &answer);
            console_answer(&answer);
        }
        console_count("stack", (unsigned long)deepest);
    }
    return 0;
}
