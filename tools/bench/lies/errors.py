"""Random numbers of flights and the resulting pose errors, as defined by goe.h, one sigma each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .genes import Array, Params

CONSTANTS = 12
(WHITE_ATTITUDE, DRIFT_ATTITUDE, WALK, WHITE_POSITION) = (slice(3 * i, 3 * i + 3) for i in range(4))
WHITE_HEIGHT = 12
PIXELS = slice(13, 25)  # of six points
SIDE_WHITE, SIDE_CORRELATED, SIDE_CUT = slice(25, 29), slice(29, 33), slice(33, 37)
SERIES = 37
(EVEN_JITTER, EVEN_MISSED, EVEN_CUT, EVEN_PARTLY) = (0, 1, 2, slice(3, 13))
EVENS = 13


@dataclass
class Draws:
    """Standard normal and uniform (0 to 1) numbers of each flight, from its seed."""

    constant: Array  # (F, CONSTANTS)
    series: Array  # (F, K, SERIES)
    even: Array  # (F, K, EVENS)


def draw(seeds: np.ndarray, counts: np.ndarray) -> Draws:
    most = int(counts.max())
    constant = np.empty((len(seeds), CONSTANTS))
    series, even = np.zeros((len(seeds), most, SERIES)), np.zeros((len(seeds), most, EVENS))
    for i, (seed, count) in enumerate(zip(seeds.tolist(), counts.tolist())):
        rng = np.random.Generator(np.random.SFC64(seed))
        constant[i] = rng.standard_normal(CONSTANTS)
        series[i, :count] = rng.standard_normal((count, SERIES))
        even[i, :count] = rng.random((count, EVENS))
    return Draws(constant, series, even)


def correlated(white: Array, share: Array) -> Array:
    """(F, K, ...) of unit variance, each number correlated with the previous one by ``share`` (F, K)."""
    found = white.copy()
    fresh = np.sqrt(1.0 - share**2)
    for k in range(1, white.shape[1]):
        found[:, k] = share[:, k, None] * found[:, k - 1] + fresh[:, k, None] * white[:, k]
    return found


@dataclass
class PoseErrors:
    """Reported minus true values."""

    attitude: Array  # (F, K, 3) about body axes, rad
    position: Array  # (F, K, 3) m
    height: Array  # (F, K) m
    slope: Array  # (F,) of the ground from the obstacle towards the aircraft at first sight


def _walk(white: Array, per_root_s: Array, t: Array) -> Array:
    step = np.sqrt(np.diff(t, axis=1, prepend=t[:, :1]))
    return np.cumsum(white * step[..., None], 1) * per_root_s[:, None, None]


def pose_errors(p: Params, draws: Draws, t: Array, after_reset: np.ndarray) -> PoseErrors:
    """``after_reset``: (F, K) after a reset of unknown size, which gives the attitude another constant error."""
    fixed, series = draws.constant * p["constant_scale"][:, None], draws.series * p["pose_scale"][:, None, None]

    def column(name: str) -> Array:
        return np.asarray(p[name][:, None, None])

    constant = np.where(after_reset[..., None], fixed[:, None, 8:11], fixed[:, None, :3])
    attitude = column("attitude_bias") * constant + column("attitude_white") * series[..., WHITE_ATTITUDE]
    attitude = attitude + _walk(series[..., DRIFT_ATTITUDE], p["attitude_drift"], t)
    drift = column("velocity_bias") * t[..., None] * (fixed[:, None, 3:6] * np.array([1.0, 1.0, 0.0]))
    position = (
        drift + _walk(series[..., WALK], p["position_walk"], t) + column("position_white") * series[..., WHITE_POSITION]
    )
    ground = np.where(p["ground_drawn"], p["ground"] * fixed[:, 7], 0.0)
    height = (p["height_bias"] * fixed[:, 6] + ground)[:, None] + p["height_white"][:, None] * series[..., WHITE_HEIGHT]
    slope = np.where(p["slope_drawn"], p["slope"] * fixed[:, 11], 0.0)
    return PoseErrors(np.radians(attitude), position, height, slope)
