/* Changes of the model: the information is expressed in other states, and nothing of it is lost or made up. SPDX-License-Identifier: MIT
 *
 * The covariance after a change, less what the change adds on purpose, must be the one before, by the derivatives of the old states
 * by the new ones, which are taken here as differences, in double. */
/* tests: lib/refined/goe_box_start.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "refined/goe_box.h"
#include "refined/goe_box_start.h"
#include "sighting.h"

#define CASES 100
#define STEP 1.0e-6
#define RAD_PER_DEG 0.017453292519943295
#define SHARE 4.0e-3 /* of a covariance's size: rounding of the root */

typedef double covariance_t[GOE_STATES][GOE_STATES];
typedef void (*map_t)(const double by[GOE_STATES], double to[GOE_STATES]);

static check_random_t any;
static goe_filter_t filter;
static sighting_t sighting;

void setUp(void) {}
void tearDown(void) {}

/* --------------------------------------------------------------------------------------------------------- covariance -- */

static void covariance_of(covariance_t c) { inverse_covariance(&filter.root, c); }

/* The states in some triangle, each with its uncertainty and a correlation with all that follow. */
static void be_uncertain(const double sigma[GOE_STATES]) {
    goe_srif_clear(&filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&filter.root, i, i) = (float)(1.0 / sigma[i]);
        for (size_t j = i + 1; j < GOE_STATES; j++) {
            *goe_srif_at(&filter.root, i, j) = (float)(check_random_between(&any, -0.4, 0.4) / sigma[j]);
        }
    }
}

/* J C J' of the first `count` states. */
static void carry(size_t count, double by[GOE_STATES][GOE_STATES], covariance_t c, covariance_t to) {
    covariance_t half;
    for (size_t i = 0; i < count; i++) {
        for (size_t l = 0; l < count; l++) {
            half[i][l] = 0.0;
            for (size_t k = 0; k < count; k++) {
                half[i][l] += by[i][k] * c[k][l];
            }
        }
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < count; j++) {
            to[i][j] = 0.0;
            for (size_t l = 0; l < count; l++) {
                to[i][j] += half[i][l] * by[j][l];
            }
        }
    }
}

static void check_same(size_t count, covariance_t expected, covariance_t actual) {
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < count; j++) {
            CHECK_CLOSE(SHARE * sqrt(expected[i][i] * expected[j][j]), expected[i][j], actual[i][j]);
        }
    }
}

static void read_state(double x[GOE_STATES]) {
    for (size_t i = 0; i < GOE_STATES; i++) {
        x[i] = (double)filter.state[i];
    }
}

/* Derivatives of `map` where the filter is now. */
static void differences(map_t map, double by[GOE_STATES][GOE_STATES]) {
    double x[GOE_STATES];
    read_state(x);
    for (size_t k = 0; k < GOE_STATES; k++) {
        double up[GOE_STATES];
        double down[GOE_STATES];
        const double at = x[k];
        x[k] = at + STEP;
        map(x, up);
        x[k] = at - STEP;
        map(x, down);
        x[k] = at;
        for (size_t i = 0; i < GOE_STATES; i++) {
            by[i][k] = (up[i] - down[i]) / (2.0 * STEP);
        }
    }
}

/* `before` is the covariance now, less the added one, in the old states. */
static void check_carried(map_t to_old, covariance_t before, const double added[GOE_STATES]) {
    covariance_t now;
    covariance_t carried;
    double by[GOE_STATES][GOE_STATES];
    covariance_of(now);
    for (size_t i = 0; i < GOE_STATES; i++) {
        now[i][i] -= added[i];
    }
    differences(to_old, by);
    carry(GOE_STATES, by, now, carried);
    check_same(GOE_STATES, before, carried);
}

static void check_state(map_t to_old, const double was[GOE_STATES]) {
    double is[GOE_STATES];
    double back[GOE_STATES];
    read_state(is);
    to_old(is, back);
    for (size_t i = 0; i < GOE_STATES; i++) {
        CHECK_CLOSE(2.0e-5, was[i], back[i]);
    }
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

static void start(void) {
    memset(&filter, 0, sizeof filter);
    filter.axes.turn_cos = 1.0f;
    sighting_start(&sighting, &any);
    sighting.sight.state = filter.state;
    sighting.sight.camera_m.x = (float)check_random_between(&any, -6.0, 6.0);
    filter.state[GOE_GROUND] = (float)check_random_between(&any, -0.02, 0.02);
    filter.state[GOE_BEARING] = (float)check_random_between(&any, -0.3, 0.3);
    filter.state[GOE_INVERSE_RANGE] = (float)(1.0 / check_random_between(&any, 60.0, 120.0));
    filter.state[GOE_TOP] = (float)check_random_between(&any, 0.02, 0.2);
    goe_observation_linearise(&sighting.sight);
}

/* As the edges of goe_box.h are defined: square to each other, their depths the two that differ by d. */
static void edges_of(const double x[GOE_STATES], double *side_z, double *front_z) {
    const double d = x[GOE_DEPTH_DIFFERENCE];
    const double sum = sqrt(d * d + 4.0 * fabs(x[GOE_SIDE_X]) * x[GOE_FRONT_X]);
    *side_z = 0.5 * (sum + d);
    *front_z = (x[GOE_SIDE_X] > 0.0 ? -0.5 : 0.5) * (sum - d);
}

/* ------------------------------------------------------------------------------------------------ front and side change names -- */

/* The box with its names exchanged: the other edge is called front, from whose middle all counts then. */
static void renamed(const double x[GOE_STATES], double to[GOE_STATES]) {
    double side_z;
    double front_z;
    edges_of(x, &side_z, &front_z);
    const double sign = x[GOE_SIDE_X] > 0.0 ? 1.0 : -1.0;
    /* from the middle of the front half a front to the end at which the side becomes the front, and half of that */
    const double zeta = 1.0 + 0.5 * (sign * front_z + side_z);
    memcpy(to, x, GOE_STATES * sizeof to[0]);
    to[GOE_GROUND] = x[GOE_GROUND] / zeta;
    to[GOE_BEARING] = (x[GOE_BEARING] + 0.5 * (sign * x[GOE_FRONT_X] + x[GOE_SIDE_X])) / zeta;
    to[GOE_INVERSE_RANGE] = x[GOE_INVERSE_RANGE] / zeta;
    to[GOE_SIDE_X] = -sign * x[GOE_FRONT_X] / zeta;
    to[GOE_FRONT_X] = fabs(x[GOE_SIDE_X]) / zeta;
    to[GOE_DEPTH_DIFFERENCE] = (fabs(front_z) - side_z) / zeta;
    to[GOE_TOP] = x[GOE_TOP] / zeta;
}

/* GIVEN a box viewed from so far aside that its side is across THEN side and front change names, and all information
 * on the one is that on the other. */
static void a_box_by_other_names_is_known_as_well(void) {
    const double sigma[GOE_STATES] = {0.01, 0.01, 0.01, 0.005, 0.01, 2.0e-4, 0.01, 0.01, 0.01, 0.01};
    const double nothing[GOE_STATES] = {0.0};
    any = check_random_start("other names");
    for (int n = 0; n < CASES; n++) {
        covariance_t before;
        double was[GOE_STATES];
        start();
        filter.phase = GOE_PHASE_BOX;
        filter.state[GOE_SIDE_X] = (float)((n % 2 == 0 ? 1.0 : -1.0) * check_random_between(&any, 0.1, 0.2));
        filter.state[GOE_FRONT_X] = (float)check_random_between(&any, 0.03, 0.05);
        filter.state[GOE_DEPTH_DIFFERENCE] = (float)check_random_between(&any, -0.08, -0.02);
        be_uncertain(sigma);
        covariance_of(before);
        read_state(was);
        TEST_ASSERT_TRUE(goe_box_change(&filter, &sighting.sight));
        TEST_ASSERT_TRUE(filter.naming.exchanged);
        check_state(renamed, was);
        check_carried(renamed, before, nothing);
    }
}

/* GIVEN a box with one visible face WHEN the second comes into view THEN its length, which was fixed, is open by twice itself, along
 * the side and nothing else. */
static void a_second_face_opens_the_length_alone(void) {
    const double sigma[GOE_STATES] = {0.01, 0.01, 0.01, 0.005, 0.01, 2.0e-4, 0.01, 0.01, 0.01, 0.01};
    any = check_random_start("second face");
    for (int n = 0; n < CASES; n++) {
        covariance_t before;
        covariance_t now;
        double x[GOE_STATES];
        double side_z;
        double front_z;
        start();
        filter.phase = GOE_PHASE_BOX_FACE;
        filter.state[GOE_SIDE_X] = (float)check_random_between(&any, -0.05, 0.05);
        filter.state[GOE_FRONT_X] = (float)check_random_between(&any, 0.03, 0.1);
        filter.state[GOE_DEPTH_DIFFERENCE] = (float)check_random_between(&any, 0.05, 0.1);
        be_uncertain(sigma);
        covariance_of(before);
        read_state(x);
        edges_of(x, &side_z, &front_z);
        sighting.sight.point[GOE_POINT_BASE_NEAR].usable = true;
        TEST_ASSERT_FALSE(goe_box_change(&filter, &sighting.sight)); /* without the outer corners it is none */
        sighting.sight.base = true;
        TEST_ASSERT_TRUE(goe_box_change(&filter, &sighting.sight));
        TEST_ASSERT_EQUAL_INT(GOE_PHASE_BOX, filter.phase);
        const double along[GOE_STATES] = {[GOE_SIDE_X] = 2.0 * x[GOE_SIDE_X], [GOE_DEPTH_DIFFERENCE] = 2.0 * side_z};
        for (size_t i = 0; i < GOE_STATES; i++) {
            for (size_t j = 0; j < GOE_STATES; j++) {
                before[i][j] += along[i] * along[j];
            }
        }
        covariance_of(now);
        check_same(GOE_STATES, before, now);
    }
}

/* -------------------------------------------------------------------------------------------------------- a box starts -- */

/* A footprint whose base corners have shown the two faces, or the one, of the same box often enough before. */
static void make_footprint(bool both, goe_first_box_t *box) {
    const double sigma[GOE_STATES] = {0.01, 0.01, 0.01, 0.005, 0.01, 1.0e-4, 0.01, 0.01, 0.01, 0.01};
    const double z = 1.0 / (double)filter.state[GOE_INVERSE_RANGE] - 25.0;
    const double x = check_random_between(&any, -0.2, 0.2);
    const double xs[3] = {x - 0.06, x + 0.01, x + 0.07};
    /* a face that is visible alone is across the line of sight: an oblique one shows a second one */
    const double nearer[3] = {both ? 0.04 : -0.06 * x, 0.0, both ? -0.04 : 0.07 * x};
    filter.phase = GOE_PHASE_FOOTPRINT;
    filter.state[GOE_HALF] = 0.05f;
    be_uncertain(sigma);
    filter.due_s = filter.walk_s[0] = 0.5f;
    sighting.sight.since_s = 0.5f;
    sighting.settings.navigation.attitude_walk_sd_deg = (float)(sqrt(8.0e-5) / RAD_PER_DEG);
    sighting.settings.navigation.position_walk_sd_m = (float)sqrt(6.0e-5) / filter.state[GOE_INVERSE_RANGE];
    for (size_t i = 0; i < 3; i++) {
        goe_point_t *p = &sighting.sight.point[GOE_POINT_BASE_LEFT + i];
        p->x = (float)xs[i];
        p->y = (float)(20.0 / z * (1.0 + nearer[i]));
        p->usable = both || i != 1;
    }
    sighting.sight.base = true;
    sighting.sight.point_px = 0.1f;
    sighting.settings.navigation.attitude_bias_sd_deg = 0.01f;
    memset(box, 0, sizeof *box);
    TEST_ASSERT_TRUE(both ? goe_box_of_two_faces(&sighting.sight, box) : goe_box_of_one_face(&sighting.sight, box));
    filter.candidate.both = both;
    filter.candidate.agreeing = 2;
    filter.candidate.extent[0] = both ? box->left : box->orientation_rad;
    filter.candidate.extent[1] = both ? box->right : 0.0f;
}

static goe_first_box_t first_box; /* that the corners show */
static double scale;              /* of its units by the footprint's */

/* Ground, bearing and range about the axes of the box. */
static void turned(const double x[GOE_STATES], double to[GOE_STATES]) {
    const double c = (double)first_box.turn_cos;
    const double s = (double)first_box.turn_sin;
    const double zeta = x[GOE_BEARING] * s + c;
    memcpy(to, x, GOE_STATES * sizeof to[0]);
    to[GOE_GROUND] = x[GOE_GROUND] * scale;
    to[GOE_BEARING] = (x[GOE_BEARING] * c - s) / zeta;
    to[GOE_INVERSE_RANGE] = x[GOE_INVERSE_RANGE] / zeta;
}

/* GIVEN a footprint that becomes a box THEN it keeps its information on attitude, ground, place and range, with the process noise of
 * biases and place that is due; the place is open again by the size of the box, as another point of it counts from now on, and the range
 * by as much; the axes turn on to the box's; extents are open but for the length of a single face, which nothing determines. */
static void a_box_starts_from_the_footprint(void) {
    any = check_random_start("a box starts");
    for (int n = 0; n < CASES; n++) {
        const bool both = n % 2 == 0;
        covariance_t before;
        covariance_t expected;
        covariance_t now;
        double by[GOE_STATES][GOE_STATES];
        start();
        memset(filter.state, 0, 3 * sizeof filter.state[0]);
        goe_observation_linearise(&sighting.sight);
        make_footprint(both, &first_box);
        const double turn = check_random_between(&any, -1.5, 1.5); /* the axes faced the obstacle */
        filter.axes.turn_cos = (float)cos(turn);
        filter.axes.turn_sin = (float)sin(turn);
        covariance_of(before);
        for (size_t i = 0; i < 3; i++) {
            before[i][i] += 4.0e-5;
        }
        before[GOE_BEARING][GOE_BEARING] += 3.0e-5;
        scale = (double)first_box.q / (double)filter.state[GOE_INVERSE_RANGE];
        differences(turned, by);
        const double top = (double)filter.state[GOE_TOP] * scale;
        const double ground = (double)filter.state[GOE_GROUND] * scale;
        TEST_ASSERT_TRUE(goe_box_start(&filter, &sighting.sight));
        const double size = fmax((double)first_box.width, (double)first_box.length);
        carry(GOE_KEPT, by, before, expected);
        expected[GOE_BEARING][GOE_BEARING] = 4.0 * expected[GOE_BEARING][GOE_BEARING] + 16.0 * size * size + 1.0e-6;
        expected[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] = 2.0 * expected[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] +
                                                         size * size * (double)first_box.q * (double)first_box.q;
        covariance_of(now);
        check_same(GOE_KEPT, expected, now);
        const double sigma[] = {2.0 * fmax(fabs(top), size), 2.0 * size, 2.0 * size, (both ? 4.0 : 0.01) * size};
        for (size_t i = 0; i < 4; i++) {
            CHECK_CLOSE(1.0e-3 * sigma[i], sigma[i], sqrt(now[GOE_KEPT + i][GOE_KEPT + i]));
        }
        CHECK_CLOSE(1.0e-6, top, filter.state[GOE_TOP]);
        CHECK_CLOSE(1.0e-6, ground, filter.state[GOE_GROUND]);
        const double turned_on = turn + atan2((double)first_box.turn_sin, (double)first_box.turn_cos);
        CHECK_CLOSE(1.0e-6, cos(turned_on), filter.axes.turn_cos);
        CHECK_CLOSE(1.0e-6, sin(turned_on), filter.axes.turn_sin);
        CHECK_SAME(0.0f, filter.due_s); /* it is in the covariance now, and must not count twice */
        TEST_ASSERT_EQUAL_INT(both ? GOE_PHASE_BOX : GOE_PHASE_BOX_FACE, filter.phase);
    }
}

/* GIVEN one face WHEN its orientation differs from that of the image before THEN the count of images that agree begins again with
 * this one; nor do images of one face and of two agree. */
static void only_images_that_agree_start_a_box(void) {
    goe_first_box_t box;
    any = check_random_start("agreement");
    start();
    memset(filter.state, 0, 3 * sizeof filter.state[0]);
    goe_observation_linearise(&sighting.sight);
    make_footprint(false, &box);
    filter.candidate.extent[0] = box.orientation_rad + 0.5f;
    TEST_ASSERT_FALSE(goe_box_start(&filter, &sighting.sight));
    TEST_ASSERT_EQUAL_UINT8(1, filter.candidate.agreeing);
    TEST_ASSERT_FALSE(goe_box_start(&filter, &sighting.sight));
    TEST_ASSERT_EQUAL_UINT8(2, filter.candidate.agreeing);
    TEST_ASSERT_TRUE(goe_box_start(&filter, &sighting.sight)); /* the third */
    start();
    memset(filter.state, 0, 3 * sizeof filter.state[0]);
    make_footprint(true, &box);
    filter.candidate.both = false;
    TEST_ASSERT_FALSE(goe_box_start(&filter, &sighting.sight));
    TEST_ASSERT_EQUAL_UINT8(1, filter.candidate.agreeing);
    TEST_ASSERT_TRUE(goe_box_start(&filter, &sighting.sight)); /* the second */
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_box_by_other_names_is_known_as_well);
    RUN_TEST(a_second_face_opens_the_length_alone);
    RUN_TEST(a_box_starts_from_the_footprint);
    RUN_TEST(only_images_that_agree_start_a_box);
    return UNITY_END();
}
