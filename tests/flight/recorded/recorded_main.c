/* The cost of interpolation on recorded flights of real autopilots. SPDX-License-Identifier: MIT
 *
 *   flight_recorded FILE...
 *
 * Masts stand along each flight. The camera uses the true pose; the estimator gets the autopilot's estimate: at
 * the very time of each image, or as the flight layer finds it 100 ms later between samples so far apart; or late by so much, with
 * the clock's uncertainty given or not. For each: the median distance of the estimate from the truth along the line of sight when
 * the mast is 70 m ahead, and how often two of its sigmas cover it. Once with the shape configured as round, as the masts are, and once
 * with the default, which knows no shape.
 *
 * Exit status: 0 if interpolation stays within its share of the exact time's median (SHARE_MAX, and SHARE_COARSE_MAX for samples
 * 200 ms apart), and poses late by 20 and by 100 ms, with a given uncertainty, cover the truth as often as required, or as the exact time
 * does; 1 otherwise; 77 if there is no such file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera_model.h"
#include "goe_flight.h"
#include "image_features.h"
#include "obstacle.h"
#include "random.h"
#include "recorded_flight.h"

#define IMAGE_MIN_S 0.05
#define ARRIVAL_S 0.1 /* after the exposure: samples up to then are known */
#define PLACES 200    /* along a flight, with a mast on each side at two distances */
#define FIRST_S 12.0  /* of the recording: abeam of the first mast */
#define FIRST_M 170.0
#define WANTED_M 70.0
#define MASTS_MAX 4096
#define PIXEL_PX 1.0
#define STREAM_RECORDED 200
#define SHARE_MAX 1.05
#define SHARE_COARSE_MAX                                                                                               \
    1.25 /* half of the images of a flight that pitches by 24 degrees a second, rms, are hardly informative then */
#define COARSE_S 0.15
#define COVERED_MIN 0.88
#define COVERED_RESOLVED 0.03 /* by the masts along the shorter flight */
#define EXIT_SKIPPED 77

typedef struct {
    double gap_s;       /* between samples; 0: the pose at the very time */
    double late_s;      /* the pose is that of so much later */
    uint32_t report_us; /* one sigma of the time */
    const char *name;
} way_t;

typedef struct {
    double error_m[MASTS_MAX];
    int masts, covered;
} tally_t;

#define ASIDES 4u
static const double asides_m[ASIDES] = {-20.0, -10.0, 10.0, 20.0};

static goe_estimator_t estimator;
static goe_flight_t flight;

static double ground_distance(vec3_t a, const obstacle_t *o) { return hypot(a.x - o->center_n_m, a.y - o->center_e_m); }

/* What a user would state of these autopilots. PX4's attitude wanders. */
static goe_settings_t settings_of(const camera_t *camera, bool wanders, bool round) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.navigation.attitude_bias_sd_deg = wanders ? 1.0f : 0.5f;
    settings.navigation.attitude_white_sd_deg = wanders ? 0.3f : 0.1f;
    settings.navigation.attitude_walk_sd_deg = wanders ? 0.5f : 0.0f;
    settings.camera.fx_px = (float)camera->fx_px;
    settings.camera.fy_px = (float)camera->fy_px;
    settings.camera.cx_px = (float)camera->cx_px;
    settings.camera.cy_px = (float)camera->cy_px;
    settings.camera.width_px = (float)camera->width_px;
    settings.camera.height_px = (float)camera->height_px;
    settings.detector.point_noise_px = (float)PIXEL_PX;
    settings.model = round ? GOE_MODEL_DISC : GOE_MODEL_AUTO;
    return settings;
}

static void to_floats(const pose_t *pose, float ned_m[3], float q[4]) {
    ned_m[0] = (float)pose->position_ned_m.x;
    ned_m[1] = (float)pose->position_ned_m.y;
    ned_m[2] = (float)pose->position_ned_m.z;
    q[0] = (float)pose->attitude.w;
    q[1] = (float)pose->attitude.x;
    q[2] = (float)pose->attitude.y;
    q[3] = (float)pose->attitude.z;
}

static void give_sample(const recorded_flight_t *recording, double t_s) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    const recorded_pose_t at = recorded_flight_at(recording, t_s);
    memset(&attitude, 0, sizeof attitude);
    memset(&position, 0, sizeof position);
    attitude.time_us = position.time_us = (uint32_t)llround(1e6 * t_s);
    to_floats(&at.estimated, position.position_ned_m, attitude.q);
    (void)goe_flight_attitude(&flight, &attitude);
    (void)goe_flight_position(&flight, &position);
}

/* The pose for an image at t_s. Samples come up to the first one behind it. */
static bool find_pose(const recorded_flight_t *recording, const way_t *way, double t_s, double *sampled_s,
                      goe_pose_t *pose, float *sd_deg) {
    const double wanted_s = t_s + way->late_s;
    const double gap_s = way->gap_s > 0.0 ? way->gap_s : 0.02;
    while (*sampled_s < wanted_s || *sampled_s + gap_s <= t_s + ARRIVAL_S + 1e-6) {
        *sampled_s += gap_s;
        give_sample(recording, *sampled_s);
    }
    const uint32_t question_us = (uint32_t)llround(1e6 * wanted_s);
    if (goe_flight_pose(&flight, question_us, way->report_us, pose, sd_deg) != GOE_FLIGHT_OK) {
        return false;
    }
    if (!(way->gap_s > 0.0)) {
        const recorded_pose_t at = recorded_flight_at(recording, wanted_s);
        to_floats(&at.estimated, pose->position_ned_m, pose->attitude);
    }
    pose->time_us = llround(1e6 * t_s);
    return true;
}

static goe_pixel_t pixel_of(const feature_t *feature, random_t *random) {
    goe_pixel_t pixel;
    const double du = PIXEL_PX * random_normal(random), dv = PIXEL_PX * random_normal(random);
    pixel.u_px = (float)(feature->u_px + du);
    pixel.v_px = (float)(feature->v_px + dv);
    pixel.visible = feature->seen;
    return pixel;
}

static bool begins_anew(const recorded_flight_t *recording, const goe_settings_t *settings, double from_s,
                        const way_t *way, double *sampled_s) {
    if (goe_init(&estimator, sizeof estimator, settings, NULL) != GOE_OK ||
        goe_flight_init(&flight, sizeof flight, settings, NULL, NULL) != GOE_FLIGHT_OK) {
        return false;
    }
    /* samples where the recording has rows: nothing is interpolated twice */
    const double grid_s = way->gap_s > 0.0 ? way->gap_s : 0.02;
    *sampled_s = grid_s * floor(from_s / grid_s);
    give_sample(recording, *sampled_s);
    return true;
}

/* Flies past the mast abeam of the aircraft's position at abeam_s. */
static void fly(const recorded_flight_t *recording, bool wanders, bool round, const way_t *way, double abeam_s,
                uint64_t seed, tally_t *tally) {
    camera_t camera = camera_default();
    camera.mount_yaw_deg = 0.0;
    camera_prepare(&camera);
    const goe_settings_t settings = settings_of(&camera, wanders, round);
    random_t random = random_start(seed, STREAM_RECORDED);
    obstacle_t mast;
    const recorded_pose_t abeam = recorded_flight_at(recording, abeam_s);
    const recorded_pose_t before = recorded_flight_at(recording, abeam_s - 1.0);
    const vec3_t way_m = vec3_sub(abeam.truth.position_ned_m, before.truth.position_ned_m);
    const double course = atan2(way_m.y, way_m.x), side = asides_m[seed % ASIDES];
    (void)obstacle_parse("disc:6,30", &mast);
    obstacle_place(&mast, abeam.truth.position_ned_m.x - side * sin(course),
                   abeam.truth.position_ned_m.y + side * cos(course), abeam.truth.position_ned_m.z + 12.0, 0.0);
    /* images are rows of the recording: between them the truth is a straight line, which no aircraft flies */
    const double row_s = recorded_flight_duration(recording) / (double)(recording->count - 1);
    const double image_s = row_s * ceil(IMAGE_MIN_S / row_s - 1e-6);
    double t_s = image_s * floor((abeam_s > 31.0 ? abeam_s - 30.0 : 1.0) / image_s);
    while (t_s < abeam_s && ground_distance(recorded_flight_at(recording, t_s).truth.position_ned_m, &mast) > FIRST_M) {
        t_s += image_s;
    }
    double sampled_s;
    if (!begins_anew(recording, &settings, t_s, way, &sampled_s)) {
        return;
    }
    for (; t_s < abeam_s; t_s += image_s) {
        goe_image_t image;
        goe_estimate_t estimate;
        memset(&image, 0, sizeof image);
        const pose_t truth = recorded_flight_at(recording, t_s).truth;
        const view_t view = camera_view(&camera, &truth);
        const features_t seen = features_project(&mast, CYLINDER_TANGENT, &camera, &view);
        if (!find_pose(recording, way, t_s, &sampled_s, &image.pose, &image.noise.attitude_sd_deg)) {
            continue;
        }
        image.pose.height_m = (float)mast.ground_d_m - image.pose.position_ned_m[2];
        image.left = pixel_of(&seen.feature[FEATURE_LEFT], &random);
        image.right = pixel_of(&seen.feature[FEATURE_RIGHT], &random);
        image.top = pixel_of(&seen.feature[FEATURE_TOP], &random);
        (void)goe_update(&estimator, &image, &estimate);
        const double north = mast.center_n_m - truth.position_ned_m.x, east = mast.center_e_m - truth.position_ned_m.y;
        const double range_m = hypot(north, east);
        if (range_m > WANTED_M || !(estimate.valid & GOE_HAS_CENTER)) {
            continue;
        }
        /* relative to where the aircraft believes to be */
        const double believed_n = (double)(estimate.center_north_m - image.pose.position_ned_m[0]);
        const double believed_e = (double)(estimate.center_east_m - image.pose.position_ned_m[1]);
        const double error_m = ((believed_n - north) * north + (believed_e - east) * east) / range_m;
        const double sd_m = hypot((double)estimate.sigma.x_m, (double)estimate.sigma.z_m);
        tally->error_m[tally->masts++] = fabs(error_m);
        tally->covered += fabs(error_m) <= 2.0 * sd_m ? 1 : 0;
        return;
    }
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(tally_t *tally) {
    qsort(tally->error_m, (size_t)tally->masts, sizeof tally->error_m[0], compare);
    return tally->masts > 0 ? tally->error_m[tally->masts / 2] : (double)NAN;
}

static tally_t fly_all(const recorded_flight_t *recording, bool wanders, bool round, const way_t *way) {
    tally_t tally;
    memset(&tally, 0, sizeof tally);
    const double end_s = recorded_flight_duration(recording) - 1.0;
    const double step_s = (end_s - FIRST_S) / PLACES;
    for (uint64_t k = 0; k < ASIDES * PLACES; k++) {
        fly(recording, wanders, round, way, FIRST_S + step_s * (double)(k / ASIDES), k, &tally);
    }
    return tally;
}

static const way_t ways[] = {
    {0.0, 0.0, 1000u, "exact time"},
    {0.04, 0.0, 1000u, "samples 40 ms apart"},
    {0.1, 0.0, 1000u, "samples 100 ms apart"},
    {0.2, 0.0, 1000u, "samples 200 ms apart"},
    {0.04, 0.02, 1000u, "20 ms late, not configured"},
    {0.04, 0.02, 20000u, "20 ms late, configured"},
    {0.04, 0.1, 100000u, "100 ms late, configured"},
};

static int judge_shape(const recorded_flight_t *recording, bool wanders, bool round) {
    int bad = 0;
    double exact_m = 0.0, exact_covered = 1.0;
    const double row_s = recorded_flight_duration(recording) / (double)(recording->count - 1);
    printf("shape %s\n", round ? "configured as round" : "not configured");
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        const way_t *way = &ways[i];
        if (way->gap_s > 0.0 && way->gap_s < 0.9 * row_s && !(way->late_s > 0.0)) {
            continue; /* the recording has no such samples */
        }
        tally_t tally = fly_all(recording, wanders, round, way);
        const double middle_m = median(&tally), covered = (double)tally.covered / tally.masts;
        printf("%-24s %4d masts: median %6.3f m, 90 %% %6.3f m, two sigmas cover %5.1f %%\n", way->name, tally.masts,
               middle_m, tally.error_m[(int)(0.9 * tally.masts)], 100.0 * covered);
        exact_m = i == 0 ? middle_m : exact_m;
        exact_covered = i == 0 ? covered : exact_covered;
        const bool interpolated = way->gap_s > 0.0 && !(way->late_s > 0.0);
        const bool reported = way->late_s > 0.0 && way->report_us > 1000u;
        const double share_max = way->gap_s > COARSE_S ? SHARE_COARSE_MAX : SHARE_MAX;
        bad += interpolated && !(middle_m <= share_max * exact_m) ? 1 : 0;
        bad += reported && !(covered >= fmin(COVERED_MIN, exact_covered - COVERED_RESOLVED)) ? 1 : 0;
    }
    return bad;
}

static int judge(const char *path) {
    recorded_flight_t recording;
    input_error_t error;
    if (!recorded_flight_read(path, &recording, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    const bool wanders = strstr(path, "px4") != NULL;
    const int bad = judge_shape(&recording, wanders, true) + judge_shape(&recording, wanders, false);
    recorded_flight_free(&recording);
    return bad;
}

int main(int argc, char **argv) {
    int bad = 0;
    for (int i = 1; i < argc; i++) {
        FILE *file = fopen(argv[i], "r");
        if (file == NULL) {
            printf("skipped: no file %s (GOE_FLIGHTS_DIR names their folder)\n", argv[i]);
            return EXIT_SKIPPED;
        }
        (void)fclose(file);
        printf("%s\n", argv[i]);
        bad += judge(argv[i]);
    }
    return bad > 0 ? 1 : 0;
}
