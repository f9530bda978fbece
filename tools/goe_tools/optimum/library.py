"""The C library over a whole flight, through the shared library goe_batch of the host build (ctypes).

Pixels and poses go in as they are, in float32; what comes out is what firmware would get, image by image. The same
library computing in float64 (goe_batch_double) gets the same inputs and settings, rounded to float32, too."""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..places import ROOT
from .flights.flight import Flight
from .flights.noise import Noise

LIBRARY_NAMES = ("libgoe_batch.so", "libgoe_batch.dylib")
METHODS = {"window": 1, "refined": 2}
MODEL_AUTO, MODEL_DISC, MODEL_LINE, MODEL_BOX, MODEL_PRISM = 1, 2, 3, 4, 5
SEES_SIDES = np.array([0x01, 0x02, 0x04, 0x08], np.uint8)  # GOE_SEES_... of left, top, right, bottom
HAS_POSITION, HAS_LENGTH, HAS_HEIGHT, HAS_ORIENTATION, HAS_WIDTH = 0x01, 0x02, 0x04, 0x08, 0x20
VALID_BITS = (HAS_POSITION, HAS_POSITION, HAS_ORIENTATION, HAS_WIDTH, HAS_LENGTH, HAS_HEIGHT)
LABELS = ("status", "method", "model", "valid", "fresh", "suspect", "points", "nis_rows")
NUMBERS = (
    "x0_m", "z0_m", "orientation_deg", "width_m", "length_m", "height_m",
    "x0_sd_m", "z0_sd_m", "orientation_sd_deg", "width_sd_m", "length_sd_m", "height_sd_m", "nis", "misfit",
)  # fmt: skip
HAZARD = (
    "status", "time_s", "miss_m", "clearance_m", "time_sd_s", "miss_sd_m", "clearance_sd_m", "violation",
    "has_clearance",
)  # fmt: skip
TO_RADIANS = np.where(np.arange(6) == 2, np.pi / 180.0, 1.0)
SETTING_OF = {  # the library's setting for each figure of a noise
    "sigma_px": "detector.point_px",
    "size_share": "detector.point_share",
    "correlation": "detector.point_correlation",
    "shape_share": "detector.shape_share",
    "attitude_bias_deg": "navigation.attitude_bias_deg",
    "attitude_white_deg": "navigation.attitude_white_deg",
    "attitude_drift_deg": "navigation.attitude_drift_deg",
    "height_m": "navigation.height_bias_m",
    "velocity_bias_m_s": "navigation.velocity_bias_m_s",
    "position_walk_m": "navigation.position_walk_m",
    "typical_size_m": "refined.typical_size_m",
}
SMALLEST = {  # that the library takes
    "detector.point_px": 0.05, "navigation.attitude_bias_deg": 1e-3, "navigation.attitude_white_deg": 1e-4,
    "navigation.height_bias_m": 1e-3,
}  # fmt: skip


class _Track(ctypes.Structure):
    _fields_ = (
        ("images", ctypes.c_int),
        ("time_us", ctypes.c_void_p),
        ("pose", ctypes.c_void_p),
        ("pixel_px", ctypes.c_void_p),
        ("seen", ctypes.c_void_p),
        ("box_px", ctypes.c_void_p),
        ("box_seen", ctypes.c_void_p),
        ("reset_count", ctypes.c_void_p),
        ("reset_m", ctypes.c_void_p),
        ("velocity", ctypes.c_void_p),
        ("plans", ctypes.c_int),
        ("plan", ctypes.c_void_p),
        ("camera", ctypes.c_void_p),
    )


class _Answer(ctypes.Structure):
    _fields_ = (
        ("label", ctypes.c_void_p),
        ("number", ctypes.c_void_p),
        ("covariance", ctypes.c_void_p),
        ("hazard", ctypes.c_void_p),
    )


@dataclass(frozen=True)
class Plan:
    """What goe_hazard is asked after each image: the README's margins, which grow while the estimate is suspect
    (times ``doubt``) and with its age (``drift_m_s``)."""

    margin_m: float
    clearance_m: float
    doubt: float = 1.0
    drift_m_s: float = 0.0


@dataclass
class Images:
    """What the library is given over a track of K images."""

    time_s: np.ndarray  # (K,)
    position_ned_m: np.ndarray  # (K, 3)
    attitude: np.ndarray  # (K, 4) w, x, y, z
    height_m: np.ndarray  # (K,) of the camera above the ground
    pixel_px: np.ndarray  # (K, 6, 2) left, right, top, base left, near, right; any number where not seen
    seen: np.ndarray  # (K, 6)
    box_px: np.ndarray | None = None  # (K, 4) left, top, right, bottom; NaN where not seen
    reset_count: np.ndarray | None = None  # (K,) of the autopilot's filter
    reset_m: np.ndarray | None = None  # (K, 3) by how much it jumped; NaN: not known
    velocity_m_s: np.ndarray | None = None  # (K, 3) planned, for goe_hazard
    plans: tuple[Plan, ...] = ()
    camera: np.ndarray | None = None  # (K,) number of the camera; number 1 is that of the settings more_cameras[0]


@dataclass
class Track:
    """The answers of an estimator over K images. Quantities in the order x0, z0, orientation (rad), width, length,
    height; NaN where they are not valid."""

    status: np.ndarray  # (K,) goe_status_t
    method: np.ndarray  # (K,) 1 window, 2 refined, 0 none
    model: np.ndarray  # (K,) goe_model_t
    fresh: np.ndarray  # (K,) solved from this image
    suspect: np.ndarray  # (K,) does not look like a static obstacle
    values: np.ndarray  # (K, 6)
    sigma: np.ndarray  # (K, 6)
    covariance: np.ndarray  # (K, 6, 6), 0 where not valid
    nis: np.ndarray  # (K,)
    nis_rows: np.ndarray  # (K,)
    misfit: np.ndarray  # (K,)
    points: np.ndarray | None = None  # (K,) images behind the answer
    hazard: dict[str, np.ndarray] = field(default_factory=dict)  # columns of ``HAZARD``, (K, plans)
    more: dict[str, np.ndarray] = field(default_factory=dict)  # columns that not every version has, (K,)

    @property
    def valid(self) -> np.ndarray:
        """(K, 6)"""
        return np.isfinite(self.values)


def library_path(double: bool = False) -> Path:
    """Of goe_batch: $GOE_BATCH, or the host build of this checkout. ``double``: goe_batch_double, beside it."""
    told = os.environ.get("GOE_BATCH")
    candidates = [Path(told)] if told else [ROOT / "build" / "sim_host" / name for name in LIBRARY_NAMES]
    target = "goe_batch"
    if double:
        target = "goe_batch_double"
        candidates = [path.with_name(f"lib{target}{path.suffix}") for path in candidates]
    for path in candidates:
        if path.is_file():
            return path
    raise FileNotFoundError(f"{candidates[0]}: not there; build the target {target}, or name goe_batch with $GOE_BATCH")


def _names(function: ctypes._CFuncPtr) -> tuple[str, ...]:  # type: ignore[name-defined]
    function.argtypes, function.restype = (ctypes.c_int,), ctypes.c_char_p
    names: list[str] = []
    while (name := function(len(names))) is not None:
        names.append(name.decode())
    return tuple(names)


@lru_cache(maxsize=2)
def _library(double: bool) -> ctypes.CDLL:
    path = library_path(double)
    library = ctypes.CDLL(str(path))
    library.goe_batch_settings_size.restype = ctypes.c_size_t
    library.goe_batch_default.argtypes, library.goe_batch_default.restype = (ctypes.c_void_p,), None
    library.goe_batch_set.argtypes = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)
    library.goe_batch_run.argtypes = (
        ctypes.c_void_p, ctypes.POINTER(_Track), ctypes.POINTER(_Answer), ctypes.POINTER(ctypes.c_char_p),
    )  # fmt: skip
    functions = (library.goe_batch_label, library.goe_batch_number, library.goe_batch_hazard)
    for function, names in zip(functions, (LABELS, NUMBERS, HAZARD)):
        if _names(function)[: len(names)] != names:  # a later version may tell more
            raise ValueError(f"{path}: is of another version; build its target anew")
    return library


def has_setting(name: str) -> bool:
    """Whether the library has a setting of that name."""
    library = _library(False)
    buffer = ctypes.create_string_buffer(library.goe_batch_settings_size())
    library.goe_batch_default(buffer)
    return bool(library.goe_batch_set(buffer, name.encode(), 0.0) == 0)


def reason_names() -> tuple[str, ...]:
    """Of the numbers in the column ``reason`` of ``Track.more``; none of a library that tells no reasons."""
    library = _library(False)
    return _names(library.goe_batch_reason) if hasattr(library, "goe_batch_reason") else ()


def camera_settings(flight: Flight) -> dict[str, float]:
    """Settings by name for a flight's camera and for the axes of T."""
    camera = flight.camera
    result = {f"camera.{name}_px": getattr(camera, name) for name in ("fx", "fy", "cx", "cy")}
    result |= {f"camera.{name}": getattr(camera, name) for name in ("k1", "k2", "p1", "p2", "k3")}
    result |= {f"camera.mount_{axis}_deg": getattr(camera, f"mount_{axis}_deg") for axis in ("yaw", "pitch", "roll")}
    result |= {f"camera.{name}_px": size for name, size in zip(("width", "height"), flight.image_size_px)}
    result |= {f"camera.offset_m[{i}]": getattr(camera, f"offset_{axis}_m") for i, axis in enumerate("xyz")}
    return result | {"heading_auto": 0.0, "heading_deg": camera.heading_deg or 0.0}


def settings_of(flight: Flight, noise: Noise | None = None, method: str = "refined") -> dict[str, float]:
    """Settings by name for a flight's camera and for its noise, as a user would state them."""
    noise = flight.noise if noise is None else noise
    result = camera_settings(flight) | {
        "refined.top_is_highest": float(flight.top_is_highest),
        "method": float(METHODS[method]),
    }
    result |= {setting: getattr(noise, name) for name, setting in SETTING_OF.items()}
    return {name: max(value, SMALLEST.get(name, value)) for name, value in result.items()}


def _settings(library: ctypes.CDLL, values: dict[str, float]) -> ctypes.Array:
    buffer = ctypes.create_string_buffer(library.goe_batch_settings_size())
    library.goe_batch_default(buffer)
    for name, value in values.items():
        if library.goe_batch_set(buffer, name.encode(), float(np.float32(value))) != 0:
            raise ValueError(f"setting {name} = {value:g}: unknown, or no such value")
    return buffer


def estimate(
    flight: Flight, settings: dict[str, float] | None = None, *, double: bool = False,
    cameras: np.ndarray | None = None, **change: float,
) -> Track:  # fmt: skip
    """Runs the library over a flight. ``settings``: by default ``settings_of(flight)``; ``change``: single ones on top,
    with "__" for the dot (``noise__pixel_px=0.5``). ``double``: computed in float64.
    ``cameras``: (K,) number of the camera of each image; number 1 is that of the settings ``more_cameras[0]``."""
    values = dict(settings_of(flight) if settings is None else settings)
    values.update({name.replace("__", "."): value for name, value in change.items()})
    return run(replace(images_of(flight), camera=cameras), values, double=double)


def boxes_of(flight: Flight | Images) -> tuple[np.ndarray, ...]:
    """Sides (K, 4) and their seen bits (K,); nothing for a flight without boxes."""
    if flight.box_px is None:
        return ()
    seen = np.isfinite(flight.box_px)
    sides = np.ascontiguousarray(np.where(seen, flight.box_px, 0.0), np.float32)
    return sides, np.ascontiguousarray(seen @ SEES_SIDES, np.uint8)


def images_of(flight: Flight) -> Images:
    return Images(
        flight.time_s, flight.position_ned_m, flight.attitude, flight.height_m, flight.pixel_px, flight.seen,
        flight.box_px,
    )  # fmt: skip


def _given(images: Images) -> dict[str, np.ndarray]:
    """The arrays of goe_batch_track_t by name; what is not given is left out."""
    pose = np.column_stack([images.position_ned_m, images.height_m, images.attitude])
    given = {
        "time_us": np.rint(images.time_s * 1e6).astype(np.int64), "pose": np.ascontiguousarray(pose, np.float32),
        "pixel_px": np.ascontiguousarray(images.pixel_px, np.float32),
        "seen": np.ascontiguousarray(images.seen, np.uint8),
    }  # fmt: skip
    given |= zip(("box_px", "box_seen"), boxes_of(images))
    if images.reset_count is not None and images.reset_m is not None:
        given["reset_count"] = np.ascontiguousarray(images.reset_count, np.uint8)
        given["reset_m"] = np.ascontiguousarray(images.reset_m, np.float32)
    if images.camera is not None:
        given["camera"] = np.ascontiguousarray(images.camera, np.uint8)
    if images.plans and images.velocity_m_s is not None:
        given["velocity"] = np.ascontiguousarray(images.velocity_m_s, np.float32)
        plans = [(p.margin_m, p.clearance_m, p.doubt, p.drift_m_s) for p in images.plans]
        given["plan"] = np.array(plans, np.float32)
    return given


def run(images: Images, settings: dict[str, float], *, double: bool = False) -> Track:
    """Runs the library over a track."""
    library = _library(double)
    count = len(images.time_s)
    given = _given(images)
    plans = len(images.plans) if "plan" in given else 0
    names = [_names(f) for f in (library.goe_batch_label, library.goe_batch_number, library.goe_batch_hazard)]
    label = np.zeros((count, len(names[0])), np.int32)
    number = np.zeros((count, len(names[1])), np.float32)
    covariance = np.zeros((count, 6, 6), np.float32)
    hazard = np.zeros((count, plans, len(names[2])), np.float32)
    bad = ctypes.c_char_p()
    track = _Track(images=count, plans=plans, **{name: array.ctypes.data for name, array in given.items()})
    answer = _Answer(*(array.ctypes.data for array in (label, number, covariance, hazard)))
    status = library.goe_batch_run(
        _settings(library, settings), ctypes.byref(track), ctypes.byref(answer), ctypes.byref(bad)
    )
    if status != 0:
        raise ValueError(f"the library refuses the setting {bad.value.decode()}" if bad.value else f"status {status}")
    result = _track(label, number.astype(float), covariance.astype(float))
    result.hazard = {name: hazard[..., i].astype(float) for i, name in enumerate(names[2])} if plans else {}
    result.more = {name: label[:, i] for i, name in enumerate(names[0]) if name not in LABELS}
    result.more |= {name: number[:, i].astype(float) for i, name in enumerate(names[1]) if name not in NUMBERS}
    return result


def _track(label: np.ndarray, number: np.ndarray, covariance: np.ndarray) -> Track:
    column = dict(zip(LABELS, label.T))
    valid = (column["valid"][:, None] & np.array(VALID_BITS)) != 0
    return Track(
        column["status"], column["method"], column["model"], column["fresh"] != 0, column["suspect"] != 0,
        np.where(valid, number[:, :6] * TO_RADIANS, np.nan), np.where(valid, number[:, 6:12] * TO_RADIANS, np.nan),
        covariance * TO_RADIANS[:, None] * TO_RADIANS, number[:, 12], column["nis_rows"], number[:, 13],
        column["points"],
    )  # fmt: skip
