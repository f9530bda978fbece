/* goe_replay: runs the library over a recorded observation log. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "camera_file.h"
#include "estimate_writer.h"
#include "frame.h"
#include "frame_reader.h"
#include "goe.h"
#include "input_error.h"
#include "log_hints.h"
#include "nearest_name.h"
#include "option_fault.h"
#include "output_file.h"
#include "read_progress.h"
#include "renamed_names.h"
#include "settings_text.h"
#include "standard_output.h"
#include "track_table.h"

#ifndef GOE_VERSION
#define GOE_VERSION "development"
#endif

#define PROGRAM "goe_replay"
#define WINDOW_MIN 3
#define CHOICE_FAULT_MAX 256

enum { EXIT_DONE = 0, EXIT_NO_ESTIMATE = 1, EXIT_BAD_INPUT = 2 };

/* --------------------------------------------------------------------------------------------------------- options -- */

typedef struct {
    char *method, *model, *out;
    char *camera, *frames; /* after parse_options(): the paths to read */
    char **set;            /* NAME=VALUE, null at the end; null if there are none */
    int window;
    int residuals, help, version, settings;
} options_t;

static void free_options(options_t *options) {
    free(options->method);
    free(options->model);
    free(options->out);
    free(options->camera);
    free(options->frames);
    for (size_t i = 0; options->set != NULL && options->set[i] != NULL; i++) {
        free(options->set[i]);
    }
    free(options->set);
}

/* Bad usage. */
static bool complain(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s (see " PROGRAM " --help)\n", subject, reason);
    return false;
}

/* Anything else that stops the program, besides faults in the input. */
static bool give_up(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s\n", subject, reason);
    return false;
}

/* Whether the word is an old value of the option, which is reported. */
static bool refuses_renamed(const char *option, const char *word) {
    char both[CHOICE_FAULT_MAX], reason[CHOICE_FAULT_MAX];
    const int length = snprintf(both, sizeof both, "%s %s", option, word);
    const char *now = length > 0 && length < (int)sizeof both ? renamed_name(both, (size_t)length) : NULL;
    if (now != NULL) {
        (void)snprintf(reason, sizeof reason, "unknown value: now %s", now);
        (void)complain(both, reason);
    }
    return now != NULL;
}

/* Number of the name that equals a word; the first one's without a word. -1: unknown, which is reported. */
static int choose(const char *option, const char *word, const char *const *names, int count) {
    char reason[CHOICE_FAULT_MAX];
    if (word == NULL) {
        return 0;
    }
    if (refuses_renamed(option, word)) {
        return -1;
    }
    nearest_name_t nearest = nearest_name_of(word, strlen(word));
    int used = snprintf(reason, sizeof reason, "%s must be %s", option, names[0]);
    for (int i = 0; i < count; i++) {
        if (strcmp(word, names[i]) == 0) {
            return i;
        }
        nearest_name_try(&nearest, names[i]);
        if (i > 0) {
            const char *separator = i + 1 < count ? ", " : " or ";
            used += snprintf(reason + used, sizeof reason - (size_t)used, "%s%s", separator, names[i]);
        }
    }
    if (nearest.name != NULL) {
        (void)snprintf(reason + used, sizeof reason - (size_t)used, "; did you mean %s?", nearest.name);
    }
    (void)complain(excerpt_of(word, strlen(word)).text, reason);
    return -1;
}

static bool parse_method(const char *text, goe_method_t *method) {
    static const char *const names[] = {"filter", "window"};
    static const goe_method_t methods[] = {GOE_METHOD_FILTER, GOE_METHOD_WINDOW};
    const int chosen = choose("--method", text, names, (int)(sizeof names / sizeof names[0]));
    *method = chosen >= 0 ? methods[chosen] : *method;
    return chosen >= 0;
}

static bool parse_model(const char *text, goe_model_t *model) {
    static const char *const names[] = {"auto", "disc", "line"};
    static const goe_model_t models[] = {GOE_MODEL_AUTO, GOE_MODEL_DISC, GOE_MODEL_LINE};
    const int chosen = choose("--model", text, names, (int)(sizeof names / sizeof names[0]));
    *model = chosen >= 0 ? models[chosen] : *model;
    return chosen >= 0;
}

static bool check_window(const options_t *options) {
    char reason[CHOICE_FAULT_MAX];
    if (options->window >= WINDOW_MIN && options->window <= GOE_WINDOW_MAX) {
        return true;
    }
    (void)snprintf(reason, sizeof reason, "must be %d to %d, not %d", WINDOW_MIN, GOE_WINDOW_MAX, options->window);
    return complain("--window", reason);
}

/* directory/name in place of a path that was not given singly. */
static bool default_path(char **path, const char *directory, const char *name) {
    if (*path != NULL) {
        return true;
    }
    if (directory == NULL) {
        return complain("DIR", "missing: name the log's folder, or both --camera and --frames");
    }
    const size_t capacity = strlen(directory) + strlen(name) + 2u;
    *path = malloc(capacity);
    if (*path == NULL) {
        return give_up(directory, "out of memory");
    }
    const char *slash = *directory != '\0' && directory[strlen(directory) - 1u] == '/' ? "" : "/";
    (void)snprintf(*path, capacity, "%s%s%s", directory, slash, name);
    return true;
}

/* The last value of --set if it can be no setting: the log's folder, after a --set without a value. */
static const char *taken_by_set(const options_t *options) {
    const char *last = NULL;
    for (size_t i = 0; options->set != NULL && options->set[i] != NULL; i++) {
        last = options->set[i];
    }
    return last != NULL && strchr(last, '=') == NULL ? last : NULL;
}

static bool is_file(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

/* The option of `goe_tools convert` for an autopilot's log; NULL: the name is not that of one. */
static const char *convert_option(const char *path) {
    static const char *const options[][2] = {{".ulg", "ulog"}, {".bin", "dataflash"}, {".tlog", "tlog"}};
    const char *end = strrchr(path, '.');
    for (size_t i = 0; end != NULL && i < sizeof options / sizeof options[0]; i++) {
        if (strcasecmp(end, options[i][0]) == 0) {
            return options[i][1];
        }
    }
    return NULL;
}

static bool parse_arguments(poptContext context, const struct poptOption *table, int argc, const char *const *argv,
                            options_t *options) {
    const int result = poptGetNextOpt(context);
    if (result < -1) {
        const char *bad = option_blamed(context, argc, argv);
        char reason[OPTION_FAULT_MAX];
        option_fault(reason, context, table, bad, result);
        return complain(bad, reason);
    }
    if (options->help || options->version || options->settings) {
        return true;
    }
    const char *directory = poptGetArg(context);
    const char *surplus = poptPeekArg(context);
    if (surplus != NULL) {
        return complain(surplus, "one folder at a time");
    }
    if (directory == NULL && taken_by_set(options) != NULL) {
        setting_fault_t fault;
        goe_settings_t unused;
        goe_settings_default(&unused);
        (void)setting_assign(&unused, taken_by_set(options), &fault);
        return complain("--set", fault.text);
    }
    if (directory != NULL && is_file(directory)) {
        char reason[CHOICE_FAULT_MAX];
        const char *option = convert_option(directory);
        if (option != NULL) {
            (void)snprintf(reason, sizeof reason,
                           "is an autopilot's log; make an observation log of it: python -m goe_tools convert --%s",
                           option);
            return complain(directory, reason);
        }
        const char *slash = strrchr(directory, '/');
        (void)snprintf(reason, sizeof reason, "is a file; name its folder, %.*s",
                       slash != NULL ? (int)(slash - directory) : 1, slash != NULL ? directory : ".");
        return complain(directory, reason);
    }
    return default_path(&options->camera, directory, "camera.ini") &&
           default_path(&options->frames, directory, "frames.csv");
}

static bool set_by_name(char *const *set, goe_settings_t *settings) {
    setting_fault_t fault;
    for (size_t i = 0; set != NULL && set[i] != NULL; i++) {
        if (!setting_assign(settings, set[i], &fault)) {
            return complain("--set", fault.text);
        }
    }
    return settings_in_range(settings, &fault) || complain("--set", fault.text);
}

/* The window is checked before the settings by name, which would get the blame otherwise. */
static bool apply_options(const options_t *options, goe_settings_t *settings) {
    if (!parse_method(options->method, &settings->method) || !parse_model(options->model, &settings->model)) {
        return false;
    }
    settings->window.points = options->window;
    return check_window(options) && set_by_name(options->set, settings);
}

/* ------------------------------------------------------------------------------------------------------------ help -- */

static void print_help(poptContext context) {
    goe_settings_t defaults;
    goe_settings_default(&defaults);
    poptPrintHelp(context, stdout, 0);
    (void)puts(
        "\nDIR holds camera.ini and frames.csv. One row comes out for each row of frames.csv; a quantity that is not\n"
        "known is empty. The fields are named in the first line: meters, degrees, each quantity followed by its\n"
        "one-sigma (..._sd_...). suspect is 1 where the track contradicts its assumptions, and reason says "
        "why:\n"
        "widen the margins then.\n"
        "\nMETHOD: filter, the square-root information filter over the whole track, by default; window, the paper's\n"
        "sliding window. NAME=VALUE: a setting of goe.h, which describes its meaning and range; by default");
    (void)settings_print(stdout, &defaults);
    (void)puts("\nExit status: 0 done; 1 the log was read but no row gave an estimate; 2 bad usage or bad input, then\n"
               "nothing is written to FILE.");
}

/* ---------------------------------------------------------------------------------------------------------- replay -- */

#define STATUS_FIRST GOE_CORRUPTED
#define STATUS_LAST GOE_NO_DETECTION
#define STATUSES ((int)STATUS_LAST - (int)STATUS_FIRST + 1)

typedef struct {
    unsigned long rows[STATUSES]; /* by status */
    unsigned long estimates;      /* rows with a solution, stale ones included */
} tally_t;

static void count_row(tally_t *tally, goe_status_t status, const goe_estimate_t *estimate) {
    tally->rows[(int)status - (int)STATUS_FIRST]++;
    tally->estimates += (estimate->valid & GOE_HAS_POSITION) != 0 ? 1u : 0u;
}

static void explain_no_estimate(const char *path, const tally_t *tally) {
    const char *separator = "";
    (void)fprintf(stderr, PROGRAM ": %s: no row gave an estimate (", path);
    for (int i = 0; i < STATUSES; i++) {
        if (tally->rows[i] != 0) {
            /* NOLINTNEXTLINE(clang-analyzer-optin.core.EnumCastOutOfRange): only returned values were counted */
            (void)fprintf(stderr, "%s%s: %lu", separator, goe_status_text((goe_status_t)(i + (int)STATUS_FIRST)),
                          tally->rows[i]);
            separator = ", ";
        }
    }
    const unsigned long without = tally->rows[GOE_NO_DETECTION - (int)STATUS_FIRST];
    unsigned long rows = 0;
    for (int i = 0; i < STATUSES; i++) {
        rows += tally->rows[i];
    }
    (void)fprintf(stderr, "%s)%s\n", rows == 0 ? "there are no rows" : "",
                  rows > 0 && rows == without ? "; is there a column of a box, box_left_px, or of a point, left_u?"
                                              : "");
}

static bool print_error(const input_error_t *error) {
    (void)fprintf(stderr, "%s\n", error->text);
    return false;
}

static bool write_failed(const options_t *options) {
    (void)fprintf(stderr, PROGRAM ": %s: cannot be written: %s\n",
                  options->out != NULL ? options->out : "standard output", strerror(errno));
    return false;
}

static bool too_many_tracks(const options_t *options, const frame_t *frame) {
    input_error_t error;
    input_error_set(&error, options->frames, frame->line, FRAME_ID_NAME,
                    "no room for another track: %d are the most, and memory may be short", TRACK_TABLE_TRACKS_MAX);
    return print_error(&error);
}

/* One row, to its track's estimator. */
static bool replay_row(const options_t *options, const frame_t *frame, track_table_t *tracks, FILE *stream,
                       goe_estimate_t *estimate, tally_t *tally, log_hints_t *hints) {
    goe_image_t image;
    goe_estimator_t *estimator = track_table_get(tracks, frame->id);
    if (estimator == NULL) {
        return too_many_tracks(options, frame);
    }
    frame_to_image(frame, &image);
    const goe_status_t status = goe_update(estimator, &image, estimate);
    count_row(tally, status, estimate);
    if (status == GOE_BAD_TIME && image.pose.time_us != GOE_TIME_UNKNOWN) {
        log_hints_late(hints, frame);
    }
    return estimate_write_row(stream, frame->time_text, frame->id, status, estimate, options->residuals != 0) ||
           write_failed(options);
}

/* Row by row, until the end or the first fault. */
static bool replay_rows(const options_t *options, frame_reader_t *reader, track_table_t *tracks, FILE *stream,
                        tally_t *tally) {
    frame_t frame;
    goe_estimate_t estimate;
    input_error_t error;
    log_hints_t hints;
    frame_reader_result_t result = FRAME_READER_END;
    (void)memset(&hints, 0, sizeof hints);
    (void)memset(&estimate, 0, sizeof estimate);
    if (!estimate_write_header(stream, options->residuals != 0)) {
        return write_failed(options);
    }
    read_progress_t progress = read_progress_begin(PROGRAM);
    bool done = true;
    while (done && (result = frame_reader_next(reader, &frame, &error)) == FRAME_READER_ROW) {
        log_hints_add(&hints, &frame);
        read_progress_row(&progress, frame_reader_share(reader));
        done = replay_row(options, &frame, tracks, stream, &estimate, tally, &hints);
    }
    read_progress_end(&progress);
    if (result == FRAME_READER_ERROR) {
        return print_error(&error);
    }
    if (done) {
        log_hints_print(&hints, PROGRAM, options->frames, stderr);
    }
    return done;
}

/* Whether a path leads to any file of the log that an input is of. */
static bool is_of_log(const char *path, const char *input) {
    static const char *const names[] = {"camera.ini", "frames.csv", "truth.csv", "truth_frames.csv"};
    const char *slash = strrchr(input, '/');
    const int folder = slash != NULL ? (int)(slash - input) + 1 : 0;
    bool found = output_file_is(path, input);
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !found; i++) {
        const size_t capacity = (size_t)folder + strlen(names[i]) + 1u;
        char *beside = malloc(capacity);
        if (beside == NULL) {
            return true; /* rather no output than a lost log */
        }
        (void)snprintf(beside, capacity, "%.*s%s", folder, input, names[i]);
        found = output_file_is(path, beside);
        free(beside);
    }
    return found;
}

static bool replay_to_output(const options_t *options, frame_reader_t *reader, track_table_t *tracks, tally_t *tally) {
    output_file_t output;
    if (options->out != NULL &&
        (is_of_log(options->out, options->frames) || is_of_log(options->out, options->camera))) {
        return give_up(options->out, "the output would replace the log");
    }
    if (!output_file_open(&output, options->out)) {
        return write_failed(options);
    }
    if (!replay_rows(options, reader, tracks, output.stream, tally)) {
        output_file_discard(&output);
        return false;
    }
    return output_file_commit(&output) || write_failed(options);
}

static bool replay_with(const options_t *options, const goe_settings_t *settings, frame_reader_t *reader,
                        tally_t *tally) {
    const char *bad_field = NULL;
    track_table_t *tracks = track_table_new(settings, &bad_field);
    if (tracks == NULL) { /* each setting alone was accepted */
        char misfit[CHOICE_FAULT_MAX] = "out of memory";
        if (bad_field != NULL) {
            (void)snprintf(misfit, sizeof misfit, "%s: does not fit the size of the image", bad_field);
        }
        return give_up(options->camera, misfit);
    }
    const bool done = replay_to_output(options, reader, tracks, tally);
    track_table_free(tracks);
    return done;
}

static int replay(const options_t *options) {
    goe_settings_t settings;
    input_error_t error;
    tally_t tally = {{0}, 0};
    goe_settings_default(&settings);
    if (!apply_options(options, &settings)) {
        return EXIT_BAD_INPUT;
    }
    frame_reader_t *reader = NULL;
    if (camera_file_read(options->camera, &settings, &error)) {
        reader = frame_reader_open(options->frames, camera_file_cameras(&settings), &error);
    }
    if (reader == NULL) {
        (void)print_error(&error);
        return EXIT_BAD_INPUT;
    }
    frame_reader_print_misspelt(reader, PROGRAM, stderr);
    const bool done = replay_with(options, &settings, reader, &tally);
    frame_reader_close(reader);
    if (!done) {
        return EXIT_BAD_INPUT;
    }
    if (tally.estimates == 0) {
        explain_no_estimate(options->frames, &tally);
        return EXIT_NO_ESTIMATE;
    }
    return EXIT_DONE;
}

/* ------------------------------------------------------------------------------------------------------------ main -- */

static int run(poptContext context, const struct poptOption *table, int argc, const char *const *argv,
               options_t *options) {
    if (!parse_arguments(context, table, argc, argv, options)) {
        return EXIT_BAD_INPUT;
    }
    if (!options->help && !options->version && !options->settings) {
        return replay(options);
    }
    if (options->help) {
        print_help(context);
    } else if (options->settings) {
        (void)settings_list(stdout);
    } else {
        (void)puts(PROGRAM " " GOE_VERSION);
    }
    return standard_output_written(PROGRAM) ? EXIT_DONE : EXIT_BAD_INPUT;
}

int main(int argc, char **argv) {
    goe_settings_t defaults;
    goe_settings_default(&defaults);
    options_t options = {.window = defaults.window.points};
    const struct poptOption table[] = {
        {"method", 0, POPT_ARG_STRING, &options.method, 0, "how to estimate; filter by default", "filter|window"},
        {"model", 0, POPT_ARG_STRING, &options.model, 0, "shape model of the obstacle; auto by default",
         "auto|disc|line"},
        {"window", 0, POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &options.window, 0, "image points in the window", "N"},
        {"set", 0, POPT_ARG_ARGV, &options.set, 0, "change a setting; may be repeated", "NAME=VALUE"},
        {"residuals", 0, POPT_ARG_NONE, &options.residuals, 0,
         "nine columns more: nis, nis_rows, nis_ratio, velocity, latency (filter)", NULL},
        {"out", 'o', POPT_ARG_STRING, &options.out, 0, "where to write the estimates; standard output by default",
         "FILE"},
        {"camera", 0, POPT_ARG_STRING, &options.camera, 0, "in place of DIR/camera.ini", "FILE"},
        {"frames", 0, POPT_ARG_STRING, &options.frames, 0, "in place of DIR/frames.csv", "FILE"},
        {"settings", 0, POPT_ARG_NONE, &options.settings, 0,
         "print every setting of --set and exit: name, unit, low, high, default, text, between tabs", NULL},
        {"help", 'h', POPT_ARG_NONE, &options.help, 0, "print this and exit", NULL},
        {"version", 0, POPT_ARG_NONE, &options.version, 0, "print the version and exit", NULL},
        POPT_TABLEEND};
    const char **arguments = (void *)argv; /* popt reads them only */
    poptContext context = poptGetContext(PROGRAM, argc, arguments, table, 0);
    if (context == NULL) {
        (void)give_up("options", "out of memory");
        return EXIT_BAD_INPUT;
    }
    poptSetOtherOptionHelp(context, "[OPTION...] DIR");
    const int status = run(context, table, argc, arguments, &options);
    (void)poptFreeContext(context);
    free_options(&options);
    return status;
}
