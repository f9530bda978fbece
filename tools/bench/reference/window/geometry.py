"""From a pixel to an aligned point: attitude, mounting, lens; and (1), (2), (4) for aligned points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from goe_tools.logs.obslog import Camera

from .precision import Numbers, Real, Rounding

Matrix = list[Real]  # 3 x 3, row by row
UNDISTORT_ROUNDS = 20


@dataclass
class Point:
    """An aligned point and its pixel."""

    x: Real
    y: Real
    u_px: Real
    v_px: Real


def multiply(a: Matrix, b: Matrix) -> Matrix:
    return [
        a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column]
        for row in range(3)
        for column in range(3)
    ]


def apply(r: Matrix, v: Sequence[Real]) -> list[Real]:
    return [r[3 * row] * v[0] + r[3 * row + 1] * v[1] + r[3 * row + 2] * v[2] for row in range(3)]


def quaternion_rotation(n: Numbers, q: Sequence[Real]) -> Matrix:
    """Body -> NED, from a quaternion of any length."""
    w, x, y, z = q
    one, s = n.one, n.two / (w * w + x * x + y * y + z * z)
    return [
        one - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
        s * (x * y + w * z), one - s * (x * x + z * z), s * (y * z - w * x),
        s * (x * z - w * y), s * (y * z + w * x), one - s * (x * x + y * y),
    ]  # fmt: skip


def mounting_rotation(n: Numbers, camera: Camera) -> Matrix:
    """Camera -> body: the camera's axes without mounting angles (body y, z, x) turned by yaw, pitch and roll,
    Z-Y'-X''."""
    sy, cy = n.sincos_deg(n.real(camera.mount_yaw_deg))
    sp, cp = n.sincos_deg(n.real(camera.mount_pitch_deg))
    sr, cr = n.sincos_deg(n.real(camera.mount_roll_deg))
    turn = [
        cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
        -sp, cp * sr, cp * cr,
    ]  # fmt: skip
    return [turn[3 * row + column] for row in range(3) for column in (1, 2, 0)]


@dataclass
class Lens:
    """The intrinsic settings of a camera in one precision."""

    fx: Real
    fy: Real
    cx: Real
    cy: Real
    k1: Real
    k2: Real
    p1: Real
    p2: Real
    k3: Real
    distorts: bool

    @classmethod
    def of(cls, n: Numbers, camera: Camera) -> Lens:
        numbers = [n.real(getattr(camera, name)) for name in ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")]
        return cls(*numbers, distorts=any(numbers[4:]))


def undistort(n: Numbers, lens: Lens, distorted_x: Real, distorted_y: Real) -> tuple[Real, Real, bool, Rounding]:
    """Inverts the lens by fixed-point iteration: x, y, whether it converged, and its distance from a limit."""
    x, y, step, near = distorted_x, distorted_y, n.zero, math.inf
    if not lens.distorts:
        return x, y, True, near
    two, ray_max = n.two, n.ray_max
    for _ in range(UNDISTORT_ROUNDS):
        r2 = x * x + y * y
        radial = n.one + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
        size = float(abs(radial))
        near = min(near, abs(float(radial) - 0.05), abs(size - 1e6) / 1e6)
        if not n.radial_min <= radial <= n.radial_max:
            return x, y, False, near
        tangential_x = two * lens.p1 * x * y + lens.p2 * (r2 + two * x * x)
        tangential_y = lens.p1 * (r2 + two * y * y) + two * lens.p2 * x * y
        next_x, next_y = (distorted_x - tangential_x) / radial, (distorted_y - tangential_y) / radial
        size_x, size_y = abs(next_x), abs(next_y)
        near = min(near, abs(float(size_x) - 20.0) / 20.0, abs(float(size_y) - 20.0) / 20.0)
        if not (size_x <= ray_max and size_y <= ray_max):
            return x, y, False, near
        step = max(abs(next_x - x), abs(next_y - y))
        x, y = next_x, next_y
        if step <= n.undistort_done:
            break
    near = min(near, abs(float(step) - 1e-4))
    return x, y, bool(step <= n.undistort_failed), near


def disc_row(n: Numbers, x_left: Real, x_right: Real) -> tuple[Real, Real]:
    """(2), with its multiplier 2: m x/S and m/S."""
    cos_left = n.one / np.sqrt(n.one + x_left * x_left)
    cos_right = n.one / np.sqrt(n.one + x_right * x_right)
    size = (x_right - x_left) * (cos_left + cos_right)
    x = n.half * (x_left + x_right) * (n.one - size * size * n.sixteenth)
    forward = n.two / size
    return x * forward, forward


def heading_deg(n: Numbers, a: Point, b: Point) -> Real:
    """(1): heading of the edge through a and b; the angle of a vector, which needs no division."""
    x = a.x * b.y - a.y * b.x
    z = b.y - a.y
    rad = n.arctan_rad(-x, -z) if z < n.zero else n.arctan_rad(x, z)
    return n.fold_deg(rad * n.deg_per_rad)
