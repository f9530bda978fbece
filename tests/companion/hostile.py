"""Input for the companion that no regular autopilot or detector sends."""

from __future__ import annotations

import itertools
import json
import math
import random
import struct
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

from autopilot import Autopilot

STRANGER_ID = 42  # a system other than the autopilot's


def frame_faults(dialect: ModuleType, dice: random.Random) -> Iterator[bytes]:
    """Endless bytes that are no valid frames: noise, torn and damaged frames, unknown messages, old and signed
    forms."""
    mavlink = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    message = dialect.MAVLink_attitude_quaternion_message(1, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    good, other = (message.pack(sender) for sender in (mavlink, dialect.MAVLink(None, srcSystem=STRANGER_ID)))
    while True:
        yield dice.randbytes(dice.randrange(1, 400))
        yield b"\xfd" + dice.randbytes(dice.randrange(0, 300))
        yield b"\xfe" + dice.randbytes(dice.randrange(0, 300))
        yield good[: dice.randrange(1, len(good))]
        yield good[:-2] + struct.pack("<H", dice.randrange(65536))
        yield good[:12] + bytes([good[12] ^ 0xFF]) + good[13:]
        yield other[:7] + b"\xff\xff\xff" + other[10:]  # message 16777215
        yield good[:2] + b"\xff" + good[3:]  # every incompatibility flag
        yield b"\xfd" + b"\xff" * 279
        yield b"\xfd" * 280
        yield b"\x00" * 1000
        yield b""


def stranger(dialect: ModuleType, dice: random.Random, ms: int) -> list[Any]:
    """Well-formed messages of another system with another position and another time."""
    far, turned = dice.uniform(-1e6, 1e6), math.sqrt(0.5)
    return [
        dialect.MAVLink_heartbeat_message(2, 3, 0xD1, 4, 4, 3),
        dialect.MAVLink_local_position_ned_message(ms, far, -far, far, 500.0, -500.0, 100.0),
        dialect.MAVLink_attitude_quaternion_message(ms, turned, turned, 0.0, 0.0, 9.0, 9.0, 9.0),
        dialect.MAVLink_timesync_message(10**18, dice.randrange(1, 10**12)),
        dialect.MAVLink_gps_global_origin_message(-330000000, 1510000000, 9000000, ms * 1000),
        dialect.MAVLink_home_position_message(
            -330000000, 1510000000, 0, far, far, 900.0, [1.0, 0.0, 0.0, 0.0], 0, 0, 0, ms * 1000
        ),
        dialect.MAVLink_odometry_message(
            ms * 1000, 1, 12, far, far, far, [1.0, 0.0, 0.0, 0.0], 1, 1, 1, 1, 1, 1, [0.0] * 21, [0.0] * 21, 200
        ),
    ]


def poison(dialect: ModuleType, ms: int) -> list[Any]:
    """Messages of the autopilot itself with NaN, infinite or impossible values."""
    d, nan, unit = dialect, math.nan, (1.0, 0.0, 0.0, 0.0)
    attitude, position = d.MAVLink_attitude_quaternion_message, d.MAVLink_local_position_ned_message
    return [
        attitude(ms, nan, nan, nan, nan, nan, nan, nan),
        attitude(ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        attitude(ms, 1e30, 1e30, 1e30, 1e30, 0.0, 0.0, 0.0),
        attitude(ms, math.inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        position(ms, 1e30, -1e30, 1e30, 1e30, 1e30, 1e30),
        position(ms, nan, 0.0, 0.0, 0.0, nan, 0.0),
        position(ms, math.inf, math.inf, -math.inf, 0.0, 0.0, 0.0),
        d.MAVLink_home_position_message(2**31 - 1, -(2**31), 2**31 - 1, nan, nan, nan, [nan] * 4, nan, nan, nan, 0),
        d.MAVLink_gps_global_origin_message(2**31 - 1, -(2**31), 2**31 - 1, 2**64 - 1),
        d.MAVLink_timesync_message(2**63 - 1, 1),
        d.MAVLink_timesync_message(-(2**63), -(2**63)),
        d.MAVLink_distance_sensor_message(ms, 0, 65535, 65535, 255, 255, 255, 255, nan, nan, list(unit), 255),
        d.MAVLink_command_ack_message(65535, 255),
        *bad_features(dialect),
    ]


def bad_features(dialect: ModuleType) -> list[Any]:
    """GOE_FEATURES with an invalid clock, camera, size and sides."""
    usual: dict[str, Any] = dict(
        time_usec=2**64 - 1,
        age_usec=2**32 - 1,
        obstacle_id=9,
        box=[-32768, 32767, -32768, 32767],
        time_sd=65535,
        image_width=1280,
        image_height=720,
        visible=0xFFFF,
        camera_id=0,
        time_base=2,
        number=1,
        pixel_sd=255,
        score=255,
    )
    changes: list[dict[str, Any]] = [
        {},
        {"time_base": 255},
        {"camera_id": 255},
        {"image_width": 0, "image_height": 0, "age_usec": 100000},
        {"number": 255, "time_base": 0},
        {"time_base": 1, "time_usec": 0},
    ]
    return [dialect.MAVLink_goe_features_message(**{**usual, **change}) for change in changes]


# ------------------------------------------------------------------------------------------------------ lines of JSON

BOX = '"box": [600, 300, 640, 420]'


def bad_lines() -> list[bytes]:
    """Malformed lines. Each is reported, and none contains an obstacle."""
    texts = [
        "{",
        "}",
        "null",
        "17",
        '"text"',
        "{}",
        "[[]]",
        "[1, 2]",
        "[null]",
        "nonsense",
        '{"time": 1}',
        '{"detections": null}',
        '{"detections": 3}',
        '{"detections": "box"}',
        '{"detections": {}}',
        '{"detections": [1]}',
        '{"detections": [[600, 300, 640, 420]]}',
        '{"detections": [{"box": [1, 2, 3]}]}',
        '{"detections": [{"box": [1, 2, 3, 4, 5]}]}',
        '{"detections": [{"box": ["a", "b", "c", "d"]}]}',
        '{"detections": [{"box": {"x1": 1}}]}',
        '{"detections": [{"box": null, "left": 3}]}',
        '{"detections": [{"left": [1]}]}',
        '{"detections": [{"id": "three", $}]}',
        '{"detections": [{"id": -5, $}]}',
        '{"detections": [{"id": 1.5, $}]}',
        '{"detections": [{"score": "high", $}]}',
        '{"detections": [], "clock": "sundial", "time": 1}',
        '{"detections": [], "clock": 7, "time": 1}',
        '{"detections": [], "time": "now"}',
        '{"detections": [], "time": {}}',
        '{"detections": [], "camera": "left"}',
        '{"detections": [], "camera": -1}',
        '{"detections": [{$, $}',
        "[" * 30000,
        '{"detections": ' * 4000,
        '{"detections": [' + "9" * 20000 + "]}",
        '{"detections": [{"box": [NaN, Infinity, -Infinity, NaN]}]}',
    ]
    return [text.replace("$", BOX).encode() for text in texts] + [
        b"\x00\x00\x00\x00",
        b'{"detections": [\x00]}',
        b'{"detections": [], "note": "\xff\xfe\xc0\x80"}',
        b"\xef\xbb\xbf{",
        bytes(range(1, 10)) + bytes(range(11, 256)),
    ]


def escapes() -> list[bytes]:
    """Lines that would control a terminal if their error message quoted them verbatim."""
    return [
        b"\x1b[2J\x1b]0;title\x07",
        b'{"clock": "\x1b[31m", "time": 1, "detections": []}',
        b'{"clock": "\\u001b[31m", "time": 1, "detections": [{"\\u001b[2J": 1}]}',
    ]


def odd_lines() -> list[bytes]:
    """Well-formed lines with useless numbers. The program decides what it accepts of them."""
    name = "x" * 5000
    texts = [
        '{"time": 1e300, "detections": []}',
        '{"time": -1e300, "detections": []}',
        '{"time": 0, "detections": []}',
        '{"time": 9e9, "detections": []}',
        '{"time": 1e9, "detections": []}',
        '{"time": -5, "clock": "age", "detections": []}',
        '{"time": 1e9, "clock": "age", "detections": []}',
        '{"time": 1e18, "clock": "autopilot", "detections": []}',
        '{"time": 0.1, "clock": "age", "time_sd": -1, "detections": []}',
        '{"time": 0.1, "clock": "age", "time_sd": 1e30, "detections": []}',
        '{"camera": 77, "detections": []}',
        '{"detections": [{"id": 4294967296, $, "score": 0.1}]}',
        '{"detections": [{"id": 99999999999999999999999999, $, "score": 0.1}]}',
        '{"detections": [{"id": 21, "score": 7, "box": [1e30, 1e30, 1e30, 1e30]}]}',
        '{"detections": [{"id": 22, "score": 0.1, "box": [640, 420, 600, 300]}]}',
        '{"detections": [{"id": 23, "score": 1e400, "box": [1, 2, 3, 4]}]}',
        '{"detections": [{"id": 24, "score": -1, "box": [1, 2, 3, 4]}]}',
        '{"detections": [{"id": 25, "score": 0.1, "pixel_sd": -3, "box": [1, 2, 3, 4]}]}',
        '{"detections": [{"id": 26, "score": 0.1, "pixel_sd": 1e30, "box": [1, 2, 3, 4]}]}',
        '{"detections": [{"id": 27, "score": 0.1}]}',
        '{"detections": [{"id": 28, "score": 0.1, "box": [-1e5, -1e5, 1e5, 1e5], "name": "%s"}]}'.replace("%s", name),
    ]
    return [text.replace("$", BOX).encode() for text in texts]


def crowd(dice: random.Random, number: int, score: float) -> bytes:
    """More detections in one line than the companion can follow."""
    found = []
    for k in range(number):
        left, top = dice.uniform(0, 1200), dice.uniform(0, 600)
        box = [left, top, left + dice.uniform(5, 80), top + dice.uniform(5, 100)]
        found.append({"id": k + 100, "score": score, "box": [round(side, 1) for side in box]})
    return json.dumps({"time": 0.1, "clock": "age", "detections": found}).encode()


def in_turn(autopilot: Autopilot, make: Callable[[int], list[Any]], mavlink: Any) -> Callable[[], None]:
    """Sends the entries of a list one after the other over the autopilot's wire. The list is made again with the
    autopilot's time."""
    number = itertools.count()

    def send() -> None:
        messages = make(int(autopilot.boot_s() * 1e3))
        autopilot.send(messages[next(number) % len(messages)], mavlink)

    return send
