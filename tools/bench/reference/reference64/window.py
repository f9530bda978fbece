"""Equation (5) over a window of images: a dense least-squares problem in X0/W, Z0/W, 1/W."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..gates import UNIT_ROUNDOFF, Gates

PARALLAX_MIN = 1e-6
LIMIT_M = 1e6


@dataclass
class Row:
    """The two rows of (5) of one image, as the paper writes them."""

    forward: float  # m/S
    aside: float  # m x/S
    cos_b: float
    sin_b: float
    dx_m: float
    dz_m: float
    roundoff: float = 0.0  # what float32 arithmetic would do to m/S and m x/S
    roundoff_m: float = 0.0  # ... and to dX and dZ


@dataclass
class Fit:
    x0_m: float
    z0_m: float
    width_m: float
    sigma: dict[str, float]  # x0_m, z0_m, width_m
    roundoff: dict[str, float]  # the same from rounding of the rows alone
    residual: float
    baseline_m: float

    @property
    def ratio(self) -> float:
        """Conditioning of the solution."""
        return self.baseline_m / self.width_m


def solve(rows: Sequence[Row], min_baseline_m: float, gates: Gates) -> tuple[str, Fit | None]:
    """(5) over a window: ("ok", fit) or (why not, None)."""
    n = len(rows)
    system, right = np.empty((2 * n, 3)), np.empty(2 * n)
    for k, row in enumerate(rows):
        c, s = row.cos_b, row.sin_b
        system[2 * k] = s, c, -(s * row.dx_m + c * row.dz_m)
        system[2 * k + 1] = c, -s, -(c * row.dx_m - s * row.dz_m)
        right[2 * k : 2 * k + 2] = row.forward, row.aside
    path = np.array([[row.dx_m, row.dz_m] for row in rows])
    baseline = float(np.linalg.norm(path - path.mean(axis=0)))
    reach = float(np.max(np.abs(path)))
    if gates.decide("baseline", baseline < min_baseline_m, baseline - min_baseline_m, baseline + reach):
        return "no_baseline", None
    unknowns = np.linalg.lstsq(system, right, rcond=None)[0]
    p, q, r = (float(value) for value in unknowns)
    turned_rows = [
        (row.cos_b * row.aside + row.sin_b * row.forward, row.cos_b * row.forward - row.sin_b * row.aside)
        for row in rows
    ]
    largest = float(np.max(np.abs(turned_rows)))
    middle = float(np.sum(np.abs(np.mean(turned_rows, axis=0))))
    roundoff = math.sqrt(float(np.mean([row.roundoff**2 + (row.roundoff_m * r) ** 2 for row in rows])))
    change, least = r * baseline, PARALLAX_MIN * (1.0 + middle)
    row_size = roundoff / UNIT_ROUNDOFF + largest
    if gates.decide("parallax", change <= least, change - least, row_size):
        return "no_parallax", None
    width, x0, z0 = 1.0 / r, p / r, q / r
    inverse = np.linalg.inv(system.T @ system)
    gradients = {
        "width_m": np.array([0.0, 0.0, -1.0 / r**2]),
        "x0_m": np.array([1.0 / r, 0.0, -p / r**2]),
        "z0_m": np.array([0.0, 1.0 / r, -q / r**2]),
    }
    spread = {name: math.sqrt(float(gradient @ inverse @ gradient)) for name, gradient in gradients.items()}
    largest_m = max(abs(width), abs(x0), abs(z0))
    if gates.decide("limit", largest_m > LIMIT_M, largest_m - LIMIT_M, LIMIT_M * (1.0 + row_size / change)):
        return "no_parallax", None
    ahead = z0 - float(path[:, 1].max())
    if gates.decide("passed", ahead <= 0.0, ahead, abs(z0) + reach + spread["z0_m"] * row_size):
        return "passed", None
    residuals = right - system @ unknowns
    squares = float(residuals @ residuals)
    sigma = math.sqrt(squares / (2 * n - 3))
    return "ok", Fit(
        x0,
        z0,
        width,
        {name: sigma * value for name, value in spread.items()},
        {name: roundoff * value for name, value in spread.items()},
        math.sqrt(squares / (2 * n)),
        baseline,
    )
