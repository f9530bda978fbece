/* First guess of a box from exact base corners. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_box_start.c */
#include "refined/goe_box_start.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "sighting.h"

#define CASES 2000
#define RAD_PER_DEG 0.017453292519943295

typedef struct {
    double x, z; /* from the camera, m */
} place_t;

static check_random_t any;
static sighting_t sighting;
static goe_first_box_t box;

void setUp(void) { memset(&box, 0, sizeof box); }
void tearDown(void) {}

/* A level camera that knows its attitude, 20 m above the ground, moved by (3, 25) m; a state that knows the range. */
static void look_from(double range_m) {
    sighting_start(&sighting, &any);
    memset(sighting.state, 0, sizeof sighting.state);
    sighting.state[GOE_INVERSE_RANGE] = (float)(1.0 / (range_m + 25.0));
    sighting_look(&sighting);
}

static void measure(size_t feature, place_t at) {
    sighting.sight.point[feature].x = (float)(at.x / at.z);
    sighting.sight.point[feature].y = (float)(20.0 / at.z);
    sighting.sight.point[feature].usable = true;
    sighting.sight.base =
        sighting.sight.point[GOE_POINT_BASE_LEFT].usable && sighting.sight.point[GOE_POINT_BASE_RIGHT].usable;
    sighting.sight.edge = sighting.sight.base;
}

/* Reference point in T from a and q, relative to the camera now. */
static place_t reference_of(const goe_first_box_t *of) {
    const double c = (double)of->turn_cos;
    const double s = (double)of->turn_sin;
    const double z = 1.0 / (double)of->q - (s * 3.0 + c * 25.0);
    const double x = (double)of->a / (double)of->q - (c * 3.0 - s * 25.0);
    const place_t place = {c * x + s * z, c * z - s * x};
    return place;
}

static double width_of(const goe_first_box_t *of) { return (double)of->width / (double)of->q; }
static double length_of(const goe_first_box_t *of) { return (double)of->length / (double)of->q; }

/* ------------------------------------------------------------------------------------------------------------ one face -- */

/* The face from `left` to `right`, with the harmonic mean of both ranges as the state's. */
static void show_face(place_t left, place_t right) {
    look_from(2.0 / (1.0 / left.z + 1.0 / right.z));
    measure(GOE_POINT_BASE_LEFT, left);
    measure(GOE_POINT_BASE_RIGHT, right);
}

/* [(R18)] GIVEN the front of any box, exact corners and range THEN orientation, width and reference point are exact. */
static void a_front_alone_is_exact(void) {
    any = check_random_start("front");
    for (int n = 0; n < CASES; n++) {
        const double b = check_random_between(&any, -40.0, 40.0) * RAD_PER_DEG;
        const double w = check_random_between(&any, 3.0, 12.0);
        const place_t middle = {check_random_between(&any, -20.0, 20.0), check_random_between(&any, 45.0, 80.0)};
        const place_t left = {middle.x - 0.5 * w * cos(b), middle.z + 0.5 * w * sin(b)};
        const place_t right = {middle.x + 0.5 * w * cos(b), middle.z - 0.5 * w * sin(b)};
        show_face(left, right);
        sighting.sight.point_px = 0.05f;
        sighting.settings.navigation.attitude_bias_sd_deg = 0.05f;
        TEST_ASSERT_TRUE(goe_box_of_one_face(&sighting.sight, &box));
        const place_t reference = reference_of(&box);
        CHECK_CLOSE(1.0e-4, b, box.orientation_rad);
        CHECK_CLOSE(1.0e-4, sin(b), box.sine);
        CHECK_CLOSE(1.0e-4, cos(b), box.cosine);
        CHECK_CLOSE(1.0e-4 * w, w, width_of(&box));
        CHECK_CLOSE(1.0e-4 * middle.z, middle.x, reference.x);
        CHECK_CLOSE(1.0e-4 * middle.z, middle.z, reference.z);
        TEST_ASSERT_TRUE(box.sigma_rad > 0.0f && box.sigma_rad < 0.2f);
    }
}

/* [(R18)] GIVEN a face that lies more along than across THEN it is the side, and its near end is a corner of the front: the right one
 * if the side lies to the right of it, viewed from outside. */
static void a_side_alone_has_its_near_end_on_the_front(void) {
    any = check_random_start("side");
    for (int n = 0; n < CASES; n++) {
        const bool on_right = n % 2 != 0; /* the right side of a box on the left of the camera */
        const double b = check_random_between(&any, -25.0, 25.0) * RAD_PER_DEG;
        const double l = check_random_between(&any, 4.0, 12.0);
        const double aside = check_random_between(&any, 25.0, 35.0);
        const place_t near = {on_right ? -aside : aside, check_random_between(&any, 40.0, 50.0)};
        const place_t far = {near.x + l * sin(b), near.z + l * cos(b)};
        if (on_right ? near.x / near.z > far.x / far.z - 0.01 : near.x / near.z < far.x / far.z + 0.01) {
            continue; /* that side is not visible */
        }
        show_face(on_right ? near : far, on_right ? far : near);
        sighting.sight.point_px = 0.05f;
        sighting.settings.navigation.attitude_bias_sd_deg = 0.05f;
        TEST_ASSERT_TRUE(goe_box_of_one_face(&sighting.sight, &box));
        const place_t reference = reference_of(&box);
        const double half = (on_right ? -0.5 : 0.5) * width_of(&box); /* from the corner to the middle of the front */
        CHECK_CLOSE(2.0e-4, b, box.orientation_rad);
        CHECK_CLOSE(2.0e-4 * l, l, length_of(&box));
        CHECK_CLOSE(2.0e-4 * near.z, near.x + half * cos(b), reference.x);
        CHECK_CLOSE(2.0e-4 * near.z, near.z - half * sin(b), reference.z);
    }
}

/* [(R18)] GIVEN noise THEN the reported sigma of the orientation is at least its effect on the orientation. */
static void the_sigma_covers_the_noise(void) {
    const int draws = 2000;
    double sum2 = 0.0;
    double reported = 0.0;
    any = check_random_start("sigma");
    for (int n = 0; n < draws; n++) {
        show_face((place_t){-6.0, 51.0}, (place_t){2.0, 49.0});
        sighting.sight.point_px = 0.3f;
        for (size_t i = GOE_POINT_BASE_LEFT; i <= GOE_POINT_BASE_RIGHT; i += 2) {
            sighting.sight.point[i].x += (float)(0.3 / 914.0 * check_random_normal(&any));
            sighting.sight.point[i].y += (float)(0.3 / 914.0 * check_random_normal(&any));
        }
        TEST_ASSERT_TRUE(goe_box_of_one_face(&sighting.sight, &box));
        const double error = (double)box.orientation_rad - atan2(2.0, 8.0);
        sum2 += error * error;
        reported = (double)box.sigma_rad;
    }
    check_report("rms error of the orientation over the reported sigma", sqrt(sum2 / draws) / reported);
    TEST_ASSERT_TRUE(sqrt(sum2 / draws) < reported);
    TEST_ASSERT_TRUE(sqrt(sum2 / draws) > 0.2 * reported);
}

/* GIVEN a face and an attitude that may be off by a roll THEN the roll tilts the face's ends against each other, which looks like a
 * depth: over the height that the camera has, by the square of the face's extent across. */
static void a_roll_looks_like_a_depth(void) {
    any = check_random_start("roll");
    const place_t left = {-5.0, 60.0};
    const place_t right = {5.0, 60.0};
    double sigma[2];
    for (int n = 0; n < 2; n++) {
        show_face(left, right);
        sighting.sight.point_px = 0.05f;
        sighting.settings.navigation.attitude_bias_sd_deg = n == 0 ? 0.001f : 1.0f;
        TEST_ASSERT_TRUE(goe_box_of_one_face(&sighting.sight, &box));
        sigma[n] = (double)box.sigma_rad;
    }
    const double tilt = 60.0 / 20.0 * (1.0 * RAD_PER_DEG) * 10.0 * 10.0; /* m of depth times m of width */
    const double added = sqrt(sigma[1] * sigma[1] - sigma[0] * sigma[0]) * 100.0;
    CHECK_CLOSE(0.01 * tilt, tilt, added);
}

/* The next image shows a face of 8 m that falls back by `back_m` to the right, across the line of sight. Returns how many images agree by
 * now. */
static int agreeing_after(goe_filter_t *filter, double back_m) {
    const double across_m = sqrt(64.0 - back_m * back_m);
    const place_t middle = {-70.0 / 8.0 * back_m, 70.0 / 8.0 * across_m};
    show_face((place_t){middle.x - 0.5 * across_m, middle.z - 0.5 * back_m},
              (place_t){middle.x + 0.5 * across_m, middle.z + 0.5 * back_m});
    sighting.sight.point_px = 0.05f;
    sighting.settings.navigation.attitude_bias_sd_deg = 0.05f;
    TEST_ASSERT_FALSE(goe_box_start(filter, &sighting.sight));
    return filter->candidate.agreeing;
}

/* GIVEN two ends askew across the line of sight WHEN the camera is not in front of them THEN they are the ends of two faces, and
 * no image agrees; nor does any while the near corner was visible shortly before. */
static void ends_that_would_show_a_second_face_are_none_of_one(void) {
    any = check_random_start("askew");
    for (int n = 0; n < 2; n++) {
        goe_filter_t filter;
        goe_filter_clear(&filter);
        filter.candidate.near_images = n == 0 ? 0 : 3;
        for (int k = 0; k < 4; k++) {
            const double back_m = n == 0 ? 4.0 : 0.0;
            show_face((place_t){-4.0, 70.0 - back_m}, (place_t){4.0, 70.0 + back_m});
            sighting.sight.point_px = 0.05f;
            sighting.settings.navigation.attitude_bias_sd_deg = 0.05f;
            TEST_ASSERT_FALSE(goe_box_start(&filter, &sighting.sight));
            TEST_ASSERT_EQUAL_UINT8(0, filter.candidate.agreeing);
        }
    }
}

/* GIVEN a face near 45 degrees, which is the front in one image and the side in the other THEN the two images agree in either order;
 * a face that has turned by 20 degrees does not agree. */
static void a_front_that_becomes_a_side_agrees_with_itself(void) {
    static const double back_m[2] = {5.65, 5.66}; /* a front, and a side: 8 m over the root of 2 is between them */
    any = check_random_start("exchanged");
    for (int order = 0; order < 2; order++) {
        goe_filter_t filter;
        goe_filter_clear(&filter);
        TEST_ASSERT_EQUAL_INT(1, agreeing_after(&filter, back_m[order]));
        const float before = filter.candidate.extent[0];
        TEST_ASSERT_EQUAL_INT(2, agreeing_after(&filter, back_m[1 - order]));
        CHECK_CLOSE(0.01, -(double)before, filter.candidate.extent[0]);
        CHECK_CLOSE(0.01, 45.0 * RAD_PER_DEG, fabs((double)before));
        TEST_ASSERT_EQUAL_INT(1, agreeing_after(&filter, 8.0 * sin(65.0 * RAD_PER_DEG)));
    }
}

/* ----------------------------------------------------------------------------------------------------------- two faces -- */

/* In the axes of the line of sight to the near corner: the left face is left_m wide and as deep as the right one, which is
 * right_m wide; both are square to each other if the depth is sqrt(left right). */
static void show_two_faces(double left_m, double right_m, double range_m, double bearing_rad) {
    const double c = cos(bearing_rad);
    const double s = sin(bearing_rad);
    const double deep_m = sqrt(left_m * right_m);
    const place_t corners[3] = {{-left_m, range_m + deep_m}, {0.0, range_m}, {right_m, range_m + deep_m}};
    look_from(range_m * c);
    for (size_t i = 0; i < 3; i++) {
        const place_t turned = {c * corners[i].x + s * corners[i].z, c * corners[i].z - s * corners[i].x};
        measure(GOE_POINT_BASE_LEFT + i, turned);
    }
}

/* [(R17)] GIVEN a box whose faces reach equally deep, as the guess takes all boxes WHEN it is small against its range THEN the guess is
 * right to twice its size over its range. */
static void two_faces_of_equal_depth_are_right_to_first_order(void) {
    any = check_random_start("two faces");
    for (int n = 0; n < CASES; n++) {
        const double left = check_random_between(&any, 1.0, 4.0);
        const double right = check_random_between(&any, 1.0, 4.0);
        const double range = check_random_between(&any, 80.0, 200.0);
        const double bearing = check_random_between(&any, -0.5, 0.5);
        show_two_faces(left, right, range, bearing);
        sighting.sight.point_px = 0.1f;
        TEST_ASSERT_TRUE(goe_box_of_two_faces(&sighting.sight, &box));
        const double deep = sqrt(left * right);
        const double share = 3.0 * deep / range * (1.0 + fabs(tan(bearing)) * deep);
        const double on_left = hypot(left, deep);
        const double on_right = hypot(right, deep);
        const bool exchanged = (double)box.sine < 0.0; /* front is the right face */
        CHECK_CLOSE(1.0e-5, sin(bearing), box.turn_sin);
        CHECK_CLOSE(1.0e-5, cos(bearing), box.turn_cos);
        CHECK_CLOSE(share * on_left, exchanged ? on_right : on_left, width_of(&box));
        CHECK_CLOSE(share * on_right, exchanged ? on_left : on_right, length_of(&box));
        CHECK_CLOSE(share, exchanged ? -left / on_left : right / on_right, box.sine);
        CHECK_CLOSE(1.0e-6, 1.0, (double)box.sine * (double)box.sine + (double)box.cosine * (double)box.cosine);
        TEST_ASSERT_TRUE(fabs((double)box.sine) <= 0.75); /* the side lies more along than across */
        const place_t reference = reference_of(&box);
        const double aside = exchanged ? 0.5 * right : -0.5 * left;
        const double ahead = range + 0.5 * deep;
        const double x = cos(bearing) * aside + sin(bearing) * ahead;
        const double z = cos(bearing) * ahead - sin(bearing) * aside;
        CHECK_CLOSE(0.05 * deep + share, x, reference.x);
        CHECK_CLOSE(0.05 * deep + share, z, reference.z);
    }
}

/* ------------------------------------------------------------------------------------------------------------ refusals -- */

static bool one_face(void) { return goe_box_of_one_face(&sighting.sight, &box); }
static bool two_faces(void) { return goe_box_of_two_faces(&sighting.sight, &box); }

static void good_face(void) {
    show_face((place_t){-6.0, 51.0}, (place_t){2.0, 49.0});
    TEST_ASSERT_TRUE(one_face());
}

static void good_box(void) {
    show_two_faces(3.0, 3.0, 60.0, 0.1);
    TEST_ASSERT_TRUE(two_faces());
}

/* [(R18)] */
static void an_unobservable_quantity_of_one_face_is_refused(void) {
    any = check_random_start("refusals");
    good_face();
    sighting.sight.base = false;
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.sight.height_m = 0.2f; /* on the ground: no depth */
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.state[GOE_GROUND] = -19.8f * sighting.state[GOE_INVERSE_RANGE];
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.state[GOE_INVERSE_RANGE] = 1.0f / 25.5f; /* the obstacle is passed */
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.state[GOE_INVERSE_RANGE] = -0.01f;
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.sight.point[GOE_POINT_BASE_RIGHT].y *= 3.0f; /* no corner is that near */
    TEST_ASSERT_FALSE(one_face());
    good_face();
    sighting.sight.point_px = 20.0f; /* orientation worse than 0.2 rad */
    TEST_ASSERT_FALSE(one_face());
    show_face((place_t){-20.0, 51.0}, (place_t){20.0, 49.0}); /* larger than 0.4 of the range */
    TEST_ASSERT_FALSE(one_face());
    show_face((place_t){0.0, 5.0},
              (place_t){1.0e-4, 5.0}); /* a tenth of a millimeter has no direction, whatever its sigma */
    TEST_ASSERT_FALSE(one_face());
    TEST_ASSERT_TRUE(box.sigma_rad < 0.2f);
}

/* [(R17)] */
static void an_unobservable_quantity_of_two_faces_is_refused(void) {
    any = check_random_start("refusals");
    good_box();
    sighting.sight.base = false;
    TEST_ASSERT_FALSE(two_faces());
    good_box();
    sighting.sight.point[GOE_POINT_BASE_NEAR].usable = false;
    TEST_ASSERT_FALSE(two_faces());
    good_box();
    sighting.sight.point[GOE_POINT_BASE_NEAR].x =
        sighting.sight.point[GOE_POINT_BASE_RIGHT].x - 0.5f / 914.0f; /* a face of half a pixel */
    TEST_ASSERT_FALSE(two_faces());
    good_box();
    sighting.sight.point[GOE_POINT_BASE_NEAR].x =
        sighting.sight.point[GOE_POINT_BASE_RIGHT].x + 0.01f; /* not between */
    TEST_ASSERT_FALSE(two_faces());
    good_box();
    sighting.state[GOE_INVERSE_RANGE] = 1.0f / 25.5f;
    TEST_ASSERT_FALSE(two_faces());
    show_two_faces(30.0, 30.0, 60.0, 0.1);
    TEST_ASSERT_FALSE(two_faces());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_front_alone_is_exact);
    RUN_TEST(a_side_alone_has_its_near_end_on_the_front);
    RUN_TEST(the_sigma_covers_the_noise);
    RUN_TEST(a_roll_looks_like_a_depth);
    RUN_TEST(ends_that_would_show_a_second_face_are_none_of_one);
    RUN_TEST(a_front_that_becomes_a_side_agrees_with_itself);
    RUN_TEST(two_faces_of_equal_depth_are_right_to_first_order);
    RUN_TEST(an_unobservable_quantity_of_one_face_is_refused);
    RUN_TEST(an_unobservable_quantity_of_two_faces_is_refused);
    return UNITY_END();
}
