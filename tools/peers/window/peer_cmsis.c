/* CMSIS-DSP. METHOD: 1 Cholesky of the normal equations, 2 Householder QR. SPDX-License-Identifier: MIT */
#include "arm_math.h"
#include "dense.h"

static float32_t given_a[PEER_SLOTS][DENSE_ROWS * DENSE_COLUMNS];
static float32_t given_b[PEER_SLOTS][DENSE_ROWS];
static peer_answer_t answers[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) { dense_system(given, given_a[slot], given_b[slot]); }

void peer_answer(int slot, peer_answer_t *answer) { *answer = answers[slot]; }

#if METHOD == 1
void peer_solve(int slot) {
    float32_t transposed[DENSE_COLUMNS * DENSE_ROWS];
    float32_t normal[9];
    float32_t right[3];
    float32_t lower[9] = {0.0f};
    float32_t half[3];
    float32_t upper[9];
    float32_t p[3];
    arm_matrix_instance_f32 a = {DENSE_ROWS, DENSE_COLUMNS, given_a[slot]};
    arm_matrix_instance_f32 b = {DENSE_ROWS, 1, given_b[slot]};
    arm_matrix_instance_f32 at = {DENSE_COLUMNS, DENSE_ROWS, transposed};
    arm_matrix_instance_f32 n = {3, 3, normal};
    arm_matrix_instance_f32 r = {3, 1, right};
    arm_matrix_instance_f32 l = {3, 3, lower};
    arm_matrix_instance_f32 h = {3, 1, half};
    arm_matrix_instance_f32 u = {3, 3, upper};
    arm_matrix_instance_f32 x = {3, 1, p};
    (void)arm_mat_trans_f32(&a, &at);
    (void)arm_mat_mult_f32(&at, &a, &n);
    (void)arm_mat_mult_f32(&at, &b, &r);
    (void)arm_mat_cholesky_f32(&n, &l);
    (void)arm_mat_solve_lower_triangular_f32(&l, &r, &h);
    (void)arm_mat_trans_f32(&l, &u);
    (void)arm_mat_solve_upper_triangular_f32(&u, &h, &x);
    dense_solution(p, &answers[slot]);
}
#else
#define WIDE_COLUMNS (DENSE_COLUMNS + 1)

/* b as a fourth column: gives Q' b together with R, without computing Q. */
void peer_solve(int slot) {
    float32_t wide[DENSE_ROWS * WIDE_COLUMNS];
    float32_t triangle[DENSE_ROWS * WIDE_COLUMNS];
    float32_t tau[WIDE_COLUMNS];
    float32_t row[DENSE_ROWS];
    float32_t column[DENSE_ROWS];
    float32_t p[DENSE_COLUMNS];
    arm_matrix_instance_f32 a = {DENSE_ROWS, WIDE_COLUMNS, wide};
    arm_matrix_instance_f32 r = {DENSE_ROWS, WIDE_COLUMNS, triangle};
    for (int i = 0; i < DENSE_ROWS; i++) {
        for (int j = 0; j < DENSE_COLUMNS; j++) {
            wide[i * WIDE_COLUMNS + j] = given_a[slot][i * DENSE_COLUMNS + j];
        }
        wide[i * WIDE_COLUMNS + DENSE_COLUMNS] = given_b[slot][i];
    }
    (void)arm_mat_qr_f32(&a, DEFAULT_HOUSEHOLDER_THRESHOLD_F32, &r, NULL, tau, row, column);
    for (int j = DENSE_COLUMNS - 1; j >= 0; j--) {
        const float32_t *line = &triangle[j * WIDE_COLUMNS];
        float32_t sum = line[DENSE_COLUMNS];
        for (int i = j + 1; i < DENSE_COLUMNS; i++) {
            sum -= line[i] * p[i];
        }
        p[j] = sum / line[j];
    }
    dense_solution(p, &answers[slot]);
}
#endif
