"""True position and attitude of the aircraft: (F, K) arrays over flights and their images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import Draws
from .genes import ORBIT, Array, Params

GRAVITY_M_S2 = 9.81
LOWEST_M = 1.2  # vehicle above ground
PRE_TURN_DEG_S = 25.0
PRE_IMAGES_MOST = 40
BANK_MOST_DEG = 45.0
NOSE_UP_DEG = 2.0
SWAY_PHASE = 1.3  # of roll against heading


@dataclass
class Motion:
    """NED, origin on the ground; angles in radians."""

    t_s: Array  # (F, K)
    first: np.ndarray  # (F,) first image that may show the obstacle
    count: np.ndarray  # (F,) images
    position: Array  # (F, K, 3)
    velocity: Array  # (F, K, 3)
    course: Array  # (F, K)
    angles: Array  # (F, K, 3) yaw, pitch, roll
    turned: Array  # (F, K, 3, 3) body to NED


def rotation(yaw: Array, pitch: Array, roll: Array) -> Array:
    """Rotation about z, then the new y, then the newest x: (..., 3, 3), columns are the rotated axes."""
    cy, sy, cp, sp, cr, sr = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(np.broadcast_arrays(*row), -1) for row in rows], -2)


def _times(p: Params, draws: Draws, pre: np.ndarray, count: np.ndarray) -> Array:
    step = (1.0 + p["jitter"][:, None] * (draws.even[:, :, 0] - 0.5)) / p["rate_hz"][:, None]
    number = np.arange(step.shape[1])
    gap = pre + 1 + (p["gap_at"] * (count - pre - 2)).astype(int)
    step = step + np.where(number == gap[:, None], p["gap_s"][:, None], 0.0)
    step[:, 0] = 0.0
    return np.cumsum(step, 1)


def _course(p: Params, t: Array, start: Array) -> tuple[Array, Array]:
    """Course and its rate, rad; ``start``: end time of the turn before the first detection."""
    omega, phase = 2.0 * np.pi / p["period_s"][:, None], p["phase_rad"][:, None]
    since = t - start
    weave = np.radians(p["weave_deg"])[:, None]
    orbit = np.where(p["kind"] == ORBIT, p["side"] * p["speed_m_s"] / p["range_m"], 0.0)
    turn = np.where(since > 0.0, (np.radians(p["turn_deg_s"]) + orbit)[:, None], 0.0)
    pre_rate = np.where(since < 0.0, np.radians(np.sign(p["pre_turn_deg"]) * PRE_TURN_DEG_S)[:, None], 0.0)
    course = (
        np.radians(p["course_deg"])[:, None] + weave * np.sin(omega * since + phase) + turn * since + pre_rate * since
    )
    return course, weave * omega * np.cos(omega * since + phase) + turn + pre_rate


def _path(p: Params, t: Array, first: np.ndarray, course: Array) -> tuple[Array, Array]:
    speed = p["speed_m_s"][:, None]
    level = np.stack([speed * np.cos(course), speed * np.sin(course)], -1)
    moved = 0.5 * (level[:, 1:] + level[:, :-1]) * np.diff(t, axis=1)[..., None]
    place = np.concatenate([np.zeros_like(level[:, :1]), np.cumsum(moved, 1)], 1)
    start = np.take_along_axis(t, first[:, None], 1)
    climb = p["climb_m_s"][:, None] * np.maximum(t - start, 0.0)
    height = np.maximum(p["height_m"][:, None] + climb, LOWEST_M)
    sink = np.where(height > LOWEST_M, -p["climb_m_s"][:, None] * (t >= start), 0.0)
    return np.concatenate([place, -height[..., None]], 2), np.concatenate([level, sink[..., None]], 2)


def pre_images(p: Params) -> np.ndarray:
    """Number of images before the obstacle may be visible: those of a turn."""
    count = np.ceil(np.abs(p["pre_turn_deg"]) / PRE_TURN_DEG_S * p["rate_hz"])
    return np.where(p["pre_turn"], np.clip(count, 1, PRE_IMAGES_MOST), 0).astype(int)


def move(p: Params, draws: Draws) -> Motion:
    pre = pre_images(p)
    count = p["images"] + pre
    t = _times(p, draws, pre, count)
    start = np.take_along_axis(t, pre[:, None], 1)
    course, rate = _course(p, t, start)
    position, velocity = _path(p, t, pre, course)
    omega, phase = 2.0 * np.pi / p["period_s"][:, None], p["phase_rad"][:, None]
    bank = np.arctan(p["speed_m_s"][:, None] * rate / GRAVITY_M_S2)
    roll = bank + np.radians(p["sway_deg"])[:, None] * np.sin(1.7 * omega * t + SWAY_PHASE + phase)
    roll = np.clip(roll, -np.radians(BANK_MOST_DEG), np.radians(BANK_MOST_DEG))
    pitch = np.arctan2(-velocity[..., 2], p["speed_m_s"][:, None]) + np.radians(NOSE_UP_DEG) * (
        1.0 + np.sin(0.7 * omega * t)
    )
    yaw = course + np.radians(p["crab_deg"])[:, None]
    return Motion(
        t, pre, count, position, velocity, course, np.stack([yaw, pitch, roll], -1), rotation(yaw, pitch, roll)
    )
