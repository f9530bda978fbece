/* Runs one solver on a target, for counting its instructions and its stack. Prints one line: stack <bytes>.
 * SPDX-License-Identifier: MIT */
#include "peer.h"
#include "semihosting.h"
#include "stack.h"

static peer_window_t windows[PEER_WINDOWS];
static peer_solution_t solution;

__attribute__((noinline)) static size_t depth_of(const peer_window_t *window) {
    port_stack_paint();
    peer_solve(window, &solution);
    return port_stack_used();
}

static void write_count(size_t count) {
    char text[12];
    int at = 11;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + count % 10u);
        count /= 10u;
    } while (count > 0u);
    port_write_text(&text[at]);
}

int main(void) {
    size_t deepest = 0;
    peer_make_windows(windows);
    for (int i = 0; i < PEER_WINDOWS; i++) {
        peer_prepare(&windows[i]);
        const size_t depth = depth_of(&windows[i]);
        deepest = depth > deepest ? depth : deepest;
    }
    port_write_text("stack ");
    write_count(deepest);
    port_write_text("\n");
    return 0;
}
