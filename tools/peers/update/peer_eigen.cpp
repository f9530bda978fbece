// Eigen's HouseholderQR of the prior's rows over the measurement's, in place, with fixed sizes: no heap. WITH_INVERSE: 1 and
// the triangle's inverse. SPDX-License-Identifier: MIT
#include <Eigen/Dense>

#include "peer.h"

constexpr int PRIOR = PEER_NUISANCES + PEER_STATES;
using Stack = Eigen::Matrix<float, PRIOR + PEER_ROWS, PEER_COLUMNS>;
using Square = Eigen::Matrix<float, PEER_STATES, PEER_STATES>;
using States = Eigen::Matrix<float, PEER_STATES, 1>;

struct State {
    Square root; // the lower half is never read
    Square inverse;
    Stack stack; // the measurement is written into its last rows
    States change;
    float nuisance_root, nis;
};

static State states[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    State &state = states[slot];
    const float *element = given->root;
    for (int i = 0; i < PEER_STATES; i++) {
        for (int j = i; j < PEER_STATES; j++) {
            state.root(i, j) = *element++;
        }
    }
    state.nuisance_root = given->nuisance_root;
    state.stack.bottomRows<PEER_ROWS>() =
        Eigen::Map<const Eigen::Matrix<float, PEER_ROWS, PEER_COLUMNS, Eigen::RowMajor>>(given->measured[0]);
}

void peer_solve(int slot) {
    State &state = states[slot];
    Stack &stack = state.stack;
    stack.topRows<PRIOR>().setZero();
    stack.diagonal().head<PEER_NUISANCES>().setConstant(state.nuisance_root);
    auto block = stack.block<PEER_STATES, PEER_STATES>(PEER_NUISANCES, PEER_NUISANCES);
    block.triangularView<Eigen::Upper>() = state.root;
    const Eigen::HouseholderQR<Eigen::Ref<Stack>> in_place(stack);
    state.root.triangularView<Eigen::Upper>() = block;
    state.change = stack.col(PEER_RESIDUAL).segment<PEER_STATES>(PEER_NUISANCES);
    state.root.triangularView<Eigen::Upper>().solveInPlace(state.change);
    const float left = stack(PEER_RESIDUAL, PEER_RESIDUAL);
    state.nis = left * left;
#if WITH_INVERSE
    state.inverse.setIdentity();
    state.root.triangularView<Eigen::Upper>().solveInPlace(state.inverse);
#endif
}

void peer_answer(int slot, peer_answer_t *answer) {
    const State &state = states[slot];
    *answer = peer_answer_t();
    Eigen::Map<States>(answer->change) = state.change;
    answer->nis = state.nis;
    float *held = answer->held;
#if WITH_INVERSE
    for (int j = 0; j < PEER_STATES; j++) {
        for (int i = 0; i <= j; i++) {
            *held++ = state.inverse(i, j);
        }
    }
#else
    for (int i = 0; i < PEER_STATES; i++) {
        for (int j = i; j < PEER_STATES; j++) {
            *held++ = state.root(i, j);
        }
    }
#endif
}
