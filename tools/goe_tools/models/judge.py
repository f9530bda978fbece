"""How far an estimate is from the truth.

Of a box that is seen nearly along a diagonal, front and side may change names: the estimate is held against the naming
that is nearer in angle. A disc that stands for a box has the box's middle as its place, and no other answer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..flights.flight import Flight, Obstacle
from ..flights.rotations import fold
from ..library import MODEL_BOX, MODEL_DISC, MODEL_LINE, Track
from .model import COMPLEX_STEP

X0, Z0, ORIENTATION, WIDTH, LENGTH, HEIGHT = range(6)
DISC_QUANTITIES = np.array([True, True, False, True, False, True])
EXCHANGE_ANGLE = math.pi / 4


def renamed(values: np.ndarray, side: int) -> np.ndarray:
    """x0, z0, orientation, width, length, height (..., 6) of a box when the face on one side (1: right, -1: left) is
    called the front; complex values too."""
    x, z, angle, width, length, height = np.moveaxis(values, -1, 0)
    c, s = np.cos(angle), np.sin(angle)
    x = x + side * width / 2 * c + length / 2 * s
    z = z - side * width / 2 * s + length / 2 * c
    return np.stack([x, z, angle - side * math.pi / 2, length, width, height], -1)


def renamed_sigma(truth: Obstacle, covariance: np.ndarray) -> np.ndarray:
    """(6,): one sigma under the other naming, of a covariance (6, 6) under the truth's own."""
    steps = truth.values + 1j * COMPLEX_STEP * np.eye(6)
    slopes = renamed(steps, _seen_side(truth)).imag.T / COMPLEX_STEP
    return np.sqrt(np.maximum(np.diag(slopes @ covariance @ slopes.T), 0.0))


def _seen_side(truth: Obstacle) -> int:
    """Which side face the camera sees at the track's first image: 1 right, -1 left."""
    c, s = math.cos(truth.orientation_rad), math.sin(truth.orientation_rad)
    return 1 if -(c * truth.x0_m - s * truth.z0_m) > 0 else -1


@dataclass
class Judgement:
    """Errors and sigmas (K, 6), NaN where there is no answer or none that could be judged; renamed (K,)."""

    error: np.ndarray
    sigma: np.ndarray
    renamed: np.ndarray


def _known_angles(angles: np.ndarray) -> np.ndarray:
    """(K,): each gap filled from the answer after it, or else before it; all NaN if there is none."""
    known = np.flatnonzero(np.isfinite(angles))
    if not len(known):
        return angles
    nearest = np.searchsorted(known, np.arange(len(angles)))
    return angles[known[np.minimum(nearest, len(known) - 1)]]


def judge(track: Track, flight: Flight) -> Judgement:
    """Holds an estimator's answers against a flight's truth."""
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
        error[other] = values[other] - renamed(truth.values, _seen_side(truth))
        disc = track.model == MODEL_DISC
        middle = truth.corners().mean(0)
        error[disc, :2] = values[disc, :2] - middle
        error[disc, 2:] = np.nan
    error[:, ORIENTATION] = fold(error[:, ORIENTATION])
    sigma[~np.isfinite(error)] = np.nan
    return Judgement(error, sigma, other)
