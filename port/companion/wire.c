/* MAVLink messages over a link. SPDX-License-Identifier: MIT */
#include "wire.h"

#include <string.h>

#define READ_MAX 4096
#define READS_MAX 64 /* in one go: a flood must not keep the companion from its other work */

#define LATE_MIN 128 /* a running number that far ahead is one that lies behind */

/* Frames of the autopilot that never came: gaps in its sequence numbers, less late arrivals. */
static void count_lost(wire_t *wire, const mavlink_message_t *message) {
    if (wire->autopilot_system == 0 || message->sysid != wire->autopilot_system ||
        message->compid != MAV_COMP_ID_AUTOPILOT1) {
        return;
    }
    const uint8_t step = wire->has_sequence ? (uint8_t)(message->seq - wire->sequence) : 1u;
    if (step >= LATE_MIN || step == 0) { /* late, or twice */
        wire->counts.lost -= wire->missing[message->seq] ? 1u : 0u;
        wire->missing[message->seq] = false;
        return;
    }
    for (uint8_t skipped = 1; skipped < step; skipped++) {
        wire->missing[(uint8_t)(message->seq - skipped)] = true;
        wire->counts.lost++;
    }
    wire->missing[message->seq] = false;
    wire->sequence = message->seq;
    wire->has_sequence = true;
}

/* The right key at an old time may be an autopilot that knows no better, such as without GPS: signed messages of the companion's
 * set its time. Nothing of what it sent is taken. */
static void refuse(wire_t *wire, const mavlink_message_t *message) {
    const bool is_signed = (message->incompat_flags & MAVLINK_IFLAG_SIGNED) != 0;
    wire->counts.forged += is_signed ? 1u : 0u;
    wire->counts.without_signature += is_signed ? 0u : 1u;
    if (is_signed && wire->parser.signing->last_status == MAVLINK_SIGNING_STATUS_OLD_TIMESTAMP) {
        link_greet(wire->link);
    }
}

/* A wrong checksum is reported twice of a signed message: also before its signature, when `message` holds nothing yet. */
static bool is_half(const wire_t *wire, uint8_t result) {
    return result == MAVLINK_FRAMING_BAD_CRC && wire->parser.parse_state != MAVLINK_PARSE_STATE_IDLE;
}

static void take_byte(wire_t *wire, uint8_t byte, message_taker_t take, void *user) {
    mavlink_message_t message;
    mavlink_status_t status;
    const uint8_t result = mavlink_frame_char_buffer(&wire->buffer, &wire->parser, byte, &message, &status);
    if (is_half(wire, result)) {
        return;
    }
    if (result == MAVLINK_FRAMING_OK) {
        wire->counts.messages++;
        count_lost(wire, &message);
        take(user, &message);
    } else if (result == MAVLINK_FRAMING_BAD_CRC && mavlink_get_msg_entry(message.msgid) == NULL) {
        wire->counts.unknown++;
        count_lost(wire, &message);
    } else if (result == MAVLINK_FRAMING_BAD_SIGNATURE) {
        refuse(wire, &message);
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
    if (!sent && wire->autopilot_system != 0) { /* before, there may be nobody to send to */
        wire->counts.unsent++;
    }
}

/* Numbers a message, signs it if the link is signed, and sends it. */
static void send_numbered(wire_t *wire, mavlink_message_t *message, uint8_t length_min, uint8_t length,
                          uint8_t crc_extra) {
    uint8_t bytes[MAVLINK_MAX_PACKET_LEN];
    (void)mavlink_finalize_message_buffer(message, wire->system, wire->component, &wire->sender, length_min, length,
                                          crc_extra);
    send_bytes(wire, bytes, mavlink_msg_to_send_buffer(bytes, message));
}

/* mavgen's functions number packed frames by a status of each source file's own: here they are numbered again. */
void wire_send(wire_t *wire, mavlink_message_t *message) {
    const mavlink_msg_entry_t *entry = mavlink_get_msg_entry(message->msgid);
    if (entry != NULL) {
        char *payload = _MAV_PAYLOAD_NON_CONST(message); /* behind it lies the checksum, where zeros were cut off */
        (void)memset(payload + message->len, 0, MAVLINK_MAX_PAYLOAD_LEN - (size_t)message->len);
        send_numbered(wire, message, entry->min_msg_len, entry->max_msg_len, entry->crc_extra);
    }
}

void wire_send_payload(wire_t *wire, goe_mavlink_message_t message, const uint8_t *payload, size_t length) {
    const goe_mavlink_info_t *info = goe_mavlink_info(message);
    mavlink_message_t packed;
    if (info == NULL || length == 0 || length > info->length) {
        return;
    }
    (void)memset(&packed, 0, sizeof packed);
    packed.msgid = info->id & 0xFFFFFFu; /* 24 bits on the wire */
    (void)memcpy(_MAV_PAYLOAD_NON_CONST(&packed), payload, length);
    send_numbered(wire, &packed, info->length_min, info->length, info->crc_extra);
}

bool wire_is_for_us(const wire_t *wire, const mavlink_command_ack_t *answer) {
    return (answer->target_system == 0 || answer->target_system == wire->system) &&
           (answer->target_component == 0 || answer->target_component == wire->component);
}
