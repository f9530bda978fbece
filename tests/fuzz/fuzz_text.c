/* Fuzzes the parsers of words and lines: numbers, names, settings, lines of configurations and of JSON. SPDX-License-Identifier: MIT
 *
 * The first letter of the input selects the kind: n numbers, t numbers after a word, m mistyped names, s a setting, i lines of a
 * configuration, l lines of JSON; any other one: a float's text. No target needs a library, so all run under every sanitizer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "fuzz_input.h"
#include "ini_lines.h"
#include "line_reader.h"
#include "nearest_name.h"
#include "number_text.h"
#include "settings_text.h"
#include "text_numbers.h"

#define TEXT_MAX 8192u

enum { INPUTS, NUMBERS, SETTINGS, SETTINGS_REFUSED, LINES, JSON_TEXTS, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"inputs", 0}, {"numbers", 0},    {"settings", 0}, {"settings_refused", 0},
                                        {"lines", 0},  {"json_texts", 0}, {NULL, 0}};

static char text[TEXT_MAX + 1];

static void try_numbers(size_t length) {
    const double untouched = -7.25;
    double value = untouched;
    int64_t whole = -7;
    char *end;
    if (number_parse(text, length, &value)) {
        const double expected = strtod(text, &end);
        FUZZ_CHECK(end == text + length);
        FUZZ_CHECK(memcmp(&expected, &value, sizeof value) == 0 || (isnan(expected) && isnan(value)));
        FUZZ_CHECK(strpbrk(text, "xXpP \t\n") == NULL);
        (void)number_to_float(value);
        fuzz_counts[NUMBERS].times++;
    } else {
        FUZZ_CHECK(memcmp(&value, &untouched, sizeof value) == 0);
    }
    if (integer_parse(text, length, &whole)) {
        FUZZ_CHECK(whole == strtoll(text, &end, 10) && end == text + length);
    } else {
        FUZZ_CHECK(whole == -7);
    }
}

/* Prints exactly as printf would, and reads the text back. */
static void try_format(const uint8_t *data, size_t size) {
    fuzz_input_t in = {data, size};
    char ours[NUMBER_TEXT_MAX + 1];
    char theirs[64];
    do {
        const float value = fuzz_float_of(fuzz_word(&in));
        const size_t length = number_format(ours, value);
        FUZZ_CHECK(length <= NUMBER_TEXT_MAX);
        ours[length] = '\0';
        (void)snprintf(theirs, sizeof theirs, "%.9g", (double)value);
        FUZZ_CHECK(strcmp(ours, theirs) == 0);
        fuzz_counts[NUMBERS].times++;
    } while (in.left > 0);
}

static void try_words(void) {
    double values[3] = {0.0, 0.0, 0.0};
    if (text_numbers(text, "box:", values, 3)) {
        FUZZ_CHECK(isfinite(values[0]) && isfinite(values[1]) && isfinite(values[2]));
        fuzz_counts[NUMBERS].times++;
    }
}

static void try_name(size_t length) {
    static const char *const names[] = {"camera.fx", "navigation.height_bias_sd_m", "x", "", "detector.box_noise_rel"};
    nearest_name_t nearest = nearest_name_of(text, length);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        nearest_name_try(&nearest, names[i]);
    }
    FUZZ_CHECK(nearest.name == NULL || nearest.edits <= (length > 64u ? length : 64u));
}

static void try_setting(void) {
    static goe_estimator_t estimator;
    goe_settings_t settings, before;
    setting_fault_t fault;
    fault.text[0] = '\0';
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
    before = settings;
    if (!setting_assign(&settings, text, &fault)) {
        FUZZ_CHECK(fault.text[0] != '\0' && memchr(fault.text, '\0', sizeof fault.text) != NULL);
        FUZZ_CHECK(memcmp(&before, &settings, sizeof before) == 0);
        fuzz_counts[SETTINGS_REFUSED].times++;
        return;
    }
    fuzz_counts[SETTINGS].times++;
    const bool taken = settings_in_range(&settings, &fault);
    const goe_status_t status = goe_init(&estimator, sizeof estimator, &settings, NULL);
    FUZZ_CHECK(taken == (status == GOE_OK));
}

static void try_lines(size_t length) {
    static ini_lines_t lines; /* large */
    const char *fault = NULL;
    if (length == 0) {
        return; /* fmemopen() takes no empty memory */
    }
    (void)memset(&lines, 0, sizeof lines);
    lines.stream = fmemopen(text, length, "r");
    FUZZ_CHECK(lines.stream != NULL);
    for (const char *line = ini_lines_next(&lines, &fault); line != NULL; line = ini_lines_next(&lines, &fault)) {
        FUZZ_CHECK(fault == NULL && strpbrk(line, "#\n") == NULL);
        fuzz_counts[LINES].times++;
    }
    (void)fclose(lines.stream);
}

typedef struct {
    uint64_t hash;
    unsigned long texts;
} taken_t;

static void take_text(void *user, const char *line, size_t length) {
    taken_t *taken = user;
    FUZZ_CHECK(length > 0 && length <= DETECTION_LINE_MAX);
    for (size_t i = 0; i < length; i++) {
        taken->hash = (taken->hash ^ (uint8_t)line[i]) * 0x100000001B3u;
    }
    taken->hash = (taken->hash ^ 0xFFu) * 0x100000001B3u;
    taken->texts++;
}

/* The same texts come out for any split of the bytes. */
static void try_json_texts(size_t length) {
    static line_reader_t at_once, in_pieces;
    taken_t whole = {0, 0};
    taken_t pieces = {0, 0};
    memset(&at_once, 0, sizeof at_once);
    memset(&in_pieces, 0, sizeof in_pieces);
    line_reader_take(&at_once, text, length, take_text, &whole);
    line_reader_end(&at_once, take_text, &whole);
    for (size_t i = 0; i < length;) {
        const size_t piece = 1u + (i * 7u + length) % 13u;
        const size_t size = length - i < piece ? length - i : piece;
        line_reader_take(&in_pieces, text + i, size, take_text, &pieces);
        i += size;
    }
    line_reader_end(&in_pieces, take_text, &pieces);
    FUZZ_CHECK(whole.hash == pieces.hash && whole.texts == pieces.texts);
    fuzz_counts[JSON_TEXTS].times += whole.texts;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_counts[INPUTS].times++;
    if (size == 0) {
        return 0;
    }
    const size_t length = size - 1u < TEXT_MAX ? size - 1u : TEXT_MAX;
    memcpy(text, data + 1, length);
    text[length] = '\0';
    switch (data[0]) {
        case 'n':
            try_numbers(length);
            break;
        case 't':
            try_words();
            break;
        case 'm':
            try_name(length);
            break;
        case 's':
            try_setting();
            break;
        case 'i':
            try_lines(length);
            break;
        case 'l':
            try_json_texts(length);
            break;
        default:
            try_format(data, size);
            break;
    }
    return 0;
}
