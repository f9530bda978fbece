"""Errors of the reported quantities: one sigma each, drawn for each track, unless noted otherwise."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import surroundings, turns
from .motion import Path, Span
from .view import BASE_LEFT, BASE_NEAR, BASE_RIGHT, LEFT, RIGHT, TOP

FEET_PER_M = 1.0 / 0.3048
FALSE_POINT_PX = (8.0, 60.0)  # of an outlier, from the truth
NED_TO_ENU = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])  # equals its inverse
FLIPPED = np.diag([1.0, -1.0, -1.0])  # FRD and FLU, NED and NWU
WRONG_NEAR_SHARE = (0.2, 0.5)  # place of the wrong near corner along an edge of the base


@dataclass(frozen=True)
class Wrong:
    """The defaults are the errors in the library's default settings."""

    point_noise_px: float = 0.5
    point_noise_rel: float = (
        0.0  # of left, right, top: share of the width in the image, correlated over box_correlation_time_s
    )
    box_noise_px: float = 0.5
    box_noise_rel: float = 0.04  # of a side: share of the box's width or height, correlated over box_correlation_time_s
    box_correlation_time_s: float = 1.0
    attitude_bias_sd_deg: float = 0.5  # each body axis
    attitude_white_sd_deg: float = 0.1
    velocity_bias_sd_m_s: float = 0.05  # north, east
    position_walk_sd_m: float = 0.05  # per sqrt(s), each axis
    height_bias_sd_m: float = 0.5
    height_white_sd_m: float = 0.0
    ground_off_m: float = 0.0  # exact size, up or down
    slope: float = 0.0  # rise or fall of the ground under the aircraft towards the obstacle
    reset_m: float = 0.0  # halfway the reported down and height jump by this size, up or down; the jump is reported
    down_walk_m: float = 0.0  # per sqrt(s): reported down and height wander together ...
    climb_off_m_s: float = 0.0  # ... and drift at this speed, up or down
    velocity_wander_m_s: float = 0.0  # error of the velocity, north and east: a Gauss-Markov process ...
    velocity_wander_s: float = 20.0  # ... with this correlation time
    velocity_off_m_s: float = 0.0  # constant error of the velocity: exact size, any horizontal direction
    step_m: float = 0.0  # the ground below the first half of the way is higher or lower by this size
    canopy_m: Span = (0.0, 0.0)  # the height is measured above trees of this height, with gaps between them
    height_lag_s: float = 0.0  # age of the height, on top of the pose's
    late_s: float = 0.0  # age of the pose
    mount_off_deg: float = 0.0  # error of the configured mounting about each axis, exact size, either sign
    focal_share: float = 0.0  # relative error of the configured focal length
    k1: float = 0.0  # of the lens, not configured
    outliers: float = 0.0  # share of the points at random places nearby
    near_wrong: bool = False  # the near base corner is a fixed point on an edge of the base
    convention: str = ""  # one of CONVENTIONS
    mount_configured_deg: tuple[float, float, float] | None = None  # yaw, pitch, roll; None: the true ones


@dataclass
class Pose:
    """As reported, over K images: NED, matrices body -> NED, heights above ground."""

    position_m: np.ndarray
    attitude: np.ndarray
    quaternion: np.ndarray
    height_m: np.ndarray
    velocity_error_m_s: np.ndarray  # (3,) or (K, 3) of the reported velocity


def _of_matrix(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Pose], None]:
    def apply(pose: Pose) -> None:
        pose.quaternion = turns.quaternion(change(pose.attitude))

    return apply


def _order(pose: Pose) -> None:
    pose.quaternion = pose.quaternion[:, [1, 2, 3, 0]]


def _with_angles(yaw: float, pitch: float, roll: float) -> Callable[[np.ndarray], np.ndarray]:
    def change(matrix: np.ndarray) -> np.ndarray:
        angles = turns.angles_of(matrix)
        return turns.of_angles(yaw * angles[0], pitch * angles[1], roll * angles[2])

    return change


def _enu(pose: Pose) -> None:
    """Position east, north, up; attitude FLU -> ENU."""
    pose.position_m = pose.position_m @ NED_TO_ENU
    pose.quaternion = turns.quaternion(NED_TO_ENU @ pose.attitude @ FLIPPED)


def _position_enu(pose: Pose) -> None:
    pose.position_m = pose.position_m @ NED_TO_ENU


def _nwu(pose: Pose) -> None:
    """Position north, west, up; attitude FLU -> NWU."""
    pose.position_m = pose.position_m @ FLIPPED
    pose.quaternion = turns.quaternion(FLIPPED @ pose.attitude @ FLIPPED)


def _height_in_feet(pose: Pose) -> None:
    pose.height_m = pose.height_m * FEET_PER_M


def _all_in_feet(pose: Pose) -> None:
    pose.height_m, pose.position_m = pose.height_m * FEET_PER_M, pose.position_m * FEET_PER_M


CONVENTIONS: dict[str, Callable[[Pose], None]] = {
    "conjugated": _of_matrix(lambda m: np.swapaxes(m, -1, -2)),
    "ENU": _enu,
    "FLU body": _of_matrix(lambda m: m @ FLIPPED),
    "NWU": _nwu,
    "xyzw": _order,
    "roll sign": _of_matrix(_with_angles(1.0, 1.0, -1.0)),
    "pitch sign": _of_matrix(_with_angles(1.0, -1.0, 1.0)),
    "position ENU": _position_enu,
    "height in feet": _height_in_feet,
    "all in feet": _all_in_feet,
}


def correlated(time_s: np.ndarray, constant_s: float, columns: int, rng: np.random.Generator) -> np.ndarray:
    """(K, columns) with sigma 1 and an exponential correlation."""
    result = rng.standard_normal((len(time_s), columns))
    kept = np.exp(-np.diff(time_s) / constant_s)
    for k, share in enumerate(kept, start=1):
        result[k] = share * result[k - 1] + math.sqrt(1.0 - share * share) * result[k]
    return result


def spoil_points(exact: np.ndarray, time_s: np.ndarray, wrong: Wrong, rng: np.random.Generator) -> np.ndarray:
    """Points (K, 6, 2) with a detector's errors."""
    pixel = exact + wrong.point_noise_px * rng.standard_normal(exact.shape)
    drawn = correlated(time_s, wrong.box_correlation_time_s, 3, rng)
    if wrong.point_noise_rel:
        width = exact[:, RIGHT, 0] - exact[:, LEFT, 0]
        error = wrong.point_noise_rel * width[:, None] * drawn
        pixel[:, LEFT, 0] += error[:, 0]
        pixel[:, RIGHT, 0] += error[:, 1]
        pixel[:, TOP, 1] += np.where(np.isfinite(error[:, 2]), error[:, 2], 0.0)
    hit = rng.random(exact.shape[:2]) < wrong.outliers
    size, angle = rng.uniform(*FALSE_POINT_PX, exact.shape[:2]), rng.uniform(0.0, 2 * math.pi, exact.shape[:2])
    pixel += (hit * size)[..., None] * np.stack([np.cos(angle), np.sin(angle)], -1)
    share, other = rng.uniform(*WRONG_NEAR_SHARE), rng.choice([BASE_LEFT, BASE_RIGHT])
    if wrong.near_wrong:
        pixel[:, BASE_NEAR] += share * (exact[:, other] - exact[:, BASE_NEAR])
    return pixel


def spoil_boxes(exact: np.ndarray, time_s: np.ndarray, wrong: Wrong, rng: np.random.Generator) -> np.ndarray:
    """Boxes (K, 4) with a detector's errors, before clipping at the border."""
    size = np.tile(exact[:, 2:] - exact[:, :2], 2)
    white = wrong.box_noise_px * rng.standard_normal(exact.shape)
    return exact + wrong.box_noise_rel * size * correlated(time_s, wrong.box_correlation_time_s, 4, rng) + white


def drifting(time_s: np.ndarray, wrong: Wrong, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Slow errors (K, 3) of the reported position, which is right in the first image, and of the reported velocity."""
    step_s, count = np.diff(time_s, prepend=time_s[0]), len(time_s)
    velocity = np.zeros((count, 3))
    velocity[:, :2] = wrong.velocity_wander_m_s * correlated(time_s, wrong.velocity_wander_s, 2, rng)
    angle = rng.uniform(0.0, 2 * math.pi)
    velocity[:, :2] += wrong.velocity_off_m_s * np.array([math.cos(angle), math.sin(angle)])
    velocity[:, 2] = wrong.climb_off_m_s * rng.choice([-1.0, 1.0])
    place = np.cumsum(velocity * step_s[:, None], 0)
    place[:, 2] += np.cumsum(wrong.down_walk_m * np.sqrt(step_s) * rng.standard_normal(count))
    return place, velocity


def ground_m(away_m: np.ndarray, wrong: Wrong, rng: np.random.Generator) -> np.ndarray:
    """Height (K,) of the ground or of the trees below the aircraft, above the obstacle's ground."""
    ground = surroundings.step_m(away_m, wrong.step_m, rng)
    return ground + surroundings.canopy_m(away_m, wrong.canopy_m, rng) if any(wrong.canopy_m) else ground


def reported_pose(
    path: Path, time_s: np.ndarray, to_ned: np.ndarray, origin_m: np.ndarray, obstacle_m: np.ndarray, wrong: Wrong,
    rng: np.random.Generator, harder: np.random.Generator,
) -> tuple[Pose, np.ndarray]:  # fmt: skip
    """The pose at some of the path's times, and the sum of the filter's jumps up to each of them (K, 3).
    ``to_ned``: the course's axes, with their origin at ``origin_m``; ``obstacle_m``: forward, right; ``harder``: draws
    the slow errors and the ground."""
    place, body = path.at(time_s - wrong.late_s)
    place, height = origin_m + place @ to_ned.T, -path.at(time_s - wrong.late_s - wrong.height_lag_s)[0][:, 2]
    count, flown_s = len(time_s), time_s - time_s[0]
    bias = math.radians(wrong.attitude_bias_sd_deg) * rng.standard_normal(3)
    white = math.radians(wrong.attitude_white_sd_deg) * rng.standard_normal((count, 3))
    step = wrong.position_walk_sd_m * np.sqrt(np.diff(time_s, prepend=time_s[0]))[:, None]
    place = place + np.cumsum(step * rng.standard_normal((count, 3)), 0)
    drift = np.append(wrong.velocity_bias_sd_m_s * rng.standard_normal(2), 0.0)
    place = place + drift * flown_s[:, None]
    up, slope, jump = rng.choice([-1.0, 1.0], 3) * [wrong.ground_off_m, wrong.slope, wrong.reset_m]
    reported = height + up + wrong.height_bias_sd_m * rng.standard_normal()
    reported = reported + wrong.height_white_sd_m * rng.standard_normal(count)
    away = np.linalg.norm(path.at(time_s)[0][:, :2] - obstacle_m, axis=1)
    slow, slow_velocity = drifting(time_s, wrong, harder)
    place, drift = place + slow, drift + slow_velocity
    reported = reported + slope * away - slow[:, 2] - ground_m(away, wrong, harder)
    jumped = np.zeros((count, 3))
    jumped[count // 2 :, 2] = jump
    attitude = to_ned @ body @ turns.of_vector(bias + white)
    pose = Pose(place + jumped, attitude, turns.quaternion(attitude), reported - jumped[:, 2], drift)
    if wrong.convention:
        CONVENTIONS[wrong.convention](pose)
    return pose, jumped


def configured_mounting(
    mount_deg: tuple[float, float, float], wrong: Wrong, rng: np.random.Generator
) -> tuple[float, float, float]:
    """Yaw, pitch, roll, degrees."""
    if wrong.mount_configured_deg is not None:
        return wrong.mount_configured_deg
    off = math.radians(wrong.mount_off_deg) * rng.choice([-1.0, 1.0], 3)
    matrix = turns.of_angles(*np.radians(mount_deg)) @ turns.of_vector(off)
    yaw, pitch, roll = np.degrees(turns.angles_of(matrix))
    return float(yaw), float(pitch), float(roll)
