/* Sides of a bounding box: which are measured, and the points that they give. SPDX-License-Identifier: MIT */
#include "image/goe_sides.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#define UPRIGHT 0.01f      /* sine of a lean that needs no correction */
#define COSINE_MIN 0.5f    /* cosine of twice the lean: beyond 30 degrees a box hardly separates width and height */
#define DIRECTION_MIN 0.1f /* least length of a vertical in the image, focal lengths: from above it has no direction */
#define WIDE (GOE_SIDE_LEFT | GOE_SIDE_RIGHT)
#define LEVEL (GOE_SIDE_TOP | GOE_SIDE_BOTTOM)
#define LEANS 0.2f      /* tangent of a lean beyond which two borders cut the same end */
#define CUT_SIGMAS 3.0f /* of a side's slow error, by which a detector may place a cut side inside the border */

GOE_STATIC_ASSERT(GOE_SIDE_LEFT == 1u << GOE_BOX_LEFT && GOE_SIDE_TOP == 1u << GOE_BOX_TOP &&
                      GOE_SIDE_RIGHT == 1u << GOE_BOX_RIGHT && GOE_SIDE_BOTTOM == 1u << GOE_BOX_BOTTOM,
                  every_side_has_its_bit);

/* Compares each side with the border of the image: removes usable sides at it, and notes the sides that it may cut. A detector draws a cut
 * side up to some sigma inside the border. The slow error is that of a box that ends at the border. A border that is not known (size 0) cuts
 * nothing. */
static void compare_with_border(const goe_camera_t *camera, unsigned seen, float noise_rel, goe_sides_t *sides) {
    const float border_px = camera->border_rel * camera->width_px;
    const float cut_px = camera->truncation_rel * camera->width_px;
    unsigned at_border = 0;
    unsigned cut = seen ^ GOE_SIDES_ALL;
    unsigned doubtful = 0;
    for (unsigned i = 0; i < GOE_BOX_SIDES; i++) {
        const unsigned opposite = i ^ 2u;
        const float last_px = ((i & 1u) ? camera->height_px : camera->width_px) - 1.0f;
        const float px = sides->px[i];
        const float other_px = sides->px[opposite];
        const float inside_px = i < opposite ? px : last_px - px;
        const float size_px = i < opposite ? other_px : last_px - other_px;
        const float farther_px = goe_larger(px, last_px - px); /* from the border that is farther away */
        const unsigned one = last_px > 0.0f ? 1u << i : 0u;
        at_border |= farther_px > last_px - border_px ? one : 0u;
        cut |= farther_px > last_px - cut_px ? one : 0u;
        doubtful |= (seen >> opposite & 1u) != 0u && inside_px < CUT_SIGMAS * noise_rel * size_px ? one : 0u;
    }
    sides->usable = (uint8_t)(seen & ~at_border);
    sides->cut = (uint8_t)(cut | at_border);
    sides->doubtful = (uint8_t)(doubtful & sides->usable);
}

/* Exchanges left and right. */
static unsigned mirrored(unsigned wide) { return (wide << 2 | wide >> 2) & WIDE; }

/* Notes which ends of the obstacle the border may cut. down: the vertical, in the camera's axes. The horizontal to the obstacle's right is
 * (down y, -down x). Each side of the box opens the end that lies in its direction: with a lean, the border above or below also cuts a wide
 * obstacle, and left or right of the box is then where its outline crosses this border. */
static void find_ends(const float down[2], goe_sides_t *sides) {
    const bool rolled = goe_absolute(down[0]) > LEANS * goe_absolute(down[1]);
    const bool upright = goe_absolute(down[1]) >= LEANS * goe_absolute(down[0]);
    const unsigned open = sides->cut | sides->doubtful;
    const unsigned across = upright ? open & WIDE : 0u;
    const unsigned along = rolled ? open >> 1 & WIDE : 0u; /* top for left */
    sides->ends = (uint8_t)((down[1] < 0.0f ? mirrored(across) : across) | (down[0] > 0.0f ? mirrored(along) : along));
    sides->truncated = (sides->cut & (rolled ? GOE_SIDES_ALL : WIDE)) != 0u;
}

/* A side that is not measured may have any value: the visible part ends at the image's border. */
static void end_at_border(const goe_camera_t *camera, goe_sides_t *sides) {
    if (!goe_sides_see(sides, GOE_SIDE_LEFT)) {
        sides->px[GOE_BOX_LEFT] = 0.0f;
    }
    if (!goe_sides_see(sides, GOE_SIDE_RIGHT)) {
        sides->px[GOE_BOX_RIGHT] = goe_larger(camera->width_px, 2.0f * camera->cx_px);
    }
}

void goe_sides_read(const goe_camera_t *camera, goe_view_t *view, goe_faults_t *faults) {
    const goe_box_t *box = &view->image->box;
    goe_sides_t *sides = &view->sides;
    const unsigned seen = box->sides & GOE_SIDES_ALL;
    memcpy(sides->px, goe_box_sides(box), sizeof sides->px);
    if (((seen & WIDE) == WIDE && !(box->left_px < box->right_px)) ||
        ((seen & LEVEL) == LEVEL && !(box->top_px < box->bottom_px))) {
        goe_fault_count(faults, GOE_SWAPPED);
        return;
    }
    compare_with_border(camera, seen, view->box_noise_rel, sides);
    find_ends(&view->camera_to_trajectory[3], sides);
    if ((sides->usable & (sides->usable - 1u)) == 0u) { /* at most one usable side */
        goe_fault_count(faults, GOE_BOX_INCOMPLETE);
    }
    end_at_border(camera, sides);
}

/* --------------------------------------------------------------------------------------------------------- points -- */

/* The box about its middle (x, y), focal lengths, and the unit vector down the obstacle's verticals there. */
typedef struct {
    float x, y, half_width, half_height, down_x, down_y;
} box_frame_t;

static bool find_down(const goe_view_t *view, box_frame_t *frame) {
    const float *r = view->camera_to_trajectory;
    const float x = r[3] - frame->x * r[5];
    const float y = r[4] - frame->y * r[5];
    const float length = sqrtf(x * x + y * y);
    if (!(length >= DIRECTION_MIN)) {
        return false;
    }
    frame->down_x = x / length;
    frame->down_y = y / length;
    return true;
}

/* Inverts the upright box around a leaning rectangle: half width = w c + h s, half height = w s + h c. */
static bool turn_back(box_frame_t *frame, bool has_height) {
    const float c = goe_absolute(frame->down_y);
    const float s = goe_absolute(frame->down_x);
    if (s < UPRIGHT) {
        return true;
    }
    const float cosine = c * c - s * s;
    if (!has_height || cosine < COSINE_MIN) {
        return false;
    }
    const float width = (frame->half_width * c - frame->half_height * s) / cosine;
    frame->half_height = (frame->half_height * c - frame->half_width * s) / cosine;
    frame->half_width = width;
    return frame->half_width > 0.0f && frame->half_height > 0.0f;
}

static goe_pixel_t pixel_at(const goe_camera_t *camera, float x, float y) {
    const goe_pixel_t pixel = {x * camera->fx_px + camera->cx_px, y * camera->fy_px + camera->cy_px, true};
    return pixel;
}

void goe_sides_points(const goe_camera_t *camera, const goe_view_t *view, goe_pixel_t *left, goe_pixel_t *right,
                      goe_pixel_t *top) {
    const goe_sides_t *sides = &view->sides;
    const float *px = sides->px;
    const bool has_top = goe_sides_see(sides, GOE_SIDE_TOP);
    const bool has_height = goe_sides_see(sides, GOE_SIDE_TOP | GOE_SIDE_BOTTOM);
    top->visible = false;
    right->visible = false;
    left->visible = false;
    if (!goe_sides_see(sides, GOE_SIDE_LEFT | GOE_SIDE_RIGHT)) {
        return;
    }
    const float bottom_px = has_height ? px[GOE_BOX_BOTTOM] : (has_top ? px[GOE_BOX_TOP] : camera->cy_px);
    const float top_px = has_top ? px[GOE_BOX_TOP] : bottom_px;
    box_frame_t frame = {(0.5f * (px[GOE_BOX_LEFT] + px[GOE_BOX_RIGHT]) - camera->cx_px) / camera->fx_px,
                         (0.5f * (top_px + bottom_px) - camera->cy_px) / camera->fy_px,
                         0.5f * (px[GOE_BOX_RIGHT] - px[GOE_BOX_LEFT]) / camera->fx_px,
                         0.5f * (bottom_px - top_px) / camera->fy_px,
                         0.0f,
                         1.0f};
    if (!find_down(view, &frame) || !turn_back(&frame, has_height)) {
        return;
    }
    const float across_x = frame.half_width * frame.down_y;
    const float across_y = -frame.half_width * frame.down_x;
    *left = pixel_at(camera, frame.x - across_x, frame.y - across_y);
    *right = pixel_at(camera, frame.x + across_x, frame.y + across_y);
    if (has_top) {
        *top = pixel_at(camera, frame.x - frame.half_height * frame.down_x, frame.y - frame.half_height * frame.down_y);
    }
}
