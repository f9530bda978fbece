/* Updates per second on one core of the host: 1, 100 and 10,000 obstacles, each fed image after image in turn, so that many
 * obstacles no longer fit into the caches.
 *
 *   throughput OBSTACLES UPDATES   the most obstacles; updates per measurement, at least
 *
 * SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "replay.h"

#define ROUNDS 5
#define IMAGES_MAX 256

static double seconds(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1.0e-9 * (double)now.tv_nsec;
}

static goe_image_t images[IMAGES_MAX];

/* Reads the track; or, at its repetition, the same images a minute later, after a filter reset of unknown size. */
static void make_images(const logged_track_t *track, int repetition) {
    for (int k = 0; k < track->count; k++) {
        replay_read_image(&logged_images[track->first + k], &images[k]);
        images[k].pose.time_us += (int64_t)repetition * 60000000;
        images[k].pose.reset_count = (uint8_t)repetition;
        images[k].pose.reset_delta_known = false;
    }
}

/* Seconds for one flight of all obstacles: each image for each of them in turn. */
static double fly(goe_estimator_t *estimators, int count, const logged_track_t *track) {
    goe_estimate_t estimate;
    const double start = seconds();
    for (int k = 0; k < track->count; k++) {
        for (int i = 0; i < count; i++) {
            (void)goe_update(&estimators[i], &images[k], &estimate);
            __asm__ volatile("" : : "r"(&estimate) : "memory");
        }
    }
    return seconds() - start;
}

/* The best of several rounds: everything else on the machine only adds. */
static double updates_per_second(goe_estimator_t *estimators, int count, int least, const logged_track_t *track) {
    goe_settings_t settings;
    double best = 0.0;
    const int updates = count * track->count;
    const int flights = least / updates + 1;
    replay_read_settings(track, GOE_METHOD_REFINED, &settings);
    for (int i = 0; i < count; i++) {
        if (goe_init(&estimators[i], sizeof estimators[i], &settings, NULL) != GOE_OK) {
            exit(1);
        }
    }
    for (int round = 0; round < ROUNDS * flights; round += flights) {
        double time = 0.0;
        for (int flight = 0; flight < flights; flight++) {
            make_images(track, round + flight);
            time += fly(estimators, count, track);
        }
        const double speed = (double)updates * flights / time;
        best = speed > best ? speed : best;
    }
    return best;
}

/* One line for each number of obstacles: obstacles, updates per second, nanoseconds per update, KiB of state. */
int main(int count, char **arguments) {
    static const int counts[] = {1, 100, 10000};
    const int most = count == 3 ? atoi(arguments[1]) : 0;
    const int least = count == 3 ? atoi(arguments[2]) : 0;
    goe_estimator_t *estimators = most > 0 ? malloc((size_t)most * sizeof *estimators) : NULL;
    if (!estimators) {
        return 1;
    }
    for (int i = 0; i < 3 && counts[i] <= most; i++) {
        const double speed = updates_per_second(estimators, counts[i], least, &logged_tracks[0]);
        printf("%d %.0f %.1f %.0f\n", counts[i], speed, 1.0e9 / speed, (double)counts[i] * sizeof *estimators / 1024.0);
    }
    free(estimators);
    return 0;
}
