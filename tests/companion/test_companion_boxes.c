/* Boxes that no pixels of the image can be. SPDX-License-Identifier: MIT */
#include <string.h>

#include "box_check.h"
#include "check.h"
#include "screen.h"

static goe_camera_t camera;

void setUp(void) {
    (void)memset(&camera, 0, sizeof camera);
    camera.width_px = 1280.0f;
    camera.height_px = 960.0f;
}
void tearDown(void) {}

static void a_box_that_no_pixels_can_be_has_a_fault(void) {
    static const struct {
        float sides[4]; /* left, top, right, bottom */
        box_fault_t fault;
    } cases[] = {
        {{612.5f, 400.0f, 660.0f, 512.5f}, BOX_GOOD},      {{0.0f, 0.0f, 1.5f, 1.0f}, BOX_GOOD},
        {{0.0f, 0.0f, 1.0f, 1.0f}, BOX_NORMALIZED},        {{0.48f, 0.42f, 0.52f, 0.53f}, BOX_NORMALIZED},
        {{0.48f, 0.42f, 0.04f, 0.11f}, BOX_NORMALIZED}, /* and exchanged */
        {{612.5f, 400.0f, 47.5f, 512.5f}, BOX_EXCHANGED},  {{612.5f, 400.0f, 660.0f, 112.5f}, BOX_EXCHANGED},
        {{-60.0f, 400.0f, -1.0f, 500.0f}, BOX_OUTSIDE},    {{600.0f, -60.0f, 700.0f, -1.0f}, BOX_OUTSIDE},
        {{1281.0f, 400.0f, 1300.0f, 500.0f}, BOX_OUTSIDE}, {{600.0f, 961.0f, 700.0f, 970.0f}, BOX_OUTSIDE},
        {{-60.0f, -60.0f, 1300.0f, 970.0f}, BOX_GOOD}, /* it contains the image */
        {{1280.0f, 960.0f, 1300.0f, 970.0f}, BOX_GOOD},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float *s = cases[i].sides;
        goe_box_t box = {s[0], s[1], s[2], s[3], GOE_SIDES_ALL};
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].fault, box_check(&box, &camera), box_fault_text(cases[i].fault));
        box.sides = GOE_SIDES_ALL & ~GOE_SIDE_TOP;
        TEST_ASSERT_EQUAL_INT(BOX_GOOD, box_check(&box, &camera));
    }
}

static void the_pilot_reads_the_whole_text(void) {
    for (int fault = 0; fault < BOX_FAULTS; fault++) {
        const size_t length = strlen("GOE: ") + strlen(box_fault_text((box_fault_t)fault));
        TEST_ASSERT_TRUE(length < SCREEN_TEXT_MAX);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_box_that_no_pixels_can_be_has_a_fault);
    RUN_TEST(the_pilot_reads_the_whole_text);
    return UNITY_END();
}
