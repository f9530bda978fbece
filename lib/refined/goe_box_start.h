/* The start of the box model from base corners. SPDX-License-Identifier: MIT */
#ifndef GOE_BOX_START_H
#define GOE_BOX_START_H

#include "refined/goe_observation.h"

/* A box viewed from above, as one image shows it. */
typedef struct {
    float turn_cos, turn_sin;         /* the fields below are in the observation's axes turned by this */
    float orientation_rad, sigma_rad; /* of the side; from one face only */
    float beyond_rad;  /* one face: from its ends to the foot of the camera's perpendicular; negative between them */
    float left, right; /* two faces: lateral extents, focal lengths */
    float sine, cosine;
    float width, length; /* over Z0 */
    float a, q;          /* X0/Z0, 1/Z0 */
} goe_first_box_t;

/* Finds the box from the lateral extents of two faces, in axes whose Z is the line of sight to the near corner. It assumes the same depth
 * for both faces, (R17). The range is the state's. False if a corner is not visible, or a face is too narrow to exceed the noise. */
bool goe_box_of_two_faces(const goe_observation_t *obs, goe_first_box_t *box);

/* Finds the box from the direction of the one visible face, (R18). The face becomes the front or the side, whichever is nearer; the other
 * extent is assumed. The range is the state's: the corners' y give differences, in which the pitch bias cancels. False if an outer base
 * corner is missing or in an impossible place, or if the sigma of the orientation exceeds 0.2 rad. */
bool goe_box_of_one_face(const goe_observation_t *obs, goe_first_box_t *box);

/* Changes a footprint into a box when two images agree on two faces and the range is known, or three on the direction of one face. Returns
 * whether it did; the image that causes the change is used for nothing else. */
bool goe_box_start(goe_filter_t *filter, const goe_observation_t *obs);

#endif
