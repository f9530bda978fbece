"""Effect of float32 on every reported quantity of a track, in sigmas, until a decision differs between the two
builds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from goe_tools import double_precision
from goe_tools.library import Images, named_settings, package, to_package

# Reported quantities: name: column, validity bit, and period.
POSITION, LENGTH, HEIGHT, ORIENTATION, CENTER, WIDTH, VELOCITY = 1, 2, 4, 8, 16, 32, 64
QUANTITIES: dict[str, tuple[int, float]] = {
    "x0_m": (POSITION, 0.0), "z0_m": (POSITION, 0.0), "x_m": (POSITION, 0.0), "z_m": (POSITION, 0.0),
    "width_m": (WIDTH, 0.0), "length_m": (LENGTH, 0.0), "height_m": (HEIGHT, 0.0),
    "orientation_deg": (ORIENTATION, 180.0), "center_north_m": (CENTER, 0.0), "center_east_m": (CENTER, 0.0),
    "velocity_north_m_s": (VELOCITY, 0.0), "velocity_east_m_s": (VELOCITY, 0.0),
}  # fmt: skip
DECISIONS = ("method", "model", "valid", "fresh", "suspect", "images_used", "nis_rows", "reason")
MOVES = 2  # reason of a suspect estimate of a moving obstacle
NIS_APART = 0.05  # of 1 + NIS: a larger difference indicates a different internal decision


@dataclass(frozen=True)
class Difference:
    """One track of K images; by quantity (K,) |float32 - float64| over the sigma of float64; NaN: not compared.

    As long as all decisions agree, the two differ by rounding alone. The NIS reveals decisions that no output contains
    (the association of a box's corners, an outlier's weight)."""

    sigmas: dict[str, np.ndarray]  # while all decisions agree, and the estimate is not suspect except for motion
    ever: dict[str, np.ndarray]  # while all reported decisions agree
    sigma: dict[str, np.ndarray]  # relative difference of the sigma itself, where `sigmas` are compared
    answered: int  # images with an answer in both
    apart: int  # of these, those after the first different decision


def most(column: np.ndarray) -> float:
    return float(np.nanmax(column)) if np.isfinite(column).any() else 0.0


def _outputs_agree(single: Any, double: Any) -> np.ndarray:
    """(K,): whether all reported decisions agree up to this image."""
    same = single.status == double.status
    for name in DECISIONS:
        same = same & (single.estimates[name] == double.estimates[name])
    return np.logical_and.accumulate(same)


def _fits_agree(single: Any, double: Any) -> np.ndarray:
    one, other = (track.estimates["nis"].astype(float) for track in (single, double))
    near = np.abs(one - other) <= NIS_APART * (1.0 + other)
    doubted = single.estimates["suspect"].astype(bool) & (single.estimates["reason"] != MOVES)
    return np.logical_and.accumulate(near & ~doubted)


def difference(images: Images, settings: dict[str, float]) -> Difference:
    given, named = to_package(images), named_settings(tuple(settings.items()))
    single, double = package().run(named, given), double_precision.run(named, given)
    both = (single.estimates["valid"] & double.estimates["valid"] & POSITION) != 0
    reported = _outputs_agree(single, double)
    agree = reported & _fits_agree(single, double)
    sigmas, ever, sigma = {}, {}, {}
    for name, (bit, turn) in QUANTITIES.items():
        off = np.abs(single.estimates[name].astype(float) - double.estimates[name].astype(float))
        if turn > 0.0:
            off = np.minimum(off, np.abs(turn - off))
        one, other = (track.estimates["sigma"][name].astype(float) for track in (single, double))
        known = ((double.estimates["valid"] & bit) != 0) & double.estimates["fresh"].astype(bool) & (other > 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            sigmas[name] = np.where(known & agree, off / other, np.nan)
            ever[name] = np.where(known & reported, off / other, np.nan)
            sigma[name] = np.where(known & agree, np.abs(one / other - 1.0), np.nan)
    return Difference(sigmas, ever, sigma, int(both.sum()), int((both & ~agree).sum()))
