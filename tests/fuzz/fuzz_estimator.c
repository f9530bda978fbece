/* Fuzzes the library's public API. SPDX-License-Identifier: MIT
 *
 * Bytes become sections: settings, a flight past an obstacle, and a number of images of it. Some images are spoiled, and some are
 * followed by other calls. The flight itself takes no bytes, so a short input flies long tracks. After every call the promises of
 * goe.h are checked (estimate_checks.h), and these:
 *   - a refused image, and a goe_init() that fails, leave the estimator unchanged except for one counter;
 *   - only the estimator and the estimate are written;
 *   - the age of an older answer is the time since its image;
 *   - the same bytes give the same bits, for any previous content of the memory (one input in 32). */
#include <math.h>
#include <string.h>

#include "estimate_checks.h"
#include "fuzz.h"
#include "fuzz_image.h"
#include "fuzz_settings.h"
#include "fuzz_twice.h"
#include "guarded_estimator.h"

#define UPDATES_MAX 6000 /* for one input */
#define COVARIANCE_IN 4u
#define HAZARD_IN 8u

/* ----------------------------------------------------------------------------------------------------------- counters -- */

enum {
    UPDATES,
    UPDATES_WINDOW,
    UPDATES_REFINED,
    FRESH_WINDOW,
    FRESH_REFINED,
    FRESH_WINDOW_IN_REFINED,
    FRESH_DISC,
    FRESH_LINE,
    FRESH_BOX,
    FRESH_PRISM,
    OTHER_MODEL,
    MOVERS,
    LATE,
    REASONS, /* by goe_reason_t from GOE_REASON_CONVENTION on */
    SECOND_CAMERA = REASONS + 6,
    STARTS,
    STARTS_REFUSED,
    RESETS,
    HAZARDS,
    COVARIANCES,
    TWICE,
    STATUSES, /* from GOE_NO_DETECTION down to GOE_NO_HEIGHT */
    COUNTS = STATUSES + (int)GOE_NO_DETECTION - (int)GOE_NO_HEIGHT + 1
};

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"updates", 0},
                                        {"updates_window", 0},
                                        {"updates_refined", 0},
                                        {"fresh_window", 0},
                                        {"fresh_refined", 0},
                                        {"fresh_window_with_filter", 0},
                                        {"fresh_disc", 0},
                                        {"fresh_line", 0},
                                        {"fresh_box", 0},
                                        {"fresh_prism", 0},
                                        {"model_changes", 0},
                                        {"movers_followed", 0},
                                        {"latency_reported", 0},
                                        {"reason_convention", 0},
                                        {"reason_moves", 0},
                                        {"reason_base", 0},
                                        {"reason_shape", 0},
                                        {"reason_late", 0},
                                        {"reason_noise", 0},
                                        {"second_camera", 0},
                                        {"starts", 0},
                                        {"starts_refused", 0},
                                        {"resets", 0},
                                        {"hazards", 0},
                                        {"covariances", 0},
                                        {"inputs_run_twice", 0},
                                        {"status_no_detection", 0},
                                        {"status_stale", 0},
                                        {"status_converging", 0},
                                        {"status_partial", 0},
                                        {"status_ok", 0},
                                        {"status_behind_camera", 0},
                                        {"status_lens_failed", 0},
                                        {"status_swapped", 0},
                                        {"status_edge_on", 0},
                                        {"status_no_edge", 0},
                                        {"cause_bad_height", 0},
                                        {"status_no_baseline", 0},
                                        {"status_no_parallax", 0},
                                        {"status_abeam", 0},
                                        {"status_not_finite", 0},
                                        {"status_out_of_range", 0},
                                        {"status_bad_time", 0},
                                        {"status_bad_attitude", 0},
                                        {"status_box_incomplete", 0},
                                        {"status_no_height", 0},
                                        {NULL, 0}};

static void count(int what) { fuzz_count_once(what); }

static void count_update(const goe_settings_t *settings, goe_status_t status, const goe_estimate_t *e) {
    const bool filter = settings->method == GOE_METHOD_FILTER;
    count(UPDATES);
    count(filter ? UPDATES_REFINED : UPDATES_WINDOW);
    FUZZ_CHECK(status <= GOE_NO_DETECTION && status >= GOE_NO_HEIGHT);
    count(STATUSES + (int)GOE_NO_DETECTION - (int)status);
    if (e->reason != GOE_REASON_NONE) {
        count(REASONS + (int)e->reason - (int)GOE_REASON_CONVENTION);
    }
    if (!e->fresh) {
        return;
    }
    count(!filter ? FRESH_WINDOW : (e->method == GOE_METHOD_FILTER ? FRESH_REFINED : FRESH_WINDOW_IN_REFINED));
    count(FRESH_DISC + (int)e->model - (int)GOE_MODEL_DISC);
    if ((e->valid & GOE_HAS_VELOCITY) != 0u) {
        count(MOVERS);
    }
    if (e->latency_s != 0.0f) {
        count(LATE);
    }
}

/* -------------------------------------------------------------------------------------------------------------- memory -- */

static goe_estimator_t kept;

static void keep(void) { memcpy(&kept, &memory.estimator, sizeof kept); }

static void check_kept(void) { FUZZ_CHECK(fuzz_same(&kept, &memory.estimator, sizeof kept)); }

typedef struct {
    fuzz_input_t in;
    fuzz_view_t view;
    goe_settings_t settings;
    uint32_t updates;
    int64_t solved_us; /* image of the latest fresh answer */
    int64_t taken_us;  /* ... and the latest image that was not refused */
    bool has_solved;
    goe_model_t model; /* of the latest fresh answer */
    uint64_t hash;
} run_t;

/* --------------------------------------------------------------------------------------------------------------- calls -- */

static goe_intent_t usual_intent(run_t *run) {
    goe_intent_t intent;
    memset(&intent, 0, sizeof intent);
    fuzz_noise_t *noise = &run->view.noise;
    const float speed_m_s = run->view.path.speed_m_s;
    intent.velocity_ned_m_s[0] = speed_m_s * cosf(run->view.path.course_rad) + fuzz_noise(noise);
    intent.velocity_ned_m_s[1] = speed_m_s * sinf(run->view.path.course_rad) + 3.0f * fuzz_noise(noise);
    intent.velocity_ned_m_s[2] = -run->view.path.climb_m_s;
    intent.margin_m = 15.0f + 15.0f * fuzz_noise(noise);
    intent.clearance_m = 10.0f + 10.0f * fuzz_noise(noise);
    intent.since_image_s = fuzz_noise_bits(noise) % 4u == 0 ? 0.5f + 0.5f * fuzz_noise(noise) : 0.0f;
    return intent;
}

static goe_intent_t any_intent(fuzz_input_t *in) {
    goe_intent_t intent;
    memset(&intent, 0, sizeof intent);
    for (int i = 0; i < 3; i++) {
        intent.velocity_ned_m_s[i] = fuzz_any(in, -1.0e3f, 1.0e3f);
    }
    intent.margin_m = fuzz_any(in, 0.0f, 1.0e4f);
    intent.clearance_m = fuzz_any(in, 0.0f, 1.0e4f);
    intent.since_image_s = fuzz_any(in, 0.0f, 1.0e3f);
    intent.velocity_sd_m_s =
        intent.margin_m > 5.0e3f ? 1.0e-2f * intent.clearance_m : 0.0f; /* the corpus has no bytes for it */
    return intent;
}

/* Both calls refer to the estimator's own latest answer. */
static void ask(run_t *run, bool covariance, bool hazard) {
    const goe_estimate_t *latest = &memory.estimator.estimate;
    if (covariance) {
        check_covariance(&memory.estimator, latest);
        count(COVARIANCES);
    }
    if (hazard) {
        const goe_intent_t intent = usual_intent(run);
        check_hazard(&memory.estimator, latest, &intent, true);
        count(HAZARDS);
    }
}

/* Seconds between them, as goe.h counts them: at most 4000. */
static float age_s(int64_t from_us, int64_t to_us) {
    const uint64_t span_us = (uint64_t)to_us - (uint64_t)from_us;
    return (float)(span_us < 4000000000u ? (uint32_t)span_us : 4000000000u) * 1.0e-6f;
}

/* ... from the latest image taken to the newest refused one, at most 1000. */
static float refused_s(const goe_estimator_t *before, int64_t image_us) {
    const int64_t taken_us = before->motion.time_us;
    const float since_s = image_us > taken_us ? age_s(taken_us, image_us) : 0.0f;
    return fmaxf(before->estimate.age_s, fminf(since_s, 1000.0f));
}

static void follow_age(run_t *run, int64_t image_us, bool refused, const goe_estimate_t *e) {
    run->taken_us = refused ? run->taken_us : image_us;
    if (e->fresh) {
        run->solved_us = image_us;
        run->has_solved = true;
        if (e->model != run->model) {
            count(OTHER_MODEL);
            run->model = e->model;
        }
    } else if ((e->valid & GOE_HAS_POSITION) != 0u) {
        const float expected_s = age_s(run->solved_us, image_us > run->taken_us ? image_us : run->taken_us);
        FUZZ_CHECK(run->has_solved);
        FUZZ_CHECK(fuzz_bits_of(e->age_s) == fuzz_bits_of(expected_s));
    }
}

static goe_status_t update(run_t *run, const goe_image_t *image) {
    const goe_estimate_t *e = &memory.estimate;
    keep();
    memset(&memory.estimate, 0xFF, sizeof memory.estimate); /* a NaN must not remain */
    const goe_status_t status = goe_update(&memory.estimator, image, &memory.estimate);
    FUZZ_CHECK(check_is_image_status(status));
    if (check_is_refusal(status)) {
        kept.fault_counts[-(int)status]++;
        kept.estimate.age_s = refused_s(&kept, image->pose.time_us);
        check_kept();
    }
    check_estimate(&run->settings, status, e);
    guard_check();
    if (memory.estimator.fault_counts[-(int)GOE_BAD_HEIGHT] != kept.fault_counts[-(int)GOE_BAD_HEIGHT]) {
        count(STATUSES + (int)GOE_NO_DETECTION - (int)GOE_BAD_HEIGHT); /* its counter alone reports it */
    }
    follow_age(run, image->pose.time_us, check_is_refusal(status), e);
    run->hash = check_hash(run->hash, status, e);
    count_update(&run->settings, status, e);
    if (image->camera == 1 && e->fresh) {
        count(SECOND_CAMERA);
    }
    run->updates++;
    ask(run, run->updates % COVARIANCE_IN == 0, run->updates % HAZARD_IN == 0);
    return status;
}

static void forget(run_t *run) {
    FUZZ_CHECK(goe_reset(&memory.estimator) == GOE_OK);
    guard_check();
    run->has_solved = false;
    run->model = GOE_MODEL_NONE;
    count(RESETS);
}

/* True if the settings were accepted; otherwise nothing has changed. */
static bool start(run_t *run, const goe_settings_t *settings) {
    const char *bad = "";
    keep();
    const goe_status_t status = goe_init(&memory.estimator, sizeof memory.estimator, settings, &bad);
    guard_check();
    if (status == GOE_OK) {
        FUZZ_CHECK(bad == NULL);
        run->settings = *settings;
        run->has_solved = false;
        run->model = GOE_MODEL_NONE;
        count(STARTS);
        return true;
    }
    FUZZ_CHECK(status == GOE_BAD_SETTINGS && bad != NULL && *bad != '\0');
    check_kept();
    count(STARTS_REFUSED);
    return false;
}

/* Invalid calls change nothing. */
static void misuse(run_t *run) {
    goe_estimator_t *estimator = &memory.estimator;
    goe_image_t image;
    goe_hazard_t hazard;
    const goe_intent_t intent = usual_intent(run);
    const char *bad = "";
    memset(&image, 0, sizeof image);
    keep();
    FUZZ_CHECK(goe_update(NULL, &image, &memory.estimate) == GOE_BAD_ARGUMENT && memory.estimate.valid == 0u);
    FUZZ_CHECK(goe_update(estimator, NULL, &memory.estimate) == GOE_BAD_ARGUMENT && memory.estimate.valid == 0u);
    FUZZ_CHECK(goe_update(estimator, &image, NULL) == GOE_BAD_ARGUMENT);
    FUZZ_CHECK(goe_init(estimator, sizeof *estimator - 8u, &run->settings, &bad) == GOE_BAD_ARGUMENT && bad == NULL);
    FUZZ_CHECK(goe_init(estimator, sizeof *estimator, NULL, NULL) == GOE_BAD_ARGUMENT);
    FUZZ_CHECK(goe_init(NULL, sizeof *estimator, &run->settings, NULL) == GOE_BAD_ARGUMENT);
    FUZZ_CHECK(goe_covariance(estimator, NULL) == GOE_BAD_ARGUMENT && goe_reset(NULL) == GOE_BAD_ARGUMENT);
    FUZZ_CHECK(goe_hazard(estimator, NULL, &hazard) == GOE_BAD_ARGUMENT && !hazard.has_clearance);
    FUZZ_CHECK(goe_hazard(estimator, &intent, NULL) == GOE_BAD_ARGUMENT);
    goe_settings_default(NULL);
    check_kept();
    guard_check();
}

static void texts(fuzz_input_t *in) {
    const uint32_t bits = fuzz_byte(in) % 2u != 0 ? fuzz_word(in) : 0x80u - fuzz_byte(in);
    int number;
    memcpy(&number, &bits, sizeof number);
    goe_status_t status;
    goe_reason_t reason;
    memcpy(&status, &number, sizeof status);
    memcpy(&reason, &number, sizeof reason);
    FUZZ_CHECK(*goe_status_text(status) != '\0' && strlen(goe_status_text(status)) < 32u);
    FUZZ_CHECK(*goe_reason_text(reason) != '\0' && strlen(goe_reason_text(reason)) < 32u);
}

/* ------------------------------------------------------------------------------------------------------------- sections -- */

enum { CALL_RESET, CALL_HAZARD, CALL_COVARIANCE, CALL_MISUSE, CALL_TEXTS, CALL_BAD_START, CALL_SAME_START, CALLS };

/* Another call between two images. */
static void call(run_t *run) {
    goe_settings_t settings = run->settings;
    goe_intent_t intent;
    switch (fuzz_below(&run->in, CALLS)) {
        case CALL_RESET:
            forget(run);
            break;
        case CALL_HAZARD:
            intent = any_intent(&run->in);
            check_hazard(&memory.estimator, &memory.estimator.estimate, &intent, false);
            break;
        case CALL_COVARIANCE:
            ask(run, true, true);
            break;
        case CALL_MISUSE:
            misuse(run);
            break;
        case CALL_TEXTS:
            texts(&run->in);
            break;
        case CALL_BAD_START:
            fuzz_change_settings(&run->in, false, &settings);
            (void)start(run, &settings);
            break;
        case CALL_SAME_START:
        default:
            FUZZ_CHECK(start(run, &settings));
            break;
    }
}

static void begin(run_t *run) {
    const uint32_t how = fuzz_byte(&run->in);
    if (run->updates == 0 || how % 4u != 3u) {
        goe_settings_t usual, changed;
        fuzz_usual_settings(&run->in, &usual);
        changed = usual;
        if (how % 4u != 0u) {
            fuzz_change_settings(&run->in, how % 4u == 1u, &changed);
        }
        if (!start(run, &changed)) {
            FUZZ_CHECK(start(run, &usual));
        }
    } else if ((how & 4u) != 0u) {
        forget(run);
    }
    fuzz_view_begin(&run->in, &run->settings, &run->view);
}

static void section(run_t *run) {
    goe_image_t image;
    begin(run);
    const uint32_t images = 4u + fuzz_byte(&run->in);
    const uint32_t spoiled = fuzz_byte(&run->in); /* of 256; most flights have few */
    const uint32_t limit = spoiled < 192u ? spoiled / 24u : spoiled - 128u;
    for (uint32_t i = 0; i < images && run->updates < UPDATES_MAX; i++) {
        if (fuzz_view_image(&run->view, &image) && fuzz_noise_bits(&run->view.noise) % 4u != 0u) {
            forget(run); /* or no reset is reported */
        }
        if (fuzz_noise_bits(&run->view.noise) % 256u < limit) {
            if (fuzz_byte(&run->in) % 4u == 3u) {
                call(run);
            } else {
                fuzz_view_spoil(&run->in, &run->view, &image);
            }
        }
        (void)update(run, &image);
    }
}

/* Memory that was never initialized. */
static void check_not_ready(void) {
    goe_image_t image;
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    memset(&image, 0, sizeof image);
    FUZZ_CHECK(goe_update(&memory.estimator, &image, &memory.estimate) == GOE_NOT_INITIALIZED);
    FUZZ_CHECK(memory.estimate.valid == 0u && goe_reset(&memory.estimator) == GOE_NOT_INITIALIZED);
    FUZZ_CHECK(goe_covariance(&memory.estimator, covariance) == GOE_NOT_INITIALIZED);
}

static uint64_t fly(const uint8_t *data, size_t size, int fill) {
    run_t run;
    memset(&run, 0, sizeof run);
    guard_begin(fill);
    run.in.next = data;
    run.in.left = size;
    check_not_ready();
    do {
        section(&run);
    } while (run.in.left > 0 && run.updates < UPDATES_MAX);
    return run.hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_twice(fly, data, size, TWICE);
    return 0;
}
