/* Images of a flight, and what is done to some of them. SPDX-License-Identifier: MIT */
#ifndef FUZZ_IMAGE_H
#define FUZZ_IMAGE_H

#include "fuzz_scene.h"

/* A flight past an obstacle, as one camera, or two in turn, see it. */
typedef struct {
    const goe_settings_t *settings;
    fuzz_noise_t noise;
    fuzz_path_t path;
    fuzz_solid_t solid;
    float t_s, late_s;  /* time of the flight; by how much the poses are late */
    float pixel_px;     /* noise */
    float height_off_m; /* of the told height above ground */
    uint32_t unseen;    /* images in a row without the obstacle */
    int64_t now_us;     /* ... of the images */
    uint32_t period_us;
    float jump_ned_m[3]; /* of the autopilot's filter, so far */
    uint8_t resets;
    uint8_t shows; /* FUZZ_SHOWS_... */
    goe_image_noise_t hint;
    goe_image_t before; /* the latest image as it was made ... */
    uint32_t frozen;    /* ... and for how many images its features are shown again */
} fuzz_view_t;

#define FUZZ_SHOWS_BOX 1u
#define FUZZ_SHOWS_POINTS 2u
#define FUZZ_SHOWS_BASE 4u
#define FUZZ_SHOWS_TWO_CAMERAS 8u

/* Another flight; its times go on from those before. The settings must stay where they are. */
void fuzz_view_begin(fuzz_input_t *in, const goe_settings_t *settings, fuzz_view_t *view);

/* The next image of it. True if the obstacle was passed and the flight begins anew, far from where it was. */
bool fuzz_view_image(fuzz_view_t *view, goe_image_t *image);

/* Something that is wrong with this image, or changes with it. */
void fuzz_view_spoil(fuzz_input_t *in, fuzz_view_t *view, goe_image_t *image);

#endif
