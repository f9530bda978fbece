/* Nothing but the solving, so that the linker keeps nothing else: how large its code is. SPDX-License-Identifier: MIT */
#include "peer.h"

int main(void) {
    peer_solve(0);
    return 0;
}
