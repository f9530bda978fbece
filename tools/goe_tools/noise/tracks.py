"""The tracks of logs as flights, with or without the truth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import dropwhile
from pathlib import Path

import numpy as np

from ..flights.flight import Flight, Obstacle
from ..flights.logged import from_log
from ..flights.noise import Noise
from ..flights.rotations import level_axes, matrices
from ..logs.obslog import Camera, Frame, LogError, Truth, read_log


def _flight_of(camera: Camera, frames: Sequence[Frame], truth: Truth | None, name: str) -> Flight:
    """A flight with boxes; the reference point of the truth is the middle of the base."""
    attitude = np.array([frame.attitude for frame in frames])
    position = np.array([frame.position_m for frame in frames])
    forward = matrices(attitude[0])[:, 0]
    heading = math.degrees(math.atan2(forward[1], forward[0])) if camera.heading_deg is None else camera.heading_deg
    offset = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
    eye = position[0] + matrices(attitude[0]) @ offset
    obstacle = Obstacle("box", *[math.nan] * 6)
    if truth is not None:
        way = np.array([truth.center_n_m, truth.center_e_m]) - eye[:2]
        x0, z0 = level_axes(math.radians(heading))[[0, 2], :2] @ way
        kind, length = ("disc", truth.width_m) if truth.length_m is None else ("box", truth.length_m)
        obstacle = Obstacle(kind, float(x0), float(z0), math.nan, truth.width_m, length, truth.height_m, truth.static)
    none = (math.nan,) * 4
    boxes = [[math.nan if side is None else side for side in frame.box_px or none] for frame in frames]
    return Flight(
        name, "", replace(camera, heading_deg=heading), np.array([frame.t_s for frame in frames]),
        np.zeros((len(frames), 6, 2)), np.zeros((len(frames), 6), bool), position, attitude,
        np.array([frame.height_m for frame in frames]), obstacle, Noise(), box_px=np.array(boxes),
        image_size_px=(camera.width, camera.height),
    )  # fmt: skip


def _whole(frame: Frame) -> bool:
    return bool(np.isfinite([frame.t_s, *frame.position_m, *frame.attitude, frame.height_m]).all())


def box_tracks(folder: Path) -> Iterator[tuple[Flight, bool]]:
    """A flight for each track with boxes, split at resets of the autopilot's filter, and whether its truth is known.
    Leaves out tracks with a moving truth, images with a bad pose, and those before the first box, where the library's
    track starts."""
    log = read_log(folder)
    if log.camera2 is not None:
        raise LogError(folder / "camera.ini", 0, "camera2", "a second camera; noise is fitted to one camera")
    for key, frames in log.tracks().items():
        truth = log.truth.get(key)
        if truth is not None and not truth.static:
            continue
        good = [frame for frame in frames if _whole(frame)]
        for count in dict.fromkeys(frame.reset_count for frame in good):
            part = [frame for frame in good if frame.reset_count == count]
            part = list(dropwhile(lambda frame: frame.box_px is None, part))
            if part:
                known = truth is not None and math.isfinite(truth.center_n_m) and count == good[0].reset_count
                yield _flight_of(log.camera, part, truth if known else None, f"{folder.name}/{key}"), known


def point_tracks(folder: Path) -> Iterator[Flight]:
    """A flight for each track with points, a known truth and a static obstacle."""
    for flight in from_log(folder):
        if flight.truth.static and flight.seen.any():
            yield flight
