/* Bytes to and from somewhere: UDP, TCP, a serial line, a FIFO, standard input. SPDX-License-Identifier: MIT
 *
 * Nothing here blocks. A lost link (a TCP peer, a serial adapter that was pulled out) is tried again once a second. */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

typedef struct link link_t;

/* Whether `where` is of one of the forms; nothing is opened. False: fault says why. */
bool link_check(const char *where, char *fault, size_t fault_size);

/* Whether `where` waits for whoever comes from any network, or from this computer alone. */
bool link_is_wide(const char *where);
bool link_is_local(const char *where);

/* `where`: udpin:HOST:PORT (receives there, answers to the peer of the latest link_answer()), udpout:HOST:PORT (receives
 * from its peer only), tcp:HOST:PORT, serial:DEVICE:BAUD, fifo:PATH, stdin. Null on failure: fault gives the reason. A TCP peer or
 * device that does not exist yet is not a failure. */
link_t *link_open(const char *where, char *fault, size_t fault_size);

/* To be waited for; -1: nothing is open at the moment. */
int link_descriptor(const link_t *link);

/* True for links that carry whole messages: each read is one. */
bool link_has_messages(const link_t *link);

/* Up to `size` bytes; 0: nothing there now. */
size_t link_read(link_t *link, uint8_t *bytes, size_t size);

/* udpin: answers from now on go to the sender of the latest bytes, and the system refuses packets of others. */
void link_answer(link_t *link);

/* udpin: answers go there until the next link_answer(), and packets of all senders are still received. */
void link_greet(link_t *link);

/* udpin: packets of all senders are received again; answers continue to the same peer. */
void link_release(link_t *link);

/* Whether the latest bytes came from there; true for every other kind of link, and before the first link_answer(). */
bool link_is_answered(const link_t *link);

/* False if it cannot be sent at once. On a stream the rest of a started frame goes out before anything else. */
bool link_write(link_t *link, const uint8_t *bytes, size_t size);

/* To be called now and then: reopens a lost link. */
void link_mend(link_t *link, int64_t now_us);

/* How often it was lost. Standard input that has ended: link_ended(). */
unsigned link_losses(const link_t *link);
bool link_ended(const link_t *link);

/* Null is ignored. */
void link_close(link_t *link);

#endif
