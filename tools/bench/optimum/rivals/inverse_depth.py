"""Extended Kalman filter with an inverse-depth point: anchor, azimuth, elevation, inverse distance from the anchor.

The parametrization of Civera, Davison and Montiel (IEEE Transactions on Robotics 24, 2008). Poses are given, so points
are independent and each is a filter of three states; the anchor is the camera of the first image.
  v = inverse (anchor - camera) + m(azimuth, elevation),  measured: atan2(vx, vz), atan2(vy, |vx, vz|)
"""

from __future__ import annotations

import numpy as np

from .kalman import update
from .points import Located, Values, estimate
from .track import MIN_IMAGES, Track

NEAREST = 30.0  # m, the prior's two-sigma interval is from here to infinity, for obstacles viewed from the air
WORST = 0.25  # relative sigma of the inverse distance above which there is no answer


def inverse_depth(track: Track) -> Values:
    """Filters every corner (or the cylinder's axis) separately, image by image."""
    return estimate(track, locate) if len(track) >= MIN_IMAGES else {}


def angles(rays: np.ndarray) -> np.ndarray:
    """Azimuth and elevation (downwards) of aligned points (..., 2), rad."""
    return np.stack([np.arctan(rays[..., 0]), np.arctan(rays[..., 1] / np.hypot(rays[..., 0], 1.0))], -1)


def direction(azimuth: float, elevation: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit vector (3,) of the angles and its derivatives (3,2)."""
    sa, ca, se, ce = np.sin(azimuth), np.cos(azimuth), np.sin(elevation), np.cos(elevation)
    return np.array([sa * ce, se, ca * ce]), np.array([[ca * ce, -sa * se], [0.0, ce], [-sa * ce, -ca * se]])


def predict(state: np.ndarray, offset: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angles from a camera at anchor - offset, and their derivatives (2,3) by the state."""
    unit, turned = direction(state[0], state[1])
    x, y, z = state[2] * offset + unit
    level2 = x * x + z * z
    level, n2 = np.sqrt(level2), level2 + y * y
    by_vector = np.array([[z / level2, 0.0, -x / level2], [-x * y / (n2 * level), level / n2, -y * z / (n2 * level)]])
    return np.array([np.arctan2(x, z), np.arctan2(y, level)]), by_vector @ np.column_stack([turned, offset])


def locate(rays: np.ndarray, cameras: np.ndarray, sigma: float) -> Located:
    """Runs the filter over the images; None while the distance is unknown."""
    measured = angles(rays)
    inverse = 0.5 / NEAREST
    state = np.array([*measured[0], inverse])
    covariance = np.diag([(sigma / np.cos(state[1])) ** 2, sigma**2, (0.5 * inverse) ** 2])
    for angle, camera in zip(measured[1:], cameras[1:]):
        passed = direction(*angle)[0] @ (state[2] * (cameras[0] - camera) + direction(*state[:2])[0]) <= 0
        if passed:  # the camera has passed the point, according to the filter: an angle behind cannot be compared
            continue
        expected, gradient = predict(state, cameras[0] - camera)
        noise = np.diag([(sigma / np.cos(angle[1])) ** 2, sigma**2])
        state, covariance = update(state, covariance, gradient, angle - expected, noise)
    if state[2] <= 0 or covariance[2, 2] > (WORST * state[2]) ** 2:
        return None
    unit, turned = direction(state[0], state[1])
    jacobian = np.column_stack([turned / state[2], -unit / state[2] ** 2])
    return cameras[0] + unit / state[2], jacobian @ covariance @ jacobian.T
