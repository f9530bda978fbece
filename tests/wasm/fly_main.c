/* Flies the approach of port/wasm, compiled for this machine, and prints the bits of every field of every report, one line per image.
 * SPDX-License-Identifier: MIT
 *
 *   fly <kind> <detector> <roll> <pixel> <height offset> <side> <knows> <seed>      the controls of live.h in their order */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live.h"

#define ONE(name) +1
enum { CONTROLS = 0 LIVE_CONTROLS(ONE), FIELDS = 0 LIVE_FIELDS(ONE) };

static void print_report(void) {
    for (int i = 0; i < FIELDS; i++) {
        uint32_t bits;
        memcpy(&bits, &live_fields()[i], sizeof bits);
        printf("%08" PRIx32, bits);
    }
    printf(" %s %s\n", live_status(), live_reason());
}

int main(int count, char **words) {
    if (count != CONTROLS + 1) {
        return 2;
    }
    for (int i = 0; i < CONTROLS; i++) {
        live_controls()[i] = strtof(words[i + 1], NULL);
    }
    int images = live_start();
    while (live_next() == 1) {
        print_report();
        images--;
    }
    return images == 0 ? 0 : 1;
}
