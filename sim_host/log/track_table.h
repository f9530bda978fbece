/* One estimator per track id. SPDX-License-Identifier: MIT */
#ifndef TRACK_TABLE_H
#define TRACK_TABLE_H

#include <stdint.h>

#include "goe.h"

#define TRACK_TABLE_TRACKS_MAX 16384 /* bounds the memory */

typedef struct track_table track_table_t;

/* Every estimator of the table starts with these settings, which goe_init() must accept: *bad_field names the one it does
 * not. Null on failure; *bad_field is then null if memory is short. */
track_table_t *track_table_new(const goe_settings_t *settings, const char **bad_field);

/* The estimator of a track; a new one if the id is new. Null if there are TRACK_TABLE_TRACKS_MAX others or memory is short. */
goe_estimator_t *track_table_get(track_table_t *table, int64_t id);

/* Null is ignored. */
void track_table_free(track_table_t *table);

#endif
