"""Straight-line fit of the inverse apparent size against the distance travelled (Atherton et al., BMVC 1991).

For a disc the depth over the width is cos(bearing) / (2 sin(angle / 2)) = Z0/W - dZ/W: a straight line in the forward
distance, on any path. Its slope is 1/W, its zero is Z0; X0 is the mean over the bearings.
"""

from __future__ import annotations

import numpy as np

from .points import Values
from .track import HUBER, MIN_IMAGES, Silhouette, Track

ROUNDS = 5  # of the weights
WORST = 0.5  # relative sigma of the slope above which there is no answer
WORST_CONDITION = 1e15


def inverse_size(track: Track) -> Values:
    """Place of the axis and width; for a box, those of the disc that replaces it."""
    outline = Silhouette.of(track)
    if len(outline.rows) < MIN_IMAGES:
        return {}
    dx, dz = track.dx[outline.rows], track.dz[outline.rows]
    depth = np.cos(outline.bearing) / outline.inverse_distance  # in widths
    line = fit_line(dz, depth, outline.angle_sigma / np.cos(outline.bearing))
    if line is None:
        return {}
    (start, slope), covariance = line
    if slope <= 0 or covariance[1, 1] > (WORST * slope) ** 2:
        return {}
    width, z0 = 1.0 / slope, start / slope
    remaining = z0 - dz
    if remaining[-1] <= 0:
        return {}
    side, weight = np.tan(outline.bearing), remaining**-2.0
    x0 = np.average(dx + remaining * side, weights=weight)
    by_line = np.array([1.0, -z0]) / slope
    z0_sd = np.sqrt(by_line @ covariance @ by_line)
    x0_sd = np.hypot(np.average(side, weights=weight) * z0_sd, outline.bearing_sigma / np.sqrt(weight.sum()))
    return {
        "x0_m": float(x0),
        "z0_m": float(z0),
        "width_m": float(width),
        "x0_sd_m": float(x0_sd),
        "z0_sd_m": float(z0_sd),
        "width_sd_m": float(width**2 * np.sqrt(covariance[1, 1])),
        "box": 0.0,
    }


def fit_line(travelled: np.ndarray, depth: np.ndarray, sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """depth = start - slope travelled: (start, slope) and covariance (2,2); sigma (n,) of an inverse depth.

    The noise of an inverse size grows with its square. It is computed first from the measured size, then from the line:
    weights that depend on the noisy values themselves would bias the line downwards.
    """
    if np.ptp(travelled) <= 0:
        return None
    modelled, weight = depth, np.ones_like(depth)
    for _ in range(ROUNDS):
        noise = sigma * modelled**2
        table = np.stack([np.ones_like(travelled), -travelled], 1) * (np.sqrt(weight) / noise)[:, None]
        information = table.T @ table
        if not np.linalg.cond(information) < WORST_CONDITION:
            return None
        covariance = np.linalg.inv(information)
        line = covariance @ (table.T @ (depth * np.sqrt(weight) / noise))
        modelled = line[0] - line[1] * travelled
        if (modelled <= 0).any():
            return None
        weight = np.minimum(1.0, HUBER / (np.abs(depth - modelled) / (sigma * modelled**2) + 1e-12))
    return line, covariance
