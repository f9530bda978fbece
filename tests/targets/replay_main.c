/* Prints one line: the hash of all outputs for the embedded logs, and the self-check's result.
 * SPDX-License-Identifier: MIT
 *
 *   replay <hash> images <n> self_check <0x..> */
#include "replay.h"

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#endif

int main(void) {
    char text[17];
    replay_t replay = replay_start();
    const unsigned self_check = goe_self_check();
    replay_all(&replay);
    replay_hash_text(replay.hash, text);
    port_write_text("replay ");
    port_write_text(text);
    port_write_text(" images ");
    replay_write_count(replay.images);
    replay_hash_text(self_check, text);
    port_write_text(" self_check 0x");
    port_write_text(&text[14]);
    port_write_text("\n");
    return 0;
}
