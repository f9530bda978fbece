"""Rotation matrices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .angle import sincos_deg
from .single import ONE, TWO

Matrix = list[np.float32]  # 3 x 3, row by row


def rotation_from_quaternion(q: Sequence[np.float32]) -> Matrix:
    w, x, y, z = q
    s = TWO / (w * w + x * x + y * y + z * z)
    return [
        ONE - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
        s * (x * y + w * z), ONE - s * (x * x + z * z), s * (y * z - w * x),
        s * (x * z - w * y), s * (y * z + w * x), ONE - s * (x * x + y * y),
    ]  # fmt: skip


def rotation_from_euler(yaw_deg: np.float32, pitch_deg: np.float32, roll_deg: np.float32) -> Matrix:
    sy, cy = sincos_deg(yaw_deg)
    sp, cp = sincos_deg(pitch_deg)
    sr, cr = sincos_deg(roll_deg)
    return [
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp, cp * sr, cp * cr,
    ]  # fmt: skip


def rotation_multiply(a: Matrix, b: Matrix) -> Matrix:
    return [
        a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column]
        for row in range(3)
        for column in range(3)
    ]


def rotation_apply(r: Matrix, v: Sequence[np.float32]) -> list[np.float32]:
    return [r[3 * row] * v[0] + r[3 * row + 1] * v[1] + r[3 * row + 2] * v[2] for row in range(3)]
