/* Reads MAVLink 2 frames, one per line in hexadecimal digits, and prints each again: read into its structure, packed and framed
 * again. "?": not a valid frame of a known message. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "any_message.h"

#define HEADER_BYTES 10u
#define LINE_BYTES (2 * GOE_MAVLINK_FRAME_MAX + 2)

static int digit_of(char c) {
    static const char digits[] = "0123456789abcdef";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) : -1;
}

static size_t read_hex(const char *line, uint8_t *bytes) {
    size_t count = 0;
    while (count < GOE_MAVLINK_FRAME_MAX && digit_of(line[2 * count]) >= 0 && digit_of(line[2 * count + 1]) >= 0) {
        bytes[count] = (uint8_t)(digit_of(line[2 * count]) << 4 | digit_of(line[2 * count + 1]));
        count++;
    }
    return count;
}

static void echo(const uint8_t *frame, size_t size) {
    any_message_t any;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    uint8_t again[GOE_MAVLINK_FRAME_MAX];
    if (size < HEADER_BYTES + 2u || frame[0] != 0xFDu || size != HEADER_BYTES + frame[1] + 2u) {
        (void)puts("?");
        return;
    }
    goe_mavlink_sender_t sender = {frame[5], frame[6], frame[4]};
    const uint32_t id = frame[7] | (uint32_t)frame[8] << 8 | (uint32_t)frame[9] << 16;
    const goe_mavlink_message_t message = goe_mavlink_of_id(id);
    any_message_read(message, frame + HEADER_BYTES, frame[1], &any);
    const size_t length = any_message_pack(message, &any, payload);
    const size_t made = goe_mavlink_frame(&sender, message, payload, length, again);
    for (size_t i = 0; i < made; i++) {
        (void)printf("%02x", again[i]);
    }
    (void)puts(made ? "" : "?");
}

int main(void) {
    char line[LINE_BYTES];
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    while (fgets(line, sizeof line, stdin)) {
        echo(frame, read_hex(line, frame));
    }
    return 0;
}
