"""The Cramer-Rao bound of a mast observed by upright bounding boxes: the smallest one-sigma of any unbiased estimator.

The bound uses all images and the configured noise. With J the derivatives of all measured sides of a flight
at the truth, by the states of ``prism`` and by a constant error of the velocity over ground, N the covariance of all
sides, and p the prior sigmas (attitude, height, velocity),

    bound = (J' N^-1 J + diag(p^-2))^-1

    N = white noise of each side
      + s_i s_j exp(-|t_i - t_j|/tau)     for the same side in the images i and j, s = box_noise_rel * size of the box
      + attitude^2 J_b J_b' + position^2 J_p J_p'     white from image to image, common to the sides of an image

As in ``bound``, the random walk of the position and the drift of the attitude are left out, since they can only
make an estimator worse. Two margins of the library are left out as well: a white share of each side, and a yaw
error that represents the velocity error. Sides that the library does not use (``prism.measured_sides``) are not
used here.

Without roll a side may touch at foot and roof at once; the bound of the width, which assumes one of them, is then
too small, since no derivative exists."""

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
    D,
    E,
    ErrorModel,
    G,
    Q,
    Row,
    S,
    Sight,
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
    """(10,): state of a mast, without errors of attitude and height."""
    truth = flight.truth
    if truth.kind != "disc":
        raise ValueError(f"{flight.name}: the bound exists for discs only")
    state = np.zeros(len(STATES))
    state[[A, Q, W, E]] = np.array([truth.x0_m, 1.0, truth.width_m / 2, truth.height_m]) / truth.z0_m
    return state


def _rows(images: list[Sight], state: np.ndarray) -> list[tuple[Sight, Row]]:
    """The rows of all measured sides, linearized at the truth."""
    unknowns = np.append(state, np.zeros(UNKNOWNS - len(state)))
    result = []
    for sight in images:
        for side in np.flatnonzero(np.isfinite(sight.side)):
            row = row_of(sight, state, side, exact_side(sight, unknowns, side, sight.side[side]))
            if row is not None:
                result.append((sight, row))
    return result


def noise_of_rows(rows: list[tuple[Sight, Row]], state: np.ndarray, errors: ErrorModel) -> np.ndarray:
    """(n, n): covariance of all rows, focal lengths squared."""
    time_s = np.array([sight.time_s for sight, _ in rows])
    side = np.array([row.side for _, row in rows])
    slope = np.array([row.slope for _, row in rows])
    size = np.array([box_size(sight, state, row.side % 2) for sight, row in rows])
    cut = np.array([sight.cut for sight, _ in rows])
    between = np.abs(time_s[:, None] - time_s)
    correlation = (
        np.exp(-between / errors.box_correlation_time_s)
        if errors.box_correlation_time_s > 0
        else (between == 0).astype(float)
    )
    share = errors.box_noise_rel * size
    white = (errors.box_noise_px / focal_px(rows[0][0].camera)[side]) ** 2 + np.where(
        cut, errors.truncation_noise_rel * size, 0.0
    ) ** 2
    moved = np.radians(errors.attitude_white_sd_deg) ** 2 * slope[:, :3] @ slope[:, :3].T
    moved += errors.position_white_sd_m**2 * slope[:, PX:] @ slope[:, PX:].T
    same_side, same_image = side[:, None] == side, between == 0
    common = np.where(same_side, share[:, None] * share * correlation, 0.0)
    return np.diag(white) + common + np.where(same_image, moved, 0.0)


def prior_sigmas(state: np.ndarray, errors: ErrorModel) -> np.ndarray:
    """(12,): sigmas of the states and the velocity over ground; a mast is known to be as deep as it is wide, without
    shear."""
    sigma = np.full(COUNT, WEAK_SIGMA)
    sigma[:3] = max(np.radians(errors.attitude_bias_sd_deg), KNOWN_SIGMA)
    sigma[G] = max(errors.ground_sd(state[Q]), KNOWN_SIGMA)
    sigma[[S, D]] = KNOWN_SIGMA
    sigma[[VX, VZ]] = max(errors.velocity_bias_sd_m_s, KNOWN_SIGMA)
    return sigma


def bound_of(flight: Flight, errors: ErrorModel) -> np.ndarray:
    """(6,): sigmas from all images of a flight, in the order of the six quantities, m; NaN except for X0, Z0, W, H."""
    state = true_state(flight)
    rows = _rows(sights(flight, errors), state)
    if not rows:
        raise ValueError(f"{flight.name}: no side is measured")
    slope = np.zeros((len(rows), COUNT))
    for i, (sight, row) in enumerate(rows):
        slope[i, : len(STATES)] = row.slope[: len(STATES)]
        slope[i, [VX, VZ]] = -sight.time_s * row.slope[[PX, PX + 2]]  # the reported path is too long by this
    white = np.linalg.solve(np.linalg.cholesky(noise_of_rows(rows, state, errors)), slope)
    information = white.T @ white + np.diag(prior_sigmas(state, errors) ** -2)
    by = np.zeros((len(ORDER), COUNT))
    by[:, : len(STATES)] = quantity_slopes(state, np.eye(3))
    result = np.full(6, np.nan)
    result[ORDER] = np.sqrt(np.einsum("ij,jk,ik->i", by, inverse(information), by))
    return result
