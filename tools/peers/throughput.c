/* Updates per second on one core of the host: 1, 10, ... 10,000 obstacles, each with image after image in turn; many
 * obstacles no longer fit into the caches. Numbers and kinds of update alternate, so a slow minute of the machine
 * affects all of them.
 *
 *   throughput OBSTACLES UPDATES   largest number of obstacles; minimum number of updates of each number and kind
 *
 * Prints for each number of obstacles: the number, KiB of state, nanoseconds per update of each kind.
 * SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "replay.h"

#define ROUND_UPDATES 5000 /* in a round, at least; the best round counts, since other load only adds time */
#define ROUNDS_LEAST 5
#define IMAGES_MAX 256
#define REPEAT_US 60000000 /* after which a flight is repeated */

typedef enum { WINDOW, REFINED, REFINED_AND_HAZARD, KINDS } kind_t;

static const goe_intent_t intent = {{15.0f, 1.0f, -0.5f}, 10.0f, 5.0f, 0.0f, 0.0f};
static const logged_track_t *const track = &logged_tracks[0];
static goe_image_t images[IMAGES_MAX];

static double seconds(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1.0e-9 * (double)now.tv_nsec;
}

static void check(bool good, const char *what) {
    if (!good) {
        (void)fprintf(stderr, "throughput: %s\n", what);
        exit(1);
    }
}

/* Reads the track; when repeated, the same images at a later time, after a filter reset of unknown size. */
static void make_images(int repetition) {
    for (int k = 0; k < track->count; k++) {
        replay_read_image(&logged_images[track->first + k], &images[k]);
        images[k].pose.time_us += (int64_t)repetition * REPEAT_US;
        images[k].pose.reset_count = (uint8_t)repetition;
        images[k].pose.reset_delta_known = false;
    }
}

/* Seconds for one flight of all obstacles: each image for each of them in turn. */
static double fly(goe_estimator_t *estimators, int count, kind_t kind) {
    goe_estimate_t estimate;
    goe_hazard_t hazard;
    goe_status_t status = GOE_OK;
    const double start = seconds();
    for (int k = 0; k < track->count; k++) {
        for (int i = 0; i < count; i++) {
            (void)goe_update(&estimators[i], &images[k], &estimate);
            if (kind == REFINED_AND_HAZARD) {
                status = goe_hazard(&estimators[i], &intent, &hazard);
            }
        }
    }
    const double time = seconds() - start;
    check(estimate.fresh && estimate.method == (kind == WINDOW ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER),
          "the flight ends without an answer");
    check(status == GOE_OK, "the flight ends without a hazard");
    return time;
}

/* Seconds per update. */
static double time_round(goe_estimator_t *estimators, int count, int flights, kind_t kind) {
    goe_settings_t settings;
    double time = 0.0;
    replay_read_settings(track, kind == WINDOW ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER, &settings);
    for (int i = 0; i < count; i++) {
        check(goe_init(&estimators[i], sizeof estimators[i], &settings, NULL) == GOE_OK, "bad settings");
    }
    for (int flight = 0; flight < flights; flight++) {
        make_images(flight);
        time += fly(estimators, count, kind);
    }
    return time / ((double)count * track->count * flights);
}

static void print_line(goe_estimator_t *estimators, int count, int updates) {
    double best[KINDS];
    const int flights = (ROUND_UPDATES - 1) / (count * track->count) + 1;
    const int wanted = updates / (count * track->count * flights);
    const int rounds = wanted > ROUNDS_LEAST ? wanted : ROUNDS_LEAST;
    for (int round = 0; round < rounds; round++) {
        for (kind_t kind = WINDOW; kind < KINDS; kind++) {
            const double time = time_round(estimators, count, flights, kind);
            best[kind] = round > 0 && best[kind] < time ? best[kind] : time;
        }
    }
    printf("%d %.0f", count, (double)count * sizeof *estimators / 1024.0);
    for (kind_t kind = WINDOW; kind < KINDS; kind++) {
        printf(" %.2f", best[kind] * 1.0e9);
    }
    printf("\n");
    (void)fflush(stdout);
}

int main(int count, char **arguments) {
    const int most = count == 3 ? atoi(arguments[1]) : 0;
    const int updates = count == 3 ? atoi(arguments[2]) : 0;
    check(most > 0 && updates > 0, "usage: throughput OBSTACLES UPDATES");
    check(track->count <= IMAGES_MAX, "the track is too long");
    goe_estimator_t *estimators = malloc((size_t)most * sizeof *estimators);
    check(estimators != NULL, "no memory");
    for (int i = 1; i <= most; i *= 10) {
        print_line(estimators, i, updates);
    }
    free(estimators);
    return 0;
}
