"""A pinhole camera in the aircraft's nose, its boxes of obstacles, and the message formats of detectors."""

from __future__ import annotations

import errno
import json
import math
import os
import random
import socket
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import Any, Callable, Optional

import numpy as np
from autopilot import Autopilot, Pose
from links import HOST, free_port
from loop import Loop

AUTOPILOT, SENDER, AGE = 0, 1, 2  # GOE_FEATURES.time_base


@dataclass(frozen=True)
class Obstacle:
    """An upright obstacle on the ground at down 0. With a length it is a box, whose length axis is `heading_deg` from
    north."""

    north_m: float
    east_m: float = 0.0
    width_m: float = 8.0
    height_m: float = 40.0
    length_m: float | None = None
    heading_deg: float = 0.0

    def outline(self) -> np.ndarray:
        """North and east of its corners or, if round, of 64 points."""
        if self.length_m is None:
            angles = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
            corners = 0.5 * self.width_m * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        else:
            turn = math.radians(self.heading_deg)
            along = 0.5 * self.length_m * np.array([math.cos(turn), math.sin(turn)])
            across = 0.5 * self.width_m * np.array([-math.sin(turn), math.cos(turn)])
            corners = np.array([along + across, along - across, -along - across, -along + across])
        return corners + np.array([self.north_m, self.east_m])

    def points(self) -> np.ndarray:
        """Points of its outline on the ground and at its top, NED."""
        around = self.outline()
        return np.concatenate([np.column_stack([around, np.full(len(around), down)]) for down in (0.0, -self.height_m)])


MAST = Obstacle(250.0)


@dataclass(frozen=True)
class Box:
    """An upright box in raw pixels; the part outside the image is cut off."""

    id: int
    left: float
    top: float
    right: float
    bottom: float


def rotation(q: tuple[float, float, float, float]) -> np.ndarray:
    """Body to NED."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass(frozen=True)
class Camera:
    """Looks along the aircraft's nose."""

    width: int = 1280
    height: int = 720
    focal: float = 800.0

    def ini(self, name: str = "camera") -> str:
        keys = {
            "width": self.width,
            "height": self.height,
            "fx": self.focal,
            "fy": self.focal,
            "cx": self.width / 2,
            "cy": self.height / 2,
        }
        return "".join(f"{name}.{key} = {value}\n" for key, value in keys.items())

    def project(self, pose: Pose, points_ned: np.ndarray) -> np.ndarray | None:
        """Pixels (right, down); None if a point is not ahead."""
        body = (points_ned - np.array(pose.position)) @ rotation(pose.q)
        if np.any(body[:, 0] < 1.0):
            return None
        middle = np.array([self.width / 2, self.height / 2])
        return middle + self.focal * body[:, 1:] / body[:, :1]

    def see(self, pose: Pose, obstacle: Obstacle, number: int) -> Box | None:
        pixels = self.project(pose, obstacle.points())
        if pixels is None:
            return None
        (left, top), (right, bottom) = pixels.min(axis=0), pixels.max(axis=0)
        if right < 1 or left > self.width - 2 or bottom < 1 or top > self.height - 2:
            return None
        sides = (max(left, 0), max(top, 0), min(right, self.width - 1), min(bottom, self.height - 1))
        return Box(number, *(float(side) for side in sides))


@dataclass(frozen=True)
class Image:
    """The boxes of an image, and the middle of its exposure by every clock."""

    monotonic_s: float
    unix_s: float
    boot_s: float
    boxes: tuple[Box, ...]
    age_s: float = 0.0  # when the message is sent


# ------------------------------------------------------------------------------------------------------ lines of JSON


def plain_line(image: Image, clock: str | None) -> str:
    """As in the README. With `clock` None the line has no time."""
    times = {"unix": image.unix_s, "monotonic": image.monotonic_s, "autopilot": image.boot_s, "age": image.age_s}
    line: dict[str, Any] = {"detections": [detection(box) for box in image.boxes]}
    if clock:
        line.update(time=times[clock], clock=clock)
    return json.dumps(line) + "\n"


def detection(box: Box) -> dict[str, Any]:
    return {"id": box.id, "score": 0.9, "box": [box.left, box.top, box.right, box.bottom]}


def ultralytics(box: Box) -> dict[str, Any]:
    sides = {"x1": box.left, "y1": box.top, "x2": box.right, "y2": box.bottom}
    return {"name": "mast", "class": 4, "confidence": 0.91234, "box": sides, "track_id": box.id}


def bare_list(image: Image, clock: str | None = None) -> str:
    """Without a newline: the end of the datagram ends the line."""
    return json.dumps([ultralytics(box) for box in image.boxes])


def as_printed(image: Image, clock: str | None = None) -> str:
    """The output of print(result.tojson()): ultralytics dumps with an indent of 2, over several lines."""
    return json.dumps([ultralytics(box) for box in image.boxes], indent=2) + "\n"


def aliases(image: Image, clock: str | None) -> str:
    line = json.loads(plain_line(image, clock))
    line["detections"] = [ultralytics(box) for box in image.boxes]
    line["speed"] = {"inference": 12.5, "notes": [None, True, 'a \\u00fc " quoted']}
    return json.dumps(line) + "\n"


def of_class(image: Image, clock: str | None) -> str:
    line = json.loads(plain_line(image, clock))
    line["detections"] = [{**detection(box), "class": "house"} for box in image.boxes]
    return json.dumps(line) + "\n"


def without_clock(image: Image, clock: str | None) -> str:
    """The configuration names the clock."""
    line = json.loads(plain_line(image, clock))
    del line["clock"]
    return json.dumps(line) + "\n"


def without_ids(image: Image, clock: str | None) -> str:
    """As a detector without a tracker sends it."""
    line = json.loads(plain_line(image, clock))
    for entry in line["detections"]:
        del entry["id"]
    return json.dumps(line) + "\n"


def of_second_camera(image: Image, clock: str | None) -> str:
    """Two lines at a time: the first camera detects nothing."""
    line = json.loads(plain_line(image, clock))
    lines = {**line, "detections": []}, {**line, "camera": 1}
    return "".join(json.dumps(line) + "\n" for line in lines)


def points(image: Image, clock: str | None) -> str:
    """The middles of the sides instead of boxes."""
    line = json.loads(plain_line(image, clock))
    for entry, box in zip(line["detections"], image.boxes):
        u, v = 0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom)
        del entry["box"]
        entry.update(left=[box.left, v], right=[box.right, v], top=[u, box.top], pixel_sd=1.0)
    return json.dumps(line) + "\n"


Line = Callable[[Image, Optional[str]], str]


class UdpLines:
    def __init__(self) -> None:
        self.port = free_port()
        self.setting = f"udp:{HOST}:{self.port}"
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def put(self, data: bytes) -> None:
        self.socket.sendto(data, (HOST, self.port))

    def close(self) -> None:
        self.socket.close()


class FifoLines:
    """A detector that writes into a FIFO, and may end and come back."""

    def __init__(self, path: str) -> None:
        os.mkfifo(path)
        self.path, self.setting, self.file = path, f"fifo:{path}", -1

    def put(self, data: bytes) -> None:
        try:
            if self.file < 0:
                self.file = os.open(self.path, os.O_WRONLY | os.O_NONBLOCK)
            os.write(self.file, data)
        except OSError as error:
            if error.errno not in (errno.ENXIO, errno.EAGAIN, errno.EPIPE):
                raise
            self.close()

    def close(self) -> None:
        if self.file >= 0:
            os.close(self.file)
            self.file = -1


class PipeLines:
    """The companion's standard input. Data that the pipe does not take at once wait here."""

    setting = "stdin"

    def __init__(self, loop: Loop) -> None:
        self.read, self.write = os.pipe()
        os.set_blocking(self.write, False)
        self.loop, self.waiting = loop, bytearray()

    def put(self, data: bytes) -> None:
        busy = bool(self.waiting)
        self.waiting += data
        if not busy:
            self._flush()

    def _flush(self) -> None:
        try:
            while self.waiting:
                del self.waiting[: os.write(self.write, self.waiting[:65536])]
        except BlockingIOError:
            self.loop.after(0.002, self._flush)
        except BrokenPipeError:
            self.waiting.clear()

    def close(self) -> None:
        for file in (self.read, self.write):
            os.close(file)


# ----------------------------------------------------------------------------------------------------------- detectors


@dataclass
class Detector:
    """Takes `hz` images a second, and passes each to `report` `delay_s` later.

    `delays` lists the delays, and `poses` the true pose of every exposure by the autopilot's clock.
    """

    loop: Loop
    autopilot: Autopilot
    report: Callable[[Image], None]
    obstacles: Iterable[Obstacle] = (MAST,)
    camera: Camera = field(default_factory=Camera)
    hz: float = 10.0
    delay_s: float = 0.1
    noise_px: float = 0.2
    blind: bool = False
    unix_error_s: float = 0.0
    delays: list[float] = field(default_factory=list)
    poses: dict[float, Pose] = field(default_factory=dict)
    dice: random.Random = field(default_factory=lambda: random.Random(11))

    def __post_init__(self) -> None:
        self.loop.every(1.0 / self.hz, self._expose, first_s=0.013)

    def _expose(self) -> None:
        now, unix = self.loop.now_s, self.loop.unix_s
        if self.blind:
            return
        pose = self.autopilot.aircraft.advance(now)
        in_view = [self.camera.see(pose, obstacle, k + 1) for k, obstacle in enumerate(self.obstacles)]
        boxes = tuple(self._noisy(box) for box in in_view if box)
        image = Image(now, unix + self.unix_error_s, self.autopilot.clock.at(now), boxes)
        self.poses[image.boot_s] = pose
        self.loop.at(now + self.delay_s, lambda: self._report(image))

    def _noisy(self, box: Box) -> Box:
        most = {"left": self.camera.width - 1, "right": self.camera.width - 1}
        moved = {}
        for side in ("left", "top", "right", "bottom"):
            value, end = getattr(box, side), most.get(side, self.camera.height - 1)
            inside = 0.0 < value < end  # at the border the detector returns the border
            moved[side] = min(max(value + self.dice.gauss(0.0, self.noise_px), 0.0), end) if inside else value
        return replace(box, **moved)

    def _report(self, image: Image) -> None:
        age_s = self.loop.now_s - image.monotonic_s
        self.report(replace(image, age_s=age_s))
        self.delays.append(age_s)


class FeaturesSender:
    """GOE_FEATURES of a camera on the autopilot's network, one message for each detection; its clock is a third one."""

    def __init__(self, autopilot: Autopilot, camera: Camera, time_base: int) -> None:
        self.autopilot, self.camera, self.time_base = autopilot, camera, time_base
        self.mavlink = autopilot.dialect.MAVLink(None, srcSystem=1, srcComponent=100)
        self.own_begin_s = autopilot.loop.now_s - 77.7

    def __call__(self, image: Image) -> None:
        for box in image.boxes or (None,):
            message = features(self.autopilot.dialect, self.camera, box, len(image.boxes), self._times(image))
            self.autopilot.send(message, self.mavlink)

    def _times(self, image: Image) -> dict[str, int]:
        own = image.monotonic_s - self.own_begin_s
        seconds = {AUTOPILOT: image.boot_s, SENDER: own, AGE: 0.0}[self.time_base]
        age = 0 if self.time_base == AUTOPILOT else int(image.age_s * 1e6)
        return {"time_usec": int(seconds * 1e6), "age_usec": age, "time_base": self.time_base}


def features(dialect: ModuleType, camera: Camera, box: Box | None, number: int, times: dict[str, int]) -> Any:
    """Pixels in tenths from the middle of the image."""
    sides = [0, 0, 0, 0]
    if box:
        middle = (camera.width / 2, camera.height / 2)
        values = (box.left, box.top, box.right, box.bottom)
        sides = [round(10 * (value - middle[k % 2])) for k, value in enumerate(values)]
    return dialect.MAVLink_goe_features_message(
        obstacle_id=box.id if box else 0,
        box=sides,
        time_sd=0,
        image_width=camera.width,
        image_height=camera.height,
        visible=0xF if box else 0,
        camera_id=0,
        number=number,
        pixel_sd=0,
        score=90,
        **times,
    )
