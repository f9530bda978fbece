// Eigen, with fixed sizes: no heap. METHOD: 1 LLT, 2 LDLT of the normal equations, 3 ColPivHouseholderQR.
// SPDX-License-Identifier: MIT
#include <Eigen/Dense>

#include "dense.h"

using Rows = Eigen::Matrix<float, DENSE_ROWS, DENSE_COLUMNS, Eigen::RowMajor>;
using Right = Eigen::Matrix<float, DENSE_ROWS, 1>;
using Unknowns = Eigen::Matrix<float, DENSE_COLUMNS, 1>;

static Rows rows[PEER_SLOTS];
static Right right_sides[PEER_SLOTS];
static peer_answer_t answers[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    dense_system(given, rows[slot].data(), right_sides[slot].data());
}

void peer_solve(int slot) {
    const Rows &a = rows[slot];
    const Right &b = right_sides[slot];
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
    dense_solution(p.data(), &answers[slot]);
}

void peer_answer(int slot, peer_answer_t *answer) { *answer = answers[slot]; }
