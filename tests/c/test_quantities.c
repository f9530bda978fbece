/* The filter's state in meters, its uncertainty, and the reported quantities. SPDX-License-Identifier: MIT
 *
 * Each variance must be that of the state's covariance, by derivatives that are taken here as differences of the values
 * themselves; unobservable depth adds to it, on purpose. */
/* tests: lib/refined/goe_quantities.c */
#include "refined/goe_quantities.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "refined/goe_box.h"
#include "refined/goe_ellipse.h"
#include "refined/goe_footprint.h"
#include "rim.h"

#define CASES 100
#define SHARE 0.02 /* differences of floats */
#define CERTAIN 1.0e-9

static check_random_t any;
static goe_filter_t filter;
static goe_settings_t settings;
static goe_motion_t motion;
static goe_quantities_t quantities;
static double sigma_of[GOE_STATES];

static const goe_phase_t phases[] = {GOE_PHASE_FOOTPRINT, GOE_PHASE_BOX_FACE, GOE_PHASE_BOX};

void setUp(void) {}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }

static bool is_box(goe_phase_t phase) { return phase != GOE_PHASE_FOOTPRINT; }

/* The image at hand gave rows. */
static void measure_here(void) {
    const goe_xz_t camera = goe_filter_camera(&filter, &motion);
    filter.measured.dx_m = camera.x;
    filter.measured.dz_m = camera.z;
}

/* An obstacle some way ahead, about axes turned anyhow, some way into the track; nothing of the own motion is wrong. */
static void make_any(goe_phase_t phase) {
    const double turn = between(-0.5, 0.5);
    const double heading = between(-3.1, 3.1);
    memset(&filter, 0, sizeof filter);
    memset(&motion, 0, sizeof motion);
    goe_settings_default(&settings);
    settings.navigation.velocity_bias_sd_m_s = 0.0f;
    settings.navigation.position_walk_sd_m = 0.0f;
    filter.datum.taken_m2 = 1.0e9f; /* so that a slope of the ground adds nothing */
    filter.phase = (uint8_t)phase;
    filter.phase_images = 100;
    filter.known = 0xFFu;
    settings.filter.top_is_highest = check_random_bits(&any) % 2u != 0u;
    filter.axes.turn_cos = (float)cos(turn);
    filter.axes.turn_sin = (float)sin(turn);
    filter.axes.start_dx_m = (float)between(-5.0, 5.0);
    filter.axes.start_dz_m = (float)between(0.0, 20.0);
    filter.axes.start_time_us = 3000000;
    motion.start_time_us = 1000000;
    motion.time_us = 13000000;
    motion.heading_cos = (float)cos(heading);
    motion.heading_sin = (float)sin(heading);
    motion.origin_ne_m[0] = (float)between(-100.0, 100.0);
    motion.origin_ne_m[1] = (float)between(-100.0, 100.0);
    motion.height_m = 15.0f;
    motion.dx_m = filter.axes.start_dx_m + (float)between(-3.0, 3.0);
    motion.dz_m = filter.axes.start_dz_m + (float)between(20.0, 40.0);
    const double q = 1.0 / between(80.0, 150.0);
    filter.state[GOE_GROUND] = (float)(between(-1.0, 1.0) * q);
    filter.state[GOE_BEARING] = (float)between(-0.3, 0.3);
    filter.state[GOE_INVERSE_RANGE] = (float)q;
    filter.state[GOE_TOP] = (float)(between(8.0, 20.0) * q);
    for (size_t i = 0; i < GOE_STATES; i++) {
        sigma_of[i] = i < GOE_GROUND ? 0.01 : i == GOE_INVERSE_RANGE ? 0.01 * q : 0.3 * q;
    }
    if (is_box(phase)) {
        filter.state[GOE_SIDE_X] = (float)(between(3.0, 6.0) * (between(-1, 1) > 0 ? q : -q));
        filter.state[GOE_FRONT_X] = (float)(between(8.0, 16.0) * q);
        filter.state[GOE_DEPTH_DIFFERENCE] = (float)(between(6.0, 12.0) * q);
    } else {
        filter.state[GOE_SHEAR] = (float)(between(-6.0, 6.0) * q);
        filter.state[GOE_HALF] = (float)(between(4.0, 12.0) * q);
        filter.state[GOE_LOG_DEPTH] = (float)between(-0.8, 0.8);
        sigma_of[GOE_LOG_DEPTH] = 0.1;
    }
    measure_here();
}

static void be_uncertain(double share) {
    goe_srif_clear(&filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&filter.root, i, i) = (float)(1.0 / (share * sigma_of[i]));
        for (size_t j = i + 1; j < GOE_STATES; j++) {
            *goe_srif_at(&filter.root, i, j) = (float)(between(-0.3, 0.3) / (share * sigma_of[j]));
        }
    }
}

static void covariance_of(double c[GOE_STATES][GOE_STATES]) { inverse_covariance(&filter.root, c); }

enum { NORTH = GOE_QUANTITIES, EAST, VALUES };

static void values_of(double values[VALUES]) {
    goe_quantities_t q;
    goe_quantities_find(&filter, &settings, &motion, &q);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        values[i] = (double)q.value[i];
    }
    values[NORTH] = (double)q.center_m[0];
    values[EAST] = (double)q.center_m[1];
}

/* Derivatives by the states, as differences. share: of a state's sigma that a step is. */
static void differentiate(void (*of)(double values[VALUES]), double share, double slope[VALUES][GOE_STATES]) {
    for (size_t k = 0; k < GOE_STATES; k++) {
        double up[VALUES] = {0.0};
        double down[VALUES] = {0.0};
        const float at = filter.state[k];
        const float step = (float)(share * sigma_of[k]);
        filter.state[k] = at + step;
        const float above = filter.state[k];
        of(up);
        filter.state[k] = at - step;
        const float below = filter.state[k];
        of(down);
        filter.state[k] = at;
        for (size_t i = 0; i < VALUES; i++) {
            slope[i][k] = (up[i] - down[i]) / ((double)above - (double)below);
        }
    }
}

/* J C J', J by differences. */
static double by[VALUES][GOE_STATES];

static void covariance_by(void (*of)(double values[VALUES]), double share, double expected[VALUES][VALUES]) {
    double c[GOE_STATES][GOE_STATES];
    double half[VALUES][GOE_STATES];
    covariance_of(c);
    differentiate(of, share, by);
    for (size_t i = 0; i < VALUES; i++) {
        for (size_t l = 0; l < GOE_STATES; l++) {
            half[i][l] = 0.0;
            for (size_t k = 0; k < GOE_STATES; k++) {
                half[i][l] += by[i][k] * c[k][l];
            }
        }
    }
    for (size_t i = 0; i < VALUES; i++) {
        for (size_t j = 0; j < VALUES; j++) {
            expected[i][j] = 0.0;
            for (size_t l = 0; l < GOE_STATES; l++) {
                expected[i][j] += half[i][l] * by[j][l];
            }
        }
    }
}

static void expected_covariance(double expected[VALUES][VALUES]) { covariance_by(values_of, 0.1, expected); }

/* On purpose: a box's corner by a poorly known depth counts more. */
static double corner_growth_of(void) {
    goe_box_edges_t edges;
    goe_box_edges(filter.state, &edges);
    const double sum = (double)edges.sum;
    const double relative = (double)goe_filter_variance(&filter, GOE_DEPTH_DIFFERENCE) / (sum * sum);
    return is_box((goe_phase_t)filter.phase) ? 1.0 + 12.0 * fmin(relative, 4.0) : 1.0;
}

static double squared(double x) { return x * x; }

/* The square of the sine of the angle under which the top is viewed from the camera's height. */
static double below2(void) {
    goe_quantities_t q;
    goe_quantities_find(&filter, &settings, &motion, &q);
    const double below = squared((double)motion.height_m - (double)q.value[GOE_HEIGHT]);
    const double half = q.box ? 0.5 * (double)q.value[GOE_LENGTH] : 0.0; /* from the front to the middle */
    const double x_m = (double)q.value[GOE_X0] + half * (double)q.length_axis.x - (double)motion.dx_m;
    const double z_m = (double)q.value[GOE_Z0] + half * (double)q.length_axis.z - (double)motion.dz_m;
    const double range = squared(x_m) + squared(z_m);
    return below / (range + below);
}

/* (R37): the ends of one face may be those of two. */
static double beyond_face(int value) {
    goe_quantities_t q;
    goe_quantities_find(&filter, &settings, &motion, &q);
    const double size = fmax((double)q.value[GOE_WIDTH], (double)q.value[GOE_LENGTH]);
    switch (value) {
        case GOE_ORIENTATION:
            return squared(0.14);
        case GOE_LENGTH:
            return 0.0;
        case GOE_WIDTH:
            return squared(0.06 * size);
        case GOE_HEIGHT:
            return squared((settings.filter.top_is_highest ? 2.0 : 0.15) * size) * below2();
        default:
            return squared(0.1 * size);
    }
}

/* What points of a silhouette leave open: a house is no ellipse. */
static double beyond_ellipse(int value) {
    const bool extent = value >= GOE_ORIENTATION && value <= GOE_HEIGHT;
    const double width = 2.0 * (double)filter.state[GOE_HALF] / (double)filter.state[GOE_INVERSE_RANGE];
    return extent || filter.boxes || settings.model == GOE_MODEL_DISC ? 0.0 : squared(0.05 * width);
}

static double beyond_of(int value) {
    if (filter.phase == GOE_PHASE_FOOTPRINT) {
        return beyond_ellipse(value);
    }
    return filter.phase == GOE_PHASE_BOX_FACE ? beyond_face(value) : 0.0;
}

/* On purpose: what the foot lies above the altimeter's zero may be hidden. */
static double hidden2(void) {
    return squared(fmin((double)filter.state[GOE_GROUND] / (double)filter.state[GOE_INVERSE_RANGE], 0.0));
}

static bool is_of_corner(int quantity) { return quantity >= GOE_ORIENTATION && quantity <= GOE_LENGTH; }

/* -------------------------------------------------------------------------------------------------------------- tests -- */

/* [A30, (R37)]
 * GIVEN any state of any phase and an own motion that is exact THEN the sigma of each quantity, of the center in north and east, and
 * the covariance of the two are those of the state. */
static void sigmas_are_those_of_the_state(void) {
    any = check_random_start("sigmas");
    for (int n = 0; n < CASES; n++) {
        double expected[VALUES][VALUES];
        const goe_phase_t phase = phases[n % 3];
        make_any(phase);
        be_uncertain(1.0);
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        TEST_ASSERT_TRUE(quantities.known & GOE_HAS_POSITION);
        expected_covariance(expected);
        for (int i = 0; i < VALUES; i++) {
            expected[i][i] = expected[i][i] * (is_of_corner(i) ? corner_growth_of() : 1.0) + beyond_of(i);
        }
        expected[GOE_HEIGHT][GOE_HEIGHT] += hidden2();
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            if (expected[i][i] > 0.0) {
                CHECK_CLOSE(SHARE, 1.0, (double)quantities.sigma[i] / sqrt(expected[i][i]));
            }
        }
        if (quantities.known & GOE_HAS_CENTER) {
            const double both = sqrt(expected[NORTH][NORTH] * expected[EAST][EAST]);
            CHECK_CLOSE(SHARE, 1.0, (double)quantities.center_sd_m[0] / sqrt(expected[NORTH][NORTH]));
            CHECK_CLOSE(SHARE, 1.0, (double)quantities.center_sd_m[1] / sqrt(expected[EAST][EAST]));
            CHECK_CLOSE(2.0 * SHARE * both, expected[NORTH][EAST], quantities.center_ne_m2);
        }
        TEST_ASSERT_TRUE((quantities.known & GOE_HAS_CENTER) || phase == GOE_PHASE_BOX_FACE || is_box(phase));
    }
}

/* What a known ground leaves of the height's variance. */
static double height2_if_ground_known(double variance) {
    double c[GOE_STATES][GOE_STATES];
    double both = 0.0;
    covariance_of(c);
    differentiate(values_of, 0.1, by);
    for (size_t k = 0; k < GOE_STATES; k++) {
        both += by[GOE_HEIGHT][k] * c[k][GOE_GROUND];
    }
    return variance - both * both / c[GOE_GROUND][GOE_GROUND];
}

/* GIVEN a footprint, of unobservable depth THEN that widens its sigmas, and silences nothing: validity is decided without
 * it. For all others the contribution of the last state is as good as the rest. Nor does the obstacle's own ground silence its height. */
static void unobserved_depth_silences_nothing(void) {
    any = check_random_start("unseen");
    for (int n = 0; n < CASES; n++) {
        const goe_phase_t phase = phases[n % 3];
        make_any(phase);
        be_uncertain(1.0);
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        const goe_quantities_t with = quantities;
        for (size_t i = 0; i < GOE_STATES && phase == GOE_PHASE_FOOTPRINT; i++) { /* as if it were known */
            inverse_set(&filter.root, i, GOE_STATES - 1, i < GOE_STATES - 1 ? 0.0 : 1.0e-9);
        }
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            const bool ellipse = phase == GOE_PHASE_FOOTPRINT;
            const double seen = (double)(ellipse ? quantities.sigma[i] : with.sigma[i]);
            const double sigma = i == GOE_HEIGHT ? sqrt(height2_if_ground_known(seen * seen - hidden2())) : seen;
            CHECK_CLOSE(2.0e-3 * sigma + 1.0e-6, sigma, with.worked_out[i]);
        }
    }
}

/* [navigation.terrain_slope_sd]
 * GIVEN a ground that may slope THEN that widens the sigmas, and silences nothing: validity is decided as if it were level. */
static void a_slope_silences_nothing(void) {
    any = check_random_start("slope");
    for (int n = 0; n < CASES; n++) {
        float row[GOE_UNKNOWNS] = {0.0f};
        float right[GOE_UNKNOWNS] = {0.0f};
        make_any(phases[n % 3]);
        be_uncertain(1.0);
        const float q = filter.state[GOE_INVERSE_RANGE];
        const float sloping_m2 = 0.25f + (0.02f / q) * (0.02f / q);
        settings.navigation.terrain_slope_sd = 0.02f;
        filter.datum.taken_m2 = 0.25f;
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        const goe_quantities_t sloping = quantities;
        row[GOE_GROUND] = sqrtf(4.0f - 1.0f / sloping_m2) / q;
        goe_srif_add(&filter.root, row, 0.0f, right);
        settings.navigation.terrain_slope_sd = 0.0f;
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            const double level = (double)quantities.worked_out[i];
            CHECK_CLOSE(2.0e-3 * level + 1.0e-6, level, sloping.worked_out[i]);
            TEST_ASSERT_TRUE(sloping.sigma[i] >= quantities.sigma[i] * 0.999f);
        }
    }
}

enum { MET_X, MET_Z, MET_WIDTH, MET };

static goe_xz_t towards; /* the camera */

/* X and Z, T axes, and diameter, m, of the circle that is as wide across the line of sight, and as near, as a footprint's rim; for a
 * constant line of sight. */
static void met_circle(double met[VALUES]) {
    const double q = (double)filter.state[GOE_INVERSE_RANGE];
    const double nx = (double)towards.x;
    const double nz = (double)towards.z;
    const double across = rim_reach(filter.state, nz, -nx);
    const double nearer = rim_reach(filter.state, nx, nz) - across;
    const double x = ((double)filter.state[GOE_BEARING] + nx * nearer) / q;
    const double z = (1.0 + nz * nearer) / q;
    const double c = (double)filter.axes.turn_cos;
    const double s = (double)filter.axes.turn_sin;
    met[MET_X] = c * x + s * z;
    met[MET_Z] = c * z - s * x;
    met[MET_WIDTH] = 2.0 * across / q;
}

/* [goe_hazard, goe_near_side.c]
 * GIVEN any footprint THEN a hazard's covariance of its place and its width is that of the circle that is as wide across the line of
 * sight, and as near to the camera, as its footprint. */
static void a_hazard_meets_the_near_side_of_a_footprint(void) {
    static const int quantity[MET] = {GOE_X0, GOE_Z0, GOE_WIDTH};
    any = check_random_start("near side");
    for (int n = 0; n < CASES; n++) {
        double expected[VALUES][VALUES];
        float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
        double circle[VALUES];
        goe_aspect_t aspect;
        make_any(GOE_PHASE_FOOTPRINT);
        be_uncertain(CERTAIN);
        goe_ellipse_face_camera(&filter, goe_filter_camera(&filter, &motion), &aspect);
        towards = aspect.towards;
        covariance_by(met_circle, 0.05, expected);
        met_circle(circle);
        goe_quantities_covariance(&filter, &settings, &motion, true, 0.0f, covariance);
        for (int i = 0; i < MET; i++) {
            for (int j = 0; j < MET; j++) {
                const double size =
                    sqrt((double)covariance[quantity[i]][quantity[i]] * (double)covariance[quantity[j]][quantity[j]]);
                const double shape = i == j && i != MET_WIDTH ? squared(0.05 * circle[MET_WIDTH]) : 0.0;
                CHECK_CLOSE(2.0 * SHARE * size, expected[i][j] + shape, covariance[quantity[i]][quantity[j]]);
            }
        }
    }
}

static double square_of(float a, float b) { return (double)a * (double)a + (double)b * (double)b; }

/* [goe_deviation.c]
 * GIVEN an estimated augmented state, such as the latency THEN its share of the uncertainty of the state widens the place, in T
 * as in north and east, and the extents that depend on the same states. */
static void augmented_states_widen_the_sigmas(void) {
    any = check_random_start("beside");
    for (int n = 0; n < CASES; n++) {
        make_any(GOE_PHASE_FOOTPRINT);
        be_uncertain(1.0);
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        const goe_quantities_t before = quantities;
        const double q = (double)filter.state[GOE_INVERSE_RANGE];
        const double part = 2.0 * q; /* 2 m of the place, along the bearing */
        filter.root.estimated = 1;
        *goe_srif_at(&filter.root, GOE_STATES, GOE_STATES) = 1.0f;
        inverse_set(&filter.root, GOE_BEARING, GOE_STATES, part);
        inverse_set(&filter.root, GOE_HALF, GOE_STATES, 0.75 * q); /* 1.5 m of the width */
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        CHECK_CLOSE(0.02, 4.0,
                    square_of(quantities.sigma[GOE_X0], quantities.sigma[GOE_Z0]) -
                        square_of(before.sigma[GOE_X0], before.sigma[GOE_Z0]));
        CHECK_CLOSE(0.02, 4.0,
                    square_of(quantities.center_sd_m[0], quantities.center_sd_m[1]) -
                        square_of(before.center_sd_m[0], before.center_sd_m[1]));
        CHECK_CLOSE(0.02, 2.25,
                    square_of(quantities.sigma[GOE_WIDTH], 0.0f) - square_of(before.sigma[GOE_WIDTH], 0.0f));
    }
}

/* GIVEN the same THEN the covariance that goe_covariance gives is the state's, too. */
static void covariances_are_those_of_the_state(void) {
    any = check_random_start("covariances");
    for (int n = 0; n < CASES; n++) {
        double expected[VALUES][VALUES];
        float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
        make_any(phases[n % 3]);
        be_uncertain(1.0);
        expected_covariance(expected);
        goe_quantities_covariance(&filter, &settings, &motion, false, 0.0f, covariance);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            for (int j = 0; j < GOE_QUANTITIES; j++) {
                const double factor =
                    sqrt((is_of_corner(i) ? corner_growth_of() : 1.0) * (is_of_corner(j) ? corner_growth_of() : 1.0));
                const double hidden = i == GOE_HEIGHT ? hidden2() : 0.0;
                const double more = i == j ? beyond_of(i) + hidden : 0.0;
                const double size = sqrt(expected[i][i] * expected[j][j]);
                CHECK_CLOSE(2.0 * SHARE * (factor * size + more), factor * expected[i][j] + more, covariance[i][j]);
            }
        }
    }
}

/* [goe_deviation.c, goe_drift.c, (R21)]
 * GIVEN a state that is exact but for an own velocity with a constant error, which images have made an error of the range, WHEN the aircraft
 * has flown for ten seconds THEN all lengths are off by that share, and the place relative to the camera also by the path's error; not the
 * place relative to the camera at the start. The walk of the own position moves the place, and from the track's first image on. */
static void errors_of_own_motion_are_in_the_sigmas(void) {
    any = check_random_start("drift");
    for (int n = 0; n < CASES; n++) {
        const double s = 10.0;
        make_any(phases[n % 3]);
        be_uncertain(CERTAIN);
        settings.navigation.velocity_bias_sd_m_s = 0.2f;
        settings.navigation.position_walk_sd_m = 0.1f;
        const double q = (double)filter.state[GOE_INVERSE_RANGE];
        const double share_s_m = between(-0.1, 0.1); /* relative error of lengths, per m/s along X */
        inverse_start(&filter.root, CERTAIN);
        *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_STATES + GOE_AUGMENTED_VELOCITY_X) =
            *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) * (float)(-q * share_s_m);
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        const double share = 0.2 * share_s_m;
        const double x = (double)quantities.value[GOE_X0] - (double)filter.axes.start_dx_m;
        const double z = (double)quantities.value[GOE_Z0] - (double)filter.axes.start_dz_m;
        const double rest = 0.01 * s + beyond_of(GOE_Z0);
        const double x_now = sqrt(rest + squared(0.2 * s - share * x));
        const double z_now = sqrt(rest + squared(share * z) + squared(0.2 * s));
        CHECK_CLOSE(SHARE * x_now, x_now, quantities.sigma[GOE_X0]);
        CHECK_CLOSE(SHARE * z_now, z_now, quantities.sigma[GOE_Z0]);
        CHECK_CLOSE(SHARE, squared(share * x) - squared(0.2 * s - share * x), quantities.began_m2[0]);
        CHECK_CLOSE(SHARE, -squared(0.2 * s), quantities.began_m2[1]);
        const double height = (double)quantities.value[GOE_HEIGHT];
        const double wide = hypot(share * (double)quantities.value[GOE_WIDTH], sqrt(beyond_of(GOE_WIDTH)));
        const double high = hypot(share * height, sqrt(beyond_of(GOE_HEIGHT) + hidden2()));
        CHECK_CLOSE(SHARE, wide, quantities.sigma[GOE_WIDTH]);
        CHECK_CLOSE(SHARE, high, quantities.sigma[GOE_HEIGHT]);
        if (quantities.box) {
            CHECK_CLOSE(SHARE, sqrt(beyond_of(GOE_ORIENTATION)), quantities.sigma[GOE_ORIENTATION]);
            CHECK_CLOSE(SHARE, fabs(share) * (double)quantities.value[GOE_LENGTH], quantities.sigma[GOE_LENGTH]);
        }
        CHECK_CLOSE(1.0e-4, 0.2 * 0.2 * 2.0 * 2.0 + 0.01 * 2.0,
                    quantities.before_m2); /* two seconds before it started */
        filter.mover.followed = true;      /* then the velocity is the obstacle's, and estimated */
        filter.root.estimated = GOE_AUGMENTED;
        for (size_t i = 0; i < GOE_AUGMENTED; i++) {
            *goe_srif_at(&filter.root, GOE_STATES + i, GOE_STATES + i) = 1.0e9f;
        }
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        CHECK_CLOSE(SHARE * sqrt(rest), sqrt(rest), quantities.sigma[GOE_X0]);
        CHECK_SAME(0.0f, quantities.began_m2[0]);
    }
}

/* The width that a hazard meets, across the present line of sight, over the one that is reported. */
static double met_share(void) {
    goe_aspect_t aspect;
    if (filter.phase != GOE_PHASE_FOOTPRINT) {
        return 1.0;
    }
    goe_ellipse_face_camera(&filter, goe_filter_camera(&filter, &motion), &aspect);
    return (double)aspect.across.reach / (double)filter.state[GOE_HALF];
}

/* GIVEN the same THEN it is in the covariance: of X0 and Z0 relative to the start, including the time before it; for a hazard relative to the
 * camera now, which has no part in the time before. */
static void errors_of_own_motion_are_in_the_covariance(void) {
    any = check_random_start("drift of covariances");
    for (int n = 0; n < CASES; n++) {
        float now[GOE_QUANTITIES][GOE_QUANTITIES];
        float ahead[GOE_QUANTITIES][GOE_QUANTITIES];
        float exact[GOE_QUANTITIES][GOE_QUANTITIES];
        make_any(phases[n % 3]);
        be_uncertain(CERTAIN);
        settings.navigation.velocity_bias_sd_m_s = 0.2f;
        settings.navigation.position_walk_sd_m = 0.1f;
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        goe_quantities_covariance(&filter, &settings, &motion, false, 0.0f, now);
        goe_quantities_covariance(&filter, &settings, &motion, true, 5.0f, ahead);
        settings.navigation.velocity_bias_sd_m_s = 0.0f;
        goe_quantities_covariance(&filter, &settings, &motion, true, 5.0f, exact);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            const double variance = squared((double)quantities.sigma[i]);
            const double early = i <= GOE_Z0 ? (double)quantities.began_m2[i] + (double)quantities.before_m2 : 0.0;
            CHECK_CLOSE(SHARE * variance + 1.0e-7, variance + early, now[i][i]);
            CHECK_CLOSE(1.0e-3, i <= GOE_Z0 ? squared(0.2 * 10.0) : 0.0, ahead[i][i] - exact[i][i]);
            if (i > GOE_Z0) { /* the place is that of a circle */
                const double met = i == GOE_WIDTH    ? variance * squared(met_share())
                                   : i == GOE_HEIGHT ? variance - hidden2()
                                                     : variance;
                CHECK_CLOSE(SHARE * met + 1.0e-7, met, ahead[i][i]);
            }
            CHECK_CLOSE(SHARE * variance + 1.0e-4, 0.0, i > 0 ? now[i][i - 1] : 0.0f);
        }
    }
}

/* GIVEN a height whose error is the altimeter's alone THEN the height over the ground has it, and the height over the camera has not:
 * it moves both equally. */
static void the_altimeters_error_is_not_between_camera_and_top(void) {
    float now[GOE_QUANTITIES][GOE_QUANTITIES];
    float ahead[GOE_QUANTITIES][GOE_QUANTITIES];
    any = check_random_start("altimeter");
    for (int n = 0; n < 3; n++) {
        make_any(phases[n]);
        be_uncertain(CERTAIN);
        inverse_set(&filter.root, GOE_GROUND, GOE_GROUND, 0.5 * (double)filter.state[GOE_INVERSE_RANGE]);
        goe_quantities_covariance(&filter, &settings, &motion, false, 0.0f, now);
        goe_quantities_covariance(&filter, &settings, &motion, true, 0.0f, ahead);
        CHECK_CLOSE(2.0e-2, 0.25, (double)now[GOE_HEIGHT][GOE_HEIGHT] - beyond_of(GOE_HEIGHT) - hidden2());
        CHECK_CLOSE(1.0e-3, 0.0, (double)ahead[GOE_HEIGHT][GOE_HEIGHT] - beyond_of(GOE_HEIGHT));
        /* and the range moves the height over the altimeter's zero, which is the height less the ground's offset */
        make_any(phases[n]);
        be_uncertain(CERTAIN);
        const double q = (double)filter.state[GOE_INVERSE_RANGE];
        inverse_set(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE, 0.01 * q);
        const double top = (double)filter.state[GOE_TOP] / q;
        goe_quantities_covariance(&filter, &settings, &motion, true, 0.0f, ahead);
        CHECK_CLOSE(SHARE * 1.0e-4 * top * top, 1.0e-4 * top * top,
                    (double)ahead[GOE_HEIGHT][GOE_HEIGHT] - beyond_of(GOE_HEIGHT));
    }
}

/* Residuals that are larger than they should be, and correlated from image to image. */
static void scatter(void) {
    filter.health.mean_nis = (float)between(1.0, 5.0);
    filter.health.excess = (float)between(0.0, 2.0);
    filter.scatter.products = (float)between(0.0, 200.0);
    filter.scatter.squares = 400.0f;
}

/* [goe_covariance]
 * GIVEN any state of any phase, a track that scatters and an own motion that is off THEN each sigma squared is its quantity's variance in
 * the covariance, to rounding; X0 and Z0 with what came before the filter's start. */
static void sigmas_are_the_roots_of_the_diagonal(void) {
    any = check_random_start("diagonal");
    for (int n = 0; n < 6 * CASES; n++) {
        float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
        make_any(phases[n % 3]);
        settings.model = n % 4 == 0 ? GOE_MODEL_DISC : GOE_MODEL_AUTO;
        settings.navigation.velocity_bias_sd_m_s = 0.2f;
        settings.navigation.position_walk_sd_m = 0.1f;
        filter.naming.exchanged = n / 6 % 2 != 0;
        filter.state[GOE_SIDE_X] += (float)(between(0.0, 0.1) * (double)filter.state[GOE_FRONT_X]);
        be_uncertain(between(0.1, 2.0));
        scatter();
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        goe_quantities_covariance(&filter, &settings, &motion, false, 0.0f, covariance);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            const double early = i <= GOE_Z0 ? (double)quantities.began_m2[i] + (double)quantities.before_m2 : 0.0;
            const double expected = squared((double)quantities.sigma[i]) + early;
            CHECK_CLOSE(1.0e-4 * expected + 1.0e-9, expected, covariance[i][i]);
        }
    }
}

/* GIVEN an image THEN its quantities are reported only if the image before knew them, too; and validity depends on the shares of the
 * header: a range that is not known to its share hides everything, an extent only itself. */
static void a_reported_value_was_known_twice(void) {
    any = check_random_start("known");
    make_any(GOE_PHASE_BOX);
    be_uncertain(0.1);
    goe_quantities_find(&filter, &settings, &motion, &quantities);
    TEST_ASSERT_EQUAL_HEX(0x3Fu, quantities.known);
    filter.known = GOE_HAS_POSITION | GOE_HAS_HEIGHT;
    goe_quantities_find(&filter, &settings, &motion, &quantities);
    TEST_ASSERT_EQUAL_HEX(0x2Fu, quantities.now);
    TEST_ASSERT_EQUAL_HEX(GOE_HAS_POSITION | GOE_HAS_HEIGHT, quantities.known);
    filter.known = 0xFFu;
    filter.phase = GOE_PHASE_BOX_FACE; /* whose length is held, not measured */
    goe_quantities_find(&filter, &settings, &motion, &quantities);
    TEST_ASSERT_EQUAL_HEX(0x2Du, quantities.known);
    filter.phase = GOE_PHASE_BOX;
    filter.state[GOE_INVERSE_RANGE] = -0.01f; /* behind: no length is computed from it */
    goe_quantities_find(&filter, &settings, &motion, &quantities);
    TEST_ASSERT_EQUAL_HEX(0u, quantities.known);
    TEST_ASSERT_EQUAL_HEX(0u, quantities.now);
    filter.state[GOE_INVERSE_RANGE] = 0.01f;
    settings.filter.range_sd_rel_max = 1.0e-5f;
    goe_quantities_find(&filter, &settings, &motion, &quantities);
    TEST_ASSERT_EQUAL_HEX(0u, quantities.known);
}

/* GIVEN an impossible range, or one behind, of any model, THEN no length is computed from it: nothing is known, and nothing was
 * divided by it. */
static void without_a_range_nothing_is_known(void) {
    static const float none[] = {0.0f, -0.0f, -1.0e-30f, -0.5f};
    any = check_random_start("no range");
    for (size_t p = 0; p < sizeof phases / sizeof phases[0]; p++) {
        for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
            make_any(phases[p]);
            be_uncertain(1.0e-2);
            filter.state[GOE_INVERSE_RANGE] = none[i];
            goe_quantities_find(&filter, &settings, &motion, &quantities);
            TEST_ASSERT_EQUAL_HEX(0u, quantities.known);
            TEST_ASSERT_EQUAL_HEX(0u, quantities.now);
        }
    }
}

/* GIVEN an obstacle that is followed WHEN its velocity has carried it beyond all bounds, either way, THEN nothing is reported
 * of it. */
static void a_position_beyond_all_bounds_is_not_reported(void) {
    static const float far_m_s[] = {0.0f, 2.0e5f, -2.0e5f};
    any = check_random_start("carried off");
    for (size_t i = 0; i < 9; i++) {
        make_any(GOE_PHASE_FOOTPRINT);
        be_uncertain(1.0e-2);
        filter.mover.followed = true;
        filter.mover.augmented[GOE_AUGMENTED_VELOCITY_X] = far_m_s[i % 3];
        filter.mover.augmented[GOE_AUGMENTED_VELOCITY_Z] = far_m_s[i / 3];
        goe_quantities_find(&filter, &settings, &motion, &quantities); /* 10 s after the start */
        TEST_ASSERT_EQUAL(i == 0, (quantities.known & GOE_HAS_POSITION) != 0);
    }
}

/* GIVEN a roof higher than any obstacle's, known to a share of its height, THEN no height is reported; the rest is. */
static void a_height_beyond_all_bounds_is_not_reported(void) {
    static const float high_m[] = {9.0e5f, 1.1e6f};
    any = check_random_start("high");
    for (size_t i = 0; i < 2; i++) {
        make_any(GOE_PHASE_BOX);
        be_uncertain(1.0e-3);
        filter.state[GOE_TOP] = high_m[i] * filter.state[GOE_INVERSE_RANGE];
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        TEST_ASSERT_EQUAL_HEX(i == 0 ? 0x3Fu : 0x3Fu & ~(unsigned)GOE_HAS_HEIGHT, quantities.known);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(sigmas_are_those_of_the_state);
    RUN_TEST(unobserved_depth_silences_nothing);
    RUN_TEST(a_slope_silences_nothing);
    RUN_TEST(a_hazard_meets_the_near_side_of_a_footprint);
    RUN_TEST(augmented_states_widen_the_sigmas);
    RUN_TEST(covariances_are_those_of_the_state);
    RUN_TEST(errors_of_own_motion_are_in_the_sigmas);
    RUN_TEST(errors_of_own_motion_are_in_the_covariance);
    RUN_TEST(the_altimeters_error_is_not_between_camera_and_top);
    RUN_TEST(sigmas_are_the_roots_of_the_diagonal);
    RUN_TEST(a_reported_value_was_known_twice);
    RUN_TEST(without_a_range_nothing_is_known);
    RUN_TEST(a_position_beyond_all_bounds_is_not_reported);
    RUN_TEST(a_height_beyond_all_bounds_is_not_reported);
    return UNITY_END();
}
