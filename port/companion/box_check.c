/* Boxes that no pixels of the image can be. SPDX-License-Identifier: MIT */
#include "box_check.h"

static bool is_within_one(float value) { return value >= 0.0f && value <= 1.0f; }

box_fault_t box_check(const goe_box_t *box, const goe_camera_t *camera) {
    if ((box->sides & GOE_SIDES_ALL) != GOE_SIDES_ALL) {
        return BOX_GOOD;
    }
    if (is_within_one(box->left_px) && is_within_one(box->top_px) && is_within_one(box->right_px) &&
        is_within_one(box->bottom_px)) {
        return BOX_NORMALIZED;
    }
    if (box->right_px < box->left_px || box->bottom_px < box->top_px) {
        return BOX_EXCHANGED;
    }
    const bool is_outside = box->right_px < 0.0f || box->bottom_px < 0.0f || box->left_px > camera->width_px ||
                            box->top_px > camera->height_px;
    return is_outside ? BOX_OUTSIDE : BOX_GOOD;
}

const char *box_fault_text(box_fault_t fault) {
    static const char *const texts[BOX_FAULTS] = {
        "good box",
        "box in 0..1: send pixels",
        "right<left or bottom<top: box is x1 y1 x2 y2",
        "box outside image: check camera.ini",
    };
    return fault < BOX_FAULTS ? texts[fault] : "";
}
