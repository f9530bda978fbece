/* One estimator per track id. SPDX-License-Identifier: MIT */
#include "track_table.h"

#include <search.h>
#include <stdlib.h>

typedef struct track {
    int64_t id; /* first: the tree compares pointers to an id */
    struct track *previous;
    goe_estimator_t estimator;
} track_t;

struct track_table {
    void *tree; /* of tsearch(): balanced, grows track by track */
    size_t count;
    track_t *newest;
    track_t *latest; /* asked for last: most logs stay with a track or have few */
    goe_estimator_t blank;
};

static int compare_ids(const void *a, const void *b) {
    const int64_t id_a = *(const int64_t *)a;
    const int64_t id_b = *(const int64_t *)b;
    return (id_a > id_b) - (id_a < id_b);
}

track_table_t *track_table_new(const goe_settings_t *settings, const char **bad_field) {
    *bad_field = NULL;
    track_table_t *table = calloc(1, sizeof *table);
    if (table == NULL) {
        return NULL;
    }
    if (goe_init(&table->blank, sizeof table->blank, settings, bad_field) != GOE_OK) {
        free(table);
        return NULL;
    }
    return table;
}

static track_t *add_track(track_table_t *table, int64_t id) {
    track_t *track = table->count < TRACK_TABLE_TRACKS_MAX ? malloc(sizeof *track) : NULL;
    if (track == NULL) {
        return NULL;
    }
    track->id = id;
    track->estimator = table->blank;
    if (tsearch(&track->id, &table->tree, compare_ids) == NULL) {
        free(track);
        return NULL;
    }
    track->previous = table->newest;
    table->newest = track;
    table->count++;
    return track;
}

goe_estimator_t *track_table_get(track_table_t *table, int64_t id) {
    if (table->latest == NULL || table->latest->id != id) {
        track_t *const *found = tfind(&id, &table->tree, compare_ids);
        track_t *track = found != NULL ? *found : add_track(table, id);
        if (track == NULL) {
            return NULL;
        }
        table->latest = track;
    }
    return &table->latest->estimator;
}

void track_table_free(track_table_t *table) {
    if (table == NULL) {
        return;
    }
    while (table->newest != NULL) {
        track_t *track = table->newest;
        table->newest = track->previous;
        (void)tdelete(&track->id, &table->tree, compare_ids);
        free(track);
    }
    free(table);
}
