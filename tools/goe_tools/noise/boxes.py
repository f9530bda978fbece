"""The rows of upright bounding boxes: four sides in each image, about the prism that fits them all.

The unknowns of the prism are place, width, height, shear and depth. With the truth, place and height are known; the
residuals then also contain errors that are constant over all images. Images with a box cut by the image border are left
out."""

from __future__ import annotations

import numpy as np

from ..flights.flight import Flight
from ..models.prism import PX, STATES, A, D, E, ErrorModel, G, Q, S, W, box_size, focal_px
from ..models.prism_offline import Track
from .rows import Effect, Fading, Rows

LEAST_IMAGES = 8
UNKNOWN, UNKNOWN_WITH_TRUTH = [A, Q, W, E, S, D], [W, S, D]
MOST_STEPS = 60
SETTLED = 1e-3  # sigmas
WHITE, SHARE = 1e-3, 0.05  # weights of the sides: focal lengths, and share of the box
DEEPEST = 2.0  # largest absolute values of D, and of S in half widths
DEG = np.pi / 180.0


def _is_plausible(state: np.ndarray) -> bool:
    return abs(state[D]) <= DEEPEST and abs(state[S]) <= DEEPEST * state[W]


def _settled(track: Track, state: np.ndarray, free: list[int], size: np.ndarray) -> np.ndarray:
    """Fits the free components of the state to the sides, each weighted by its box: Levenberg-Marquardt."""
    weight = 1.0 / np.hypot(WHITE, SHARE * size)
    found, damping = track.predicted(state), 1e-2
    if found is None:
        raise ValueError("the start is not an obstacle ahead of the camera")
    for _ in range(MOST_STEPS):
        left, slope = weight * (track.measured - found[0]), weight[:, None] * found[1][:, free]
        scale = np.maximum(np.linalg.norm(slope, axis=0), 1e-12)
        by = slope / scale
        step = np.linalg.solve(by.T @ by + damping * np.eye(len(free)), by.T @ left) / scale
        tried = state.copy()
        tried[free] += step
        better = track.predicted(tried) if _is_plausible(tried) else None
        if better is not None and np.sum((weight * (track.measured - better[0])) ** 2) < left @ left:
            state, found, damping = tried, better, max(0.2 * damping, 1e-9)
            if np.abs(step * scale).max() < SETTLED:
                break
        else:
            damping *= 10.0
            if damping > 1e9:
                break
    return state


def _true_state(track: Track, flight: Flight) -> np.ndarray:
    """(12,) in the track's axes: place, height and approximate width of the truth."""
    truth = flight.truth
    x, _, z = track.turn @ (np.array([truth.x0_m, 0.0, truth.z0_m]) - track.origin_m)
    if not z > 1.0:
        raise ValueError("the truth does not lie ahead")
    state = np.zeros(len(STATES) + 2)
    state[[A, Q, W, E]] = np.array([x, 1.0, 0.5 * truth.width_m, truth.height_m]) / z
    return state


def box_rows(flight: Flight, errors: ErrorModel, with_truth: bool) -> Rows | None:
    """None: too few images, or no prism fits them."""
    try:
        track = Track(flight, errors)
        unknown = UNKNOWN_WITH_TRUTH if with_truth else UNKNOWN
        start = _true_state(track, flight) if with_truth else track.start()
        ahead = np.maximum(1.0 - track.moved_m[:, 2] * start[Q], 0.05)
        state = _settled(track, start, unknown, 2.0 * start[W] / ahead)
        found = track.predicted(state)
    except (ValueError, np.linalg.LinAlgError):
        return None
    if found is None:
        return None
    at, slope = found
    uncut = np.array([not sight.cut for sight in track.sight])
    if len(np.unique(track.since_s[uncut])) < LEAST_IMAGES:
        return None
    time_s, side = track.since_s, track.side
    size = np.array([box_size(sight, state[: len(STATES)], i % 2) for sight, i in zip(track.sight, side)])
    same = (time_s[:, None] == time_s).astype(float)
    passed = np.minimum(time_s[:, None], time_s)
    turn, place = DEG * slope[:, :3], slope[:, PX:]
    own = 1.0 / focal_px(flight.camera)[side]
    effects = {
        "detector.box_noise_px": Effect(own[:, None], np.eye(len(own))),
        "navigation.attitude_white_sd_deg": Effect(turn, same),
        "navigation.attitude_walk_sd_deg": Effect(turn, passed),
        "navigation.attitude_bias_sd_deg": Effect(turn),
        "navigation.velocity_bias_sd_m_s": Effect(-time_s[:, None] * slope[:, [PX, PX + 2]]),
        "navigation.position_walk_sd_m": Effect(place, passed),
        "navigation.position_white_sd_m": Effect(place, same),
        "navigation.height_bias_sd_m": Effect(slope[:, [G]] * state[Q]),
    }
    fading = {"detector.box_noise_rel": Fading("detector.box_correlation_time_s", size, side)}
    image = np.unique(time_s, return_inverse=True)[1]
    return Rows(flight.name, time_s, image, track.measured - at, slope[:, unknown], effects, fading).only(uncut)
