/* Every message by its number. SPDX-License-Identifier: MIT */
#ifndef ANY_MESSAGE_H
#define ANY_MESSAGE_H

#include "goe_mavlink.h"

typedef union {
    goe_mavlink_features_t features;
    goe_mavlink_obstacle_t obstacle;
    goe_mavlink_hazard_t hazard;
    goe_mavlink_status_t status;
    goe_mavlink_landing_target_t landing_target;
    goe_mavlink_tracking_t tracking;
    goe_mavlink_obstacle_distance_t obstacle_distance;
    goe_mavlink_obstacle_distance_3d_t obstacle_distance_3d;
    goe_mavlink_collision_t collision;
    goe_mavlink_target_absolute_t target_absolute;
    goe_mavlink_adsb_vehicle_t adsb_vehicle;
} any_message_t;

size_t any_message_pack(goe_mavlink_message_t message, const any_message_t *any, uint8_t *payload);
void any_message_read(goe_mavlink_message_t message, const uint8_t *payload, size_t length, any_message_t *any);

#endif
