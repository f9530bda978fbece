"""Pseudo-linear Kalman filter on the bearing and the subtended angle: place and size of a disc.

With the measured unit vector g to the axis, n across it, and c the camera, a disc of width W at p obeys
  n'(p - c) = 0,   g'(p - c) - W / (2 sin(angle / 2)) = 0,
linear in (p, W) because the measured directions replace the true ones. That is the method's known flaw: the
coefficients contain the measurement noise, which biases the answer to second order.
"""

from __future__ import annotations

import numpy as np

from .kalman import update
from .points import Values
from .track import MIN_IMAGES, Silhouette, Track

TYPICAL_WIDTH = 6.0  # m, scales the rows' noise until the width is known
VAGUE = 1e4  # m, prior sigma of place and width
KNOWN = 0.3  # relative sigma from which the width counts as known


def bearing_angle(track: Track) -> Values:
    """Place of the axis and width; for a box, those of the disc that replaces it."""
    outline = Silhouette.of(track)
    if len(outline.rows) < MIN_IMAGES:
        return {}
    state, covariance = np.zeros(3), np.diag([VAGUE**2] * 3)
    for i, row in enumerate(outline.rows):
        sine = np.sin(0.5 * outline.angle[i])
        toward = np.array([np.sin(outline.bearing[i]), np.cos(outline.bearing[i])])
        across = np.array([toward[1], -toward[0]])
        rows = np.array([[*across, 0.0], [*toward, -0.5 / sine]])
        camera = np.array([track.dx[row], track.dz[row]])
        width = state[2] if state[2] > 0 and covariance[2, 2] < (KNOWN * state[2]) ** 2 else TYPICAL_WIDTH
        distance = 0.5 * width / sine
        by_angle = distance * np.sqrt(1.0 - sine**2) / (2.0 * sine)
        noise = np.diag([distance * outline.bearing_sigma, by_angle * outline.angle_sigma]) ** 2
        state, covariance = update(state, covariance, rows, rows[:, :2] @ camera - rows @ state, noise)
    sigmas = np.sqrt(np.diag(covariance))
    if state[2] <= 0 or state[1] <= track.dz[outline.rows[-1]] or sigmas[2] > 0.5 * state[2]:
        return {}
    names = ("x0_m", "z0_m", "width_m"), ("x0_sd_m", "z0_sd_m", "width_sd_m")
    return {**dict(zip(names[0], state.tolist())), **dict(zip(names[1], sigmas.tolist())), "box": 0.0}
