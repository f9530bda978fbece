/* Reference for the window fit. SPDX-License-Identifier: MIT */
#include "reference.h"

#include <math.h>

#define UNKNOWNS 3
#define EQUATIONS_MAX (2 * REFERENCE_ROWS_MAX)

reference_row_t reference_disc(double left_x, double right_x, double dx_m, double dz_m) {
    const double size = (right_x - left_x) * (cos(atan(left_x)) + cos(atan(right_x)));
    const double x = 0.5 * (left_x + right_x) * (1.0 - size * size / 16.0);
    return (reference_row_t){dx_m, dz_m, 2.0 / size, 2.0 * x / size, 0.0, 1.0};
}

/* a: equations x (unknowns + right side); turned into an upper triangle in place. */
static void triangulate(double a[EQUATIONS_MAX][UNKNOWNS + 1], int equations) {
    for (int j = 0; j < UNKNOWNS; j++) {
        double norm2 = 0.0;
        double v[EQUATIONS_MAX];
        for (int i = j; i < equations; i++) {
            norm2 += a[i][j] * a[i][j];
            v[i] = a[i][j];
        }
        v[j] += a[j][j] >= 0.0 ? sqrt(norm2) : -sqrt(norm2);
        double length2 = 0.0;
        for (int i = j; i < equations; i++) {
            length2 += v[i] * v[i];
        }
        for (int k = j; k <= UNKNOWNS; k++) {
            double dot = 0.0;
            for (int i = j; i < equations; i++) {
                dot += v[i] * a[i][k];
            }
            for (int i = j; i < equations; i++) {
                a[i][k] -= 2.0 * dot / length2 * v[i];
            }
        }
    }
}

/* R p = right side. */
static void back_substitute(double a[EQUATIONS_MAX][UNKNOWNS + 1], const double right[UNKNOWNS], double p[UNKNOWNS]) {
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        double sum = right[i];
        for (int k = i + 1; k < UNKNOWNS; k++) {
            sum -= a[i][k] * p[k];
        }
        p[i] = sum / a[i][i];
    }
}

/* Sigma of g . p for p with covariance s2 (R^T R)^-1: sqrt(s2) |R^-T g|. */
static double sigma_of(double a[EQUATIONS_MAX][UNKNOWNS + 1], const double g[UNKNOWNS], double s2) {
    double y[UNKNOWNS];
    double sum2 = 0.0;
    for (int i = 0; i < UNKNOWNS; i++) {
        double sum = g[i];
        for (int k = 0; k < i; k++) {
            sum -= a[k][i] * y[k];
        }
        y[i] = sum / a[i][i];
        sum2 += y[i] * y[i];
    }
    return sqrt(s2 * sum2);
}

reference_fit_t reference_solve(const reference_row_t *rows, int images) {
    double a[EQUATIONS_MAX][UNKNOWNS + 1];
    double right[UNKNOWNS];
    double p[UNKNOWNS];
    double squares = 0.0;
    const int equations = 2 * images;
    for (int k = 0; k < images; k++) {
        const reference_row_t *r = &rows[k];
        double *size = a[2 * k];
        double *aside = a[2 * k + 1];
        size[0] = r->sine;
        size[1] = r->cosine;
        size[2] = -(r->sine * r->dx_m + r->cosine * r->dz_m);
        size[3] = r->size;
        aside[0] = r->cosine;
        aside[1] = -r->sine;
        aside[2] = -(r->cosine * r->dx_m - r->sine * r->dz_m);
        aside[3] = r->aside;
    }
    triangulate(a, equations);
    for (int i = 0; i < UNKNOWNS; i++) {
        right[i] = a[i][UNKNOWNS];
    }
    for (int i = UNKNOWNS; i < equations; i++) {
        squares += a[i][UNKNOWNS] * a[i][UNKNOWNS];
    }
    back_substitute(a, right, p);
    const double width = 1.0 / p[2];
    const double s2 = squares / (equations - UNKNOWNS);
    const double of_x0[UNKNOWNS] = {width, 0.0, -p[0] * width * width};
    const double of_z0[UNKNOWNS] = {0.0, width, -p[1] * width * width};
    const double of_width[UNKNOWNS] = {0.0, 0.0, -width * width};
    const reference_fit_t fit = {p[0] * width,
                                 p[1] * width,
                                 width,
                                 sigma_of(a, of_x0, s2),
                                 sigma_of(a, of_z0, s2),
                                 sigma_of(a, of_width, s2),
                                 sqrt(squares / equations)};
    return fit;
}
