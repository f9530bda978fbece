"""Disturbances of a flight: missed detections, resets of the autopilot's filter, refused images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import EVEN_MISSED, Draws
from .genes import BOTH, HORIZONTAL, NO_RESET, VERTICAL, Array, Params
from .motion import Motion

NAN_ATTITUDE, LONG_ATTITUDE, OLD_TIME = range(3)


@dataclass
class Mishaps:
    """(F, K, ...)"""

    detected: np.ndarray  # bool
    known: np.ndarray  # bool: a reset of known size comes with this image
    unknown: np.ndarray  # bool
    jump: Array  # (F, K, 3) of the reported position, since the first image
    jump_height: Array  # (F, K) of the reported height
    count: np.ndarray  # resets so far
    delta: Array  # (F, K, 3) reported: since the last accepted image; NaN: unknown
    refused: np.ndarray  # bool


def at_share(p: Params, motion: Motion, name: str) -> np.ndarray:
    """(F, 1): image number at a share of the images that may show the obstacle; never the first one."""
    span = motion.count - motion.first - 2
    return np.asarray(motion.first + 1 + (p[name] * span).astype(int))[:, None]


def _detected(p: Params, draws: Draws, motion: Motion) -> np.ndarray:
    number = np.arange(motion.t_s.shape[1])
    found = (number >= motion.first[:, None]) & (draws.even[..., EVEN_MISSED] >= p["missed_share"][:, None])
    n = np.maximum(p["every_n"], 1)[:, None]
    found &= (p["every_n"][:, None] == 0) | (number % n != n - 1)
    for i, name in enumerate(("run_at", "run_at_2")):
        start = np.take_along_axis(motion.t_s, at_share(p, motion, name), 1)
        since = motion.t_s - start
        found &= ~((p["runs"][:, None] > i) & (since >= 0.0) & (since < p["run_s"][:, None]))
    return found


def _refused(p: Params, motion: Motion) -> np.ndarray:
    return p["refused"][:, None] & (np.arange(motion.t_s.shape[1]) == at_share(p, motion, "refused_at"))


def _summed(step: Array, refused: np.ndarray) -> Array:
    """The reported jumps: an image after a refused one repeats its reset."""
    found = step.copy()
    for k in range(1, step.shape[1]):
        found[:, k] += np.where(refused[:, k - 1, None], found[:, k - 1], 0.0)
    return found


def happen(p: Params, draws: Draws, motion: Motion) -> Mishaps:
    number = np.arange(motion.t_s.shape[1])
    kind = p["reset_kind"]
    size = np.stack([p["reset_n_m"], p["reset_e_m"], p["reset_d_m"]], 1)
    level, upright = np.isin(kind, (HORIZONTAL, BOTH)), np.isin(kind, (VERTICAL, BOTH))
    known_size = size * np.stack([level, level, upright], 1)
    at = at_share(p, motion, "reset_at")
    second = np.minimum(at + 7, motion.count[:, None] - 1)
    is_first = (kind != NO_RESET)[:, None] & (number == at)
    is_second = ((kind != NO_RESET) & (p["resets"] > 1))[:, None] & (number == second) & (second > at)
    unknown = p["unknown"][:, None] & (number == at_share(p, motion, "unknown_at"))
    step = known_size[:, None] * (is_first * 1.0 - is_second * 0.6)[..., None]
    refused = _refused(p, motion)
    reported = _summed(np.where(unknown[..., None], np.nan, step), refused)
    jump = np.cumsum(step + size[:, None] * unknown[..., None], 1)
    follows = p["height_follows"][:, None] & upright[:, None]
    return Mishaps(
        _detected(p, draws, motion), is_first | is_second, unknown, jump, -np.cumsum(step[..., 2], 1) * follows,
        np.cumsum(is_first.astype(int) + is_second + unknown, 1), reported, refused,
    )  # fmt: skip
