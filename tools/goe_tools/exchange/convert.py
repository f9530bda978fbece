"""Converts an autopilot's log and a detector's table to an observation log.

    python -m goe_tools convert --ulog FILE --detections FILE --camera FILE --out LOG

Each row of the detector gets the pose at the time of exposure: attitudes by spherical, positions by linear
interpolation between two samples. The result uses the autopilot's time."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..flights.rotations import matrices
from ..logs.fields import LogError, warn
from ..logs.numbers import finite, positive
from ..logs.obslog import Camera, Frame, ObservationLog, read_cameras
from ..logs.own_log import write_own_log
from .dataflash import read_dataflash
from .detections import read_detections, sees
from .doubts import doubt_of_attitude, doubt_of_height, doubt_of_velocity, doubts_of_boxes, hints_on_conventions
from .offset import Searched, found_offset, spans, warn_of_few
from .recording import Poses, Recording, check_size
from .tlog import read_tlog
from .ulog import read_ulog

HEIGHTS = ("origin", "sensor")
GAP_S = 0.5
REACH_S = 0.5
REPORTED_JUMPS, REPORTED_IMAGES = 20, 5  # printed one by one


@dataclass(frozen=True)
class Wish:
    """Options for the poses. ``ground_d_m``: of the obstacle's ground, with ``height`` "origin"."""

    height: str = HEIGHTS[0]
    ground_d_m: float = 0.0
    gap_s: float = GAP_S


@dataclass
class Converted:
    frames: list[Frame]
    left_out: list[tuple[float, int, str]]  # autopilot's time, id, reason


def _jump_since(poses: Poses, before: int, now: int) -> tuple[float, float, float] | None:
    """Sum of the jumps from number ``before`` to number ``now``; None if one of them is unknown."""
    deltas = [jump.delta_m for jump in poses.recording.jumps[before:now]]
    if any(delta is None for delta in deltas):
        return None
    total = np.sum([delta for delta in deltas if delta is not None], 0)
    return tuple(float(value) for value in total)  # type: ignore[return-value]


def _why_not(poses: Poses, time_s: float) -> str:
    for series in (poses.recording.position, poses.recording.attitude):
        if not series.time_s[0] <= time_s <= series.time_s[-1]:
            return f"{series.name} is logged from {series.time_s[0]:.3f} s to {series.time_s[-1]:.3f} s"
    for cut in poses.cuts_s:
        if abs(cut - time_s) < GAP_S:
            return f"the filter jumped between the samples around it, at {cut:.3f} s"
    return "the gap between its logged poses is too long"


def add_poses(
    frames: Sequence[Frame], cameras: Sequence[Camera], poses: Poses, offset_s: float, wish: Wish
) -> Converted:
    """The rows with their poses; leaves out rows without a pose in the autopilot's log."""
    time_s = np.array([frame.t_s for frame in frames]) + offset_s
    position, attitude, count = poses.position_m(time_s), poses.attitude(time_s), poses.count(time_s)
    good, turn = poses.good(time_s, wish.gap_s), matrices(attitude)
    ground = np.full(len(frames), wish.ground_d_m)
    if wish.height == "sensor":
        measured = poses.ground_d_m(time_s)
        if measured is None:
            raise LogError(poses.recording.path, 0, "", "no sensor of the height above ground was logged")
        ground = measured
    result, counted = Converted([], []), {}
    for k, frame in enumerate(frames):
        if not good[k]:
            result.left_out.append((float(time_s[k]), frame.id, _why_not(poses, float(time_s[k]))))
            continue
        camera = cameras[frame.camera]
        arm = turn[k] @ np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
        before = counted.get(frame.id, int(count[k]))
        counted[frame.id] = int(count[k])
        result.frames.append(
            replace(
                frame,
                t_s=float(time_s[k]),
                position_m=tuple(float(x) for x in position[k]),  # type: ignore[arg-type]
                attitude=tuple(float(x) for x in attitude[k]),  # type: ignore[arg-type]
                agl_m=float(ground[k] - position[k, 2] - arm[2]),
                reset_count=int(count[k]),
                reset_delta_m=_jump_since(poses, before, int(count[k])) if count[k] != before else None,
            )
        )
    return result


# ------------------------------------------------------------------------------------------------------- the command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--ulog", type=Path, metavar="FILE", help="PX4's log")
    source.add_argument("--dataflash", type=Path, metavar="FILE", help="ArduPilot's log (.bin)")
    source.add_argument("--tlog", type=Path, metavar="FILE", help="a ground station's log of MAVLink messages")
    add("--detections", type=Path, required=True, metavar="CSV", help="t_s, id and the columns of frames.csv for boxes")
    add("--camera", type=Path, required=True, metavar="INI", help="camera.ini of the new log")
    add("--out", type=Path, required=True, metavar="LOG", help="folder to write; an earlier result there is replaced")
    add("--offset", type=finite, metavar="S", help="the autopilot's time minus t_s (default: estimated)")
    add("--about", type=finite, default=0.0, metavar="S", help="center of the offset search (default 0)")
    add("--within", type=positive, default=REACH_S, metavar="S", help=f"half its length (default {REACH_S:g})")
    add("--height", choices=HEIGHTS, default=HEIGHTS[0], help="above ground: from --ground (default), or measured")
    add("--ground", type=finite, default=0.0, metavar="D", help="down coordinate of the obstacle's ground (default 0)")
    add("--gap", type=positive, default=GAP_S, metavar="S", help=f"longest time between poses (default {GAP_S:g})")
    add("--system", type=int, metavar="N", help="system number of the autopilot in a tlog (default: the first)")


def _read(arguments: argparse.Namespace) -> Recording:
    check_size(arguments.ulog or arguments.dataflash or arguments.tlog)
    if arguments.ulog is not None:
        return read_ulog(arguments.ulog)
    if arguments.dataflash is not None:
        return read_dataflash(arguments.dataflash)
    return read_tlog(arguments.tlog, arguments.system)


def _report_recording(recording: Recording) -> None:
    series = [recording.position, recording.attitude, recording.gyro, recording.clearance]
    for one in series:
        if one is not None:
            print(f"{one.name}: {one.time_s[0]:.3f} to {one.time_s[-1]:.3f} s, {one.rate_hz:.1f} Hz")
    for note in recording.notes:
        print(note)
    for jump in recording.jumps[:REPORTED_JUMPS]:
        size = "the track is split" if jump.delta_m is None else ", ".join(f"{x:+.2f}" for x in jump.delta_m) + " m"
        print(f"reset at {jump.time_s:.3f} s, {jump.cause}: {size}")
    if len(recording.jumps) > REPORTED_JUMPS:
        print(f"... and {len(recording.jumps) - REPORTED_JUMPS} more resets")


def _warn_of_doubts(poses: Poses, height: str, ground_d_m: float) -> None:
    """Signals of the log that contradict each other."""
    doubts = [doubt_of_velocity(poses.recording), doubt_of_attitude(poses.recording), *hints_on_conventions(poses)]
    if height == HEIGHTS[0]:
        doubts.append(doubt_of_height(poses, ground_d_m))
    for doubt in doubts:
        if doubt:
            warn(poses.recording.path, doubt)


def _report(result: Converted) -> None:
    images: dict[tuple[float, str], list[int]] = {}
    for time_s, key, reason in result.left_out:
        images.setdefault((time_s, reason), []).append(key)
    printed = 0
    for (time_s, reason), keys in itertools.islice(images.items(), REPORTED_IMAGES):
        word = "id" if len(keys) == 1 else "ids"
        print(f"left out: row at {time_s:.3f} s, {word} {', '.join(map(str, keys))}: {reason}")
        printed += len(keys)
    if len(result.left_out) > printed:
        print(f"... and {len(result.left_out) - printed} more rows are left out")
    for key in sorted({frame.id for frame in result.frames}):
        rows = [frame for frame in result.frames if frame.id == key]
        resets = rows[-1].reset_count - rows[0].reset_count
        print(f"id {key}: {len(rows)} rows, {sum(map(sees, rows))} with a detection, {resets} resets")


def run(arguments: argparse.Namespace) -> int:
    cameras = read_cameras(arguments.camera)
    frames = read_detections(arguments.detections, len(cameras))
    for doubt in doubts_of_boxes(frames, cameras):
        warn(arguments.detections, doubt)
    recording = _read(arguments)
    _report_recording(recording)
    poses = Poses(recording)
    _warn_of_doubts(poses, arguments.height, arguments.ground)
    offset_s = arguments.offset
    if offset_s is None:
        searched = Searched(arguments.about, arguments.within, arguments.gap)
        offset_s = found_offset(arguments.detections, frames, cameras, poses, searched)
    result = add_poses(frames, cameras, poses, offset_s, Wish(arguments.height, arguments.ground, arguments.gap))
    _report(result)
    if not result.frames:
        reason = f"no row has a pose: {spans(frames, recording, offset_s)}"
        raise LogError(arguments.detections, 0, "t_s", reason)
    warn_of_few(arguments.detections, len(result.frames), frames, recording, offset_s)
    log = ObservationLog(cameras[0], result.frames, camera2=cameras[1] if len(cameras) > 1 else None)
    comment = f"{recording.path.name} and {arguments.detections.name}, t_s {offset_s:+.6f} s"
    write_own_log(arguments.out, log, comment, [arguments.camera, arguments.detections, recording.path])
    print(f"{arguments.out}: {len(result.frames)} rows")
    return 0
