"""Reads a ground station's log of MAVLink messages with pymavlink.

Position: LOCAL_POSITION_NED, otherwise GLOBAL_POSITION_INT, otherwise ODOMETRY. Attitude: the more frequent of
ATTITUDE_QUATERNION and ATTITUDE, otherwise ODOMETRY. Height: a DISTANCE_SENSOR that looks down. Times are the
autopilot's time_boot_ms (ODOMETRY: time_usec). Only ODOMETRY reports resets; other jumps are detected from the velocity
and the rates."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..flights.rotations import quaternions
from ..logs.fields import LogError
from .recording import Jump, Recording, Series, made_upright, make_attitude, make_series
from .resets import attitude_jumps, merged, position_jumps

WANTED = (
    "HEARTBEAT", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "ODOMETRY", "ATTITUDE", "ATTITUDE_QUATERNION",
    "DISTANCE_SENSOR",
)  # fmt: skip
NO_AUTOPILOT = 8  # HEARTBEAT.autopilot: a camera, a ground station
DOWNWARD = 25  # DISTANCE_SENSOR.orientation
LOCAL_NED, BODY_FRD = 1, 12  # ODOMETRY.frame_id, child_frame_id
MS, US, CM, MM = 1e-3, 1e-6, 1e-2, 1e-3
DEG_E7 = 1e-7
EARTH_M = 6371000.8  # mean radius: errors of short distances are at most 0.6 %
System = tuple[int, int]
Messages = dict[str, list]


def _read(path: Path, system: int | None) -> tuple[Messages, System]:
    """Messages of one autopilot, by name, and its number and component."""
    from pymavlink import mavutil  # imported here: the other formats do not need it

    try:
        if path.is_dir():
            raise LogError(path, 0, "", "is a folder")
        log = mavutil.mavlogfile(str(path))
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    by_system: dict[System, Messages] = {}
    autopilots: list[System] = []
    while True:
        try:
            message = log.recv_match(type=list(WANTED))
        except Exception as error:  # in a damaged file
            raise LogError(path, 0, "", f"damaged: {error}") from None
        if message is None:
            break
        source = (message.get_srcSystem(), message.get_srcComponent())
        name = message.get_type()
        if name == "HEARTBEAT" and message.autopilot != NO_AUTOPILOT and source not in autopilots:
            autopilots.append(source)
        by_system.setdefault(source, {}).setdefault(name, []).append(message)
    log.close()
    if system is not None:
        autopilots = [source for source in autopilots if source[0] == system]
    if not autopilots:
        of = "" if system is None else f" of system {system}"
        raise LogError(path, 0, "HEARTBEAT", f"the log has none{of} from an autopilot; is it a tlog?")
    return by_system[autopilots[0]], autopilots[0]


def _columns(messages: list, *fields: str) -> np.ndarray:
    return np.array([[getattr(message, field) for field in fields] for message in messages], float)


def _of(path: Path, messages: Messages, name: str, unit: float, stamp: str, fields: str) -> Series:
    names = fields.split()
    time_s = _columns(messages[name], stamp)[:, 0] * (US if stamp == "time_usec" else MS)
    return make_series(path, f"{name}.{', '.join(names)}", time_s, _columns(messages[name], *names) * unit)


def _local(path: Path, messages: Messages) -> Series:
    """GLOBAL_POSITION_INT relative to its first fix."""
    name = "GLOBAL_POSITION_INT"
    series = _of(path, messages, name, 1.0, "time_boot_ms", "lat lon relative_alt")
    lat, lon = np.radians(series.value[:, :2] * DEG_E7).T
    north = EARTH_M * (lat - lat[0])
    east = EARTH_M * math.cos(lat[0]) * (lon - lon[0])
    return Series(series.name, series.time_s, np.column_stack([north, east, -series.value[:, 2] * MM]))


def _position(path: Path, messages: Messages) -> tuple[Series, Series | None, list[Jump]]:
    """Position and velocity, NED, and reported jumps."""
    if "LOCAL_POSITION_NED" in messages:
        name = "LOCAL_POSITION_NED"
        return (
            _of(path, messages, name, 1.0, "time_boot_ms", "x y z"),
            _of(path, messages, name, 1.0, "time_boot_ms", "vx vy vz"), [],
        )  # fmt: skip
    if "GLOBAL_POSITION_INT" in messages:
        velocity = _of(path, messages, "GLOBAL_POSITION_INT", CM, "time_boot_ms", "vx vy vz")
        return _local(path, messages), velocity, []
    if "ODOMETRY" in messages:
        position = _of(path, messages, "ODOMETRY", 1.0, "time_usec", "x y z")
        return position, None, _odometry_jumps(messages)
    raise LogError(path, 0, "LOCAL_POSITION_NED", "the log has none, and no GLOBAL_POSITION_INT or ODOMETRY")


def _odometry_jumps(messages: Messages) -> list[Jump]:
    rows = messages["ODOMETRY"]
    count = [int(row.reset_counter) for row in rows]
    return [
        Jump(float(rows[k].time_usec) * US, None, "ODOMETRY.reset_counter")
        for k in range(1, len(rows))
        if count[k] != count[k - 1]
    ]


def _attitude(path: Path, messages: Messages) -> tuple[Series, Series]:
    """Attitude and body rates."""
    rates = "rollspeed pitchspeed yawspeed"
    euler, direct = (len(messages.get(name, ())) for name in ("ATTITUDE", "ATTITUDE_QUATERNION"))
    if direct and direct >= euler:
        name = "ATTITUDE_QUATERNION"
        series = _of(path, messages, name, 1.0, "time_boot_ms", "q1 q2 q3 q4")
        q = series.value
    elif euler:
        name = "ATTITUDE"
        series = _of(path, messages, name, 1.0, "time_boot_ms", "roll pitch yaw")
        roll, pitch, yaw = series.value.T
        q = quaternions(yaw, pitch, roll)
    elif "ODOMETRY" in messages:
        name, stamp = "ODOMETRY", "time_usec"
        rows = messages[name]
        series = make_series(path, f"{name}.q", _columns(rows, stamp)[:, 0] * US, np.array([row.q for row in rows]))
        return (
            make_attitude(path, series.name, series.time_s, series.value),
            _of(path, messages, name, 1.0, stamp, rates),
        )
    else:
        raise LogError(path, 0, "ATTITUDE", "the log has none, and no ATTITUDE_QUATERNION or ODOMETRY")
    return make_attitude(path, series.name, series.time_s, q), _of(path, messages, name, 1.0, "time_boot_ms", rates)


def _clearance(path: Path, messages: Messages, attitude: Series) -> Series | None:
    rows = [row for row in messages.get("DISTANCE_SENSOR", ()) if row.orientation == DOWNWARD]
    rows = [row for row in rows if row.min_distance <= row.current_distance <= row.max_distance]
    if len(rows) < 2:
        return None
    series = _of(path, {"DISTANCE_SENSOR": rows}, "DISTANCE_SENSOR", CM, "time_boot_ms", "current_distance")
    return made_upright(series, attitude)


def _check_frames(path: Path, messages: Messages) -> None:
    """Checks the frames of ODOMETRY if it is used."""
    alone = not {"LOCAL_POSITION_NED", "GLOBAL_POSITION_INT"} & messages.keys()
    alone |= not {"ATTITUDE", "ATTITUDE_QUATERNION"} & messages.keys()
    for row in messages.get("ODOMETRY", ()) if alone else ():
        if (row.frame_id, row.child_frame_id) != (LOCAL_NED, BODY_FRD):
            at, frames = row.time_usec * US, f"{row.frame_id}, {row.child_frame_id}"
            raise LogError(
                path, 0, "ODOMETRY.frame_id", f"frames {frames} at {at:.6f} s; supported: {LOCAL_NED}, {BODY_FRD}"
            )


def read_tlog(path: Path, system: int | None = None) -> Recording:
    """``system``: number of the autopilot; by default the first that sends a heartbeat."""
    messages, source = _read(path, system)
    _check_frames(path, messages)
    position, velocity, jumps = _position(path, messages)
    attitude, gyro = _attitude(path, messages)
    if velocity is not None:
        jumps = jumps + position_jumps(position, velocity, f"{position.name}: a step")
    jumps = jumps + attitude_jumps(attitude, gyro, f"{attitude.name}: a turn by")
    notes = [f"system {source[0]}, component {source[1]}"]
    clearance = _clearance(path, messages, attitude)
    return Recording(path, position, attitude, gyro, velocity, clearance, merged(jumps), notes)
