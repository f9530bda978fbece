/* The start of a box from base corners. SPDX-License-Identifier: MIT */
#ifndef GOE_BOX_START_H
#define GOE_BOX_START_H

#include "refined/goe_observation.h"

/* Ground plan of a box. */
typedef struct {
    float turn_cos, turn_sin;         /* the axes of all that follows: those of the observation turned by this */
    float orientation_rad, sigma_rad; /* of the side; only of one face */
    float beyond_rad;  /* the camera's foot on the face's line beyond the face's ends; only of one face */
    float left, right; /* lateral extents, focal lengths; only of two faces */
    float sine, cosine;
    float width, length; /* over Z0 */
    float a, q;          /* X0/Z0, 1/Z0 */
} goe_first_box_t;

/* From the lateral extents of two faces, with the depth of both taken as the same: in the axes of the line of sight to the
 * near corner, (R17). The range is the state's. False if a corner is not visible, or a face is too narrow to exceed the
 * noise. */
bool goe_box_of_two_faces(const goe_observation_t *obs, goe_first_box_t *box);

/* From the direction of the one visible face, which becomes the front or the side, whichever it is nearer to; the
 * other extent is guessed, (R18). The range is the state's, the corners' y give differences: the pitch bias drops out.
 * False if the image does not show it: no two outer base corners, corners in no possible place, or orientation known worse
 * than to 0.2 rad. */
bool goe_box_of_one_face(const goe_observation_t *obs, goe_first_box_t *box);

/* Of a footprint: becomes a box when two images agree on two faces and the range is known, or three on the direction
 * of one. Returns whether it did; the image that brings it is not used for more. */
bool goe_box_start(goe_filter_t *filter, const goe_observation_t *obs);

#endif
