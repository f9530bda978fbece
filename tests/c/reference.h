/* Independent double-precision reference for the window fit. SPDX-License-Identifier: MIT */
#ifndef REFERENCE_H
#define REFERENCE_H

#define REFERENCE_ROWS_MAX 64

/* One image's pair of rows of (5): m/S and m x/S in the camera turned by b, and the camera's displacement in T. */
typedef struct {
    double dx_m, dz_m;
    double size, aside;  /* m/S, m x/S */
    double sine, cosine; /* of b */
} reference_row_t;

typedef struct {
    double x0_m, z0_m, width_m;
    double sigma_x0_m, sigma_z0_m, sigma_width_m; /* from the covariance of the 2N x 3 system, to first order */
    double residual;                              /* rms */
} reference_fit_t;

/* The 2N x 3 system (5) in the unknowns X0/W, Z0/W, 1/W as the paper writes it, solved by Householder reflections. */
reference_fit_t reference_solve(const reference_row_t *rows, int images);

/* (2) of aligned tangent points, b = 0. */
reference_row_t reference_disc(double left_x, double right_x, double dx_m, double dz_m);

#endif
