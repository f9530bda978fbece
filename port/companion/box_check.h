/* Boxes that no pixels of the image can be. SPDX-License-Identifier: MIT */
#ifndef BOX_CHECK_H
#define BOX_CHECK_H

#include "goe_flight.h"

typedef enum {
    BOX_GOOD,
    BOX_NORMALIZED, /* all coordinates within 0..1 */
    BOX_EXCHANGED,  /* right < left or bottom < top */
    BOX_OUTSIDE,    /* no part of it is in the image */
    BOX_FAULTS
} box_fault_t;

/* The fault of a box with four sides in an image of this camera. A box without one of its sides is good. */
box_fault_t box_check(const goe_box_t *box, const goe_camera_t *camera);

/* The fault and its remedy, for the pilot's screen. */
const char *box_fault_text(box_fault_t fault);

#endif
