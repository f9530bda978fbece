"""The input of an estimator for one obstacle, image by image, and the truth."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..logs.obslog import Camera
from .noise import Noise

LEFT, RIGHT, TOP, BASE_LEFT, BASE_NEAR, BASE_RIGHT = range(6)
QUANTITIES = ("x0_m", "z0_m", "orientation_rad", "width_m", "length_m", "height_m")


@dataclass(frozen=True)
class Obstacle:
    """Truth, in T of the first image. Disc: (x0, z0) is the center, width and length are the diameter.
    Box: (x0, z0) is the middle of the front edge, and the orientation is that of the side edge from Z, clockwise."""

    kind: str  # box or disc
    x0_m: float
    z0_m: float
    orientation_rad: float
    width_m: float
    length_m: float
    height_m: float
    static: bool = True

    @property
    def values(self) -> np.ndarray:
        """(6,), in the order of ``QUANTITIES``."""
        return np.array([self.x0_m, self.z0_m, self.orientation_rad, self.width_m, self.length_m, self.height_m])

    def corners(self) -> np.ndarray:
        """Base corners (4, 2) as (X, Z): front left, back left, back right, front right; clockwise from above."""
        c, s = math.cos(self.orientation_rad), math.sin(self.orientation_rad)
        across, along = 0.5 * self.width_m * np.array([c, -s]), self.length_m * np.array([s, c])
        front = np.array([self.x0_m, self.z0_m])
        return np.array([front - across, front - across + along, front + across + along, front + across])


@dataclass
class Flight:
    """The input of an estimator for one obstacle, K images, and the truth.

    ``camera.heading_deg`` is always set: T is the same for everyone."""

    name: str
    group: str
    camera: Camera
    time_s: np.ndarray  # (K,)
    pixel_px: np.ndarray  # (K, 6, 2), 0 if not visible
    seen: np.ndarray  # (K, 6)
    position_ned_m: np.ndarray  # (K, 3) vehicle, estimated
    attitude: np.ndarray  # (K, 4) estimated
    height_m: np.ndarray  # (K,) camera above the ground, measured
    truth: Obstacle
    noise: Noise
    reach_s: float = math.nan  # from the first image until the obstacle's reference position is abeam
    top_is_highest: bool = False  # top: the roof's highest point in the image; otherwise the one nearest to the camera
    box_px: np.ndarray | None = None  # (K, 4) left, top, right, bottom; NaN if a side is not visible
    image_size_px: tuple[float, float] = (0.0, 0.0)  # width, height; 0: unknown

    @property
    def heading_rad(self) -> float:
        return math.radians(self.camera.heading_deg or 0.0)

    def first(self, images: int) -> Flight:
        """The first images of the flight."""
        names = ["time_s", "pixel_px", "seen", "position_ned_m", "attitude", "height_m"]
        names += [] if self.box_px is None else ["box_px"]
        return replace(self, **{name: getattr(self, name)[:images] for name in names})

    def path_m(self) -> float:
        """Length of the flown path over ground."""
        return float(np.linalg.norm(np.diff(self.position_ned_m[:, :2], axis=0), axis=1).sum())
