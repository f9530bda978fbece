/* Input checks, which refuse an image before anything is computed. SPDX-License-Identifier: MIT */
#ifndef GOE_INTAKE_H
#define GOE_INTAKE_H

#include "goe.h"

/* Returns GOE_OK, or why the whole image is refused: GOE_NOT_FINITE, GOE_OUT_OF_RANGE, GOE_BAD_TIME, GOE_BAD_ATTITUDE. */
goe_status_t goe_intake_check(const goe_motion_t *motion, const goe_image_t *image);

/* The same checks for inputs of the filter method alone: GOE_OK, GOE_NOT_FINITE or GOE_OUT_OF_RANGE. */
goe_status_t goe_intake_check_noise(const goe_image_noise_t *noise);
goe_status_t goe_intake_check_kind(const goe_kind_t *kind);

#endif
