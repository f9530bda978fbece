/* Replays the embedded logs and hashes every output bit. SPDX-License-Identifier: MIT */
#ifndef GOE_TARGET_REPLAY_H
#define GOE_TARGET_REPLAY_H

#include <stdint.h>

#include "embedded_logs.h"

/* FNV-1a, 64 bit, over fields written out one by one, least significant byte first: no padding, no byte order. */
typedef struct {
    uint64_t hash;
    long images;
} replay_t;

replay_t replay_start(void);

/* Each method flies each track, in this order. */
#define REPLAY_METHODS 2
extern const goe_method_t replay_methods[REPLAY_METHODS];

/* For every track: initializes the estimator, processes each image, resets at the end. Hashes all returned data. */
void replay_all(replay_t *replay);

/* The same for outputs that do not depend on other compiled parts; a part that is left out has no images. */
typedef struct {
    replay_t window, filter, window_hazard, refined_hazard;
} replay_parts_t;

void replay_parts(replay_parts_t *parts);

void replay_read_settings(const logged_track_t *track, goe_method_t method, goe_settings_t *settings);
void replay_read_image(const logged_image_t *logged, goe_image_t *image);

/* 16 digits and the terminating zero. */
void replay_hash_text(uint64_t hash, char text[17]);

/* Writes to the console, 0 to 2^31 - 1. */
void replay_write_count(long count);

#if !defined(GOE_BARE_METAL)
void port_write_text(const char *text); /* on the host: to standard output */
#endif

#endif
