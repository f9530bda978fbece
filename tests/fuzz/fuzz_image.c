/* Images of a flight, and faults in some of them. SPDX-License-Identifier: MIT */
#include "fuzz_image.h"

#define US_PER_S 1000000u
#define PERIOD_US 125000u
#define INVISIBLE_MAX 6u /* images in a row before the flight restarts */
#define AHEAD_MAX_US (INT64_MAX / 2)

/* ------------------------------------------------------------------------------------------------------------- images -- */

static const uint8_t shown[] = {FUZZ_SHOWS_POINTS | FUZZ_SHOWS_BASE, FUZZ_SHOWS_BOX, FUZZ_SHOWS_POINTS,
                                FUZZ_SHOWS_BOX | FUZZ_SHOWS_POINTS | FUZZ_SHOWS_BASE, FUZZ_SHOWS_BASE};

void fuzz_view_begin(fuzz_input_t *in, const goe_settings_t *settings, fuzz_view_t *view) {
    const int64_t now_us = view->now_us;
    const uint8_t resets = view->resets;
    memset(view, 0, sizeof *view);
    view->settings = settings;
    view->now_us = now_us > AHEAD_MAX_US || now_us < -AHEAD_MAX_US ? 0 : now_us;
    view->resets = resets;
    view->path = fuzz_any_path(in);
    view->solid = fuzz_any_solid(in, &view->path);
    const uint32_t kind = fuzz_byte(in);
    view->noise.state = fuzz_half(in) * 0x9E3779B9u | 1u;
    view->shows = shown[fuzz_below(in, sizeof shown)];
#if GOE_CAMERAS_MAX > 1
    view->shows |= settings->more_cameras[0].fx_px > 0.0f ? FUZZ_SHOWS_TWO_CAMERAS : 0u;
#endif
    view->pixel_px = (kind & 3u) == 0 ? 0.0f : (kind & 3u) == 3u ? fuzz_between(in, 0.0f, 30.0f) : 0.7f;
    view->late_s = (kind & 12u) == 12u ? fuzz_between(in, -0.2f, 0.4f) : 0.0f;
    view->period_us = (kind & 48u) == 48u ? 1000u + 10u * fuzz_half(in) : PERIOD_US;
    if ((kind & 192u) == 192u) {
        view->hint.attitude_sd_deg = fuzz_between(in, 0.0f, 3.0f);
        view->hint.height_sd_m = fuzz_between(in, 0.0f, 10.0f);
        view->hint.pixel_sd_px = fuzz_between(in, 0.0f, 8.0f);
    }
}

static const goe_camera_t *camera_of(const fuzz_view_t *view, uint8_t number) {
#if GOE_CAMERAS_MAX > 1
    return number == 1 ? &view->settings->more_cameras[0] : &view->settings->camera;
#else
    (void)number;
    return &view->settings->camera;
#endif
}

/* The features; none if a part of the obstacle is not ahead. */
static void show(fuzz_view_t *view, const goe_camera_t *camera, const goe_pose_t *truth, goe_image_t *image) {
    fuzz_sight_t sight;
    view->invisible++;
    if (!fuzz_look(camera, truth, &view->solid, view->t_s, &sight)) {
        return;
    }
    if (view->pixel_px > 0.0f) {
        fuzz_blur(&sight, &view->noise, view->pixel_px);
    }
    if ((view->shows & FUZZ_SHOWS_BOX) != 0) {
        image->box = fuzz_box(camera, &sight);
    }
    if ((view->shows & (FUZZ_SHOWS_POINTS | FUZZ_SHOWS_BASE)) != 0) {
        fuzz_points(camera, &sight, (view->shows & FUZZ_SHOWS_BASE) != 0, image);
    }
    if (image->box.sides != 0 || image->left.visible || image->right.visible) {
        view->invisible = 0;
    }
}

/* A camera that hangs repeats the same features with new poses. */
static void repeat(fuzz_view_t *view, goe_image_t *image) {
    if (view->frozen > 0) {
        const goe_pose_t pose = image->pose;
        view->frozen--;
        *image = view->before;
        image->pose = pose;
    } else {
        view->before = *image;
    }
}

bool fuzz_view_image(fuzz_view_t *view, goe_image_t *image) {
    goe_pose_t truth;
    const bool restarted = view->invisible > INVISIBLE_MAX;
    memset(image, 0, sizeof *image);
    if (restarted) {
        view->invisible = 0;
        view->t_s = 0.0f;
        fuzz_path_pose(&view->path, 0.0f, &truth);
        const float distance_m = 3.0f * truth.height_m + 70.0f + 40.0f * fuzz_noise(&view->noise);
        fuzz_put_ahead(&view->settings->camera, &truth, distance_m, 0.0f, &view->solid);
    }
    view->t_s += (float)view->period_us / (float)US_PER_S;
    view->now_us += view->now_us < INT64_MAX - (int64_t)view->period_us ? (int64_t)view->period_us : 0;
    if ((view->shows & FUZZ_SHOWS_TWO_CAMERAS) != 0) {
        image->camera = (uint8_t)(fuzz_noise_bits(&view->noise) >> 31);
    }
    fuzz_path_pose(&view->path, view->t_s, &truth);
    show(view, camera_of(view, image->camera), &truth, image);
    if (view->late_s > 0.0f || view->late_s < 0.0f) {
        fuzz_path_pose(&view->path, view->t_s - view->late_s, &truth);
    }
    image->pose = truth;
    image->pose.time_us = view->now_us;
    image->pose.reset_count = view->resets;
    for (int i = 0; i < 3; i++) {
        image->pose.position_ned_m[i] += view->jump_ned_m[i];
    }
    image->pose.height_m += view->height_off_m;
    image->noise = view->hint;
    repeat(view, image);
    return restarted;
}

/* -------------------------------------------------------------------------------------------------------------- faults -- */

#define NUMBER(field) offsetof(goe_image_t, field)
static const size_t numbers[] = {NUMBER(left.u_px),
                                 NUMBER(left.v_px),
                                 NUMBER(right.u_px),
                                 NUMBER(right.v_px),
                                 NUMBER(top.u_px),
                                 NUMBER(top.v_px),
                                 NUMBER(base_left.u_px),
                                 NUMBER(base_left.v_px),
                                 NUMBER(base_near.u_px),
                                 NUMBER(base_near.v_px),
                                 NUMBER(base_right.u_px),
                                 NUMBER(base_right.v_px),
                                 NUMBER(box.left_px),
                                 NUMBER(box.top_px),
                                 NUMBER(box.right_px),
                                 NUMBER(box.bottom_px),
                                 NUMBER(pose.height_m),
                                 NUMBER(pose.position_ned_m),
                                 NUMBER(pose.position_ned_m[1]),
                                 NUMBER(pose.position_ned_m[2]),
                                 NUMBER(pose.attitude),
                                 NUMBER(pose.attitude[1]),
                                 NUMBER(pose.attitude[2]),
                                 NUMBER(pose.attitude[3]),
                                 NUMBER(noise.attitude_sd_deg),
                                 NUMBER(noise.height_sd_m),
                                 NUMBER(noise.pixel_sd_px),
                                 NUMBER(pose.reset_delta_ned_m),
                                 NUMBER(pose.reset_delta_ned_m[1]),
                                 NUMBER(pose.reset_delta_ned_m[2])};
#define NUMBERS (sizeof numbers / sizeof numbers[0])
#define FEATURE_NUMBERS 16u /* the first ones */
#define POSE_NUMBERS 11u    /* ... and those up to here */

static float get_number(const goe_image_t *image, size_t i) {
    float value;
    memcpy(&value, (const unsigned char *)image + numbers[i], sizeof value);
    return value;
}

static void put_number(goe_image_t *image, size_t i, float value) {
    memcpy((unsigned char *)image + numbers[i], &value, sizeof value);
}

static goe_pixel_t *point_of(goe_image_t *image, uint32_t i) {
    goe_pixel_t *const points[] = {&image->left,      &image->right,     &image->top,
                                   &image->base_left, &image->base_near, &image->base_right};
    return points[i % 6u];
}

static void hide(goe_image_t *image) {
    for (uint32_t i = 0; i < 6u; i++) {
        point_of(image, i)->visible = false;
    }
    image->box.sides = 0;
}

static void hide_one(fuzz_input_t *in, goe_image_t *image) {
    const uint32_t which = fuzz_byte(in);
    point_of(image, which)->visible = false;
    image->box.sides = (uint8_t)(image->box.sides & ~(1u << (which >> 5) % 4u));
}

/* Bytes of bool that are neither 0 nor 1: they count as 1. Only the library may read them. */
static void put_truths(fuzz_input_t *in, goe_image_t *image) {
    const uint8_t truth = fuzz_byte(in);
    const uint32_t which = fuzz_byte(in);
    for (uint32_t i = 0; i < 6u; i++) {
        if ((which >> i & 1u) != 0) {
            memset(&point_of(image, i)->visible, truth, sizeof(bool));
        }
    }
    memset(&image->pose.reset_delta_known, truth >> 1, sizeof(bool));
}

static void swap_points(fuzz_input_t *in, goe_image_t *image) {
    const uint32_t which = fuzz_byte(in);
    goe_pixel_t *a = point_of(image, which);
    goe_pixel_t *b = point_of(image, which / 6u);
    const goe_pixel_t kept = *a;
    *a = *b;
    *b = kept;
}

static void all_bits(fuzz_input_t *in, goe_image_t *image) {
    const uint32_t visible = fuzz_half(in);
    const uint32_t how = fuzz_byte(in);
    fuzz_noise_t noise = {fuzz_word(in) | 1u};
    for (size_t i = 0; i < NUMBERS; i++) {
        const bool pose = i >= FEATURE_NUMBERS;
        const float bits = fuzz_float_of(fuzz_noise_bits(&noise));
        if ((how & 1u) == 0 || !pose) { /* or the pose stays, and the numbers are within their range */
            put_number(image, i, (how & 2u) == 0 ? bits : 1.0e5f * fuzz_noise(&noise));
        }
    }
    for (uint32_t i = 0; i < 6u; i++) {
        point_of(image, i)->visible = (visible >> i & 1u) != 0;
    }
    image->box.sides = (uint8_t)(visible >> 8);
}

static int64_t any_time(fuzz_input_t *in, int64_t now_us) {
    const int64_t hour_us = INT64_C(3600000000);
    const int64_t before_us = now_us > INT64_MIN + hour_us ? now_us - hour_us : now_us;
    const int64_t after_us = now_us < INT64_MAX - hour_us ? now_us + hour_us : now_us;
    const int64_t times[] = {INT64_MIN, INT64_MIN + 1, -1, 0, 1, INT64_MAX - 1, INT64_MAX, before_us, after_us, now_us};
    return times[fuzz_below(in, sizeof times / sizeof times[0])];
}

/* The autopilot's filter jumps, with a reported size or with another one. */
static void jump(fuzz_input_t *in, fuzz_view_t *view, goe_image_t *image) {
    const uint32_t how = fuzz_byte(in);
    const bool true_to_it = (how & 3u) != 0;
    image->pose.reset_delta_known = (how & 4u) == 0;
    for (int i = 0; i < 3; i++) {
        const float by_m = fuzz_between(in, -20.0f, 20.0f);
        image->pose.reset_delta_ned_m[i] = by_m;
        image->pose.position_ned_m[i] += true_to_it ? by_m : 0.0f;
        view->jump_ned_m[i] += true_to_it ? by_m : 0.0f;
    }
    view->resets = (uint8_t)(view->resets + 1u + (how >> 5));
    image->pose.reset_count = view->resets;
}

static void turn_attitude(fuzz_input_t *in, goe_image_t *image) {
    const float scale = fuzz_between(in, 0.98f, 1.02f);
    const uint32_t how = fuzz_byte(in);
    for (int i = 0; i < 4; i++) {
        image->pose.attitude[i] *= scale;
    }
    if (how % 4u == 3u) { /* another attitude, its norm 1 */
        const float other[4] = {0.5f, (how & 16u) != 0 ? -0.5f : 0.5f, (how & 32u) != 0 ? -0.5f : 0.5f,
                                (how & 64u) != 0 ? -0.5f : 0.5f};
        memcpy(image->pose.attitude, other, sizeof other);
    }
}

enum {
    SPOIL_HIDE,
    SPOIL_HIDE_ONE,
    SPOIL_OUTLIER,
    SPOIL_NUMBER,
    SPOIL_POSE,
    SPOIL_TIME_REPEATED,
    SPOIL_TIME_ANY,
    SPOIL_TIME_AHEAD,
    SPOIL_ATTITUDE,
    SPOIL_JUMP,
    SPOIL_CAMERA,
    SPOIL_HINT,
    SPOIL_BITS,
    SPOIL_SWAP,
    SPOIL_SIDES,
    SPOIL_HANG,
    SPOIL_LEAP,
    SPOIL_FROZEN,
    SPOIL_SOLID,
    SPOIL_PATH,
    SPOIL_LATE,
    SPOIL_SHOWN,
    SPOIL_HEIGHT,
    SPOIL_TRUTH,
    SPOILS
};

/* A lasting change from this image on. */
static void change_flight(fuzz_input_t *in, uint32_t what, fuzz_view_t *view) {
    switch (what) {
        case SPOIL_HANG:
            view->t_s -= (float)view->period_us / (float)US_PER_S;
            view->path.speed_m_s = fuzz_below(in, 2) != 0 ? 0.0f : view->path.speed_m_s;
            break;
        case SPOIL_LEAP:
            view->t_s += fuzz_between(in, -10.0f, 10.0f);
            break;
        case SPOIL_SOLID:
            view->solid = fuzz_any_solid(in, &view->path);
            break;
        case SPOIL_PATH:
            view->path = fuzz_any_path(in);
            break;
        case SPOIL_LATE:
            view->late_s = fuzz_between(in, -0.3f, 0.6f);
            break;
        case SPOIL_HEIGHT:
            view->height_off_m = fuzz_between(in, -100.0f, 10.0f);
            break;
        case SPOIL_SHOWN:
        default:
            view->shows = shown[fuzz_below(in, sizeof shown)];
            break;
    }
}

static void spoil_time(fuzz_input_t *in, uint32_t what, fuzz_view_t *view, goe_image_t *image) {
    if (what == SPOIL_TIME_REPEATED) {
        image->pose.time_us -= (int64_t)view->period_us;
    } else if (what == SPOIL_TIME_ANY) {
        image->pose.time_us = any_time(in, view->now_us);
    } else {
        const uint32_t ahead_us = fuzz_word(in);
        const bool far = ahead_us % 16u == 15u;
        view->now_us = far ? any_time(in, view->now_us) : view->now_us + (view->now_us < AHEAD_MAX_US ? ahead_us : 0);
        image->pose.time_us = view->now_us;
    }
}

static void spoil_features(fuzz_input_t *in, uint32_t what, fuzz_view_t *view, goe_image_t *image) {
    const size_t feature = fuzz_below(in, FEATURE_NUMBERS);
    switch (what) {
        case SPOIL_HIDE:
            hide(image);
            break;
        case SPOIL_HIDE_ONE:
            hide_one(in, image);
            break;
        case SPOIL_OUTLIER:
            put_number(image, feature, get_number(image, feature) + fuzz_between(in, -200.0f, 200.0f));
            break;
        case SPOIL_NUMBER:
            put_number(image, feature, fuzz_any(in, -1.0e5f, 1.0e5f));
            break;
        case SPOIL_SWAP:
            swap_points(in, image);
            break;
        case SPOIL_SIDES:
            image->box.sides = fuzz_byte(in);
            break;
        case SPOIL_TRUTH:
            put_truths(in, image);
            break;
        case SPOIL_FROZEN:
        default:
            view->frozen = fuzz_below(in, 32);
            break;
    }
}

static void spoil_pose(fuzz_input_t *in, uint32_t what, fuzz_view_t *view, goe_image_t *image) {
    switch (what) {
        case SPOIL_POSE:
            put_number(image, FEATURE_NUMBERS + fuzz_below(in, POSE_NUMBERS), fuzz_any(in, -1.0e6f, 1.0e6f));
            break;
        case SPOIL_ATTITUDE:
            turn_attitude(in, image);
            break;
        case SPOIL_JUMP:
            jump(in, view, image);
            break;
        case SPOIL_CAMERA:
            image->camera = fuzz_byte(in);
            break;
        case SPOIL_HINT:
            image->noise.attitude_sd_deg = fuzz_any(in, 0.0f, 30.0f);
            image->noise.height_sd_m = fuzz_any(in, 0.0f, 1.0e3f);
            image->noise.pixel_sd_px = fuzz_any(in, 0.0f, 100.0f);
            break;
        case SPOIL_BITS:
        default:
            all_bits(in, image);
            break;
    }
}

void fuzz_view_spoil(fuzz_input_t *in, fuzz_view_t *view, goe_image_t *image) {
    const uint32_t what = fuzz_below(in, SPOILS);
    switch (what) {
        case SPOIL_TIME_REPEATED:
        case SPOIL_TIME_ANY:
        case SPOIL_TIME_AHEAD:
            spoil_time(in, what, view, image);
            break;
        case SPOIL_POSE:
        case SPOIL_ATTITUDE:
        case SPOIL_JUMP:
        case SPOIL_CAMERA:
        case SPOIL_HINT:
        case SPOIL_BITS:
            spoil_pose(in, what, view, image);
            break;
        case SPOIL_HANG:
        case SPOIL_LEAP:
        case SPOIL_SOLID:
        case SPOIL_PATH:
        case SPOIL_LATE:
        case SPOIL_SHOWN:
        case SPOIL_HEIGHT:
            change_flight(in, what, view);
            break;
        default:
            spoil_features(in, what, view, image);
            break;
    }
}
