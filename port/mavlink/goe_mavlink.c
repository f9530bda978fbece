/* Payloads and frames: one codec over tables of where the fields lie. SPDX-License-Identifier: MIT */
#include "goe_mavlink.h"

#include <string.h>

#define FRAME_START 0xFDu /* of MAVLink 2 */
#define HEADER_BYTES 10u
#define CHECKSUM_BYTES 2u
#define CHECKSUM_BEGIN 0xFFFFu
#define CHECKSUM_POLYNOMIAL 0x8408u /* x^16 + x^12 + x^5 + 1, the lowest bit first: X.25 */

static const goe_mavlink_info_t infos[GOE_MAVLINK_MESSAGES] = {
#define GOE_MAVLINK_INFO(message, name, id, crc_extra, length_min, length)                                             \
    [GOE_MAVLINK_##message] = {name, id, crc_extra, length_min, length},
#include "goe_mavlink_messages.h"
#undef GOE_MAVLINK_INFO
};

const goe_mavlink_info_t *goe_mavlink_info(goe_mavlink_message_t message) {
    return (unsigned)message < (unsigned)GOE_MAVLINK_MESSAGES ? &infos[message] : NULL;
}

goe_mavlink_message_t goe_mavlink_of_id(uint32_t id) {
    int message = 0;
    while (message < GOE_MAVLINK_MESSAGES && infos[message].id != id) {
        message++;
    }
    return (goe_mavlink_message_t)message;
}

/* ------------------------------------------------------------------------------------------------------------ tables -- */

/* Fields of one size that follow each other in the structure as they do on the wire. */
typedef struct {
    uint8_t offset; /* of the first, in the structure */
    uint8_t size;   /* of an element, bytes */
    uint8_t count;  /* of elements */
} run_t;

typedef struct {
    const run_t *run;
    uint8_t runs;
    uint8_t size; /* of the structure */
} layout_t;

#define END_OF(message, field)                                                                                         \
    (offsetof(goe_mavlink_##message##_t, field) + sizeof((const goe_mavlink_##message##_t *)0)->field)
#define RUN(message, first, last, size)                                                                                \
    {offsetof(goe_mavlink_##message##_t, first), size,                                                                 \
     (END_OF(message, last) - offsetof(goe_mavlink_##message##_t, first)) / (size)}

static const run_t features[] = {RUN(features, time_usec, time_usec, 8), RUN(features, age_usec, obstacle_id, 4),
                                 RUN(features, box, visible, 2),         RUN(features, camera_id, score, 1),
                                 RUN(features, u, kind_height_sd, 2),    RUN(features, kind_shape, kind_shape, 1)};
static const run_t obstacle[] = {RUN(obstacle, time_usec, time_usec, 8), RUN(obstacle, id, age, 4),
                                 RUN(obstacle, slot, flags, 1)};
static const run_t hazard[] = {RUN(hazard, time_usec, time_usec, 8), RUN(hazard, id, needed, 4),
                               RUN(hazard, slot, flags, 1)};
static const run_t status[] = {RUN(status, time_boot_ms, time_boot_ms, 4), RUN(status, taken, delay_max, 2),
                               RUN(status, obstacles, unplaced, 1)};
static const run_t landing_target[] = {RUN(landing_target, time_usec, time_usec, 8),
                                       RUN(landing_target, angle_x, size_y, 4),
                                       RUN(landing_target, target_num, frame, 1), RUN(landing_target, x, q, 4),
                                       RUN(landing_target, type, position_valid, 1)};
static const run_t tracking[] = {RUN(tracking, point_x, rec_bottom_y, 4),
                                 RUN(tracking, tracking_status, camera_device_id, 1)};
static const run_t obstacle_distance[] = {
    RUN(obstacle_distance, time_usec, time_usec, 8), RUN(obstacle_distance, distances, max_distance, 2),
    RUN(obstacle_distance, sensor_type, increment, 1), RUN(obstacle_distance, increment_f, angle_offset, 4),
    RUN(obstacle_distance, frame, frame, 1)};
static const run_t obstacle_distance_3d[] = {RUN(obstacle_distance_3d, time_boot_ms, max_distance, 4),
                                             RUN(obstacle_distance_3d, obstacle_id, obstacle_id, 2),
                                             RUN(obstacle_distance_3d, sensor_type, frame, 1)};
static const run_t collision[] = {RUN(collision, id, horizontal_minimum_delta, 4),
                                  RUN(collision, src, threat_level, 1)};
static const run_t target_absolute[] = {RUN(target_absolute, timestamp, timestamp, 8),
                                        RUN(target_absolute, lat, acc_std, 4),
                                        RUN(target_absolute, id, sensor_capabilities, 1)};
static const run_t adsb_vehicle[] = {RUN(adsb_vehicle, icao_address, altitude, 4),
                                     RUN(adsb_vehicle, heading, squawk, 2), RUN(adsb_vehicle, altitude_type, tslc, 1)};

#define LAYOUT(name) {name, sizeof(name) / sizeof(name)[0], sizeof(goe_mavlink_##name##_t)}

static const layout_t layouts[GOE_MAVLINK_MESSAGES] = {
    [GOE_MAVLINK_FEATURES] = LAYOUT(features),
    [GOE_MAVLINK_OBSTACLE] = LAYOUT(obstacle),
    [GOE_MAVLINK_HAZARD] = LAYOUT(hazard),
    [GOE_MAVLINK_STATUS] = LAYOUT(status),
    [GOE_MAVLINK_LANDING_TARGET] = LAYOUT(landing_target),
    [GOE_MAVLINK_TRACKING] = LAYOUT(tracking),
    [GOE_MAVLINK_OBSTACLE_DISTANCE] = LAYOUT(obstacle_distance),
    [GOE_MAVLINK_OBSTACLE_DISTANCE_3D] = LAYOUT(obstacle_distance_3d),
    [GOE_MAVLINK_COLLISION] = LAYOUT(collision),
    [GOE_MAVLINK_TARGET_ABSOLUTE] = LAYOUT(target_absolute),
    [GOE_MAVLINK_ADSB_VEHICLE] = LAYOUT(adsb_vehicle),
};

/* ------------------------------------------------------------------------------------------------------------- codec -- */

/* Where this machine keeps the byte that is number `byte` of an element from the lowest one on. */
static size_t kept_at(size_t byte, size_t size) {
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, sizeof first);
    return first == 1u ? byte : size - 1u - byte;
}

/* The wire's byte `at` of a run as an offset into the structure. */
static size_t offset_of(const run_t *run, size_t at) {
    const size_t element = at / run->size;
    return run->offset + element * run->size + kept_at(at - element * run->size, run->size);
}

static size_t pack(goe_mavlink_message_t message, const void *structure, uint8_t *payload) {
    const layout_t *layout = &layouts[message];
    const uint8_t *from = (const uint8_t *)structure;
    size_t length = 0;
    for (size_t k = 0; k < layout->runs; k++) {
        const run_t *run = &layout->run[k];
        for (size_t at = 0; at < (size_t)run->size * run->count; at++) {
            payload[length++] = from[offset_of(run, at)];
        }
    }
    while (length > 1u && payload[length - 1u] == 0u) {
        length--;
    }
    return length;
}

static void unpack(goe_mavlink_message_t message, const uint8_t *payload, size_t length, void *structure) {
    const layout_t *layout = &layouts[message];
    uint8_t *to = (uint8_t *)structure;
    size_t next = 0;
    memset(structure, 0, layout->size);
    for (size_t k = 0; k < layout->runs; k++) {
        const run_t *run = &layout->run[k];
        for (size_t at = 0; at < (size_t)run->size * run->count && next < length; at++) {
            to[offset_of(run, at)] = payload[next++];
        }
    }
}

#define CODEC(message, name)                                                                                           \
    size_t goe_mavlink_pack_##name(const goe_mavlink_##name##_t *message_, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]) { \
        return pack(GOE_MAVLINK_##message, message_, payload);                                                         \
    }                                                                                                                  \
    void goe_mavlink_read_##name(const uint8_t *payload, size_t length, goe_mavlink_##name##_t *message_) {            \
        unpack(GOE_MAVLINK_##message, payload, length, message_);                                                      \
    }
CODEC(FEATURES, features)
CODEC(OBSTACLE, obstacle)
CODEC(HAZARD, hazard)
CODEC(STATUS, status)
CODEC(LANDING_TARGET, landing_target)
CODEC(TRACKING, tracking)
CODEC(OBSTACLE_DISTANCE, obstacle_distance)
CODEC(OBSTACLE_DISTANCE_3D, obstacle_distance_3d)
CODEC(COLLISION, collision)
CODEC(TARGET_ABSOLUTE, target_absolute)
CODEC(ADSB_VEHICLE, adsb_vehicle)

/* ------------------------------------------------------------------------------------------------------------- frame -- */

static uint16_t checksum(uint16_t sum, const uint8_t *bytes, size_t count) {
    unsigned rest = sum;
    for (size_t i = 0; i < count; i++) {
        rest ^= bytes[i];
        for (int shift = 0; shift < 8; shift++) {
            rest = (rest & 1u) != 0u ? (rest >> 1) ^ CHECKSUM_POLYNOMIAL : rest >> 1;
        }
    }
    return (uint16_t)rest;
}

size_t goe_mavlink_frame(goe_mavlink_sender_t *sender, goe_mavlink_message_t message, const uint8_t *payload,
                         size_t length, uint8_t frame[GOE_MAVLINK_FRAME_MAX]) {
    const goe_mavlink_info_t *info = goe_mavlink_info(message);
    if (!info || length < 1u || length > info->length) {
        return 0;
    }
    const uint8_t header[HEADER_BYTES] = {FRAME_START,
                                          (uint8_t)length,
                                          0u, /* flags that a receiver must know: none, no signature */
                                          0u, /* flags that it need not know */
                                          sender->sequence,
                                          sender->system,
                                          sender->component,
                                          (uint8_t)(info->id & 0xFFu),
                                          (uint8_t)(info->id >> 8 & 0xFFu),
                                          (uint8_t)(info->id >> 16 & 0xFFu)};
    memcpy(frame, header, HEADER_BYTES);
    memcpy(frame + HEADER_BYTES, payload, length);
    const uint16_t of_frame = checksum(CHECKSUM_BEGIN, frame + 1, HEADER_BYTES - 1u + length);
    const uint16_t sum = checksum(of_frame, &info->crc_extra, 1);
    frame[HEADER_BYTES + length] = (uint8_t)(sum & 0xFFu);
    frame[HEADER_BYTES + length + 1u] = (uint8_t)(sum >> 8);
    sender->sequence = (uint8_t)(sender->sequence + 1u); /* 0 follows 255 */
    return HEADER_BYTES + length + CHECKSUM_BYTES;
}
