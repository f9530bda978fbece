/* First guess of a box. SPDX-License-Identifier: MIT */
#include "refined/goe_footprint.h"

#include <math.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#define RANGE_LEAST_M 1.0f
#define HEIGHT_LEAST_M 0.3f /* camera over ground: lower the corners' y say nothing */
#define NEARER_MOST 1.7f    /* 1/range of a corner over the state's 1/range */
#define FARTHER_MOST 0.6f
#define POINT_NOISE 1.5f  /* one sigma of a difference of two points, in those of a pixel */
#define SURE_SIGMAS2 4.0f /* a difference in depth counts only as far as it exceeds 2 sigma, or luck would pass */
#define EDGE_LEAST_M2 1.0e-6f
#define SIGMA_MOST_RAD 0.2f
#define SIZE_MOST 0.4f /* of the range */
#define SIZE_LEAST_M 0.05f
#define FACE_LEAST_PX 3.0f /* lateral extent of a face, in sigmas of a pixel */

typedef struct {
    float x, z; /* from the camera, m */
} place_t;

/* Into the state's scale; reference: middle of the front edge from the camera, in the footprint's axes. False if it is out of
 * bounds. */
static bool scale(const goe_observation_t *sight, place_t reference, float width_m, float length_m, float range_m,
                  goe_footprint_t *box) {
    const float c = box->turn_cos;
    const float s = box->turn_sin;
    const float z0_m = reference.z + s * sight->dx_m + c * sight->dz_m;
    if (!(z0_m >= RANGE_LEAST_M) || goe_larger(width_m, length_m) > SIZE_MOST * range_m) {
        return false;
    }
    box->q = 1.0f / z0_m;
    box->a = (reference.x + c * sight->dx_m - s * sight->dz_m) * box->q;
    box->width = goe_larger(width_m, SIZE_LEAST_M) * box->q;
    box->length = goe_larger(length_m, SIZE_LEAST_M) * box->q;
    return true;
}

static float range_of(const goe_observation_t *sight) { return 1.0f / sight->state[GOE_Q] - sight->dz_m; }

/* ----------------------------------------------------------------------------------------------------------- two faces -- */

bool goe_footprint_two_faces(const goe_observation_t *sight, goe_footprint_t *box) {
    const float range_m = range_of(sight);
    if (!sight->base || !sight->point[GOE_BASE_NEAR].usable || !(range_m >= RANGE_LEAST_M)) {
        return false;
    }
    const float corner = goe_observation_unbiased(sight, GOE_BASE_NEAR).x;
    const float c = 1.0f / sqrtf(1.0f + corner * corner);
    box->left = corner - goe_observation_unbiased(sight, GOE_BASE_LEFT).x;
    box->right = goe_observation_unbiased(sight, GOE_BASE_RIGHT).x - corner;
    const float left_m = box->left * range_m * c;
    const float right_m = box->right * range_m * c;
    const float least_m = left_m < right_m ? left_m : right_m;
    if (!(least_m > FACE_LEAST_PX * goe_observation_pixel(sight) * range_m)) {
        return false;
    }
    /* side (right_m, deep_m) and front (left_m, -deep_m) are square to each other; or the names exchanged */
    const float deep_m = sqrtf(left_m * right_m);
    const float on_left_m = sqrtf(left_m * left_m + deep_m * deep_m);
    const float on_right_m = sqrtf(right_m * right_m + deep_m * deep_m);
    const bool exchange = right_m > deep_m;
    const place_t reference = {exchange ? 0.5f * right_m : -0.5f * left_m, range_m / c + 0.5f * deep_m};
    box->turn_cos = c;
    box->turn_sin = corner * c;
    box->sine = exchange ? -left_m / on_left_m : right_m / on_right_m;
    box->cosine = exchange ? deep_m / on_left_m : deep_m / on_right_m;
    return scale(sight, reference, exchange ? on_right_m : on_left_m, exchange ? on_left_m : on_right_m, range_m, box);
}

/* ------------------------------------------------------------------------------------------------------------ one face -- */

typedef struct {
    place_t left, right;
    float range_m, height_m;
} face_t;

/* False if an end lies in no possible place. */
static bool place_end(const goe_point_t *point, float mean_y, const face_t *face, place_t *end) {
    const float nearness = 1.0f / face->range_m;
    const float inverse = nearness + (point->y - mean_y) / face->height_m;
    if (!(inverse >= FARTHER_MOST * nearness && inverse <= NEARER_MOST * nearness)) {
        return false;
    }
    end->z = 1.0f / inverse;
    end->x = point->x * end->z;
    return true;
}

static bool place_face(const goe_observation_t *sight, face_t *face) {
    const goe_point_t left = goe_observation_unbiased(sight, GOE_BASE_LEFT);
    const goe_point_t right = goe_observation_unbiased(sight, GOE_BASE_RIGHT);
    const float mean_y = 0.5f * (left.y + right.y);
    return place_end(&left, mean_y, face, &face->left) && place_end(&right, mean_y, face, &face->right);
}

/* One sigma of the orientation that an edge tells, rad. */
static float edge_sigma(const goe_observation_t *sight, const face_t *face, float x, float z) {
    const float pixel = goe_observation_pixel(sight) * POINT_NOISE;
    const float deep = face->range_m * face->range_m / face->height_m * pixel;
    const float wide = face->range_m * pixel;
    const float tilt =
        face->range_m / face->height_m * (sight->settings->noise.attitude_bias_deg * GOE_RAD_PER_DEG) * x * x;
    const float noise = sqrtf(deep * x * (deep * x) + wide * z * (wide * z) + tilt * tilt);
    const float sure = z * z - SURE_SIGMAS2 * deep * deep;
    return noise / goe_larger(x * x + goe_larger(sure, 0.0f), EDGE_LEAST_M2);
}

/* An edge that lies more across than along is the front, any other the side. */
static place_t measure_face(const face_t *face, float x, float z, float size_m, goe_footprint_t *box) {
    const bool front = goe_absolute(x) > goe_absolute(z);
    const float across = front ? -z : x;
    const float along = front ? x : z;
    const float sign = along < 0.0f ? -1.0f : 1.0f;
    box->sine = sign * across / size_m;
    box->cosine = sign * along / size_m;
    box->orientation_rad = goe_arctan_rad(sign * across, sign * along);
    if (front) {
        const place_t middle = {0.5f * (face->left.x + face->right.x), 0.5f * (face->left.z + face->right.z)};
        return middle;
    }
    /* the near end of the side is a corner of the front: the right one if the side is seen to the right of it */
    const bool left_is_near = face->left.z < face->right.z;
    const place_t corner = left_is_near ? face->left : face->right;
    const float half_m = left_is_near ? 0.5f * size_m : -0.5f * size_m;
    const place_t middle = {corner.x - half_m * box->cosine, corner.z + half_m * box->sine};
    return middle;
}

bool goe_footprint_one_face(const goe_observation_t *sight, goe_footprint_t *box) {
    face_t face;
    face.range_m = range_of(sight);
    face.height_m = sight->height_m + sight->state[GOE_DH];
    if (!sight->base || !(face.range_m >= RANGE_LEAST_M) || !(sight->height_m >= HEIGHT_LEAST_M) ||
        !(face.height_m >= HEIGHT_LEAST_M) || !place_face(sight, &face)) {
        return false;
    }
    const float x = face.right.x - face.left.x;
    const float z = face.right.z - face.left.z;
    box->turn_cos = 1.0f;
    box->turn_sin = 0.0f;
    box->sigma_rad = edge_sigma(sight, &face, x, z);
    if (!(x * x + z * z >= EDGE_LEAST_M2) || !(box->sigma_rad < SIGMA_MOST_RAD)) {
        return false;
    }
    const float size_m = sqrtf(x * x + z * z);
    const place_t reference = measure_face(&face, x, z, size_m, box);
    return scale(sight, reference, size_m, size_m, face.range_m, box);
}
