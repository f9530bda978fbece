/* MAVLink messages over a link. SPDX-License-Identifier: MIT */
#include "wire.h"

#include <string.h>

#define READ_MAX 4096
#define READS_MAX 64 /* in one go: a flood must not keep the companion from its other work */

/* Frames of the autopilot that never came: what its running number left out. One that came late or twice is none. */
static void count_lost(wire_t *wire, const mavlink_message_t *message) {
    const uint8_t step = (uint8_t)(message->seq - wire->sequence);
    if (wire->heard == 0 || message->sysid != wire->heard || message->compid != MAV_COMP_ID_AUTOPILOT1) {
        return;
    }
    if (wire->has_sequence && step > 0 && step < 128) {
        wire->counts.lost += step - 1u;
    }
    if (!wire->has_sequence || step < 128) {
        wire->sequence = message->seq;
    }
    wire->has_sequence = true;
}

static void take_byte(wire_t *wire, uint8_t byte, message_taker_t take, void *user) {
    mavlink_message_t message;
    mavlink_status_t status;
    const uint8_t result = mavlink_frame_char_buffer(&wire->buffer, &wire->parser, byte, &message, &status);
    if (result == MAVLINK_FRAMING_OK) {
        wire->counts.messages++;
        count_lost(wire, &message);
        take(user, &message);
    } else if (result == MAVLINK_FRAMING_BAD_CRC && mavlink_get_msg_entry(message.msgid) == NULL) {
        wire->counts.unknown++;
        count_lost(wire, &message);
    } else if (result != MAVLINK_FRAMING_INCOMPLETE) {
        wire->counts.garbage++;
    } else if (wire->parser.parse_state == MAVLINK_PARSE_STATE_IDLE ||
               wire->parser.parse_state == MAVLINK_PARSE_STATE_UNINIT) {
        wire->counts.stray++;
    }
}

bool wire_receive(wire_t *wire, message_taker_t take, void *user) {
    uint8_t bytes[READ_MAX];
    bool any = false;
    for (int i = 0; i < READS_MAX; i++) {
        const size_t size = link_read(wire->link, bytes, sizeof bytes);
        if (size == 0) {
            return any;
        }
        any = true;
        for (size_t k = 0; k < size; k++) {
            take_byte(wire, bytes[k], take, user);
        }
        if (link_has_messages(wire->link)) {
            wire->parser.parse_state = MAVLINK_PARSE_STATE_IDLE; /* a cut datagram takes nothing of the next one */
        }
    }
    return any;
}

static void send_bytes(wire_t *wire, const uint8_t *bytes, size_t size) {
    const bool sent = size > 0 && link_write(wire->link, bytes, size);
    if (!sent && wire->heard != 0) { /* before, there may be nobody to send to */
        wire->counts.unsent++;
    }
}

void wire_send(wire_t *wire, mavlink_message_t *message) {
    uint8_t bytes[MAVLINK_MAX_PACKET_LEN];
    send_bytes(wire, bytes, mavlink_msg_to_send_buffer(bytes, message));
}

/* mavgen's functions keep the running number of the first channel; both kinds of messages share it. */
void wire_send_payload(wire_t *wire, goe_mavlink_message_t message, const uint8_t *payload, size_t length) {
    mavlink_status_t *channel = mavlink_get_channel_status(MAVLINK_COMM_0);
    goe_mavlink_sender_t sender = {wire->system, wire->component, channel->current_tx_seq};
    uint8_t bytes[GOE_MAVLINK_FRAME_MAX];
    const size_t size = goe_mavlink_frame(&sender, message, payload, length, bytes);
    channel->current_tx_seq = sender.sequence;
    send_bytes(wire, bytes, size);
}
