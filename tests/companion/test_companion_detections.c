/* Conversion of JSON lines into images. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "detection_text.h"
#include "obstacle_class.h"

#define NOW_US 900000000 /* of the autopilot's clock */
#define UNIX_US 1700000000000000
#define MONOTONIC_US 55000000
#define SD_US 3000.0 /* sigma of the offset between both clocks */

static companion_config_t config;
static camera_image_t image;
static detection_fault_t fault;
static const detection_now_t now = {UNIX_US, MONOTONIC_US, NOW_US, SD_US};

void setUp(void) {
    (void)memset(&config, 0, sizeof config);
    (void)memset(&image, 0xA5, sizeof image);
    goe_flight_settings_default(&config.flight);
    config.detections_clock = LINE_CLOCK_UNIX;
    config.detections_delay_s = 0.08;
    config.detections_delay_sd_s = 0.02;
}
void tearDown(void) {}

static bool reads(const char *line) {
    fault.text[0] = '\0';
    return detection_text_read(line, strlen(line), &config, &now, &image, &fault);
}

/* A line with these members in addition to its detections. */
static bool reads_with(const char *members) {
    char line[256];
    (void)snprintf(line, sizeof line, "{%s%s\"detections\": []}", members, *members != '\0' ? ", " : "");
    return reads(line);
}

/* The time by any clock becomes the time of the exposure by the autopilot's clock. */
static void a_time_is_of_its_clock(void) {
    static const char *const clocks[] = {"unix", "monotonic", "age", "autopilot"};
    static const double times[] = {1e-6 * UNIX_US - 0.25, 1e-6 * MONOTONIC_US - 0.25, 0.25, 1e-6 * NOW_US - 0.25};
    for (int k = 0; k < 4; k++) {
        char members[128];
        (void)snprintf(members, sizeof members, "\"clock\": \"%s\", \"time\": %.6f, \"time_sd\": 0.004", clocks[k],
                       times[k]);
        TEST_ASSERT_TRUE_MESSAGE(reads_with(members), fault.text);
        TEST_ASSERT_UINT32_WITHIN(1u, NOW_US - 250000u, image.frame.capture_us);
        TEST_ASSERT_EQUAL_UINT32(image.frame.capture_us, image.frame.sent_us);
        TEST_ASSERT_EQUAL_UINT32(NOW_US, image.frame.arrival_us);
        TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_AUTOPILOT_CLOCK, image.frame.time_base);
        /* 4 ms of the sender, 3 ms of the offset if there are two clocks */
        TEST_ASSERT_UINT32_WITHIN(1u, k == 3 ? 4000u : 5000u, image.frame.time_sd_us);
        TEST_ASSERT_EQUAL_UINT8(0, image.frame.number);
        config.detections_clock = (line_clock_t)k; /* the default, so no line has it */
        (void)snprintf(members, sizeof members, "\"time\": %.6f", times[k]);
        TEST_ASSERT_TRUE(reads_with(members));
        TEST_ASSERT_UINT32_WITHIN(1u, NOW_US - 250000u, image.frame.capture_us);
        TEST_ASSERT_UINT32_WITHIN(1u, k == 3 ? 5000u : 5831u, image.frame.time_sd_us); /* delay_sd_s: 5 ms */
    }
    TEST_ASSERT_FALSE(reads_with("\"clock\": \"sundial\", \"time\": 1"));
    TEST_ASSERT_FALSE(reads_with("\"clock\": 1, \"time\": 1"));
}

/* Without a time the configured delay applies. */
static void a_line_without_a_time_has_the_usual_delay(void) {
    TEST_ASSERT_TRUE(reads_with(""));
    TEST_ASSERT_EQUAL_UINT32(NOW_US - 80000u, image.frame.capture_us);
    TEST_ASSERT_UINT32_WITHIN(1u, 20224u, image.frame.time_sd_us); /* 20 and 3 ms */
    TEST_ASSERT_TRUE(reads_with("\"time_sd\": 0.004"));
    TEST_ASSERT_UINT32_WITHIN(1u, 5000u, image.frame.time_sd_us);
    TEST_ASSERT_TRUE(reads("[]"));
    TEST_ASSERT_EQUAL_UINT32(NOW_US - 80000u, image.frame.capture_us);
}

/* Refused: a time farther in the future than two clocks may differ, and an old time. An uncertainty is never 0, and at most a second. */
static void a_time_is_of_the_last_minute(void) {
    static const struct {
        const char *members;
        bool good;
    } cases[] = {
        {"\"clock\": \"age\", \"time\": 59.9", true},
        {"\"clock\": \"age\", \"time\": 60.1", false},
        {"\"clock\": \"age\", \"time\": -0.049", true},
        {"\"clock\": \"age\", \"time\": -0.051", false},
        {"\"clock\": \"age\", \"time\": \"1\"", false},
        {"\"clock\": \"age\", \"time\": 2e12", false},
        {"\"time_sd\": 1.0", true},
        {"\"time_sd\": 1.01", false},
        {"\"time_sd\": -0.01", false},
        {"\"time\": null", true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].good, reads_with(cases[i].members), cases[i].members);
        TEST_ASSERT_EQUAL(cases[i].good, fault.text[0] == '\0');
    }
    TEST_ASSERT_TRUE(reads_with("\"clock\": \"age\", \"time\": -0.03"));
    TEST_ASSERT_EQUAL_UINT32(NOW_US, image.frame.capture_us); /* not after its arrival */
    TEST_ASSERT_TRUE(reads_with("\"clock\": \"autopilot\", \"time\": 899.9, \"time_sd\": 1e-9"));
    TEST_ASSERT_EQUAL_UINT32(1u, image.frame.time_sd_us);
    TEST_ASSERT_TRUE(reads_with("\"time\": null, \"time_sd\": 1"));
    TEST_ASSERT_EQUAL_UINT32(1000000u, image.frame.time_sd_us);
}

static void a_camera_is_one_of_those_there_are(void) {
    TEST_ASSERT_TRUE(reads_with(""));
    TEST_ASSERT_EQUAL_UINT8(0, image.frame.camera);
    TEST_ASSERT_TRUE(reads_with("\"camera\": 1"));
    TEST_ASSERT_EQUAL_UINT8(1, image.frame.camera);
    TEST_ASSERT_FALSE(reads_with("\"camera\": 2"));
    TEST_ASSERT_FALSE(reads_with("\"camera\": -1"));
}

/* Every member of a detection, by its name and by its alternative name. */
static void a_detection_is_read_whole(void) {
    TEST_ASSERT_TRUE_MESSAGE(
        reads("[{\"id\": 4294967295, \"score\": 0.25, \"pixel_sd\": 2.5, \"box\": [1, 2, 3.5, 4],"
              "\"left\": [10, 11], \"right\": [12, 13], \"top\": [14, 15], \"base_left\": [16, 17],"
              "\"base_near\": [18, 19], \"base_right\": [20, 21]},"
              "{\"track_id\": 9, \"confidence\": 0.5, \"box\": {\"x1\": 5, \"y1\": 6, \"x2\": 7, "
              "\"y2\": 8}}, {\"base_near\": [1, 2]}]"),
        fault.text);
    const goe_flight_detection_t *d = image.detection;
    const goe_pixel_t *points[] = {&d->left, &d->right, &d->top, &d->base_left, &d->base_near, &d->base_right};
    TEST_ASSERT_EQUAL_UINT(3, image.detections);
    TEST_ASSERT_EQUAL_UINT8(3, image.frame.number);
    TEST_ASSERT_EQUAL_UINT32(4294967295u, d[0].id);
    CHECK_SAME(0.25f, d[0].score);
    CHECK_SAME(2.5f, d[0].pixel_px);
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_TRUE(points[i]->visible);
        CHECK_SAME(10.0f + 2.0f * (float)i, points[i]->u_px);
        CHECK_SAME(11.0f + 2.0f * (float)i, points[i]->v_px);
    }
    TEST_ASSERT_EQUAL_HEX8(GOE_SIDES_ALL, d[0].box.sides);
    CHECK_SAME(1.0f, d[0].box.left_px);
    CHECK_SAME(2.0f, d[0].box.top_px);
    CHECK_SAME(3.5f, d[0].box.right_px);
    CHECK_SAME(4.0f, d[0].box.bottom_px);
    TEST_ASSERT_EQUAL_UINT32(9u, d[1].id);
    CHECK_SAME(0.5f, d[1].score);
    CHECK_SAME(7.0f, d[1].box.right_px);
    CHECK_SAME(8.0f, d[1].box.bottom_px);
    TEST_ASSERT_FALSE(d[1].left.visible);
    CHECK_SAME(1.0f, d[2].score); /* without a score it is certain */
    TEST_ASSERT_EQUAL_UINT32(0u, d[2].id);
    TEST_ASSERT_EQUAL_HEX8(0, d[2].box.sides);
}

static void what_is_no_detection_is_refused(void) {
    static const char *const bad[] = {
        "",
        "{",
        "7",
        "{}",
        "{\"detections\": {}}",
        "[7]",
        "[{}]",
        "[{\"id\": 1}]",
        "[{\"id\": 1.5, \"box\": [1, 2, 3, 4]}]",
        "[{\"id\": -1, \"box\": [1, 2, 3, 4]}]",
        "[{\"id\": 4294967296, \"box\": [1, 2, 3, 4]}]",
        "[{\"id\": \"1\", \"box\": [1, 2, 3, 4]}]",
        "[{\"score\": 1.01, \"box\": [1, 2, 3, 4]}]",
        "[{\"score\": -0.01, \"box\": [1, 2, 3, 4]}]",
        "[{\"pixel_sd\": 101, \"box\": [1, 2, 3, 4]}]",
        "[{\"pixel_sd\": -1, \"box\": [1, 2, 3, 4]}]",
        "[{\"box\": [1, 2, 3]}]",
        "[{\"box\": [1, 2, 3, 4, 5]}]",
        "[{\"box\": [1, 2, 3, \"4\"]}]",
        "[{\"box\": {\"x1\": 1, \"y1\": 2, \"x2\": 3}}]",
        "[{\"box\": 7}]",
        "[{\"left\": [1]}]",
        "[{\"left\": [1, 2, 3]}]",
        "[{\"left\": [1, \"2\"]}]",
        "[{\"left\": 7}]",
        "[{\"top\": [1, 2], \"base_right\": 7}]",
        "[{\"box\": [1, 2, 3, 4], \"box\": [1, 2, 3, 4]}]",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(reads(bad[i]), bad[i]);
        TEST_ASSERT_TRUE_MESSAGE(fault.text[0] != '\0', bad[i]);
    }
}

/* If classes are named, only these count, as whole words. */
static void classes_that_are_not_wanted_are_left_out(void) {
    static const char line[] =
        "[{\"class\": \"mast\", \"box\": [1, 2, 3, 4]}, {\"name\": \"tree\", \"box\": [1, 2, 3, 4]},"
        "{\"class\": \"as\", \"box\": [1, 2, 3, 4]}, {\"box\": [1, 2, 3, 4]},"
        "{\"class\": \"cow\", \"id\": \"no number\"}]";
    (void)snprintf(config.detections_classes, sizeof config.detections_classes, " mast tree ");
    TEST_ASSERT_TRUE_MESSAGE(reads(line), fault.text);
    TEST_ASSERT_EQUAL_UINT(2, image.detections);
    TEST_ASSERT_EQUAL_UINT8(2, image.frame.number);
    config.detections_classes[0] = '\0';
    TEST_ASSERT_FALSE(reads(line));
}

/* A class by its name, or by its number in the list of names. Any other one has no size, is counted, and is no error. */
static void a_class_gives_its_size(void) {
    static const char line[] =
        "[{\"class\": \"Car\", \"box\": [1, 2, 3, 4]}, {\"class\": 7, \"name\": \"person\", \"box\": [1, 2, 3, 4]},"
        "{\"class\": 2, \"box\": [1, 2, 3, 4]}, {\"class\": 3, \"box\": [1, 2, 3, 4]}, {\"class\": -1, \"box\": [1, 2, "
        "3, 4]},"
        "{\"class\": \"cow\", \"box\": [1, 2, 3, 4]}, {\"class\": 0.5, \"box\": [1, 2, 3, 4]}, {\"box\": [1, 2, 3, "
        "4]}]";
    goe_kind_t car, person, pole;
    const goe_flight_detection_t *d = image.detection;
    TEST_ASSERT_TRUE(obstacle_class_kind("car", &car) && obstacle_class_kind("person", &person) &&
                     obstacle_class_kind("pole", &pole));
    (void)snprintf(config.detections_class_names, sizeof config.detections_class_names, "cat  dog pole");
    TEST_ASSERT_TRUE_MESSAGE(reads(line), fault.text);
    TEST_ASSERT_EQUAL_UINT(8, image.detections);
    CHECK_SAME(car.width_m, d[0].kind.width_m);
    CHECK_SAME(car.width_sd_m, d[0].kind.width_sd_m);
    CHECK_SAME(person.height_m, d[1].kind.height_m);
    CHECK_SAME(pole.height_sd_m, d[2].kind.height_sd_m);
    TEST_ASSERT_EQUAL_UINT8(GOE_KIND_ROUND, d[2].kind.shape);
    for (int i = 3; i < 8; i++) {
        CHECK_SAME(0.0f, d[i].kind.width_m);
        CHECK_SAME(0.0f, d[i].kind.height_m);
        TEST_ASSERT_EQUAL_UINT8(GOE_KIND_UNKNOWN, d[i].kind.shape);
    }
    TEST_ASSERT_EQUAL_UINT(3, image.unknown_classes); /* 3, -1 and cow; 0.5 is no class */
    (void)snprintf(config.detections_classes, sizeof config.detections_classes, " pole ");
    TEST_ASSERT_TRUE(reads(line));
    TEST_ASSERT_EQUAL_UINT(1, image.detections);
    TEST_ASSERT_EQUAL_UINT(0, image.unknown_classes);
}

/* A name of any length. */
static void a_long_name_is_an_unknown_class(void) {
    char line[256], name[OBSTACLE_CLASS_NAME_MAX + 2];
    for (int extra = 0; extra < 2; extra++) {
        (void)memset(name, 'x', sizeof name);
        name[OBSTACLE_CLASS_NAME_MAX + extra] = '\0';
        (void)snprintf(line, sizeof line, "[{\"class\": \"%s\", \"box\": [1, 2, 3, 4]}]", name);
        TEST_ASSERT_TRUE(reads(line));
        TEST_ASSERT_EQUAL_UINT(1, image.unknown_classes);
        (void)snprintf(config.detections_class_names, sizeof config.detections_class_names, "%s", name);
        TEST_ASSERT_TRUE(reads("[{\"class\": 0, \"box\": [1, 2, 3, 4]}]"));
        TEST_ASSERT_EQUAL_UINT(1, image.unknown_classes);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_time_is_of_its_clock);
    RUN_TEST(a_line_without_a_time_has_the_usual_delay);
    RUN_TEST(a_time_is_of_the_last_minute);
    RUN_TEST(a_camera_is_one_of_those_there_are);
    RUN_TEST(a_detection_is_read_whole);
    RUN_TEST(what_is_no_detection_is_refused);
    RUN_TEST(classes_that_are_not_wanted_are_left_out);
    RUN_TEST(a_class_gives_its_size);
    RUN_TEST(a_long_name_is_an_unknown_class);
    return UNITY_END();
}
