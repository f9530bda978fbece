/* Fuzzes all input of goe_replay: camera.ini, frames.csv and --set. SPDX-License-Identifier: MIT
 *
 * The input is text: frames.csv alone; or camera.ini, a line "%%" and frames.csv; or a further "%%" and settings, one per line. The
 * frames read go through the library, and the answers are printed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera_file.h"
#include "estimate_writer.h"
#include "frame_reader.h"
#include "fuzz.h"
#include "fuzz_file.h"
#include "settings_text.h"
#include "track_table.h"

#define ROWS_MAX 2000 /* of one input */
#define ASSIGNMENT_MAX 200u

enum { INPUTS, CAMERAS, CAMERAS_REFUSED, LOGS, LOGS_REFUSED, ROWS, FRESH, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"inputs", 0},       {"cameras", 0}, {"cameras_refused", 0}, {"logs", 0},
                                        {"logs_refused", 0}, {"rows", 0},    {"fresh", 0},           {NULL, 0}};

static const char usual_camera[] =
    "camera.width = 1280\ncamera.height = 1280\ncamera.fx = 914\ncamera.fy = 914\ncamera.cx = 640\n"
    "camera.cy = 640\n";

static FILE *sink; /* the output is discarded */

/* An error is one line that names the file. */
static void check_error(const input_error_t *error, const char *path) {
    FUZZ_CHECK(memchr(error->text, '\0', sizeof error->text) != NULL);
    FUZZ_CHECK(strncmp(error->text, path, strlen(path)) == 0 && strchr(error->text, '\n') == NULL);
}

static void take_settings(const char *text, size_t size, goe_settings_t *settings) {
    char assignment[ASSIGNMENT_MAX];
    setting_fault_t fault;
    while (text != NULL && size > 0) {
        const char *end = memchr(text, '\n', size);
        const size_t length = end != NULL ? (size_t)(end - text) : size;
        const goe_settings_t before = *settings;
        (void)snprintf(assignment, sizeof assignment, "%.*s", (int)(length < 199u ? length : 199u), text);
        if (!setting_assign(settings, assignment, &fault) || !settings_in_range(settings, &fault)) {
            *settings = before;
        }
        size -= end != NULL ? length + 1u : length;
        text += end != NULL ? length + 1u : length;
    }
}

static void take_row(const frame_t *frame, track_table_t *tracks) {
    goe_image_t image;
    goe_estimate_t estimate;
    goe_estimator_t *estimator = track_table_get(tracks, frame->id);
    FUZZ_CHECK(estimator != NULL);
    frame_to_image(frame, &image);
    const goe_status_t status = goe_update(estimator, &image, &estimate);
    FUZZ_CHECK((int)status >= (int)GOE_NO_HEIGHT && (int)status <= (int)GOE_NO_DETECTION);
    FUZZ_CHECK(estimate_write_row(sink, frame->time_text, frame->id, status, &estimate, true));
    fuzz_counts[ROWS].times++;
    fuzz_counts[FRESH].times += estimate.fresh ? 1u : 0u;
}

static void take_frames(const char *text, size_t size, const goe_settings_t *settings) {
    input_error_t error;
    frame_t frame;
    const char *bad = NULL;
    const char *path = fuzz_file(1, "frames.csv", text, size);
    frame_reader_t *reader = frame_reader_open(path, camera_file_cameras(settings), &error);
    if (reader == NULL) {
        check_error(&error, path);
        fuzz_counts[LOGS_REFUSED].times++;
        return;
    }
    track_table_t *tracks = track_table_new(settings, &bad);
    if (tracks == NULL) { /* a camera whose numbers do not fit each other: goe_init() alone compares them */
        FUZZ_CHECK(bad != NULL && strncmp(bad, "camera", strlen("camera")) == 0);
        fuzz_counts[CAMERAS_REFUSED].times++;
        frame_reader_close(reader);
        return;
    }
    frame_reader_result_t result = frame_reader_next(reader, &frame, &error);
    for (int i = 0; i < ROWS_MAX && result == FRAME_READER_ROW; i++) {
        take_row(&frame, tracks);
        result = frame_reader_next(reader, &frame, &error);
    }
    if (result == FRAME_READER_ERROR) {
        check_error(&error, path);
        FUZZ_CHECK(frame_reader_next(reader, &frame, &error) == FRAME_READER_ERROR);
    }
    fuzz_counts[result == FRAME_READER_ERROR ? LOGS_REFUSED : LOGS].times++;
    track_table_free(tracks);
    frame_reader_close(reader);
}

static void take_log(const char *camera, size_t camera_size, const char *frames, size_t frames_size) {
    goe_settings_t settings;
    input_error_t error;
    const char *assignments = NULL;
    size_t assignments_size = 0;
    goe_settings_default(&settings);
    frames_size = fuzz_split(frames, frames_size, &assignments, &assignments_size);
    take_settings(assignments, assignments_size, &settings);
    const char *path = fuzz_file(0, "camera.ini", camera, camera_size);
    if (!camera_file_read(path, &settings, &error)) {
        check_error(&error, path);
        fuzz_counts[CAMERAS_REFUSED].times++;
        return;
    }
    fuzz_counts[CAMERAS].times++;
    take_frames(frames, frames_size, &settings);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const char *text = size > 0 ? (const char *)data : "";
    const char *rest = NULL;
    size_t rest_size = 0;
    if (sink == NULL) {
        sink = fopen("/dev/null", "w");
        FUZZ_CHECK(sink != NULL);
    }
    fuzz_counts[INPUTS].times++;
    const size_t first = fuzz_split(text, size, &rest, &rest_size);
    if (rest == NULL) {
        take_log(usual_camera, sizeof usual_camera - 1u, text, first);
    } else {
        take_log(text, first, rest, rest_size);
    }
    return 0;
}
