"""Logs for the tests of goe_tools view: every kind that a user may bring."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
from goe_tools.logs.obslog import FEATURES, Camera, Frame, ObservationLog, read_log, write_log
from goe_tools.logs.scene import Scene, make_log

ROOT = Path(__file__).resolve().parents[2]
CORNER = ROOT / "tests" / "data" / "corner"
BUILDING = Scene(
    width_m=12.0, length_m=20.0, height_m=25.0, x0_m=-30.0, z0_m=220.0, alpha_deg=20.0, altitude_m=20.0,
    course_deg=140.0, start_ne_m=(5000.0, -3000.0), wobble_deg=1.0, run_s=8.0, fps_hz=10.0, speed_mps=20.0,
    pixel_sigma_px=0.5,
)  # fmt: skip
INVISIBLE: dict[str, None] = dict.fromkeys(FEATURES)
SHIFT_M = (3.0, -2.0, 0.5)


def boxed(frame: Frame) -> Frame:
    """The frame with the upright box around its points instead of the points."""
    points = [getattr(frame, name) for name in FEATURES]
    u, v = zip(*(point for point in points if point is not None))
    return dataclasses.replace(frame, box_px=(min(u), min(v), max(u), max(v)), **INVISIBLE)


def boxes() -> ObservationLog:
    log = make_log(BUILDING)
    return dataclasses.replace(log, frames=[boxed(frame) for frame in log.frames])


def several() -> ObservationLog:
    """A building, a chimney that comes into view later, and a truck visible in one of three images, in one flight."""
    building = make_log(dataclasses.replace(BUILDING, id=3))
    chimney = make_log(
        dataclasses.replace(BUILDING, id=11, shape="cylinder", width_m=6.0, x0_m=25.0, z0_m=260.0, seed=2)
    )
    truck = make_log(
        dataclasses.replace(BUILDING, id=7, width_m=2.5, length_m=8.0, height_m=3.5, x0_m=-5.0, z0_m=300.0, seed=3)
    )
    late = [frame for frame in chimney.frames if frame.t_s > 2.5]
    frames = sorted([*building.frames, *late, *truck.frames[::3]], key=lambda frame: frame.t_s)
    return dataclasses.replace(building, frames=frames, truth=building.truth | chimney.truth | truck.truth)


def spoiled() -> ObservationLog:
    """Rows without pose, time or valid values; one reported jump of the filter and one unreported; sides of boxes that
    are NaN; a time without detections; a class from there on."""
    log = make_log(BUILDING)
    frames = []
    for k, frame in enumerate(log.frames):
        count = 254 + (k >= 30) + (k >= 55)  # wraps
        position = tuple(p + s for p, s in zip(frame.position_m, SHIFT_M)) if k >= 30 else frame.position_m
        delta = SHIFT_M if k == 30 else None
        frames.append(dataclasses.replace(frame, position_m=position, reset_count=count, reset_delta_m=delta))
    frames[5] = dataclasses.replace(frames[5], position_m=(math.nan, 0.0, -20.0))
    frames[9] = dataclasses.replace(frames[9], t_s=math.nan)
    frames[13] = dataclasses.replace(frames[13], t_s=0.0)
    frames[17] = dataclasses.replace(frames[17], attitude=(0.0, 0.0, 0.0, 0.0))
    frames[21] = dataclasses.replace(frames[21], attitude=(1.0, math.nan, 0.0, 0.0))
    frames[24] = dataclasses.replace(frames[24], box_px=(math.nan, 1.0, 2.0, 3.0))
    frames[26] = dataclasses.replace(frames[26], position_m=(1e300, 0.0, -20.0))
    for k in range(40, 46):
        frames[k] = dataclasses.replace(frames[k], **INVISIBLE)
    for k in range(46, len(frames)):
        frames[k] = dataclasses.replace(frames[k], kind=(BUILDING.width_m, 2.0, BUILDING.height_m, 1.0, 2))
    return dataclasses.replace(log, frames=frames)


def moving() -> ObservationLog:
    """The building moves along, because the camera's logged positions include a sideways motion."""
    log = make_log(BUILDING)
    frames = [
        dataclasses.replace(frame, position_m=(n + 3.0 * frame.t_s, e + 4.0 * frame.t_s, d))
        for frame in log.frames
        for n, e, d in [frame.position_m]
    ]
    return dataclasses.replace(log, frames=frames, truth={1: dataclasses.replace(log.truth[1], static=False)})


def two_cameras(camera: Camera) -> ObservationLog:
    """Every second half of a second another camera takes the images. It looks more to the left, through another
    lens."""
    first = make_log(dataclasses.replace(BUILDING, camera=camera))
    other = dataclasses.replace(camera, mount_yaw_deg=camera.mount_yaw_deg - 20.0, k1=0.0, k2=0.0, offset_y_m=-0.5)
    second = make_log(dataclasses.replace(BUILDING, camera=other))
    frames = [
        dataclasses.replace(b, camera=1) if int(2.0 * a.t_s) % 2 else a for a, b in zip(first.frames, second.frames)
    ]
    return dataclasses.replace(first, frames=frames, camera2=other)


def nothing_answered() -> ObservationLog:
    """The detector finds nothing."""
    log = make_log(BUILDING)
    return dataclasses.replace(log, frames=[dataclasses.replace(frame, **INVISIBLE) for frame in log.frames])


def one_frame() -> ObservationLog:
    log = read_log(CORNER)
    return dataclasses.replace(log, frames=log.frames[:1])


def long(rows: int = 10_000) -> ObservationLog:
    """A plate of 6 m by 30 m, 30 m to the left, approached at 20 m/s from 2200 m."""
    camera, frames = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0), []
    for k in range(rows):
        t_s = 100.0 * k / rows
        u, v = 914.0 * np.array([-33.0, -27.0]) / (2200.0 - 20.0 * t_s), 914.0 * 15.0 / (2200.0 - 20.0 * t_s)
        box = (640.0 + float(u[0]), 640.0 - v, 640.0 + float(u[1]), 640.0 + v)
        frames.append(Frame(t_s, 1, (20.0 * t_s, 0.0, -15.0), (1.0, 0.0, 0.0, 0.0), box_px=box))
    return ObservationLog(camera, frames)


def written(log: ObservationLog, folder: Path) -> Path:
    write_log(folder, log)
    return folder
