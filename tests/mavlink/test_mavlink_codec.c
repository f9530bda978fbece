/* Payloads and frames. tests/python/test_mavlink.py compares the fields with mavgen's.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "any_message.h"
#include "check.h"

#define GUARD 0xA5
#define ROUNDS 2000

static check_random_t any;

void setUp(void) { any = check_random_start("MAVLink codec"); }
void tearDown(void) {}

/* The last one is not 0. */
static void random_bytes(uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(check_random_bits(&any) | (i + 1u == count ? 1u : 0u));
    }
}

static goe_mavlink_features_t some_features(void) {
    const goe_mavlink_features_t features = {.time_usec = 1234567890123u,
                                             .age_usec = 45000u,
                                             .obstacle_id = 77u,
                                             .box = {-100, -200, 300, 400},
                                             .time_sd = 1500u,
                                             .image_width = 1280u,
                                             .image_height = 960u,
                                             .visible = 0x20Fu,
                                             .camera_id = 1u,
                                             .time_base = 2u,
                                             .number = 3u,
                                             .pixel_sd = 4u,
                                             .score = 95u,
                                             .u = {1, 2, 3, 4, 5, -6},
                                             .v = {7, 8, 9, 10, 11, -12}};
    return features;
}

/* The output of pymavlink 2.4.50 for the same values. */
static const uint8_t features_frame[] = {
    0xfd, 0x3d, 0x00, 0x00, 0xc9, 0x07, 0xbf, 0xcc, 0xa6, 0x00, 0xcb, 0x04, 0xfb, 0x71, 0x1f, 0x01, 0x00, 0x00, 0xc8,
    0xaf, 0x00, 0x00, 0x4d, 0x00, 0x00, 0x00, 0x9c, 0xff, 0x38, 0xff, 0x2c, 0x01, 0x90, 0x01, 0xdc, 0x05, 0x00, 0x05,
    0xc0, 0x03, 0x0f, 0x02, 0x01, 0x02, 0x03, 0x04, 0x5f, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00,
    0xfa, 0xff, 0x07, 0x00, 0x08, 0x00, 0x09, 0x00, 0x0a, 0x00, 0x0b, 0x00, 0xf4, 0xff, 0x09, 0x10};
static const uint8_t status_frame[] = {0xfd, 0x1f, 0x00, 0x00, 0xc8, 0x07, 0xbf, 0xcf, 0xa6, 0x00, 0x15,
                                       0xcd, 0x5b, 0x07, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00,
                                       0x05, 0x00, 0x06, 0x00, 0x07, 0x00, 0x08, 0x00, 0x09, 0x00, 0x0a,
                                       0x00, 0x0b, 0x00, 0x0c, 0x00, 0x02, 0x03, 0x03, 0x35, 0xab};
static const uint8_t collision_frame[] = {0xfd, 0x13, 0x00, 0x00, 0xff, 0x01, 0x9e, 0xf7, 0x00, 0x00, 0x09,
                                          0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x40, 0x00, 0x00, 0x00, 0x00,
                                          0x00, 0x00, 0x44, 0x41, 0x01, 0x03, 0x02, 0x45, 0x7c};

static void check_frame(goe_mavlink_sender_t *sender, goe_mavlink_message_t message, const any_message_t *fields,
                        const uint8_t *expected, size_t size) {
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    const uint8_t sequence = sender->sequence;
    const size_t length = any_message_pack(message, fields, payload);
    TEST_ASSERT_EQUAL(size, goe_mavlink_frame(sender, message, payload, length, frame));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, frame, size);
    TEST_ASSERT_EQUAL_UINT8((uint8_t)(sequence + 1u), sender->sequence);
}

static void frames_are_those_of_others(void) {
    goe_mavlink_sender_t sender = {7u, 191u, 200u};
    goe_mavlink_sender_t other = {1u, 158u, 255u};
    any_message_t fields;
    memset(&fields, 0, sizeof fields);
    const goe_mavlink_status_t status = {123456789u, 1u,  2u,  3u,  4u, 5u, 6u, 7u, 8u,
                                         9u,         10u, 11u, 12u, 2u, 3u, 3u, 0u, 0u};
    fields.status = status;
    check_frame(&sender, GOE_MAVLINK_STATUS, &fields, status_frame, sizeof status_frame);
    fields.features = some_features();
    check_frame(&sender, GOE_MAVLINK_FEATURES, &fields, features_frame, sizeof features_frame);
    const goe_mavlink_collision_t collision = {9u, 4.5f, 0.0f, 12.25f, 1u, 3u, 2u};
    fields.collision = collision;
    check_frame(&other, GOE_MAVLINK_COLLISION, &fields, collision_frame, sizeof collision_frame);
    TEST_ASSERT_EQUAL_UINT8(0u, other.sequence); /* it wraps */
}

static void features_are_read_field_by_field(void) {
    const goe_mavlink_features_t expected = some_features();
    goe_mavlink_features_t features;
    memset(&features, GUARD, sizeof features);
    goe_mavlink_read_features(features_frame + 10, sizeof features_frame - 12u, &features);
    TEST_ASSERT_TRUE(expected.time_usec == features.time_usec); /* Unity on targets has no 64 bits */
    TEST_ASSERT_EQUAL_UINT32(expected.age_usec, features.age_usec);
    TEST_ASSERT_EQUAL_UINT32(expected.obstacle_id, features.obstacle_id);
    TEST_ASSERT_EQUAL_INT16_ARRAY(expected.box, features.box, GOE_MAVLINK_SIDES);
    TEST_ASSERT_EQUAL_UINT16(expected.time_sd, features.time_sd);
    TEST_ASSERT_EQUAL_UINT16(expected.image_width, features.image_width);
    TEST_ASSERT_EQUAL_UINT16(expected.image_height, features.image_height);
    TEST_ASSERT_EQUAL_HEX16(expected.visible, features.visible);
    TEST_ASSERT_EQUAL_UINT8(expected.camera_id, features.camera_id);
    TEST_ASSERT_EQUAL_UINT8(expected.time_base, features.time_base);
    TEST_ASSERT_EQUAL_UINT8(expected.number, features.number);
    TEST_ASSERT_EQUAL_UINT8(expected.pixel_sd, features.pixel_sd);
    TEST_ASSERT_EQUAL_UINT8(expected.score, features.score);
    TEST_ASSERT_EQUAL_INT16_ARRAY(expected.u, features.u, GOE_MAVLINK_POINTS);
    TEST_ASSERT_EQUAL_INT16_ARRAY(expected.v, features.v, GOE_MAVLINK_POINTS);
}

/* A sender without points omits the extension. */
static void an_extension_may_be_missing(void) {
    goe_mavlink_features_t features;
    const goe_mavlink_info_t *info = goe_mavlink_info(GOE_MAVLINK_FEATURES);
    goe_mavlink_read_features(features_frame + 10, info->length_min, &features);
    TEST_ASSERT_EQUAL_UINT8(95u, features.score);
    for (int i = 0; i < GOE_MAVLINK_POINTS; i++) {
        TEST_ASSERT_EQUAL_INT16(0, features.u[i]);
        TEST_ASSERT_EQUAL_INT16(0, features.v[i]);
    }
}

/* Any payload of full length is read and packed to the same bytes, except for zeros at its end. */
static void every_byte_comes_back(void) {
    for (int k = 0; k < ROUNDS; k++) {
        const goe_mavlink_message_t message = (goe_mavlink_message_t)(k % (int)GOE_MAVLINK_MESSAGES);
        const size_t length = goe_mavlink_info(message)->length;
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        uint8_t again[GOE_MAVLINK_PAYLOAD_MAX];
        any_message_t fields;
        random_bytes(payload, length);
        memset(again, GUARD, sizeof again);
        any_message_read(message, payload, length, &fields);
        TEST_ASSERT_EQUAL(length, any_message_pack(message, &fields, again));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(payload, again, length);
        for (size_t i = length; i < sizeof again; i++) {
            TEST_ASSERT_EQUAL_HEX8(GUARD, again[i]);
        }
    }
}

static void zeros_at_the_end_are_cut_and_come_back(void) {
    for (int k = 0; k < ROUNDS; k++) {
        const goe_mavlink_message_t message = (goe_mavlink_message_t)(k % (int)GOE_MAVLINK_MESSAGES);
        const size_t length = goe_mavlink_info(message)->length;
        const size_t cut = 1u + check_random_bits(&any) % length;
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX] = {0};
        uint8_t again[GOE_MAVLINK_PAYLOAD_MAX];
        any_message_t whole;
        any_message_t shorter;
        memset(&whole, 0, sizeof whole);
        memset(&shorter, 0, sizeof shorter);
        random_bytes(payload, cut);
        any_message_read(message, payload, length, &whole);
        any_message_read(message, payload, cut, &shorter);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &shorter, sizeof whole);
        TEST_ASSERT_EQUAL(cut, any_message_pack(message, &shorter, again));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(payload, again, cut);
    }
}

static void nothing_at_all_is_one_byte(void) {
    for (int k = 0; k < (int)GOE_MAVLINK_MESSAGES; k++) {
        any_message_t fields;
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        any_message_read((goe_mavlink_message_t)k, NULL, 0, &fields);
        TEST_ASSERT_EQUAL(1, any_message_pack((goe_mavlink_message_t)k, &fields, payload));
        TEST_ASSERT_EQUAL_HEX8(0, payload[0]);
    }
}

/* A newer dialect may have added fields. */
static void what_is_longer_is_passed_over(void) {
    for (int k = 0; k < (int)GOE_MAVLINK_MESSAGES; k++) {
        const goe_mavlink_message_t message = (goe_mavlink_message_t)k;
        struct {
            any_message_t fields;
            uint8_t guard[16];
        } own, longer;
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        memset(&own, GUARD, sizeof own);
        memset(&longer, GUARD, sizeof longer);
        random_bytes(payload, sizeof payload);
        any_message_read(message, payload, goe_mavlink_info(message)->length, &own.fields);
        any_message_read(message, payload, sizeof payload, &longer.fields);
        TEST_ASSERT_EQUAL_MEMORY(&own, &longer, sizeof own);
    }
}

static void messages_are_found_by_id(void) {
    for (int k = 0; k < (int)GOE_MAVLINK_MESSAGES; k++) {
        const goe_mavlink_info_t *info = goe_mavlink_info((goe_mavlink_message_t)k);
        TEST_ASSERT_NOT_NULL(info);
        TEST_ASSERT_EQUAL(k, goe_mavlink_of_id(info->id));
        TEST_ASSERT_TRUE(info->length_min >= 1u && info->length_min <= info->length);
    }
    TEST_ASSERT_EQUAL(GOE_MAVLINK_MESSAGES, goe_mavlink_of_id(0u));
    TEST_ASSERT_EQUAL(GOE_MAVLINK_MESSAGES, goe_mavlink_of_id(0xFFFFFFFFu));
    TEST_ASSERT_NULL(goe_mavlink_info(GOE_MAVLINK_MESSAGES));
}

static void a_frame_of_nothing_is_refused(void) {
    goe_mavlink_sender_t sender = {1u, 2u, 3u};
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX] = {0};
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    memset(frame, GUARD, sizeof frame);
    TEST_ASSERT_EQUAL(0, goe_mavlink_frame(&sender, GOE_MAVLINK_MESSAGES, payload, 1, frame));
    TEST_ASSERT_EQUAL(0, goe_mavlink_frame(&sender, GOE_MAVLINK_STATUS, payload, 0, frame));
    TEST_ASSERT_EQUAL(0, goe_mavlink_frame(&sender, GOE_MAVLINK_STATUS, payload, 34, frame));
    TEST_ASSERT_EQUAL_UINT8(3u, sender.sequence);
    TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, frame, sizeof frame);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(frames_are_those_of_others);
    RUN_TEST(features_are_read_field_by_field);
    RUN_TEST(an_extension_may_be_missing);
    RUN_TEST(every_byte_comes_back);
    RUN_TEST(zeros_at_the_end_are_cut_and_come_back);
    RUN_TEST(nothing_at_all_is_one_byte);
    RUN_TEST(what_is_longer_is_passed_over);
    RUN_TEST(messages_are_found_by_id);
    RUN_TEST(a_frame_of_nothing_is_refused);
    return UNITY_END();
}
