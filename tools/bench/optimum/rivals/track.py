"""Input of a rival: aligned image points of one obstacle, and camera positions.

Axes T: X right, Y down, Z forward, level; origin at the camera of the track's first image, but Y = 0 on the ground.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from goe_tools.flights.flight import BASE_LEFT, BASE_NEAR, BASE_RIGHT, LEFT, RIGHT, TOP, Flight
from goe_tools.flights.noise import Noise
from goe_tools.models.model import view_of

MIN_IMAGES = 5  # least number for an answer: two suffice without noise, but do not reveal outliers
LEAST_ANGLE = 1e-5  # rad, a narrower obstacle has no size
HUBER = 2.5  # sigmas beyond which residuals count linearly, for every rival: a gate would lock a biased filter out


@dataclass
class Track:
    """K images of one obstacle, with the pose already applied (the rivals take it as exact, as their authors do).

    time (K,)      s
    points (K,6,2) aligned points x/z, y/z in T's axes, in focal lengths
    seen (K,6)     whether the point is used
    dx, dz (K,)    m, camera displacement since the first image, T
    h (K,)         m, camera height over the ground
    sigma          focal lengths, noise of an image point
    attitude       rad, white noise of the attitude: common to all points of an image, so it does not affect sizes
    """

    time: np.ndarray
    points: np.ndarray
    seen: np.ndarray
    dx: np.ndarray
    dz: np.ndarray
    h: np.ndarray
    sigma: float
    attitude: float = 0.0

    @classmethod
    def of_flight(cls, flight: Flight, noise: Noise | None = None) -> Track:
        """Converts a flight for the rivals; their configured noise is the flight's unless another is given."""
        noise, view = noise or flight.noise, view_of(flight)
        rays = np.concatenate([view.point, np.ones((*view.point.shape[:2], 1))], -1)
        rays = np.einsum("kij,knj->kni", view.t_from_body @ view.body_from_camera, rays)
        depth = np.where(view.seen, rays[..., 2], 1.0)[..., None]
        points = np.where(view.seen[..., None], rays[..., :2] / depth, 0.0)
        sigma = noise.sigma_px / math.sqrt(flight.camera.fx * flight.camera.fy)
        attitude = math.radians(noise.attitude_white_sd_deg)
        return cls(view.time_s, points, view.seen, view.dx_m, view.dz_m, view.height_m, sigma, attitude)

    def __len__(self) -> int:
        return len(self.time)

    def until(self, count: int) -> Track:
        """The first ``count`` images."""
        arrays = {name: getattr(self, name)[:count] for name in ("time", "points", "seen", "dx", "dz", "h")}
        return replace(self, **arrays)

    def mirrored(self) -> Track:
        """The same flight with right and left swapped."""
        order = [RIGHT, LEFT, TOP, BASE_RIGHT, BASE_NEAR, BASE_LEFT]
        return replace(self, points=self.points[:, order] * [-1.0, 1.0], seen=self.seen[:, order], dx=-self.dx)

    @property
    def point_sigma(self) -> float:
        """rad, of the direction to a point."""
        return math.hypot(self.sigma, self.attitude)

    def cameras(self) -> np.ndarray:
        """(K,3) m, camera positions in T, Y = 0 on the ground."""
        return np.stack([self.dx, -self.h, self.dz], 1)


@dataclass
class Silhouette:
    """Bearing and subtended angle of the obstacle's left and right outline, in images with both.

    For an upright cylinder both are exact: the bisector of the tangents passes through the axis, and
    distance = width / (2 sin(half the angle)).
    rows (n,) image numbers; bearing (n,) rad from Z, positive to the right; angle (n,) rad; their one-sigmas, rad
    """

    rows: np.ndarray
    bearing: np.ndarray
    angle: np.ndarray
    bearing_sigma: float
    angle_sigma: float

    @classmethod
    def of(cls, track: Track) -> Silhouette:
        azimuth = np.arctan(track.points[:, [LEFT, RIGHT], 0])
        angle = azimuth[:, 1] - azimuth[:, 0]
        rows = np.flatnonzero(track.seen[:, LEFT] & track.seen[:, RIGHT] & (angle > LEAST_ANGLE))
        bearing_sigma = math.hypot(track.sigma / math.sqrt(2.0), track.attitude)
        return cls(rows, azimuth[rows].mean(1), angle[rows], bearing_sigma, math.sqrt(2.0) * track.sigma)

    @property
    def inverse_distance(self) -> np.ndarray:
        """(n,) width of the obstacle over its distance: 2 sin(angle / 2)."""
        return 2.0 * np.sin(0.5 * self.angle)
