"""Flight logs past masts in the autopilots' formats, with a detector's table: input for the tests of the converter.

This module writes the ULog and DataFlash files by their published layouts; pymavlink writes the tlog."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from goe_tools.flights.boxes import correlated
from goe_tools.flights.rotations import euler, matrices, mounting, multiply, quaternions, small_rotations
from goe_tools.flights.scene import project
from goe_tools.logs.obslog import Camera, write_camera

START_S = 20.0  # autopilot's clock at the first sample
SPEED_M_S = 17.0
HEIGHT_M = 20.0
ARM_M = (0.3, -0.1, 0.05)
CAMERA = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0, mount_pitch_deg=-3.0, mount_yaw_deg=-4.0,
                offset_x_m=ARM_M[0], offset_y_m=ARM_M[1], offset_z_m=ARM_M[2])  # fmt: skip
MASTS = {4: (210.0, -14.0), 9: (260.0, 20.0)}  # id: m north and east of the middle
MAST_M = (3.0, 25.0)  # radius, height


@dataclass
class Fault:
    """A reset of the autopilot's filter at ``time_s``: a jump of its position (NED, m) or of its yaw (deg)."""

    time_s: float
    delta_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    yaw_deg: float = 0.0


@dataclass
class Flown:
    """``roll_deg`` is the amplitude of a roll oscillation at 0.4 Hz, ``rate_hz`` the rate of the logged pose."""

    seconds: float = 11.0
    roll_deg: float = 10.0
    rate_hz: float = 50.0
    gyro_hz: float = 100.0
    faults: list[Fault] = field(default_factory=list)

    def angles(self, t: np.ndarray) -> tuple[np.ndarray, ...]:
        """Yaw, pitch and roll in rad at the times ``t`` since the start."""
        yaw = np.radians(0.7) * np.sin(2 * math.pi * t / 2.3 + 0.4)
        pitch = np.radians(2.0) + np.radians(0.7) * np.sin(2 * math.pi * t / 3.1 + 1.1)
        return yaw, pitch, math.radians(self.roll_deg) * np.sin(2 * math.pi * 0.4 * t + 2.0)

    def position(self, t: np.ndarray) -> np.ndarray:
        return np.stack([SPEED_M_S * t, 0.5 * np.sin(0.7 * t), -HEIGHT_M - 0.3 * np.cos(0.5 * t)], 1)

    def velocity(self, t: np.ndarray) -> np.ndarray:
        return np.stack([np.full(len(t), SPEED_M_S), 0.35 * np.cos(0.7 * t), 0.15 * np.sin(0.5 * t)], 1)

    def rates(self, t: np.ndarray) -> np.ndarray:
        """Body rates, (N, 3), rad/s."""
        h = 1e-4
        before, after = quaternions(*self.angles(t - h)), quaternions(*self.angles(t + h))
        return multiply(before * [1.0, -1.0, -1.0, -1.0], after)[:, 1:] / h

    def logged_position(self, t: np.ndarray) -> np.ndarray:
        result = self.position(t)
        for fault in self.faults:
            result[t >= fault.time_s - START_S - 1e-9] += fault.delta_m
        return result

    def logged_attitude(self, t: np.ndarray) -> np.ndarray:
        result = quaternions(*self.angles(t))
        for fault in self.faults:
            turn = np.array(
                [[math.cos(math.radians(fault.yaw_deg) / 2), 0, 0, math.sin(math.radians(fault.yaw_deg) / 2)]]
            )
            late = t >= fault.time_s - START_S - 1e-9
            result[late] = multiply(np.repeat(turn, late.sum(), 0), result[late])
        return result

    def count(self, t: np.ndarray, yaw: bool) -> np.ndarray:
        """Number of position or yaw faults up to each time, (N,)."""
        kinds = [f for f in self.faults if (f.yaw_deg != 0.0) == yaw]
        return np.sum([t >= f.time_s - START_S - 1e-9 for f in kinds], 0) if kinds else np.zeros(len(t), int)

    def grid(self, rate_hz: float) -> np.ndarray:
        return np.arange(round(self.seconds * rate_hz) + 1) / rate_hz


def write_detections(folder: Path, flown: Flown, offset_s: float, seed: int = 1, images: Sequence[int] = (8, 80),
                     share: float = 0.04, ids: Sequence[int] = tuple(MASTS)) -> tuple[Path, Path]:  # fmt: skip
    """Writes detections.csv and camera.ini at eight images a second. ``behind_s``: how far its clock is behind the
    autopilot's."""
    rng, t = np.random.default_rng(seed), np.arange(*images) / 8.0
    angle = np.arange(128) * (2 * math.pi / 128)
    lines = ["t_s,id,box_left_px,box_top_px,box_right_px,box_bottom_px,score"]
    turn = euler(*flown.angles(t))
    eye = flown.position(t) + np.einsum("kij,j->ki", turn, np.array(ARM_M))
    for key in ids:
        north, east = MASTS[key]
        rim = np.array([north, east]) + MAST_M[0] * np.stack([np.cos(angle), np.sin(angle)], 1)
        points = np.concatenate([np.column_stack([rim, np.full(len(rim), down)]) for down in (0.0, -MAST_M[1])])
        pixel = project(CAMERA, turn @ mounting(CAMERA), eye, np.broadcast_to(points, (len(t), *points.shape)))
        box = np.concatenate([pixel.min(1), pixel.max(1)], 1)
        size = np.tile(box[:, 2:] - box[:, :2], 2)
        box = box + share * size * correlated(t, 1.0, 4, rng) + 0.5 * rng.standard_normal(box.shape)
        for time_s, sides in zip(t, box):
            inside = np.isfinite(sides).all() and sides.min() > 20.0 and sides.max() < CAMERA.width - 20.0
            if inside:
                lines.append(f"{float(time_s + START_S - offset_s)!r},{key},{','.join(f'{x:.2f}' for x in sides)},0.9")
    table, camera = folder / "detections.csv", folder / "camera.ini"
    table.write_text("\n".join(lines) + "\n")
    write_camera(camera, CAMERA)
    return table, camera


# ---------------------------------------------------------------------------------------------------------------- ULog

ULOG_TYPES = {"uint64_t": "Q", "float": "f", "uint8_t": "B", "bool": "?"}


def write_ulog(path: Path, topics: dict[str, list[tuple[str, str, np.ndarray]]]) -> Path:
    """Writes topics: name, then (type, field name, values of shape (N,) or (N, n)). The first field is the time stamp
    in us."""

    def message(kind: str, body: bytes) -> bytes:
        return struct.pack("<HB", len(body), ord(kind)) + body

    out = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0) + message("B", bytes(40))
    data = []
    for number, (name, columns) in enumerate(topics.items()):
        wide = [values.shape[1] if values.ndim == 2 else 0 for _, _, values in columns]
        format_fields = [
            f"{kind}[{n}] {field}" if n else f"{kind} {field}" for (kind, field, _), n in zip(columns, wide)
        ]
        out += message("F", f"{name}:{';'.join(format_fields)};".encode())
        layout = "<H" + "".join(ULOG_TYPES[kind] * max(n, 1) for (kind, _, _), n in zip(columns, wide))
        for k in range(len(columns[0][2])):
            row: list[object] = []
            for kind, _, values in columns:
                parts = np.atleast_1d(values[k]).tolist()
                row += [float(x) if kind == "float" else int(x) for x in parts]
            data.append((int(columns[0][2][k]), message("D", struct.pack(layout, number, *row))))
    for number, name in enumerate(topics):
        out += message("A", struct.pack("<BH", 0, number) + name.encode())
    path.write_bytes(out + b"".join(body for _, body in sorted(data, key=lambda one: one[0])))
    return path


def ulog_topics(flown: Flown) -> dict[str, list[tuple[str, str, np.ndarray]]]:
    """The topics that PX4 logs in a flight. Stamps are 3 ms after the samples."""

    def stamps(t: np.ndarray) -> list[tuple[str, str, np.ndarray]]:
        us = np.rint((t + START_S) * 1e6).astype(np.int64)
        return [("uint64_t", "timestamp", us + 3000), ("uint64_t", "timestamp_sample", us)]

    t, rates_t = flown.grid(flown.rate_hz), flown.grid(flown.gyro_hz)
    place, speed = flown.logged_position(t), flown.velocity(t)
    count = flown.count(t, yaw=False)
    delta = np.zeros((len(t), 3))
    for fault in flown.faults:
        if fault.yaw_deg == 0.0:
            delta[t >= fault.time_s - START_S - 1e-9] = fault.delta_m
    flat = any(f.delta_m[0] or f.delta_m[1] for f in flown.faults)
    down = any(f.delta_m[2] for f in flown.faults)
    zero, yes = np.zeros(len(t), int), np.ones(len(t), int)
    return {
        "vehicle_local_position": [
            *stamps(t), *(("float", name, place[:, i]) for i, name in enumerate("xyz")),
            *(("float", f"v{name}", speed[:, i]) for i, name in enumerate("xyz")),
            ("float", "delta_xy", delta[:, :2]), ("float", "delta_z", delta[:, 2]),
            ("float", "dist_bottom", -flown.position(t)[:, 2] + 2.0),
            ("uint8_t", "xy_reset_counter", 250 + count if flat else zero + 250),
            ("uint8_t", "z_reset_counter", 3 + count if down else zero + 3),
            ("bool", "xy_valid", yes), ("bool", "z_valid", yes), ("bool", "dist_bottom_valid", yes),
        ],
        "vehicle_attitude": [
            *stamps(t), ("float", "q", flown.logged_attitude(t)),
            ("uint8_t", "quat_reset_counter", flown.count(t, yaw=True)),
        ],
        "vehicle_angular_velocity": [*stamps(rates_t), ("float", "xyz", flown.rates(rates_t))],
    }  # fmt: skip


# ----------------------------------------------------------------------------------------------------------- DataFlash

DATAFLASH_TYPES = {"Q": "Q", "B": "B", "f": "f", "M": "B", "b": "b"}


def write_dataflash(path: Path, messages: dict[str, tuple[str, str, list[tuple[object, ...]]]]) -> Path:
    """Writes messages: name, then format characters, column names and rows. The first column is TimeUS."""
    out, data = b"", []

    def described(number: int, length: int, name: str, kinds: str, columns: str) -> bytes:
        texts = [text.encode().ljust(n, b"\0") for text, n in ((name, 4), (kinds, 16), (columns, 64))]
        return b"\xa3\x95\x80" + struct.pack("<BB", number, length) + b"".join(texts)

    out += described(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
    for number, (name, (kinds, columns, rows)) in enumerate(messages.items(), start=129):
        layout = "<" + "".join(DATAFLASH_TYPES[kind] for kind in kinds)
        out += described(number, 3 + struct.calcsize(layout), name, kinds, columns)
        data += [(row[0], bytes([0xA3, 0x95, number]) + struct.pack(layout, *row)) for row in rows]
    path.write_bytes(out + b"".join(body for _, body in sorted(data, key=lambda one: one[0])))  # type: ignore[arg-type,return-value]
    return path


def dataflash_messages(flown: Flown) -> dict[str, tuple[str, str, list[tuple[object, ...]]]]:
    """The messages that ArduPilot logs in a flight with two cores. The second core is primary; the first is off by 7
    m."""
    t, rates_t, slow = flown.grid(flown.rate_hz), flown.grid(flown.gyro_hz), flown.grid(10.0)
    place, speed, q = flown.logged_position(t), flown.velocity(t), flown.logged_attitude(t)

    def us(time: np.ndarray) -> list[int]:
        return [int(x) for x in np.rint((time + START_S) * 1e6)]

    format_fields = np.zeros((len(slow), 2))
    for fault in flown.faults:
        if fault.yaw_deg == 0.0:
            format_fields[slow >= fault.time_s - START_S - 1e-9] = fault.delta_m[:2]
    cores = [(0, 7.0), (1, 0.0)]
    return {
        "XKF1": ("QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD", [
            (us_k, core, *speed[k], *(place[k] + off)) for k, us_k in enumerate(us(t)) for core, off in cores]),
        "XKQ": ("QBffff", "TimeUS,C,Q1,Q2,Q3,Q4", [
            (us_k, core, *(q[k] if core else (1.0, 0.0, 0.0, 0.0)))
            for k, us_k in enumerate(us(t)) for core, _ in cores]),
        "XKF4": ("QBffb", "TimeUS,C,OFN,OFE,PI", [(us_k, 0, *format_fields[k], 1) for k, us_k in enumerate(us(slow))]),
        "IMU": ("QBfff", "TimeUS,I,GyrX,GyrY,GyrZ", [
            (us_k, 0, *row) for us_k, row in zip(us(rates_t), flown.rates(rates_t))]),
        "RFND": ("QBfBB", "TimeUS,Instance,Dist,Stat,Orient", [
            (us_k, 0, (-flown.position(slow)[k, 2] + 2.0) / matrices(flown.logged_attitude(slow))[k, 2, 2], 4, 25)
            for k, us_k in enumerate(us(slow))]),
    }  # fmt: skip


# ---------------------------------------------------------------------------------------------------------------- tlog


def write_tlog(path: Path, flown: Flown, odometry: bool = False) -> Path:
    """Writes the log of a ground station. It also contains a camera's heartbeat and another system's position."""
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    def sender(system: int, component: int) -> mavlink.MAVLink:
        return mavlink.MAVLink(None, srcSystem=system, srcComponent=component)

    own, camera, other = sender(1, 1), sender(1, 100), sender(7, 1)
    t = flown.grid(flown.rate_hz)
    place, speed, rates, q = flown.logged_position(t), flown.velocity(t), flown.rates(t), flown.logged_attitude(t)
    yaw, pitch, roll = flown.angles(t)
    with path.open("wb") as file:

        def put(of: mavlink.MAVLink, time_s: float, message: mavlink.MAVLink_message) -> None:
            stamp = struct.pack(">Q", int((1.7e9 + time_s) * 1e6))
            file.write(stamp + message.pack(of))

        put(camera, 0.0, mavlink.MAVLink_heartbeat_message(30, 8, 0, 0, 0, 3))
        put(own, 0.0, mavlink.MAVLink_heartbeat_message(1, 3, 0, 0, 0, 3))
        for k, time_s in enumerate(t + START_S):
            ms = round(time_s * 1e3)
            if odometry:
                none = [math.nan] * 21
                put(own, time_s, mavlink.MAVLink_odometry_message(
                    round(time_s * 1e6), 1, 12, *place[k], q[k], *speed[k], *rates[k], none, none,
                    int(flown.count(t, yaw=False)[k] + 255) % 256, 0))  # fmt: skip
                continue
            put(own, time_s, mavlink.MAVLink_attitude_message(ms, roll[k], pitch[k], yaw[k], *rates[k]))
            put(own, time_s, mavlink.MAVLink_local_position_ned_message(ms, *place[k], *speed[k]))
            put(other, time_s, mavlink.MAVLink_local_position_ned_message(ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return path


def noisy(quaternion: np.ndarray, sigma_deg: float, seed: int) -> np.ndarray:
    """Attitudes with an independent error in each."""
    turns = np.radians(sigma_deg) * np.random.default_rng(seed).standard_normal((len(quaternion), 3))
    return multiply(quaternion, small_rotations(turns))
