"""Maximum likelihood fit of all images of a flight at once, in float64: a reference optimum for recursive estimators
of fixed memory.

It uses the model and noise of the bound, so it estimates the constant errors of attitude, height and velocity together
with the obstacle. It leaves out points that disagree with the other points of their image or with the fit.

    python -m goe_tools offline DIR
"""

from __future__ import annotations

import argparse
import importlib.util
from dataclasses import dataclass

import numpy as np

from ..flights.flight import Flight
from ..flights.noise import Noise
from ..flights.rotations import fold
from .bound import add_arguments as add_arguments  # shared by both commands
from .bound import inverse, noise_of, print_flights, print_row, printable, shown
from .model import (
    DH,
    FX,
    NUISANCES,
    ROW_FEATURE,
    SX,
    SZ,
    VX,
    VZ,
    Corners,
    View,
    correspond,
    covariances,
    jacobian,
    masked,
    prior_sigmas,
    quantities,
    quantity_slopes,
    residuals,
    row_mask,
    true_state,
    view_of,
    whitened,
)

OUTLIER_SIGMA = 4.5
ROUNDS = 2  # rounds of outlier detection and fit
OUTLIERS_PER_IMAGE = 3
MAX_STEPS = 40
WEAK_SIZE = 5.0  # prior sigma of the size about the start: bounds the length if one face is visible
LOST_COST = 1e6  # cost of a step to a box without depth


@dataclass
class Fit:
    """x0, z0, orientation (rad), width, length, height with sigmas and covariance, the state and the used features."""

    values: np.ndarray
    sigma: np.ndarray
    covariance: np.ndarray
    state: np.ndarray
    used: np.ndarray  # (K, 6)
    cost: float  # sum of the squared whitened residuals over the number of rows; about 1


MISSING = "the offline fit needs scipy, which is not installed"


def available() -> bool:
    """Whether the solver is installed."""
    return importlib.util.find_spec("scipy") is not None


def without_outliers(view: View, corners: Corners, state: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(K, 6): usable features that agree with the others of their image. Each row is compared with its prediction from
    all other rows; an attitude error, which moves all points, then rejects none."""
    use = corners.usable.copy()
    measured = residuals(view, corners, state)
    for _ in range(OUTLIERS_PER_IMAGE):
        rows = row_mask(use)
        weight = np.linalg.inv(masked(matrix, rows))
        value = np.einsum("kij,kj->ki", weight, np.where(rows, measured, 0.0))
        score = np.abs(value) / np.sqrt(np.einsum("kii->ki", weight)) * rows
        worst = np.argmax(score, 1)
        bad = np.flatnonzero(score[np.arange(len(worst)), worst] > OUTLIER_SIGMA)
        if not len(bad):
            break
        use[bad, ROW_FEATURE[worst[bad]]] = False
    return use


def _solve(view: View, corners: Corners, start: np.ndarray, noise: Noise, use: np.ndarray) -> np.ndarray:
    """The fit from a start, with fixed correspondences, weights and features."""
    from scipy.optimize import least_squares  # imported here: nothing else in the package needs scipy

    rows, sigma = row_mask(use), prior_sigmas(noise, view.box)
    slopes = jacobian(view, corners, start)
    matrix = covariances(view, slopes, start, noise)
    sigma[[SX, FX, SZ]] = WEAK_SIZE * np.max(np.abs(start[[SX, FX, SZ]]))
    fixed = np.append(NUISANCES, [SX, FX, SZ])
    prior = np.zeros((len(fixed), len(sigma)))
    prior[range(len(fixed)), fixed] = 1 / sigma[fixed]
    middle = np.where(np.isin(np.arange(len(sigma)), NUISANCES), 0.0, start)
    white = whitened(matrix, rows, slopes)
    scale = 1 / np.sqrt((white * white).sum(0) + sigma**-2.0)

    def cost(step: np.ndarray) -> np.ndarray:
        state = start + step * scale
        values = whitened(matrix, rows, np.nan_to_num(residuals(view, corners, state), nan=LOST_COST))
        return np.concatenate([values, -prior @ (state - middle)])

    def slope(step: np.ndarray) -> np.ndarray:
        white = whitened(matrix, rows, np.nan_to_num(jacobian(view, corners, start + step * scale)))
        return np.concatenate([-white, -prior]) * scale

    solution = least_squares(cost, np.zeros(len(sigma)), slope, method="trf", max_nfev=MAX_STEPS)
    return start + solution.x * scale


def fit(flight: Flight, noise: Noise | None = None, start: np.ndarray | None = None) -> Fit:
    """Fits a flight. ``start``: states of ``model``, by default the truth, so that the fit finds the optimum next to
    the truth and no other."""
    noise = flight.noise if noise is None else noise
    view = view_of(flight)
    state = true_state(flight) if start is None else np.array(start, float)
    sigma = prior_sigmas(noise, view.box)
    unknown = np.isin(np.arange(len(sigma)), NUISANCES)
    for number in range(ROUNDS):
        corners = correspond(view, state)
        slopes = jacobian(view, corners, state)
        matrix = covariances(view, slopes, state, noise)
        judged = matrix
        if number == 0:  # the nuisances are not known yet
            blurred = slopes[..., unknown] * sigma[unknown]
            judged = matrix + blurred @ np.swapaxes(blurred, -1, -2)
        use = without_outliers(view, corners, state, judged)
        state = _solve(view, corners, state, noise, use)
    return _fit_result(view, state, noise, use)


def _fit_result(view: View, state: np.ndarray, noise: Noise, use: np.ndarray) -> Fit:
    corners = correspond(view, state)
    use = use & corners.usable
    rows = row_mask(use)
    slopes = jacobian(view, corners, state)
    matrix = covariances(view, slopes, state, noise)
    white = whitened(matrix, rows, slopes)
    left = whitened(matrix, rows, residuals(view, corners, state))
    inner = inverse(white.T @ white + np.diag(prior_sigmas(noise, view.box) ** -2))
    outer = quantity_slopes(state, view.box)
    covariance = outer @ inner @ outer.T
    sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return Fit(quantities(state, view.box), sigma, covariance, state, use, float(left @ left / max(rows.sum(), 1)))


# -------------------------------------------------------------------------------------------------------------- shell


def run(arguments: argparse.Namespace) -> int:
    noise = noise_of(arguments)
    if not available():
        raise ValueError(MISSING)
    for flight in print_flights(arguments):
        result, show = fit(flight, noise), shown(flight)
        error = result.values - flight.truth.values
        error[2] = fold(error[2])
        print_row("fit", printable(result.values), show)
        print_row("its one sigma", printable(result.sigma), show)
        print_row("error / one sigma", error / np.maximum(result.sigma, 1e-12), show)
        nuisances = np.degrees(result.state[:3])
        dh, vx, vz = result.state[[DH, VX, VZ]]
        print(
            f"attitude error {nuisances[0]:.3f} {nuisances[1]:.3f} {nuisances[2]:.3f} deg, height error {dh:.3f} m, "
            f"velocity error {vx:.3f} {vz:.3f} m/s; {int(result.used.sum())} of {int(flight.seen.sum())} points used; "
            f"squared residual over variance {result.cost:.2f}"
        )
    return 0
