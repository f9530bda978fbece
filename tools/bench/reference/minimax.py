"""Minimax polynomials of goe_angle.c and goe_normal.c in lib/maths. `python -m bench minimax` prints the
constants and their error bounds.

Each angle function is written around its leading terms, with z = t^2:

    atan t = t - t z A(z)          |t| <= tan(pi/8)
    sin t  = t - t z S(z)          |t| <= pi/4
    cos t  = 1 - z/2 + z^2 C(z)    |t| <= pi/4

and of the normal distribution the upper tail

    1 - Phi(t) = N(t)^-8           0 <= t <= 5.2

A, S, C and N are the polynomials whose largest weighted error is smallest (Remez exchange, float64).
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from math import erfc
from typing import Callable

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]

GRID_POINTS = 100_001
EXCHANGES = 60


@dataclass(frozen=True)
class Problem:
    """A function of z to approximate on [smallest, largest] with `terms` coefficients.

    The C source has their magnitudes; the signs, in its expressions, alternate or not.
    """

    name: str
    function: Function
    weight: Function  # of the polynomial's error in the error of the result
    smallest: float
    largest: float
    terms: int
    source: str = "goe_angle.c"
    alternating: bool = True


@dataclass(frozen=True)
class Polynomial:
    """Coefficients in rising powers of z, and the largest weighted error."""

    coefficients: np.ndarray
    bound: float


def _atan_rest(z: np.ndarray) -> np.ndarray:
    t = np.sqrt(z)
    return (1.0 - np.arctan(t) / t) / z


def _sin_rest(z: np.ndarray) -> np.ndarray:
    t = np.sqrt(z)
    return (1.0 - np.sin(t) / t) / z


def _cos_rest(z: np.ndarray) -> np.ndarray:
    return (np.cos(np.sqrt(z)) - 1.0 + 0.5 * z) / z**2


def _odd_weight(z: np.ndarray) -> np.ndarray:
    return z * np.sqrt(z)


def _even_weight(z: np.ndarray) -> np.ndarray:
    return z**2


def _normal_tail(t: np.ndarray) -> np.ndarray:
    """Probability that a normal variable exceeds t sigma."""
    return 0.5 * np.array([erfc(x) for x in (t / np.sqrt(2.0)).tolist()])


def _normal_root(t: np.ndarray) -> np.ndarray:
    return _normal_tail(t) ** (-1 / 8)


def _normal_weight(t: np.ndarray) -> np.ndarray:
    return 8.0 * _normal_tail(t) ** (9 / 8)


# The smallest z keep the differences above free of cancellation; below them the next term is far under the bound.
PROBLEMS = (
    Problem("ATAN", _atan_rest, _odd_weight, 1e-4, float(np.tan(np.pi / 8) ** 2), 4),
    Problem("SIN", _sin_rest, _odd_weight, 1e-4, float((np.pi / 4) ** 2), 3),
    Problem("COS", _cos_rest, _even_weight, 1e-2, float((np.pi / 4) ** 2), 3),
    Problem("NORMAL", _normal_root, _normal_weight, 0.0, 5.2, 8, "goe_normal.c", alternating=False),
)


def _alternating_extrema(error: np.ndarray, wanted: int) -> np.ndarray:
    """Indices of `wanted` extrema of alternating sign, the largest ones."""
    turning = np.where((error[1:-1] - error[:-2]) * (error[2:] - error[1:-1]) <= 0)[0] + 1
    kept: list[int] = []
    for index in (0, *turning.tolist(), len(error) - 1):
        if kept and np.sign(error[index]) == np.sign(error[kept[-1]]):
            if abs(error[index]) > abs(error[kept[-1]]):
                kept[-1] = index
        else:
            kept.append(index)
    while len(kept) > wanted:
        kept.pop(0 if abs(error[kept[0]]) < abs(error[kept[-1]]) else -1)
    return np.array(kept)


def remez(problem: Problem) -> Polynomial:
    """The minimax polynomial of a problem."""
    n = problem.terms
    grid = np.linspace(problem.smallest, problem.largest, GRID_POINTS)
    middle, half = (problem.smallest + problem.largest) / 2, (problem.largest - problem.smallest) / 2
    nodes = middle - half * np.cos(np.pi * np.arange(n + 1) / n)
    signs = (-1.0) ** np.arange(n + 1)
    for _ in range(EXCHANGES):
        system = np.column_stack([nodes[:, None] ** np.arange(n), signs / problem.weight(nodes)])
        coefficients = np.linalg.solve(system, problem.function(nodes))[:n]
        error = (np.polyval(coefficients[::-1], grid) - problem.function(grid)) * problem.weight(grid)
        extrema = _alternating_extrema(error, n + 1)
        if len(extrema) <= n or np.allclose(grid[extrema], nodes, atol=1e-9):
            break
        nodes = grid[extrema]
    return Polynomial(coefficients, float(np.abs(error).max()))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """No arguments."""


def run(arguments: argparse.Namespace) -> int:
    """Prints the constants in the format of the C sources."""
    for problem in PROBLEMS:
        polynomial = remez(problem)
        for number, coefficient in enumerate(polynomial.coefficients, start=1):
            print(f"#define {problem.name}_{number} {abs(coefficient):.9g}f")
        print(f"/* {problem.name}: largest error {polynomial.bound:.1e} */")
    return 0
