"""The error of an estimate against the truth.

If a box is observed nearly along a diagonal, front and side may swap: the estimate is compared with the naming that is
nearer in angle. If a footprint (a disc or a prism) represents a box, its place is compared with the middle of the
box, and nothing else is judged."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..flights.flight import Flight, Obstacle
from ..flights.rotations import fold
from ..library import MODEL_BOX, MODEL_DISC, MODEL_LINE, MODEL_PRISM, Track
from .model import COMPLEX_STEP

X0, Z0, ORIENTATION, WIDTH, LENGTH, HEIGHT = range(6)
DISC_QUANTITIES = np.array([True, True, False, True, False, True])
EXCHANGE_ANGLE = math.pi / 4


def renamed(values: np.ndarray, side: int) -> np.ndarray:
    """x0, z0, orientation, width, length, height (..., 6) of a box after renaming the face on one side (1: right, -1:
    left) to front; works for complex values."""
    x, z, angle, width, length, height = np.moveaxis(values, -1, 0)
    c, s = np.cos(angle), np.sin(angle)
    x = x + side * width / 2 * c + length / 2 * s
    z = z - side * width / 2 * s + length / 2 * c
    return np.stack([x, z, angle - side * math.pi / 2, length, width, height], -1)


def renamed_sigma(truth: Obstacle, covariance: np.ndarray) -> np.ndarray:
    """(6,): sigmas under the other naming, from a covariance (6, 6) under the naming of the truth."""
    steps = truth.values + 1j * COMPLEX_STEP * np.eye(6)
    slopes = renamed(steps, _visible_side(truth)).imag.T / COMPLEX_STEP
    return np.sqrt(np.maximum(np.diag(slopes @ covariance @ slopes.T), 0.0))


def _visible_side(truth: Obstacle) -> int:
    """The side face visible at the track's first image: 1 right, -1 left."""
    c, s = math.cos(truth.orientation_rad), math.sin(truth.orientation_rad)
    return 1 if -(c * truth.x0_m - s * truth.z0_m) > 0 else -1


@dataclass
class Judgement:
    """Errors and sigmas (K, 6), NaN without an answer that can be judged; renamed (K,)."""

    error: np.ndarray
    sigma: np.ndarray
    renamed: np.ndarray


def _known_angles(angles: np.ndarray) -> np.ndarray:
    """(K,): fills each gap from the next answer, otherwise from the previous one; all NaN without an answer."""
    known = np.flatnonzero(np.isfinite(angles))
    if not len(known):
        return angles
    nearest = np.searchsorted(known, np.arange(len(angles)))
    return angles[known[np.minimum(nearest, len(known) - 1)]]


def judge(track: Track, flight: Flight) -> Judgement:
    """Compares an estimator's answers with a flight's truth."""
    truth, values, sigma = flight.truth, track.values, track.sigma.copy()
    error = values - truth.values
    other = np.zeros(len(values), bool)
    if truth.kind != "box":
        error[:, ~DISC_QUANTITIES] = np.nan
    else:
        as_box = (track.model == MODEL_BOX) | (track.model == MODEL_LINE)
        angles = _known_angles(np.where(as_box, values[:, ORIENTATION], np.nan))
        with np.errstate(invalid="ignore"):
            other = as_box & (np.abs(fold(angles - truth.orientation_rad)) > EXCHANGE_ANGLE)
        error[other] = values[other] - renamed(truth.values, _visible_side(truth))
        footprint = (track.model == MODEL_DISC) | (track.model == MODEL_PRISM)
        middle = truth.corners().mean(0)
        error[footprint, :2] = values[footprint, :2] - middle
        error[footprint, 2:] = np.nan
    error[:, ORIENTATION] = fold(error[:, ORIENTATION])
    sigma[~np.isfinite(error)] = np.nan
    return Judgement(error, sigma, other)
