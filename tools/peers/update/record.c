/* Prints the measurement updates that the filter method makes over the embedded logs, one a line: triangle, 1/sigma of the
 * nuisances, rows. The linker's --wrap replaces the library's functions by those named
 * __wrap_... here; no other file uses their names.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "job.h"
#include "refined/goe_srif.h"
#include "replay.h"

_Static_assert(GOE_STATES == PEER_STATES && GOE_NUISANCES == PEER_NUISANCES && GOE_ROWS_MAX == PEER_ROWS,
               "job.h describes another filter");

float __real_goe_srif_update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                             float *change);
float __wrap_goe_srif_update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                             float *change);

static void print(const float *numbers, int count) {
    for (int i = 0; i < count; i++) {
        printf("%.9g ", (double)numbers[i]);
    }
}

float __wrap_goe_srif_update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                             float *change) {
    print(root->element, PEER_TRIANGLE);
    print(&nuisance_root, 1);
    print(&matrix->row[0][0], PEER_COLUMNS * PEER_ROWS);
    printf("\n");
    return __real_goe_srif_update(root, nuisance_root, matrix, count, change);
}

static void fly(goe_estimator_t *estimator, const logged_track_t *track) {
    for (int k = 0; k < track->count; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        replay_read_image(&logged_images[track->first + k], &image);
        (void)goe_update(estimator, &image, &estimate);
    }
}

int main(void) {
    static goe_estimator_t estimator;
    for (int t = 0; t < logged_track_count; t++) {
        goe_settings_t settings;
        replay_read_settings(&logged_tracks[t], GOE_METHOD_FILTER, &settings);
        if (goe_init(&estimator, sizeof estimator, &settings, NULL) == GOE_OK) {
            fly(&estimator, &logged_tracks[t]);
        }
    }
    return 0;
}
