/* Output of a frame. SPDX-License-Identifier: MIT */
#include "console.h"

#include <stdint.h>
#include <string.h>

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#else
#include <stdio.h>
static void port_write_text(const char *text) { (void)fputs(text, stdout); }
#endif

static void write_word(uint32_t word) {
    char text[10] = " 00000000";
    for (int i = 0; i < 8; i++) {
        text[1 + i] = "0123456789abcdef"[(word >> (28 - 4 * i)) & 0xFu];
    }
    port_write_text(text);
}

void console_answer(const peer_answer_t *answer) {
    uint32_t words[sizeof *answer / sizeof(uint32_t)];
    memcpy(words, answer, sizeof words);
    port_write_text("answer");
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        write_word(words[i]);
    }
    port_write_text("\n");
}

void console_count(const char *name, unsigned long count) {
    char text[22];
    int at = 21;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + count % 10u);
        count /= 10u;
    } while (count > 0u);
    port_write_text(name);
    port_write_text(" ");
    port_write_text(&text[at]);
    port_write_text("\n");
}
