/* Position, height and rotation of the camera in T, from the poses; Section 2. SPDX-License-Identifier: MIT */
#include "image/goe_ego_motion.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_rotation.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"

#define PACE_SPAN_S 0.09f        /* span of the poses that give rate and velocity: a shorter one gives their noise */
#define PACE_SPAN_MIN_S 0.045f   /* least time since the latest mark that gives them */
#define PACE_SPAN_MAX_US 600000u /* longest span: a longer one gives only a mean */
#define PACE_SPAN_MAX_S ((float)PACE_SPAN_MAX_US * GOE_S_PER_US)
#define PACE_COSINE_MIN 0.9f     /* cosine of half the rotation in a span: more is a jump, not flight */
#define LEVEL_NOSE_MIN 1.0e-3f   /* least horizontal part of the nose's unit vector that gives a heading */
#define LEAP_MIN_M 0.5f          /* least distance of a jump from the predicted place: a smaller one does no harm */
#define LEAP_MIN_S 0.02f         /* added, times the speed: an error of the time stamp */
#define LEAP_MIN_M_S2 40.0f      /* added, times the squared time: an aircraft's acceleration */
#define LEAP_STRAYS 5.0f         /* added, times the largest recent distance: positions err */
#define LEAP_SIGMAS 6.0f         /* at least added, times position_white_sd_m */
#define SINGLE_RATIO 1.25f       /* largest sum of the recent jumps and a single one, over the latter */
#define UNDONE_M (1.0f / 256.0f) /* unit of goe_motion_t.undone */
#define UNDONE_MAX_M 127.0f      /* most that it holds */
#define UNDONE_S 10.0f           /* in which recent jumps are forgotten */
#define STRAY_M 0.0625f          /* unit of goe_motion_t.stray */
#define STRAY_LEFT 0.7f          /* of it is left in the next image */
#define STRAY_UNKNOWN_M 16.0f    /* allows no jump: eight images later 0.9 m are left */
#define PATH_MARKS 6             /* marks in the memory of the smoothed path: half a second, if each image is one */
#define OFF_MAX_M 1.0e7f         /* more off the path is no flight: positions are within 1e6 m */
#define MOVING_M_S 1.0f          /* least velocity that predicts a place: held positions have none */

/* Sets T's Z axis in (north, east): the configured heading, or the direction of the nose. */
static void fix_heading(goe_motion_t *motion, const goe_settings_t *settings, const float body_to_ned[9]) {
    const float north = body_to_ned[0];
    const float east = body_to_ned[3];
    const float level = sqrtf(north * north + east * east);
    if (!settings->heading_auto) {
        goe_sincos_deg(settings->heading_deg, &motion->heading_sin, &motion->heading_cos);
    } else if (level < LEVEL_NOSE_MIN) {
        motion->heading_cos = 1.0f;
        motion->heading_sin = 0.0f;
    } else {
        motion->heading_cos = north / level;
        motion->heading_sin = east / level;
    }
}

float goe_motion_heading_deg(const goe_motion_t *motion) {
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    if (motion->time_us == GOE_TIME_UNKNOWN) {
        return 0.0f;
    }
    const float half_deg = goe_arctan_rad(s, c < 0.0f ? -c : c) * GOE_DEG_PER_RAD;
    if (c >= 0.0f) {
        return half_deg;
    }
    return s >= 0.0f ? 180.0f - half_deg : -180.0f - half_deg;
}

/* Position of a camera, NED. */
static void camera_position(const goe_camera_t *camera, const goe_pose_t *pose, const float body_to_ned[9],
                            float position[3]) {
    float arm[3];
    goe_rotation_apply(body_to_ned, camera->offset_m, arm);
    position[0] = pose->position_ned_m[0] + arm[0];
    position[1] = pose->position_ned_m[1] + arm[1];
    position[2] = pose->position_ned_m[2] + arm[2];
}

/* Fixes T and its origin. Every image does this, up to the first one that shows a feature. */
static void begin_track(goe_motion_t *motion, const goe_settings_t *settings, const float body_to_ned[9],
                        const float position[3]) {
    fix_heading(motion, settings, body_to_ned);
    motion->start_time_us = motion->time_us;
    motion->origin_ne_m[0] = position[0];
    motion->origin_ne_m[1] = position[1];
}

/* jump_m: known jump of the autopilot's down, 0 if there is none. The given height and down place the ground. If the ground stays, the
 * height jumped with down, and from now on the jump is removed from it. If the ground jumps with down, the height did not jump, because it
 * is a range finder's. The nearer of the two applies. */
static void follow_height(goe_motion_t *motion, const goe_pose_t *pose, float camera_down_m, float jump_m) {
    const float ground_m = pose->height_m + camera_down_m;
    const float step_m = ground_m - motion->ground_m;
    if (goe_absolute(step_m) < goe_absolute(step_m - jump_m)) {
        motion->height_jump_m += jump_m;
    }
    motion->ground_m = ground_m;
    motion->height_m = pose->height_m + motion->height_jump_m;
}

/* Computes (NED -> T) (body -> NED) (camera -> body), column by column. Rows of NED -> T: X = (-sin, cos, 0), Y = (0, 0, 1), Z = (cos, sin,
 * 0). T is level, whatever the glide slope. */
static void turn_into_trajectory(const goe_motion_t *motion, const float body_to_ned[9], goe_view_t *view) {
    const float *b = body_to_ned;
    float *turned = view->camera_to_trajectory;
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    for (int i = 0; i < 3; i++) {
        const float *m = &view->camera_to_body[i];
        const float north = b[0] * m[0] + b[1] * m[3] + b[2] * m[6];
        const float east = b[3] * m[0] + b[4] * m[3] + b[5] * m[6];
        const float down = b[6] * m[0] + b[7] * m[3] + b[8] * m[6];
        turned[i] = c * east - s * north;
        turned[3 + i] = down;
        turned[6 + i] = c * north + s * east;
    }
}

/* Sets the camera's position, T axes, from the pose. */
static void place_camera(goe_motion_t *motion, const float position[3]) {
    const float north = position[0] - motion->origin_ne_m[0];
    const float east = position[1] - motion->origin_ne_m[1];
    motion->dx_m = motion->heading_cos * east - motion->heading_sin * north;
    motion->dz_m = motion->heading_cos * north + motion->heading_sin * east;
}

#if GOE_AUGMENTED
#if GOE_CAMERAS_MAX > 1
/* Adds the way from the arm of the previous image's camera to that of this one: it is no motion of the aircraft. */
static void add_arm(const goe_motion_t *motion, const goe_settings_t *settings, const goe_view_t *view,
                    const float body_to_ned[9], float before_m[2]) {
    const size_t number = motion->camera % (size_t)GOE_CAMERAS_MAX;
    const goe_camera_t *previous = number == 0u ? &settings->camera : &settings->more_cameras[number - 1u];
    float arm_m[3];
    const float offset_m[3] = {view->camera->offset_m[0] - previous->offset_m[0],
                               view->camera->offset_m[1] - previous->offset_m[1],
                               view->camera->offset_m[2] - previous->offset_m[2]};
    goe_rotation_apply(body_to_ned, offset_m, arm_m);
    before_m[0] += motion->heading_cos * arm_m[1] - motion->heading_sin * arm_m[0];
    before_m[1] += motion->heading_cos * arm_m[0] + motion->heading_sin * arm_m[1];
}
#endif

/* Remembers the largest recent distance of an image from the predicted place. */
static void note_stray(goe_motion_t *motion, float distance_m) {
    const float stray = goe_larger(STRAY_LEFT * (float)motion->stray, distance_m / STRAY_M);
    motion->stray = (uint8_t)(stray < (float)UINT8_MAX ? stray : (float)UINT8_MAX);
}

/* Whether the path predicts this image. Positions held from fix to fix have no path, and a hover has none either. */
static bool predicts(const goe_motion_t *motion, const float before_m[2], float since_s) {
    const float way2 = goe_square(motion->dx_m - before_m[0]) + goe_square(motion->dz_m - before_m[1]);
    return goe_motion_paced(motion) && since_s < PACE_SPAN_MAX_S && way2 >= goe_square(MOVING_M_S * since_s);
}

/* Least distance of a jump from the predicted place: what an aircraft flies, a time stamp errs by, or noise explains. */
static float least_leap_m(const goe_motion_t *motion, float white_m, float since_s) {
    const float speed_m_s = goe_absolute(motion->velocity_m_s[0]) + goe_absolute(motion->velocity_m_s[1]);
    const float stray_m = goe_larger(LEAP_STRAYS * STRAY_M * (float)motion->stray, LEAP_SIGMAS * white_m);
    return LEAP_MIN_M + LEAP_MIN_S * speed_m_s + LEAP_MIN_M_S2 * since_s * since_s + stray_m;
}

/* Whether a jump is not one of a series in one direction. Such a series corrects a position that drifts, so it is motion. */
static bool is_single(const float sum_m[2], float distance_m) {
    return goe_square(sum_m[0]) + goe_square(sum_m[1]) <= goe_square(SINGLE_RATIO * distance_m);
}

/* Removes a jump that no reset announced, and that no aircraft can fly. The jump is the way from the predicted place to the given one. */
static bool undo_leap(goe_motion_t *motion, float white_m, const float before_m[2], float since_s) {
    const float x_m = before_m[0] + motion->velocity_m_s[0] * since_s;
    const float z_m = before_m[1] + motion->velocity_m_s[1] * since_s;
    const float leap_m[2] = {motion->dx_m - x_m, motion->dz_m - z_m};
    const float distance_m = sqrtf(goe_square(leap_m[0]) + goe_square(leap_m[1]));
    const float left_m = UNDONE_M * (1.0f - since_s / UNDONE_S); /* since_s ends at PACE_SPAN_MAX_S */
    float undone_m[2] = {left_m * (float)motion->undone[0], left_m * (float)motion->undone[1]};
    const float sum_m[2] = {undone_m[0] + leap_m[0], undone_m[1] + leap_m[1]};
    const bool predicted = predicts(motion, before_m, since_s);
    const bool quiet = motion->stray < UINT8_MAX && goe_within(distance_m, OFF_MAX_M);
    const bool leapt =
        predicted && quiet && distance_m > least_leap_m(motion, white_m, since_s) && is_single(sum_m, distance_m);
    float leap_ne_m[2];
    if (leapt) {
        goe_motion_turn(motion, leap_m, leap_ne_m);
        for (size_t i = 0; i < 2; i++) {
            undone_m[i] = goe_larger(sum_m[i] < UNDONE_MAX_M ? sum_m[i] : UNDONE_MAX_M, -UNDONE_MAX_M);
            motion->origin_ne_m[i] += leap_ne_m[i];
        }
        motion->dx_m = x_m;
        motion->dz_m = z_m;
    }
    note_stray(motion, predicted ? (leapt ? 0.0f : distance_m) : STRAY_UNKNOWN_M);
    motion->undone[0] = (int16_t)(undone_m[0] / UNDONE_M);
    motion->undone[1] = (int16_t)(undone_m[1] / UNDONE_M);
    return leapt;
}

/* The rotation `turn` from mark to now, in NED (now = turn mark). half_ned: vector part over scalar part, which is half the angle. */
static bool half_turn(const float now[4], const float mark[4], float half_ned[3]) {
    const float scalar = now[0] * mark[0] + now[1] * mark[1] + now[2] * mark[2] + now[3] * mark[3];
    const float north = now[1] * mark[0] - now[0] * mark[1] + now[3] * mark[2] - now[2] * mark[3];
    const float east = now[2] * mark[0] - now[0] * mark[2] + now[1] * mark[3] - now[3] * mark[1];
    const float down = now[3] * mark[0] - now[0] * mark[3] + now[2] * mark[1] - now[1] * mark[2];
    if (!(goe_absolute(scalar) > PACE_COSINE_MIN)) {
        return false;
    }
    half_ned[0] = north / scalar;
    half_ned[1] = east / scalar;
    half_ned[2] = down / scalar;
    return true;
}

static void turn_rate(goe_motion_t *motion, const float half_ned[3], float since_s) {
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    motion->rate_rad_s[0] = 2.0f * (c * half_ned[1] - s * half_ned[0]) / since_s;
    motion->rate_rad_s[1] = 2.0f * half_ned[2] / since_s;
    motion->rate_rad_s[2] = 2.0f * (c * half_ned[0] + s * half_ned[1]) / since_s;
}

/* The place minus that which the path predicts for this image: the errors of the two are independent. */
static void leave_path(const goe_motion_t *motion, const float place_m[3], float since_s, float off_m[3]) {
    for (size_t i = 0; i < 3; i++) {
        off_m[i] = place_m[i] - (motion->mark_m[i] + motion->velocity_m_s[i] * since_s);
    }
}

/* Begins the path with this image. */
static void begin_path(goe_motion_t *motion, const float place_m[3]) {
    motion->marks = 1;
    memcpy(motion->mark_m, place_m, sizeof motion->mark_m);
    memset(motion->velocity_m_s, 0, sizeof motion->velocity_m_s);
}

/* The least-squares line through the marks so far, by recursion; from PATH_MARKS on, with constant gains. Returns the gain of the velocity. */
static float extend_path(goe_motion_t *motion, const float place_m[3], const float off_m[3], float since_s) {
    motion->marks = (uint8_t)(motion->marks < PATH_MARKS ? motion->marks + 1 : PATH_MARKS);
    const float n = (float)motion->marks;
    const float share = 1.0f / (n * (n + 1.0f));
    const float left = (n - 1.0f) * (n - 2.0f) * share; /* 1 minus the gain of the place */
    const float gain = 6.0f * share / since_s;
    for (size_t i = 0; i < 3; i++) {
        motion->mark_m[i] = place_m[i] - left * off_m[i];
        motion->velocity_m_s[i] += gain * off_m[i];
    }
    return gain;
}

/* Updates the smoothed path. place_m: the vehicle, X and Z in T, down; not the camera, because two cameras have different arms. It contains
 * no jump. since_s: time since the mark; continues: the image follows the mark; marked: it is a mark. */
static void follow_path(goe_motion_t *motion, const float place_m[3], float since_s, bool continues, bool marked,
                        goe_view_t *view) {
    const bool known = continues && goe_motion_paced(motion);
    view->gain_1_s = 0.0f;
    if (!continues) {
        begin_path(motion, place_m);
    }
    leave_path(motion, place_m, since_s, view->off_m);
    if (!goe_within(view->off_m[0] + view->off_m[1] + view->off_m[2], OFF_MAX_M)) {
        begin_path(motion, place_m); /* a bit was flipped */
        memset(view->off_m, 0, sizeof view->off_m);
    } else if (continues && marked) {
        view->gain_1_s = extend_path(motion, place_m, view->off_m, since_s);
    } else {
        /* the path stays */
    }
    if (!known) {
        memset(view->off_m, 0, sizeof view->off_m);
    }
}

/* Updates rate and path from the poses since the mark. */
static void find_pace(goe_motion_t *motion, const float attitude[4], const float place_m[3], float before_s,
                      goe_view_t *view) {
    float half[3] = {0.0f, 0.0f, 0.0f};
    const bool first = !motion->detected; /* no earlier image fixed T */
    const uint32_t since_us = (uint32_t)(uint64_t)motion->time_us - motion->mark_us;
    const float marked_s = (float)(since_us < PACE_SPAN_MAX_US ? since_us : PACE_SPAN_MAX_US) * GOE_S_PER_US;
    const float since_s = goe_larger(before_s, marked_s); /* mark_us is half a time */
    const bool soon = !first && since_s < PACE_SPAN_MIN_S;
    const bool continues =
        !first && since_s < PACE_SPAN_MAX_S && (soon || half_turn(attitude, motion->mark_attitude, half));
    const bool marked = !continues || since_s >= PACE_SPAN_S;
    follow_path(motion, place_m, since_s, continues, marked, view);
    if (soon) {
        return;
    }
    if (continues) {
        turn_rate(motion, half, since_s);
    } else {
        memset(motion->rate_rad_s, 0, sizeof motion->rate_rad_s);
        memset(motion->rate_before_rad_s, 0, sizeof motion->rate_before_rad_s);
    }
    if (marked) {
        memcpy(motion->mark_attitude, attitude, sizeof motion->mark_attitude);
        motion->mark_us = (uint32_t)(uint64_t)motion->time_us;
    }
}

/* For the filter: removes a jump that no reset announced from the own motion, and updates rate and path. before_m, before_us: camera and
 * time of the previous image. Returns whether there was a jump. */
static GOE_NOINLINE bool follow_pace(goe_motion_t *motion, const goe_settings_t *settings, const float position[3],
                                     const float before_m[2], int64_t before_us, goe_view_t *view) {
    const goe_pose_t *pose = &view->image->pose;
    const float arm_n = position[0] - pose->position_ned_m[0];
    const float arm_e = position[1] - pose->position_ned_m[1];
    const float before_s = goe_time_between_s(before_us, motion->time_us, PACE_SPAN_MAX_US);
    const bool leapt = undo_leap(motion, settings->navigation.position_white_sd_m, before_m, before_s);
    /* a span ended there: its rate does not contain this image's own error */
    if (motion->mark_us == (uint32_t)(uint64_t)before_us) {
        memcpy(motion->rate_before_rad_s, motion->rate_rad_s, sizeof motion->rate_rad_s);
    }
    const float place_m[3] = {motion->dx_m - (motion->heading_cos * arm_e - motion->heading_sin * arm_n),
                              motion->dz_m - (motion->heading_cos * arm_n + motion->heading_sin * arm_e),
                              pose->position_ned_m[2]};
    find_pace(motion, pose->attitude, place_m, before_s, view);
    return leapt;
}
#endif

/* Fixes T and its origin; later, moves the origin along with a known jump. */
static void place_origin(goe_motion_t *motion, const goe_settings_t *settings, const float body_to_ned[9],
                         const float position[3], const float jump_m[3]) {
    if (!motion->detected) {
        begin_track(motion, settings, body_to_ned, position);
        return;
    }
    motion->origin_ne_m[0] += jump_m[0];
    motion->origin_ne_m[1] += jump_m[1];
}

bool goe_motion_follow(goe_motion_t *motion, const goe_settings_t *settings, goe_view_t *view) {
    static const float NO_JUMP[3] = {0.0f, 0.0f, 0.0f};
    const goe_pose_t *pose = &view->image->pose;
    const float *jump_m = goe_motion_reset(motion, pose) ? pose->reset_delta_ned_m : NO_JUMP;
    float body_to_ned[9];
    float position[3];
    bool leapt = false;
#if GOE_AUGMENTED
    float before_m[2] = {motion->dx_m, motion->dz_m};
    const int64_t before_us = motion->time_us;
#endif
    goe_rotation_from_quaternion(pose->attitude, body_to_ned);
    camera_position(view->camera, pose, body_to_ned, position);
#if GOE_AUGMENTED && GOE_CAMERAS_MAX > 1
    add_arm(motion, settings, view, body_to_ned, before_m);
#endif
    motion->reset_count = pose->reset_count;
    motion->time_us = pose->time_us;
#if GOE_CAMERAS_MAX > 1
    motion->camera = view->image->camera;
#endif
    place_origin(motion, settings, body_to_ned, position, jump_m);
    follow_height(motion, pose, position[2], jump_m[2]);
    place_camera(motion, position);
    turn_into_trajectory(motion, body_to_ned, view);
#if GOE_AUGMENTED
    if (settings->method == GOE_METHOD_FILTER) {
        motion->mark_m[2] += jump_m[2]; /* the path jumps along */
        leapt = follow_pace(motion, settings, position, before_m, before_us, view);
    }
#endif
    return leapt;
}
