/* The window method: the estimation of the paper, Sections 2 to 4. SPDX-License-Identifier: MIT */
#ifndef GOE_WINDOW_H
#define GOE_WINDOW_H

#include "image/goe_fault.h"
#include "image/goe_view.h"

/* Clears the memory of the track. */
void goe_window_clear(goe_window_t *window);

/* Takes one image and, if there is a solution, updates *estimate. Returns the status of the image. faults: those found so far; further ones
 * are counted. */
goe_status_t goe_window_update(goe_window_t *window, const goe_settings_t *settings, const goe_view_t *view,
                               const goe_faults_t *faults, goe_estimate_t *estimate);

#endif
