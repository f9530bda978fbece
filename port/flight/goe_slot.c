/* One tracked obstacle: its estimator, and the estimate that it keeps. SPDX-License-Identifier: MIT */
#include "goe_slot.h"

#include <math.h>

#include "goe_candidate.h"
#include "goe_flight_maths.h"
#include "goe_geometry.h"

#define AROUND 0.25f /* share by which a box is enlarged: detectors and predictions err */
#define OVERLAP_MIN 0.3f
#define ALIKE 3.0f /* a box this many times as wide or high as the latest one shows another object */
#define PIXEL_MAX 32000.0f
#define SIZE_MIN_PX 8.0f
#define AWAY_MIN_M 1.0f /* nearer than this, a width in pixels says nothing */
#define KIND_MAX_M 1.0e3f
#define SHORT_M2 1.0e-6f     /* square of a vector that has no direction */
#define KIND_SHARE_MIN 0.01f /* least sigma over size that the estimator accepts */
#define LOCATED_S                                                                                                      \
    0.15f /* detections that give no new position for longer show another object; for less, images came too soon */

/* ------------------------------------------------------------------------------------------------------------- track -- */

void goe_flight_slot_begin(goe_flight_slot_t *slot, uint32_t id, uint32_t time_us) {
    (void)goe_reset(&slot->estimator);
    const size_t after = offsetof(goe_flight_slot_t, hazard);
    memset((unsigned char *)slot + after, 0, sizeof *slot - after);
    slot->id = id;
    slot->bearings.half_deg = GOE_FLIGHT_ANY_BEARING;
    slot->taken_us = slot->detected_us = time_us;
    slot->used = slot->fresh_track = true;
}

void goe_flight_slot_lose(goe_flight_slot_t *slot) { slot->fresh_track = slot->suspect = slot->remembered = true; }

bool goe_flight_slot_is_unplaced(const goe_flight_slot_t *slot) {
    return slot->used && ((slot->valid & GOE_HAS_POSITION) == 0u || slot->unlocated);
}

float goe_flight_slot_radius_m(const goe_flight_slot_t *slot) {
    return 0.5f * sqrtf(goe_flight_square(slot->width_m) + goe_flight_square(slot->length_m));
}

float goe_flight_slot_sd_along_m(const goe_flight_slot_t *slot, float north_m, float east_m) {
    const float *ne_m2 = slot->covariance_ne_m2;
    const float square = goe_flight_square(north_m) + goe_flight_square(east_m);
    const float most_m2 = ne_m2[0] + ne_m2[2];
    const float along_m2 = goe_flight_square(north_m) * ne_m2[0] + 2.0f * north_m * east_m * ne_m2[1] +
                           goe_flight_square(east_m) * ne_m2[2];
    return sqrtf(goe_flight_larger(square > SHORT_M2 ? along_m2 / square : most_m2, GOE_FLIGHT_SLOT_SD_MIN_M2));
}

void goe_flight_slot_shift(goe_flight_slot_t *slot, const float jump_ned_m[3]) {
    slot->center_ne_m[0] += jump_ned_m[0];
    slot->center_ne_m[1] += jump_ned_m[1];
    slot->ground_down_m += jump_ned_m[2];
}

/* ------------------------------------------------------------------------------------------------------------- image -- */

static void set_pose(const goe_flight_slot_t *slot, const goe_flight_slot_view_t *view, const float jumps_ned_m[3],
                     float camera_down_m, goe_pose_t *pose) {
    float jump[3];
    bool jumped = false;
    for (int i = 0; i < 3; i++) {
        jump[i] = jumps_ned_m[i] - slot->jumps_ned_m[i];
        jumped = jumped || goe_flight_magnitude(jump[i]) > 0u;
        pose->reset_delta_ned_m[i] = jump[i];
        pose->position_ned_m[i] = view->pose.ned_m[i];
    }
    memcpy(pose->attitude, view->pose.q, sizeof pose->attitude);
    pose->time_us = view->estimator_us;
    pose->height_m = slot->ground_down_m - camera_down_m;
    pose->reset_count = (uint8_t)(slot->reset_count + (jumped ? 1 : 0));
    pose->reset_delta_known = true;
}

/* Left and right in the border zone are not measured. The top may then also be outside the image. */
static void keep_inside(goe_image_t *image, const goe_flight_camera_t *camera) {
    goe_pixel_t *side[3] = {&image->left, &image->right, &image->top};
    bool all = true;
    for (int i = 0; i < 3; i++) {
        const float pixel[2] = {side[i]->u_px, side[i]->v_px};
        bool inside = true;
        for (int axis = 0; axis < 2 && goe_flight_is_set(&side[i]->visible); axis++) {
            const float half = 0.5f * camera->size_px[axis];
            inside = inside && goe_flight_within(pixel[axis] - half, goe_flight_larger(half - camera->border_px, 0.0f));
        }
        side[i]->visible = goe_flight_is_set(&side[i]->visible) && inside;
        all = all && inside;
    }
    image->top.visible = goe_flight_is_set(&image->top.visible) && all;
}

static bool is_good_size(float size_m, float sd_m) {
    return goe_flight_within(size_m, KIND_MAX_M) && !(size_m < 0.0f) && goe_flight_finite(sd_m) &&
           (!(size_m > 0.0f) || (goe_flight_within(sd_m, KIND_MAX_M) && sd_m >= KIND_SHARE_MIN * size_m));
}

bool goe_flight_slot_is_good_kind(const goe_kind_t *kind) {
    return is_good_size(kind->width_m, kind->width_sd_m) && is_good_size(kind->height_m, kind->height_sd_m) &&
           kind->shape <= GOE_KIND_OTHER;
}

static void set_features(goe_image_t *image, const goe_flight_camera_t *camera, const goe_flight_detection_t *seen) {
    image->box = seen->box;
    image->left = seen->left;
    image->right = seen->right;
    image->top = seen->top;
    image->base_left = seen->base_left;
    image->base_near = seen->base_near;
    image->base_right = seen->base_right;
    image->noise.pixel_sd_px = seen->pixel_px;
    if (goe_flight_slot_is_good_kind(&seen->kind)) {
        image->kind = seen->kind;
    }
    keep_inside(image, camera);
}

/* ------------------------------------------------------------------------------------------------------------- place -- */

static void note_center(goe_flight_slot_t *slot, const goe_estimate_t *estimate) {
    slot->center_ne_m[0] = estimate->center_north_m;
    slot->center_ne_m[1] = estimate->center_east_m;
    slot->covariance_ne_m2[0] = goe_flight_square(estimate->sigma.center_north_m);
    slot->covariance_ne_m2[1] = estimate->center_ne_m2;
    slot->covariance_ne_m2[2] = goe_flight_square(estimate->sigma.center_east_m);
}

/* A box or line of unknown length has no center. The middle of its front edge and the covariance of that replace it. */
static void note_front(goe_flight_slot_t *slot, const float camera_ned_m[3], const goe_estimate_t *estimate) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    float s;
    float c;
    goe_flight_sincos_deg(estimate->trajectory_heading_deg, &s, &c);
    (void)goe_covariance(&slot->estimator, covariance);
    const float xx = covariance[GOE_X0][GOE_X0];
    const float xz = covariance[GOE_X0][GOE_Z0];
    const float zz = covariance[GOE_Z0][GOE_Z0];
    slot->center_ne_m[0] = camera_ned_m[0] + c * estimate->z_m - s * estimate->x_m;
    slot->center_ne_m[1] = camera_ned_m[1] + s * estimate->z_m + c * estimate->x_m;
    slot->covariance_ne_m2[0] = c * c * zz - 2.0f * c * s * xz + s * s * xx;
    slot->covariance_ne_m2[1] = c * s * (zz - xx) + (c * c - s * s) * xz;
    slot->covariance_ne_m2[2] = s * s * zz + 2.0f * c * s * xz + c * c * xx;
}

static void note_outline(goe_flight_slot_t *slot, const goe_estimate_t *estimate) {
    slot->width_m = estimate->width_m;
    slot->length_m = estimate->length_m;
    slot->top_m = estimate->height_m;
    slot->top_sd_m = estimate->sigma.height_m;
    slot->length_heading_deg = 0.0f;
    if (estimate->valid & GOE_HAS_ORIENTATION) {
        const float *ne = estimate->length_axis_ne;
        const float heading_deg = goe_flight_positive_deg(goe_flight_atan2_deg(ne[1], ne[0]));
        slot->length_heading_deg = heading_deg < 180.0f ? heading_deg : heading_deg - 180.0f;
    }
}

/* since_s: time since the previous image. */
static void note(goe_flight_slot_t *slot, const float camera_ned_m[3], const goe_estimate_t *estimate, float since_s) {
    const bool placed = (estimate->valid & GOE_HAS_POSITION) != 0u;
    if (slot->remembered && !placed) {
        slot->age_s += goe_flight_larger(since_s, 0.0f);
        return;
    }
    slot->remembered = false;
    slot->valid = (uint8_t)estimate->valid;
    slot->model = (uint8_t)estimate->model;
    slot->suspect = estimate->suspect;
    slot->age_s = estimate->age_s;
    if (!placed) {
        slot->assessed = false;
        memset(&slot->hazard, 0, sizeof slot->hazard);
        return;
    }
    if (estimate->valid & GOE_HAS_CENTER) {
        note_center(slot, estimate);
    } else {
        note_front(slot, camera_ned_m, estimate);
    }
    note_outline(slot, estimate);
}

/* The pixel of the center at this share of the top's height, or of the aircraft's height if the top is unknown. */
static bool predict_at(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera,
                       const goe_flight_history_pose_t *pose, float share, float pixel[2]) {
    const float own_m = slot->ground_down_m - pose->ned_m[2];
    const float above_m = share * ((slot->valid & GOE_HAS_HEIGHT) ? slot->top_m : goe_flight_larger(own_m, 0.0f));
    const float point[3] = {slot->center_ne_m[0], slot->center_ne_m[1], slot->ground_down_m - above_m};
    return goe_flight_geometry_project(camera, pose, point, pixel);
}

static bool predict(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera,
                    const goe_flight_history_pose_t *pose, float pixel[2]) {
    return predict_at(slot, camera, pose, 0.5f, pixel);
}

/* Whether a box shows the slot's position. If the image border cuts the box, the position may lie outside it. */
static bool shows_position(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera,
                           const goe_flight_history_pose_t *pose, const int16_t box_px[4]) {
    const float left = (float)box_px[0];
    const float right = (float)box_px[2];
    float pixel[2];
    if (left <= camera->border_px || right >= camera->size_px[0] - camera->border_px) {
        return true;
    }
    const bool ahead = predict(slot, camera, pose, pixel);
    return ahead && goe_flight_within(pixel[0] - 0.5f * (left + right), (0.5f + AROUND) * (right - left) + SIZE_MIN_PX);
}

/* Whether the latest detections show another object than the obstacle at its position: they do not change its position, or are elsewhere.
 * This stays set until the position is new. */
static void note_located(goe_flight_slot_t *slot, const goe_flight_camera_t *camera, const goe_flight_slot_view_t *view,
                         const goe_flight_detection_t *seen) {
    const bool old = slot->age_s + goe_flight_between_s(view->time_us, slot->taken_us) > LOCATED_S;
    int16_t box_px[4];
    if (!seen) {
        return;
    }
    const bool elsewhere = (slot->valid & GOE_HAS_POSITION) != 0u && goe_flight_slot_box_of(seen, box_px) &&
                           !shows_position(slot, camera, &view->pose, box_px);
    slot->unlocated = old || elsewhere;
}

/* A detection in an image that the estimator cannot use, because a newer one without a detection came before. It still shows where the
 * obstacle is, and that the position does not follow its detections. */
static void note_late(goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                      const goe_flight_slot_view_t *view, const goe_flight_detection_t *seen) {
    if (!seen || goe_flight_between_us(view->time_us, slot->detected_us) <= 0) {
        return;
    }
    slot->detected_us = view->time_us;
    slot->camera = view->camera;
    slot->in_view = true;
    (void)goe_flight_slot_box_of(seen, slot->box_px);
    goe_flight_slot_bearings_of(seen, &cameras[view->camera], view->pose.q, &slot->bearings);
    slot->unlocated = true;
}

void goe_flight_slot_take(goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                          const goe_flight_slot_view_t *view, const float jumps_ned_m[3],
                          const goe_flight_detection_t *seen) {
    goe_image_t image;
    goe_estimate_t estimate;
    float body_to_ned[9];
    float camera_ned_m[3];
    if (!slot->fresh_track && goe_flight_between_us(view->time_us, slot->taken_us) <= 0) {
        note_late(slot, cameras, view, seen);
        return;
    }
    const uint8_t last = slot->camera < GOE_CAMERAS_MAX ? slot->camera : 0u;
    const uint8_t number = seen ? view->camera : last;
    const goe_flight_camera_t *camera = &cameras[number];
    goe_flight_rotation(view->pose.q, body_to_ned);
    goe_flight_turn(body_to_ned, camera->offset_m, camera_ned_m);
    for (int i = 0; i < 3; i++) {
        camera_ned_m[i] += view->pose.ned_m[i];
    }
    if (slot->fresh_track) {
        if (slot->remembered) { /* the kept top stays at its height, whatever the ground below the aircraft */
            slot->top_m += view->ground_down_m - slot->ground_down_m;
        }
        slot->ground_down_m = view->ground_down_m;
        slot->height_sd_m = view->height_sd_m;
        memcpy(slot->jumps_ned_m, jumps_ned_m, sizeof slot->jumps_ned_m);
    }
    memset(&image, 0, sizeof image);
    set_pose(slot, view, jumps_ned_m, camera_ned_m[2], &image.pose);
    image.camera = number;
    image.noise.attitude_sd_deg = view->attitude_sd_deg;
    image.noise.height_sd_m = slot->height_sd_m; /* the estimator uses it once, in an image of its choice */
    if (seen) {
        slot->in_view = true;
        set_features(&image, camera, seen);
        goe_flight_slot_bearings_of(seen, camera, view->pose.q, &slot->bearings);
    }
    const goe_status_t status = goe_update(&slot->estimator, &image, &estimate);
    if (status == GOE_CORRUPTED || status == GOE_NOT_INITIALIZED) {
        goe_flight_slot_lose(slot);
    }
    const bool taken = GOE_IMAGE_TAKEN(status) != 0;
    if (taken) {
        const float since_s = goe_flight_between_s(view->time_us, slot->taken_us);
        slot->taken_us = view->time_us;
        slot->detected_us = seen ? view->time_us : slot->detected_us;
        slot->reset_count = image.pose.reset_count;
        slot->camera = number;
        memcpy(slot->jumps_ned_m, jumps_ned_m, sizeof slot->jumps_ned_m);
        slot->fresh_track = false;
        note(slot, camera_ned_m, &estimate, since_s);
        if (seen) {
            (void)goe_flight_slot_box_of(seen, slot->box_px);
        }
    }
    note_located(slot, camera, view, seen);
}

/* ------------------------------------------------------------------------------------------------------------ claims -- */

static void widen(float extent[4], float u, float v, bool *any) {
    extent[0] = *any ? goe_flight_smaller(extent[0], u) : u;
    extent[1] = *any ? goe_flight_smaller(extent[1], v) : v;
    extent[2] = *any ? goe_flight_larger(extent[2], u) : u;
    extent[3] = *any ? goe_flight_larger(extent[3], v) : v;
    *any = true;
}

/* Left, top, right and bottom of its box, or of its points; false: it has none. */
static bool extent_of(const goe_flight_detection_t *detection, float extent[4]) {
    const goe_pixel_t *const points[6] = {&detection->left,      &detection->right,     &detection->top,
                                          &detection->base_left, &detection->base_near, &detection->base_right};
    const goe_box_t *box = &detection->box;
    bool any = false;
    memset(extent, 0, 4 * sizeof extent[0]);
    if (box->sides == GOE_SIDES_ALL) {
        widen(extent, box->left_px, box->top_px, &any);
        widen(extent, box->right_px, box->bottom_px, &any);
        return true;
    }
    for (int i = 0; i < 6; i++) {
        if (goe_flight_is_set(&points[i]->visible)) {
            widen(extent, points[i]->u_px, points[i]->v_px, &any);
        }
    }
    return any;
}

bool goe_flight_slot_box_of(const goe_flight_detection_t *detection, int16_t box_px[4]) {
    float extent[4];
    const bool any = extent_of(detection, extent);
    for (int axis = 0; axis < 2; axis++) { /* two points in one row also get a height */
        const float lacking = 0.5f * goe_flight_larger(SIZE_MIN_PX - (extent[axis + 2] - extent[axis]), 0.0f);
        const float low = goe_flight_clamped(extent[axis] - lacking, -PIXEL_MAX, PIXEL_MAX);
        const float high = goe_flight_clamped(extent[axis + 2] + lacking, -PIXEL_MAX, PIXEL_MAX);
        box_px[axis] = (int16_t)low;
        box_px[axis + 2] = (int16_t)high;
    }
    return any;
}

/* A side that the detection's box lacks is at the image's border. */
void goe_flight_slot_bearings_of(const goe_flight_detection_t *detection, const goe_flight_camera_t *camera,
                                 const float q[4], goe_flight_bearings_t *bearings) {
    const goe_box_t *box = &detection->box;
    float extent[4];
    if ((box->sides != 0u && box->sides != GOE_SIDES_ALL) || !extent_of(detection, extent)) {
        extent[0] = (box->sides & GOE_SIDE_LEFT) != 0u ? box->left_px : 0.0f;
        extent[1] = (box->sides & GOE_SIDE_TOP) != 0u ? box->top_px : 0.0f;
        extent[2] = (box->sides & GOE_SIDE_RIGHT) != 0u ? box->right_px : camera->size_px[0];
        extent[3] = (box->sides & GOE_SIDE_BOTTOM) != 0u ? box->bottom_px : camera->size_px[1];
    }
    goe_flight_geometry_bearings(camera, q, extent, bearings);
}

static bool matches(const int16_t a[4], const int16_t b[4]) {
    bool similar = true;
    for (int axis = 0; axis < 2; axis++) {
        const float one = (float)(a[axis + 2] - a[axis]);
        const float other = (float)(b[axis + 2] - b[axis]);
        similar = similar && one <= ALIKE * other && other <= ALIKE * one;
    }
    return similar;
}

static float px_per_m_of(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera,
                         const goe_flight_history_pose_t *pose) {
    const float north_m = slot->center_ne_m[0] - pose->ned_m[0];
    const float east_m = slot->center_ne_m[1] - pose->ned_m[1];
    const float away_m = sqrtf(goe_flight_square(north_m) + goe_flight_square(east_m));
    return camera->focal_px[0] / goe_flight_larger(away_m, AWAY_MIN_M);
}

/* Overlap of a box with the outline in this view: the circle around the axis at its base, its middle and its top, as far as the image
 * contains it. A rolled camera's image of a mast is wide, and the border cuts an obstacle that comes back into view. */
static float overlap_of(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera,
                        const goe_flight_history_pose_t *pose, float px_per_m, const int16_t box_px[4]) {
    const float half_px = px_per_m * goe_flight_slot_radius_m(slot);
    float extent[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    bool any = false;
    int16_t outline_px[4];
    for (int k = 0; k < 3; k++) {
        float pixel[2];
        if (predict_at(slot, camera, pose, 0.5f * (float)k, pixel)) {
            widen(extent, pixel[0] - half_px, pixel[1] - half_px, &any);
            widen(extent, pixel[0] + half_px, pixel[1] + half_px, &any);
        }
    }
    for (int i = 0; i < 4; i++) {
        const float inside = goe_flight_clamped(extent[i], 0.0f, camera->size_px[i % 2]);
        outline_px[i] = (int16_t)inside;
    }
    return any ? goe_flight_candidate_overlap(outline_px, box_px) : 0.0f;
}

/* Whether a box of another camera is about as wide as the outline in this view. From any side, an outline is at most as wide as the circle
 * around it. The image border may hide a part of the box. */
static bool is_as_wide(const goe_flight_slot_t *slot, const goe_flight_camera_t *camera, float px_per_m,
                       const int16_t box_px[4]) {
    const float box = (float)(box_px[2] - box_px[0]);
    const float circle = goe_flight_larger(2.0f * px_per_m * goe_flight_slot_radius_m(slot), SIZE_MIN_PX);
    const bool cut =
        (float)box_px[0] <= camera->border_px || (float)box_px[2] >= camera->size_px[0] - camera->border_px;
    return (slot->valid & GOE_HAS_WIDTH) != 0u && box <= ALIKE * circle &&
           (cut || px_per_m * slot->width_m <= ALIKE * box);
}

/* Of an obstacle with a position: the overlap with its outline, or else how near the middle of the box its place is. */
float goe_flight_slot_claims(const goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                             const goe_flight_slot_view_t *view, const int16_t box_px[4]) {
    float pixel[2];
    const goe_flight_camera_t *camera = &cameras[view->camera];
    const bool comparable = slot->camera == view->camera; /* boxes of two cameras are not comparable */
    if (!(slot->valid & GOE_HAS_POSITION)) {
        const float overlap = goe_flight_candidate_overlap(slot->box_px, box_px);
        return comparable && overlap >= OVERLAP_MIN ? overlap : 0.0f;
    }
    const float px_per_m = px_per_m_of(slot, camera, &view->pose);
    const float overlap =
        (slot->valid & GOE_HAS_WIDTH) != 0u ? overlap_of(slot, camera, &view->pose, px_per_m, box_px) : 0.0f;
    if (overlap >= OVERLAP_MIN) {
        return overlap;
    }
    const bool alike = comparable ? matches(slot->box_px, box_px) : is_as_wide(slot, camera, px_per_m, box_px);
    if (!alike || !predict(slot, camera, &view->pose, pixel)) {
        return 0.0f;
    }
    float claim = 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        const float half = (0.5f + AROUND) * (float)(box_px[axis + 2] - box_px[axis]);
        const float middle = 0.5f * (float)(box_px[axis + 2] + box_px[axis]);
        const float off = goe_flight_absolute(pixel[axis] - middle) / goe_flight_larger(half, 1.0f);
        claim *= goe_flight_larger(1.0f - off, 0.0f);
    }
    return claim;
}
