/* Signatures of MAVLink 2, in both directions; MAVLink's headers provide SHA-256. SPDX-License-Identifier: MIT
 *
 * Each frame contains a time that never goes back, even over restarts: the file KEY.time contains a time that no frame has reached yet.
 * Messages are refused if they have no signature, a wrong signature, or an older time than the latest of their sender. */
#ifndef SIGNING_H
#define SIGNING_H

#include "key_file.h"
#include "wire.h"

#define SIGNING_PATH_MAX 520

typedef struct {
    bool on;
    char path[SIGNING_PATH_MAX]; /* path of the file KEY.time */
    uint64_t kept;               /* time in this file */
    bool failed;                 /* the file could not be written; this was reported */
    mavlink_signing_t state;
    mavlink_signing_streams_t streams;
    unsigned long unsigned_reported, forged_reported; /* counts of wire_counts_t that were reported */
} signing_t;

/* Starts to sign and check messages. unix_us: the computer's clock, which may be wrong. */
void signing_begin(signing_t *signing, wire_t *wire, const char *key_path, const uint8_t key[KEY_BYTES],
                   int64_t unix_us);

/* To be called once a second. Updates and stores the time, and reports refused messages. */
void signing_go_on(signing_t *signing, const wire_t *wire, int64_t unix_us);

#endif
