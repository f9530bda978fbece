/*
 * goe_sim - flies one case past a ground obstacle and writes what its camera and sensors report as an observation log.
 *
 * Exit status: 0 done; 1 the flight ended before its time (log written); 2 bad usage or bad input, nothing written.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <float.h>
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flight_case.h"
#include "log_writer.h"
#include "option_fault.h"
#include "scenario.h"
#include "scenario_file.h"
#include "standard_output.h"
#include "text_numbers.h"
#include "turbulence.h"

#define EXIT_ENDED_EARLY 1
#define EXIT_BAD_USAGE 2
#define FAULT_SIZE 4608

#define SEED_SHIFT 48

#define NOT_SAID (-DBL_MAX)

/* Options that take a word; their numbers are what popt returns for them. */
enum {
    WORD_OBSTACLE = 1,
    WORD_PATH,
    WORD_SPEED_PROFILE,
    WORD_WIND,
    WORD_NOISE,
    WORD_CYLINDER,
    WORD_FLIGHT,
    WORD_FEATURES,
    WORD_SECOND_CAMERA,
    WORD_SCENARIO,
    WORD_OUT,
    WORD_COUNT
};

/* What the command line says. NOT_SAID or null: nothing. */
typedef struct {
    char *word[WORD_COUNT];
    double x0, z0, reach, run, alpha, altitude, glide, speed, fps, course;
    double roll_amplitude, roll_rate;
    double wind_speed, wind_from, flight_start;
    double image_width, image_height, fx, fy, cx, cy, k1, k2, p1, p2, k3;
    double camera_roll, camera_pitch, camera_yaw, offset_x, offset_y, offset_z;
    double pixel_noise, outlier_rate, outlier_size, detector_px, detector_width, detector_correlation;
    double box_px, box_share, box_correlation;
    double attitude_bias, attitude_noise, position_walk, velocity_bias, altimeter_bias, drop_rate, time_jitter;
    long long seed;
    int paper_case, list_cases, rounding, help, version;
} arguments_t;

static arguments_t given;
static scenario_file_t scenario_file;

/* Where the scenario file gave an option, so that a value is blamed there if it turns out wrong later. */
#define FILE_OPTIONS_MAX 128
typedef struct {
    char name[32];
    unsigned long line;
} file_option_t;

static struct {
    const char *path; /* null: there is no such file */
    int count;
    file_option_t option[FILE_OPTIONS_MAX];
} from_file;

static struct {
    int count;
    const char **word;
} command_line;

static char *scenario_path; /* from_file.path, to be freed */

#define NUMBER(name, variable, unit, text) {name, '\0', POPT_ARG_DOUBLE, &given.variable, 0, text, unit}
#define WORD(name, number, form, text) {name, '\0', POPT_ARG_STRING, NULL, number, text, form}
static struct poptOption scene_options[] = {
    WORD("obstacle", WORD_OBSTACLE, "WHAT", OBSTACLE_FORMS "; default cylinder"),
    NUMBER("x0", x0, "M",
           "side distance of its center from the course at the start, right positive, as x0_m of the answers"),
    NUMBER("z0", z0, "M", "distance of its center along the course, instead of the way flown by --reach"),
    NUMBER("alpha", alpha, "DEG", "its length axis from the course, clockwise as viewed from above"),
    NUMBER("reach", reach, "S", "time to reach the obstacle"),
    NUMBER("run", run, "S", "length of the run"),
    NUMBER("altitude", altitude, "M", "height over ground at reach time"),
    NUMBER("glide", glide, "DEG", "slope, positive down"),
    NUMBER("speed", speed, "MPS", "speed over ground in still air; default 17"),
    NUMBER("course", course, "DEG", "intended flight direction, clockwise from north; default 0"),
    WORD("path", WORD_PATH, "WHAT", "straight, arc:R (R > 0 turns right) or weave:A,T (amplitude m, period s)"),
    WORD("speed-profile", WORD_SPEED_PROFILE, "WHAT", "constant or ramp:A (m/s^2)"),
    WORD("wind", WORD_WIND, "WHAT", "turbulence: none, dryden:light or dryden:moderate"),
    NUMBER("roll-amplitude-deg", roll_amplitude, "DEG",
           "the aircraft rolls by a sine, on top of what it flies; default 0"),
    NUMBER("roll-rate-hz", roll_rate, "HZ", "frequency of the sine; default 0.4"),
    NUMBER("wind-speed", wind_speed, "MPS", "mean wind"),
    NUMBER("wind-from", wind_from, "DEG", "where the mean wind comes from"),
    WORD("flight", WORD_FLIGHT, "FILE",
         "recorded flight: the camera sees from its true pose, the log carries the estimated one"),
    NUMBER("flight-start", flight_start, "S", "where in the recording the run starts"),
    POPT_TABLEEND};

static struct poptOption camera_options[] = {
    NUMBER("fps", fps, "HZ", "images per second; default 8"),
    NUMBER("image-width", image_width, "PX", "default 1280"),
    NUMBER("image-height", image_height, "PX", "default 1280"),
    NUMBER("fx", fx, "PX", "focal length; default 914"),
    NUMBER("fy", fy, "PX", "default: fx"),
    NUMBER("cx", cx, "PX", "principal point; default half the image width"),
    NUMBER("cy", cy, "PX", "default half the image height"),
    NUMBER("k1", k1, "-", "lens distortion, OpenCV's meaning"),
    NUMBER("k2", k2, "-", NULL),
    NUMBER("p1", p1, "-", NULL),
    NUMBER("p2", p2, "-", NULL),
    NUMBER("k3", k3, "-", NULL),
    NUMBER("yaw-camera", camera_yaw, "DEG", "mounting, negative looks left; default -30"),
    NUMBER("pitch-camera", camera_pitch, "DEG", "mounting, negative looks down"),
    NUMBER("roll-camera", camera_roll, "DEG", "mounting"),
    NUMBER("offset-x", offset_x, "M", "camera from the position's reference point, body forward"),
    NUMBER("offset-y", offset_y, "M", "body right"),
    NUMBER("offset-z", offset_z, "M", "body down"),
    WORD("second-camera", WORD_SECOND_CAMERA, "YAW,PITCH",
         "another camera like the first, mounted so (DEG); a row is that of the one that sees the whole obstacle, or "
         "has it nearer to its axis"),
    WORD("features", WORD_FEATURES, "WHAT",
         "what the log carries: points (left, right, top), corners (base corners too) or boxes (upright bounding "
         "boxes); "
         "default corners"),
    WORD("cylinder", WORD_CYLINDER, "WHAT", "tangent (exact) or cloud (points on the wall); default tangent"),
    POPT_TABLEEND};

static struct poptOption noise_options[] = {
    WORD("noise", WORD_NOISE, "WHAT",
         SENSOR_NOISE_FORMS "; default rounding, of boxes detector. The options below change single figures of it"),
    {"rounding", '\0', POPT_ARG_INT, &given.rounding, 0, "1: whole pixels, 0: not", "0|1"},
    NUMBER("pixel-noise", pixel_noise, "PX", "one sigma, white"),
    NUMBER("outlier-rate", outlier_rate, "0..1", "share of features that are displaced"),
    NUMBER("outlier-size", outlier_size, "PX", "by so much, in a random direction"),
    NUMBER("detector-px", detector_px, "PX", "detector noise, constant part of one sigma"),
    NUMBER("detector-width", detector_width, "0..", "detector noise, share of the silhouette's width"),
    NUMBER("detector-correlation", detector_correlation, "0..1", "detector noise, from frame to frame"),
    NUMBER("box-px", box_px, "PX", "a box's sides: one sigma, white; default of boxes 0.5"),
    NUMBER("box-share", box_share, "0..",
           "one sigma of the slowly varying error, share of the box's width (left, right) or height (top, bottom); "
           "default 0.04"),
    NUMBER("box-correlation", box_correlation, "S", "correlation time of this error; default 1"),
    NUMBER("attitude-bias", attitude_bias, "DEG", "one sigma per body axis, constant over a run"),
    NUMBER("attitude-noise", attitude_noise, "DEG", "one sigma per body axis, white"),
    NUMBER("position-walk", position_walk, "M", "random walk, one sigma per axis after a second"),
    NUMBER("velocity-bias", velocity_bias, "MPS", "one sigma per axis, constant over a run"),
    NUMBER("altimeter-bias", altimeter_bias, "M", "one sigma, constant over a run"),
    NUMBER("drop-rate", drop_rate, "0..1", "share of frames that are lost"),
    NUMBER("time-jitter", time_jitter, "S", "largest displacement of an exposure"),
    {"seed", '\0', POPT_ARG_LONGLONG, &given.seed, 0, "of all random numbers; default 1", "N"},
    POPT_TABLEEND};

static struct poptOption program_options[] = {
    {NULL, '\0', POPT_ARG_INCLUDE_TABLE, scene_options, 0, "Obstacle and flight:", NULL},
    {NULL, '\0', POPT_ARG_INCLUDE_TABLE, camera_options, 0, "Camera:", NULL},
    {NULL, '\0', POPT_ARG_INCLUDE_TABLE, noise_options, 0, "Sensors:", NULL},
    WORD("scenario", WORD_SCENARIO, "FILE",
         "flight and obstacles from a file, [flight] and [obstacle N]; options given here override it"),
    {"case", '\0', POPT_ARG_INT, &given.paper_case, 0, "start from this case of the paper's campaign", "N"},
    {"list-cases", '\0', POPT_ARG_NONE, &given.list_cases, 0, "list the paper's campaign and stop", NULL},
    WORD("out", WORD_OUT, "DIR", "folder of the log; one that goe_sim wrote there is replaced"),
    {"help", 'h', POPT_ARG_NONE, &given.help, 0, "print this and exit", NULL},
    {"version", 'V', POPT_ARG_NONE, &given.version, 0, "print the version and exit", NULL},
    POPT_TABLEEND};

static void nothing_said(void) {
    memset(&given, 0, sizeof given);
    struct poptOption *tables[] = {scene_options, camera_options, noise_options};
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        for (struct poptOption *option = tables[i]; option->longName != NULL; option++) {
            if (option->argInfo == POPT_ARG_DOUBLE) {
                double *value = option->arg;
                *value = NOT_SAID;
            }
        }
    }
    given.paper_case = -1;
    given.rounding = -1;
    given.seed = 1;
}

/* The text after the program's name, on stderr; returns the exit status. */
static int complain(const char *what, const char *reason) {
    (void)fprintf(stderr, "goe_sim: %s: %s\n", what, reason);
    return EXIT_BAD_USAGE;
}

static bool is_on_command_line(const char *name, size_t length) {
    for (int i = 1; i < command_line.count; i++) {
        const char *word = command_line.word[i];
        const size_t dashes = strspn(word, "-");
        const char after = strlen(word) >= dashes + length ? word[dashes + length] : 'x';
        if (dashes > 0 && strncmp(word + dashes, name, length) == 0 && (after == '\0' || after == '=')) {
            return true;
        }
    }
    return false;
}

/* Line of the scenario file that gave an option its value; 0: the value is not from there. */
static unsigned long line_in_file(const char *name, size_t length) {
    for (int i = from_file.count - 1; i >= 0; i--) {
        const file_option_t *option = &from_file.option[i];
        if (strlen(option->name) == length && strncmp(option->name, name, length) == 0) {
            return is_on_command_line(name, length) ? 0 : option->line;
        }
    }
    return 0;
}

/* Of the options that a reason begins with, as in "run, reach: must be ...", the first that the file gave; 0: none. */
static unsigned long line_of_reason(const char *reason) {
    const size_t names = strcspn(reason, ":");
    unsigned long line = 0;
    for (size_t begin = 0; begin < names && line == 0;) {
        const size_t length = strcspn(reason + begin, ",:");
        line = line_in_file(reason + begin, length);
        begin += length + strspn(reason + begin + length, ", ");
    }
    return line;
}

/* A flight that cannot be. */
static int complain_of_flight(const char *reason) {
    const unsigned long line = line_of_reason(reason);
    if (line == 0) {
        return complain("cannot fly", reason);
    }
    (void)fprintf(stderr, "goe_sim: %s:%lu: %s\n", from_file.path, line, reason);
    return EXIT_BAD_USAGE;
}

/* What an option was given; null: it takes no word, or has none. */
static const char *word_of(const char *option) {
    static struct poptOption *const tables[] = {scene_options, camera_options, noise_options};
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        for (const struct poptOption *known = tables[i]; known->longName != NULL; known++) {
            if (strcmp(known->longName, option) == 0) {
                return known->val > 0 ? given.word[known->val] : NULL;
            }
        }
    }
    return NULL;
}

/* A value that is not understood, with what it may be. */
static int complain_of_value(const char *option, const char *reason) {
    const char *name = option + strspn(option, "-"), *word = word_of(name);
    const unsigned long line = line_in_file(name, strlen(name));
    if (line != 0) {
        (void)fprintf(stderr, "goe_sim: %s:%lu: %s: ", from_file.path, line, name);
    } else {
        (void)fprintf(stderr, "goe_sim: %s: ", option);
    }
    if (word != NULL) {
        (void)fprintf(stderr, "'%s' cannot be taken: ", excerpt_of(word, strlen(word)).text);
    }
    (void)fprintf(stderr, "%s\n", reason);
    return EXIT_BAD_USAGE;
}

/* A NaN was said: the checks of the values refuse it. */
static bool was_said(double value) { return isnan(value) || value < NOT_SAID || value > NOT_SAID; }

static void set(double *value, double said) {
    if (was_said(said)) {
        *value = said;
    }
}

static void set_flight(flight_case_t *setup) {
    if (was_said(given.x0)) {
        setup->x0_m = 0.0 - given.x0; /* a case's is the paper's: left is positive */
    }
    set(&setup->z0_m, given.z0);
    set(&setup->alpha_deg, given.alpha);
    set(&setup->reach_s, given.reach);
    set(&setup->run_s, given.run);
    set(&setup->altitude_m, given.altitude);
    set(&setup->glide_deg, given.glide);
    set(&setup->speed_mps, given.speed);
    set(&setup->fps_hz, given.fps);
    set(&setup->course_deg, given.course);
    set(&setup->roll_amplitude_deg, given.roll_amplitude);
    set(&setup->roll_rate_hz, given.roll_rate);
    set(&setup->wind_mps, given.wind_speed);
    set(&setup->wind_from_deg, given.wind_from);
    set(&setup->recording_start_s, given.flight_start);
    setup->course_given = was_said(given.course);
    setup->altitude_given = was_said(given.altitude);
    setup->seed = (uint64_t)given.seed;
}

static void set_camera(camera_t *camera) {
    set(&camera->width_px, given.image_width);
    set(&camera->height_px, given.image_height);
    camera->cx_px = 0.5 * camera->width_px;
    camera->cy_px = 0.5 * camera->height_px;
    set(&camera->fx_px, given.fx);
    camera->fy_px = camera->fx_px;
    set(&camera->fy_px, given.fy);
    set(&camera->cx_px, given.cx);
    set(&camera->cy_px, given.cy);
    set(&camera->k1, given.k1);
    set(&camera->k2, given.k2);
    set(&camera->p1, given.p1);
    set(&camera->p2, given.p2);
    set(&camera->k3, given.k3);
    set(&camera->mount_roll_deg, given.camera_roll);
    set(&camera->mount_pitch_deg, given.camera_pitch);
    set(&camera->mount_yaw_deg, given.camera_yaw);
    set(&camera->offset_m.x, given.offset_x);
    set(&camera->offset_m.y, given.offset_y);
    set(&camera->offset_m.z, given.offset_z);
}

/* False: the word is not understood. To be called when the first camera is set. */
static bool set_second_camera(flight_case_t *setup) {
    double angle_deg[2];
    if (given.word[WORD_SECOND_CAMERA] == NULL) {
        return true;
    }
    setup->cameras = 2;
    setup->camera[1] = setup->camera[0];
    if (!text_numbers(given.word[WORD_SECOND_CAMERA], "", angle_deg, 2)) {
        return false;
    }
    setup->camera[1].mount_yaw_deg = angle_deg[0];
    setup->camera[1].mount_pitch_deg = angle_deg[1];
    return true;
}

static void set_noise(sensor_noise_t *noise) {
    set(&noise->pixel_px, given.pixel_noise);
    set(&noise->outlier_rate, given.outlier_rate);
    set(&noise->outlier_px, given.outlier_size);
    set(&noise->detector_px, given.detector_px);
    set(&noise->detector_width, given.detector_width);
    set(&noise->detector_correlation, given.detector_correlation);
    set(&noise->box_px, given.box_px);
    set(&noise->box_share, given.box_share);
    set(&noise->box_correlation_s, given.box_correlation);
    set(&noise->attitude_bias_deg, given.attitude_bias);
    set(&noise->attitude_noise_deg, given.attitude_noise);
    set(&noise->position_walk_m, given.position_walk);
    set(&noise->velocity_bias_mps, given.velocity_bias);
    set(&noise->altimeter_m, given.altimeter_bias);
    set(&noise->drop_rate, given.drop_rate);
    set(&noise->time_jitter_s, given.time_jitter);
    if (given.rounding >= 0) {
        noise->rounding = given.rounding != 0;
    }
}

static bool parse_features(const char *text, log_features_t *features) {
    static const char *const names[] = {[LOG_CORNERS] = "corners", [LOG_POINTS] = "points", [LOG_BOXES] = "boxes"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(text, names[i]) == 0) {
            *features = (log_features_t)i;
            return true;
        }
    }
    return false;
}

/* The case of the command line; otherwise the name of the bad option, and what it may be. */
static const char *set_case(flight_case_t *setup, const char **reason) {
    if (given.paper_case >= scenario_count() || given.paper_case < -1) {
        *reason = "--list-cases lists them";
        return "--case";
    }
    *reason = OBSTACLE_FORMS;
    if (!flight_case_default(setup, given.word[WORD_OBSTACLE] != NULL ? given.word[WORD_OBSTACLE] : "cylinder")) {
        return "--obstacle";
    }
    if (given.paper_case >= 0) {
        const scenario_t scenario = scenario_get(given.paper_case);
        *reason = "--case has an obstacle of its own";
        if (given.word[WORD_OBSTACLE] != NULL) {
            return "--obstacle";
        }
        flight_case_paper(setup, &scenario);
    }
    *reason = "straight, arc:R (at least 1 m) or weave:A,T";
    if (given.word[WORD_PATH] != NULL && !path_parse(given.word[WORD_PATH], &setup->path)) {
        return "--path";
    }
    *reason = "constant or ramp:A";
    if (given.word[WORD_SPEED_PROFILE] != NULL && !path_parse_speed(given.word[WORD_SPEED_PROFILE], &setup->path)) {
        return "--speed-profile";
    }
    *reason = "none, dryden:light or dryden:moderate";
    if (given.word[WORD_WIND] != NULL && !turbulence_parse(given.word[WORD_WIND], &setup->w20_mps)) {
        return "--wind";
    }
    *reason = "points, corners or boxes";
    if (given.word[WORD_FEATURES] != NULL && !parse_features(given.word[WORD_FEATURES], &setup->features)) {
        return "--features";
    }
    *reason = SENSOR_NOISE_FORMS;
    const char *usual_noise = setup->features == LOG_BOXES ? "detector" : NULL;
    const char *noise = given.word[WORD_NOISE] != NULL ? given.word[WORD_NOISE] : usual_noise;
    if (noise != NULL && !sensor_noise_parse(noise, &setup->noise)) {
        return "--noise";
    }
    *reason = "tangent or cloud";
    if (given.word[WORD_CYLINDER] != NULL) {
        setup->cylinder_model = strcmp(given.word[WORD_CYLINDER], "cloud") == 0 ? CYLINDER_CLOUD : CYLINDER_TANGENT;
        if (setup->cylinder_model == CYLINDER_TANGENT && strcmp(given.word[WORD_CYLINDER], "tangent") != 0) {
            return "--cylinder";
        }
    }
    *reason = "must be a number";
    if (isnan(given.z0)) {
        return "--z0";
    }
    *reason = "must be 0 or more";
    if (given.seed < 0) {
        return "--seed";
    }
    set_flight(setup);
    set_camera(&setup->camera[0]);
    set_noise(&setup->noise);
    *reason = "YAW,PITCH in degrees";
    return set_second_camera(setup) ? NULL : "--second-camera";
}

static int list_cases(void) {
    (void)printf("case obstacle    x0_m altitude_m alpha_deg glide_deg run_s reach_s\n");
    for (int i = 0; i < scenario_count(); i++) {
        const scenario_t s = scenario_get(i);
        (void)printf("%4d %-10s %5g %10g %9g %9g %5g %7g\n", i, s.obstacle, 0.0 - s.x0_m, s.altitude_m, s.alpha_deg,
                     s.glide_deg, s.run_s, s.reach_s);
    }
    return EXIT_SUCCESS;
}

/* Past all obstacles. The flight ends with the first one that it ends at. Null, or why it could not be flown; the logs are to be
 * freed either way. */
static const char *fly_past_all(const flight_case_t *setup, flight_log_t *log, size_t *count) {
    const char *reason = flight_case_fly(setup, log);
    *count = reason == NULL ? 1 : 0;
    for (int i = 0; i < scenario_file.neighbors && reason == NULL; i++) {
        /* no other flight's seed: small numbers are what people give */
        const uint64_t seed = setup->seed ^ ((uint64_t)(i + 1) << SEED_SHIFT);
        reason = flight_log_of_neighbor(setup, log, &scenario_file.neighbor[i], seed, &log[*count]);
        *count += reason == NULL ? 1u : 0u;
    }
    for (size_t i = 1; i < *count; i++) {
        if (log[i].count < log[0].count) {
            log[0].count = log[i].count;
            log[0].ended = log[i].ended;
        }
    }
    return reason;
}

static int write_logs(const flight_case_t *setup, const flight_logs_t *logs) {
    char fault[FAULT_SIZE];
    const flight_log_t *log = logs->log;
    if (!log_write(given.word[WORD_OUT], setup, logs, fault, sizeof fault)) {
        (void)fprintf(stderr, "goe_sim: %s\n", fault);
        return EXIT_BAD_USAGE;
    }
    if (log->ended == NULL) {
        return EXIT_SUCCESS;
    }
    const double last_s = log->count > 0 ? (double)log->frames[log->count - 1].time_us * 1e-6 : 0.0;
    (void)fprintf(stderr, "goe_sim: %s: log ends at %g s: %s\n", given.word[WORD_OUT], last_s, log->ended);
    return EXIT_ENDED_EARLY;
}

static int fly_and_write(const flight_case_t *setup) {
    flight_log_t log[1 + SCENARIO_NEIGHBORS_MAX];
    size_t count = 0;
    const char *reason = fly_past_all(setup, log, &count);
    const flight_logs_t logs = {log, count};
    const int status = reason != NULL ? complain_of_flight(reason) : write_logs(setup, &logs);
    for (size_t i = 0; i < count; i++) {
        flight_log_free(&log[i]);
    }
    return status;
}

/* An input that the log would replace; null: none. */
static const char *replaced_input(void) {
    static const int inputs[] = {WORD_FLIGHT, WORD_SCENARIO};
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        const char *path = given.word[inputs[i]];
        if (path != NULL && log_write_replaces(given.word[WORD_OUT], path)) {
            return path;
        }
    }
    return NULL;
}

/* An option that a recorded flight decides itself, or that needs one; null: none. */
static const char *contradicted(const char **reason) {
    const struct {
        bool said;
        const char *option;
    } own[] = {
        {was_said(given.speed), "--speed"},           {was_said(given.glide), "--glide"},
        {given.word[WORD_PATH] != NULL, "--path"},    {given.word[WORD_SPEED_PROFILE] != NULL, "--speed-profile"},
        {given.word[WORD_WIND] != NULL, "--wind"},    {was_said(given.wind_speed), "--wind-speed"},
        {was_said(given.wind_from), "--wind-from"},   {was_said(given.roll_amplitude), "--roll-amplitude-deg"},
        {was_said(given.roll_rate), "--roll-rate-hz"}};
    const bool recorded = given.word[WORD_FLIGHT] != NULL;
    *reason = recorded ? "the recorded flight of --flight has its own" : "needs --flight";
    for (size_t i = 0; recorded && i < sizeof own / sizeof own[0]; i++) {
        if (own[i].said) {
            return own[i].option;
        }
    }
    return !recorded && was_said(given.flight_start) ? "--flight-start" : NULL;
}

static int fly(void) {
    flight_case_t setup;
    const char *reason;
    const char *option = set_case(&setup, &reason);
    if (option == NULL) {
        option = contradicted(&reason);
    }
    if (option != NULL) {
        return complain_of_value(option, reason);
    }
    if (given.word[WORD_OUT] == NULL) {
        return complain("--out", "is needed: the folder of the log");
    }
    if (replaced_input() != NULL) {
        return complain(replaced_input(), "the log would replace it");
    }
    if (given.word[WORD_FLIGHT] == NULL) {
        return fly_and_write(&setup);
    }
    input_error_t error;
    recorded_flight_t recording;
    if (!recorded_flight_read(given.word[WORD_FLIGHT], &recording, &error)) {
        (void)fprintf(stderr, "goe_sim: %s\n", error.text);
        return EXIT_BAD_USAGE;
    }
    setup.recording = &recording;
    const int status = fly_and_write(&setup);
    recorded_flight_free(&recording);
    return status;
}

static void free_words(void) {
    free(scenario_path);
    for (size_t i = 0; i < WORD_COUNT; i++) {
        free(given.word[i]);
    }
}

/* popt's verdict: -1, or an error. The last of several words for one option counts. */
static int read_options(poptContext context) {
    int option = poptGetNextOpt(context);
    while (option > 0) {
        free(given.word[option]);
        given.word[option] = poptGetOptArg(context);
        option = poptGetNextOpt(context);
    }
    return option;
}

static void note_line(const char *name, unsigned long line) {
    if (from_file.count < FILE_OPTIONS_MAX) {
        file_option_t *option = &from_file.option[from_file.count++];
        (void)snprintf(option->name, sizeof option->name, "%s", name);
        option->line = line;
    }
}

/* An option of a scenario file, as if it stood on the command line. */
static bool take_option(const char *name, const char *value, unsigned long line, char reason[SCENARIO_REASON_MAX]) {
    static const char *const no_options[] = {"scenario", "out", "case", "list-cases", "help", "version"};
    for (size_t i = 0; i < sizeof no_options / sizeof no_options[0]; i++) {
        if (strcmp(name, no_options[i]) == 0) {
            (void)snprintf(reason, SCENARIO_REASON_MAX, "belongs on the command line");
            return false;
        }
    }
    char option[SCENARIO_REASON_MAX];
    const int length = snprintf(option, sizeof option, "--%s=%s", name, value);
    if (length < 0 || (size_t)length >= sizeof option) {
        (void)snprintf(reason, SCENARIO_REASON_MAX, "too long");
        return false;
    }
    const char *argv[] = {"goe_sim", option, NULL};
    note_line(name, line);
    poptContext context = poptGetContext("goe_sim", 2, argv, program_options, 0);
    const int error = read_options(context);
    if (error < -1) {
        option_fault_bare(reason, SCENARIO_REASON_MAX, program_options, name, value, error);
    }
    (void)poptFreeContext(context);
    return error >= -1;
}

/* The file's options first, then once more those of the command line, which go before them. */
static bool read_scenario(poptContext context) {
    char fault[FAULT_SIZE];
    char *path = scenario_path = given.word[WORD_SCENARIO]; /* the second reading of the options finds it again */
    given.word[WORD_SCENARIO] = NULL;
    const bool read = scenario_file_read(path, take_option, &scenario_file, fault, sizeof fault);
    from_file.path = path;
    if (!read) {
        (void)fprintf(stderr, "goe_sim: %s\n", fault);
        return false;
    }
    poptResetContext(context);
    return read_options(context) >= -1;
}

int main(int argc, const char **argv) {
    nothing_said();
    command_line.count = argc;
    command_line.word = argv;
    standard_output_watch("goe_sim", EXIT_BAD_USAGE);
    poptContext context = poptGetContext("goe_sim", argc, argv, program_options, 0);
    const int error = read_options(context);
    int status;
    if (error < -1) {
        const char *bad = option_blamed(context, argc, argv);
        char reason[OPTION_FAULT_MAX];
        option_fault(reason, context, program_options, bad, error);
        status = complain(bad, reason);
    } else if (poptPeekArg(context) != NULL) {
        status = complain(poptPeekArg(context), "options only; see --help");
    } else if (given.help) {
        poptPrintHelp(context, stdout, 0);
        status = EXIT_SUCCESS;
    } else if (given.version) {
        (void)puts("goe_sim " GOE_VERSION);
        status = EXIT_SUCCESS;
    } else if (given.word[WORD_SCENARIO] != NULL && !read_scenario(context)) {
        status = EXIT_BAD_USAGE;
    } else {
        status = given.list_cases ? list_cases() : fly();
    }
    free_words();
    (void)poptFreeContext(context);
    return status;
}
