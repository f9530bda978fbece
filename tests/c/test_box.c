/* Rows of a box against a brute-force projection of its corners in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_box.c */
#include "refined/goe_box.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "sighting.h"

#define CASES 3000
#define RAD_PER_DEG 0.017453292519943295

typedef struct {
    double x, z;
} corner_t;

enum { FL, BL, BR, FR }; /* clockwise as viewed from above */

static check_random_t any;
static sighting_t sighting;
static double truth[GOE_STATES];
static int seen_at[GOE_FEATURES];  /* corner behind each feature */
static size_t kind[GOE_ROWS_MAX];  /* feature of each row that should come */
static bool along_y[GOE_ROWS_MAX]; /* its coordinate */
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

/* The face from corner i clockwise to the next is visible if the camera lies on its outer side. */
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

/* Visible corners in image order; false if a face is viewed from its end. */
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

static double height_of(const double state[GOE_STATES], int feature) {
    const double h = (double)sighting.sight.height_m;
    return feature == GOE_POINT_TOP ? h * state[GOE_INVERSE_RANGE] - state[GOE_TOP]
                                    : h * state[GOE_INVERSE_RANGE] + state[GOE_GROUND];
}

/* How far down in the raw image a corner of the roof is, focal lengths. */
static double down_of(corner_t c) {
    const float *r = sighting.sight.camera_to_axes;
    const double point[3] = {c.x, height_of(truth, GOE_POINT_TOP), c.z};
    double seen[2] = {0.0, 0.0};
    for (int i = 0; i < 3; i++) {
        seen[0] += (double)r[3 * i + 1] * point[i];
        seen[1] += (double)r[3 * i + 2] * point[i];
    }
    return seen[0] / seen[1];
}

/* The quantity that is least at the corner below the top: distance from the camera, or height in the raw image. */
static double rank(corner_t c, bool highest) { return highest ? down_of(c) : range2(c); }

/* False if two are equal. */
static bool find_top(const corner_t corner[4], bool highest, int *found) {
    bool clear = true;
    *found = 0;
    for (int i = 1; i < 4; i++) {
        *found = rank(corner[i], highest) < rank(corner[*found], highest) ? i : *found;
    }
    for (int i = 0; i < 4; i++) {
        clear = clear && (i == *found || rank(corner[i], highest) - rank(corner[*found], highest) > 1.0e-4);
    }
    return clear;
}

static void see(const double state[GOE_STATES], int feature, double seen[2]) {
    corner_t corner[4];
    corners_of(state, corner);
    const corner_t at = corner[seen_at[feature]];
    const bool silhouette = feature == GOE_POINT_LEFT || feature == GOE_POINT_RIGHT;
    const double y = silhouette ? sighting_height(&sighting, state, (size_t)feature) * at.z : height_of(state, feature);
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
        sighting.settings.filter.top_is_highest = check_random_bits(&any) % 2u != 0u;
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
    sighting_clear_rows(&sighting);
    goe_box_rows(&sighting.sight, &sighting.rows);
    TEST_ASSERT_EQUAL_size_t(expected_rows, sighting.rows.count);
    for (size_t row = 0; row < expected_rows; row++) {
        const bool base = kind[row] >= GOE_POINT_BASE_LEFT;
        TEST_ASSERT_EQUAL_size_t(kind[row], sighting.rows.feature[row]);
        TEST_ASSERT_EQUAL_INT(along_y[row] ? GOE_ALONG_Y : GOE_ALONG_X, sighting.rows.axis[row]);
        TEST_ASSERT_EQUAL_size_t(2u * kind[row] + (base && along_y[row] ? 1u : 0u), sighting.rows.series[row]);
    }
    sighting_check_rows(&sighting, predict);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static const int faces_to_feature[3] = {GOE_POINT_BASE_LEFT, GOE_POINT_BASE_NEAR, GOE_POINT_BASE_RIGHT};

/* [goe_image_t.base_left, goe_image_t.pose, goe_image_t.top, (R1), (R8), (R9), (R10), (R11), (R2), (R7)]
 * GIVEN boxes of any size, side and orientation WHEN all visible features are measured at their brute-force places THEN all
 * residuals are 0, which shows that the same corners were taken, and all derivatives are those of the projection. */
static void rows_are_those_of_the_corners_that_are_visible(void) {
    int faces[3] = {0, 0, 0};
    any = check_random_start("all features");
    for (int n = 0; n < CASES; n++) {
        corner_t corner[4];
        int visible[4];
        int count;
        int top;
        any_box(corner);
        const bool highest = sighting.settings.filter.top_is_highest;
        if (!find_visible(corner, visible, &count) || !find_top(corner, highest, &top)) {
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
    check_report("boxes with one visible face", faces[1]);
    check_report("boxes with two visible faces", faces[2]);
    TEST_ASSERT_TRUE(faces[1] > CASES / 20 && faces[2] > CASES / 2);
}

/* [(R10)] GIVEN a silhouette alone THEN its corners are the outermost ones. */
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

/* [goe_image_t.base_left]
 * GIVEN two faces of which the detector missed the corner between them WHEN the length is estimated THEN the outer corners
 * are those of both faces all the same, if that fits clearly better. */
static void a_missed_near_corner_is_distinguished_from_a_single_face(void) {
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

/* [(R7)] The depths solve their two equations for any sign and size of their difference. */
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

/* ------------------------------------------------------------------------------------------------------------- names -- */

#define RANGE_M 100.0
#define LENGTH_M 8.0
#define WIDTH_M 3.0

static goe_filter_t filter;

/* The box whose side lies at this angle from Z. */
static void lay(double deg) {
    const double s = sin(deg * RAD_PER_DEG);
    const double c = cos(deg * RAD_PER_DEG);
    filter.state[GOE_BEARING] = -0.1f;
    filter.state[GOE_INVERSE_RANGE] = (float)(1.0 / RANGE_M);
    filter.state[GOE_SIDE_X] = (float)(LENGTH_M * s / RANGE_M);
    filter.state[GOE_FRONT_X] = (float)(WIDTH_M * c / RANGE_M);
    filter.state[GOE_DEPTH_DIFFERENCE] = (float)((LENGTH_M * c - WIDTH_M * fabs(s)) / RANGE_M);
    goe_box_name(&filter);
}

static void start_at(double deg) {
    memset(&filter, 0, sizeof filter);
    inverse_start(&filter.root, 1.0e-3);
    filter.axes.turn_cos = 1.0f;
    goe_box_enter(&filter, GOE_PHASE_BOX);
    lay(deg);
}

/* [A8] GIVEN a box THEN its side is the edge nearer to Z at first, and keeps that name until it lies more than 52 degrees (tan b = 1.3)
 * from Z; so does the other edge then. */
static void an_edge_keeps_its_name_until_it_lies_clearly_across(void) {
    static const double all_deg[] = {52.3, -52.3, 30.0, 52.6, 45.0, 37.7, 60.0, 37.3, 52.3};
    static const bool exchanged[] = {false, false, false, true, true, true, true, false, false};
    for (int sign = -1; sign <= 1; sign += 2) {
        start_at(46.0 * sign);
        TEST_ASSERT_TRUE(filter.naming.exchanged);
        start_at(44.0 * sign);
        TEST_ASSERT_FALSE(filter.naming.exchanged);
        for (size_t i = 0; i < sizeof all_deg / sizeof all_deg[0]; i++) {
            lay(all_deg[i] * sign);
            TEST_ASSERT_EQUAL_INT(exchanged[i], filter.naming.exchanged);
        }
    }
}

/* [A8, goe_estimate_t.center_north_m, goe_shape.c, (R8)]
 * GIVEN a box WHEN its edges exchange their names THEN width, length, orientation and the reference point are those of the other
 * edge, and the middle of the base is where it was. */
static void names_move_the_reference_point_and_not_the_middle(void) {
    for (int deg = -70; deg <= 70; deg += 10) {
        goe_shape_t shape[2];
        double middle[2][2];
        if (deg == 0) {
            continue;
        }
        start_at(deg);
        for (int i = 0; i < 2; i++) {
            filter.naming.exchanged = i > 0;
            goe_box_shape(&filter, &shape[i]);
            const goe_linear_t *q = shape[i].quantity;
            middle[i][0] = (double)q[GOE_X0].value + 0.5 * (double)q[GOE_LENGTH].value * (double)shape[i].length_axis.x;
            middle[i][1] = (double)q[GOE_Z0].value + 0.5 * (double)q[GOE_LENGTH].value * (double)shape[i].length_axis.z;
            CHECK_CLOSE(1.0e-3, (double)shape[i].middle.at.x * RANGE_M, middle[i][0]);
            CHECK_CLOSE(1.0e-3, (double)shape[i].middle.at.z * RANGE_M, middle[i][1]);
        }
        CHECK_CLOSE(1.0e-4, LENGTH_M, shape[0].quantity[GOE_LENGTH].value);
        CHECK_CLOSE(1.0e-4, WIDTH_M, shape[0].quantity[GOE_WIDTH].value);
        CHECK_CLOSE(1.0e-4, WIDTH_M, shape[1].quantity[GOE_LENGTH].value);
        CHECK_CLOSE(1.0e-4, LENGTH_M, shape[1].quantity[GOE_WIDTH].value);
        CHECK_CLOSE(1.0e-4, deg * RAD_PER_DEG, shape[0].quantity[GOE_ORIENTATION].value);
        CHECK_CLOSE(1.0e-4, (deg > 0 ? deg - 90.0 : deg + 90.0) * RAD_PER_DEG,
                    shape[1].quantity[GOE_ORIENTATION].value);
        CHECK_CLOSE(1.0e-4, middle[0][0], middle[1][0]);
        CHECK_CLOSE(1.0e-4, middle[0][1], middle[1][1]);
    }
}

/* [(R22)] 1 + 12 var(d)/(sz + fz)^2, of which the ratio is at most 4. */
static void an_uncertain_depth_widens_corner_quantities(void) {
    goe_box_edges_t edges;
    goe_shape_t shape;
    start_at(30.0);
    goe_box_edges(filter.state, &edges);
    static const double share[] = {1.0e-5, 0.25, 1.0, 1.9, 3.0};
    static const double growth[] = {1.0, 1.75, 13.0, 44.32, 49.0};
    for (int i = 0; i < 5; i++) {
        inverse_start(&filter.root, 1.0e-6);
        inverse_set(&filter.root, GOE_DEPTH_DIFFERENCE, GOE_DEPTH_DIFFERENCE, share[i] * (double)edges.sum);
        goe_box_shape(&filter, &shape);
        CHECK_CLOSE(1.0e-4 * growth[i], growth[i], shape.corner_growth);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_are_those_of_the_corners_that_are_visible);
    RUN_TEST(a_silhouette_alone_takes_the_outermost_corners);
    RUN_TEST(a_missed_near_corner_is_distinguished_from_a_single_face);
    RUN_TEST(depths_solve_their_equations);
    RUN_TEST(an_edge_keeps_its_name_until_it_lies_clearly_across);
    RUN_TEST(names_move_the_reference_point_and_not_the_middle);
    RUN_TEST(an_uncertain_depth_widens_corner_quantities);
    return UNITY_END();
}
