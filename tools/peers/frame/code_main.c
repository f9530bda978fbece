/* Only the solver, so the image contains nothing else: measures the size of its code. SPDX-License-Identifier: MIT */
#include "peer.h"

int main(void) {
    peer_solve(0);
    return 0;
}
