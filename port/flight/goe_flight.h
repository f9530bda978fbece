/*
 * goe_flight - the layer between a detector, an autopilot and the estimator
 *
 * In: attitude and position as the autopilot publishes them, detections as a detector sends them, late and with clocks of their
 * own. Out: which obstacles there are, where, what hazard they are from now on, and what to do about the worst one.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * THIS HEADER IS THE MANUAL. It rests on goe.h alone; README.md has a drawing of the flow and what it costs.
 *
 *   autopilot   goe_flight_attitude(), goe_flight_position()   each sample, as it comes
 *   detector    goe_flight_frame()                             each image, also when nothing is in view
 *   reaction    goe_flight_assess()                            at any rate, 5 to 50 Hz; then goe_flight_obstacle(), _sectors()
 *
 * ---------------------------------------------------------------------------------------------------------------------
 * Frames      as goe.h: earth = local north, east, down (NED), m; body = forward, right, down; attitude = Hamilton quaternion
 *             (w, x, y, z), body to NED.
 * Time        uint32_t microseconds of the autopilot's clock. It may wrap: only differences count, and no two times that are
 *             compared lie more than half an hour apart.
 * Memory      goe_flight_t is owned by the caller, fixed in size, and all there is: no heap, no hidden statics, no recursion.
 * Threads     Every function touches only what its arguments point at; one goe_flight_t needs the caller's lock.
 * Arithmetic  float only; of the C library sqrtf, memcpy and memset. Compiled with -ffp-contract=off the results have the same
 *             bits on every IEEE 754 target.
 * Safety      Every output is finite. Values that are not finite are refused by their exponent bits, also under -ffast-math.
 * Bit flips   A flipped bit in goe_flight_t leads to no write out of bounds. Settings, cameras among them, are sealed: a frame and an
 *             assessment return GOE_FLIGHT_CORRUPTED. An estimator that returns GOE_CORRUPTED begins again, with the settings
 *             of another slot if its own are lost; until it knows a position again the slot keeps position and hazard, suspect, and
 *             its warning. The rest (poses, clocks, positions, the active order) is not sealed.
 * Cost        On a Cortex-M4F (gcc), in instructions: a sample at most 1,250, a frame 44,700 for each obstacle in it, an assessment
 *             28,700 with one obstacle, 23,200 for each further one with a position and, while a hazard is answered, the ways that
 *             are looked at: at most 3 times 4 + 4 GOE_FLIGHT_SLOTS of them, each against every obstacle; goe_flight_obstacle() 980,
 *             goe_flight_sectors() 6,600, goe_flight_init() 12,400 for each slot. No loop runs longer than GOE_FLIGHT_SECTORS.
 * Failure     A call that returns a negative status, or GOE_FLIGHT_TOO_NEW, changed nothing but counters.
 */
#ifndef GOE_FLIGHT_H
#define GOE_FLIGHT_H

#include "goe.h"

#if !GOE_WITH_HAZARD
#error "the flight layer needs GOE_WITH_HAZARD"
#endif

/* ------------------------------------------------------------------------------------------------- compile-time limits -- */

/* As those of goe.h they may come from GOE_CONFIG_HEADER. */
#ifndef GOE_FLIGHT_SLOTS
#define GOE_FLIGHT_SLOTS 4 /* obstacles that are followed at a time, 1 to 16; each costs an estimator and 128 bytes */
#endif
#if GOE_FLIGHT_SLOTS < 1 || GOE_FLIGHT_SLOTS > 16
#error "GOE_FLIGHT_SLOTS must be 1 to 16"
#endif

#define GOE_FLIGHT_SAMPLES 32    /* of each ring of the pose's history: 0.6 s or more */
#define GOE_FLIGHT_CANDIDATES 6  /* detections that wait for their confirmation */
#define GOE_FLIGHT_DETECTIONS 32 /* most that goe_flight_frame() takes at once */
#define GOE_FLIGHT_SECTORS 72    /* of goe_flight_sectors(), 5 degrees each, the first centered on north */

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------- status -- */

typedef enum {
    GOE_FLIGHT_OK = 0,
    GOE_FLIGHT_TOO_NEW = 1, /* no pose so new yet: keep the frame and ask again after the next sample; nothing was taken */
    GOE_FLIGHT_TOO_OLD = -1,   /* older than the history or settings.delay_max_s, or in a gap of the samples: drop the frame */
    GOE_FLIGHT_NO_POSE = -2,   /* no sample of attitude or position since the start or the latest unknown reset */
    GOE_FLIGHT_BAD_TIME = -3,  /* a sample that is not newer than the one before it. After 16 of them in a row the clock is
                                  taken to have been set back: goe_flight_restart() is done */
    GOE_FLIGHT_NOT_FINITE = -4,
    GOE_FLIGHT_OUT_OF_RANGE = -5, /* a number outside the range stated at its field */
    GOE_FLIGHT_BAD_ATTITUDE = -6, /* the quaternion's norm is off 1 by more than 1 % */
    GOE_FLIGHT_NOTHING = -7,      /* no such obstacle */
    GOE_FLIGHT_BAD_SETTINGS = -32,
    GOE_FLIGHT_BAD_ARGUMENT = -33, /* a null pointer, or a goe_flight_t of another size */
    GOE_FLIGHT_NOT_INITIALIZED = -34,
    GOE_FLIGHT_CORRUPTED = -35 /* settings, here or of all estimators, are not what goe_flight_init() left: call it again. Until then
                                  nothing is known, which is not "clear" */
} goe_flight_status_t;

/* -------------------------------------------------------------------------------------------------------- settings -- */

/* How the autopilot reports the resets of its filter. */
enum {
    GOE_FLIGHT_RESETS_COUNT = 0, /* marks are 8 bit counters: one up is a reset with the delta given, more an unknown one. PX4 */
    GOE_FLIGHT_RESETS_TIME = 1   /* marks are times of the latest reset: any change is one reset. ArduPilot */
};

/* Where the height above the ground comes from. Chosen once per track, in this order; see goe_flight_position_t. */
enum { GOE_FLIGHT_RANGE_FINDER, GOE_FLIGHT_TERRAIN, GOE_FLIGHT_HOME, GOE_FLIGHT_HEIGHTS };

/* Field: meaning; range; default. goe_flight_settings_list.h has the same as one table. */
typedef struct {
    /* detector */
    float score_min;      /* a detection of less is not looked at; 0 to 1; 0.3 */
    float confirm_images; /* images, at most 1 s apart, with a detection of a new obstacle before it gets a slot; 1 to 20; 3 */
    float detector_timeout_s; /* without a frame for this long the detector counts as dead; 0.05 to 60; 1 */
    float track_timeout_s; /* an obstacle undetected for this long is given up, unless it is ahead on the course or an order
                             is about it; 1 to 600; 10 */
    /* time */
    float delay_s;     /* least time from sending to arrival, which no one-way clock can see; 0 to 0.5; 0.005 */
    float delay_sd_s;  /* its one-sigma, and that of any capture time whose sender gives none; 0 to 0.5; 0.005 */
    float delay_max_s; /* a frame that comes later after its exposure is refused; 0.02 to 0.5; 0.4 */
    float resets;      /* GOE_FLIGHT_RESETS_...; 0 or 1; 0 */
    /* height: one sigma, and the highest that the range finder is believed at */
    float range_finder_sd_m;  /* 0.001 to 100; 0.3 */
    float range_finder_max_m; /* 0 to 1000; 40 */
    float terrain_sd_m;       /* 0.001 to 1000; 3 */
    float home_sd_m;          /* 0.001 to 1000; 5 */
    /* wanted distances */
    float margin_m;      /* to the outline, horizontally; 0 to 1000; 15 */
    float clearance_m;   /* over the top; 0 to 1000; 10 */
    float conflict_probability_max; /* probability of violating both from which on there is a reaction; 0.001 to 1; 0.1 */
    float suspect_factor; /* factor on margin and clearance while the estimate is suspect; 1 to 10; 1.5 */
    float stale_growth_m_s; /* by which both grow while the estimate is not renewed; 0 to 100; 1 */
    /* what the aircraft can do */
    float bank_deg;    /* of an avoiding turn; 5 to 70; 30 */
    float roll_in_s;   /* from the order to that turn, link and mode change included; 0 to 20; 1.5 */
    float climb_m_s;   /* of an avoiding climb; 0.1 to 50; 2.5 */
    float climb_in_s;  /* from the order to that climb; 0 to 20; 2 */
    float loiter_m;    /* radius of the circle that the autopilot flies about a reposition point; 0: it flies through; 0 to
                          1e4; 0 */
    float reserve_s;   /* an order comes this much before its last moment; 0 to 60; 3 */
    float confirm_s;   /* the hazard must stay for this long before an order, unless none is left; 0 to 10; 0.3 */
    float hold_s;      /* ... and its end before the order is taken back; 0 to 60; 2 */
    /* where no order is given; hazards are reported all the same. A height below the ground by twice home_sd_m, as in a valley,
       withholds nothing */
    float order_height_m;  /* no new order below this height above the ground; 0: at any; 0 to 1000; 5 */
    float order_speed_m_s; /* ... nor below this speed over the ground; 0 to 100; 5 */
} goe_flight_settings_t;

/* ----------------------------------------------------------------------------------------------------------- input -- */

typedef struct {
    uint32_t time_us; /* of the sample itself (PX4: timestamp_sample), not of its arrival; increasing */
    float q[4];       /* w, x, y, z; norm 1 within 1 % */
    uint32_t reset;   /* mark: changes with every reset of attitude or heading. Any such reset ends all tracks, as an unknown
                         reset of the position does: obstacles are kept, suspect, until an image places them again */
} goe_flight_attitude_t;

typedef struct {
    uint32_t time_us;
    float position_ned_m[3];   /* vehicle's reference point, each +-1e6 */
    float velocity_ned_m_s[3]; /* over the ground, each +-1e3 */
    float height_m[GOE_FLIGHT_HEIGHTS]; /* of the reference point above the ground, vertical; read if valid; +-1e5 */
    uint8_t height_valid;               /* bit 1 << GOE_FLIGHT_RANGE_FINDER, ...: which of them hold. The ground of a track is
                                           that of its first image: later a range finder would read roofs. With none the
                                           origin's down = 0 is the ground, as good as home */
    bool origin_known;                  /* the origin of NED, for latitude and longitude */
    int32_t origin_lat_e7, origin_lon_e7; /* degrees times 1e7; +-89e7, +-180e7 */
    uint32_t reset_horizontal, reset_vertical; /* marks of resets, see goe_flight_settings_t.resets */
    bool reset_delta_known;             /* else any reset is an unknown one: ends all tracks, empties the history. The kept
                                           obstacles moves along as far as the velocity shows the jump */
    float reset_delta_ned_m[3];         /* new minus old of the latest reset of each; read when a mark changed. Down: the
                                           ground of every track moves along, whether height_m jumped or not, so that no height
                                           above ground changes. A track that begins later has the ground of its own sample */
} goe_flight_position_t;

/* Clock of goe_flight_frame_t.capture_us. */
enum {
    GOE_FLIGHT_AUTOPILOT_CLOCK = 0, /* the autopilot's: nothing to estimate */
    GOE_FLIGHT_SENDER_CLOCK = 1, /* the sender's: offset from goe_flight_timesync() or, one-way, the least of arrival - sending
                                    over 10 to 20 s, less delay_s */
    GOE_FLIGHT_AGE = 2           /* age of the image at sending: capture = arrival - delay_s - age */
};

/* One obstacle in one image. A box, or points, or both, as in goe_image_t. */
typedef struct {
    uint32_t id;   /* of the detector's tracker, of each camera's own; 0: it has none, and the place in the image decides */
    float score;   /* 0 to 1 */
    float pixel_px; /* one sigma of box and points; 0: as in the settings; 0 to 100 */
    goe_box_t box; /* raw pixels; give all four sides, also at the border of the image: the estimator detects truncation */
    goe_pixel_t left, right, top, base_left, base_near, base_right; /* left, right, top within the image's border count as
                                                                       invisible, and with a side the top */
} goe_flight_detection_t;

typedef struct {
    uint32_t arrival_us; /* autopilot's clock */
    uint32_t capture_us; /* middle of the exposure, by the clock of time_base; or the age */
    uint32_t sent_us;    /* GOE_FLIGHT_SENDER_CLOCK: when it was sent; = capture_us if not known: then delay_s is from the
                            exposure on */
    uint32_t time_sd_us; /* one sigma of capture_us as the sender knows it; 0: settings.delay_sd_s */
    uint8_t time_base;
    uint8_t camera; /* number of the camera that took it; one that is set, below GOE_CAMERAS_MAX */
    uint8_t number; /* of detections in the image. 0: nothing in view, which shows that the detector is alive */
    uint8_t count;  /* of those here, 0 to GOE_FLIGHT_DETECTIONS. Less than number: the others come in further calls with the
                       same capture time */
    const goe_flight_detection_t *detection;
} goe_flight_frame_t;

/* ---------------------------------------------------------------------------------------------------------- output -- */

typedef enum {
    GOE_FLIGHT_NONE = 0,
    GOE_FLIGHT_LEFT = 1,      /* fly to target_ned_m, to the left of the obstacle, looking along the course */
    GOE_FLIGHT_RIGHT = 2,     /* ... right of it */
    GOE_FLIGHT_CLIMB = 3,     /* straight on, up to target_ned_m: the top is surely below that by then */
    GOE_FLIGHT_GO_AROUND = 4, /* break off the approach */
    GOE_FLIGHT_HOLD = 5       /* neither side nor top can be passed in time: turn away, to target_ned_m before the obstacle, and
                                 loiter */
} goe_flight_action_t;

/* Why it is this action. */
typedef enum {
    GOE_FLIGHT_REASON_NONE = 0,  /* no order, and none is withheld */
    GOE_FLIGHT_REASON_CLEAR = 1, /* the order keeps clear of everything known */
    GOE_FLIGHT_REASON_LEAST_BAD = 2, /* nothing is free: the order has the largest clearance that was found */
    /* an order is due and withheld, because the aircraft ... */
    GOE_FLIGHT_REASON_LOW = 3,   /* is lower than order_height_m */
    GOE_FLIGHT_REASON_SLOW = 4,  /* is slower than order_speed_m_s */
    GOE_FLIGHT_REASON_LANDING = 5 /* flares, or has touched down */
} goe_flight_reason_t;

/* What the aircraft does, for goe_flight_assess(). Any other number counts as GOE_FLIGHT_FLYING. */
enum {
    GOE_FLIGHT_FLYING = 0,
    GOE_FLIGHT_APPROACH = 1, /* it is landing: to go around comes first */
    GOE_FLIGHT_FLARE = 2,    /* no order is given, and an active one ends */
    GOE_FLIGHT_LANDED = 3    /* it has touched down: the same. Obstacles behind the runway are not on its course */
};

/* What goe_flight_assess() finds. The worst obstacle is that of the largest conflict_probability / (1 + 0.1 tcpa_s). */
typedef struct {
    goe_flight_action_t action;
    bool late;             /* the action needs longer than there is: it may not suffice */
    bool suspect;          /* the worst obstacle's estimate is: margins were widened */
    bool detector_alive;   /* within detector_timeout_s, of every camera, a frame came that can be read: without detections, or with one of good
                              numbers. Once false, false until the next such frame */
    bool pose_alive;       /* samples of attitude and position came within 0.5 s */
    int8_t worst;          /* slot, for goe_flight_obstacle(); -1: no hazard is known, which is "clear" only if both are alive */
    int8_t avoided;        /* slot of the obstacle that the action is about; -1: none, or it was given up */
    uint8_t obstacles;     /* with a position */
    float needed_s;        /* time that the action needs, or the best one would, if there is a worst obstacle */
    float target_ned_m[3]; /* 0 if GOE_FLIGHT_NONE. The height of CLIMB and GO_AROUND clears the highest top that is known on the
                              course by clearance_m at two sigma; it rises with the estimate and never sinks while the order is active */
    goe_flight_reason_t reason;
    float clear_m;         /* of LEFT, RIGHT and HOLD: the least distance that the ways in which the order may be flown keep from any
                              known outline, two sigmas of its place taken off; at most 1000. Else 0 */
    int32_t target_lat_e7, target_lon_e7; /* 0 if the origin is not known */
    goe_hazard_t hazard;   /* of the worst obstacle, from now; all zero if there is none */
} goe_flight_assessment_t;

/* One obstacle. An unknown value is 0 and not in valid. */
typedef struct {
    uint32_t id;
    unsigned valid;          /* GOE_HAS_POSITION, _HEIGHT, _WIDTH, _LENGTH, _ORIENTATION */
    goe_model_t model;
    bool suspect, receding;  /* receding: on the present course its distance grows */
    bool in_view;            /* detected in the latest image of the camera that detected it last */
    bool has_hazard;         /* hazard is known: assessed with a position */
    float age_s;             /* since it was last measured, from the latest assessment */
    float center_ned_m[3];   /* middle of the visible base; down: of its ground */
    float covariance_ne_m2[3]; /* of the center: north north, north east, east east */
    float radius_m;          /* of the circle about the center that contains the outline */
    float height_m, height_sd_m; /* of the top above the ground */
    float width_m, length_m;
    float length_heading_deg; /* of the length axis, clockwise from north, 0 to 180 */
    float nearest_ned_m[3];  /* of the circle from the aircraft, at the aircraft's height or the top, whichever is lower */
    float nearest_body_m[3]; /* the same relative to the aircraft, body axes */
    int32_t lat_e7, lon_e7;  /* center; 0 if the origin is not known */
    goe_hazard_t hazard;     /* from the latest goe_flight_assess() on */
} goe_flight_obstacle_t;

#define GOE_FLIGHT_SECTOR_UNKNOWN 65535u /* outside the view of every camera whose detector is alive, or the pose dead */

/* Counted since goe_flight_init(); they saturate. */
typedef struct {
    uint16_t taken;   /* frames */
    uint16_t late;    /* frames that came too late for the history */
    uint16_t early;   /* calls that were answered by GOE_FLIGHT_TOO_NEW */
    uint16_t refused; /* samples, frames or detections that were not finite or out of range */
    uint16_t weak;    /* detections below score_min */
    uint16_t renumbered; /* tracks that took over a new id */
    uint16_t evicted; /* tracks given up for a new obstacle */
    uint16_t full;    /* confirmed detections that found no slot */
    uint16_t resets;  /* known jumps */
    uint16_t lost;    /* unknown resets and restarts: all tracks ended */
} goe_flight_counters_t;

/* ----------------------------------------------------------------------------------------------------------- state -- */

/* Transparent, for the caller to place and count; private but for counters and capture_us. Each type names the file that maintains it. */

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
    uint8_t stale; /* samples in a row that were not newer */
} goe_flight_history_t;

typedef struct { /* goe_marks.c: the autopilot's reset counters */
    uint32_t attitude, horizontal, vertical;
    goe_flag_t attitude_known, position_known; /* a first mark has come */
    float jumps_ned_m[3];                /* sum of all known ones, modulo nothing: bounded to 1e6 */
} goe_flight_marks_t;

typedef struct { /* goe_clock.c: sender's clock to autopilot's */
    uint32_t offset_us;    /* autopilot's minus sender's: by goe_flight_timesync(); or the least of this bucket ... */
    uint32_t before_us;    /* ... and of the one before it */
    uint32_t bucket_us;    /* when this bucket began */
    float excess_us;       /* running mean of how far arrivals lie above the least */
    float synced_sd_us;
    uint8_t count, strange; /* of this filter; arrivals in a row that are off by more than a second */
    goe_flag_t has_before, synced;
} goe_flight_clock_t;

typedef struct { /* goe_candidate.c */
    uint32_t id, time_us;
    int16_t box_px[4];
    uint8_t camera;
    uint8_t images; /* 0: free */
} goe_flight_candidate_t;

typedef struct { /* goe_slot.c */
    goe_estimator_t estimator;
    goe_hazard_t hazard; /* from the latest assessment; goe_lookout.c */
    uint32_t id;
    uint32_t taken_us, detected_us; /* exposure of the latest image taken, and of that with a detection */
    float jumps_ned_m[3];       /* the history's sum at the latest image taken */
    float ground_down_m, height_sd_m; /* of the track, fixed at its first image */
    float center_ne_m[2], covariance_ne_m2[3];
    float top_m, top_sd_m, width_m, length_m, length_heading_deg;
    float age_s; /* at taken_us */
    int16_t box_px[4];
    uint8_t valid, model, reset_count;
    uint8_t camera; /* that saw it last */
    goe_flag_t used, fresh_track, suspect, in_view, assessed;
    goe_flag_t remembered; /* place and hazard are from before the estimator was lost */
} goe_flight_slot_t;

typedef struct { /* goe_reaction.c: the active order */
    float from_ne_m[2], course_ne[2]; /* where it was given, and the course then: the line to go back to */
    uint32_t rising_us, falling_us;   /* since when there is a hazard, and an end of it */
    float target_ned_m[3];
    float along_ne[2];  /* the course when the target was chosen */
    float clear_m;      /* as reported */
    uint32_t ordered_us;
    uint8_t action;
    int8_t slot; /* its obstacle; -1: none, or given up */
    int8_t edge; /* the slot past whose outline the target lies; -1: the target does not follow one */
    int8_t side; /* -1: left, 1: right, also of HOLD; 0: none */
    uint8_t changes; /* of the side */
    uint8_t reason;
    goe_flag_t rising, falling, late;
    goe_flag_t gap; /* the target lies in the middle between slot and edge */
} goe_flight_reaction_t;

typedef struct { /* goe_flight.c */
    float offset_m[3];        /* of the camera, body */
    float body_from_camera[9];
    float focal_px[2], center_px[2], size_px[2], border_px; /* focal length 0: there is no camera of this number */
} goe_flight_camera_t;

typedef struct {
    uint32_t tag; /* set by goe_flight_init() */
    goe_seal_t seal; /* of the next three */
    goe_flight_settings_t settings;
    goe_flight_camera_t camera[GOE_CAMERAS_MAX];
    float attitude_white_sd_deg; /* setting of the estimator */
    goe_flight_history_t history;
    goe_flight_marks_t marks;
    goe_flight_clock_t clock;
    goe_flight_reaction_t reaction;
    goe_flight_counters_t counters; /* may be read */
    int64_t base_us;                /* the newest sample's time, never wrapping */
    uint32_t frame_us[GOE_CAMERAS_MAX]; /* base_us when the latest frame of each camera was taken ... */
    uint32_t assessed_us;
    uint32_t capture_us; /* exposure of the latest frame taken, autopilot's clock; may be read */
    float velocity_ned_m_s[3];
    float ground_down_m; /* by the best source of the newest sample ... */
    uint8_t ground_source; /* ... which is this, GOE_FLIGHT_RANGE_FINDER, ... */
    uint8_t had_frame; /* ... bit i: one was of camera i */
    goe_flag_t origin_known;
    int32_t origin_lat_e7, origin_lon_e7;
    goe_flight_candidate_t candidate[GOE_FLIGHT_CANDIDATES];
    goe_flight_slot_t slot[GOE_FLIGHT_SLOTS];
} goe_flight_t;

/* ------------------------------------------------------------------------------------------------------- functions -- */

/* Sets every field to its default. A null pointer is ignored. */
void goe_flight_settings_default(goe_flight_settings_t *settings);

/* Checks both settings, copies them, starts with nothing known.
 *   flight_size  sizeof(goe_flight_t) in the caller's compilation
 *   estimator    as for goe_init; width_px and height_px of every camera must be set too. With boxes the sigma of the height's source, a
 *                setting of the layer, replaces navigation.height_bias_sd_m. Leave height_white_sd_m at 0: a track's heights
 *                are one reading and the changes of down
 *   settings     null: the defaults
 *   bad_field    where to put the name of the first bad setting; null if not wanted
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT or _BAD_SETTINGS; on failure *flight cannot be used. */
GOE_NODISCARD goe_flight_status_t goe_flight_init(goe_flight_t *flight, size_t flight_size, const goe_settings_t *estimator,
                                                  const goe_flight_settings_t *settings, const char **bad_field);

/* Changes the layer's settings in flight: poses, clocks, obstacles and an active order stay, and the next assessment judges by the new
 * settings. The settings of the estimators at initialization stay too.
 *   settings   null: the defaults
 *   bad_field  as for goe_flight_init
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT, _BAD_SETTINGS, _NOT_INITIALIZED, or _CORRUPTED: then call goe_flight_init(). On failure the
 * settings stay as they were. */
GOE_NODISCARD goe_flight_status_t goe_flight_change_settings(goe_flight_t *flight, const goe_flight_settings_t *settings,
                                                             const char **bad_field);

/* Take a sample of the pose. Samples closer than 20 ms are thinned.
 * Return GOE_FLIGHT_OK, _BAD_TIME, _NOT_FINITE, _OUT_OF_RANGE, _BAD_ATTITUDE, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample);
goe_flight_status_t goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample);

/* The pose at a time, height_m that of camera 0: position linear between the two samples about it, attitude by the cubic
 * through them and their neighbors, as far as these exist; the height by the best source known now. pose->time_us does not wrap and is in
 * the same clock.
 *   attitude_sd_deg  uncertainty of the attitude for a time whose one sigma is time_sd_us; null if not wanted
 * Returns GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED; all zero unless _OK. */
goe_flight_status_t goe_flight_pose(const goe_flight_t *flight, uint32_t time_us, uint32_t time_sd_us, goe_pose_t *pose,
                                    float *attitude_sd_deg);

/* The sender's clock from a two-way exchange: autopilot's minus sender's (modulo 2^32), and its one sigma. From then on it
 * replaces the one-way estimate, until sd_us is 0xFFFFFFFF: not known any more.
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_timesync(goe_flight_t *flight, uint32_t offset_us, uint32_t sd_us);

/* Takes an image's detections. A detection that is not finite or out of range is left out and counted; a known id goes to its
 * slot; a new one takes over the track that is not in this image and whose predicted position is inside its box; any other waits until
 * it is confirmed. With the last detection of an image the other tracks of its camera are updated as undetected. An obstacle
 * visible to two cameras at once may have two slots until both know its position.
 * Returns GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD, _NO_POSE, _OUT_OF_RANGE (time base, camera, count), _BAD_ARGUMENT, _NOT_INITIALIZED,
 * _CORRUPTED. */
goe_flight_status_t goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame);

/* The hazards ahead from now on, at the velocity of the newest sample, and the reaction: README.md has the rule as a table.
 *   now_us    autopilot's clock; older than the newest sample: counts as that
 *   phase     GOE_FLIGHT_FLYING, _APPROACH, _FLARE or _LANDED
 *   result    written by every call unless null; all zero (worst, avoided -1) on failure: that is not "clear" then
 * Returns GOE_FLIGHT_OK, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED, _CORRUPTED. */
goe_flight_status_t goe_flight_assess(goe_flight_t *flight, uint32_t now_us, uint8_t phase,
                                      goe_flight_assessment_t *result);

/* One obstacle, slot 0 to GOE_FLIGHT_SLOTS - 1, as of the latest image, with the hazard of the latest assessment.
 * Returns GOE_FLIGHT_OK, _NOTHING, _NO_POSE, _BAD_ARGUMENT, _NOT_INITIALIZED, _CORRUPTED (a flipped bit made a number of it infinite);
 * all zero unless _OK. */
goe_flight_status_t goe_flight_obstacle(const goe_flight_t *flight, int slot, goe_flight_obstacle_t *obstacle);

/* Nearest obstacle by bearing: sector i is centered on 5 i degrees from north; cm, at most max_cm; max_cm + 1: nothing there as
 * far as the camera's view; GOE_FLIGHT_SECTOR_UNKNOWN elsewhere. Obstacles that the latest assessment clears in height by more than the
 * clearance, at two sigma, are left out. For PX4's obstacle_distance: increment 5, GLOBAL frame.
 *   max_cm  1 to 65000
 * Returns GOE_FLIGHT_OK, _NO_POSE (all unknown), _OUT_OF_RANGE, _BAD_ARGUMENT, _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_sectors(const goe_flight_t *flight, uint32_t max_cm, uint16_t sector_cm[GOE_FLIGHT_SECTORS]);

/* Forgets poses, clocks, obstacles and the reaction; keeps settings and counters. After a restart of the autopilot.
 * Returns GOE_FLIGHT_OK, _BAD_ARGUMENT or _NOT_INITIALIZED. */
goe_flight_status_t goe_flight_restart(goe_flight_t *flight);

/* A short lower-case name for an action ("none", "left", ...), never null; "unknown" for any other number. */
const char *goe_flight_action_text(goe_flight_action_t action);

/* The same for a reason ("none", "clear", "least_bad", "low", "slow", "landing"). */
const char *goe_flight_reason_text(goe_flight_reason_t reason);

#ifdef __cplusplus
}
#endif

#endif /* GOE_FLIGHT_H */
