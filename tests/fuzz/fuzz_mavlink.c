/* Fuzzes the MAVLink messages from the wire to the flight layer and back. SPDX-License-Identifier: MIT
 *
 * The first byte selects a message, the rest is its payload. The payload is read, packed again and put into a frame. A message about an
 * obstacle also goes into the flight layer. */
#include <string.h>

#include "fuzz.h"
#include "fuzz_input.h"
#include "goe_mavlink_map.h"

#define GUARD 0xC3

enum { INPUTS, READ, SIGHTINGS, FRAMES, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"inputs", 0}, {"read", 0}, {"sightings", 0}, {"frames_taken", 0}, {NULL, 0}};

static goe_flight_t flight;

static void start(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 914.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;
    FUZZ_CHECK(goe_flight_init(&flight, sizeof flight, &settings, NULL, NULL) == GOE_FLIGHT_OK);
    for (uint32_t time_us = 0u; time_us <= 1000000u; time_us += 20000u) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        memset(&attitude, 0, sizeof attitude);
        memset(&position, 0, sizeof position);
        attitude.time_us = position.time_us = time_us;
        attitude.q[0] = 1.0f;
        position.position_ned_m[2] = -20.0f;
        FUZZ_CHECK(goe_flight_attitude(&flight, &attitude) == GOE_FLIGHT_OK);
        FUZZ_CHECK(goe_flight_position(&flight, &position) == GOE_FLIGHT_OK);
    }
}

static void take(bool has, const goe_mavlink_sighting_t *sighting) {
    FUZZ_CHECK(sighting->frame.count == (has ? 1u : 0u) && sighting->frame.detection == &sighting->detection);
    fuzz_counts[SIGHTINGS].times += has ? 1u : 0u;
    const goe_flight_status_t status = goe_flight_frame(&flight, &sighting->frame);
    fuzz_counts[FRAMES].times += status == GOE_FLIGHT_OK ? 1u : 0u;
}

/* A packed message is read back as the same, and no byte outside the frame is written. */
#define TRY(kind, name)                                                                                                \
    do {                                                                                                               \
        goe_mavlink_##name##_t message, again;                                                                         \
        goe_mavlink_read_##name(payload, size, &message);                                                              \
        length = goe_mavlink_pack_##name(&message, packed);                                                            \
        goe_mavlink_read_##name(packed, length, &again);                                                               \
        FUZZ_CHECK(goe_mavlink_pack_##name(&again, twice) == length);                                                  \
        FUZZ_CHECK(memcmp(packed, twice, length) == 0 && length <= goe_mavlink_info(kind)->length);                    \
    } while (0)

static size_t try_message(goe_mavlink_message_t kind, const uint8_t *payload, size_t size, uint8_t *packed) {
    uint8_t twice[GOE_MAVLINK_PAYLOAD_MAX];
    size_t length = 0;
    switch (kind) {
        case GOE_MAVLINK_FEATURES:
            TRY(GOE_MAVLINK_FEATURES, features);
            break;
        case GOE_MAVLINK_OBSTACLE:
            TRY(GOE_MAVLINK_OBSTACLE, obstacle);
            break;
        case GOE_MAVLINK_HAZARD:
            TRY(GOE_MAVLINK_HAZARD, hazard);
            break;
        case GOE_MAVLINK_STATUS:
            TRY(GOE_MAVLINK_STATUS, status);
            break;
        case GOE_MAVLINK_LANDING_TARGET:
            TRY(GOE_MAVLINK_LANDING_TARGET, landing_target);
            break;
        case GOE_MAVLINK_TRACKING:
            TRY(GOE_MAVLINK_TRACKING, tracking);
            break;
        case GOE_MAVLINK_OBSTACLE_DISTANCE:
            TRY(GOE_MAVLINK_OBSTACLE_DISTANCE, obstacle_distance);
            break;
        case GOE_MAVLINK_OBSTACLE_DISTANCE_3D:
            TRY(GOE_MAVLINK_OBSTACLE_DISTANCE_3D, obstacle_distance_3d);
            break;
        case GOE_MAVLINK_COLLISION:
            TRY(GOE_MAVLINK_COLLISION, collision);
            break;
        case GOE_MAVLINK_TARGET_ABSOLUTE:
            TRY(GOE_MAVLINK_TARGET_ABSOLUTE, target_absolute);
            break;
        case GOE_MAVLINK_ADSB_VEHICLE:
            TRY(GOE_MAVLINK_ADSB_VEHICLE, adsb_vehicle);
            break;
        case GOE_MAVLINK_MESSAGES:
        default:
            break;
    }
    fuzz_counts[READ].times++;
    return length;
}

static void try_in(goe_mavlink_message_t kind, const uint8_t *payload, size_t size) {
    const goe_mavlink_camera_t camera = {1280.0f, 1280.0f, 914.0f, 914.0f, 640.0f, 640.0f, 0, 80000u, 5000u, true};
    goe_mavlink_sighting_t sighting;
    if (kind == GOE_MAVLINK_FEATURES) {
        goe_mavlink_features_t features;
        goe_mavlink_read_features(payload, size, &features);
        take(goe_mavlink_from_features(&features, 1000000u, &sighting), &sighting);
    } else if (kind == GOE_MAVLINK_LANDING_TARGET) {
        goe_mavlink_landing_target_t target;
        goe_mavlink_read_landing_target(payload, size, &target);
        take(goe_mavlink_from_landing_target(&target, &camera, 1000000u, &sighting), &sighting);
    } else if (kind == GOE_MAVLINK_TRACKING) {
        goe_mavlink_tracking_t tracking;
        goe_mavlink_read_tracking(payload, size, &tracking);
        take(goe_mavlink_from_tracking(&tracking, &camera, 1000000u, &sighting), &sighting);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    uint8_t packed[GOE_MAVLINK_PAYLOAD_MAX];
    uint8_t frame[GOE_MAVLINK_FRAME_MAX + 1];
    goe_mavlink_sender_t sender = {1, 1, 0};
    fuzz_counts[INPUTS].times++;
    start();
    /* a message each: number, length, payload */
    fuzz_input_t in = {data, size};
    for (uint8_t k = 0; k < UINT8_MAX && in.left > 0; k++) {
        const goe_mavlink_message_t kind = (goe_mavlink_message_t)fuzz_below(&in, GOE_MAVLINK_MESSAGES);
        const size_t wanted = fuzz_byte(&in);
        const size_t length = wanted < in.left ? wanted : in.left;
        const size_t most = try_message(kind, in.next, length, packed);
        memset(frame, GUARD, sizeof frame);
        const size_t bytes = goe_mavlink_frame(&sender, kind, packed, most, frame);
        FUZZ_CHECK(bytes == most + 12u && frame[bytes] == GUARD);
        try_in(kind, in.next, length);
        in.next += length;
        in.left -= length;
    }
    return 0;
}
