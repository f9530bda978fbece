/* Runs a target without libFuzzer. SPDX-License-Identifier: MIT
 *
 *   fuzz_<target> FILE|FOLDER...                              each file once
 *   fuzz_<target> --random SEED [OPTION...] [FILE|FOLDER...]  generated inputs; with files: mutations of these
 *     --work N     until the target's first counter has reached N
 *     --seconds S  ... or for this time
 *     --keep DIR   folder for an input that fails; by default the current folder
 *
 * Prints the counters as one line of JSON at the end, also on SIGINT and SIGTERM. An input that fails, or takes longer
 * than a minute, is saved to a file, and the program ends with SIGABRT. Not for libFuzzer, which has its own main(). */
#include <dirent.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "fuzz.h"

#define INPUT_MAX 65536u
#define RANDOM_MIN 64u
#define RANDOM_MAX 3072u
#define FILES_MAX 4096u
#define MUTATIONS_MAX 8u
#define PATH_SIZE 512
#define HANG_S 60u

typedef struct {
    uint8_t *bytes;
    size_t size;
} file_t;

static struct {
    uint8_t bytes[INPUT_MAX]; /* the present input */
    size_t size;
    uint64_t seed, runs, random;
    file_t file[FILES_MAX];
    size_t files;
    char name[PATH_SIZE]; /* path of the present file, or of a failed input */
    const char *keep;
    bool is_random;
} fuzz;

static volatile sig_atomic_t stopped;

/* -------------------------------------------------------------------------------------------------------------- signals -- */

static void stop(int number) {
    (void)number;
    stopped = 1;
}

/* An input that is already a file need not be saved. Nothing here may use stdio. */
static void keep_broken(int number) {
    static const char says[] = "fuzz: the input is ";
    if (fuzz.is_random) {
        FILE *to = fopen(fuzz.name, "wb"); /* not safe in a handler, but the program has failed already */
        if (to != NULL) {
            (void)fwrite(fuzz.bytes, 1, fuzz.size, to);
            (void)fclose(to);
        }
    }
    (void)!write(STDERR_FILENO, says, sizeof says - 1u);
    (void)!write(STDERR_FILENO, fuzz.name, strlen(fuzz.name));
    (void)!write(STDERR_FILENO, "\n", 1);
    (void)signal(SIGABRT, SIG_DFL);
    if (number != SIGABRT) {
        abort();
    }
}

static void set_signals(void) {
    (void)signal(SIGINT, stop);
    (void)signal(SIGTERM, stop);
    (void)signal(SIGABRT, keep_broken);
    (void)signal(SIGALRM, keep_broken);
#if !defined(__SANITIZE_ADDRESS__) && !defined(FUZZ_SANITIZED) /* these give more detail on the signals below */
    (void)signal(SIGSEGV, keep_broken);
    (void)signal(SIGBUS, keep_broken);
    (void)signal(SIGFPE, keep_broken);
    (void)signal(SIGILL, keep_broken);
#endif
}

/* --------------------------------------------------------------------------------------------------------------- inputs -- */

/* The generator: a counter, mixed. */
static uint64_t next_random(void) {
    fuzz.random += 0x9E3779B97F4A7C15u;
    uint64_t x = fuzz.random;
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

static size_t below(size_t limit) { return (size_t)(next_random() % limit); }

static void random_bytes(void) {
    fuzz.size = RANDOM_MIN + below(RANDOM_MAX - RANDOM_MIN);
    for (size_t i = 0; i < fuzz.size; i += sizeof(uint64_t)) {
        const uint64_t bits = next_random();
        const size_t left = fuzz.size - i;
        memcpy(&fuzz.bytes[i], &bits, left < sizeof bits ? left : sizeof bits);
    }
}

/* Makes space for `more` bytes at a place; false: they do not fit. */
static bool open_gap(size_t at, size_t more) {
    if (fuzz.size + more > INPUT_MAX) {
        return false;
    }
    memmove(&fuzz.bytes[at + more], &fuzz.bytes[at], fuzz.size - at);
    fuzz.size += more;
    return true;
}

static void close_gap(size_t at, size_t less) {
    memmove(&fuzz.bytes[at], &fuzz.bytes[at + less], fuzz.size - at - less);
    fuzz.size -= less;
}

/* Words of the formats that parsers accept, and of those that they must refuse. */
static const char *const words[] = {"\n",
                                    "\r\n",
                                    ",",
                                    ";",
                                    "\"",
                                    "\"\"",
                                    "#",
                                    "=",
                                    "[",
                                    "]",
                                    "{",
                                    "}",
                                    "nan",
                                    "inf",
                                    "-",
                                    "1e308",
                                    "1e-400",
                                    "0x1p3",
                                    "-0",
                                    "99999999999999999999",
                                    "null",
                                    "true",
                                    "\xef\xbb\xbf",
                                    "\xff",
                                    "1e9",
                                    "id",
                                    "t_s",
                                    ".",
                                    "NaN",
                                    "-9223372036854775808"};

static void insert_word(size_t at) {
    const char *word = words[below(sizeof words / sizeof words[0])];
    if (open_gap(at, strlen(word))) {
        memcpy(&fuzz.bytes[at], word, strlen(word));
    }
}

/* Replaces the bytes here by a part of some file, or inserts that part. */
static void splice(size_t at) {
    const file_t *from = &fuzz.file[below(fuzz.files)];
    if (from->size == 0) {
        return;
    }
    const size_t begin = below(from->size);
    size_t size = 1u + below(from->size - begin);
    size = size > 512u ? 512u : size;
    if (open_gap(at, size)) {
        memcpy(&fuzz.bytes[at], &from->bytes[begin], size);
    }
}

static void mutate(void) {
    const size_t at = below(fuzz.size + 1u);
    const size_t left = fuzz.size - at;
    const size_t part = left > 0 ? 1u + below(left > 64u ? 64u : left) : 0u;
    switch (below(8)) {
        case 0:
            splice(at);
            break;
        case 1:
            insert_word(at);
            break;
        case 2:
            close_gap(at, part);
            break;
        case 3:
            fuzz.size = at; /* cut off */
            break;
        case 4: /* repeated */
            if (part > 0 && open_gap(at, part)) {
                memcpy(&fuzz.bytes[at], &fuzz.bytes[at + part], part);
            }
            break;
        case 5:
            if (left > 0) {
                fuzz.bytes[at] = (uint8_t)(fuzz.bytes[at] ^ 1u << below(8));
            }
            break;
        case 6:
            if (left > 0) {
                fuzz.bytes[at] = (uint8_t)('0' + below(10));
            }
            break;
        default:
            if (left > 0) {
                fuzz.bytes[at] = (uint8_t)next_random();
            }
            break;
    }
}

static void mutated_file(void) {
    const file_t *from = &fuzz.file[below(fuzz.files)];
    fuzz.size = from->size;
    memcpy(fuzz.bytes, from->bytes, from->size);
    for (size_t i = 1u + below(1u + below(MUTATIONS_MAX)); i > 0; i--) { /* mostly few */
        mutate();
    }
}

/* ---------------------------------------------------------------------------------------------------------------- files -- */

static int fail(const char *path, const char *why) {
    (void)fprintf(stderr, "fuzz: %s: %s\n", path, why);
    return 2;
}

static int take_file(const char *path) {
    FILE *from = fopen(path, "rb");
    if (from == NULL) {
        return fail(path, "cannot be opened");
    }
    fuzz.size = fread(fuzz.bytes, 1, INPUT_MAX, from);
    (void)fclose(from);
    if (!fuzz.is_random) {
        (void)snprintf(fuzz.name, sizeof fuzz.name, "%s", path);
        (void)LLVMFuzzerTestOneInput(fuzz.bytes, fuzz.size);
        fuzz.runs++;
        return 0;
    }
    uint8_t *bytes = fuzz.files < FILES_MAX ? malloc(fuzz.size + 1u) : NULL;
    if (bytes == NULL) {
        return fail(path, "too large");
    }
    memcpy(bytes, fuzz.bytes, fuzz.size);
    fuzz.file[fuzz.files].bytes = bytes;
    fuzz.file[fuzz.files].size = fuzz.size;
    fuzz.files++;
    return 0;
}

static int take(const char *path) {
    char inside[PATH_SIZE];
    int status = 0;
    DIR *folder = opendir(path);
    if (folder == NULL) {
        return take_file(path);
    }
    for (const struct dirent *entry = readdir(folder); entry != NULL && status == 0; entry = readdir(folder)) {
        if (entry->d_name[0] != '.') {
            (void)snprintf(inside, sizeof inside, "%s/%s", path, entry->d_name);
            status = take_file(inside);
        }
    }
    (void)closedir(folder);
    return status;
}

/* ----------------------------------------------------------------------------------------------------------------- main -- */

static double now_s(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void run_random(const char *program, uint64_t work, double seconds) {
    const char *slash = strrchr(program, '/');
    const double begun_s = now_s();
    while (stopped == 0 && (work == 0 || fuzz_counts[0].times < work) &&
           (seconds <= 0.0 || now_s() - begun_s < seconds)) {
        if (fuzz.files > 0) {
            mutated_file();
        } else {
            random_bytes();
        }
        (void)snprintf(fuzz.name, sizeof fuzz.name, "%s/broken-%s-%" PRIu64 "-%" PRIu64, fuzz.keep,
                       slash != NULL ? slash + 1 : program, fuzz.seed, fuzz.runs);
        (void)alarm(HANG_S);
        (void)LLVMFuzzerTestOneInput(fuzz.bytes, fuzz.size);
        fuzz.runs++;
    }
}

static void print_counts(double seconds) {
    (void)printf("{\"runs\": %" PRIu64 ", \"seconds\": %.1f", fuzz.runs, seconds);
    for (const fuzz_count_t *count = fuzz_counts; count->name != NULL; count++) {
        (void)printf(", \"%s\": %" PRIu64, count->name, count->times);
    }
    (void)puts("}");
}

typedef struct {
    uint64_t work;
    double seconds;
} limits_t;

/* True if it is an option, which takes the next argument. */
static bool take_option(const char *name, const char *value, limits_t *limits) {
    if (strcmp(name, "--random") == 0) {
        fuzz.seed = fuzz.random = strtoull(value, NULL, 0);
    } else if (strcmp(name, "--work") == 0) {
        limits->work = strtoull(value, NULL, 0);
    } else if (strcmp(name, "--seconds") == 0) {
        limits->seconds = strtod(value, NULL);
    } else if (strcmp(name, "--keep") == 0) {
        fuzz.keep = value;
    } else {
        return false;
    }
    return true;
}

int main(int argc, char **argv) {
    limits_t limits = {0, 0.0};
    int status = 0;
    fuzz.keep = ".";
    for (int i = 1; i + 1 < argc; i++) {
        fuzz.is_random = fuzz.is_random || strcmp(argv[i], "--random") == 0;
    }
    set_signals();
    const double begun_s = now_s();
    int i = 1;
    while (i < argc && status == 0) {
        const bool is_option = take_option(argv[i], i + 1 < argc ? argv[i + 1] : "", &limits);
        status = is_option ? 0 : take(argv[i]);
        i += is_option ? 2 : 1;
    }
    if (status == 0 && fuzz.is_random) {
        run_random(argv[0], limits.work, limits.seconds);
    }
    print_counts(now_s() - begun_s);
    return status;
}
