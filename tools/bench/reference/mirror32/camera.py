"""From a pixel to an aligned point: the lens, and the camera's attitude."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from goe_tools.logs.obslog import Camera

from .rotation import Matrix, rotation_apply, rotation_from_euler
from .single import ONE, TWO, ZERO, F, larger, magnitude, within

UNDISTORT_ROUNDS = 20
UNDISTORT_DONE, UNDISTORT_FAILED = F(1.0e-7), F(1.0e-4)
RAY_MAX, RADIAL_MIN, RADIAL_MAX = F(20.0), F(0.05), F(1.0e6)
FORWARD_MIN = F(0.05)


@dataclass
class Camera32:
    """The camera settings as floats."""

    fx: np.float32
    fy: np.float32
    cx: np.float32
    cy: np.float32
    k1: np.float32
    k2: np.float32
    p1: np.float32
    p2: np.float32
    k3: np.float32
    offset_m: list[np.float32]
    camera_to_body: Matrix


def camera_of(camera: Camera) -> Camera32:
    turn = rotation_from_euler(F(camera.mount_yaw_deg), F(camera.mount_pitch_deg), F(camera.mount_roll_deg))
    mounting = [turn[3 * row + column] for row in range(3) for column in (1, 2, 0)]
    numbers = [F(getattr(camera, name)) for name in ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")]
    return Camera32(*numbers, [F(camera.offset_x_m), F(camera.offset_y_m), F(camera.offset_z_m)], mounting)


def undistort(lens: Camera32, distorted_x: np.float32, distorted_y: np.float32) -> tuple[np.float32, np.float32] | None:
    x, y, step = distorted_x, distorted_y, ZERO
    for _ in range(UNDISTORT_ROUNDS):
        r2 = x * x + y * y
        radial = ONE + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))
        if not within(radial, RADIAL_MAX) or radial < RADIAL_MIN:
            return None
        tangential_x = TWO * lens.p1 * x * y + lens.p2 * (r2 + TWO * x * x)
        tangential_y = lens.p1 * (r2 + TWO * y * y) + TWO * lens.p2 * x * y
        next_x = (distorted_x - tangential_x) / radial
        next_y = (distorted_y - tangential_y) / radial
        if not within(next_x, RAY_MAX) or not within(next_y, RAY_MAX):
            return None
        step = larger(np.abs(next_x - x), np.abs(next_y - y))
        x, y = next_x, next_y
        if step <= UNDISTORT_DONE:
            break
    return (x, y) if step <= UNDISTORT_FAILED else None


def camera_ray(camera: Camera32, u_px: np.float32, v_px: np.float32) -> tuple[np.float32, np.float32] | None:
    x, y = (u_px - camera.cx) / camera.fx, (v_px - camera.cy) / camera.fy
    if any(magnitude(k) != 0 for k in (camera.k1, camera.k2, camera.p1, camera.p2, camera.k3)):
        return undistort(camera, x, y)
    return x, y


@dataclass
class Point:
    x: np.float32
    y: np.float32
    u_px: np.float32
    v_px: np.float32


def align(
    camera: Camera32, camera_to_trajectory: Matrix, u_px: np.float32, v_px: np.float32
) -> tuple[str, Point | None]:
    ray = camera_ray(camera, u_px, v_px)
    if ray is None:
        return "lens_failed", None
    x, y = ray
    norm = np.sqrt(x * x + y * y + ONE)
    turned = rotation_apply(camera_to_trajectory, (x, y, ONE))
    if turned[2] <= FORWARD_MIN * norm:
        return "behind_camera", None
    return "ok", Point(turned[0] / turned[2], turned[1] / turned[2], u_px, v_px)
