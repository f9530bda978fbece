"""Minimum number of floating-point operations of a Householder update.

The update runs in double precision and counts each operation; none if a factor is zero, so zeros
in the triangle, in a row, in a state that affects no row or in the nuisances' prior cost nothing.
The count is a lower bound for a program with this method on a processor with a scalar unit that takes one instruction
for each operation, such as the Cortex-M4F: no load, no store, no branch, no address.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass
class Operations:
    """pairs: a product and the sum that uses it, one operation with a fused multiply-add."""

    products: int = 0
    sums: int = 0
    pairs: int = 0
    divisions: int = 0
    roots: int = 0

    @property
    def fused(self) -> int:
        return self.products + self.sums + self.pairs + self.divisions + self.roots

    @property
    def separate(self) -> int:
        return self.fused + self.pairs

    def dot(self, a: Vector, b: Vector) -> float:
        terms = int(np.count_nonzero((a != 0.0) & (b != 0.0)))
        if terms:
            self.products += 1
            self.pairs += terms - 1
        return float(a @ b)

    def added(self, to: Vector, factor: float, vector: Vector) -> Vector:
        """to + factor * vector"""
        if factor != 0.0:
            terms = vector != 0.0
            self.pairs += int(np.count_nonzero(terms & (to != 0.0)))
            self.products += int(np.count_nonzero(terms & (to == 0.0)))
        return to + factor * vector


@dataclass(frozen=True)
class Solution:
    root: NDArray[np.float64]
    change: Vector
    nis: float


def reflect(row: Vector, columns: NDArray[np.float64], first: int, keeps_row: bool, operations: Operations) -> None:
    """The reflection that clears a column of the measurement against the diagonal of a row of the triangle, in place.

    keeps_row: the row is needed afterwards; otherwise only the measurement is.
    """
    pivot = columns[:, first].copy()
    if not pivot.any():
        return
    norm = np.sqrt(operations.dot(pivot, pivot) + row[first] ** 2)
    operations.pairs += 1
    operations.roots += 1
    diagonal = -norm if row[first] > 0.0 else norm
    u = row[first] - diagonal
    beta = 1.0 / (diagonal * u)
    operations.sums += 1
    operations.products += 1
    operations.divisions += 1
    vector = np.concatenate([[u], pivot])
    for other in range(first + 1, columns.shape[1]):
        column = np.concatenate([[row[other]], columns[:, other]])
        g = operations.dot(vector, column)
        if g == 0.0:
            continue
        operations.products += 1
        g *= beta
        start = 0 if keeps_row else 1
        column[start:] = operations.added(column[start:], g, vector[start:])
        row[other], columns[:, other] = column[0], column[1:]
    row[first], columns[:, first] = diagonal, 0.0


def householder_update(
    root: NDArray[np.float64], nuisances_root: float, rows: NDArray[np.float64], operations: Operations
) -> Solution:
    """rows: of nuisances, states, residual, each divided by its sigma."""
    states, count = len(root), rows.shape[1]
    nuisances = count - states - 1
    triangle = np.zeros((states, count))
    triangle[:, nuisances:-1] = root
    measured = rows.copy()
    for i in range(nuisances):
        row = np.zeros(count)
        row[i] = nuisances_root
        reflect(row, measured, i, False, operations)
    for i in range(states):
        reflect(triangle[i], measured, nuisances + i, True, operations)
    change = np.zeros(states)
    for i in reversed(range(states)):
        row, known = triangle[i, nuisances:-1], change[i + 1 :]
        operations.pairs += int(np.count_nonzero((row[i + 1 :] != 0.0) & (known != 0.0)))
        operations.divisions += 1
        change[i] = (triangle[i, -1] - row[i + 1 :] @ known) / row[i]
    left = measured[:, -1]
    return Solution(triangle[:, nuisances:-1], change, operations.dot(left, left))


def triangle_inverse(root: NDArray[np.float64], operations: Operations) -> NDArray[np.float64]:
    """Inverse of an update's triangle; it shares the reciprocals of the diagonal with the solution for the change."""
    size = len(root)
    inverse = np.diag(1.0 / np.diag(root))
    operations.products += size  # instead of the solution's divisions
    for j in range(size):
        for i in reversed(range(j)):
            total = operations.dot(root[i, i + 1 : j + 1], inverse[i + 1 : j + 1, j])
            if total != 0.0:
                operations.products += 1
                inverse[i, j] = -total * inverse[i, i]
    return inverse
