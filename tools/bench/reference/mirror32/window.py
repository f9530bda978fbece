"""Equation (5) over a window of images in closed form, and sliding means."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .single import ONE, ZERO, Decisions, F, larger, within

PARALLAX_MIN, METRES_MAX, SIGMA_MAX_M = F(1.0e-6), F(1.0e6), F(1.0e9)
COUNT_MAX = 32767


@dataclass
class Window:
    """A ring, as in C: the order of summation is the order in memory."""

    dx_m: list[np.float32]
    dz_m: list[np.float32]
    xi: list[np.float32]
    zeta: list[np.float32]
    next: int = 0
    count: int = 0

    @classmethod
    def of(cls, length: int) -> Window:
        return cls([ZERO] * length, [ZERO] * length, [ZERO] * length, [ZERO] * length)

    def add(self, dx_m: np.float32, dz_m: np.float32, row: tuple[np.float32, np.float32]) -> None:
        at, length = self.next, len(self.xi)
        self.dx_m[at], self.dz_m[at] = dx_m, dz_m
        self.xi[at], self.zeta[at] = row
        self.next = at + 1 if at + 1 < length else 0
        self.count = min(self.count + 1, COUNT_MAX)


@dataclass
class Fit:
    x0_m: np.float32
    z0_m: np.float32
    width_m: np.float32
    sigma_x0_m: np.float32
    sigma_z0_m: np.float32
    sigma_width_m: np.float32
    residual: np.float32
    baseline_m: np.float32


def bounded(sigma_m: np.float32) -> np.float32:
    return sigma_m if sigma_m < SIGMA_MAX_M else SIGMA_MAX_M


def window_solve(window: Window, min_baseline_m: np.float32, taken: Decisions) -> tuple[str, Fit | None]:
    """(5) in closed form."""
    length = len(window.xi)
    mean_dx = mean_dz = mean_xi = mean_zeta = ZERO
    largest_dz = window.dz_m[0]
    share = ONE / F(length)
    for k in range(length):
        mean_dx = mean_dx + window.dx_m[k]
        mean_dz = mean_dz + window.dz_m[k]
        mean_xi = mean_xi + window.xi[k]
        mean_zeta = mean_zeta + window.zeta[k]
        largest_dz = larger(largest_dz, window.dz_m[k])
    mean_dx, mean_dz, mean_xi, mean_zeta = mean_dx * share, mean_dz * share, mean_xi * share, mean_zeta * share
    spread_m2 = mixed_m = ZERO
    for k in range(length):
        x = window.dx_m[k] - mean_dx
        z = window.dz_m[k] - mean_dz
        spread_m2 = spread_m2 + (x * x + z * z)
        mixed_m = mixed_m + (x * (window.xi[k] - mean_xi) + z * (window.zeta[k] - mean_zeta))

    baseline_m = np.sqrt(spread_m2)
    taken["baseline"] = bool(baseline_m < min_baseline_m)
    if taken["baseline"]:
        return "no_baseline", None
    inverse_width = -mixed_m / spread_m2
    taken["parallax"] = bool(inverse_width * baseline_m <= PARALLAX_MIN * (ONE + np.abs(mean_xi) + np.abs(mean_zeta)))
    if taken["parallax"]:
        return "no_parallax", None
    width_m = ONE / inverse_width
    x0_m = width_m * mean_xi + mean_dx
    z0_m = width_m * mean_zeta + mean_dz
    taken["limit"] = not (within(width_m, METRES_MAX) and within(x0_m, METRES_MAX) and within(z0_m, METRES_MAX))
    if taken["limit"]:
        return "no_parallax", None
    taken["passed"] = bool(z0_m <= largest_dz)
    if taken["passed"]:
        return "passed", None

    squares = ZERO
    for k in range(length):
        x = (window.xi[k] - mean_xi) + inverse_width * (window.dx_m[k] - mean_dx)
        z = (window.zeta[k] - mean_zeta) + inverse_width * (window.dz_m[k] - mean_dz)
        squares = squares + (x * x + z * z)
    s2 = squares / F(2 * length - 3)
    mean = s2 / F(length)
    slope = width_m * width_m * (s2 / spread_m2)
    return "ok", Fit(
        x0_m,
        z0_m,
        width_m,
        bounded(width_m * np.sqrt(mean + mean_xi * mean_xi * slope)),
        bounded(width_m * np.sqrt(mean + mean_zeta * mean_zeta * slope)),
        bounded(width_m * np.sqrt(slope)),
        np.sqrt(squares / F(2 * length)),
        baseline_m,
    )


@dataclass
class Mean:
    value: list[np.float32]
    next: int = 0
    count: int = 0

    def add(self, value: np.float32) -> tuple[np.float32, np.float32]:
        """Mean and its variance."""
        length = len(self.value)
        self.value[self.next] = value
        self.next = self.next + 1 if self.next + 1 < length else 0
        self.count = self.count + 1 if self.count < length else length
        n = self.count
        mean = squares = ZERO
        for k in range(n):
            mean = mean + self.value[k]
        mean = mean / F(n)
        for k in range(n):
            off = self.value[k] - mean
            squares = squares + off * off
        return mean, squares / F((n - 1) * n) if n > 1 else ZERO
