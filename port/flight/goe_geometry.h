/* Places: in the image, on the earth, by bearing. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_GEOMETRY_H
#define GOE_FLIGHT_GEOMETRY_H

#include "goe_flight.h"
#include "goe_history.h"

/* Where a camera of these settings sits and looks. */
void goe_flight_geometry_camera(goe_flight_camera_t *camera, const goe_camera_t *settings);

/* Pixel of a point, without lens distortion. False: behind the camera or outside the image by more than half of it. */
bool goe_flight_geometry_project(const goe_flight_camera_t *camera, const goe_flight_history_pose_t *pose,
                                 const float point_ned_m[3], float pixel[2]);

/* Latitude and longitude, degrees times 1e7, of a place north and east of an origin: a sphere of 6371 km, as PX4's local
 * projection, to first order; good to 1 m within 5 km, below 75 degrees of latitude. */
void goe_flight_geometry_lat_lon(int32_t origin_lat_e7, int32_t origin_lon_e7, const float ne_m[2], int32_t *lat_e7,
                                 int32_t *lon_e7);

/* The bearings, degrees from north, of the limits of the camera's view; false: it looks up or down too steeply. */
bool goe_flight_geometry_view(const goe_flight_camera_t *camera, const float q[4], float *from_deg, float *width_deg);

/* The sectors wholly within [from, from + width] are clear. */
void goe_flight_geometry_open_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm, float from_deg,
                                      float width_deg);

#define GOE_FLIGHT_ANY_BEARING 180 /* of half_deg */

/* Bearings of a part of the image (left, top, right, bottom, pixels), without lens distortion: those of its middle and its corners. */
void goe_flight_geometry_bearings(const goe_flight_camera_t *camera, const float q[4], const float extent_px[4],
                                  goe_flight_bearings_t *bearings);

/* The sectors of these bearings, and one more on each side, are unknown. */
void goe_flight_geometry_close_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], const goe_flight_bearings_t *bearings);

/* A circle at a place relative to the aircraft enters the sectors that it touches, by its nearest point. */
void goe_flight_geometry_enter_circle(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm, const float away_ne_m[2],
                                      float radius_m);

#endif
