/* Output of a frame, on the host and on a target without printf. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_CONSOLE_H
#define GOE_PEER_CONSOLE_H

#include "peer.h"

/* "answer" and each number as the eight hexadecimal digits of its bits. */
void console_answer(const peer_answer_t *answer);

/* A name and a count: "stack 160". */
void console_count(const char *name, unsigned long count);

#endif
