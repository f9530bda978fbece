"""The obstacles, in level T-like axes about the middle of the footprint: X right, Z forward, heights above the
ground."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

RIM_POINTS = 180  # in place of a circle: the outline is at most 1.5e-4 of the radius too narrow
EAVES_SHARE = 0.6  # of a gable roof's height
TOP_SHARE = 0.2  # of a pylon's width at the top
NOTCH_SHARE = 0.5  # share of an L's width and length
GAP_M = (2.0, 8.0)  # between two buildings
LEVELS = 9  # of a pylon's legs, its visible part


@dataclass(frozen=True)
class Solid:
    """``orientation_rad``: of the side edge (length) from Z, clockwise from above, as the library reports it. Width and
    length are those of the smallest rectangle along these axes that contains the footprint."""

    kind: str  # cylinder, box, roof, pylon, L or two
    orientation_rad: float
    width_m: float
    length_m: float
    height_m: float
    gap_m: float = 0.0  # two: between the buildings
    setback_m: float = 0.0  # two: distance of the second one farther back

    @property
    def across(self) -> np.ndarray:
        """(X, Z) along the front edge, to the right."""
        return np.array([math.cos(self.orientation_rad), -math.sin(self.orientation_rad)])

    @property
    def along(self) -> np.ndarray:
        """(X, Z) along the side edge."""
        return np.array([math.sin(self.orientation_rad), math.cos(self.orientation_rad)])

    @property
    def half_m(self) -> float:
        """Largest distance of its points from its middle."""
        return 0.5 * (self.width_m if self.kind == "cylinder" else math.hypot(self.width_m, self.length_m))

    def _placed(self, shares: np.ndarray) -> np.ndarray:
        """(N, 2) of shares of width and length, -0.5 to 0.5."""
        return shares[:, :1] * self.width_m * self.across + shares[:, 1:] * self.length_m * self.along

    def rectangle(self) -> np.ndarray:
        """(4, 2): front left, back left, back right, front right; clockwise from above."""
        return self._placed(np.array([[-0.5, -0.5], [-0.5, 0.5], [0.5, 0.5], [0.5, -0.5]]))

    def bases(self) -> list[np.ndarray]:
        """Corners of the convex footprints (N, 2), clockwise from above; of a cylinder its rim."""
        if self.kind == "cylinder":
            angle = np.arange(RIM_POINTS) * (2 * math.pi / RIM_POINTS)
            return [0.5 * self.width_m * np.stack([np.sin(angle), np.cos(angle)], 1)]
        if self.kind == "two":
            half = 0.5 - 0.5 * self.gap_m / self.width_m
            back = self.setback_m / self.length_m
            left = np.array([[-0.5, -0.5], [-0.5, 0.5 - back], [half - 0.5, 0.5 - back], [half - 0.5, -0.5]])
            right = np.array([[0.5 - half, back - 0.5], [0.5 - half, 0.5], [0.5, 0.5], [0.5, back - 0.5]])
            return [self._placed(left), self._placed(right)]
        if self.kind == "L":
            cut = NOTCH_SHARE - 0.5
            wing = np.array([[-0.5, -0.5], [-0.5, 0.5], [cut, 0.5], [cut, -0.5]])
            foot = np.array([[cut, -0.5], [cut, cut], [0.5, cut], [0.5, -0.5]])
            return [self._placed(wing), self._placed(foot)]
        return [self.rectangle()]

    def points(self) -> np.ndarray:
        """(N, 3) X, Z, height: points with the same outline as the solid from any side; an L's notch does not change
        it, since none of its points is extreme."""
        base = np.concatenate(self.bases())
        if self.kind == "roof":
            ridge = self._placed(np.array([[0.0, -0.5], [0.0, 0.5]]))
            levels = ((base, 0.0), (base, EAVES_SHARE), (ridge, 1.0))
        elif self.kind == "pylon":
            shares = np.linspace(0.0, 1.0, LEVELS)
            levels = tuple((base * (1.0 - (1.0 - TOP_SHARE) * s), float(s)) for s in shares)
        else:
            levels = ((base, 0.0), (base, 1.0))
        rows = [np.column_stack([level, np.full(len(level), share * self.height_m)]) for level, share in levels]
        return np.concatenate(rows)

    def tops(self) -> np.ndarray:
        """(N, 3): the corners of the highest part; for a cylinder the upper rim."""
        points = self.points()
        return points[points[:, 2] >= self.height_m * (1 - 1e-9)]


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def drawn(kind: str, size_m: tuple[float, float], rng: np.random.Generator) -> Solid:
    """A solid with width, length and height within ``size_m``."""
    low, high = size_m
    width, height = _log(rng, low, high), _log(rng, max(low, 3.0), high)
    turned, ratio = math.radians(rng.uniform(-45.0, 45.0)), _log(rng, 0.5, 2.5)
    length, gap, setback = min(max(width * ratio, low), high), rng.uniform(*GAP_M), rng.uniform(0.2, 0.5)
    if kind == "cylinder":
        return Solid(kind, 0.0, width, width, height)
    if kind == "pylon":
        width = length = max(0.5 * width, low)
        return Solid(kind, turned, width, length, max(height, 3.0 * width))
    if kind == "two":
        return Solid(kind, turned, 2.0 * width + gap, (1.0 + setback) * length, height, gap, setback * length)
    return Solid(kind, turned, width, length, height)
