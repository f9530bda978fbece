"""The Cramer-Rao bound of a mast seen by upright bounding boxes: no unbiased estimator can have a smaller one-sigma.

All images are used, with the noise that the user would state. With J the derivatives of all measured sides of a flight
at the truth, by the states of ``prism`` and by a constant error of the velocity over ground, N the covariance of all
sides, and p the sigmas of what is known beforehand (attitude, height, velocity),

    bound = (J' N^-1 J + diag(p^-2))^-1

    N = white noise of each side
      + s_i s_j exp(-|t_i - t_j|/tau)     of the same side in the images i and j, s = box_share * size of the box
      + attitude^2 J_b J_b' + position^2 J_p J_p'     new in each image, alike for its sides

As in ``bound``, what the position wanders by beyond a constant velocity error and the drift of the attitude are left
out: with them no estimator can do better than without. Left out, too, is what the library reckons with for its own
sake: a white share of each side, and a yaw error that stands for that of the velocity. Sides that the library would not
use (``prism.measured_sides``) are not used.

Without any roll a side may touch at foot and roof at once; there the width's bound, which takes one of them, is too
small, as no derivative exists."""

from __future__ import annotations

import numpy as np

from ..flights.flight import Flight
from .bound import inverse
from .model import KNOWN_SIGMA, WEAK_SIGMA
from .prism import (
    PX,
    STATES,
    UNKNOWNS,
    A,
    C,
    E,
    G,
    Q,
    Row,
    S,
    Sight,
    Told,
    W,
    box_size,
    exact_side,
    focal_px,
    quantity_slopes,
    row_of,
    sights,
)

VX, VZ = len(STATES), len(STATES) + 1
COUNT = len(STATES) + 2
ORDER = [0, 1, 3, 5]  # X0, Z0, W, H among the six quantities


def true_state(flight: Flight) -> np.ndarray:
    """(10,): of a mast, without errors of attitude and height."""
    truth = flight.truth
    if truth.kind != "disc":
        raise ValueError(f"{flight.name}: the bound is that of a disc")
    state = np.zeros(len(STATES))
    state[[A, Q, W, E]] = np.array([truth.x0_m, 1.0, truth.width_m / 2, truth.height_m]) / truth.z0_m
    return state


def _rows(images: list[Sight], state: np.ndarray) -> list[tuple[Sight, Row]]:
    """Of all measured sides, linearised at the truth."""
    unknowns = np.append(state, np.zeros(UNKNOWNS - len(state)))
    result = []
    for sight in images:
        for side in np.flatnonzero(np.isfinite(sight.side)):
            row = row_of(sight, state, side, exact_side(sight, unknowns, side, sight.side[side]))
            if row is not None:
                result.append((sight, row))
    return result


def noise_of_rows(rows: list[tuple[Sight, Row]], state: np.ndarray, told: Told) -> np.ndarray:
    """(n, n): covariance of all rows, focal lengths squared."""
    time_s = np.array([sight.time_s for sight, _ in rows])
    side = np.array([row.side for _, row in rows])
    slope = np.array([row.slope for _, row in rows])
    size = np.array([box_size(sight, state, row.side % 2) for sight, row in rows])
    cut = np.array([sight.cut for sight, _ in rows])
    between = np.abs(time_s[:, None] - time_s)
    alike = np.exp(-between / told.correlation_s) if told.correlation_s > 0 else (between == 0).astype(float)
    share = told.box_share * size
    white = (told.box_px / focal_px(rows[0][0].camera)[side]) ** 2 + np.where(cut, told.cut_noise * size, 0.0) ** 2
    moved = np.radians(told.attitude_white_deg) ** 2 * slope[:, :3] @ slope[:, :3].T
    moved += told.position_white_m**2 * slope[:, PX:] @ slope[:, PX:].T
    same_side, same_image = side[:, None] == side, between == 0
    return np.diag(white) + np.where(same_side, share[:, None] * share * alike, 0.0) + np.where(same_image, moved, 0.0)


def prior_sigmas(state: np.ndarray, told: Told) -> np.ndarray:
    """(12,): of the states and the velocity over ground; a disc is as deep as it is wide."""
    sigma = np.full(COUNT, WEAK_SIGMA)
    sigma[:3] = max(np.radians(told.attitude_bias_deg), KNOWN_SIGMA)
    sigma[G] = max(told.height_sd_m * state[Q], KNOWN_SIGMA)
    sigma[[S, C]] = KNOWN_SIGMA
    sigma[[VX, VZ]] = max(told.velocity_bias_m_s, KNOWN_SIGMA)
    return sigma


def bound_of(flight: Flight, told: Told) -> np.ndarray:
    """(6,): one sigma with all images of a flight, in the order of the six quantities, m; NaN but for X0, Z0, W, H."""
    state = true_state(flight)
    rows = _rows(sights(flight, told), state)
    if not rows:
        raise ValueError(f"{flight.name}: no side is measured")
    slope = np.zeros((len(rows), COUNT))
    for i, (sight, row) in enumerate(rows):
        slope[i, : len(STATES)] = row.slope[: len(STATES)]
        slope[i, [VX, VZ]] = -sight.time_s * row.slope[[PX, PX + 2]]  # the path told is too long by velocity times time
    white = np.linalg.solve(np.linalg.cholesky(noise_of_rows(rows, state, told)), slope)
    information = white.T @ white + np.diag(prior_sigmas(state, told) ** -2)
    by = np.zeros((len(ORDER), COUNT))
    by[:, : len(STATES)] = quantity_slopes(state, np.eye(3))
    result = np.full(6, np.nan)
    result[ORDER] = np.sqrt(np.einsum("ij,jk,ik->i", by, inverse(information), by))
    return result
