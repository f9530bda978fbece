/*
 * campaign_probe CASE NOISE CYLINDER METHOD MODEL WINDOW - flies a case of the paper with other sensors, runs the library over
 * it in-process, as goe_campaign does, and writes the output of goe_replay.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_run.h"
#include "estimate_writer.h"
#include "log_writer.h"

#define US_PER_S 1000000

static int fail(const char *what, const char *why) {
    (void)fprintf(stderr, "campaign_probe: %s: %s\n", what, why);
    return EXIT_FAILURE;
}

static int run(const flight_case_t *setup, const flight_log_t *log, case_setting_t setting) {
    case_sample_t *samples = calloc(log->count + 1, sizeof *samples);
    const char *fault = samples != NULL ? case_run(setup, log, setting, samples) : "out of memory";
    bool written = fault == NULL && estimate_write_header(stdout, false);
    for (size_t i = 0; i < log->count && written; i++) {
        char time_text[64];
        const int64_t time_us = log->frames[i].time_us;
        (void)snprintf(time_text, sizeof time_text, "%" PRId64 ".%06" PRId64, time_us / US_PER_S, time_us % US_PER_S);
        written = estimate_write_row(stdout, time_text, LOG_TRACK_ID, samples[i].status, &samples[i].estimate, false);
    }
    free(samples);
    return written && fflush(stdout) == 0 ? EXIT_SUCCESS : fail("run", fault != NULL ? fault : "write error");
}

int main(int argc, char **argv) {
    flight_case_t setup;
    flight_log_t log;
    if (argc < 7 || argc > 9) {
        return fail(
            "usage",
            "CASE NOISE CYLINDER METHOD MODEL WINDOW [ROLL of an aircraft that logs boxes [YAW of a second camera]]");
    }
    const scenario_t scenario = scenario_get((int)strtol(argv[1], NULL, 10));
    flight_case_paper(&setup, &scenario);
    if (!sensor_noise_parse(argv[2], &setup.noise)) {
        return fail(argv[2], SENSOR_NOISE_FORMS);
    }
    setup.cylinder_model = strcmp(argv[3], "cloud") == 0 ? CYLINDER_CLOUD : CYLINDER_TANGENT;
    if (argc >= 8) {
        setup.features = LOG_BOXES;
        setup.roll_amplitude_deg = strtod(argv[7], NULL);
    }
    if (argc == 9) {
        setup.cameras = 2;
        setup.camera[1] = setup.camera[0];
        setup.camera[1].mount_yaw_deg = strtod(argv[8], NULL);
    }
    setup.seed = 1;
    const char *fault = flight_case_fly(&setup, &log);
    if (fault != NULL) {
        return fail("fly", fault);
    }
    const case_setting_t setting = {strcmp(argv[4], "filter") == 0 ? GOE_METHOD_FILTER : GOE_METHOD_WINDOW,
                                    strcmp(argv[5], "disc") == 0 ? GOE_MODEL_DISC : GOE_MODEL_AUTO,
                                    (int)strtol(argv[6], NULL, 10)};
    const int status = run(&setup, &log, setting);
    flight_log_free(&log);
    return status;
}
