"""Simulated flights past an obstacle, with a detector's upright bounding box in each image.

The box is the smallest upright one around the exact outline, plus a detector's error, clipped at the image border.
The reference position of the truth is the middle of the base, which boxes determine."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .flight import Flight, Obstacle
from .noise import Noise
from .rotations import euler, mounting, multiply, quaternions, small_rotations
from .scene import project
from .simulated import pinhole

RIM_POINTS = 256  # in place of a circle: error of at most 0.02 px at the nearest
MIN_WIDTH_PX = 2.0  # least width of an obstacle that a detector finds
MIN_INSIDE_PX = 20.0  # least part of its width inside the image
MIN_IMAGES = 12  # with a box, for a flight
ANY_HEIGHT_M = 200.0  # without an altimeter the reported height is random up to this
PITCH_RAD = math.radians(2.0)  # mean; pitch and yaw sway about their means
SWAY_RAD = math.radians(0.7)
PITCH_PERIOD_S, YAW_PERIOD_S = 3.1, 2.3


@dataclass(frozen=True)
class Solid:
    """An upright cylinder (disc) or box to fly past."""

    name: str
    kind: str  # disc or box
    width_m: float
    length_m: float
    height_m: float
    turned_deg: float = 0.0  # largest angle of the side edge from the direction of flight

    def outline(self, x_m: float, z_m: float, orientation_rad: float) -> np.ndarray:
        """Base points (N, 2) as (X, Z) about the middle: the corners, or the rim."""
        if self.kind == "disc":
            angle = np.arange(RIM_POINTS) * (2 * math.pi / RIM_POINTS)
            return np.array([x_m, z_m]) + 0.5 * self.width_m * np.stack([np.sin(angle), np.cos(angle)], 1)
        c, s = math.cos(orientation_rad), math.sin(orientation_rad)
        across, along = 0.5 * self.width_m * np.array([c, -s]), 0.5 * self.length_m * np.array([s, c])
        return np.array([[x_m, z_m]]) + np.array([i * across + j * along for i in (-1, 1) for j in (-1, 1)])


MAST = Solid("mast", "disc", 6.0, 6.0, 30.0)
BUILDING = Solid("building", "box", 12.0, 20.0, 15.0, 45.0)
WALL = Solid("wall end-on", "box", 6.0, 40.0, 12.0, 5.0)


@dataclass(frozen=True)
class BoxOptions:
    """The flight, and the errors of the measurements: one sigma each unless noted otherwise."""

    roll_deg: float = 0.0  # amplitude
    roll_hz: float = 0.4
    speed_mps: float = 17.0
    altitude_m: float = 20.0  # of the camera above the obstacle's ground
    image_rate_hz: float = 8.0
    stop_m: float = 12.0  # distance of the last image before the obstacle's middle is abeam
    ahead_m: tuple[float, float] = (200.0, 260.0)  # Z of the middle at the first image, from and to
    aside_m: tuple[float, float] = (-30.0, -8.0)  # X of it
    box_noise_px: float = 0.5  # of a side, white
    box_noise_rel: float = 0.04  # of a side, share of the box's width or height, correlated in time
    box_correlation_time_s: float = 1.0
    attitude_bias_sd_deg: float = 0.5  # each body axis
    attitude_white_sd_deg: float = 0.1
    velocity_bias_sd_m_s: float = 0.05  # north and east
    position_walk_sd_m: float = 0.05  # per sqrt(s), each axis
    height_bias_sd_m: float = 0.5
    height_white_sd_m: float = 0.0  # of the altimeter
    altimeter: bool = True  # without one, the reported height is random
    ground_off_m: float = 0.0  # height of the obstacle's ground relative to the ground of the altimeter


EXACT = BoxOptions(
    box_noise_px=0.0, box_noise_rel=0.0, attitude_bias_sd_deg=0.0, attitude_white_sd_deg=0.0, velocity_bias_sd_m_s=0.0,
    position_walk_sd_m=0.0, height_bias_sd_m=0.0,
)  # fmt: skip


def correlated(time_s: np.ndarray, constant_s: float, columns: int, rng: np.random.Generator) -> np.ndarray:
    """(K, columns) of a normal process with one sigma of 1 and an exponential correlation."""
    result = rng.standard_normal((len(time_s), columns))
    kept = np.exp(-np.diff(time_s) / constant_s)
    for k, share in enumerate(kept, start=1):
        result[k] = share * result[k - 1] + math.sqrt(1.0 - share * share) * result[k]
    return result


def _exact_boxes(pixel: np.ndarray) -> np.ndarray:
    """(K, 4) left, top, right, bottom around points (K, N, 2); NaN if a point is not ahead of the camera."""
    return np.concatenate([pixel.min(1), pixel.max(1)], 1)


def _detected(exact: np.ndarray, time_s: np.ndarray, options: BoxOptions, rng: np.random.Generator) -> np.ndarray:
    """Boxes (K, 4) with a detector's error."""
    size = np.tile(exact[:, 2:] - exact[:, :2], 2)
    common = correlated(time_s, options.box_correlation_time_s, 4, rng)
    return exact + options.box_noise_rel * size * common + options.box_noise_px * rng.standard_normal(exact.shape)


def clipped(box: np.ndarray, image_size_px: tuple[float, float]) -> np.ndarray:
    """Boxes (K, 4) clipped at the image border; NaN if too little of one remains inside."""
    width, height = image_size_px
    left, top, right, bottom = box.T
    with np.errstate(invalid="ignore"):
        inside = (right > MIN_INSIDE_PX) & (left < width - MIN_INSIDE_PX) & (bottom > 0.0) & (top < height)
    return np.where(inside[:, None], np.clip(box, 0.0, np.tile([width - 1.0, height - 1.0], 2)), np.nan)


def _estimated_pose(
    position: np.ndarray, attitude: np.ndarray, time_s: np.ndarray, options: BoxOptions, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, attitude and height as estimated by the autopilot."""
    bias = math.radians(options.attitude_bias_sd_deg) * rng.standard_normal(3)
    white = math.radians(options.attitude_white_sd_deg) * rng.standard_normal((len(time_s), 3))
    step = options.position_walk_sd_m * np.sqrt(np.diff(time_s, prepend=time_s[0]))[:, None]
    estimated = position + np.cumsum(step * rng.standard_normal(position.shape), 0)
    estimated[:, :2] += options.velocity_bias_sd_m_s * rng.standard_normal(2) * time_s[:, None]
    off = options.ground_off_m * rng.choice([-1.0, 1.0]) + options.height_bias_sd_m * rng.standard_normal()
    height = -position[:, 2] + off + options.height_white_sd_m * rng.standard_normal(len(time_s))
    if not options.altimeter:
        height = np.full(len(time_s), rng.uniform(0.0, ANY_HEIGHT_M))
    return estimated, multiply(attitude, small_rotations(bias + white)), height


def _one_flight(solid: Solid, options: BoxOptions, name: str, rng: np.random.Generator) -> Flight | None:
    """None if too few images show the obstacle."""
    orientation = math.radians(solid.turned_deg) * rng.uniform(-1.0, 1.0)
    x0, z0 = float(rng.uniform(*options.aside_m)), float(rng.uniform(*options.ahead_m))
    images = int((z0 - options.stop_m) / options.speed_mps * options.image_rate_hz)
    t = np.arange(images) / options.image_rate_hz
    phases = rng.uniform(0.0, 2 * math.pi, 3)
    sway = [np.sin(2 * math.pi * t / p + q) for p, q in zip((YAW_PERIOD_S, PITCH_PERIOD_S), phases)]
    roll = math.radians(options.roll_deg) * np.sin(2 * math.pi * options.roll_hz * t + phases[2])
    angles = (SWAY_RAD * sway[0], PITCH_RAD + SWAY_RAD * sway[1], roll)
    position = np.stack([options.speed_mps * t, np.zeros(images), np.full(images, -options.altitude_m)], 1)

    camera = pinhole()
    base = solid.outline(x0, z0, orientation)[:, ::-1]  # T looks north: (Z, X) is (north, east)
    levels = np.repeat([0.0, -solid.height_m], len(base))
    points = np.column_stack([np.tile(base, (2, 1)), levels])
    ned_from_camera = euler(*angles) @ mounting(camera)
    pixel = project(camera, ned_from_camera, position, np.broadcast_to(points, (images, *points.shape)))
    exact, size = _exact_boxes(pixel), (camera.width, camera.height)
    box = clipped(_detected(exact, t, options, rng), size)
    with np.errstate(invalid="ignore"):
        box[~(exact[:, 2] - exact[:, 0] > MIN_WIDTH_PX)] = np.nan
    estimated, attitude, height = _estimated_pose(position, quaternions(*angles), t, options, rng)

    there = np.flatnonzero(np.isfinite(box[:, 0]))
    if len(there) < MIN_IMAGES:
        return None
    part = slice(there[0], there[-1] + 1)
    z0 -= float(position[there[0], 0])
    truth = Obstacle(solid.kind, x0, z0, orientation, solid.width_m, solid.length_m, solid.height_m)
    kept = there[-1] + 1 - there[0]
    return Flight(
        name, solid.name, camera, t[part] - t[there[0]], np.zeros((kept, 6, 2)), np.zeros((kept, 6), bool),
        estimated[part],
        attitude[part], height[part], truth, Noise(), box_px=box[part], image_size_px=size,
    )  # fmt: skip


def box_flight(solid: Solid, options: BoxOptions, seed: int | Sequence[int] = 1) -> Flight:
    """A flight past a solid at a random place; the same seed gives the same flight."""
    rng = np.random.default_rng(seed)
    while True:
        flight = _one_flight(solid, options, f"{solid.name} roll {options.roll_deg:g}", rng)
        if flight is not None:
            return flight
