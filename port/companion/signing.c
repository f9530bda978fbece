/* Signatures of MAVLink 2. SPDX-License-Identifier: MIT */
#include "signing.h"

#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "events.h"

#define EPOCH_US INT64_C(1420070400000000) /* UNIX time of 2015: times of signatures count from there ... */
#define TICK_US 10                         /* ... in so many microseconds */
#define TIME_MAX (UINT64_C(1) << 48)       /* of a signature */
#define TEXT_MAX 32
#define TIME_DIGITS 15 /* of TIME_MAX */
#define TICKS_PER_S UINT64_C(100000)
#define AHEAD (20u * TICKS_PER_S)  /* of the time now that is kept: well within the minute that a receiver allows ... */
#define ENOUGH (10u * TICKS_PER_S) /* ... and what of that is left when another is */

static uint64_t ticks_of(int64_t unix_us) { return unix_us > EPOCH_US ? (uint64_t)(unix_us - EPOCH_US) / TICK_US : 0u; }

/* 0: there is none. */
static uint64_t read_time(const char *path) {
    char text[TEXT_MAX] = "";
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return 0;
    }
    const uint64_t time = fgets(text, sizeof text, file) != NULL ? strtoull(text, NULL, 10) : 0u;
    (void)fclose(file);
    return time < TIME_MAX ? time : 0u;
}

/* In place and always as long: a loss of power leaves the old time or the new one. A new file would need a wait for the disk, in flight. */
static bool write_time(const char *path, uint64_t time) {
    char text[TEXT_MAX];
    const int length = snprintf(text, sizeof text, "%0*" PRIu64 "\n", TIME_DIGITS, time);
    const int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) {
        return false;
    }
    const bool written = pwrite(file, text, (size_t)length, 0) == length;
    return close(file) == 0 && written;
}

static void keep_time(signing_t *signing) {
    if (signing->kept >= signing->state.timestamp + ENOUGH) {
        return;
    }
    const uint64_t kept = signing->state.timestamp + AHEAD;
    if (write_time(signing->path, kept)) {
        signing->kept = kept;
        return;
    }
    if (!signing->failed) {
        event("%s cannot be written: after a restart the autopilot may refuse messages", signing->path);
    }
    signing->failed = true;
}

void signing_begin(signing_t *signing, wire_t *wire, const char *key_path, const uint8_t key[KEY_BYTES],
                   int64_t unix_us) {
    const uint64_t now = ticks_of(unix_us);
    (void)memset(signing, 0, sizeof *signing);
    (void)snprintf(signing->path, sizeof signing->path, "%s.time", key_path);
    const uint64_t before = read_time(signing->path);
    signing->on = true;
    signing->state.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING;
    signing->state.timestamp = now > before ? now : before;
    (void)memcpy(signing->state.secret_key, key, KEY_BYTES);
    wire->parser.signing = wire->sender.signing = &signing->state;
    wire->parser.signing_streams = &signing->streams;
    keep_time(signing);
    if (key_file_is_open_to_others(key_path)) {
        event("%s may be read by others: chmod 600", key_path);
    }
}

static void report_refused(signing_t *signing, const wire_t *wire) {
    if (wire->counts.without_signature > signing->unsigned_reported) {
        event("messages without a signature are refused: %lu so far", wire->counts.without_signature);
    }
    if (wire->counts.forged > signing->forged_reported) {
        event("messages with another's signature, or an old one, are refused: %lu so far", wire->counts.forged);
    }
    signing->unsigned_reported = wire->counts.without_signature;
    signing->forged_reported = wire->counts.forged;
}

void signing_go_on(signing_t *signing, const wire_t *wire, int64_t unix_us) {
    const uint64_t now = ticks_of(unix_us);
    if (!signing->on) {
        return;
    }
    signing->state.timestamp = now > signing->state.timestamp ? now : signing->state.timestamp;
    keep_time(signing);
    report_refused(signing, wire);
}
