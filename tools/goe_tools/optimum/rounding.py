"""What float32 does to every reported quantity of a track, in sigmas, until the two builds decide something
otherwise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import double_precision
from .library import Images, named_settings, package, to_package

# Reported quantities: by name the column, its bit, the turn after which it is the same again.
POSITION, LENGTH, HEIGHT, ORIENTATION, CENTER, WIDTH, VELOCITY = 1, 2, 4, 8, 16, 32, 64
QUANTITIES: dict[str, tuple[int, float]] = {
    "x0_m": (POSITION, 0.0), "z0_m": (POSITION, 0.0), "x_m": (POSITION, 0.0), "z_m": (POSITION, 0.0),
    "width_m": (WIDTH, 0.0), "length_m": (LENGTH, 0.0), "height_m": (HEIGHT, 0.0),
    "orientation_deg": (ORIENTATION, 180.0), "center_north_m": (CENTER, 0.0), "center_east_m": (CENTER, 0.0),
    "velocity_north_m_s": (VELOCITY, 0.0), "velocity_east_m_s": (VELOCITY, 0.0),
}  # fmt: skip
DECISIONS = ("method", "model", "valid", "fresh", "suspect", "points", "nis_rows", "reason")


@dataclass(frozen=True)
class Difference:
    """Of one track of K images."""

    sigmas: dict[str, np.ndarray]  # by quantity: (K,) |float32 - float64| over the latter's sigma; NaN: not compared
    sigma: dict[str, np.ndarray]  # ... of its sigma, relative
    answered: int  # images with an answer in both
    apart: int  # of these, those from which on something was decided otherwise

    def worst(self, name: str) -> float:
        column = self.sigmas[name]
        return float(np.nanmax(column)) if np.isfinite(column).any() else 0.0

    def worst_sigma(self, name: str) -> float:
        column = self.sigma[name]
        return float(np.nanmax(column)) if np.isfinite(column).any() else 0.0


def _alike(single: Any, double: Any) -> np.ndarray:
    """(K,): up to this image all was decided alike."""
    same = single.status == double.status
    for name in DECISIONS:
        same = same & (single.estimates[name] == double.estimates[name])
    return np.logical_and.accumulate(same)


def difference(images: Images, settings: dict[str, float]) -> Difference:
    given, named = to_package(images), named_settings(tuple(settings.items()))
    single, double = package().run(named, given), double_precision.run(named, given)
    both = (single.estimates["valid"] & double.estimates["valid"] & POSITION) != 0
    alike = _alike(single, double)
    sigmas, sigma = {}, {}
    for name, (bit, turn) in QUANTITIES.items():
        known = alike & ((double.estimates["valid"] & bit) != 0) & double.estimates["fresh"].astype(bool)
        off = np.abs(single.estimates[name].astype(float) - double.estimates[name].astype(float))
        if turn > 0.0:
            off = np.minimum(off, np.abs(turn - off))
        one, other = (track.estimates["sigma"][name].astype(float) for track in (single, double))
        known = known & (other > 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            sigmas[name] = np.where(known, off / other, np.nan)
            sigma[name] = np.where(known, np.abs(one / other - 1.0), np.nan)
    return Difference(sigmas, sigma, int(both.sum()), int((both & ~alike).sum()))
