"""The rows of silhouette points and base corners about the truth; without it, points do not determine the shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..flights.flight import TOP, Flight
from ..flights.noise import Noise
from ..models.model import (
    DH,
    VX,
    VZ,
    correspond,
    covariances,
    jacobian,
    residuals,
    row_mask,
    true_state,
    view_of,
)
from .rows import Effect, Rows

LEAST_IMAGES = 8
SILHOUETTE_ROWS = 3  # left, right, top
DEG = np.pi / 180.0


def _top_of(flight: Flight) -> Flight:
    """Decides the meaning of the log's ``top``: the one that agrees better with the truth."""
    errors = {}
    for highest in (False, True):
        view, state = view_of(replace(flight, top_is_highest=highest)), true_state(flight)
        rows = residuals(view, correspond(view, state), state)[view.seen[:, TOP], 2]
        errors[highest] = float(np.abs(rows).sum())
    return replace(flight, top_is_highest=errors[True] < errors[False])


def point_rows(flight: Flight) -> Rows | None:
    """None: too few images."""
    flight = _top_of(flight)
    view, state = view_of(flight), true_state(flight)
    corners = correspond(view, state)
    used = row_mask(corners.usable)
    left, slopes = residuals(view, corners, state), jacobian(view, corners, state)
    used &= np.isfinite(left) & np.isfinite(slopes).all(-1)
    if used.any(1).sum() < LEAST_IMAGES:
        return None
    own = np.sqrt(np.einsum("kii->ki", covariances(view, slopes, state, Noise(pixel_px=1.0))))
    width = np.where(np.arange(used.shape[1]) < SILHOUETTE_ROWS, view.width[:, None], 0.0)
    image = np.repeat(np.arange(len(used)), used.shape[1])[used.ravel()]
    time_s, slope = view.time_s[image], slopes[used]
    same = (image[:, None] == image).astype(float)
    passed = np.minimum(time_s[:, None], time_s)
    since = np.where(time_s > 0.0, time_s, 1.0)[:, None]  # no random walk yet at the start
    turn = DEG * slope[:, :3]
    effects = {
        "detector.point_noise_px": Effect(own[used][:, None], np.eye(len(image))),
        "detector.point_noise_rel": Effect(width[used][:, None], np.eye(len(image))),
        "navigation.attitude_white_sd_deg": Effect(turn, same),
        "navigation.attitude_walk_sd_deg": Effect(turn, passed),
        "navigation.attitude_bias_sd_deg": Effect(turn),
        "navigation.velocity_bias_sd_m_s": Effect(slope[:, [VX, VZ]]),
        "navigation.position_walk_sd_m": Effect(slope[:, [VX, VZ]] / since, passed),
        "navigation.height_bias_sd_m": Effect(slope[:, [DH]]),
    }
    return Rows(flight.name, time_s, image, left[used], np.zeros((len(image), 0)), effects, {})
