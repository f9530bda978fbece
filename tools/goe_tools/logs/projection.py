"""Projects a point into the image of a flying camera, with lens distortion.

Frames as in ``obslog``: NED earth, FRD body, camera x right, y down, z forward.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .obslog import Camera, Pixel

MIN_DEPTH_FRACTION = 0.05  # of the ray's length; a point with less is out of view
LENS_SAMPLES = 33
LENS_SLOPE_MIN = 0.2  # of d(distorted radius)/d(radius); below this the lens model is outside its valid field
CAMERA_AXES_IN_BODY = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # unmounted: z forward


def rotation(axis: int, angle_rad: float) -> np.ndarray:
    """Right-handed rotation by an angle about axis 0, 1 or 2; 3 x 3."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    result = np.eye(3)
    result[i, i] = result[j, j] = c
    result[i, j], result[j, i] = -s, s
    return result


def yaw_pitch_roll(yaw_deg: float, pitch_deg: float, roll_deg: float) -> np.ndarray:
    """Z-Y'-X'' rotation matrix; 3 x 3."""
    return (
        rotation(2, math.radians(yaw_deg)) @ rotation(1, math.radians(pitch_deg)) @ rotation(0, math.radians(roll_deg))
    )


def quaternion_of(matrix: np.ndarray) -> tuple[float, float, float, float]:
    """The unit quaternion (w, x, y, z), w >= 0, of a rotation matrix (largest-component method)."""
    m = matrix
    squares = np.array(
        [
            1.0 + m[0, 0] + m[1, 1] + m[2, 2],
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
        ]
    )
    products = {
        (0, 1): m[2, 1] - m[1, 2],
        (0, 2): m[0, 2] - m[2, 0],
        (0, 3): m[1, 0] - m[0, 1],
        (1, 2): m[0, 1] + m[1, 0],
        (1, 3): m[0, 2] + m[2, 0],
        (2, 3): m[1, 2] + m[2, 1],
    }
    big = int(np.argmax(squares))
    scale = 2.0 * math.sqrt(squares[big])
    q = np.array([scale / 4.0 if i == big else products[tuple(sorted((i, big)))] / scale for i in range(4)])
    if q[0] < 0.0:
        q = -q
    q /= np.linalg.norm(q)
    return tuple(float(value) for value in q)  # type: ignore[return-value]


def distort(camera: Camera, x: float, y: float) -> tuple[float, float]:
    """Brown-Conrady distortion of a normalized image point, coefficients in OpenCV's order."""
    r2 = x * x + y * y
    radial = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3))
    return (
        x * radial + 2.0 * camera.p1 * x * y + camera.p2 * (r2 + 2.0 * x * x),
        y * radial + camera.p1 * (r2 + 2.0 * y * y) + 2.0 * camera.p2 * x * y,
    )


def lens_bends_back(camera: Camera, x: float, y: float) -> bool:
    """Whether the lens model has turned around before this point; then a farther ray would meet the same pixel."""
    r2 = np.linspace(0.0, x * x + y * y, LENS_SAMPLES)
    return bool(np.any(1.0 + r2 * (3.0 * camera.k1 + r2 * (5.0 * camera.k2 + 7.0 * r2 * camera.k3)) <= LENS_SLOPE_MIN))


@dataclass
class Pose:
    """Vehicle and camera at one time. ``ned_from_camera`` turns camera axes into NED."""

    vehicle_ned_m: np.ndarray
    ned_from_body: np.ndarray
    camera_ned_m: np.ndarray
    ned_from_camera: np.ndarray


def project(camera: Camera, pose: Pose, point_ned_m: np.ndarray, clip: bool = False) -> Pixel | None:
    """The pixel of a point in NED; None if it lies behind the image plane, outside the lens model's valid field
    or, with clip, outside the image."""
    ray = pose.ned_from_camera.T @ (np.asarray(point_ned_m) - pose.camera_ned_m)
    if ray[2] <= MIN_DEPTH_FRACTION * np.linalg.norm(ray):
        return None
    x, y = ray[0] / ray[2], ray[1] / ray[2]
    if lens_bends_back(camera, x, y):
        return None
    x, y = distort(camera, x, y)
    u, v = camera.fx * x + camera.cx, camera.fy * y + camera.cy
    if clip and not (0.0 <= u <= camera.width and 0.0 <= v <= camera.height):
        return None
    return float(u), float(v)
