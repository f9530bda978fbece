/* Rotation matrices. SPDX-License-Identifier: MIT */
/* tests: lib/maths/goe_rotation.c */
#include "check.h"
#include "maths/goe_rotation.h"

#define EPS 5.0e-7f
#define HALF_SQRT2 0.707106781f

void setUp(void) {}
void tearDown(void) {}

static void check_turns(const float r[9], float x, float y, float z, float to_x, float to_y, float to_z) {
    const float v[3] = {x, y, z};
    float turned[3];
    goe_rotation_apply(r, v, turned);
    TEST_ASSERT_FLOAT_WITHIN(EPS, to_x, turned[0]);
    TEST_ASSERT_FLOAT_WITHIN(EPS, to_y, turned[1]);
    TEST_ASSERT_FLOAT_WITHIN(EPS, to_z, turned[2]);
}

/* [goe_pose_t.attitude] */
static void quaternion_turns_body_into_ned(void) {
    const float level[4] = {1.0f, 0.0f, 0.0f, 0.0f};
    const float heading_east[4] = {HALF_SQRT2, 0.0f, 0.0f, HALF_SQRT2};
    const float nose_up[4] = {HALF_SQRT2, 0.0f, HALF_SQRT2, 0.0f};
    const float right_wing_down[4] = {HALF_SQRT2, HALF_SQRT2, 0.0f, 0.0f};
    float r[9];
    goe_rotation_from_quaternion(level, r);
    check_turns(r, 1.0f, 2.0f, 3.0f, 1.0f, 2.0f, 3.0f);
    goe_rotation_from_quaternion(heading_east, r); /* the nose points east, the right wing south */
    check_turns(r, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    check_turns(r, 0.0f, 1.0f, 0.0f, -1.0f, 0.0f, 0.0f);
    goe_rotation_from_quaternion(nose_up, r);
    check_turns(r, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, -1.0f);
    goe_rotation_from_quaternion(right_wing_down, r);
    check_turns(r, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f);
}

/* [goe_pose_t.attitude] */
static void quaternion_norm_and_sign_do_not_matter(void) {
    const float q[4] = {0.5f, -0.1f, 0.7f, 0.3f};
    const float opposite[4] = {-0.5f, 0.1f, -0.7f, -0.3f};
    const float longer[4] = {0.505f, -0.101f, 0.707f, 0.303f};
    float r[9];
    float r_opposite[9];
    float r_longer[9];
    goe_rotation_from_quaternion(q, r);
    goe_rotation_from_quaternion(opposite, r_opposite);
    goe_rotation_from_quaternion(longer, r_longer);
    for (int i = 0; i < 9; i++) {
        CHECK_SAME(r[i], r_opposite[i]);
        TEST_ASSERT_FLOAT_WITHIN(EPS, r[i], r_longer[i]);
    }
}

static void check_orthonormal(const float r[9]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const float dot = r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
            TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, i == j ? 1.0f : 0.0f, dot);
        }
    }
    const float volume =
        r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, 1.0f, volume); /* a mirror image would be -1 */
}

/* [camera.mount_yaw_deg] */
static void every_rotation_is_proper(void) {
    check_random_t random = check_random_start("rotations");
    for (int i = 0; i < 500; i++) {
        float q[4];
        float r[9];
        float norm2 = 0.0f;
        for (int k = 0; k < 4; k++) {
            q[k] = (float)check_random_between(&random, -1.0, 1.0);
            norm2 += q[k] * q[k];
        }
        if (norm2 > 0.1f) {
            goe_rotation_from_quaternion(q, r);
            check_orthonormal(r);
        }
        goe_rotation_from_euler((float)check_random_between(&random, -360.0, 360.0),
                                (float)check_random_between(&random, -360.0, 360.0),
                                (float)check_random_between(&random, -360.0, 360.0), r);
        check_orthonormal(r);
    }
}

/* [camera.mount_yaw_deg] Z-Y'-X'': the product of the three single turns in this order. */
static void euler_angles_turn_yaw_then_pitch_then_roll(void) {
    float yaw[9];
    float pitch[9];
    float roll[9];
    float at_once[9];
    goe_rotation_from_euler(25.0f, 0.0f, 0.0f, yaw);
    goe_rotation_from_euler(0.0f, -40.0f, 0.0f, pitch);
    goe_rotation_from_euler(0.0f, 0.0f, 70.0f, roll);
    goe_rotation_from_euler(25.0f, -40.0f, 70.0f, at_once);
    for (int axis = 0; axis < 3; axis++) {
        const float v[3] = {axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
        float rolled[3];
        float pitched[3];
        float yawed[3];
        goe_rotation_apply(roll, v, rolled);
        goe_rotation_apply(pitch, rolled, pitched);
        goe_rotation_apply(yaw, pitched, yawed);
        check_turns(at_once, v[0], v[1], v[2], yawed[0], yawed[1], yawed[2]);
    }
    check_turns(yaw, 1.0f, 0.0f, 0.0f, 0.906307787f, 0.422618262f, 0.0f);
    check_turns(pitch, 1.0f, 0.0f, 0.0f, 0.766044443f, 0.0f, 0.642787610f); /* nose down */
    check_turns(roll, 0.0f, 1.0f, 0.0f, 0.0f, 0.342020143f, 0.939692621f);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(quaternion_turns_body_into_ned);
    RUN_TEST(quaternion_norm_and_sign_do_not_matter);
    RUN_TEST(every_rotation_is_proper);
    RUN_TEST(euler_angles_turn_yaw_then_pitch_then_roll);
    return UNITY_END();
}
