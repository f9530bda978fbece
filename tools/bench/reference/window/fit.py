"""Equation (5) over a window of images in closed form, and sliding means."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..gates import UNIT_ROUNDOFF, Gates
from .precision import Numbers, Real, Rounding


@dataclass
class Row:
    """The two rows of (5) for one image, turned back by the orientation into T, where they are

    xi = X0/W - dX/W and zeta = Z0/W - dZ/W.
    """

    xi: Real
    zeta: Real
    dx_m: Real
    dz_m: Real
    roundoff: Rounding = 0.0  # effect of float32 arithmetic on xi and zeta
    roundoff_m: Rounding = 0.0  # ... and to dX and dZ


@dataclass
class Fit:
    """A solution; sigmas and roundoffs of x0_m, z0_m and width_m."""

    x0_m: Real
    z0_m: Real
    width_m: Real
    sigma: dict[str, Real]
    roundoff: dict[str, Rounding]  # sigmas from rounding of the rows alone
    residual: Real
    baseline_m: Real

    @property
    def ratio(self) -> Rounding:
        """Conditioning of the solution."""
        return float(self.baseline_m) / float(self.width_m)


@dataclass
class Ring:
    """The newest items. A new item replaces the oldest one in its place; sums go by place, which affects the last
    bits."""

    length: int
    items: list = field(default_factory=list)
    next: int = 0
    count: int = 0  # of all added items

    def add(self, item: object) -> None:
        if len(self.items) < self.length:
            self.items.append(item)
        else:
            self.items[self.next] = item
        self.next = (self.next + 1) % self.length
        self.count += 1


def solve(n: Numbers, rows: list[Row], min_baseline_m: Real, gates: Gates) -> tuple[str, Fit | None]:
    """(5) over a window, two straight lines with one shared slope -1/W: ("ok", fit) or (reason, None)."""
    length = len(rows)
    mean_dx = mean_dz = mean_xi = mean_zeta = n.zero
    for row in rows:
        mean_dx, mean_dz = mean_dx + row.dx_m, mean_dz + row.dz_m
        mean_xi, mean_zeta = mean_xi + row.xi, mean_zeta + row.zeta
    share = n.one / n.real(length)
    mean_dx, mean_dz, mean_xi, mean_zeta = mean_dx * share, mean_dz * share, mean_xi * share, mean_zeta * share
    off = [(row.dx_m - mean_dx, row.dz_m - mean_dz, row.xi - mean_xi, row.zeta - mean_zeta) for row in rows]
    spread_m2 = mixed_m = n.zero
    for x, z, xi, zeta in off:
        spread_m2 = spread_m2 + (x * x + z * z)
        mixed_m = mixed_m + (x * xi + z * zeta)
    baseline_m = np.sqrt(spread_m2)
    reach = max(max(abs(row.dx_m), abs(row.dz_m)) for row in rows)
    if gates.decide("baseline", baseline_m < min_baseline_m, baseline_m - min_baseline_m, baseline_m + reach):
        return "no_baseline", None

    slope = -mixed_m / spread_m2
    change, least = slope * baseline_m, n.parallax_min * (n.one + abs(mean_xi) + abs(mean_zeta))
    steepness = float(slope)
    roundoff = math.sqrt(sum(row.roundoff**2 + (row.roundoff_m * steepness) ** 2 for row in rows) / length)
    row_size = roundoff / UNIT_ROUNDOFF + max(max(abs(row.xi), abs(row.zeta)) for row in rows)
    if gates.decide("parallax", change <= least, change - least, row_size):
        return "no_parallax", None
    width_m = n.one / slope
    x0_m = width_m * mean_xi + mean_dx
    z0_m = width_m * mean_zeta + mean_dz
    largest_m = max(abs(width_m), abs(x0_m), abs(z0_m))
    limit_m = n.metres_max
    within = all(abs(value) <= limit_m for value in (width_m, x0_m, z0_m))
    if gates.decide("limit", not within, largest_m - limit_m, limit_m * (1.0 + row_size / float(change))):
        return "no_parallax", None

    # variances for rows of variance 1: the slope has 1/D, the means have 1/N, and they are independent
    mean, tilt = n.one / n.real(length), width_m * width_m * (n.one / spread_m2)
    spread = {
        "x0_m": float(width_m * np.sqrt(mean + mean_xi * mean_xi * tilt)),
        "z0_m": float(width_m * np.sqrt(mean + mean_zeta * mean_zeta * tilt)),
        "width_m": float(width_m * np.sqrt(tilt)),
    }
    ahead_m = z0_m - max(row.dz_m for row in rows)
    size_m = abs(float(z0_m)) + float(reach) + spread["z0_m"] * row_size
    if gates.decide("abeam", ahead_m <= n.zero, ahead_m, size_m):
        return "abeam", None

    squares = n.zero
    for x, z, xi, zeta in off:
        along, across = xi + slope * x, zeta + slope * z
        squares = squares + (along * along + across * across)
    s2 = squares / n.real(2 * length - 3)
    mean, tilt = s2 / n.real(length), width_m * width_m * (s2 / spread_m2)
    sigma = {
        "x0_m": width_m * np.sqrt(mean + mean_xi * mean_xi * tilt),
        "z0_m": width_m * np.sqrt(mean + mean_zeta * mean_zeta * tilt),
        "width_m": width_m * np.sqrt(tilt),
    }
    return "ok", Fit(
        x0_m,
        z0_m,
        width_m,
        {name: value if value < n.sigma_max_m else n.sigma_max_m for name, value in sigma.items()},
        {name: roundoff * value for name, value in spread.items()},
        np.sqrt(squares / n.real(2 * length)),
        baseline_m,
    )


@dataclass
class Mean:
    """Sliding mean, with baseline / W of the solution behind each value."""

    ring: Ring

    @property
    def ratio(self) -> Rounding:
        return min((ratio for _, ratio in self.ring.items), default=0.0)

    def add(self, n: Numbers, value: Real, ratio: Rounding) -> tuple[Real, Real]:
        """Mean of the newest values, and its variance from their spread (0 for a single one)."""
        self.ring.add((value, ratio))
        values = [value for value, _ in self.ring.items]
        count, total, squares = len(values), n.zero, n.zero
        for value in values:
            total = total + value
        mean = total / n.real(count)
        for value in values:
            off = value - mean
            squares = squares + off * off
        return mean, squares / n.real((count - 1) * count) if count > 1 else n.zero
