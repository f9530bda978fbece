/* JSON lines: parsed content, refused lines, robustness. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "detection_text.h"
#include "line_reader.h"

#define AUTOPILOT_US 60000000
#define UNIX_US 1790000000000000
#define MONOTONIC_US 5000000000

static check_random_t any;
static companion_config_t config;
static camera_image_t image;
static detection_fault_t fault;
static const detection_now_t now = {UNIX_US, MONOTONIC_US, AUTOPILOT_US, 300.0};

void setUp(void) {
    any = check_random_start("companion lines");
    (void)memset(&config, 0, sizeof config);
    config.detections_clock = LINE_CLOCK_UNIX;
    config.detections_delay_s = 0.08;
    config.detections_delay_sd_s = 0.01;
    config.flight.delay_sd_s = 0.004f;
}
void tearDown(void) {}

static bool read_line(const char *line) {
    fault.text[0] = '\0';
    return detection_text_read(line, strlen(line), &config, &now, &image, &fault);
}

static void refused(const char *line, const char *because) {
    TEST_ASSERT_FALSE_MESSAGE(read_line(line), line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(fault.text, because), fault.text);
}

static void check_capture(const char *line, uint32_t age_us, uint32_t sd_us) {
    TEST_ASSERT_TRUE_MESSAGE(read_line(line), fault.text);
    TEST_ASSERT_UINT32_WITHIN(1, AUTOPILOT_US - age_us, image.frame.capture_us);
    TEST_ASSERT_UINT32_WITHIN(1, sd_us, image.frame.time_sd_us);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_AUTOPILOT_CLOCK, image.frame.time_base);
}

static void a_line_has_the_fields_of_the_readme(void) {
    TEST_ASSERT_TRUE(
        read_line("{\"time\": 1789999999.9, \"camera\": 1, \"detections\": [{\"id\": 3, \"score\": 0.875, \"box\": "
                  "[612.5, 400, 660, 512.5], \"base_near\": [630, 511], \"pixel_sd\": 2.5}]}"));
    TEST_ASSERT_EQUAL_UINT(1, image.detections);
    TEST_ASSERT_EQUAL_UINT8(1, image.frame.number);
    TEST_ASSERT_EQUAL_UINT8(1, image.frame.camera);
    const goe_flight_detection_t *d = &image.detection[0];
    TEST_ASSERT_EQUAL_UINT32(3, d->id);
    CHECK_SAME(0.875f, d->score);
    CHECK_SAME(2.5f, d->pixel_px);
    CHECK_SAME(612.5f, d->box.left_px);
    CHECK_SAME(400.0f, d->box.top_px);
    CHECK_SAME(660.0f, d->box.right_px);
    CHECK_SAME(512.5f, d->box.bottom_px);
    TEST_ASSERT_EQUAL_UINT8(GOE_SIDES_ALL, d->box.sides);
    TEST_ASSERT_TRUE(d->base_near.visible);
    CHECK_SAME(511.0f, d->base_near.v_px);
    TEST_ASSERT_FALSE(d->left.visible);
}

static void other_programs_keys_are_understood(void) {
    TEST_ASSERT_TRUE(
        read_line("[{\"name\": \"tower\", \"class\": 4, \"confidence\": 0.5, \"track_id\": 9, \"box\": {\"x1\": 1, "
                  "\"y1\": 2, \"x2\": 30, \"y2\": 40}, \"segments\": {\"x\": [], \"y\": []}}]"));
    TEST_ASSERT_EQUAL_UINT32(9, image.detection[0].id);
    CHECK_SAME(0.5f, image.detection[0].score);
    CHECK_SAME(40.0f, image.detection[0].box.bottom_px);
    TEST_ASSERT_UINT32_WITHIN(1, AUTOPILOT_US - 80000, image.frame.capture_us); /* the calibrated delay */
}

static void every_clock_gives_the_same_exposure(void) {
    check_capture("{\"time\": 1789999999.9, \"detections\": []}", 100000, 4011);
    check_capture("{\"time\": 4999.9, \"clock\": \"monotonic\", \"detections\": []}", 100000, 4011);
    check_capture("{\"time\": 0.1, \"clock\": \"age\", \"detections\": []}", 100000, 4011);
    check_capture("{\"time\": 59.9, \"clock\": \"autopilot\", \"detections\": []}", 100000, 4000);
    check_capture("{\"time\": 0.1, \"clock\": \"age\", \"time_sd\": 0.0004, \"detections\": []}", 100000, 500);
    check_capture("{\"detections\": []}", 80000, 10004);
}

static void classes_are_picked(void) {
    (void)strcpy(config.detections_classes, " tower building ");
    TEST_ASSERT_TRUE(
        read_line("[{\"name\": \"tower\", \"box\": [1, 2, 3, 4]}, {\"name\": \"tow\", \"box\": [1, 2, 3, 4]}, "
                  "{\"class\": \"building\", \"box\": [1, 2, 3, 4]}, {\"box\": [1, 2, 3, 4]}]"));
    TEST_ASSERT_EQUAL_UINT(2, image.detections);
}

static void bad_lines_are_refused_with_their_reason(void) {
    refused("", "column");
    refused("{\"detections\": [", "column");
    refused("3", "column 1");
    refused("{}", "\"detections\" is no list");
    refused("{\"detections\": {}}", "\"detections\" is no list");
    refused("[1]", "detection 1 is no object");
    refused("[{\"id\": 1}]", "neither a box nor points");
    refused("[{\"box\": [1, 2, 3]}]", "\"box\" is not");
    refused("[{\"box\": [1, 2, 3, \"4\"]}]", "\"box\" is not");
    refused("[{\"left\": [1]}]", "\"left\" is not");
    refused("[{\"box\": [1, 2, 3, 4], \"score\": 2}]", "\"score\" is out of range");
    refused("[{\"box\": [1, 2, 3, 4], \"id\": -1}]", "\"id\" is out of range");
    refused("[{\"box\": [1, 2, 3, 4], \"id\": \"a\"}]", "\"id\" is not a number");
    refused("{\"clock\": \"gps\", \"detections\": []}", "\"clock\" is none of");
    refused("{\"time\": 1790000100, \"detections\": []}", "ahead of now");
    refused("{\"time\": 1789990000, \"detections\": []}", "old");
    refused("{\"camera\": 7, \"detections\": []}", "\"camera\" is out of range");
    refused("{\"detections\": [], \"detections\": []}", "duplicate");
}

/* Numbers beyond a float become infinite: the flight layer refuses them by their bits. */
static void huge_numbers_are_left_to_the_flight_layer(void) {
    TEST_ASSERT_TRUE(read_line("[{\"box\": [1e300, 2, -1e300, 4]}]"));
    TEST_ASSERT_FALSE(check_is_finite(image.detection[0].box.left_px));
}

static void more_detections_than_a_frame_can_count_are_cut(void) {
    static char line[32768] = "[";
    size_t length = 1;
    for (int i = 0; i < 400; i++) {
        length += (size_t)snprintf(line + length, sizeof line - length, "%s{\"box\": [1, 2, 3, 4]}", i == 0 ? "" : ",");
    }
    (void)snprintf(line + length, sizeof line - length, "]");
    TEST_ASSERT_TRUE(read_line(line));
    TEST_ASSERT_EQUAL_UINT(CAMERA_IMAGE_DETECTIONS, image.detections);
    TEST_ASSERT_EQUAL_UINT8(CAMERA_IMAGE_DETECTIONS, image.frame.number);
}

/* A good line with some changed bytes is read or refused, and all values read are within the ranges. */
static void changed_lines_never_break_anything(void) {
    static const char good[] =
        "{\"time\": 0.1, \"clock\": \"age\", \"camera\": 0, \"detections\": [{\"id\": 3, \"score\": 0.8, "
        "\"box\": {\"x1\": 1, \"y1\": 2, \"x2\": 3, \"y2\": 4}, \"left\": [1, 2]}]}";
    static const char marks[] = "{}[]\":,.0123456789eE-+ntfu\\ \x01\xff";
    int read = 0;
    for (int k = 0; k < 100000; k++) {
        char line[sizeof good];
        (void)memcpy(line, good, sizeof good);
        for (uint32_t changes = 1u + check_random_bits(&any) % 3u; changes > 0; changes--) {
            line[check_random_bits(&any) % (sizeof good - 1u)] = marks[check_random_bits(&any) % (sizeof marks - 1u)];
        }
        if (detection_text_read(line, sizeof good - 1u, &config, &now, &image, &fault)) {
            read++;
            TEST_ASSERT_TRUE(image.detections <= CAMERA_IMAGE_DETECTIONS && image.frame.camera < GOE_CAMERAS_MAX);
            TEST_ASSERT_TRUE(image.frame.time_sd_us > 0);
        } else {
            TEST_ASSERT_NOT_EQUAL(0, fault.text[0]);
        }
    }
    check_report("changed lines that were read, per cent", read / 1000.0);
    TEST_ASSERT_TRUE(read > 1000); /* not all lines were refused */
}

/* -------------------------------------------------------------------------------------------------------- line reader -- */

static char lines_read[256];

static void keep(void *user, const char *line, size_t length) {
    (void)user;
    const size_t used = strlen(lines_read);
    (void)snprintf(lines_read + used, sizeof lines_read - used, "%.*s|", (int)length, line);
}

static void lines_come_out_whole_however_they_are_cut(void) {
    static const char text[] = "one\n\n  \ntwo\r\nthree";
    for (size_t cut = 0; cut < sizeof text; cut++) {
        static line_reader_t reader;
        (void)memset(&reader, 0, sizeof reader);
        lines_read[0] = '\0';
        line_reader_take(&reader, text, cut, keep, NULL);
        line_reader_take(&reader, text + cut, sizeof text - 1u - cut, keep, NULL);
        line_reader_end(&reader, keep, NULL);
        TEST_ASSERT_EQUAL_STRING("one|two\r|three|", lines_read);
        TEST_ASSERT_EQUAL_UINT32(3, (uint32_t)reader.line);
    }
}

static void check_texts(const char *bytes, const char *expected) {
    static line_reader_t reader;
    (void)memset(&reader, 0, sizeof reader);
    lines_read[0] = '\0';
    line_reader_take(&reader, bytes, strlen(bytes), keep, NULL);
    TEST_ASSERT_EQUAL_STRING(expected, lines_read);
}

/* As json.dumps(..., indent=2) prints: complete with the last bracket, so no image waits for the next one. */
static void an_indented_text_goes_over_several_lines(void) {
    check_texts("[\n  {\n    \"a\": \"]}\\\"\"\n  }\n]\n", "[\n  {\n    \"a\": \"]}\\\"\"\n  }\n]|");
    check_texts("[\n]\n[\n]\n", "[\n]|[\n]|");
    check_texts("[\n\n  1]\n", "[\n\n  1]|");
}

/* A malformed detection does not affect others. */
static void a_text_that_is_left_open_ends_where_another_one_begins(void) {
    check_texts("[{\n{}\n", "[{\n|{}|");
    check_texts("[\"open\n{}\n", "[\"open\n|{}|");
    check_texts("]]\n{}\n", "]]|{}|");
}

static void a_line_without_end_is_passed_over_and_the_next_one_is_read(void) {
    static line_reader_t reader;
    static char flood[4096];
    (void)memset(flood, 'x', sizeof flood);
    lines_read[0] = '\0';
    for (int i = 0; i < 1000; i++) {
        line_reader_take(&reader, flood, sizeof flood, keep, NULL);
    }
    line_reader_take(&reader, "\nnext\n", 6, keep, NULL);
    TEST_ASSERT_EQUAL_STRING("next|", lines_read);
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)reader.cut);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_line_has_the_fields_of_the_readme);
    RUN_TEST(other_programs_keys_are_understood);
    RUN_TEST(every_clock_gives_the_same_exposure);
    RUN_TEST(classes_are_picked);
    RUN_TEST(bad_lines_are_refused_with_their_reason);
    RUN_TEST(huge_numbers_are_left_to_the_flight_layer);
    RUN_TEST(more_detections_than_a_frame_can_count_are_cut);
    RUN_TEST(changed_lines_never_break_anything);
    RUN_TEST(lines_come_out_whole_however_they_are_cut);
    RUN_TEST(an_indented_text_goes_over_several_lines);
    RUN_TEST(a_text_that_is_left_open_ends_where_another_one_begins);
    RUN_TEST(a_line_without_end_is_passed_over_and_the_next_one_is_read);
    return UNITY_END();
}
