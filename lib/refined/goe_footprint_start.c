/* The start of a footprint from the first image: axes, range, state and sigmas. SPDX-License-Identifier: MIT */
#include "refined/goe_footprint_start.h"

#include <math.h>
#include <string.h>

#include "image/goe_camera.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_ground.h"
#include "refined/goe_kind.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define RAY_AHEAD_MIN 0.02f /* least third component of a ray to the obstacle */
#define GROUND_SIGMAS 3.0f  /* sigmas by which the foot must be below the horizon to give the range */
#define FOOT_SHARE 0.6f     /* share of box_noise_rel times the width in that sigma */
#define NEAR_SIDE 0.5f      /* a box's foot is nearer than the middle by half the width */
#define CUT_MAX 0.3f     /* largest width of a starting box with one side missing: the border has not cut a wider one */
#define RANGE_MIN_M 1.0f /* least range at the start */
#define FARTHER_MAX 5.0f /* factor by which a class may place the obstacle farther than the settings */
#define RANGE_MAX_M 1.0e6f    /* largest range at the start */
#define NO_ALTIMETER_M 50.0f  /* sigma of the height above which the first image sets the ground by the foot */
#define HALF_FREEDOM 2.5f     /* prior sigma of the half width, in widths */
#define SHEAR_FREEDOM 0.6f    /* prior sigma of the shear, in half widths */
#define DEPTH_FREEDOM 1.0f    /* prior sigma of the log of the depth: masts, cars and houses, in any direction */
#define ROUND_FREEDOM 1.0e-3f /* the same for a round obstacle */
#define ROUND_SHEAR 0.02f     /* prior sigma of its shear, in half widths: enough to show that it is no disc */
#define GROUND_MIN 1.0e-6f    /* least sigma of the ground's offset, units of Z0 */
#define BOX_SIZE_MIN 1.0e-12f /* least angular size of a box: a smaller one gives no range */

/* Aligned ray, in the state's axes, of the raw point (x, y) focal lengths. False if it does not point ahead. */
static bool ray_of(const goe_camera_t *camera, const float camera_to_axes[9], float x, float y, goe_point_t *ray) {
    float undistorted[2] = {x, y};
    if (goe_camera_distorts(camera) && !goe_camera_undistort(camera, &undistorted[0], &undistorted[1])) {
        return false;
    }
    const float *r = camera_to_axes;
    const float z = r[6] * undistorted[0] + r[7] * undistorted[1] + r[8];
    ray->usable = z > RAY_AHEAD_MIN;
    const float ahead = ray->usable ? z : 1.0f;
    ray->x = (r[0] * undistorted[0] + r[1] * undistorted[1] + r[2]) / ahead;
    ray->y = (r[3] * undistorted[0] + r[4] * undistorted[1] + r[5]) / ahead;
    return ray->usable;
}

/* Whether a box shows the obstacle's direction: left or right is enough, as the visible part ends at the image's border. */
static bool shows_box(const goe_sides_t *sides) { return (sides->usable & (GOE_SIDE_LEFT | GOE_SIDE_RIGHT)) != 0u; }

/* Middle of the visible part of the box. Returns its width, focal lengths. */
static float middle_of(const goe_camera_t *camera, const goe_sides_t *sides, float *x, float *y) {
    const float left = goe_touch_coordinate(camera, sides, GOE_BOX_LEFT);
    const float right = goe_touch_coordinate(camera, sides, GOE_BOX_RIGHT);
    *x = 0.5f * (left + right);
    *y = goe_sides_see(sides, GOE_SIDE_TOP | GOE_SIDE_BOTTOM)
             ? 0.5f * (goe_touch_coordinate(camera, sides, GOE_BOX_TOP) +
                       goe_touch_coordinate(camera, sides, GOE_BOX_BOTTOM))
             : 0.0f;
    return right - left;
}

/* x of the ray to the obstacle. */
static bool find_middle(const goe_view_t *view, float *x) {
    goe_feature_t left;
    goe_feature_t right;
    if (shows_box(&view->sides)) {
        goe_point_t ray;
        float at_x;
        float at_y;
        (void)middle_of(view->camera, &view->sides, &at_x, &at_y);
        const bool ahead = ray_of(view->camera, view->camera_to_trajectory, at_x, at_y, &ray);
        *x = ray.x;
        return ahead;
    }
    if (!goe_observation_ends(view->point, &left, &right)) {
        return false;
    }
    const float left_x = view->point[left].x;
    const float right_x = view->point[right].x;
    const float to_left = 1.0f / sqrtf(1.0f + goe_square(left_x)); /* cosines from Z */
    const float to_right = 1.0f / sqrtf(1.0f + goe_square(right_x));
    *x = (left_x * to_left + right_x * to_right) / (to_left + to_right);
    return true;
}

bool goe_footprint_face(goe_filter_t *filter, const goe_view_t *view) {
    float x;
    if (!find_middle(view, &x)) {
        return false;
    }
    const float norm = sqrtf(1.0f + x * x);
    goe_filter_turn_axes(filter, 1.0f / norm, x / norm);
    return true;
}

/* What a first image shows: the angular width, and the rays to head and foot. */
typedef struct {
    float size;
    goe_point_t head, foot;
    bool box; /* measured by an upright box */
    bool cut; /* the image's border hides the left or the right end of the box */
} sight_t;

static void see_box(const goe_observation_t *obs, sight_t *sight) {
    const goe_camera_t *camera = obs->camera;
    const goe_sides_t *sides = obs->sides;
    float x;
    float y;
    const float width = middle_of(camera, sides, &x, &y);
    if (goe_sides_see(sides, GOE_SIDE_TOP)) {
        (void)ray_of(camera, obs->camera_to_axes, x, goe_touch_coordinate(camera, sides, GOE_BOX_TOP), &sight->head);
    }
    if (goe_sides_see(sides, GOE_SIDE_BOTTOM)) {
        (void)ray_of(camera, obs->camera_to_axes, x, goe_touch_coordinate(camera, sides, GOE_BOX_BOTTOM), &sight->foot);
    }
    sight->size = width / (1.0f + x * x);
    sight->box = true;
    sight->cut = !goe_sides_see(sides, GOE_SIDE_LEFT | GOE_SIDE_RIGHT);
}

static bool see_points(const goe_observation_t *obs, sight_t *sight) {
    goe_feature_t left;
    goe_feature_t right;
    if (!goe_observation_ends(obs->point, &left, &right)) {
        return false;
    }
    sight->size = obs->point[right].x - obs->point[left].x;
    sight->head = obs->point[GOE_POINT_TOP];
    sight->foot.usable = obs->base;
    sight->foot.y = 0.5f * (obs->point[GOE_POINT_BASE_LEFT].y + obs->point[GOE_POINT_BASE_RIGHT].y);
    return true;
}

static bool see(const goe_observation_t *obs, sight_t *sight) {
    memset(sight, 0, sizeof *sight);
    if (!shows_box(obs->sides)) {
        return see_points(obs, sight);
    }
    see_box(obs, sight);
    return sight->size > 0.0f && !(sight->cut && sight->size > CUT_MAX);
}

/* Angular height, 0 if not visible. */
static float up_of(const sight_t *sight) {
    return sight->head.usable && sight->foot.usable ? sight->foot.y - sight->head.y : 0.0f;
}

/* (R2): range over flat ground, if the foot is clearly below the horizon; otherwise 0. */
static float range_by_ground_m(const goe_observation_t *obs, const sight_t *sight) {
    const goe_settings_t *s = obs->settings;
    const float attitude =
        goe_square(s->navigation.attitude_bias_sd_deg * GOE_RAD_PER_DEG) + goe_square(obs->white_rad);
    const float pixel = sight->box ? obs->side_px / obs->camera->fy_px : goe_observation_pixel(obs);
    const float share = sight->box ? FOOT_SHARE * s->detector.box_noise_rel : 0.0f;
    const float foot_sd = sqrtf(attitude + goe_square(pixel) + goe_square(share * sight->size));
    const float nearer = sight->box ? NEAR_SIDE * sight->size : 0.0f;
    const bool grounded = sight->foot.usable && sight->foot.y > GROUND_SIGMAS * foot_sd &&
                          obs->height_m > GROUND_SIGMAS * obs->height_sd_m;
    return grounded ? obs->height_m / sight->foot.y * (1.0f + nearer) : 0.0f;
}

/* (R16): range by the ground; otherwise by the size, from the class or from the settings. A class may be wrong, and must not place the
 * obstacle so far away that the prior's sigma does not reach back. */
static float first_range_m(const goe_observation_t *obs, const sight_t *sight, bool *by_kind) {
    const float ground_m = range_by_ground_m(obs, sight);
    const float prior_m = goe_kind_prior_width_m(obs->settings, obs->passed) / goe_larger(sight->size, BOX_SIZE_MIN);
    const float kind_m = goe_kind_range_m(obs->kind, sight->cut ? 0.0f : sight->size, up_of(sight));
    *by_kind = !(ground_m > 0.0f) && kind_m >= RANGE_MIN_M && kind_m <= FARTHER_MAX * prior_m;
    if (*by_kind) {
        return kind_m;
    }
    return goe_larger(ground_m > 0.0f ? ground_m : prior_m, RANGE_MIN_M);
}

/* One sigma of the half width: the part behind the border may double it, or exceed it by the prior width. */
static float half_freedom(const goe_observation_t *obs, const sight_t *sight, float q) {
    if (!sight->cut) {
        return HALF_FREEDOM * sight->size;
    }
    return goe_larger(0.5f * sight->size, goe_kind_prior_width_m(obs->settings, obs->passed) * q);
}

static void set_root(const goe_observation_t *obs, const float state[GOE_STATES], const sight_t *sight,
                     goe_triangle_t *root) {
    float sd[GOE_STATES];
    goe_observation_prior(obs, state, sight->size, sd);
    sd[GOE_GROUND] = goe_larger(sqrtf(goe_ground_variance(obs, state[GOE_INVERSE_RANGE])), GROUND_MIN);
    sd[GOE_SHEAR] = (obs->is_round ? ROUND_SHEAR : SHEAR_FREEDOM) * state[GOE_HALF];
    sd[GOE_HALF] = half_freedom(obs, sight, state[GOE_INVERSE_RANGE]);
    sd[GOE_LOG_DEPTH] = obs->is_round ? ROUND_FREEDOM : DEPTH_FREEDOM;
    goe_srif_from_sigmas(sd, root);
}

bool goe_footprint_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root, bool *by_kind) {
    sight_t sight;
    if (!see(obs, &sight)) {
        return false;
    }
    const float range_m = first_range_m(obs, &sight, by_kind);
    if (!goe_within(range_m, RANGE_MAX_M)) {
        return false;
    }
    const float q = 1.0f / range_m;
    memset(state, 0, GOE_STATES * sizeof state[0]);
    state[GOE_INVERSE_RANGE] = q;
    state[GOE_HALF] = 0.5f * sight.size;
    state[GOE_TOP] = obs->height_m * q - (sight.head.usable ? sight.head.y : 0.0f);
    if (obs->height_sd_m > NO_ALTIMETER_M && sight.foot.usable) {
        state[GOE_GROUND] = sight.foot.y - obs->height_m * q;
    }
    set_root(obs, state, &sight, root);
    return true;
}

#endif
