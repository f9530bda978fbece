/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "image_features.h"

#include <math.h>
#include <string.h>

#define TANGENT_STEPS 32   /* a touching line is searched for its visible stretch at this many steps over its height */
#define CLOUD_AZIMUTHS 120 /* 3 degrees: at most r (1 - cos 1.5 deg) = 0.03 % of the radius is lost at an edge */
#define CLOUD_LEVELS 5     /* rings of the cloud, base and roof among them */

const char *const FEATURE_NAMES[FEATURE_COUNT] = {"left", "right", "top", "base_left", "base_near", "base_right"};

int features_logged(log_features_t logged) {
    return logged == LOG_CORNERS ? FEATURE_COUNT : logged == LOG_POINTS ? FEATURE_TOP + 1 : 0;
}

typedef struct {
    const camera_t *camera;
    const view_t *view;
} eye_t;

/* Running extremes of a set of image points. */
typedef struct {
    feature_t left, right;
} extent_t;

static feature_t see(const eye_t *eye, vec3_t point) {
    feature_t feature = {0.0, 0.0, false};
    double u, v;
    if (camera_project(eye->camera, eye->view, point, &u, &v) && camera_in_image(eye->camera, u, v)) {
        feature.u_px = u;
        feature.v_px = v;
        feature.seen = true;
    }
    return feature;
}

static extent_t extent_empty(void) {
    extent_t extent = {{HUGE_VAL, 0.0, false}, {-HUGE_VAL, 0.0, false}};
    return extent;
}

static void extent_include(extent_t *extent, const eye_t *eye, vec3_t point) {
    feature_t image;
    /* a point without an image lies beyond the left or the right margin: +-HUGE_VAL makes that side invisible */
    (void)camera_project(eye->camera, eye->view, point, &image.u_px, &image.v_px);
    image.seen = camera_in_image(eye->camera, image.u_px, image.v_px);
    if (image.u_px < extent->left.u_px) {
        extent->left = image;
    }
    if (image.u_px > extent->right.u_px) {
        extent->right = image;
    }
}

static void set_silhouette(features_t *features, feature_t left, feature_t right) {
    const feature_t unseen = {0.0, 0.0, false};
    const double width = right.u_px - left.u_px;
    features->width_px = isfinite(width) && width > 0.0 ? width : 0.0;
    features->feature[FEATURE_LEFT] = left.seen ? left : unseen;
    features->feature[FEATURE_RIGHT] = right.seen ? right : unseen;
}

static void project_box(features_t *features, const obstacle_t *box, const eye_t *eye) {
    extent_t extent = extent_empty();
    for (int k = 0; k < 8; k++) {
        extent_include(&extent, eye, obstacle_corner(box, k & 3, k >= 4));
    }
    set_silhouette(features, extent.left, extent.right);

    const vec3_t position = eye->view->eye_ned_m;
    features->feature[FEATURE_TOP] = see(eye, obstacle_corner(box, obstacle_nearest_corner(box, position), true));

    int left, near, right;
    if (obstacle_visible_base(box, position, &left, &near, &right) > 0) {
        features->feature[FEATURE_BASE_LEFT] = see(eye, obstacle_corner(box, left, false));
        features->feature[FEATURE_BASE_RIGHT] = see(eye, obstacle_corner(box, right, false));
        if (near >= 0) {
            features->feature[FEATURE_BASE_NEAR] = see(eye, obstacle_corner(box, near, false));
        }
    }
}

/* The middle of the part of an upright line on the wall that lies in the image. Without lens distortion the part is one
 * stretch; with it, its middle is looked at once more. */
static feature_t see_line(const eye_t *eye, const obstacle_t *cylinder, double azimuth) {
    int first = -1, last = -1;
    for (int i = 0; i <= TANGENT_STEPS; i++) {
        const double height = cylinder->height_m * (double)i / TANGENT_STEPS;
        if (see(eye, obstacle_cylinder_point(cylinder, azimuth, height)).seen) {
            first = first < 0 ? i : first;
            last = i;
        }
    }
    const double middle = cylinder->height_m * (double)(first + last) / (2.0 * TANGENT_STEPS);
    feature_t feature = see(eye, obstacle_cylinder_point(cylinder, azimuth, middle));
    feature.seen = feature.seen && first >= 0;
    return feature;
}

static void project_tangents(features_t *features, const obstacle_t *cylinder, const eye_t *eye) {
    const vec3_t position = eye->view->eye_ned_m;
    double left, right;
    if (obstacle_tangent_azimuths(cylinder, position, &left, &right)) {
        set_silhouette(features, see_line(eye, cylinder, left), see_line(eye, cylinder, right));
    }
    if (!features->feature[FEATURE_LEFT].seen || !features->feature[FEATURE_RIGHT].seen) {
        features->width_px = 0.0;
    }
    features->feature[FEATURE_TOP] =
        see(eye, obstacle_cylinder_point(cylinder, obstacle_azimuth_to(cylinder, position), cylinder->height_m));
}

static void project_cloud(features_t *features, const obstacle_t *cylinder, const eye_t *eye) {
    const double to_eye = obstacle_azimuth_to(cylinder, eye->view->eye_ned_m);
    extent_t extent = extent_empty();
    double best_cosine = -2.0;
    vec3_t top = {0.0, 0.0, 0.0};
    for (int k = 0; k < CLOUD_AZIMUTHS; k++) {
        const double azimuth = 2.0 * SIM_PI * (double)k / CLOUD_AZIMUTHS;
        /* one point of the wall, then the rings above it: sine and cosine are taken once */
        vec3_t point = obstacle_cylinder_point(cylinder, azimuth, 0.0);
        for (int level = 0; level < CLOUD_LEVELS; level++) {
            point.z = cylinder->ground_d_m - cylinder->height_m * (double)level / (CLOUD_LEVELS - 1);
            extent_include(&extent, eye, point);
        }
        if (cos(azimuth - to_eye) > best_cosine) {
            best_cosine = cos(azimuth - to_eye);
            top = point;
        }
    }
    set_silhouette(features, extent.left, extent.right);
    features->feature[FEATURE_TOP] = see(eye, top);
}

features_t features_project(const obstacle_t *obstacle, cylinder_model_t cylinder_model, const camera_t *camera,
                            const view_t *view) {
    const eye_t eye = {camera, view};
    features_t features;
    memset(&features, 0, sizeof features);
    if (obstacle_contains(obstacle, view->eye_ned_m)) {
        return features;
    }
    if (obstacle->kind == OBSTACLE_BOX) {
        project_box(&features, obstacle, &eye);
    } else if (cylinder_model == CYLINDER_TANGENT) {
        project_tangents(&features, obstacle, &eye);
    } else {
        project_cloud(&features, obstacle, &eye);
    }
    return features;
}
