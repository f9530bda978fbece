/* MAVLink messages over a link, by mavgen's headers. SPDX-License-Identifier: MIT */
#ifndef WIRE_H
#define WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The generated headers are not ours to mend. */
#include "companion/mavlink.h"

#include "goe_mavlink.h"
#include "link.h"

typedef struct {
    unsigned long messages;                  /* understood */
    unsigned long unknown;                   /* of a kind that is not in companion.xml */
    unsigned long garbage;                   /* frames with a wrong checksum */
    unsigned long stray;                     /* bytes between frames */
    unsigned long lost;                      /* of the autopilot's, by its running number */
    unsigned long unsent;                    /* did not go out */
    unsigned long without_signature, forged; /* on a signed link: refused */
} wire_counts_t;

typedef struct {
    link_t *link;
    uint8_t system, component; /* the companion's */
    uint8_t autopilot_system;  /* the autopilot's system, whose losses count; 0: not known yet */
    mavlink_message_t buffer;
    mavlink_status_t parser;
    mavlink_status_t sender; /* keeps the sequence number of sent frames */
    uint8_t sequence;        /* latest of the autopilot's */
    bool missing[256];       /* by running number: counted as lost */
    bool has_sequence;
    wire_counts_t counts;
} wire_t;

typedef void (*message_taker_t)(void *user, const mavlink_message_t *message);

/* Reads the available bytes, and passes every message on. Returns whether there were any. */
bool wire_receive(wire_t *wire, message_taker_t take, void *user);

/* Sends a message that mavgen's functions have packed, with the wire's running number. */
void wire_send(wire_t *wire, mavlink_message_t *message);

/* Sends a payload of goe_mavlink's. */
void wire_send_payload(wire_t *wire, goe_mavlink_message_t message, const uint8_t *payload, size_t length);

/* Whether a command was the companion's: an autopilot may leave out whose. */
bool wire_is_for_us(const wire_t *wire, const mavlink_command_ack_t *answer);

#endif
