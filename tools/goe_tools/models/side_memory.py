"""The rows of an image, and the sides' correlated errors that they leave, as in the library.

A slope has the states' columns and, after them, those of the obstacle's velocity (``VX``, ``VZ``: m/s, axes of the
state). No filter step estimates a velocity: these columns show how the estimate depends on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .prism import AXIS, PX, PZ, STATES

COUNT = len(STATES)
VX, VZ = COUNT, COUNT + 1
COLUMNS = COUNT + 2


@dataclass
class Rows:
    """The n rows of an image; variances per row."""

    side: np.ndarray  # (n,)
    residual: np.ndarray
    slope: np.ndarray  # (n, 12)
    own: np.ndarray
    about: np.ndarray  # (n, 3) by unit errors of the image's attitude, which all rows share; the state's axes


def slopes_with_velocity(slope: np.ndarray, span_s: float) -> np.ndarray:
    """(n, 12) of slopes (n, 13) by the unknowns: an obstacle with a velocity has moved by that times ``span_s``, as if
    the camera had moved less."""
    return np.hstack([slope[:, :COUNT], -span_s * slope[:, [PX, PZ]]])


@dataclass
class Memory:
    """A side's correlated error, given the state and a velocity: value - by (x - state, velocity), focal lengths."""

    value: float
    by: np.ndarray  # (12,)
    variance: float
    measured: bool = False  # in an earlier image

    def predict(self, share: float, variance: float) -> None:
        if not self.measured:
            self.variance = variance
            return
        self.value *= share
        self.by = self.by * share
        self.variance = min(share**2 * self.variance + (1 - share**2) * variance, variance)

    def follow(self, change: np.ndarray) -> None:
        """After a change of the first states."""
        self.value -= self.by[: len(change)] @ change


def learn(memories: list[Memory], rows: Rows) -> None:
    """Of each side; the error of the attitude, which opposite sides share, is estimated and removed."""
    common, axis = rows.about @ rows.about.T, AXIS[rows.side]
    for i, side in enumerate(rows.side):
        memory, pair = memories[side], np.flatnonzero(axis == axis[i])
        share = common[i, pair] / rows.own[pair] / (1 + (common[pair, pair] / rows.own[pair]).sum())
        gain = memory.variance / rows.own[i] * ((pair == i) - share)
        memory.value += gain @ rows.residual[pair]
        memory.by = memory.by + gain @ rows.slope[pair]
        memory.variance -= gain[pair == i][0] * memory.variance
        memory.measured = True
