// Eigen, with fixed sizes: no heap. METHOD: 1 LLT, 2 LDLT of the normal equations, 3 ColPivHouseholderQR.
// SPDX-License-Identifier: MIT
#include <Eigen/Dense>

#include "dense.h"

using Rows = Eigen::Matrix<float, DENSE_ROWS, DENSE_COLUMNS, Eigen::RowMajor>;
using Right = Eigen::Matrix<float, DENSE_ROWS, 1>;
using Unknowns = Eigen::Matrix<float, DENSE_COLUMNS, 1>;

static Rows a;
static Right b;

void peer_prepare(const peer_window_t *window) { dense_system(window, a.data(), b.data()); }

void peer_solve(const peer_window_t *, peer_solution_t *solution) {
#if METHOD == 3
    const Unknowns p = a.colPivHouseholderQr().solve(b);
#else
    const Eigen::Matrix<float, DENSE_COLUMNS, DENSE_COLUMNS> normal = a.transpose() * a;
    const Unknowns right = a.transpose() * b;
#if METHOD == 1
    const Unknowns p = normal.llt().solve(right);
#else
    const Unknowns p = normal.ldlt().solve(right);
#endif
#endif
    dense_solution(p.data(), solution);
}
