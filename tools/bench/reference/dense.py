"""Equation (5) as the paper writes it: a dense least-squares problem in X0/W, Z0/W, 1/W, solved with numpy.linalg.

It shares nothing with the window method's closed form (window/fit.py), which it verifies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass
class DenseRow:
    """The two rows of (5) for one image, in the image turned by b."""

    forward: float  # m/S
    aside: float  # m x/S
    cos_b: float
    sin_b: float
    dx_m: float
    dz_m: float


@dataclass
class Solution:
    x0_m: float
    z0_m: float
    width_m: float
    sigma: dict[str, float]  # x0_m, z0_m, width_m
    residual: float
    baseline_m: float


def solve(rows: Sequence[DenseRow]) -> Solution:
    """The least-squares solution; sigmas by error propagation from inv(A^T A)."""
    n = len(rows)
    system, right = np.empty((2 * n, 3)), np.empty(2 * n)
    for k, row in enumerate(rows):
        c, s = row.cos_b, row.sin_b
        system[2 * k] = s, c, -(s * row.dx_m + c * row.dz_m)
        system[2 * k + 1] = c, -s, -(c * row.dx_m - s * row.dz_m)
        right[2 * k : 2 * k + 2] = row.forward, row.aside
    path = np.array([[row.dx_m, row.dz_m] for row in rows])
    unknowns = np.linalg.lstsq(system, right, rcond=None)[0]
    p, q, r = (float(value) for value in unknowns)
    inverse = np.linalg.inv(system.T @ system)
    gradients = {
        "x0_m": np.array([1.0 / r, 0.0, -p / r**2]),
        "z0_m": np.array([0.0, 1.0 / r, -q / r**2]),
        "width_m": np.array([0.0, 0.0, -1.0 / r**2]),
    }
    residuals = right - system @ unknowns
    squares = float(residuals @ residuals)
    sigma = math.sqrt(squares / (2 * n - 3))
    return Solution(
        p / r,
        q / r,
        1.0 / r,
        {name: sigma * math.sqrt(float(gradient @ inverse @ gradient)) for name, gradient in gradients.items()},
        math.sqrt(squares / (2 * n)),
        float(np.linalg.norm(path - path.mean(axis=0))),
    )
