"""Whether and when a flown path first violates the margin of an obstacle.

After the last image the path continues straight at the last velocity. North, east, down in meters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..logs.obslog import Truth

STEP_S = 0.05
FLOWN_ON_S = 60.0


@dataclass(frozen=True)
class Course:
    closest_m: float  # horizontal distance to the walls; 0: over the obstacle
    violated_s: float  # first violation of both margin and clearance; NaN: never


def distance_to_walls(truth: Truth, north_m: np.ndarray, east_m: np.ndarray) -> np.ndarray:
    """(K,) horizontal distance; 0 inside."""
    n, e = north_m - truth.center_n_m, east_m - truth.center_e_m
    if truth.length_m is None or truth.heading_deg is None:
        return np.maximum(np.hypot(n, e) - 0.5 * truth.width_m, 0.0)
    c, s = math.cos(math.radians(truth.heading_deg)), math.sin(math.radians(truth.heading_deg))
    along = np.maximum(np.abs(n * c + e * s) - 0.5 * truth.length_m, 0.0)
    across = np.maximum(np.abs(e * c - n * s) - 0.5 * truth.width_m, 0.0)
    return np.hypot(along, across)


def flown_on(time_s: np.ndarray, position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The path (K,), (K, 3) in steps of ``STEP_S``, and its straight continuation."""
    dense_s = np.arange(time_s[0], time_s[-1] + 0.5 * STEP_S, STEP_S)
    dense_m = np.stack([np.interp(dense_s, time_s, column) for column in position_m.T], -1)
    if len(time_s) < 2:
        return dense_s, dense_m
    velocity = (position_m[-1] - position_m[-2]) / (time_s[-1] - time_s[-2])
    after_s = np.arange(1, round(FLOWN_ON_S / STEP_S) + 1) * STEP_S
    after_m = position_m[-1] + after_s[:, None] * velocity
    return np.concatenate([dense_s, time_s[-1] + after_s]), np.concatenate([dense_m, after_m])


def course_of(truth: Truth, time_s: np.ndarray, position_m: np.ndarray, margin_m: float, clearance_m: float) -> Course:
    path_s, path_m = flown_on(time_s, position_m)
    walls_m = distance_to_walls(truth, path_m[:, 0], path_m[:, 1])
    over_top_m = truth.ground_d_m - truth.height_m - path_m[:, 2]
    inside = np.flatnonzero((walls_m < margin_m) & (over_top_m < clearance_m))
    return Course(float(walls_m.min()), float(path_s[inside[0]]) if len(inside) else math.nan)
