/* Rows of a box against a brute-force projection of its corners in double. SPDX-License-Identifier: MIT */
#include "refined/goe_box.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "sighting.h"

#define CASES 3000
#define RAD_PER_DEG 0.017453292519943295

typedef struct {
    double x, z;
} corner_t;

enum { FL, BL, BR, FR }; /* clockwise seen from above */

static check_random_t any;
static sighting_t sighting;
static double truth[GOE_STATES];
static int seen_at[GOE_FEATURES];   /* corner behind each feature */
static double held_z[GOE_FEATURES]; /* Z of a silhouette point: its height on the edge does not hang on the state's */
static size_t kind[GOE_ROWS_MAX];   /* feature of each row that should come */
static bool along_y[GOE_ROWS_MAX];  /* its coordinate */
static size_t expected_rows;

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

/* Corners now, in units of Z0. The side's depth solves side - front = d, side front = |sx| fx. */
static void corners_of(const double state[GOE_STATES], corner_t corner[4]) {
    const double d = state[GOE_DEPTH_DIFFERENCE];
    const double side = 0.5 * (d + sqrt(d * d + 4.0 * fabs(state[GOE_SIDE_X]) * state[GOE_FRONT_X]));
    const double front = -state[GOE_FRONT_X] * state[GOE_SIDE_X] / side;
    const double px = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * state[GOE_INVERSE_RANGE];
    const double pz = 1.0 - (double)sighting.sight.camera_m.z * state[GOE_INVERSE_RANGE];
    for (int i = 0; i < 4; i++) {
        const double across = i == BR || i == FR ? 0.5 : -0.5;
        const double along = i == BL || i == BR ? 1.0 : 0.0;
        corner[i].x = px + across * state[GOE_FRONT_X] + along * state[GOE_SIDE_X];
        corner[i].z = pz + across * front + along * side;
    }
}

/* The face from corner i clockwise to the next is seen if the camera lies on its outer side. */
static bool face_is_seen(const corner_t corner[4], int i) {
    const corner_t a = corner[i];
    const corner_t b = corner[(i + 1) % 4];
    return a.x * b.z - a.z * b.x > 1.0e-4; /* clearly */
}

static bool face_is_hidden(const corner_t corner[4], int i) {
    const corner_t a = corner[i];
    const corner_t b = corner[(i + 1) % 4];
    return a.x * b.z - a.z * b.x < -1.0e-4;
}

static double range2(corner_t c) { return c.x * c.x + c.z * c.z; }

/* Visible corners in image order; false if a face is seen from its end. */
static bool find_visible(const corner_t corner[4], int visible[4], int *count) {
    bool seen[4] = {false, false, false, false};
    *count = 0;
    for (int i = 0; i < 4; i++) {
        if (face_is_seen(corner, i)) {
            seen[i] = true;
            seen[(i + 1) % 4] = true;
        } else if (!face_is_hidden(corner, i)) {
            return false;
        }
    }
    for (int i = 0; i < 4; i++) {
        int at = *count;
        if (!seen[i]) {
            continue;
        }
        for (; at > 0 && corner[visible[at - 1]].x / corner[visible[at - 1]].z > corner[i].x / corner[i].z; at--) {
            visible[at] = visible[at - 1];
        }
        visible[at] = i;
        (*count)++;
    }
    return true;
}

/* Nearest, or farthest, corner; false if two are alike. */
static bool find_top(const corner_t corner[4], bool farthest, int *found) {
    bool clear = true;
    *found = 0;
    for (int i = 1; i < 4; i++) {
        *found = (range2(corner[i]) > range2(corner[*found])) == farthest ? i : *found;
    }
    for (int i = 0; i < 4; i++) {
        clear = clear && (i == *found || fabs(range2(corner[i]) - range2(corner[*found])) > 1.0e-4);
    }
    return clear;
}

static double height_of(const double state[GOE_STATES], int feature) {
    const double h = (double)sighting.sight.height_m;
    return feature == GOE_POINT_TOP ? h * state[GOE_INVERSE_RANGE] - state[GOE_TOP]
                                    : h * state[GOE_INVERSE_RANGE] + state[GOE_GROUND];
}

static void see(const double state[GOE_STATES], int feature, double seen[2]) {
    corner_t corner[4];
    corners_of(state, corner);
    const corner_t at = corner[seen_at[feature]];
    const bool silhouette = feature == GOE_POINT_LEFT || feature == GOE_POINT_RIGHT;
    const double y =
        silhouette ? sighting_height(&sighting, state, (size_t)feature) * held_z[feature] : height_of(state, feature);
    const double point[3] = {at.x, y, at.z};
    sighting_project(&sighting, state, point, seen);
}

static double predict(const sighting_t *of, const double state[GOE_STATES], size_t row) {
    double seen[2];
    const size_t feature = kind[row];
    see(state, (int)feature, seen);
    if (!along_y[row]) {
        return seen[0];
    }
    if (feature == GOE_POINT_TOP) {
        return seen[1];
    }
    const goe_spread_t spread = goe_observation_spread(&of->sight, (goe_feature_t)feature);
    return seen[1] - (double)spread.xy / (double)spread.xx * seen[0]; /* free of the first row's noise */
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

/* Any box that lies wholly ahead, of any orientation within a quarter turn of the axis. */
static void any_box(corner_t corner[4]) {
    bool ahead = false;
    while (!ahead) {
        sighting_start(&sighting, &any);
        const double b = check_random_between(&any, -80.0, 80.0) * RAD_PER_DEG;
        const double z0_m = check_random_between(&any, 40.0, 150.0);
        const double w = check_random_between(&any, 2.0, 20.0) / z0_m;
        const double l = check_random_between(&any, 2.0, 20.0) / z0_m;
        sighting.state[GOE_GROUND] = (float)(check_random_between(&any, -1.0, 1.0) / z0_m);
        sighting.state[GOE_BEARING] = (float)check_random_between(&any, -0.6, 0.6);
        sighting.state[GOE_INVERSE_RANGE] = (float)(1.0 / z0_m);
        sighting.state[GOE_SIDE_X] = (float)(l * sin(b));
        sighting.state[GOE_FRONT_X] = (float)(w * cos(b));
        sighting.state[GOE_DEPTH_DIFFERENCE] = (float)(l * cos(b) - w * fabs(sin(b)));
        sighting.state[GOE_TOP] = (float)(check_random_between(&any, 2.0, 40.0) / z0_m);
        sighting.settings.refined.top_is_highest = check_random_bits(&any) % 2u != 0u;
        for (int i = 0; i < GOE_STATES; i++) {
            truth[i] = (double)sighting.state[i];
        }
        corners_of(truth, corner);
        ahead = fabs(truth[GOE_SIDE_X]) > 1.0e-4; /* at 0 the depths have a kink */
        for (int i = 0; i < 4; i++) {
            ahead = ahead && corner[i].z > 0.15;
        }
    }
    sighting_look(&sighting);
}

static void expect_row(int feature, bool y) {
    kind[expected_rows] = (size_t)feature;
    along_y[expected_rows] = y;
    expected_rows++;
}

static void measure(int feature, int corner) {
    double seen[2];
    corner_t corners[4];
    corners_of(truth, corners);
    seen_at[feature] = corner;
    sighting.sight.point[feature].y = (float)check_random_between(&any, -0.15, 0.15);
    held_z[feature] = corners[corner].z;
    sighting.sight.point[feature].x = 0.0f;
    for (int i = 0; i < SETTLED; i++) { /* the height that is freed of the bias hangs on x a little */
        see(truth, feature, seen);
        sighting.sight.point[feature].x = (float)seen[0];
    }
    if (feature != GOE_POINT_LEFT && feature != GOE_POINT_RIGHT) {
        sighting.sight.point[feature].y = (float)seen[1];
    }
    sighting.sight.point[feature].usable = true;
}

static void check_rows(void) {
    sighting.sight.base =
        sighting.sight.point[GOE_POINT_BASE_LEFT].usable && sighting.sight.point[GOE_POINT_BASE_RIGHT].usable;
    sighting.sight.edge = sighting.sight.base;
    goe_rows_clear(&sighting.rows, &sighting.matrix);
    goe_box_rows(&sighting.sight, &sighting.rows);
    TEST_ASSERT_EQUAL_size_t(expected_rows, sighting.rows.count);
    for (size_t row = 0; row < expected_rows; row++) {
        TEST_ASSERT_EQUAL_size_t(kind[row], sighting.rows.feature[row]);
    }
    sighting_check_rows(&sighting, predict);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static const int faces_to_feature[3] = {GOE_POINT_BASE_LEFT, GOE_POINT_BASE_NEAR, GOE_POINT_BASE_RIGHT};

/* GIVEN boxes of any size, side and orientation WHEN all that can be seen is measured where brute force puts it THEN all
 * residuals are 0, so that the same corners were taken, and all derivatives are those of the projection. */
static void rows_are_those_of_the_corners_that_are_seen(void) {
    int faces[3] = {0, 0, 0};
    any = check_random_start("all features");
    for (int n = 0; n < CASES; n++) {
        corner_t corner[4];
        int visible[4];
        int count;
        int top;
        any_box(corner);
        const bool farthest = sighting.settings.refined.top_is_highest && height_of(truth, GOE_POINT_TOP) > 0.0;
        if (!find_visible(corner, visible, &count) || !find_top(corner, farthest, &top)) {
            continue;
        }
        expected_rows = 0;
        for (int i = 0; i < 3; i++) {
            if (count == 2 && i == 1) {
                continue;
            }
            measure(faces_to_feature[i], visible[count == 2 && i == 2 ? 1 : i]);
            expect_row(faces_to_feature[i], false);
            expect_row(faces_to_feature[i], true);
        }
        measure(GOE_POINT_LEFT, visible[0]);
        expect_row(GOE_POINT_LEFT, false);
        measure(GOE_POINT_RIGHT, visible[count - 1]);
        expect_row(GOE_POINT_RIGHT, false);
        measure(GOE_POINT_TOP, top);
        expect_row(GOE_POINT_TOP, true);
        check_rows();
        faces[count - 1]++;
    }
    check_report("boxes of which one face is seen", faces[1]);
    check_report("boxes of which two faces are seen", faces[2]);
    TEST_ASSERT_TRUE(faces[1] > CASES / 20 && faces[2] > CASES / 2);
}

/* GIVEN a silhouette alone THEN its corners are the outermost ones. */
static void a_silhouette_alone_takes_the_outermost_corners(void) {
    any = check_random_start("silhouette");
    for (int n = 0; n < CASES; n++) {
        corner_t corner[4];
        int left = 0;
        int right = 0;
        any_box(corner);
        for (int i = 1; i < 4; i++) {
            left = corner[i].x / corner[i].z < corner[left].x / corner[left].z ? i : left;
            right = corner[i].x / corner[i].z > corner[right].x / corner[right].z ? i : right;
        }
        expected_rows = 0;
        measure(GOE_POINT_LEFT, left);
        expect_row(GOE_POINT_LEFT, false);
        measure(GOE_POINT_RIGHT, right);
        expect_row(GOE_POINT_RIGHT, false);
        check_rows();
    }
}

/* GIVEN two faces of which the detector missed the corner between them WHEN the length is estimated THEN the outer corners
 * are those of both faces all the same, if that fits clearly better. */
static void a_missed_near_corner_is_told_from_a_single_face(void) {
    int checked = 0;
    any = check_random_start("missed corner");
    for (int n = 0; n < CASES; n++) {
        corner_t corner[4];
        int visible[4];
        int count;
        any_box(corner);
        memset(sighting.state, 0, 3 * sizeof sighting.state[0]); /* unbiased: the fits are compared without it */
        memset(truth, 0, 3 * sizeof truth[0]);
        sighting_look(&sighting);
        sighting.sight.two_faces = true;
        sighting.sight.point_px = 0.2f;
        const double clearly = 6.0 * 0.2 / 914.0;
        if (!find_visible(corner, visible, &count) || count != 3) {
            continue;
        }
        double narrowest = HUGE_VAL;
        for (int i = 0; i < 2; i++) {
            const corner_t a = corner[visible[i]];
            const corner_t b = corner[visible[i + 1]];
            narrowest = fmin(narrowest, b.x / b.z - a.x / a.z);
        }
        if (narrowest < clearly) {
            continue;
        }
        expected_rows = 0;
        for (int i = 0; i < 3; i += 2) {
            measure(faces_to_feature[i], visible[i]);
            expect_row(faces_to_feature[i], false);
            expect_row(faces_to_feature[i], true);
        }
        check_rows();
        checked++;
    }
    check_report("boxes checked", checked);
    TEST_ASSERT_TRUE(checked > 50);
}

/* The depths solve their two equations for any sign and size of their difference. */
static void depths_solve_their_equations(void) {
    any = check_random_start("depths");
    for (int n = 0; n < CASES; n++) {
        float state[GOE_STATES] = {0.0f};
        state[GOE_SIDE_X] = (float)check_random_between(&any, -0.3, 0.3);
        state[GOE_FRONT_X] = (float)check_random_between(&any, 0.001, 0.3);
        state[GOE_DEPTH_DIFFERENCE] = (float)check_random_between(&any, -0.3, 0.3);
        goe_box_edges_t edges;
        goe_box_edges(state, &edges);
        const double side = (double)edges.side.along.z;
        const double front = fabs((double)edges.front.along.z);
        const double product = fabs((double)state[GOE_SIDE_X]) * (double)state[GOE_FRONT_X];
        CHECK_CLOSE(1.0e-7, state[GOE_DEPTH_DIFFERENCE], side - front);
        CHECK_CLOSE(1.0e-6 * product + 1.0e-12, product, side * front);
        TEST_ASSERT_TRUE(side >= 0.0 && edges.front.along.z * state[GOE_SIDE_X] <= 0.0f);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_are_those_of_the_corners_that_are_seen);
    RUN_TEST(a_silhouette_alone_takes_the_outermost_corners);
    RUN_TEST(a_missed_near_corner_is_told_from_a_single_face);
    RUN_TEST(depths_solve_their_equations);
    return UNITY_END();
}
