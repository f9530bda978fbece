/* The paper's method, Sections 2 to 4. SPDX-License-Identifier: MIT */
#ifndef GOE_WINDOW_H
#define GOE_WINDOW_H

#include "image/goe_align.h"

static inline bool goe_image_seen(const goe_image_t *image) {
    return image->left.seen || image->right.seen || image->top.seen || image->base_left.seen || image->base_near.seen ||
           image->base_right.seen;
}

typedef enum {
    GOE_WINDOW_SOLVES,
    GOE_WINDOW_COLLECTS /* rows of the disc only, so that it can solve when it is asked to */
} goe_window_task_t;

/* Takes one image, whose ego motion the estimator holds, and, if it solves, brings estimator->estimate up to date. Returns
 * what to say of the image. faults: those met so far; more are counted. */
goe_status_t goe_window_update(goe_estimator_t *estimator, const goe_image_t *image, const goe_view_t *view,
                               goe_window_task_t task, const goe_faults_t *faults);

#endif
