/* Links that transfer bytes: UDP, TCP, serial line, FIFO, standard input. SPDX-License-Identifier: MIT
 *
 * No function blocks. The companion tries to reopen a lost link (a TCP peer, an unplugged serial adapter) once a second. */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

typedef struct link link_t;

/* Returns whether the address `where` is valid, without opening it. If not, fault gives the reason. */
bool link_check(const char *where, char *fault, size_t fault_size);

/* Return whether the address `where` accepts senders from any network, or only from this computer. */
bool link_is_wide(const char *where);
bool link_is_local(const char *where);

/* Opens the address `where`: udpin:HOST:PORT (receives there, and sends to the peer of the latest link_answer()), udpout:HOST:PORT
 * (receives only from its peer), tcp:HOST:PORT, serial:DEVICE:BAUD, fifo:PATH, stdin. A TCP peer or device that does not exist yet is
 * not a failure. Null on failure: fault gives the reason. */
link_t *link_open(const char *where, char *fault, size_t fault_size);

/* Descriptor for poll(); -1 while the link is not open. */
int link_descriptor(const link_t *link);

/* Returns true for links with datagrams, where each read returns one message. */
bool link_has_messages(const link_t *link);

/* Reads at most `size` bytes. Returns the number of bytes; 0: none available now. */
size_t link_read(link_t *link, uint8_t *bytes, size_t size);

/* udpin: makes the sender of the latest bytes the peer. link_write() sends to the peer, and the operating system drops packets of
 * other senders. */
void link_answer(link_t *link);

/* udpin: link_write() sends to the sender of the latest bytes until the next link_answer(). Packets of all senders are received. */
void link_greet(link_t *link);

/* udpin: packets of all senders are received again. link_write() still sends to the same peer. */
void link_release(link_t *link);

/* Returns whether the latest bytes came from the peer; true for every other kind of link, and while there is no peer. */
bool link_is_answered(const link_t *link);

/* Sends the bytes. Returns false if they cannot be sent at once. A stream first sends the rest of a frame that was sent in part. */
bool link_write(link_t *link, const uint8_t *bytes, size_t size);

/* Reopens a lost link; to be called repeatedly. */
void link_mend(link_t *link, int64_t now_us);

/* Number of losses of the link; whether standard input has ended. */
unsigned link_losses(const link_t *link);
bool link_ended(const link_t *link);

/* Null is ignored. */
void link_close(link_t *link);

#endif
