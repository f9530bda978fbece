/* The replay of the embedded logs, as a module that calls the library's. SPDX-License-Identifier: MIT */
#include "replay.h"

const char *golden_hash(void);

/* 16 digits, to be compared with tests/targets/golden_hash.txt. */
const char *golden_hash(void) {
    static char text[17];
    replay_t replay = replay_start();
    replay_all(&replay);
    replay_hash_text(replay.hash, text);
    return text;
}
