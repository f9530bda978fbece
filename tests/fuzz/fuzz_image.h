/* Images of a flight, and faults in some of them. SPDX-License-Identifier: MIT */
#ifndef FUZZ_IMAGE_H
#define FUZZ_IMAGE_H

#include "fuzz_scene.h"

/* A flight past an obstacle, as one camera or two alternating cameras show it. */
typedef struct {
    const goe_settings_t *settings;
    fuzz_noise_t noise;
    fuzz_path_t path;
    fuzz_solid_t solid;
    float t_s, late_s;  /* time of the flight; delay of the poses */
    float pixel_px;     /* noise */
    float height_off_m; /* error of the height above ground */
    uint32_t invisible; /* images in a row without the obstacle */
    int64_t now_us;     /* ... between the images */
    uint32_t period_us;
    float jump_ned_m[3]; /* resets of the autopilot's filter so far */
    uint8_t resets;
    uint8_t shows; /* FUZZ_SHOWS_... */
    goe_image_noise_t hint;
    goe_image_t before; /* the latest image before it was spoiled ... */
    uint32_t frozen;    /* ... and the number of images that still repeat its features */
} fuzz_view_t;

#define FUZZ_SHOWS_BOX 1u
#define FUZZ_SHOWS_POINTS 2u
#define FUZZ_SHOWS_BASE 4u
#define FUZZ_SHOWS_TWO_CAMERAS 8u

/* Begins another flight; its times continue those of the previous one. The settings must remain in place. */
void fuzz_view_begin(fuzz_input_t *in, const goe_settings_t *settings, fuzz_view_t *view);

/* The next image. True if the obstacle was passed and the flight restarts, far from its last place. */
bool fuzz_view_image(fuzz_view_t *view, goe_image_t *image);

/* Puts a fault into this image, or begins a lasting change with it. */
void fuzz_view_spoil(fuzz_input_t *in, fuzz_view_t *view, goe_image_t *image);

#endif
