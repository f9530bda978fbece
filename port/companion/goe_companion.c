/* goe_companion: obstacles for a stock autopilot, from a computer next to it. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <fcntl.h>
#include <popt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "companion.h"
#include "companion_config.h"
#include "option_fault.h"
#include "standard_output.h"
#include "status_line.h"

#ifndef GOE_VERSION
#define GOE_VERSION "development"
#endif

#define PROGRAM "goe_companion"
#define FAULT_MAX 512

enum { EXIT_DONE = 0, EXIT_NOT_OPENED = 1, EXIT_BAD_INPUT = 2 };

static volatile sig_atomic_t is_over;

static void on_signal(int number) {
    (void)number;
    is_over = 1;
}

/* A signal that the caller's shell made the program ignore stays ignored. */
static void catch_signals(void) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action, before;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    (void)sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
            (void)sigaction(numbers[i], &action, NULL);
        }
    }
    (void)signal(SIGPIPE, SIG_IGN);
}

/* A stream that the caller has closed gives its number to the next file or socket: texts would go to the autopilot. Each is opened for
 * the wrong direction, so that reading and printing still fail. */
static bool occupy_standard_streams(void) {
    static const int flags[] = {O_WRONLY, O_RDONLY, O_RDONLY};
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; number++) {
        if (fcntl(number, F_GETFD) < 0 && open("/dev/null", flags[number]) != number) {
            return false;
        }
    }
    return true;
}

typedef struct {
    char *path; /* of the configuration */
    char *link; /* instead of its link.autopilot; null: none */
    int check, help, version;
} options_t;

static bool complain(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s (see " PROGRAM " --help)\n", subject, reason);
    return false;
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
    if (options->help || options->version) {
        return true;
    }
    const char *path = poptGetArg(context);
    const char *surplus = poptPeekArg(context);
    if (path == NULL) {
        return complain("CONFIGURATION", "missing: name a file like companion.ini");
    }
    if (surplus != NULL) {
        return complain(surplus, "one configuration at a time");
    }
    options->path = strdup(path);
    return options->path != NULL;
}

static int run(const companion_config_t *config) {
    char fault[FAULT_MAX] = "";
    companion_t *companion = companion_new(config, fault, sizeof fault);
    if (companion == NULL) {
        (void)fprintf(stderr, PROGRAM ": %s\n", fault);
        return EXIT_NOT_OPENED;
    }
    catch_signals();
    while (!is_over) {
        if (companion_turn(companion)) {
            status_line_show(companion);
        }
    }
    (void)signal(SIGINT, SIG_DFL); /* a second one ends it even where nobody reads the summary */
    status_line_summary(companion);
    companion_free(companion);
    return EXIT_DONE;
}

static int start(const options_t *options) {
    static companion_config_t config;
    input_error_t error;
    if (!companion_config_read(options->path, options->link, &config, &error)) {
        (void)fprintf(stderr, PROGRAM ": %s\n", error.text);
        return EXIT_BAD_INPUT;
    }
    if (options->check) {
        companion_config_print(stdout, &config);
        return standard_output_written(PROGRAM) ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    return run(&config);
}

int main(int count, const char **arguments) {
    options_t options = {NULL, NULL, 0, 0, 0};
    const struct poptOption table[] = {
        {"check", 'c', POPT_ARG_NONE, &options.check, 0, "read the configuration, print what it comes to, and end",
         NULL},
        {"link", 'l', POPT_ARG_STRING, &options.link, 0,
         "instead of link.autopilot; udpin:0.0.0.0:14540 listens to every network, and not to this computer alone",
         "WHERE"},
        {"help", 'h', POPT_ARG_NONE, &options.help, 0, "print this text", NULL},
        {"version", 'V', POPT_ARG_NONE, &options.version, 0, "print the version", NULL},
        POPT_TABLEEND,
    };
    if (!occupy_standard_streams()) {
        return EXIT_NOT_OPENED;
    }
    poptContext context = poptGetContext(PROGRAM, count, arguments, table, 0);
    poptSetOtherOptionHelp(context, "[OPTIONS] CONFIGURATION");
    const bool good = parse_arguments(context, table, count, arguments, &options);
    int status = EXIT_BAD_INPUT;
    if (good && options.help) {
        poptPrintHelp(context, stdout, 0);
        status = standard_output_written(PROGRAM) ? EXIT_DONE : EXIT_BAD_INPUT;
    } else if (good && options.version) {
        (void)puts(PROGRAM " " GOE_VERSION);
        status = standard_output_written(PROGRAM) ? EXIT_DONE : EXIT_BAD_INPUT;
    } else if (good) {
        status = start(&options);
    }
    poptFreeContext(context);
    free(options.path);
    free(options.link);
    return status;
}
