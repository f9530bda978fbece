/* Sizes of classes of COCO, VisDrone and others. SPDX-License-Identifier: MIT
 *
 * A size that the table gives as low to high becomes their middle, with the sigma of a uniform distribution between both,
 * (high - low) / sqrt(12). The width is that of the silhouette. A vehicle shows its own width from the front, and at most
 * sqrt(length^2 + width^2); the road decides from which side, so no side is more probable. Sizes that vary too much are 0: unknown.
 *
 *   car         1.8 m wide and 4.4 m long, about 1.5 m high; off-road ones about 1.8 m
 *   van         from 1.9 m wide and high to the longest ones, 7.4 m long and 2.9 m high
 *   truck       Directive 96/53/EC: at most 2.55 m wide, 4 m high, 18.75 m long. COCO counts pickups of 1.9 m by 1.8 m as well
 *   bus         Directive 96/53/EC: at most 2.55 m wide, 4 m high, 15 m long (18.75 m if it is articulated); minibuses are 2.1 m
 *               wide and 2.6 m high
 *   motorcycle  without and with a rider: 0.8 m wide, up to 2.2 m long, 1.1 m to 1.8 m high
 *   bicycle     without and with a rider: 0.5 m wide, 1.8 m long, 1 m to 1.9 m high
 *   person      adult stature: 1.71 m (men), 1.59 m (women), NCD-RisC 2016, sigma 0.07 m each; lower for those who sit or are children.
 *               Shoulders: 0.51 m (men), 0.45 m (women), ANSUR II 2012; from the side 0.25 m, with a step or an arm 0.9 m
 *   pole        utility poles: 8 m to 12 m above the ground, lamps from 6 m. Of 0.2 m to 0.35 m in diameter, but a box contains the
 *               crossarm
 *   house       one or two storeys with a roof; no source, so the range is wide */
#include "obstacle_class.h"

#include <string.h>
#include <strings.h>

#define SIGMA_OF_SPAN 0.288675f /* 1 / sqrt(12) */

typedef struct {
    const char *name;
    float width_m[2], height_m[2]; /* low, high; 0: unknown */
    uint8_t shape;
} obstacle_class_t;

static const obstacle_class_t classes[] = {
    {"car", {1.8f, 4.8f}, {1.35f, 1.85f}, GOE_KIND_OTHER},
    {"van", {1.9f, 7.7f}, {1.9f, 2.9f}, GOE_KIND_OTHER},
    {"truck", {1.9f, 18.9f}, {1.8f, 4.0f}, GOE_KIND_OTHER},
    {"bus", {2.1f, 18.9f}, {2.6f, 4.0f}, GOE_KIND_OTHER},
    {"motorcycle", {0.8f, 2.4f}, {1.1f, 1.8f}, GOE_KIND_OTHER},
    {"motor", {0.8f, 2.4f}, {1.1f, 1.8f}, GOE_KIND_OTHER}, /* of VisDrone */
    {"bicycle", {0.5f, 1.9f}, {1.0f, 1.9f}, GOE_KIND_OTHER},
    {"person", {0.25f, 0.95f}, {1.3f, 1.9f}, GOE_KIND_UNKNOWN},
    {"pedestrian", {0.25f, 0.95f}, {1.4f, 1.9f}, GOE_KIND_UNKNOWN}, /* of VisDrone: they stand or walk */
    {"people", {0.25f, 0.95f}, {0.8f, 1.9f}, GOE_KIND_UNKNOWN},     /* of VisDrone: in any other posture */
    {"pole", {0.0f, 0.0f}, {6.0f, 12.0f}, GOE_KIND_ROUND},
    {"chimney", {0.0f, 0.0f}, {0.0f, 0.0f}, GOE_KIND_ROUND},
    {"house", {6.0f, 20.0f}, {4.0f, 12.0f}, GOE_KIND_OTHER},
};

static void set_size(const float range_m[2], float *size_m, float *sd_m) {
    *size_m = 0.5f * (range_m[0] + range_m[1]);
    *sd_m = SIGMA_OF_SPAN * (range_m[1] - range_m[0]);
}

bool obstacle_class_kind(const char *name, goe_kind_t *kind) {
    (void)memset(kind, 0, sizeof *kind);
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++) {
        if (strcasecmp(name, classes[i].name) == 0) {
            set_size(classes[i].width_m, &kind->width_m, &kind->width_sd_m);
            set_size(classes[i].height_m, &kind->height_m, &kind->height_sd_m);
            kind->shape = classes[i].shape;
            return true;
        }
    }
    return false;
}
