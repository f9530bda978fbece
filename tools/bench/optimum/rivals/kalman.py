"""The update shared by both Kalman filters."""

from __future__ import annotations

import numpy as np

from .track import HUBER


def update(
    state: np.ndarray, covariance: np.ndarray, rows: np.ndarray, innovation: np.ndarray, noise: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """One update, Joseph form; adds noise to an unlikely image (Huber's weight) instead of rejecting it."""
    spread = rows @ covariance @ rows.T + noise
    excess = np.sqrt(innovation @ np.linalg.solve(spread, innovation)) / HUBER
    if excess > 1:
        noise = noise * excess
        spread = rows @ covariance @ rows.T + noise
    gain = np.linalg.solve(spread, rows @ covariance).T
    keep = np.eye(len(state)) - gain @ rows
    return state + gain @ innovation, keep @ covariance @ keep.T + gain @ noise @ gain.T
