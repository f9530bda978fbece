"""Reads PX4's log with pyulog.

vehicle_local_position: x, y, z, vx, vy, vz, dist_bottom; xy_reset_counter with delta_xy, z_reset_counter with delta_z
vehicle_attitude: q; quat_reset_counter
vehicle_angular_velocity: xyz; in older logs sensor_combined: gyro_rad

Jumps that no counter reports are detected from the velocity and the rates."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from ..logs.fields import LogError, warn
from .recording import LEAST_SAMPLES, Jump, Recording, Series, make_attitude, make_series
from .resets import attitude_jumps, merged, position_jumps, unexplained_m, unreported
from .ulog_file import sound

POSITION, ATTITUDE = "vehicle_local_position", "vehicle_attitude"
GYROS = (("vehicle_angular_velocity", "xyz"), ("sensor_combined", "gyro_rad"))
US = 1e-6
AGREES_M, AGREES_SHARE = 0.5, 0.2  # agreement of a reported jump with the positions around it
NEAR_S = 0.25  # a step as near as this to a reported jump is that jump

Columns = dict[str, np.ndarray]


def _topics(path: Path) -> tuple[dict[str, Columns], list[str]]:
    """Columns of the first instance of each topic, and notes about the file."""
    import pyulog  # imported here: it loads slowly, and the other formats do not need it

    names = [POSITION, ATTITUDE, *(name for name, _ in GYROS)]
    try:
        file = sound(path)
        log = pyulog.ULog(io.BytesIO(file.content), names)
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    except Exception as error:  # on unknown content pyulog raises struct, index and key errors
        raise LogError(path, 0, "", f"not a ULog file: {error}") from None
    result: dict[str, Columns] = {}
    for data in sorted(log.data_list, key=lambda one: one.multi_id):
        result.setdefault(data.name, data.data)
    for note in file.notes():
        warn(path, note)
    notes = ["the file is damaged: unreadable parts are left out"] if log.file_corruption and not file.damages else []
    if log.dropouts:
        notes.append(f"the logger lost {sum(one.duration for one in log.dropouts)} ms in {len(log.dropouts)} dropouts")
    return result, notes


def _columns(path: Path, topic: str, columns: Columns, *names: str) -> np.ndarray:
    """Columns as an array, (N, n)."""
    for name in names:
        if name not in columns:
            raise LogError(path, 0, f"{topic}.{name}", "the topic has no such field")
    return np.column_stack([columns[name].astype(float) for name in names])


def _time_s(columns: Columns) -> np.ndarray:
    """Time of the sample behind the estimate if it is logged, otherwise of its publication."""
    sampled = columns.get("timestamp_sample")
    stamps = sampled if sampled is not None and (sampled > 0).all() else columns["timestamp"]
    return stamps.astype(float) * US


def _steps(columns: Columns, counter: str) -> np.ndarray:
    """(N,) increments of an 8-bit counter since the previous sample; 0 without it."""
    if counter not in columns:
        return np.zeros(len(columns["timestamp"]), int)
    count = columns[counter].astype(int)
    return np.diff(count, prepend=count[0]) % 256


def _position_jumps(columns: Columns, time_s: np.ndarray) -> list[Jump]:
    """Jumps of both counters; if a counter increases by more than one, the size is unknown."""
    result = []
    kinds = (("xy_reset_counter", ("delta_xy[0]", "delta_xy[1]")), ("z_reset_counter", ("delta_z",)))
    for counter, deltas in kinds:
        steps = _steps(columns, counter)
        for k in np.flatnonzero(steps):
            known = all(name in columns for name in deltas) and steps[k] == 1
            size = [float(columns[name][k]) for name in deltas] if known else [np.nan]
            delta = ((*size, 0.0) if len(deltas) == 2 else (0.0, 0.0, *size)) if np.isfinite(size).all() else None
            result.append(Jump(float(time_s[k]), delta, f"{POSITION}.{counter}"))  # type: ignore[arg-type]
    return result


def _attitude_jumps(columns: Columns, time_s: np.ndarray) -> list[Jump]:
    name = "quat_reset_counter"
    return [Jump(float(time_s[k]), None, f"{ATTITUDE}.{name}") for k in np.flatnonzero(_steps(columns, name))]


def _doubts(jumps: list[Jump], position: Series, velocity: Series | None) -> list[str]:
    """Notes on jumps that differ from the positions around them."""
    if velocity is None:
        return []
    off, result = unexplained_m(position, velocity), []
    for jump in jumps:
        k = int(np.searchsorted(position.time_s, jump.time_s))
        if jump.delta_m is None or not 0 < k < len(position.time_s):
            continue
        reported = np.array(jump.delta_m)
        if np.linalg.norm(off[k - 1] - reported) > AGREES_M + AGREES_SHARE * np.linalg.norm(reported):
            words = ", ".join(f"{x:.2f}" for x in off[k - 1])
            result.append(f"the reported jump at {jump.time_s:.3f} s differs from that of the positions: {words} m")
    return result


def _gyro(path: Path, topics: dict[str, Columns]) -> Series | None:
    for topic, name in GYROS:
        if topic in topics:
            fields = [f"{name}[{i}]" for i in range(3)]
            values = _columns(path, topic, topics[topic], *fields)
            return make_series(path, f"{topic}.{name}", _time_s(topics[topic]), values)
    return None


def _clearance(path: Path, columns: Columns, time_s: np.ndarray) -> Series | None:
    if "dist_bottom" not in columns or "dist_bottom_valid" not in columns:
        return None
    good = columns["dist_bottom_valid"].astype(bool)
    if good.sum() < 2:
        return None
    return make_series(path, f"{POSITION}.dist_bottom", time_s[good], columns["dist_bottom"][good])


def read_ulog(path: Path) -> Recording:
    topics, notes = _topics(path)
    for topic in (POSITION, ATTITUDE):
        if topic not in topics:
            raise LogError(path, 0, topic, "the log has no such topic")
    place, turn = topics[POSITION], topics[ATTITUDE]
    time_s, valid = _time_s(place), np.ones(len(place["timestamp"]), bool)
    for name in ("xy_valid", "z_valid"):
        valid &= place[name].astype(bool) if name in place else True
    if valid.sum() < LEAST_SAMPLES:
        reason = f"marks {valid.sum()} of {len(valid)} samples as valid: the autopilot knew no position"
        raise LogError(path, 0, f"{POSITION}.xy_valid, z_valid", reason)
    if not valid.all():
        notes.append(f"{POSITION}: {int((~valid).sum())} samples are marked invalid and left out")
    xyz = _columns(path, POSITION, place, "x", "y", "z")
    position = make_series(path, f"{POSITION}.x, y, z", time_s[valid], xyz[valid])
    velocity = None
    if "vx" in place:
        speed = _columns(path, POSITION, place, "vx", "vy", "vz")
        velocity = make_series(path, f"{POSITION}.vx, vy, vz", time_s[valid], speed[valid])
    q = _columns(path, ATTITUDE, turn, *(f"q[{i}]" for i in range(4)))
    attitude_s = _time_s(turn)
    attitude = make_attitude(path, f"{ATTITUDE}.q", attitude_s, q)
    gyro = _gyro(path, topics)
    jumps, turns = _position_jumps(place, time_s), _attitude_jumps(turn, attitude_s)
    notes += _doubts(jumps, position, velocity)
    steps = position_jumps(position, velocity, f"{POSITION}: a step") if velocity is not None else []
    twists = attitude_jumps(attitude, gyro, f"{ATTITUDE}: a turn by") if gyro is not None else []
    unannounced = unreported(steps, jumps, NEAR_S) + unreported(twists, turns, NEAR_S)
    return Recording(
        path, position, attitude, gyro, velocity, _clearance(path, place, time_s),
        merged(jumps + turns + unannounced), notes,
    )  # fmt: skip
