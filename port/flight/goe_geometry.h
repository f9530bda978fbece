/* Pixels of positions, latitude and longitude, bearings and sectors. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_GEOMETRY_H
#define GOE_FLIGHT_GEOMETRY_H

#include "goe_flight.h"
#include "goe_history.h"

/* Computes position and orientation of a camera from its settings. */
void goe_flight_geometry_camera(goe_flight_camera_t *camera, const goe_camera_t *settings);

/* Computes the pixel of a point. Returns false if the point is behind the camera, or outside the image by more
 * than half of the image's size. */
bool goe_flight_geometry_project(const goe_flight_camera_t *camera, const goe_flight_history_pose_t *pose,
                                 const float point_ned_m[3], float pixel[2]);

/* Computes latitude and longitude (degrees times 1e7) of a position north and east of an origin, to first order on a sphere of 6371 km,
 * as in PX4's local projection. The error is at most 1 m within 5 km, below 75 degrees of latitude. */
void goe_flight_geometry_lat_lon(int32_t origin_lat_e7, int32_t origin_lon_e7, const float ne_m[2], int32_t *lat_e7,
                                 int32_t *lon_e7);

/* Marks as clear the sectors whose ground at the distance max_cm is visible to a camera at this attitude and height. Such an image also
 * shows a nearer obstacle on that ground that is as high as the aircraft. */
void goe_flight_geometry_open_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm,
                                      const goe_flight_camera_t *camera, const float q[4], float above_m);

#define GOE_FLIGHT_ANY_BEARING 180 /* value of half_deg: the bearing is not known */

/* Computes the bearings of a part of the image (left, top, right, bottom, pixels) from its middle and its corners. */
void goe_flight_geometry_bearings(const goe_flight_camera_t *camera, const float q[4], const float extent_px[4],
                                  goe_flight_bearings_t *bearings);

/* Makes the sectors unknown that these bearings touch when they are wider by widen_deg on each side. */
void goe_flight_geometry_close_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], const goe_flight_bearings_t *bearings,
                                       float widen_deg);

/* Whether a circle, moved nearer by nearer_m, is within max_cm. */
bool goe_flight_geometry_reaches(uint32_t max_cm, const float away_ne_m[2], float radius_m, float nearer_m);

/* Enters a circle, at a place relative to the aircraft, into the sectors that it touches, with its nearest point. If this point is beyond
 * max_cm, but within it when nearer by nearer_m, those of these sectors that are clear become unknown. */
void goe_flight_geometry_enter_circle(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm, const float away_ne_m[2],
                                      float radius_m, float nearer_m);

#endif
