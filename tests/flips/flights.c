/* Flights. SPDX-License-Identifier: MIT */
#include "flights.h"

#include "scene.h"

void setUp(void);
void tearDown(void);
void setUp(void) {} /* required by the scene code shared with the unit tests */
void tearDown(void) {}

#define NOISE_PX 0.5
#define FINE_HZ 80.0 /* of a scene, of which every tenth image is used */
#define STEP 10

typedef struct {
    const char *name;
    bool window, corners, boxes, cylinder, second_camera;
    int late; /* delay of the pose in images of the fine rate */
    double north_m_s, east_m_s;
} kind_t;

static const kind_t kinds[] = {
    {"window, disc", true, false, false, true, false, 0, 0.0, 0.0},
    {"window, line", true, true, false, false, false, 0, 0.0, 0.0},
    {"filter, disc", false, false, false, true, false, 0, 0.0, 0.0},
    {"filter, base corners", false, true, false, false, false, 0, 0.0, 0.0},
    {"filter, upright boxes", false, false, true, true, false, 0, 0.0, 0.0},
    {"filter, moves, late poses", false, true, false, false, false, 4, 0.0, 5.0},
    {"filter, two cameras", false, true, false, false, true, 0, 0.0, 0.0},
};

static void set_scene(const kind_t *kind, scene_t *scene) {
    scene_default(scene);
    scene->image_rate_hz = FINE_HZ;
    scene->wobble_deg = 3.0;
    scene->z0_m = 240.0;
    scene->alpha_deg = 20.0;
    scene->boxes = kind->boxes;
    if (kind->cylinder) {
        scene_make_cylinder(scene);
    }
}

static void add_box_noise(goe_box_t *box, check_random_t *random) {
    float *const sides[] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    for (int i = 0; i < 4; i++) {
        *sides[i] += (float)(NOISE_PX * check_random_normal(random));
    }
}

static void take_out_corners(goe_image_t *image) {
    image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
}

static void set_settings(const kind_t *kind, const scene_t *scene, goe_settings_t *settings) {
    *settings = kind->window ? scene_window_settings(scene) : scene_settings(scene);
#if GOE_CAMERAS_MAX > 1
    if (kind->second_camera) {
        settings->more_cameras[0] = scene->camera;
        settings->more_cameras[0].mount_yaw_deg = -6.0f;
    }
#endif
}

/* A moving obstacle is simulated by poses of an aircraft displaced against its motion. */
static void move_pose(const kind_t *kind, const scene_t *scene, int fine, goe_image_t *image) {
    goe_image_t before;
    const double t = fine / FINE_HZ;
    scene_image(scene, fine - kind->late, &before, NULL);
    before.pose.time_us = image->pose.time_us;
    image->pose = before.pose;
    image->pose.position_ned_m[0] += (float)(kind->north_m_s * t);
    image->pose.position_ned_m[1] += (float)(kind->east_m_s * t);
}

bool flights_make(int which, flipped_flight_t *flight) {
    scene_t scene;
    check_random_t random = {4711u};
    if (which < 0 || which >= (int)(sizeof kinds / sizeof kinds[0])) {
        return false;
    }
    const kind_t *kind = &kinds[which];
    set_scene(kind, &scene);
    flight->name = kind->name;
    set_settings(kind, &scene, &flight->settings);
    flight->intent = (goe_intent_t){{16.0f, 0.0f, 0.0f}, 15.0f, 10.0f, 0.1f, 0.0f};
    for (int k = 0; k < FLIGHT_IMAGES; k++) {
        goe_image_t *image = &flight->image[k];
        scene_t displaced = scene;
        const int fine = 20 + STEP * k;
        const bool second = kind->second_camera && k % 2 == 1;
        displaced.camera.mount_yaw_deg = second ? -6.0f : 0.0f;
        scene_image(&displaced, fine, image, NULL);
        move_pose(kind, &displaced, fine, image);
        image->camera = second ? 1u : 0u;
        scene_add_noise(image, &random, NOISE_PX);
        add_box_noise(&image->box, &random);
        if (!kind->corners) {
            take_out_corners(image);
        }
    }
    return true;
}
