"""What the estimator has to know before it starts.

Names, units and meaning are those of goe_settings_t in goe.h; defaults and ranges come from the C library. Numbers are
rounded to single precision. A range is checked when an estimator is made, or by ``Settings.check``; a name that is not
there is refused at once.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from . import _renamed, _table
from ._goe import lib
from ._table import CAMERA_ROWS, FLIGHT_ROWS, ROWS, Row, flight, real, whole
from .status import Method, SettingError, Shape

CAMERAS_MAX: int = lib.GOE_CAMERAS_MAX
"""Cameras of one aircraft, the first included."""

METHOD_DEFAULT, SHAPE_DEFAULT = Method(whole("method")), Shape(whole("model"))
NAME = re.compile(r"(?:(\w+)(?:\[(\d+)\])?\.)?(\w+)(?:\[(\d+)\])?")


def _meant(name: str, names: Sequence[str]) -> str:
    close = difflib.get_close_matches(name, names, n=1)
    return f"; did you mean {close[0]}?" if close else ""


class _Group(_renamed.Renamed):
    """Takes no names but its own."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __setattr__(self, name: str, value: Any) -> None:
        names = self.__dataclass_fields__
        if name in _renamed.FIELDS.get(type(self).__name__, {}):
            raise AttributeError(_renamed.unknown(type(self).__name__, name))
        if name not in names:
            raise AttributeError(f"{type(self).__name__} has no setting {name}{_meant(name, tuple(names))}")
        object.__setattr__(self, name, value)


@dataclass
class Camera(_Group):
    """Pinhole camera with Brown-Conrady lens, in OpenCV's conventions, and how it sits on the aircraft.

    The camera that is not turned looks along body x, with image x = body y and image y = body z. It is turned by yaw
    about z, then pitch about the new y, then roll about the newest x: a camera that looks left has a negative yaw.
    """

    fx_px: float = real("camera.fx_px")
    """Focal length along x, px; 1 to 1e5; must be set."""
    fy_px: float = real("camera.fy_px")
    """Focal length along y, px; 1 to 1e5; must be set."""
    cx_px: float = real("camera.cx_px")
    """Principal point from the left, px; within 1e5; must be set."""
    cy_px: float = real("camera.cy_px")
    """Principal point from the top, px; within 1e5; must be set."""
    k1: float = real("camera.k1")
    """Lens distortion, radial."""
    k2: float = real("camera.k2")
    """Lens distortion, radial."""
    p1: float = real("camera.p1")
    """Lens distortion, tangential."""
    p2: float = real("camera.p2")
    """Lens distortion, tangential."""
    k3: float = real("camera.k3")
    """Lens distortion, radial."""
    mount_yaw_deg: float = real("camera.mount_yaw_deg")
    """Mounting, degrees."""
    mount_pitch_deg: float = real("camera.mount_pitch_deg")
    """Mounting, degrees."""
    mount_roll_deg: float = real("camera.mount_roll_deg")
    """Mounting, degrees."""
    offset_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Camera relative to the pose's reference point, body axes: forward, right, down, m."""
    width_px: float = real("camera.width_px")
    """Width of the image, px; 0: not known, and boxes that the border cuts are not noticed. The flight layer needs
    it."""
    height_px: float = real("camera.height_px")
    """Height of the image, px; 0: as with ``width_px``. The flight layer needs it."""
    border_rel: float = real("camera.border_rel")
    """A box's side nearer to the border than this is not measured, fraction of the image's width."""
    truncation_rel: float = real("camera.truncation_rel")
    """While left or right is nearer to the border than this the other sides count less:
    ``Detector.truncation_noise_rel``."""


@dataclass
class Navigation(_Group):
    """How wrong the pose is, one sigma each; for the filter method."""

    attitude_bias_sd_deg: float = real("navigation.attitude_bias_sd_deg")
    """Constant attitude error about each body axis, mounting included, degrees."""
    attitude_white_sd_deg: float = real("navigation.attitude_white_sd_deg")
    """Attitude error that is new in each image, degrees."""
    attitude_walk_sd_deg: float = real("navigation.attitude_walk_sd_deg")
    """Random walk of the attitude error, degrees per square root of a second."""
    height_bias_sd_m: float = real("navigation.height_bias_sd_m")
    """Constant error of the pose's ``height_m`` over the obstacle's ground, m."""
    velocity_bias_sd_m_s: float = real("navigation.velocity_bias_sd_m_s")
    """Constant error of the own horizontal velocity, each axis, m/s."""
    position_walk_sd_m: float = real("navigation.position_walk_sd_m")
    """Random walk of the own position, m per square root of a second."""
    position_white_sd_m: float = real("navigation.position_white_sd_m")
    """Error of the own position that is new in each image, each axis, m."""
    height_white_sd_m: float = real("navigation.height_white_sd_m")
    """Error of the height that is new in each image, m; 0: points take each image's height as it is."""
    terrain_slope_sd: float = real("navigation.terrain_slope_sd")
    """Slope of the ground that the height is above, m per m flown."""
    terrain_height_sd_m: float = real("navigation.terrain_height_sd_m")
    """How far the obstacle's ground may lie off that which the height is above, m. Upright boxes only."""


@dataclass
class Detector(_Group):
    """How wrong the detector's features are, one sigma each; for the filter method."""

    point_noise_px: float = real("detector.point_noise_px")
    """Error of an image point, new in each image, px."""
    point_noise_rel: float = real("detector.point_noise_rel")
    """Error of left, right and top as points, added to it, fraction of the silhouette's width."""
    point_correlation: float = real("detector.point_correlation")
    """Correlation of a point's error from image to image."""
    shape_error_rel: float = real("detector.shape_error_rel")
    """How far a real silhouette departs from that of a disc or prism, fraction of its width; cars: about 0.12."""
    box_noise_px: float = real("detector.box_noise_px")
    """Error of a box's side that is new in each image, px."""
    box_noise_rel: float = real("detector.box_noise_rel")
    """Slowly varying (correlated) error of a side, fraction of the box's width or height."""
    box_correlation_time_s: float = real("detector.box_correlation_time_s")
    """Correlation time of this error, s."""
    truncation_noise_rel: float = real("detector.truncation_noise_rel")
    """Error of every side while the image's border cuts the box, fraction of the box."""


@dataclass
class FilterSettings(_Group):
    """The filter method: a square-root information filter over the whole track."""

    prior_width_m: float = real("filter.prior_width_m")
    """Width that the range is first guessed from, m."""
    gate_sigma: float = real("filter.gate_sigma")
    """A point farther off is left out, sigmas."""
    huber_sigma: float = real("filter.huber_sigma")
    """A point farther off counts less, sigmas."""
    nis_ratio_max: float = real("filter.nis_ratio_max")
    """NIS ratio above which the obstacle is suspect."""
    range_sd_rel_max: float = real("filter.range_sd_rel_max")
    """Sigma over range up to which a position is reported."""
    top_is_highest: bool = bool(whole("filter.top_is_highest"))
    """True: ``top`` is the roof's highest point in the image; False: it is the roof's nearest point."""


@dataclass
class WindowSettings(_Group):
    """The paper's method: least squares over the last images."""

    points: int = whole("window.points")
    """Images in the window."""
    line_points: int = whole("window.line_points")
    """Number of line points, at least ``points``, after which the line replaces the disc."""
    edge_min_px: float = real("window.edge_min_px")
    """An edge counts if its ends are farther apart, px."""
    orientation_min_px: float = real("window.orientation_min_px")
    """... and has an orientation if they differ by more in aligned y, px."""
    side_min_px: float = real("window.side_min_px")
    """Least x distance of a side's ends to its vanishing point that gives a length, px."""
    orientation_memory: int = whole("window.orientation_memory")
    """Images that the low-pass of the orientation remembers."""
    min_baseline_m: float = real("window.min_baseline_m")
    """Least spread of the flown baseline, m."""


@dataclass
class Settings(_Group):
    """All settings of an estimator.

    >>> settings = Settings.for_camera(914.0, 914.0, 640.0, 480.0, width_px=1280, height_px=960)
    >>> settings.navigation.attitude_bias_sd_deg = 1.0
    """

    camera: Camera = field(default_factory=Camera)
    """Number 0."""
    more_cameras: tuple[Camera, ...] = ()
    """Numbers 1 on; at most ``CAMERAS_MAX`` - 1."""
    method: Method = METHOD_DEFAULT
    """How it is estimated."""
    shape: Shape = SHAPE_DEFAULT
    """Which shapes it may take the obstacle for; ``model`` in C."""
    heading_deg: float | None = None
    """Where Z of the trajectory's axes points: clockwise from north, degrees; None: where the nose does at the track's
    first image, which is the first one that shows a feature (``heading_auto`` in C)."""
    navigation: Navigation = field(default_factory=Navigation)
    """Errors of the pose."""
    detector: Detector = field(default_factory=Detector)
    """Errors of the features."""
    filter: FilterSettings = field(default_factory=FilterSettings)
    """The filter method."""
    window: WindowSettings = field(default_factory=WindowSettings)
    """The window method."""

    @classmethod
    def for_camera(
        cls, fx_px: float, fy_px: float, cx_px: float, cy_px: float, width_px: float, height_px: float, **more: Any
    ) -> Settings:
        """The defaults, with a camera of these focal lengths, this principal point and this image size, px; ``more``:
        others of its fields.

        Without the size the estimator takes the sides of a box that the image border cuts for the obstacle's own.
        SettingError: the size is not positive.
        """
        for name, size_px in (("width_px", width_px), ("height_px", height_px)):
            if not size_px > 0:
                raise SettingError(f"camera.{name}", f" = {size_px}: give the size of the image, px")
        return cls(camera=Camera(fx_px, fy_px, cx_px, cy_px, width_px=width_px, height_px=height_px, **more))

    @classmethod
    def from_names(cls, values: Mapping[str, float]) -> Settings:
        """The defaults, changed by name as in C and in goe_replay's ``--set``: {"detector.point_noise_px": 0.8,
        "method": 1, "heading_auto": 0, "heading_deg": 90, "more_cameras[0].fx_px": 900, ...}.

        Raises SettingError for a name that is not there.
        """
        settings, rest = cls(), dict(values)
        auto, heading_deg = rest.pop("heading_auto", 1), rest.pop("heading_deg", 0.0)
        if auto not in (0, 1):
            raise SettingError("heading_auto", f" = {auto}: not 0 or 1")
        settings.heading_deg = None if auto else heading_deg
        for name, value in rest.items():
            settings._assign(name, value)
        return settings

    def _assign(self, name: str, value: Any) -> None:
        parts = NAME.fullmatch(name)
        group, number, own, index = parts.groups() if parts else (None, None, name, None)
        if name in _renamed.SETTINGS:
            raise SettingError(name, f": unknown setting, now {_renamed.SETTINGS[name]}")
        known = name if number is None else f"camera.{own}" + (f"[{index}]" if index else "")
        row = _BY_NAME.get(known)
        if row is None or (number is not None and (group != "more_cameras" or int(number) + 1 >= CAMERAS_MAX)):
            raise SettingError(name, f": no such setting{_meant(name, tuple(_BY_NAME))}")
        if group is None:
            own, value = _general(row, value)
        place: Any = self if group is None else self._group(group, number)
        if index is not None:
            vector = list(getattr(place, own))
            vector[int(index)] = value
            value = tuple(vector)
        elif row.kind == _table.TRUTH and value in (0, 1):
            value = bool(value)
        setattr(place, own, value)

    def _group(self, group: str, number: str | None) -> Any:
        if number is None:
            return getattr(self, group)
        while len(self.more_cameras) <= int(number):
            self.more_cameras += (Camera(),)
        return self.more_cameras[int(number)]

    def check(self) -> None:
        """Raises SettingError for the first setting that is outside its range or no number."""
        self.numbers()

    def numbers(self) -> npt.NDArray[np.float64]:
        """All of them, checked and as single precision holds them, in the order of ``setting_rows``; after them those
        of each further camera."""
        count = len(self.more_cameras)
        if count >= CAMERAS_MAX:
            raise SettingError("more_cameras", f": {count}, not at most {CAMERAS_MAX - 1}")
        values = _camera_values(self.camera, "camera")
        values += [self._value(group, own) for group, own in _OTHERS]
        for number, camera in enumerate(self.more_cameras):
            values += _camera_values(camera, f"more_cameras[{number}]")
        return checked(_bounds(count), values, _name_of)

    def _value(self, group: str, own: str) -> Any:
        if group:
            return getattr(getattr(self, group), own)
        if own == "heading_auto":
            return self.heading_deg is None
        if own == "heading_deg":
            return 0.0 if self.heading_deg is None else self.heading_deg
        return self.shape if own == "model" else self.method


_BY_NAME = {row.name: row for row in ROWS}
_CAMERA_FIELDS = tuple(dict.fromkeys(row.name.rpartition(".")[2].partition("[")[0] for row in CAMERA_ROWS))
_OTHERS = tuple(row.name.rpartition(".")[::2] for row in ROWS[len(CAMERA_ROWS) :])


def _general(row: Row, value: Any) -> tuple[str, Any]:
    """Name and value in Settings of a setting without group: method or model."""
    own, kind = ("shape", Shape) if row.name == "model" else ("method", Method)
    if value not in tuple(kind):
        raise SettingError(row.name, f" = {value:g}: not one of {', '.join(f'{k:d} ({k})' for k in kind)}")
    return own, kind(int(value))


def _camera_values(camera: Camera, prefix: str) -> list[Any]:
    """In the order of the C list."""
    values: list[Any] = []
    for own in _CAMERA_FIELDS:
        value = getattr(camera, own)
        if own != "offset_m":
            values.append(value)
        elif len(value) != 3:
            raise SettingError(f"{prefix}.{own}", f": {len(value)} numbers, not 3")
        else:
            values += value
    return values


def _name_of(number: int) -> str:
    """Of the number-th of all values."""
    if number < len(ROWS):
        return ROWS[number].name
    camera, row = divmod(number - len(ROWS), len(CAMERA_ROWS))
    return CAMERA_ROWS[row].name.replace("camera", f"more_cameras[{camera}]")


@dataclass(frozen=True)
class _Bounds:
    """The rows' ranges as arrays."""

    rows: tuple[Row, ...]
    low: npt.NDArray[np.float32]
    high: npt.NDArray[np.float32]
    any: npt.NDArray[np.bool_]  # not only whole numbers


@cache
def _bounds(more_cameras: int) -> _Bounds:
    return _bounds_of(ROWS + CAMERA_ROWS * more_cameras)


def _bounds_of(rows: tuple[Row, ...]) -> _Bounds:
    low, high = (np.array([getattr(row, name) for row in rows], np.float32) for name in ("low", "high"))
    return _Bounds(rows, low, high, np.array([not row.whole for row in rows]))


_USUAL = {int, float, bool, Method, Shape, np.float64, np.float32}


def checked(bounds: _Bounds, values: Sequence[Any], name_of: Callable[[int], str]) -> npt.NDArray[np.float64]:
    """Numbers that single precision holds, each within its row's range; SettingError names the first that is not."""
    if not {type(value) for value in values} <= _USUAL:
        for i, value in enumerate(values):
            if not isinstance(value, (int, float, np.number, np.bool_)):
                raise SettingError(name_of(i), f" = {value!r}: not a number")
    with np.errstate(over="ignore", invalid="ignore"):
        numbers = np.array(values, np.float64).astype(np.float32)
        inside = (numbers >= bounds.low) & (numbers <= bounds.high)
        good = inside & (bounds.any | (numbers == np.rint(numbers)))
    if not good.all():
        i = int(np.argmin(good))
        raise SettingError(name_of(i), f" = {float(values[i]):g}: " + _wanted(bounds.rows[i], bool(inside[i])))
    return numbers.astype(np.float64)


def _wanted(row: Row, inside: bool) -> str:
    unit = f" {row.unit}" if row.unit else ""
    must = "; it must be set" if not row.low <= row.default <= row.high else ""
    return "not a whole number" if inside else f"not within {row.low:g} to {row.high:g}{unit}{must}"


def setting_rows() -> Iterator[Row]:
    """Every setting as C lists it: ``name``, ``unit``, ``text``, ``low``, ``high``, ``default``."""
    return iter(ROWS)


_FLIGHT_BOUNDS = _bounds_of(FLIGHT_ROWS)


@dataclass
class FlightSettings(_Group):
    """Settings of the flight layer, in addition to those of the estimators."""

    score_min: float = flight("score_min")
    """Detections with a lower score are ignored."""
    confirm_images: float = flight("confirm_images")
    """Images with a new obstacle, at most 1 s apart, before it gets a slot."""
    detector_timeout_s: float = flight("detector_timeout_s")
    """The detector counts as dead after this time without a frame, s."""
    track_timeout_s: float = flight("track_timeout_s")
    """An obstacle is dropped after this time undetected, s."""
    delay_s: float = flight("delay_s")
    """Least time from sending to arrival, s."""
    delay_sd_s: float = flight("delay_sd_s")
    """One sigma of ``delay_s``, and of a capture time without a sigma, s."""
    delay_max_s: float = flight("delay_max_s")
    """Frames that arrive later than this after their exposure are refused, s."""
    resets: float = flight("resets")
    """How the autopilot reports resets: 0 by counters (PX4), 1 by times (ArduPilot)."""
    range_finder_sd_m: float = flight("range_finder_sd_m")
    """One sigma of the range finder, m."""
    range_finder_max_m: float = flight("range_finder_max_m")
    """Greatest height at which the layer uses the range finder, m."""
    terrain_sd_m: float = flight("terrain_sd_m")
    """One sigma of the terrain's height, m."""
    home_sd_m: float = flight("home_sd_m")
    """One sigma of the height over home, m."""
    margin_m: float = flight("margin_m")
    """Wanted horizontal distance to the outline, m."""
    clearance_m: float = flight("clearance_m")
    """Wanted vertical distance over the top, m."""
    conflict_probability_max: float = flight("conflict_probability_max")
    """Least conflict probability that causes a reaction."""
    suspect_factor: float = flight("suspect_factor")
    """Factor on margin and clearance while the estimate is suspect."""
    stale_growth_m_s: float = flight("stale_growth_m_s")
    """Growth of margin and clearance while the estimate is not updated, m/s."""
    bank_deg: float = flight("bank_deg")
    """Bank of an avoiding turn, degrees."""
    roll_in_s: float = flight("roll_in_s")
    """Time from the order to that turn, s."""
    climb_m_s: float = flight("climb_m_s")
    """Rate of an avoiding climb, m/s."""
    climb_in_s: float = flight("climb_in_s")
    """Time from the order to that climb, s."""
    loiter_m: float = flight("loiter_m")
    """Radius of the autopilot's circle around a target, m; 0: it flies straight on."""
    reserve_s: float = flight("reserve_s")
    """An order comes this long before the last possible moment, s."""
    confirm_s: float = flight("confirm_s")
    """An order comes after the hazard has lasted this long, s."""
    hold_s: float = flight("hold_s")
    """An order ends after the hazard has been over for this long, s."""
    order_height_m: float = flight("order_height_m")
    """No new order below this height above the ground, m; 0: no limit."""
    order_speed_m_s: float = flight("order_speed_m_s")
    """No new order below this speed over the ground, m/s."""

    def check(self) -> None:
        """Raises SettingError for the first setting that is outside its range or no number."""
        self.numbers()

    def numbers(self) -> npt.NDArray[np.float32]:
        """All of them, checked, in the order of goe_flight_settings_t."""
        names = [row.name for row in FLIGHT_ROWS]
        return checked(_FLIGHT_BOUNDS, [getattr(self, n) for n in names], names.__getitem__).astype(np.float32)
