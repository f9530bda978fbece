"""Attitude, lens and the angles of undirected lines, in float64."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from goe_tools.logs.obslog import Camera

from ..gates import Gates

FORWARD_MIN = 0.05
RAY_LIMIT = 20.0
RADIAL_MIN = 0.05
RADIAL_MAX = 1e6
UNDISTORT_ROUNDS = 20
UNDISTORT_FAILED = 1e-4


def quaternion_rotation(q: Sequence[float]) -> np.ndarray:
    """Body -> NED, from the axis and the angle of the quaternion (Rodrigues)."""
    w, vector = q[0], np.asarray(q[1:], dtype=float)
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        return np.eye(3)
    x, y, z = vector / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = 2.0 * math.atan2(length, w)
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)


def mounting_rotation(camera: Camera) -> np.ndarray:
    """Camera -> body: the columns are the camera's axes in body, turned by yaw, pitch and roll."""
    yaw, pitch, roll = np.radians([camera.mount_yaw_deg, camera.mount_pitch_deg, camera.mount_roll_deg])
    about_z = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[np.cos(pitch), 0.0, np.sin(pitch)], [0.0, 1.0, 0.0], [-np.sin(pitch), 0.0, np.cos(pitch)]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(roll), -np.sin(roll)], [0.0, np.sin(roll), np.cos(roll)]])
    turn = about_z @ about_y @ about_x
    return np.column_stack([turn[:, 1], turn[:, 2], turn[:, 0]])


def undistort(camera: Camera, x: float, y: float) -> tuple[float, float, bool, float]:
    """Inverts the lens by fixed-point iteration: x, y, whether it converged, and how near that was to a limit."""
    if not any((camera.k1, camera.k2, camera.p1, camera.p2, camera.k3)):
        return x, y, True, math.inf
    point, distorted, step, near = np.array([x, y]), np.array([x, y]), 0.0, math.inf
    for _ in range(UNDISTORT_ROUNDS):
        r2 = float(point @ point)
        radial = 1.0 + camera.k1 * r2 + camera.k2 * r2**2 + camera.k3 * r2**3
        near = min(near, abs(radial - RADIAL_MIN), abs(abs(radial) - RADIAL_MAX) / RADIAL_MAX)
        if not RADIAL_MIN <= radial <= RADIAL_MAX:
            return x, y, False, near
        px, py = point
        tangential = np.array(
            [
                2.0 * camera.p1 * px * py + camera.p2 * (r2 + 2.0 * px**2),
                camera.p1 * (r2 + 2.0 * py**2) + 2.0 * camera.p2 * px * py,
            ]
        )
        after = (distorted - tangential) / radial
        near = min(near, float(np.min(np.abs(np.abs(after) - RAY_LIMIT))) / RAY_LIMIT)
        if float(np.max(np.abs(after))) > RAY_LIMIT:
            return x, y, False, near
        step = float(np.max(np.abs(after - point)))
        point = after
    near = min(near, abs(step - UNDISTORT_FAILED))
    return float(point[0]), float(point[1]), step <= UNDISTORT_FAILED, near


def fold(deg: float) -> float:
    """The angle of the same undirected line in (-90, 90]."""
    return deg - 180.0 * math.ceil((deg - 90.0) / 180.0)


def chosen_end(gates: Gates, name: str, deg: float, size: float = 180.0) -> float:
    """An angle in (-90, 90]. Which of the two ends it takes near 90 is a decision. size: of the angle's operands."""
    if abs(deg) > 45.0:
        positive = gates.decide(name, deg > 0.0, 90.0 - abs(deg), size)
        if positive != (deg > 0.0):
            return deg + (180.0 if positive else -180.0)
    return deg


def turned(gates: Gates, name: str, x: float, cos_b: float, sin_b: float) -> float | None:
    """(4): the aligned point seen by a camera turned by b. None: not ahead of it."""
    norm = math.hypot(1.0, x)
    forward = cos_b + x * sin_b
    if not gates.decide(name, forward > FORWARD_MIN * norm, forward - FORWARD_MIN * norm, 2.0 * norm):
        return None
    return math.tan(math.atan(x) - math.atan2(sin_b, cos_b))
