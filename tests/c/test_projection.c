/* The projection models (2), (3) and the virtual rotation (4). SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_projection.c */
#include <math.h>

#include "check.h"
#include "window/goe_projection.h"

#define RAD_PER_DEG 0.017453292519943295

void setUp(void) {}
void tearDown(void) {}

static goe_point_t at(double x) { return (goe_point_t){(float)x, 0.0f, true}; }

static goe_turn_t turn_of(double deg) {
    return (goe_turn_t){(float)sin(deg * RAD_PER_DEG), (float)cos(deg * RAD_PER_DEG)};
}

/* Exact tangents of a disc of radius r at (x, z): from the foot of the tangent, no angle involved. */
static goe_status_t disc_row(double x, double z, double r, goe_row_t *row) {
    const double d2 = x * x + z * z;
    const double along = 1.0 - r * r / d2;
    const double across = r * sqrt(d2 - r * r) / d2;
    const goe_point_t left = at((x * along - z * across) / (z * along + x * across));
    const goe_point_t right = at((x * along + z * across) / (z * along - x * across));
    return goe_projection_disc(&left, &right, row);
}

/* [(2)] (2) is exact on the axis: zeta = Z/(2r), xi = 0. */
static void the_disc_is_exact_ahead(void) {
    for (double z = 20.0; z < 400.0; z *= 1.3) {
        goe_row_t row;
        CHECK_STATUS(GOE_OK, disc_row(0.0, z, 3.0, &row));
        CHECK_CLOSE(1.0e-6 * z / 6.0, z / 6.0, row.zeta);
        CHECK_CLOSE(1.0e-6 * z / 6.0, 0.0, row.xi);
    }
}

/* [(2)] The position row of (2), x = xi/zeta = X/Z: with half-angle a, sin a = r/d, and bearing p it is short of tan p by
 * 2 sin^4 a tan^3 p/cos^2 p to first order, which is rounding for any disc that is not filling the view. */
static void the_disc_has_a_nearly_exact_bearing_everywhere(void) {
    check_random_t random = check_random_start("discs");
    double worst_small = 0.0;
    for (int i = 0; i < 2000; i++) {
        const double z = check_random_between(&random, 10.0, 300.0);
        const double x = check_random_between(&random, -2.0, 2.0) * z;
        const double r = check_random_between(&random, 0.01, 0.1) * z;
        const double tangent = x / z;
        const double d2 = x * x + z * z;
        const double short_of =
            2.0 * (r * r / d2) * (r * r / d2) * tangent * tangent * tangent * (1.0 + tangent * tangent);
        goe_row_t row;
        CHECK_STATUS(GOE_OK, disc_row(x, z, r, &row));
        CHECK_CLOSE(0.1 * fabs(short_of) + 1.0e-6, tangent - short_of, row.xi / row.zeta);
        if (fabs(tangent) < 1.0 && r < 0.03 * z) {
            check_worst(&worst_small, (double)(row.xi / row.zeta) - tangent);
        }
    }
    check_report("disc bearings within 45 degrees and r < 0.03 Z, worst error of X/Z", worst_small);
    TEST_ASSERT_TRUE(worst_small < 2.0e-6);
}

/* [(2)] Off the axis the size row 2/S of (2) is off Z/W by the relative error r^2 X^2/(Z^2 d^2), to first order. */
static void the_disc_size_has_the_error_of_equation_2(void) {
    static const double bearings[] = {-1.0, -0.5, -0.2, 0.1, 0.4, 0.8};
    for (int i = 0; i < 6; i++) {
        const double z = 60.0;
        const double x = bearings[i] * z;
        const double r = 3.0;
        const double predicted = r * r * x * x / (z * z * (x * x + z * z));
        goe_row_t row;
        CHECK_STATUS(GOE_OK, disc_row(x, z, r, &row));
        const double found = fabs((double)row.zeta / (z / (2.0 * r)) - 1.0);
        CHECK_CLOSE(0.02 * predicted + 5.0e-7, predicted, found);
    }
}

static void a_disc_needs_left_on_the_left(void) {
    goe_row_t row = {1.25f, 2.5f};
    const goe_point_t a = at(0.1);
    const goe_point_t b = at(0.2);
    const goe_point_t hardly_right_of_a = at(0.10009);
    CHECK_STATUS(GOE_SWAPPED, goe_projection_disc(&b, &a, &row));
    CHECK_STATUS(GOE_SWAPPED, goe_projection_disc(&a, &a, &row));
    CHECK_STATUS(GOE_SWAPPED, goe_projection_disc(&a, &hardly_right_of_a, &row));
    TEST_ASSERT_EQUAL_FLOAT(1.25f, row.xi);
    CHECK_STATUS(GOE_OK, goe_projection_disc(&a, &b, &row));
}

/* [GOE_MODEL_LINE, (3)] (3), (4): a front edge of width w, middle (x, z), turned by b, gives xi = x/w and zeta = z/w exactly. */
static void the_line_is_exact_everywhere(void) {
    check_random_t random = check_random_start("lines");
    double worst = 0.0;
    int seen = 0;
    for (int i = 0; i < 5000; i++) {
        const double b = check_random_between(&random, -60.0, 60.0);
        const double z = check_random_between(&random, 10.0, 300.0);
        const double x = check_random_between(&random, -1.0, 1.0) * z;
        const double w = check_random_between(&random, 0.02, 0.3) * z;
        const double s = sin(b * RAD_PER_DEG);
        const double c = cos(b * RAD_PER_DEG);
        const goe_point_t left = at((x - 0.5 * w * c) / (z + 0.5 * w * s));
        const goe_point_t right = at((x + 0.5 * w * c) / (z - 0.5 * w * s));
        goe_row_t row;
        goe_span_t span;
        if (x * s + z * c > 0.2 * z) { /* the front is visible, not too flat */
            CHECK_STATUS(GOE_OK, goe_projection_line(&left, &right, turn_of(b), &span, &row));
            check_worst(&worst, ((double)row.xi - x / w) * w / z);
            check_worst(&worst, ((double)row.zeta - z / w) * w / z);
            seen++;
        }
    }
    check_report("line rows, worst error relative to Z/W", worst);
    TEST_ASSERT_GREATER_THAN_INT(3000, seen);
    TEST_ASSERT_TRUE(worst < 3.0e-5);
}

static void a_line_viewed_from_its_end_or_from_behind_is_edge_on(void) {
    goe_row_t row = {1.25f, 2.5f};
    goe_span_t span;
    const goe_point_t a = at(0.1);
    const goe_point_t b = at(0.2);
    const goe_point_t far_left = at(-1.0);
    CHECK_STATUS(GOE_EDGE_ON, goe_projection_line(&b, &a, turn_of(0.0), &span, &row));         /* from behind */
    CHECK_STATUS(GOE_EDGE_ON, goe_projection_line(&a, &a, turn_of(0.0), &span, &row));         /* no width */
    CHECK_STATUS(GOE_EDGE_ON, goe_projection_line(&far_left, &b, turn_of(60.0), &span, &row)); /* an end behind (4) */
    TEST_ASSERT_EQUAL_FLOAT(1.25f, row.xi);
    CHECK_STATUS(GOE_OK, goe_projection_line(&a, &b, turn_of(60.0), &span, &row));
}

/* [(4)] turning the camera by b moves a ray at bearing a to bearing a - b. */
static void a_virtual_rotation_subtracts_from_the_bearing(void) {
    for (int a = -60; a <= 60; a += 10) {
        for (int b = -80; b <= 80; b += 10) {
            const goe_point_t point = at(tan(a * RAD_PER_DEG));
            float x = -7.0f;
            const bool ahead = goe_projection_turn(&point, turn_of(b), &x);
            if (a - b > -85 && a - b < 85) {
                TEST_ASSERT_TRUE(ahead);
                const double expected = tan((a - b) * RAD_PER_DEG);
                CHECK_CLOSE(2.0e-6 * (1.0 + expected * expected), expected, x);
            } else if (a - b > 88 || a - b < -88) {
                TEST_ASSERT_FALSE(ahead);
                TEST_ASSERT_EQUAL_FLOAT(-7.0f, x);
            }
        }
    }
}

/* [(4)] The limit of the alignment, 0.05 of a unit ray or 87.13 degrees, applies to the turned camera as well. */
static void a_virtual_rotation_stops_where_the_alignment_does(void) {
    float x = 0.0f;
    const goe_point_t inside = at(tan(27.0 * RAD_PER_DEG));
    const goe_point_t outside = at(tan(27.3 * RAD_PER_DEG));
    TEST_ASSERT_TRUE(goe_projection_turn(&inside, turn_of(-60.0), &x));
    TEST_ASSERT_FALSE(goe_projection_turn(&outside, turn_of(-60.0), &x));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_disc_is_exact_ahead);
    RUN_TEST(the_disc_has_a_nearly_exact_bearing_everywhere);
    RUN_TEST(the_disc_size_has_the_error_of_equation_2);
    RUN_TEST(a_disc_needs_left_on_the_left);
    RUN_TEST(the_line_is_exact_everywhere);
    RUN_TEST(a_line_viewed_from_its_end_or_from_behind_is_edge_on);
    RUN_TEST(a_virtual_rotation_subtracts_from_the_bearing);
    RUN_TEST(a_virtual_rotation_stops_where_the_alignment_does);
    return UNITY_END();
}
