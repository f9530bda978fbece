"""Flights from logs with truth, including KITTI's."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import dropwhile
from pathlib import Path

import numpy as np

from ..logs.obslog import FEATURES, RESET_COLUMN, Frame, LogError, ObservationLog, Truth, read_log
from ..places import ROOT
from .flight import Flight, Obstacle
from .noise import FIELD, Noise
from .rotations import fold, level_axes, matrices

KITTI_FOLDER = ROOT.parent / "shared" / "data" / "kitti"
KITTI_NOISE = Noise(
    pixel_px=0.7, size_share=0.025, correlation=0.54, shape_error_rel=0.12, attitude_bias_sd_deg=0.2,
    attitude_white_sd_deg=0.03,
    attitude_walk_sd_deg=0.05, height_m=0.1, velocity_bias_sd_m_s=0.05, position_walk_sd_m=0.02, prior_width_m=3.0,
)  # fmt: skip


def _value(number: float | None) -> float:
    return math.nan if number is None else number


def _heading_of(log: ObservationLog, frames: Sequence[Frame], truth: Truth) -> float:
    """Heading of T's Z axis, rad: from camera.ini, from the simulator, or the yaw at the first image."""
    if log.camera.heading_deg is not None:
        return math.radians(log.camera.heading_deg)
    if truth.extra.get("track_heading_deg"):
        return math.radians(float(truth.extra["track_heading_deg"]))
    forward = matrices(np.array(frames[0].attitude))[:, 0]
    return math.atan2(forward[1], forward[0])


def _obstacle_of(truth: Truth, origin_ne: np.ndarray, heading: float, kind: str | None) -> Obstacle:
    box = truth.length_m is not None if kind is None else kind == "box"
    x, z = level_axes(heading)[[0, 2], :2] @ (np.array([truth.center_n_m, truth.center_e_m]) - origin_ne)
    length = truth.width_m if truth.length_m is None else truth.length_m
    angle = float(fold(np.radians(_value(truth.heading_deg)) - heading)) if box else 0.0
    if box:
        x, z = x - 0.5 * length * math.sin(angle), z - 0.5 * length * math.cos(angle)
    logged = [truth.extra.get(name, "") for name in ("x0_m", "z0_m", "track_heading_deg")]
    if all(logged) and abs(math.radians(float(logged[2])) - heading) < 1e-9 and kind is None:
        x, z = float(logged[0]), float(logged[1])  # relative to the true first pose, which is not in the log
    return Obstacle("box" if box else "disc", x, z, angle, truth.width_m, length, truth.height_m, truth.static)


def _flight_of(log: ObservationLog, frames: Sequence[Frame], truth: Truth, name: str, kind: str | None) -> Flight:
    heading = _heading_of(log, frames, truth)
    attitude = np.array([frame.attitude for frame in frames])
    position = np.array([frame.position_m for frame in frames])
    points = [[getattr(frame, feature) or (math.nan, math.nan) for feature in FEATURES] for frame in frames]
    pixels = np.array(points, float)
    seen = np.isfinite(pixels).all(-1)
    none = (math.nan,) * 4
    boxes = [[math.nan if side is None else side for side in frame.box_px or none] for frame in frames]
    offset = np.array([log.camera.offset_x_m, log.camera.offset_y_m, log.camera.offset_z_m])
    origin = position[0] + matrices(attitude[0]) @ offset
    time_s = np.array([frame.t_s for frame in frames])
    return Flight(
        name, name.split("/")[0], replace(log.camera, heading_deg=math.degrees(heading)), time_s,
        np.where(seen[..., None], pixels, 0.0), seen, position, attitude,
        np.array([frame.height_m for frame in frames]), _obstacle_of(truth, origin[:2], heading, kind), FIELD,
        box_px=np.array(boxes) if np.isfinite(boxes).any() else None,
        image_size_px=(log.camera.width, log.camera.height),
    )  # fmt: skip


def _shows(frame: Frame) -> bool:
    """Whether the frame has a feature; the track starts with the first one that has."""
    box = frame.box_px or ()
    return any(side is not None for side in box) or any(getattr(frame, name) is not None for name in FEATURES)


def from_log(folder: Path, kind: str | None = None) -> list[Flight]:
    """A flight for each track with truth of a log folder. Leaves out images with a bad pose and those before the first
    feature; a reset or a second camera is an error.

    kind: None: box if the truth has a length, otherwise disc; or one of the two (disc: (x0, z0) is the center)."""
    folder = Path(folder)
    log = read_log(folder)
    if not log.truth:
        raise LogError(folder / "truth.csv", 0, "", "there is no truth")
    if log.camera2 is not None:
        raise LogError(folder / "camera.ini", 0, "camera2", "a second camera, a flight has one")
    for key in log.resets() & log.truth.keys():
        raise LogError(folder / "frames.csv", 0, RESET_COLUMN, f"changes within track {key}, a flight has no resets")
    result = []
    for key, frames in log.tracks().items():
        good = [f for f in frames if np.isfinite([f.t_s, *f.position_m, *f.attitude, f.height_m]).all()]
        good = list(dropwhile(lambda frame: not _shows(frame), good))
        if key in log.truth and good:
            result.append(_flight_of(log, good, log.truth[key], f"{folder.name}/{key}", kind))
    return result


def kitti_flights(folder: Path = KITTI_FOLDER) -> Iterator[Flight]:
    """Every car, as a disc at its middle; none without the folder."""
    for path in sorted(p.parent for p in Path(folder).glob("*/frames.csv")):
        for flight in from_log(path, kind="disc"):
            yield replace(flight, group="kitti", noise=KITTI_NOISE)
