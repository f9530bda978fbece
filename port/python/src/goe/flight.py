"""The layer between a detector, an autopilot and the estimators: poses of the exposures, clocks, resets, a table of
obstacles, hazards from now on, what to do. goe_flight.h is its manual.

    autopilot   Flight.attitude, Flight.position   each sample, as it comes
    detector    Flight.frame                       each image, also when nothing is in view
    reaction    Flight.assess                      at any rate, 5 to 50 Hz; then obstacle, sectors

Times are microseconds of the autopilot's clock; their lowest 32 bits count, which may wrap.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._goe import ffi, lib
from ._renamed import Renamed
from .estimate import BITS, MODELS, Length
from .hazard import Hazard, hazard_of
from .image import BoundingBox, Kind, Pixel, Pose, fill_box, fill_kind, fill_points, vector
from .settings import FlightSettings, Settings
from .status import Model, SettingError

SLOTS: int = lib.GOE_FLIGHT_SLOTS
"""Obstacles that are followed at a time."""
SECTORS: int = lib.GOE_FLIGHT_SECTORS
"""Of ``Flight.sectors``, 5 degrees each, the first centered on north."""
DETECTIONS: int = lib.GOE_FLIGHT_DETECTIONS
"""Most that ``Flight.frame`` takes at once."""
SECTOR_UNKNOWN = 65535
"""Outside the view of every camera whose detector is alive, or the pose dead. Not the same as clear."""
TIME_BITS = 0xFFFFFFFF


class FlightStatus(IntEnum):
    """What became of a call. 0: done; negative or TOO_NEW: nothing was taken."""

    OK = 0
    """Done."""
    TOO_NEW = 1
    """No pose so new yet: keep the frame and ask again after the next sample."""
    TOO_OLD = -1
    """Older than the history or ``delay_max_s``, or in a gap of the samples: drop the frame."""
    NO_POSE = -2
    """No sample of attitude or position since the start or the latest unknown reset."""
    BAD_TIME = -3
    """A sample that is not newer than the one before it."""
    NOT_FINITE = -4
    """A number is a NaN or an infinity."""
    OUT_OF_RANGE = -5
    """A number is outside its range."""
    BAD_ATTITUDE = -6
    """The quaternion's norm is off 1 by more than 1 %."""
    NOTHING = -7
    """No obstacle in this slot."""
    CORRUPTED = -35
    """Settings in the layer's memory have changed: make another. Nothing is known, which is not "clear"."""

    def __str__(self) -> str:
        return self.name.lower()


class Action(IntEnum):
    """What to do about the worst obstacle."""

    NONE = 0
    """Fly on."""
    LEFT = 1
    """Fly to the target, to the left of the obstacle looking along the course."""
    RIGHT = 2
    """... right of it."""
    CLIMB = 3
    """Straight on, up to the target."""
    GO_AROUND = 4
    """Break off the approach."""
    HOLD = 5
    """Turn away, to the target before the obstacle, and loiter."""

    def __str__(self) -> str:
        return ffi.string(lib.goe_flight_action_text(int(self))).decode()


class OrderReason(IntEnum):
    """Why ``Flight.assess`` gives this action."""

    NONE = 0
    """No action, and none is withheld."""
    CLEAR = 1
    """The path of the order is clear of all known obstacles."""
    LEAST_BAD = 2
    """No path is clear: the order has the largest distance that was found."""
    LOW = 3
    """An action is due and withheld: the aircraft is lower than ``order_height_m``."""
    SLOW = 4
    """... slower than ``order_speed_m_s``."""
    LANDING = 5
    """... flares, or has touched down."""

    def __str__(self) -> str:
        return ffi.string(lib.goe_flight_reason_text(int(self))).decode()


class Phase(IntEnum):
    """What the aircraft does, for ``Flight.assess``."""

    FLYING = 0
    """It flies."""
    APPROACH = 1
    """It is landing: to go around comes first."""
    FLARE = 2
    """No action is given, and an active one ends."""
    LANDED = 3
    """It has touched down: the same. Obstacles behind the runway are not on its course."""


class TimeBase(IntEnum):
    """The clock of ``Frame.capture_us``."""

    AUTOPILOT = 0
    """The autopilot's: nothing to estimate."""
    SENDER = 1
    """The sender's: the layer compares it with the arrivals, or ``Flight.timesync`` knows."""
    AGE = 2
    """No clock: the age of the image when it was sent."""


class LatLon(NamedTuple):
    """A place on the earth, degrees times 1e7."""

    lat_e7: int
    lon_e7: int


@dataclass
class Attitude:
    """A sample of the attitude."""

    time_us: int
    """Of the sample itself, not of its arrival."""
    q: Sequence[float]
    """w, x, y, z; body (forward, right, down) to north, east, down; its norm is 1 within 1 %."""
    reset: int = 0
    """Changes with every reset of attitude or heading, which ends all tracks."""


@dataclass
class PositionSample:
    """A sample of the position."""

    time_us: int
    """Of the sample itself, not of its arrival."""
    position_ned_m: Sequence[float]
    """The vehicle's reference point in north, east, down, m; each within 1e6."""
    velocity_ned_m_s: Sequence[float]
    """Over the ground, m/s; each within 1e3."""
    range_finder_m: float | None = None
    """Height of the reference point above the ground, by a range finder, m. The first of the three that is known and
    believed counts."""
    terrain_m: float | None = None
    """... by a map of the terrain, m."""
    home_m: float | None = None
    """... over home, m."""
    origin: LatLon | None = None
    """Of north, east, down, if it is known."""
    reset_horizontal: int = 0
    """Changes with every reset of north and east."""
    reset_vertical: int = 0
    """Changes with every reset of down."""
    reset_delta_ned_m: Sequence[float] | None = None
    """New minus old of the latest reset of each, m. None: any reset ends all tracks."""


@dataclass
class Detection:
    """One obstacle in one image: a box, or points, or both, raw pixels."""

    score: float
    """0 to 1."""
    id: int = 0
    """Of the detector's tracker; 0: it has none, and the place in the image decides."""
    bounding_box: BoundingBox | None = None
    """All four sides, also at the image's border."""
    left: Pixel | None = None
    right: Pixel | None = None
    top: Pixel | None = None
    base_left: Pixel | None = None
    base_near: Pixel | None = None
    base_right: Pixel | None = None
    pixel_px: float | None = None
    """One sigma of box and points, px, instead of the settings'; up to 100."""
    kind: Kind = field(default_factory=Kind)
    """What the detector's class says of it. A bad one is counted, and not used."""


@dataclass
class Frame:
    """The detections of one image."""

    arrival_us: int
    """Autopilot's clock."""
    capture_us: int
    """Middle of the exposure by the clock of ``time_base``; or the age."""
    detections: Sequence[Detection] = ()
    """Those of this call; at most ``DETECTIONS``. None in view: give the frame all the same, the detector is alive."""
    time_base: TimeBase = TimeBase.AUTOPILOT
    """The clock of ``capture_us``."""
    sent_us: int | None = None
    """When it was sent, sender's clock; None: not known."""
    time_sd_us: int = 0
    """One sigma of ``capture_us``; 0: ``FlightSettings.delay_sd_s``."""
    camera: int = 0
    """Number of the camera that took it."""
    number: int | None = None
    """Of detections in the whole image, if further calls with the same capture bring the others; None: all are here."""


@dataclass(frozen=True)
class Assessment:
    """What ``Flight.assess`` finds."""

    action: Action
    """What to do."""
    late: bool
    """The action needs longer than there is: it may not suffice."""
    suspect: bool
    """The worst obstacle's estimate is: margins were widened."""
    detector_alive: bool
    """A frame came in time, of every camera."""
    pose_alive: bool
    """The pose agrees, and samples of attitude and position came within 0.5 s."""
    worst: int | None
    """Slot of the worst obstacle, for ``Flight.obstacle``. None is "clear" only if detector and pose are alive and
    ``unplaced`` is 0."""
    avoided: int | None
    """Slot of the obstacle that the action is about, unless it was given up."""
    obstacles: int
    """With a position."""
    needed_s: float
    """Time that the action needs, or the best one would, s."""
    target_ned_m: tuple[float, float, float] | None
    """Where to, north, east, down, m; None without an action."""
    target: LatLon | None
    """The same on the earth, if the origin is known."""
    hazard: Hazard | None
    """Of the worst obstacle, from now."""
    reason: OrderReason
    """Why this action, or why none."""
    clear_m: float
    """Least distance that the action's path keeps from any known obstacle's circle, with two sigma of its place
    taken off; at most 1000 m; 0 without an action to a side."""
    unplaced: int
    """Detected obstacles without a position: no order avoids them."""
    pose_agrees: bool
    """In the latest 10 s no position contradicted the velocities. If false, a convention is wrong, or the position
    jumped."""


class Place(NamedTuple):
    """Where an obstacle is."""

    center_ned_m: tuple[float, float, float]
    """Middle of the visible base; down: of its ground; m."""
    covariance_ne_m2: tuple[float, float, float]
    """Of that: north north, north east, east east."""
    radius_m: float
    """Of the circle about the center that contains the outline."""
    nearest_ned_m: tuple[float, float, float]
    """The point of the circle nearest to the aircraft, m."""
    nearest_body_m: tuple[float, float, float]
    """The same relative to the aircraft: forward, right, down, m."""
    center: LatLon | None
    """The center on the earth, if the origin is known."""


@dataclass(frozen=True)
class Obstacle(Renamed):
    """One obstacle of the table. An unknown value is None."""

    id: int
    """The detector's; 0: it has none."""
    model: Model | None
    """The shape."""
    suspect: bool
    """Its sigmas may be too small."""
    receding: bool
    """On the present course its distance grows."""
    in_view: bool
    """Detected in the latest image."""
    moves: bool
    """It moves, and is followed."""
    age_s: float
    """Since it was last measured, from the latest assessment, s."""
    place: Place | None
    """Where it is."""
    height: Length | None
    """Of its top above the ground."""
    width_m: float | None
    """Disc: diameter; prism: across the first line of sight; box: the front edge; m."""
    length_m: float | None
    """The side edge, m."""
    length_heading_deg: float | None
    """Of the length axis, clockwise from north, 0 to 180."""
    hazard: Hazard | None
    """From the latest assessment on."""


class Counters(NamedTuple):
    """Counted since the start; they saturate."""

    taken: int
    """Frames."""
    late: int
    """Frames that came too late for the history."""
    early: int
    """Calls that were answered by TOO_NEW."""
    refused: int
    """Samples, frames, detections or kinds that were not finite or out of range."""
    weak: int
    """Detections below ``score_min``."""
    renumbered: int
    """Tracks that took over a new id."""
    evicted: int
    """Tracks given up for a new obstacle."""
    full: int
    """Confirmed detections that found no slot."""
    resets: int
    """Known jumps."""
    lost: int
    """Unknown resets and restarts: all tracks ended."""


def _lat_lon(lat_e7: int, lon_e7: int) -> LatLon | None:
    return LatLon(lat_e7, lon_e7) if lat_e7 or lon_e7 else None


def _slot(number: int) -> int | None:
    return number if number >= 0 else None


def _assessment_of(c: Any) -> Assessment:
    action = Action(c.action)
    return Assessment(
        action, c.late, c.suspect, c.detector_alive, c.pose_alive, _slot(c.worst), _slot(c.avoided), c.obstacles,
        c.needed_s, tuple(c.target_ned_m) if action else None, _lat_lon(c.target_lat_e7, c.target_lon_e7),
        hazard_of(c.hazard) if c.worst >= 0 else None, OrderReason(c.reason), c.clear_m, c.unplaced, c.pose_agrees,
    )  # fmt: skip


def _obstacle_of(c: Any) -> Obstacle:
    has = {name: bool(c.valid & bit) for name, bit in BITS.items()}
    vectors = (c.center_ned_m, c.covariance_ne_m2, c.nearest_ned_m, c.nearest_body_m)
    center, covariance, nearest, body = (tuple(v) for v in vectors)
    place = Place(center, covariance, c.radius_m, nearest, body, _lat_lon(c.lat_e7, c.lon_e7))
    return Obstacle(
        c.id, MODELS.get(c.model), c.suspect, c.receding, c.in_view, has["velocity"], c.age_s,
        place if has["position"] else None,
        Length(c.height_m, c.height_sd_m) if has["height"] else None,
        c.width_m if has["width"] else None,
        c.length_m if has["length"] else None,
        c.length_heading_deg if has["orientation"] else None,
        hazard_of(c.hazard) if c.has_hazard else None,
    )  # fmt: skip


def _fill_detection(c: Any, detection: Detection) -> None:
    c.id = detection.id
    c.score = detection.score
    c.pixel_px = detection.pixel_px or 0.0
    fill_box(c.box, detection.bounding_box)
    fill_points(c, detection)
    fill_kind(c.kind, detection.kind)


class Flight:
    """The flight layer. Given to several threads it works for one after the other."""

    def __init__(self, estimator: Settings, settings: FlightSettings | None = None) -> None:
        """Copies both settings and starts with nothing known. Every camera needs its ``width_px`` and ``height_px``.

        SettingError: one is outside its range.
        """
        values, layer = estimator.numbers(), (settings or FlightSettings()).numbers()
        self._lock = threading.Lock()
        self._c = ffi.new("goe_flight_t *")
        bad = ffi.new("const char **")
        status = lib.goe_python_flight_init(
            self._c, ffi.from_buffer("double[]", values), 1 + len(estimator.more_cameras),
            ffi.from_buffer("float[]", layer), bad,
        )  # fmt: skip
        if status != FlightStatus.OK:
            name = ffi.string(bad[0]).decode() if bad[0] != ffi.NULL else "settings"
            needs = "the size of every camera's image" if "camera" in name else "a whole number"
            raise SettingError(name, f": refused by the flight layer, which needs {needs}")

    def attitude(self, sample: Attitude) -> FlightStatus:
        """Takes a sample of the attitude; those closer than 20 ms are thinned.

        OK, BAD_TIME, NOT_FINITE, OUT_OF_RANGE or BAD_ATTITUDE.
        """
        quaternion = vector(sample.q, 4, "q")
        c = ffi.new("goe_flight_attitude_t *", (sample.time_us & TIME_BITS, quaternion, sample.reset & TIME_BITS))
        with self._lock:
            return FlightStatus(lib.goe_flight_attitude(self._c, c))

    def position(self, sample: PositionSample) -> FlightStatus:
        """Takes a sample of the position; those closer than 20 ms are thinned.

        OK, BAD_TIME, NOT_FINITE or OUT_OF_RANGE.
        """
        c = ffi.new("goe_flight_position_t *")
        c.time_us = sample.time_us & TIME_BITS
        c.position_ned_m = vector(sample.position_ned_m, 3, "position_ned_m")
        c.velocity_ned_m_s = vector(sample.velocity_ned_m_s, 3, "velocity_ned_m_s")
        heights = (sample.range_finder_m, sample.terrain_m, sample.home_m)
        c.height_m = tuple(0.0 if height is None else height for height in heights)
        c.height_valid = sum(1 << i for i, height in enumerate(heights) if height is not None)
        c.origin_known = sample.origin is not None
        c.origin_lat_e7, c.origin_lon_e7 = sample.origin or (0, 0)
        c.reset_horizontal = sample.reset_horizontal & TIME_BITS
        c.reset_vertical = sample.reset_vertical & TIME_BITS
        c.reset_delta_known = sample.reset_delta_ned_m is not None
        delta = (0.0, 0.0, 0.0) if sample.reset_delta_ned_m is None else sample.reset_delta_ned_m
        c.reset_delta_ned_m = vector(delta, 3, "reset_delta_ned_m")
        with self._lock:
            return FlightStatus(lib.goe_flight_position(self._c, c))

    def pose(self, time_us: int, time_sd_us: int = 0) -> tuple[Pose, float] | None:
        """The pose at a time, and what its attitude is uncertain by, degrees, for a time whose one sigma is
        ``time_sd_us``. None: the samples do not hold that time."""
        c, sd_deg = ffi.new("goe_pose_t *"), ffi.new("float *")
        with self._lock:
            status = lib.goe_flight_pose(self._c, time_us & TIME_BITS, time_sd_us, c, sd_deg)
        if status != FlightStatus.OK:
            return None
        return Pose(c.time_us, tuple(c.position_ned_m), c.height_m, tuple(c.attitude), c.reset_count), sd_deg[0]

    def timesync(self, offset_us: int, sd_us: int | None) -> None:
        """The sender's clock from a two-way exchange: autopilot's minus sender's, and its one sigma, microseconds. It
        replaces the one-way estimate until ``sd_us`` is None: not known any more."""
        with self._lock:
            lib.goe_flight_timesync(self._c, offset_us & TIME_BITS, TIME_BITS if sd_us is None else sd_us)

    def frame(self, frame: Frame) -> FlightStatus:
        """Takes an image's detections.

        OK, TOO_NEW, TOO_OLD, NO_POSE or OUT_OF_RANGE (camera, or more than ``DETECTIONS``). A detection that is not
        finite or out of range is left out and counted.
        """
        if len(frame.detections) > DETECTIONS:
            return FlightStatus.OUT_OF_RANGE
        detections = ffi.new("goe_flight_detection_t[]", len(frame.detections))
        for c_detection, detection in zip(detections, frame.detections):
            _fill_detection(c_detection, detection)
        c = ffi.new("goe_flight_frame_t *")
        c.arrival_us = frame.arrival_us & TIME_BITS
        c.capture_us = frame.capture_us & TIME_BITS
        c.sent_us = (frame.capture_us if frame.sent_us is None else frame.sent_us) & TIME_BITS
        c.time_sd_us = frame.time_sd_us
        c.time_base = frame.time_base
        c.camera = frame.camera
        c.number = len(frame.detections) if frame.number is None else frame.number
        c.count = len(frame.detections)
        c.detection = detections
        with self._lock:
            return FlightStatus(lib.goe_flight_frame(self._c, c))

    def assess(self, now_us: int, phase: Phase = Phase.FLYING) -> Assessment | None:
        """The hazards ahead from now on, at the velocity of the newest sample, and the reaction. ``approach``: the
        aircraft is landing, and to go around comes first. None: there is no pose, which is not "clear"."""
        c = ffi.new("goe_flight_assessment_t *")
        with self._lock:
            status = lib.goe_flight_assess(self._c, now_us & TIME_BITS, phase, c)
        return _assessment_of(c) if status == FlightStatus.OK else None

    def obstacle(self, slot: int) -> Obstacle | None:
        """One obstacle, slot 0 to ``SLOTS`` - 1, as of the latest image, with the hazard of the latest assessment.
        None: there is none, or no pose."""
        c = ffi.new("goe_flight_obstacle_t *")
        with self._lock:
            status = lib.goe_flight_obstacle(self._c, slot, c)
        return _obstacle_of(c) if status == FlightStatus.OK else None

    def obstacles(self) -> dict[int, Obstacle]:
        """All that there are, by slot."""
        return {slot: found for slot in range(SLOTS) if (found := self.obstacle(slot)) is not None}

    def sectors(self, max_cm: int) -> npt.NDArray[np.uint16] | None:
        """(72,) nearest obstacle by bearing, cm: sector i is centered on 5 i degrees from north; ``max_cm`` + 1:
        nothing within the camera's view; ``SECTOR_UNKNOWN`` elsewhere. None: there is no pose.

        ValueError: ``max_cm`` is not within 1 to 65000.
        """
        if not 1 <= max_cm <= 65000:
            raise ValueError(f"max_cm = {max_cm}: not within 1 to 65000")
        result = np.zeros(SECTORS, np.uint16)
        with self._lock:
            status = lib.goe_flight_sectors(self._c, max_cm, ffi.from_buffer("uint16_t[]", result))
        return result if status == FlightStatus.OK else None

    def change_settings(self, settings: FlightSettings) -> FlightStatus:
        """Changes the layer's settings in flight: poses, clocks, obstacles and a standing action stay.

        OK or CORRUPTED. SettingError: one is outside its range; the settings stay as they were.
        """
        values = settings.numbers()
        bad = ffi.new("const char **")
        with self._lock:
            status = lib.goe_python_flight_change(self._c, ffi.from_buffer("float[]", values), bad)
        if bad[0] != ffi.NULL:
            raise SettingError(ffi.string(bad[0]).decode(), ": refused by the flight layer")
        return FlightStatus(status)

    def restart(self) -> None:
        """Forgets poses, clocks, obstacles and the reaction; keeps settings and counters. If the autopilot restarts."""
        with self._lock:
            lib.goe_flight_restart(self._c)

    @property
    def counters(self) -> Counters:
        """Counted since the start."""
        with self._lock:
            return Counters(*(getattr(self._c.counters, name) for name in Counters._fields))

    @property
    def capture_us(self) -> int:
        """Exposure of the latest frame taken, autopilot's clock."""
        return int(self._c.capture_us)
