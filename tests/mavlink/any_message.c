/* Every message by its number. SPDX-License-Identifier: MIT */
#include "any_message.h"

size_t any_message_pack(goe_mavlink_message_t message, const any_message_t *any, uint8_t *payload) {
    switch (message) {
        case GOE_MAVLINK_FEATURES:
            return goe_mavlink_pack_features(&any->features, payload);
        case GOE_MAVLINK_OBSTACLE:
            return goe_mavlink_pack_obstacle(&any->obstacle, payload);
        case GOE_MAVLINK_HAZARD:
            return goe_mavlink_pack_hazard(&any->hazard, payload);
        case GOE_MAVLINK_STATUS:
            return goe_mavlink_pack_status(&any->status, payload);
        case GOE_MAVLINK_LANDING_TARGET:
            return goe_mavlink_pack_landing_target(&any->landing_target, payload);
        case GOE_MAVLINK_TRACKING:
            return goe_mavlink_pack_tracking(&any->tracking, payload);
        case GOE_MAVLINK_OBSTACLE_DISTANCE:
            return goe_mavlink_pack_obstacle_distance(&any->obstacle_distance, payload);
        case GOE_MAVLINK_OBSTACLE_DISTANCE_3D:
            return goe_mavlink_pack_obstacle_distance_3d(&any->obstacle_distance_3d, payload);
        case GOE_MAVLINK_COLLISION:
            return goe_mavlink_pack_collision(&any->collision, payload);
        case GOE_MAVLINK_TARGET_ABSOLUTE:
            return goe_mavlink_pack_target_absolute(&any->target_absolute, payload);
        case GOE_MAVLINK_ADSB_VEHICLE:
            return goe_mavlink_pack_adsb_vehicle(&any->adsb_vehicle, payload);
        case GOE_MAVLINK_MESSAGES:
        default:
            return 0;
    }
}

void any_message_read(goe_mavlink_message_t message, const uint8_t *payload, size_t length, any_message_t *any) {
    switch (message) {
        case GOE_MAVLINK_FEATURES:
            goe_mavlink_read_features(payload, length, &any->features);
            break;
        case GOE_MAVLINK_OBSTACLE:
            goe_mavlink_read_obstacle(payload, length, &any->obstacle);
            break;
        case GOE_MAVLINK_HAZARD:
            goe_mavlink_read_hazard(payload, length, &any->hazard);
            break;
        case GOE_MAVLINK_STATUS:
            goe_mavlink_read_status(payload, length, &any->status);
            break;
        case GOE_MAVLINK_LANDING_TARGET:
            goe_mavlink_read_landing_target(payload, length, &any->landing_target);
            break;
        case GOE_MAVLINK_TRACKING:
            goe_mavlink_read_tracking(payload, length, &any->tracking);
            break;
        case GOE_MAVLINK_OBSTACLE_DISTANCE:
            goe_mavlink_read_obstacle_distance(payload, length, &any->obstacle_distance);
            break;
        case GOE_MAVLINK_OBSTACLE_DISTANCE_3D:
            goe_mavlink_read_obstacle_distance_3d(payload, length, &any->obstacle_distance_3d);
            break;
        case GOE_MAVLINK_COLLISION:
            goe_mavlink_read_collision(payload, length, &any->collision);
            break;
        case GOE_MAVLINK_TARGET_ABSOLUTE:
            goe_mavlink_read_target_absolute(payload, length, &any->target_absolute);
            break;
        case GOE_MAVLINK_ADSB_VEHICLE:
            goe_mavlink_read_adsb_vehicle(payload, length, &any->adsb_vehicle);
            break;
        case GOE_MAVLINK_MESSAGES:
        default:
            break;
    }
}
