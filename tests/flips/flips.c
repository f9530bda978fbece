/* Flips each bit of the estimator's memory between two images, flies on, and counts the outcomes per field.
 * SPDX-License-Identifier: MIT
 *
 *   goe_flips [--stride N] [--images N] [--flight N] [--moment N]
 *
 * Flips every N-th bit (by default 13; 1: all), and every bit of fields that decide: counts, enumerations, bools, settings. Flies
 * on for so many images (by default 24), in all flights and after all moments or only these. A line for each flight, moment and field:
 *
 *   flips,<flight>,<images before>,<field>,<bits>,<by outcome: the columns of the first line>
 *
 * Each flip runs in a process of its own. Exit status 0: none died, hung, or gave an answer that is not finite or outside its
 * enumeration; 1: some did; 2: bad usage. */
#define _DEFAULT_SOURCE
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fields.h"
#include "flights.h"

#define BITS (8u * sizeof(goe_estimator_t))
#define IMAGES_MAX 60
#define WRONG_SIGMAS 5.0
#define HANG_S 10u
#define RAD_PER_DEG 0.017453292519943295
#define FIELDS_MAX 200

static const int moments[] = {3, 12, 30};
#define MOMENTS (int)(sizeof moments / sizeof moments[0])

/* Outcome of a flipped bit: the first one that applies. */
typedef enum {
    CRASHED,    /* the process died: a sanitizer's finding, a trap */
    HUNG,       /* no end within 10 s */
    NOT_FINITE, /* an output is an infinity or a NaN */
    UNDEFINED,  /* an output is outside its enumeration, or a bool neither 0 nor 1 */
    CORRUPTED,  /* a call returned GOE_CORRUPTED */
    SUSPECT,    /* an estimate was suspect, or suspect for another reason, unlike without the flip */
    REPORTED,   /* in the end the answer is stale or missing, where without the flip it is fresh */
    WRONG,      /* in the end the error of a quantity exceeds 5 sigma, and nothing reports it */
    WAS_WRONG,  /* it did in between, but not in the end */
    MASKED,     /* the error was never so large */
    OUTCOMES
} outcome_t;

static const char *const outcome_names[OUTCOMES] = {"crashed", "hung",     "not_finite", "undefined", "corrupted",
                                                    "suspect", "reported", "wrong",      "was_wrong", "masked"};

typedef struct {
    goe_status_t status, covariance_status, hazard_status;
    goe_estimate_t estimate;
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    goe_hazard_t hazard;
} answer_t;

/* Shared by both processes. */
typedef struct {
    unsigned bit; /* present */
    unsigned count[FIELDS_MAX][OUTCOMES];
} shared_t;

static struct {
    unsigned stride;
    int images, flight, moment;
} options = {13u, 24, -1, -1};

static flipped_flight_t flight;
static goe_estimator_t healthy; /* at the moment of the flips */
static answer_t expected[IMAGES_MAX];
static shared_t *shared;

/* ------------------------------------------------------------------------------------------------------------ answers -- */

static bool is_number(float x) {
    unsigned bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7F800000u) != 0x7F800000u;
}

static bool are_numbers(const void *from, size_t bytes) {
    bool all = true;
    for (size_t i = 0; i + sizeof(float) <= bytes; i += sizeof(float)) {
        float x;
        memcpy(&x, (const unsigned char *)from + i, sizeof x);
        all = all && is_number(x);
    }
    return all;
}

static bool is_finite(const answer_t *a) {
    const size_t first = offsetof(goe_estimate_t, age_s);
    return are_numbers((const unsigned char *)&a->estimate + first, sizeof a->estimate - first) &&
           are_numbers(a->covariance, sizeof a->covariance) &&
           are_numbers(&a->hazard, offsetof(goe_hazard_t, has_clearance));
}

static unsigned byte_of(const bool *truth) {
    unsigned char byte;
    memcpy(&byte, truth, 1);
    return byte;
}

static bool is_known(goe_status_t status) { return strcmp(goe_status_text(status), "unknown") != 0; }

static bool is_defined(const answer_t *a) {
    const goe_estimate_t *e = &a->estimate;
    const bool model = e->model == GOE_MODEL_NONE || (e->model >= GOE_MODEL_DISC && e->model <= GOE_MODEL_PRISM);
    return is_known(a->status) && is_known(a->covariance_status) && is_known(a->hazard_status) && model &&
           (unsigned)e->method <= (unsigned)GOE_METHOD_FILTER && (unsigned)e->reason <= (unsigned)GOE_REASON_NOISE &&
           e->valid <= 0x7Fu && byte_of(&e->fresh) <= 1u && byte_of(&e->suspect) <= 1u && e->images_used >= 0 &&
           e->images_used <= INT16_MAX && e->nis_rows >= 0 && byte_of(&a->hazard.has_clearance) <= 1u;
}

static void take(goe_estimator_t *estimator, const goe_image_t *image, answer_t *answer) {
    memset(answer, 0, sizeof *answer);
    answer->status = goe_update(estimator, image, &answer->estimate);
    answer->covariance_status = goe_covariance(estimator, answer->covariance);
    answer->hazard_status = goe_hazard(estimator, &flight.intent, &answer->hazard);
}

/* From the camera to the reference point, north and east: a restarted track has other axes. */
static void place_of(const goe_estimate_t *e, float ne_m[2]) {
    const double c = cos((double)e->trajectory_heading_deg * RAD_PER_DEG);
    const double s = sin((double)e->trajectory_heading_deg * RAD_PER_DEG);
    ne_m[0] = (float)(c * (double)e->z_m - s * (double)e->x_m);
    ne_m[1] = (float)(s * (double)e->z_m + c * (double)e->x_m);
}

/* The largest difference of a quantity known to both, in sigmas of the answer. */
static double off_by(const goe_estimate_t *a, const goe_estimate_t *e) {
    float is_ne_m[2];
    float should_ne_m[2];
    const float sigma_m = a->sigma.x_m > a->sigma.z_m ? a->sigma.x_m : a->sigma.z_m;
    place_of(a, is_ne_m);
    place_of(e, should_ne_m);
    const struct {
        unsigned bit;
        float is, should, sigma;
    } q[] = {
        {GOE_HAS_POSITION, is_ne_m[0], should_ne_m[0], sigma_m},
        {GOE_HAS_POSITION, is_ne_m[1], should_ne_m[1], sigma_m},
        {GOE_HAS_WIDTH, a->width_m, e->width_m, a->sigma.width_m},
        {GOE_HAS_LENGTH, a->length_m, e->length_m, a->sigma.length_m},
        {GOE_HAS_HEIGHT, a->height_m, e->height_m, a->sigma.height_m},
        {GOE_HAS_ORIENTATION, a->orientation_deg + a->trajectory_heading_deg,
         e->orientation_deg + e->trajectory_heading_deg, a->sigma.orientation_deg},
        {GOE_HAS_CENTER, a->center_north_m, e->center_north_m, a->sigma.center_north_m},
        {GOE_HAS_CENTER, a->center_east_m, e->center_east_m, a->sigma.center_east_m},
        {GOE_HAS_VELOCITY, a->velocity_north_m_s, e->velocity_north_m_s, a->sigma.velocity_north_m_s},
        {GOE_HAS_VELOCITY, a->velocity_east_m_s, e->velocity_east_m_s, a->sigma.velocity_east_m_s},
    };
    double most = 0.0;
    for (size_t i = 0; i < sizeof q / sizeof q[0]; i++) {
        if ((a->valid & e->valid & q[i].bit) != 0u) {
            double off = fabs((double)q[i].is - (double)q[i].should);
            off = q[i].bit == GOE_HAS_ORIENTATION ? fabs(remainder(off, 180.0)) : off;
            most = fmax(most, off / fmax((double)q[i].sigma, 1.0e-3));
        }
    }
    return most;
}

static bool has_fresh(const answer_t *a) { return a->estimate.fresh && (a->estimate.valid & GOE_HAS_POSITION) != 0u; }

/* ------------------------------------------------------------------------------------------------------------- flips -- */

/* The worst effect of one flipped bit. */
static outcome_t fly_on(unsigned bit) {
    static goe_estimator_t estimator;
    outcome_t worst = MASKED;
    double off = 0.0;
    bool lost = false;
    memcpy(&estimator, &healthy, sizeof estimator);
    ((unsigned char *)&estimator)[bit / 8u] ^= (unsigned char)(1u << bit % 8u);
    for (int k = 0; k < options.images; k++) {
        answer_t answer;
        const answer_t *e = &expected[k];
        outcome_t now = MASKED;
        take(&estimator, &flight.image[moments[options.moment] + k], &answer);
        if (!is_finite(&answer)) {
            now = NOT_FINITE;
        } else if (!is_defined(&answer)) {
            now = UNDEFINED;
        } else if (answer.status == GOE_CORRUPTED || answer.covariance_status == GOE_CORRUPTED ||
                   answer.hazard_status == GOE_CORRUPTED) {
            now = CORRUPTED;
        } else if ((answer.estimate.suspect && !e->estimate.suspect) ||
                   (answer.estimate.reason != GOE_REASON_NONE && answer.estimate.reason != e->estimate.reason)) {
            now = SUSPECT;
        }
        lost = !has_fresh(&answer) && has_fresh(e);
        off = off_by(&answer.estimate, &e->estimate);
        if (now == MASKED && off > WRONG_SIGMAS) {
            now = WAS_WRONG;
        }
        worst = now < worst ? now : worst;
    }
    const outcome_t end = lost ? REPORTED : (off > WRONG_SIGMAS ? WRONG : MASKED);
    return end < worst ? end : worst;
}

static bool is_chosen(unsigned bit) { return bit % options.stride == 0u || fields[field_at(bit / 8u)].decides; }

/* From the present bit on, until one kills the process. */
static void flip_all(void) {
    for (; shared->bit < BITS; shared->bit++) {
        if (is_chosen(shared->bit)) {
            (void)alarm(HANG_S);
            const outcome_t outcome = fly_on(shared->bit);
            shared->count[field_at(shared->bit / 8u)][outcome]++;
        }
    }
}

/* False: no process could be created. */
static bool flip_in_processes(void) {
    shared->bit = 0;
    memset(shared->count, 0, sizeof shared->count);
    while (shared->bit < BITS) {
        int status = 0;
        (void)fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            flip_all();
            _exit(0);
        }
        if (child < 0 || waitpid(child, &status, 0) != child) {
            return false;
        }
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
            const bool hung = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
            (void)fprintf(stderr, "goe_flips: %s, %d: bit %u (%s) %s\n", flight.name, moments[options.moment],
                          shared->bit, fields[field_at(shared->bit / 8u)].name, hung ? "hangs" : "kills");
            shared->count[field_at(shared->bit / 8u)][hung ? HUNG : CRASHED]++;
            shared->bit++;
        }
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- runs -- */

static bool fly_healthy(void) {
    answer_t ignored;
    goe_estimator_t after;
    if (goe_init(&healthy, sizeof healthy, &flight.settings, NULL) != GOE_OK) {
        return false;
    }
    for (int k = 0; k < moments[options.moment]; k++) {
        take(&healthy, &flight.image[k], &ignored);
    }
    memcpy(&after, &healthy, sizeof after);
    for (int k = 0; k < options.images; k++) {
        take(&after, &flight.image[moments[options.moment] + k], &expected[k]);
    }
    return true;
}

static bool print_counts(void) {
    bool good = true;
    for (size_t f = 0; f < field_count; f++) {
        unsigned bits = 0;
        for (int o = 0; o < OUTCOMES; o++) {
            bits += shared->count[f][o];
        }
        if (bits == 0u) {
            continue;
        }
        (void)printf("flips,\"%s\",%d,%s,%u", flight.name, moments[options.moment], fields[f].name, bits);
        for (int o = 0; o < OUTCOMES; o++) {
            (void)printf(",%u", shared->count[f][o]);
            good = good && (o > UNDEFINED || shared->count[f][o] == 0u);
        }
        (void)printf("\n");
    }
    return good;
}

static void print_header(void) {
    (void)printf("flips,flight,images,field,bits");
    for (int o = 0; o < OUTCOMES; o++) {
        (void)printf(",%s", outcome_names[o]);
    }
    (void)printf("\n");
}

static bool take_option(const char *name, const char *value) {
    char *end = NULL;
    const long number = strtol(value, &end, 10);
    if (end == value || *end != '\0' || number < 0 || number > 1000000) {
        return false;
    }
    if (strcmp(name, "--stride") == 0 && number > 0) {
        options.stride = (unsigned)number;
    } else if (strcmp(name, "--images") == 0 && number > 0 && number <= IMAGES_MAX) {
        options.images = (int)number;
    } else if (strcmp(name, "--flight") == 0) {
        options.flight = (int)number;
    } else if (strcmp(name, "--moment") == 0 && number < MOMENTS) {
        options.moment = (int)number;
    } else {
        return false;
    }
    return true;
}

/* For one flight, after one moment or all of them. */
static int run_flight(void) {
    int status = 0;
    const int only = options.moment;
    for (int m = 0; m < MOMENTS; m++) {
        if (only >= 0 && only != m) {
            continue;
        }
        options.moment = m;
        if (!fly_healthy() || !flip_in_processes()) {
            (void)fprintf(stderr, "goe_flips: %s cannot be flown\n", flight.name);
            return 2;
        }
        status = print_counts() ? status : 1;
    }
    options.moment = only;
    return status;
}

int main(int argc, char **argv) {
    int status = 0;
    for (int i = 1; i < argc; i += 2) {
        if (i + 1 >= argc || !take_option(argv[i], argv[i + 1])) {
            (void)fprintf(stderr, "goe_flips: bad option %s\n", argv[i]);
            return 2;
        }
    }
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED || field_count > FIELDS_MAX) {
        (void)fprintf(stderr, "goe_flips: no memory\n");
        return 2;
    }
    print_header();
    for (int f = 0; flights_make(f, &flight); f++) {
        const int now = options.flight >= 0 && options.flight != f ? 0 : run_flight();
        status = now > status ? now : status;
    }
    return status;
}
