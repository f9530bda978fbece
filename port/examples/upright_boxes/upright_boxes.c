/* The boxes of a real detector: whole pixels, images in which it sees nothing, weak detections, a tracker's number that changes,
 * a rolling aircraft, and a box that the image's border cuts. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "goe.h"

/* ------------------------------------------------------------------------------------- what the detector's link delivers -- */

typedef struct {
    uint32_t track; /* number of the detector's tracker */
    float score;    /* 0 to 1 */
    float left_px, top_px, right_px, bottom_px;
} detection_t;

/* ------------------------------------------------------------------------------------------------------------ the world -- */

#define FOCAL_PX 600.0f
#define WIDTH_PX 960.0f
#define HEIGHT_PX 720.0f
#define FLYING_HEIGHT_M 30.0f
#define SPEED_M_S 20.0f
#define IMAGE_S 0.1f
#define IMAGE_US 100000
#define IMAGES 84
#define MAST_NORTH_M 180.0f
#define MAST_LEFT_M 6.0f /* east of the path */
#define MAST_RIGHT_M 10.0f
#define MAST_TOP_M 48.0f

static float clamped(float x, float most) { return x < 0.0f ? 0.0f : (x > most ? most : x); }

/* Triangular, +-0.1: the tangent of half the roll angle, so +-11 degrees. */
static float half_roll(int k) {
    const int phase = k % 40;
    return 0.01f * (float)(phase < 20 ? phase - 10 : 30 - phase);
}

static void fly(int k, goe_pose_t *pose) {
    const float t = half_roll(k);
    pose->time_us = (int64_t)k * IMAGE_US;
    pose->position_ned_m[0] = SPEED_M_S * IMAGE_S * (float)k;
    pose->position_ned_m[2] = -FLYING_HEIGHT_M;
    pose->height_m = FLYING_HEIGHT_M;
    pose->attitude[0] = 1.0f / sqrtf(1.0f + t * t);
    pose->attitude[1] = t * pose->attitude[0];
}

/* The smallest upright box about the mast, in whole pixels, cut at the image's border. */
static bool detect(int k, detection_t *detection) {
    const float ahead_m = MAST_NORTH_M - SPEED_M_S * IMAGE_S * (float)k;
    const float t = half_roll(k);
    const float cosine = (1.0f - t * t) / (1.0f + t * t);
    const float sine = 2.0f * t / (1.0f + t * t);
    float least[2] = {1e6f, 1e6f}, most[2] = {-1e6f, -1e6f};
    for (int corner = 0; corner < 4; corner++) {
        const float east_m = (corner & 1) != 0 ? MAST_LEFT_M : MAST_RIGHT_M;
        const float down_m = (corner & 2) != 0 ? FLYING_HEIGHT_M : FLYING_HEIGHT_M - MAST_TOP_M;
        const float px[2] = {0.5f * WIDTH_PX + FOCAL_PX * (cosine * east_m + sine * down_m) / ahead_m,
                             0.5f * HEIGHT_PX + FOCAL_PX * (cosine * down_m - sine * east_m) / ahead_m};
        for (int i = 0; i < 2; i++) {
            least[i] = px[i] < least[i] ? px[i] : least[i];
            most[i] = px[i] > most[i] ? px[i] : most[i];
        }
    }
    if (least[0] >= WIDTH_PX || k % 7 == 3) { /* out of view; one image in seven shows it nothing */
        return false;
    }
    detection->track = k < 50 ? 4u : 9u;
    detection->score = k % 11 == 5 ? 0.2f : 0.8f;
    detection->left_px = floorf(clamped(least[0], WIDTH_PX - 1.0f) + 0.5f);
    detection->top_px = floorf(clamped(least[1], HEIGHT_PX - 1.0f) + 0.5f);
    detection->right_px = floorf(clamped(most[0], WIDTH_PX - 1.0f) + 0.5f);
    detection->bottom_px = floorf(clamped(most[1], HEIGHT_PX - 1.0f) + 0.5f);
    return true;
}

/* --------------------------------------------------------------------------------------------------- what you would write -- */

#define SCORE_MIN 0.3f

static goe_estimator_t mast;
static uint32_t followed; /* the tracker's number; 0: none yet */

/* An image without a detection is an image, too: it ages the estimate. */
static void fill(const detection_t *detection, goe_image_t *image) {
    if (detection == NULL || detection->score < SCORE_MIN) {
        return;
    }
    if (detection->track != followed) {
        /* Another number, another thing: unless you know better. The flight layer does, by the place in the image. */
        (void)goe_reset(&mast);
        followed = detection->track;
    }
    image->box.left_px = detection->left_px;
    image->box.top_px = detection->top_px;
    image->box.right_px = detection->right_px;
    image->box.bottom_px = detection->bottom_px;
    image->box.sides =
        GOE_SIDES_ALL; /* also of a box that the border cuts: the estimator knows it by the size of the image */
}

static void print(int k, goe_status_t status, const goe_estimate_t *now) {
    printf("%3.1f s, %-12s", (double)(IMAGE_S * (float)k), goe_status_text(status));
    if (now->valid & GOE_HAS_POSITION) {
        printf(" %5.1f +- %4.1f m ahead, %4.1f m to the right", (double)now->z_m, (double)now->sigma.z_m,
               (double)now->x_m);
    }
    if (now->valid & GOE_HAS_WIDTH) {
        printf(", %3.1f +- %3.1f m wide", (double)now->width_m, (double)now->sigma.width_m);
    }
    if (now->valid & GOE_HAS_HEIGHT) {
        printf(", %2.0f +- %2.0f m high", (double)now->height_m, (double)now->sigma.height_m);
    }
    if (now->age_s > 0.0f) {
        printf(", %.1f s old", (double)now->age_s);
    }
    printf("%s%s\n", now->suspect ? ", suspect: " : "", now->suspect ? goe_reason_text(now->reason) : "");
}

int main(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = 0.5f * WIDTH_PX;
    settings.camera.cy_px = 0.5f * HEIGHT_PX;
    settings.camera.width_px = WIDTH_PX; /* needed for boxes that the border cuts */
    settings.camera.height_px = HEIGHT_PX;
    settings.detector.box_noise_px = 1.0f; /* whole pixels and some */
    settings.detector.box_noise_rel =
        0.02f; /* this detector's sides stay off by 2 % of the box; leave 0.07 if you do not know */
    if (goe_init(&mast, sizeof mast, &settings, NULL) != GOE_OK) {
        return 1;
    }
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image = {0};
        goe_estimate_t now;
        detection_t detection;
        fly(k, &image.pose);
        fill(detect(k, &detection) ? &detection : NULL, &image);
        const goe_status_t status = goe_update(&mast, &image, &now);
        if (k % 6 == 3) {
            print(k, status, &now);
        }
    }
    return 0;
}
