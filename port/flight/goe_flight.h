/*
 * goe_flight - the layer between a detector, an autopilot and the estimator
 *
 * Input: attitude and position as the autopilot publishes them; detections as a detector sends them, late and with other clocks.
 * Output: the obstacles, their positions, their hazards from now on, and an order that avoids the worst one.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * THIS HEADER IS THE MANUAL. It needs only goe.h; README.md has a drawing of the data flow and the costs.
 *
 *   autopilot   goe_flight_attitude(), goe_flight_position()   each sample, as it comes
 *   detector    goe_flight_frame()                             each image, also when nothing is in view
 *   reaction    goe_flight_assess()                            at any rate, 5 to 50 Hz; then goe_flight_obstacle(), _sectors()
 *
 * ---------------------------------------------------------------------------------------------------------------------
 * Frames      as in goe.h: earth = local north, east, down (NED), m; body = forward, right, down; attitude = Hamilton quaternion
 *             (w, x, y, z), body to NED.
 * Time        uint32_t microseconds of the autopilot's clock. It may wrap: the layer uses only differences. Two compared times
 *             must not be more than half an hour apart.
 * Memory      The caller owns goe_flight_t. It has a fixed size and contains all state: no heap, no hidden statics, no recursion.
 * Threads     Every function accesses only the memory that its arguments point at. The caller must lock a shared goe_flight_t.
 * Arithmetic  float only. From the C library the layer uses sqrtf, memcpy and memset. Compiled with -ffp-contract=off, the results
 *             have the same bits on every IEEE 754 target.
 * Safety      Every output is finite. [F1] The layer refuses non-finite values, which it detects by their exponent bits, also under
 *             -ffast-math.
 * Bit flips   A flipped bit in goe_flight_t causes no write out of bounds. [F2] Settings and cameras are sealed: with a broken seal a
 *             frame, an assessment, sectors and a change of settings return GOE_FLIGHT_CORRUPTED. [F3] The other calls do not check
 *             the seal. An estimator that returns GOE_CORRUPTED starts again; if its settings are lost, it takes those of another
 *             slot. Until it has a position again, the slot keeps its position, hazard and warning, marked suspect. [F4] The rest
 *             (poses, clocks, positions, the active order) is not sealed.
 * Cost        On a Cortex-M4F (gcc), measured in instructions: a sample at most 1,720; a frame 49,900 for each obstacle in it (it
 *             includes goe_update(), whose proved limit goe.h states), and more to match each new id with each obstacle that is out
 *             of view; an assessment 38,100 with one obstacle and 23,200 for each further one with a position. While there is a
 *             hazard or an order, an assessment also examines paths: at most 6 times (4 + 4 GOE_FLIGHT_SLOTS), each against every
 *             obstacle. goe_flight_obstacle() 980; goe_flight_sectors() 13,200 with one obstacle; goe_flight_init() 12,700 for each
 *             slot. No loop runs longer than GOE_FLIGHT_SECTORS.
 * Failure     A call that returns a negative status, or GOE_FLIGHT_TOO_NEW, changes nothing except counters, with three exceptions:
 *             after a failed goe_flight_init() *flight cannot be used; the 16th GOE_FLIGHT_BAD_TIME in a row of the attitudes, or of
 *             the positions, calls goe_flight_restart(); and a GOE_FLIGHT_TOO_OLD frame still counts for the estimate of the
 *             sender's clock, because all frames look too old after that clock was set back. [F5]
 */
#ifndef GOE_FLIGHT_H
#define GOE_FLIGHT_H

#include "goe.h"

#if !GOE_WITH_HAZARD
#error "the flight layer needs GOE_WITH_HAZARD"
#endif

/* ------------------------------------------------------------------------------------------------- compile-time limits -- */

/* Like the limits of goe.h, these may be defined in GOE_CONFIG_HEADER. */
#ifndef GOE_FLIGHT_SLOTS
#define GOE_FLIGHT_SLOTS 4 /* most obstacles at a time, 1 to 16; each takes an estimator and 136 bytes */
#endif
#if GOE_FLIGHT_SLOTS < 1 || GOE_FLIGHT_SLOTS > 16
#error "GOE_FLIGHT_SLOTS must be 1 to 16"
#endif

#define GOE_FLIGHT_SAMPLES 32    /* samples in each ring of the pose history: 0.6 s or more */
#define GOE_FLIGHT_CANDIDATES 6  /* new obstacles that wait for confirmation or for a slot */
#define GOE_FLIGHT_DETECTIONS 32 /* most detections in one call of goe_flight_frame() */
#define GOE_FLIGHT_SECTORS 72    /* sectors of goe_flight_sectors(), 5 degrees each, the first centered on north */

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------- status -- */

typedef enum {
    GOE_FLIGHT_OK = 0,
    GOE_FLIGHT_TOO_NEW = 1, /* the poses are older than the frame: keep it and call again after the next sample */
    GOE_FLIGHT_TOO_OLD = -1,   /* older than the history or settings.delay_max_s, or in a gap of samples: drop it */
    GOE_FLIGHT_NO_POSE = -2,   /* no sample of attitude or position since the start or the latest unknown reset */
    GOE_FLIGHT_BAD_TIME = -3,  /* a sample that is not newer than the previous one of its kind. The 16th attitude or the 16th
                                  position in a row shows that the clock was set back, or that one sample had a time
                                  of the future: the layer then calls goe_flight_restart() */
    GOE_FLIGHT_NOT_FINITE = -4,
    GOE_FLIGHT_OUT_OF_RANGE = -5, /* a number outside the range stated at its field */
    GOE_FLIGHT_BAD_ATTITUDE = -6, /* the quaternion's norm differs from 1 by more than 1 % */
    GOE_FLIGHT_NOTHING = -7,      /* no such obstacle */
    GOE_FLIGHT_BAD_SETTINGS = -32,
    GOE_FLIGHT_BAD_ARGUMENT = -33, /* a null pointer, or a goe_flight_t of another size */
    GOE_FLIGHT_NOT_INITIALIZED = -34,
    GOE_FLIGHT_CORRUPTED = -35 /* settings of the layer or of all estimators changed after goe_flight_init(): call
                                  it again. Until then nothing is known, which is not "clear" */
} goe_flight_status_t;

/* -------------------------------------------------------------------------------------------------------- settings -- */

/* How the autopilot reports the resets of its filter. */
enum {
    GOE_FLIGHT_RESETS_COUNT = 0, /* PX4: marks are 8 bit counters. One more: a reset by the given delta; any other
                                    change: an unknown reset */
    GOE_FLIGHT_RESETS_TIME = 1   /* ArduPilot: marks are times of the latest reset. Any change is one reset */
};

/* Sources of the height above the ground. The layer chooses one per track, in this order; see goe_flight_position_t. */
enum { GOE_FLIGHT_RANGE_FINDER, GOE_FLIGHT_TERRAIN, GOE_FLIGHT_HOME, GOE_FLIGHT_HEIGHTS };

/* Field: meaning; range; default. goe_flight_settings_list.h lists ranges and defaults as a table. */
typedef struct {
    /* detector */
    float score_min;      /* detections with a lower score are ignored; 0 to 1; 0.3 */
    float confirm_images; /* images with a new obstacle, at most 1 s apart, before it gets a slot; 1 to 20; 3 */
    float detector_timeout_s; /* the detector counts as dead after this time without a frame; 0.05 to 60; 1 */
    float track_timeout_s; /* an obstacle is dropped after this time undetected, unless it is a hazard ahead. During an
                              order the time is at least 120 s, and 600 s for the order's obstacle; for 10 s after an order 600 s;
                              for an obstacle that moves 30 s. A new obstacle may need the slot earlier (README.md, "a full table");
                              1 to 600; 10 */
    /* time */
    float delay_s;     /* least time from sending to arrival, which one-way messages cannot show; 0 to 0.5; 0.005 */
    float delay_sd_s;  /* one sigma of delay_s, and of a capture time without a sigma; 0 to 0.5; 0.005 */
    float delay_max_s; /* frames exposed longer than this before the newest sample are refused; 0.02 to 0.5; 0.4 */
    float resets;      /* GOE_FLIGHT_RESETS_...; 0 or 1; 0 */
    /* sources of the height */
    float range_finder_sd_m;  /* one sigma of the range finder's height; 0.001 to 100; 0.3 */
    float range_finder_max_m; /* greatest height at which the layer uses the range finder; 0 to 1000; 40 */
    float terrain_sd_m;       /* one sigma of the height above the terrain database; 0.001 to 1000; 3 */
    float home_sd_m;          /* one sigma of the height above home; 0.001 to 1000; 5 */
    /* wanted distances */
    float margin_m;      /* horizontal distance to the outline; 0 to 1000; 15 */
    float clearance_m;   /* vertical distance over the top; 0 to 1000; 10 */
    float conflict_probability_max; /* least conflict probability that causes a reaction; 0.001 to 1; 0.1 */
    float suspect_factor; /* factor on margin and clearance while the estimate is suspect; 1 to 10; 1.5 */
    float stale_growth_m_s; /* growth of margin and clearance while the estimate is not updated; 0 to 100; 1 */
    /* abilities of the aircraft */
    float bank_deg;    /* bank angle of an avoiding turn; 5 to 70; 30 */
    float roll_in_s;   /* time from the order to that turn, with link and mode change; 0 to 20; 1.5 */
    float climb_m_s;   /* rate of an avoiding climb; 0.1 to 50; 2.5 */
    float climb_in_s;  /* time from the order to that climb; 0 to 20; 2 */
    float loiter_m;    /* radius of the autopilot's circle around a target; 0: it flies straight on; 0 to 1e4; 0 */
    float reserve_s;   /* an order comes this long before the last possible moment; 0 to 60; 3 */
    float confirm_s;   /* an order comes after the hazard has lasted this long, at once if it is late; 0 to 10; 0.3 */
    float hold_s;      /* an order ends after the hazard has been over for this long; 0 to 60; 2 */
    /* Limits of orders; hazards are reported in any case. A height of more than twice home_sd_m below the ground, as in
       a valley, withholds no order */
    float order_height_m;  /* no new order below this height above the ground; 0: no limit; 0 to 1000; 5 */
    float order_speed_m_s; /* no new order below this speed over the ground; 0 to 100; 5 */
} goe_flight_settings_t;

/* ----------------------------------------------------------------------------------------------------------- input -- */

typedef struct {
    uint32_t time_us; /* time of the sample (PX4: timestamp_sample), not of its arrival; increasing */
    float q[4];       /* w, x, y, z; norm 1 within 1 % */
    uint32_t reset;   /* mark that changes with every reset of attitude or heading. Such a reset ends all tracks, like
                         an unknown reset of the position. Obstacles are kept, suspect, until an image gives a new
                         position */
} goe_flight_attitude_t;

typedef struct {
    uint32_t time_us;
    float position_ned_m[3];   /* vehicle's reference point, each +-1e6 */
    float velocity_ned_m_s[3]; /* over the ground, each +-1e3 */
    float height_m[GOE_FLIGHT_HEIGHTS]; /* vertical, of the reference point above the ground; read if valid; +-1e5.
                                           Exactly 0 counts as not valid, because range finders report it out of reach */
    uint8_t height_valid;               /* bits 1 << GOE_FLIGHT_RANGE_FINDER, ...: the valid heights. A track keeps the
                                           ground of its first image, because a range finder would later measure roofs.
                                           Without a valid height the ground is down = 0, with the sigma of home */
    bool origin_known;                  /* the latitude and longitude of the NED origin are known */
    int32_t origin_lat_e7, origin_lon_e7; /* degrees times 1e7; +-89e7, +-180e7 */
    uint32_t reset_horizontal, reset_vertical; /* marks of resets, see goe_flight_settings_t.resets */
    bool reset_delta_known;             /* false: any reset is unknown, ends all tracks and empties the history. The
                                           layer shifts kept obstacles by the jump that the velocity reveals, if the
                                           previous sample is at most 1 s older */
    float reset_delta_ned_m[3];         /* new minus old position at the latest reset. The layer reads north and east
                                           if reset_horizontal changed, down if reset_vertical did; all are finite. The
                                           ground of every track shifts by the down part, even if height_m did not jump,
                                           so no height above the ground changes. A later track takes the ground of its
                                           first sample */
} goe_flight_position_t;

/* Clock of goe_flight_frame_t.capture_us. */
enum {
    GOE_FLIGHT_AUTOPILOT_CLOCK = 0, /* the autopilot's clock: the layer estimates no offset */
    GOE_FLIGHT_SENDER_CLOCK = 1, /* the sender's clock. Its offset comes from goe_flight_timesync(); without it, the
                                    offset is the least (arrival - sending) over 10 to 20 s, minus delay_s. Each camera
                                    may have a sender of its own: each has its own offset */
    GOE_FLIGHT_AGE = 2           /* age of the image at sending: capture = arrival - delay_s - age */
};

/* One obstacle in one image: a box, or points, or both, as in goe_image_t. */
typedef struct {
    uint32_t id;   /* from the tracker of the camera's detector; 0: no id; the layer matches by the position in the image */
    float score;   /* 0 to 1; exactly 0: the detector gives none, and the detection counts as one of full score */
    float pixel_px; /* one sigma of box and points; 0: as in the settings; 0 to 100 */
    goe_box_t box; /* raw pixels; give all sides, also at the image border, where the estimator detects truncation. Leave out
                      the bit of a side that another object hides */
    goe_pixel_t left, right, top, base_left, base_near, base_right; /* left, right, top in the image's border zone
                                                                       count as invisible; so does top if left or
                                                                       right does */
    goe_kind_t kind; /* what the detector's class says of the obstacle; 0: unknown. A kind that is not finite or out of range is
                        counted and treated as unknown */
} goe_flight_detection_t;

typedef struct {
    uint32_t arrival_us; /* autopilot's clock */
    uint32_t capture_us; /* middle of the exposure, by the clock of time_base; or the age */
    uint32_t sent_us;    /* sending time, for GOE_FLIGHT_SENDER_CLOCK. If it is unknown, set it to capture_us: delay_s
                            then counts from the exposure */
    uint32_t time_sd_us; /* one sigma of capture_us from the sender; 0: settings.delay_sd_s */
    uint8_t time_base;   /* one of the clocks above */
    uint8_t camera; /* number of the camera that took the image; a configured one, below GOE_CAMERAS_MAX */
    uint8_t number; /* detections in the image. 0: nothing in view; such a frame shows that the detector is alive */
    uint8_t count;  /* detections in this call, 0 to GOE_FLIGHT_DETECTIONS. If fewer than number, the others follow in
                       further calls with the same capture time */
    const goe_flight_detection_t *detection;
} goe_flight_frame_t;

/* ---------------------------------------------------------------------------------------------------------- output -- */

typedef enum {
    GOE_FLIGHT_NONE = 0,
    GOE_FLIGHT_LEFT = 1,      /* fly to target_ned_m, to the left of the obstacle as viewed along the course */
    GOE_FLIGHT_RIGHT = 2,     /* fly to target_ned_m, to the right of the obstacle */
    GOE_FLIGHT_CLIMB = 3,     /* fly straight on and climb to target_ned_m, which is above the top at two sigma; it
                               * moves on past the obstacle */
    GOE_FLIGHT_GO_AROUND = 4, /* abort the approach */
    GOE_FLIGHT_HOLD = 5       /* turn away to target_ned_m before the obstacle and loiter: no side is clear, and a climb
                                 comes too late */
} goe_flight_action_t;

/* The reason of the action. */
typedef enum {
    GOE_FLIGHT_REASON_NONE = 0,  /* no order is given, and none is withheld */
    GOE_FLIGHT_REASON_CLEAR = 1, /* when it was chosen, the path of the order kept at least 75 % of margin_m (HOLD: 50 %) from every
                                    known obstacle, at two sigmas. The reason stays until the path leads into an obstacle at one
                                    sigma (clear_m below 0): clear_m is the present value. With loiter_m 0 that path goes
                                    on along the order line: an aircraft that turns elsewhere at the target leaves it. CLIMB,
                                    GO_AROUND: all tops that the climb leads over are known, and it clears them in time */
    GOE_FLIGHT_REASON_LEAST_BAD = 2, /* no path is clear: the side with the largest distance, or HOLD with a distance that is larger by
                                       more than 0.2 margin_m; on approach, if these lead into an obstacle, GO_AROUND over an unknown top */
    /* an order is due and withheld, because the aircraft ... */
    GOE_FLIGHT_REASON_LOW = 3,   /* is lower than order_height_m */
    GOE_FLIGHT_REASON_SLOW = 4,  /* is slower than order_speed_m_s. At 1 m/s or less it has no course, so no order is due, and the reason of
                                    a hazard is GOE_FLIGHT_REASON_NONE */
    GOE_FLIGHT_REASON_LANDING = 5 /* flares, or has touched down */
} goe_flight_reason_t;

/* The phase of flight, for goe_flight_assess(). Any other number counts as GOE_FLIGHT_FLYING. */
enum {
    GOE_FLIGHT_FLYING = 0,
    GOE_FLIGHT_APPROACH = 1, /* the aircraft is landing: the layer prefers a go-around over known tops */
    GOE_FLIGHT_FLARE = 2,    /* no order is given, and an active one ends */
    GOE_FLIGHT_LANDED = 3    /* the aircraft has touched down: no order, as in the flare. Obstacles beyond the runway
                                are not on its course */
};

/* The result of goe_flight_assess(). The worst obstacle has the largest conflict_probability / (1 + 0.1 tcpa_s). */
typedef struct {
    goe_flight_action_t action;
    bool late;             /* the action needs more time than is left: it may not suffice */
    bool suspect;          /* the worst obstacle's estimate is suspect: margins were widened */
    bool detector_alive;   /* every camera sent a readable frame within detector_timeout_s: an empty one, or one with a
                              valid detection. Once false, it stays false until the next such frame */
    bool pose_agrees;      /* in the latest 10 s no position contradicted the velocities: none was off by more than 4 m
                              (down 3 m) plus 30 % of the way of a second, or 10 % of the way of 10 s. If false, a convention is wrong (axes, sign,
                              unit, time), or the position jumped: nothing is clear, and hazards may be missing. The
                              layer corrects nothing */
    bool pose_alive;       /* pose_agrees, and samples of attitude and position came within 0.5 s */
    int8_t worst;          /* slot, for goe_flight_obstacle(); -1: no known hazard. That is "clear" only if detector and
                              pose are alive and unplaced is 0 */
    int8_t avoided;        /* slot of the obstacle that the action avoids; -1: none, or its track has ended */
    uint8_t obstacles;     /* number of obstacles with a position */
    uint8_t unplaced;      /* at least so many detected obstacles have no position, or one that does not follow their
                              detections (it is outside the box, or older than 0.15 s); also those that wait for
                              confirmation or for a slot; 0: none. No order avoids what these detections show */
    float needed_s;        /* time that the action needs; without an action, time that the best action would need; 0
                              without a worst obstacle */
    float target_ned_m[3]; /* 0 if GOE_FLIGHT_NONE. The height of CLIMB and GO_AROUND clears the highest known top on
                              the course by clearance_m at two sigma; it rises with the estimate and never sinks while
                              the order is active */
    goe_flight_reason_t reason;
    float clear_m;         /* LEFT, RIGHT, HOLD: the clear fraction of the order's path (README.md), times margin_m, or times 1 m if that
                              is larger. That is its least distance from any known outline, minus two sigmas of that obstacle's position in the
                              assessment that chooses the path, and minus one sigma in later ones. If that obstacle is suspect,
                              the distance is larger by suspect_factor. At most 2 margin_m and 1000; negative: the path leads
                              into an obstacle. Otherwise 0 */
    int32_t target_lat_e7, target_lon_e7; /* 0 if the origin is not known */
    goe_hazard_t hazard;   /* hazard of the worst obstacle from now on; all zero if there is none */
} goe_flight_assessment_t;

/* One obstacle. An unknown value is 0 and has no bit in valid. */
typedef struct {
    uint32_t id;
    unsigned valid;          /* GOE_HAS_POSITION, _HEIGHT, _WIDTH, _LENGTH, _ORIENTATION */
    goe_model_t model;
    bool suspect, receding;  /* receding: on the present course its distance grows */
    bool in_view;            /* detected in the latest image of the camera that detected it last */
    bool has_hazard;         /* the obstacle has been assessed with a position, so hazard is valid */
    float age_s;             /* time from its last measurement to the latest assessment */
    float center_ned_m[3];   /* middle of the visible base; its down is the obstacle's ground */
    float covariance_ne_m2[3]; /* covariance of the center: north north, north east, east east */
    float radius_m;          /* radius of the circle around the center that contains the outline */
    float height_m, height_sd_m; /* height of the top above the ground, and its sigma */
    float width_m, length_m;
    float length_heading_deg; /* of the length axis, clockwise from north, 0 to 180 */
    float nearest_ned_m[3];  /* nearest point of the circle, at the height of the aircraft or of the top, whichever is lower */
    float nearest_body_m[3]; /* the nearest point relative to the aircraft, body axes */
    int32_t lat_e7, lon_e7;  /* center; 0 if the origin is not known */
    goe_hazard_t hazard;     /* from the time of the latest goe_flight_assess() on */
} goe_flight_obstacle_t;

#define GOE_FLIGHT_SECTOR_UNKNOWN 65535u /* not known to be clear: not in view, no pose, or an obstacle may be there */

/* Counted since goe_flight_init(); they saturate. */
typedef struct {
    uint16_t taken;   /* accepted frames */
    uint16_t late;    /* frames that came too late for the history */
    uint16_t early;   /* calls that returned GOE_FLIGHT_TOO_NEW */
    uint16_t refused; /* samples, frames, detections or kinds that were not finite or out of range */
    uint16_t weak;    /* detections below score_min */
    uint16_t renumbered; /* tracks that took over a new id */
    uint16_t evicted; /* tracks that ended because a new obstacle took their slot */
    uint16_t full;    /* confirmed detections that found no slot */
    uint16_t resets;  /* known jumps */
    uint16_t lost;    /* unknown resets and restarts: all tracks ended */
} goe_flight_counters_t;

/* ----------------------------------------------------------------------------------------------------------- state -- */

/* These types are visible so that the caller can allocate them. Only counters and capture_us are public. Each comment
 * names the file that maintains the type. */

typedef struct { /* goe_history.c */
    uint32_t time_us;
    float q[4];
} goe_flight_history_attitude_t;

typedef struct { /* goe_history.c */
    uint32_t time_us;
    float ned_m[3];
} goe_flight_history_position_t;

typedef struct { /* goe_history.c */
    goe_flight_history_attitude_t attitude[GOE_FLIGHT_SAMPLES];
    goe_flight_history_position_t position[GOE_FLIGHT_SAMPLES];
    uint8_t attitude_next, attitude_count, position_next, position_count;
    uint8_t attitude_stale, position_stale; /* samples of a kind in a row that were not newer */
} goe_flight_history_t;

typedef struct { /* goe_marks.c: the autopilot's reset counters */
    uint32_t attitude, horizontal, vertical;
    goe_flag_t attitude_known, position_known; /* a first mark has come */
    float jumps_ned_m[3];                /* sum of all known jumps, limited to 1e6 */
} goe_flight_marks_t;

typedef struct { /* goe_travel.c: a way by the velocities, its length, and where it began by the positions */
    uint32_t begun_us;
    float begun_ned_m[3], by_velocity_m[3], across_m, down_m;
} goe_flight_way_t;

#define GOE_FLIGHT_TRAVELS 2

typedef struct { /* goe_travel.c */
    goe_flight_way_t way[GOE_FLIGHT_TRAVELS]; /* of one second, and of ten */
    uint32_t newest_us, doubted_us;
    float velocity_ned_m_s[3];
    goe_flag_t begun, doubted;
} goe_flight_travel_t;

typedef struct { /* goe_clock.c: sender's clock to autopilot's */
    uint32_t offset_us;    /* autopilot's minus sender's, by goe_flight_timesync(); or the least in this interval */
    uint32_t before_us;    /* the least in the previous interval */
    uint32_t bucket_us;    /* start of this interval */
    uint32_t strange_us, strange_offset_us; /* time and offset of the first strange arrival */
    float excess_us;       /* running mean of the delays above the least */
    float synced_sd_us;
    uint8_t count, strange; /* of this filter; arrivals in a row that are late by more than a second, all by a similar time */
    goe_flag_t has_before, synced;
} goe_flight_clock_t;

typedef struct { /* goe_geometry.c: the bearings of a detection, at its exposure, degrees */
    int16_t middle_deg, half_deg; /* half_deg 180: any */
} goe_flight_bearings_t;

typedef struct { /* goe_candidate.c */
    uint32_t id, time_us;
    int16_t box_px[4];
    uint8_t camera;
    uint8_t images; /* 0: free; otherwise one more than the images that count */
    goe_flight_bearings_t bearings;
} goe_flight_candidate_t;

typedef struct { /* goe_candidate.c */
    goe_flight_candidate_t place[GOE_FLIGHT_CANDIDATES];
    uint32_t crowded_us;
    goe_flag_t crowded; /* a detection had no place, or no known one, last at crowded_us */
} goe_flight_waiting_t;

typedef struct { /* goe_parts.c: the images of a camera */
    uint32_t begun_us; /* exposure of the image whose detections come */
    uint32_t taken;    /* slots that it has updated, as bits */
    uint8_t given;     /* its detections so far */
    goe_flag_t viewed; /* an image was complete, and is not older than detector_timeout_s: */
    uint32_t viewed_us; /* newest sample when it was; */
    float q[4], above_m; /* attitude, and height above the ground, at its exposure */
} goe_flight_parts_t;

typedef struct { /* goe_slot.c */
    goe_estimator_t estimator;
    goe_hazard_t hazard; /* from the latest assessment; goe_lookout.c */
    uint32_t id;
    uint32_t taken_us, detected_us; /* exposure of the latest accepted image, and of the latest detection */
    float jumps_ned_m[3];       /* sum of all known jumps at the latest accepted image */
    float ground_down_m, height_sd_m; /* of the track, fixed at its first image */
    float center_ne_m[2], covariance_ne_m2[3];
    float top_m, top_sd_m, width_m, length_m, length_heading_deg;
    float age_s; /* at taken_us */
    int16_t box_px[4];
    goe_flight_bearings_t bearings; /* of the latest detection */
    uint8_t valid, model, reset_count;
    uint8_t camera; /* that detected it last */
    goe_flag_t used, fresh_track, suspect, in_view, assessed;
    goe_flag_t remembered; /* position and hazard are from before the estimator was lost */
    goe_flag_t unlocated;  /* its latest detections did not change its position */
} goe_flight_slot_t;

typedef struct { /* goe_reaction.c: the active order */
    float from_ned_m[3], course_ne[2]; /* position and course when it was given: the line to return to */
    uint32_t rising_us, falling_us;   /* when the hazard began, and when it was over */
    float target_ned_m[3];
    float along_ne[2];  /* the course when the target was chosen */
    float clear_m;      /* as reported */
    uint32_t ordered_us;
    uint8_t action;
    int8_t slot; /* its obstacle; -1: none, or its track has ended */
    int8_t edge; /* the slot whose outline determines the target; -1: none */
    int8_t side; /* -1: left, 1: right, also of HOLD; 0: none */
    uint8_t changes; /* of the side */
    uint8_t reason;
    goe_flag_t rising, falling, late; /* falling, without an order: it has just ended */
    goe_flag_t gap; /* the target is in the middle between slot and edge */
} goe_flight_reaction_t;

typedef struct { /* goe_flight.c */
    float offset_m[3];        /* of the camera, body */
    float body_from_camera[9];
    float focal_px[2], center_px[2], size_px[2], border_px; /* focal length 0: there is no camera of this number */
    float lens[5]; /* k1, k2, p1, p2, k3 */
} goe_flight_camera_t;

typedef struct {
    uint32_t tag; /* set by goe_flight_init() */
    goe_seal_t seal; /* of the next three */
    goe_flight_settings_t settings;
    goe_flight_camera_t camera[GOE_CAMERAS_MAX];
    float attitude_white_sd_deg; /* setting of the estimator */
    goe_flight_history_t history;
    goe_flight_marks_t marks;
    goe_flight_travel_t travel;
    goe_flight_clock_t clock[GOE_CAMERAS_MAX]; /* of the sender of each camera's frames */
    goe_flight_reaction_t reaction;
    goe_flight_counters_t counters; /* public */
    uint32_t assessed_us;
    int64_t base_us;                /* the newest sample's time, never wrapping */
    uint32_t frame_us[GOE_CAMERAS_MAX]; /* base_us at the latest accepted frame of each camera */
    uint32_t capture_us; /* exposure of the latest accepted frame, autopilot's clock; public */
    float velocity_ned_m_s[3];
    float ground_down_m; /* ground by the best source of the newest sample */
    uint8_t ground_source; /* that source: GOE_FLIGHT_RANGE_FINDER, ... */
    uint8_t had_frame; /* bit i: camera i has had a frame */
    goe_flag_t origin_known;
    int32_t origin_lat_e7, origin_lon_e7;
    goe_flight_waiting_t waiting;
    goe_flight_parts_t parts[GOE_CAMERAS_MAX];
    goe_flight_slot_t slot[GOE_FLIGHT_SLOTS];
} goe_flight_t;

/* ------------------------------------------------------------------------------------------------------- functions -- */

/* Sets every field to its default. A null pointer is ignored. */
void goe_flight_settings_default(goe_flight_settings_t *settings);

/* Checks the settings of estimator and layer, copies them, and clears all state.
 *   flight_size  sizeof(goe_flight_t) in the caller's compilation
 *   estimator    as for goe_init; width_px and height_px of every camera must be set too. The layer replaces
 *                navigation.height_bias_sd_m by the sigma of the height's source, one of its settings. This sigma
 *                includes noise: a track takes one height, and after that only the changes of down. height_white_sd_m may thus
 *                be 0; its default widens the first estimates a little
 *   settings     null: the defaults
 *   bad_field    receives the name of the first bad setting; null if not wanted
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT or _BAD_SETTINGS; on failure *flight cannot be used. */
GOE_NODISCARD goe_flight_status_t goe_flight_init(goe_flight_t *flight, size_t flight_size, const goe_settings_t *estimator,
                                                  const goe_flight_settings_t *settings, const char **bad_field);

/* Changes the layer's settings in flight. Poses, clocks, obstacles, an active order and the settings of the estimators stay; the next
 * assessment uses the new settings.
 *   settings   null: the defaults
 *   bad_field  as for goe_flight_init
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT, _BAD_SETTINGS, _NOT_INITIALIZED, or _CORRUPTED: then call goe_flight_init(). On failure the
 * settings do not change. */
GOE_NODISCARD goe_flight_status_t goe_flight_change_settings(goe_flight_t *flight, const goe_flight_settings_t *settings,
                                                             const char **bad_field);

/* Take a sample of the pose. The history keeps samples at least 20 ms apart.
 * Return GOE_FLIGHT_OK, _BAD_TIME, _NOT_FINITE, _OUT_OF_RANGE, _BAD_ATTITUDE, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample);
goe_flight_status_t goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample);

/* Interpolates the pose at a time: the position linearly between the two nearest samples, the attitude by the cubic through them
 * and their neighbors, if these exist. height_m is that of camera 0, by the best source at present. pose->time_us uses the
 * autopilot's clock, too, but does not wrap.
 *   attitude_sd_deg  one sigma of the attitude if the time has one sigma of time_sd_us; null if not wanted
 * Returns GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED; all zero unless _OK. */
goe_flight_status_t goe_flight_pose(const goe_flight_t *flight, uint32_t time_us, uint32_t time_sd_us, goe_pose_t *pose,
                                    float *attitude_sd_deg);

/* Sets the offset of the sender's clock from a two-way exchange: autopilot's minus sender's time (modulo 2^32), and its one sigma.
 * It replaces the one-way estimate until a call with sd_us 0xFFFFFFFF, which means unknown. It applies to all cameras with
 * GOE_FLIGHT_SENDER_CLOCK: call it only if their senders have one clock.
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_timesync(goe_flight_t *flight, uint32_t offset_us, uint32_t sd_us);

/* Takes the detections of an image:
 *   - A detection that is not finite or out of range is ignored and counted; of a bad kind, the kind alone.
 *   - A detection with a known id updates the slot with that id.
 *   - A detection with a new id takes over the track whose predicted position fits its box best, if no other detection of the call
 *     fits better. If another camera detected the track last, the box must also be about as wide as the track's outline, at most three
 *     times wider or narrower. That track has no detection in this image so far. Before the image's last call it had none in the image
 *     before, either: a later call may contain its own id.
 *   - Any other detection waits until it is confirmed.
 * Calls whose exposures are at most 5 ms apart are one image. After its last detection, the other tracks of its camera are
 * updated as undetected. An obstacle visible to two cameras at once may have two slots until both have its position.
 * Returns GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD, _NO_POSE, _OUT_OF_RANGE (time base, camera, count), _BAD_ARGUMENT, _NOT_INITIALIZED,
 * _CORRUPTED. */
goe_flight_status_t goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame);

/* Finds the hazards ahead from now on, at the velocity of the newest sample, and the reaction; README.md has the rule as a table.
 *   now_us    time by the autopilot's clock; a time before the newest sample is replaced by that sample's time
 *   phase     GOE_FLIGHT_FLYING, _APPROACH, _FLARE or _LANDED
 *   result    every call writes it, unless null. On failure it is all zero (worst, avoided -1), which does not mean "clear"
 * Returns GOE_FLIGHT_OK, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED, _CORRUPTED. */
goe_flight_status_t goe_flight_assess(goe_flight_t *flight, uint32_t now_us, uint8_t phase,
                                      goe_flight_assessment_t *result);

/* Reads one obstacle, slot 0 to GOE_FLIGHT_SLOTS - 1, as of the latest image, with the hazard of the latest assessment.
 * Returns GOE_FLIGHT_OK, _NOTHING, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED, _CORRUPTED (a flipped bit made one of its numbers
 * infinite). *obstacle is all zero unless _OK. */
goe_flight_status_t goe_flight_obstacle(const goe_flight_t *flight, int slot, goe_flight_obstacle_t *obstacle);

/* Finds the distance of the nearest obstacle in each sector; sector i is centered on the bearing 5 i degrees. Values in cm:
 *   - at most max_cm: the distance of an obstacle with a position; while unplaced is not 0 there may be a nearer one
 *   - max_cm + 1: nothing was detected in the sector up to max_cm. No estimated outline is nearer, also if it is moved nearer by two
 *     sigmas of its position; no obstacle there is suspect; [F6] no obstacle without a width, none that unplaced counts, and no box
 *     of one that may be within max_cm was detected there. The latest complete image of a live camera shows the flat ground at
 *     max_cm there, at the attitude of its exposure; so it also shows any nearer obstacle that is as high as the aircraft
 *   - GOE_FLIGHT_SECTOR_UNKNOWN: all other sectors
 * Time is that of the latest assessment or of the newest sample, whichever is later.
 * Obstacles whose top the aircraft clears by more than the clearance, at two sigma, at present and at the closest approach, are
 * ignored. For PX4's obstacle_distance use increment 5 and the frame GLOBAL.
 *   max_cm  1 to 65000
 * Returns GOE_FLIGHT_OK, _NO_POSE or _CORRUPTED (all unknown), _OUT_OF_RANGE, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_sectors(const goe_flight_t *flight, uint32_t max_cm, uint16_t sector_cm[GOE_FLIGHT_SECTORS]);

/* Deletes poses, clocks, obstacles and the reaction; keeps settings and counters. Call it after a restart of the autopilot.
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT or _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_restart(goe_flight_t *flight);

/* A short lower-case name for an action ("none", "left", ...), never null; "unknown" for any other number. */
const char *goe_flight_action_text(goe_flight_action_t action);

/* A short lower-case name for a reason ("none", "clear", "least_bad", "low", "slow", "landing"), like goe_flight_action_text(). */
const char *goe_flight_reason_text(goe_flight_reason_t reason);

#ifdef __cplusplus
}
#endif

#endif /* GOE_FLIGHT_H */
