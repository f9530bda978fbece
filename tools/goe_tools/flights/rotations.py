"""Attitudes as arrays: Euler angles, quaternions (w, x, y, z) body -> NED, rotation matrices.

Frames: NED earth (north, east, down), FRD body, camera (right, down, ahead), T = (right, down, forward) level.
"""

from __future__ import annotations

import math

import numpy as np

from ..logs.obslog import Camera

AXES = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # camera -> body, without mounting angles


def euler(yaw: np.ndarray, pitch: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """Z-Y'-X'' rotations body -> NED from angles in rad, broadcast; (..., 3, 3)."""
    yaw, pitch, roll = np.broadcast_arrays(yaw, pitch, roll)
    cy, sy, cp, sp, cr, sr = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def multiply(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Products of quaternions (..., 4)."""
    w, v, s, u = p[..., :1], p[..., 1:], q[..., :1], q[..., 1:]
    return np.concatenate([w * s - (v * u).sum(-1, keepdims=True), w * u + s * v + np.cross(v, u)], -1)


def quaternions(yaw: np.ndarray, pitch: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """The quaternions (..., 4) of ``euler``'s rotations."""

    def about(axis: int, angle: np.ndarray) -> np.ndarray:
        q = np.zeros((*np.shape(angle), 4))
        q[..., 0], q[..., axis] = np.cos(angle / 2), np.sin(angle / 2)
        return q

    yaw, pitch, roll = np.broadcast_arrays(yaw, pitch, roll)
    return multiply(multiply(about(3, yaw), about(2, pitch)), about(1, roll))


def small_rotations(vector: np.ndarray) -> np.ndarray:
    """Quaternions (..., 4) of rotation vectors (..., 3) in rad."""
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle / 2), vector * 0.5 * np.sinc(angle / (2 * math.pi))], -1)


def matrices(q: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of quaternions (..., 4), which it normalizes."""
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def level_axes(heading_rad: float) -> np.ndarray:
    """NED -> T, 3 x 3."""
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    return np.array([[-s, c, 0.0], [0.0, 0.0, 1.0], [c, s, 0.0]])


def mounting(camera: Camera) -> np.ndarray:
    """Camera -> body, 3 x 3."""
    angles = np.radians([camera.mount_yaw_deg, camera.mount_pitch_deg, camera.mount_roll_deg])
    return euler(*angles) @ AXES


def fold(angle: np.ndarray) -> np.ndarray:
    """Axis angles in rad, folded to +-90 degrees."""
    return (angle + math.pi / 2) % math.pi - math.pi / 2
