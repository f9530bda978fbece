"""A complete flight past a mast with autopilot, camera, detector and companion; and fleets of simultaneous flights."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, Union

import numpy as np
from autopilot import Aircraft, Autopilot, Heard
from camera import (
    MAST,
    Camera,
    Detector,
    FeaturesSender,
    FifoLines,
    Image,
    Line,
    Obstacle,
    PipeLines,
    UdpLines,
    plain_line,
)
from companion import Companion, Ended, Settings
from links import WIRES, Faults, SerialWire
from loop import Loop

Lines = Union[UdpLines, FifoLines, PipeLines]
FAR_M = 3.44  # size of the 99.7 % ellipse in two-dimensional sigmas


@dataclass
class Plan:
    """Options of one flight. `source`: udp, fifo, stdin, or the time base of GOE_FEATURES."""

    name: str
    link: str = "udpin"
    source: str | int = "udp"
    line: Line = plain_line
    clock: str | None = "unix"
    settings: Settings = field(default_factory=dict)
    obstacles: Sequence[Obstacle] = (MAST,)
    faults: Faults | None = None
    detector_faults: Faults | None = None
    detector: Mapping[str, Any] = field(default_factory=dict)
    autopilot: Mapping[str, Any] = field(default_factory=dict)
    aircraft: Mapping[str, Any] = field(default_factory=dict)
    cameras: int = 1
    recorded: bool = False


@dataclass(frozen=True)
class Found:
    """One GOE_OBSTACLE against the truth."""

    time_s: float
    error_m: float
    sigmas: float  # Mahalanobis distance
    range_m: float


class Flight:
    def __init__(self, loop: Loop, dialect: ModuleType, folder: Path, plan: Plan) -> None:
        self.loop, self.plan = loop, plan
        self.autopilot = Autopilot(
            loop,
            dialect,
            wire=WIRES[plan.link],
            faults=plan.faults,
            aircraft=Aircraft(time_s=loop.now_s, **plan.aircraft),
            **plan.autopilot,
        )
        camera = Camera()
        self.lines = self._lines(folder, plan.source)
        self.log = folder / "log"
        cameras = camera.ini() + (camera.ini("camera2") if plan.cameras > 1 else "")
        self.companion = Companion(loop, folder, self._settings(), cameras)
        if isinstance(self.autopilot.wire, SerialWire):
            self.companion.on_written = self.autopilot.wire.wait_for_written
        report = FeaturesSender(self.autopilot, camera, plan.source) if isinstance(plan.source, int) else self._report
        self.detector = Detector(loop, self.autopilot, report, plan.obstacles, camera, **plan.detector)
        self.ended: Ended | None = None

    def _lines(self, folder: Path, source: str | int) -> Lines | None:
        folder.mkdir(parents=True, exist_ok=True)
        if source == "udp":
            return UdpLines()
        if source == "fifo":
            return FifoLines(str(folder / "detections"))
        return PipeLines(self.loop) if source == "stdin" else None

    def _settings(self) -> dict[str, dict[str, Any]]:
        """The plan's settings, added to those of every flight."""
        settings: dict[str, dict[str, Any]] = {
            "link": {"autopilot": self.autopilot.wire.setting},
            "detections": {"from": self.lines.setting if self.lines else "none"},
            "camera": {"file": "camera.ini"},
        }
        if self.plan.recorded:
            settings["record"] = {"folder": self.log}
        for section, keys in self.plan.settings.items():
            settings.setdefault(section, {}).update(keys)
        return settings

    def _report(self, image: Image) -> None:
        assert self.lines
        data = self.plan.line(image, self.plan.clock).encode()
        for delay_s in self.plan.detector_faults.copies() if self.plan.detector_faults else [0.0]:
            if delay_s > 0.0:
                self.loop.after(delay_s, lambda: self.put(data))
            else:
                self.put(data)

    def put(self, data: bytes) -> None:
        """Sends any data to the companion's input for detections."""
        assert self.lines
        self.lines.put(data)

    def start(self) -> None:
        if isinstance(self.lines, PipeLines):
            self.companion.start(stdin=self.lines.read)
        else:
            self.companion.start()

    def stop(self) -> None:
        if self.companion.process:
            self.ended = self.companion.stop()

    def close(self) -> None:
        if self.companion.process:
            self.companion.stop()
        self.autopilot.close()
        if self.lines:
            self.lines.close()

    # ---------------------------------------------------------------------------------------------- what came of it

    def of(self, name: str) -> list[Any]:
        return self.autopilot.of(name)

    def statuses(self) -> list[Any]:
        return self.of("GOE_STATUS")

    def found(self, obstacle: Obstacle | None = None, since_s: float = 0.0) -> list[Found]:
        """Every GOE_OBSTACLE since a time whose nearest obstacle is this one, against its (shifted) truth."""
        obstacle = obstacle or self.plan.obstacles[0]
        reports = [heard for heard in self.autopilot.heard_of("GOE_OBSTACLE") if heard.time_s >= since_s]
        mine = [heard for heard in reports if self._nearest(heard) == obstacle]
        return [self._against(heard, obstacle) for heard in mine]

    def _nearest(self, heard: Heard) -> Obstacle:
        """The nearest obstacle of the plan."""
        return min(self.plan.obstacles, key=lambda obstacle: self._against(heard, obstacle).error_m)

    def _against(self, heard: Heard, obstacle: Obstacle) -> Found:
        reports = heard.message
        shift = self.autopilot.shift
        error = np.array([reports.north - obstacle.north_m - shift[0], reports.east - obstacle.east_m - shift[1]])
        nn, ne, ee = reports.covariance
        covariance = np.array([[nn, ne], [ne, ee]])
        sigmas = float(np.sqrt(max(error @ np.linalg.pinv(covariance) @ error, 0.0)))
        return Found(heard.time_s, float(np.hypot(*error)), sigmas, obstacle.north_m - heard.north_m)

    def assert_found(self, obstacle: Obstacle | None = None, since_s: float = 0.0, least: int = 10) -> None:
        """Detected in time and at the right position: within three sigma always, within 10 % of the range from 100 m
        on."""
        ahead = [found for found in self.found(obstacle, since_s) if found.range_m > 20.0]
        assert len(ahead) >= least, f"{len(ahead)} reports; {self.ended}"
        wrong = [found for found in ahead if not found.sigmas <= FAR_M]
        assert not wrong, (wrong[:3], self.ended)
        near = [found for found in ahead if found.range_m < 100.0]
        assert near, "nothing is reported within 100 m"
        wrong = [found for found in near if not found.error_m <= max(0.1 * found.range_m, 4.0)]
        assert not wrong, (wrong[:3], self.ended)

    def assert_ended_well(self) -> None:
        assert self.ended and self.ended.status == 0, self.ended


class Fleet:
    """Simultaneous flights, each with its own companion."""

    def __init__(self, dialect: ModuleType, folder: Path, plans: Sequence[Plan]) -> None:
        self.loop = Loop()
        self.flights = {plan.name: Flight(self.loop, dialect, folder / plan.name, plan) for plan in plans}

    def __getitem__(self, name: str) -> Flight:
        return self.flights[name]

    def start(self) -> None:
        for flight in self.flights.values():
            flight.start()
            assert flight.companion.alive(), flight.companion.stop()

    def run(self, seconds: float) -> None:
        self.loop.run(seconds)

    def stop(self) -> None:
        for flight in self.flights.values():
            flight.stop()

    def close(self) -> None:
        for flight in self.flights.values():
            flight.close()
        self.loop.close()


MakeFleet = Callable[[Sequence[Plan]], Fleet]
