/* MAVLink messages over a link, by mavgen's headers. SPDX-License-Identifier: MIT */
#ifndef WIRE_H
#define WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Generated headers. */
#include "companion/mavlink.h"

#include "goe_mavlink.h"
#include "link.h"

typedef struct {
    unsigned long messages;                  /* valid messages */
    unsigned long unknown;                   /* messages of a kind that is not in companion.xml */
    unsigned long garbage;                   /* frames with a wrong checksum */
    unsigned long stray;                     /* bytes between frames */
    unsigned long lost;                      /* lost messages of the autopilot, by its sequence number */
    unsigned long unsent;                    /* messages that could not be sent */
    unsigned long without_signature, forged; /* refused messages on a signed link */
} wire_counts_t;

typedef struct {
    link_t *link;
    uint8_t system, component; /* ids of the companion */
    uint8_t autopilot_system;  /* system id of the autopilot, whose lost messages are counted; 0: not known yet */
    mavlink_message_t buffer;
    mavlink_status_t parser;
    mavlink_status_t sender; /* keeps the sequence number of sent frames */
    uint8_t sequence;        /* latest sequence number of the autopilot */
    bool missing[256];       /* by sequence number: counted as lost */
    bool has_sequence;
    wire_counts_t counts;
} wire_t;

typedef void (*message_taker_t)(void *user, const mavlink_message_t *message);

/* Reads the available bytes and passes every message to `take`. Returns whether there were bytes. */
bool wire_receive(wire_t *wire, message_taker_t take, void *user);

/* Sends a message that mavgen's functions packed, with the wire's sequence number. */
void wire_send(wire_t *wire, mavlink_message_t *message);

/* Sends a payload that goe_mavlink packed. */
void wire_send_payload(wire_t *wire, goe_mavlink_message_t message, const uint8_t *payload, size_t length);

/* Returns whether an acknowledgement is for the companion's command. Some autopilots do not name the sender of the command. */
bool wire_is_for_us(const wire_t *wire, const mavlink_command_ack_t *answer);

#endif
