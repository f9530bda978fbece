/* Signatures of MAVLink 2, in both directions; SHA-256 is that of MAVLink's own headers. SPDX-License-Identifier: MIT
 *
 * Each frame carries a time that never goes back, also not over restarts: the file KEY.time keeps a time that no frame has reached
 * yet. A message with an older time than the latest of its sender is refused, as is one without a signature or with a wrong one. */
#ifndef SIGNING_H
#define SIGNING_H

#include "key_file.h"
#include "wire.h"

#define SIGNING_PATH_MAX 520

typedef struct {
    bool on;
    char path[SIGNING_PATH_MAX]; /* of the file that keeps the time */
    uint64_t kept;               /* time that it holds */
    bool failed;                 /* it could not be written, which was reported */
    mavlink_signing_t state;
    mavlink_signing_streams_t streams;
    unsigned long unsigned_reported, forged_reported; /* counts of the wire that were reported */
} signing_t;

/* Signs and checks from now on. unix_us: the computer's clock, which need not be right. */
void signing_begin(signing_t *signing, wire_t *wire, const char *key_path, const uint8_t key[KEY_BYTES],
                   int64_t unix_us);

/* To be called once a second: updates times by the clock, stores them, and reports refused messages. */
void signing_go_on(signing_t *signing, const wire_t *wire, int64_t unix_us);

#endif
