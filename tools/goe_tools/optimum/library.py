"""The C library over a whole flight, through the shared library goe_batch of the host build (ctypes).

Pixels and poses go in as they are, in float32; what comes out is what firmware would get, image by image. The same
library computing in float64 (goe_batch_double) gets the same inputs and settings, rounded to float32, too."""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
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
        ("camera", ctypes.c_void_p),
    )


class _Answer(ctypes.Structure):
    _fields_ = (("label", ctypes.c_void_p), ("number", ctypes.c_void_p), ("covariance", ctypes.c_void_p))


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
    if (_names(library.goe_batch_label), _names(library.goe_batch_number)) != (LABELS, NUMBERS):
        raise ValueError(f"{path}: is of another version; build its target anew")
    return library


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


def boxes_of(flight: Flight) -> tuple[np.ndarray, ...]:
    """Sides (K, 4) and their seen bits (K,); nothing for a flight without boxes."""
    if flight.box_px is None:
        return ()
    seen = np.isfinite(flight.box_px)
    sides = np.ascontiguousarray(np.where(seen, flight.box_px, 0.0), np.float32)
    return sides, np.ascontiguousarray(seen @ SEES_SIDES, np.uint8)


def estimate(
    flight: Flight, settings: dict[str, float] | None = None, *, double: bool = False,
    cameras: np.ndarray | None = None, **change: float,
) -> Track:  # fmt: skip
    """Runs the library over a flight. ``settings``: by default ``settings_of(flight)``; ``change``: single ones on top,
    with "__" for the dot (``noise__pixel_px=0.5``). ``double``: computed in float64.
    ``cameras``: (K,) number of the camera of each image; number 1 is that of the settings ``more_cameras[0]``."""
    library = _library(double)
    values = dict(settings_of(flight) if settings is None else settings)
    values.update({name.replace("__", "."): value for name, value in change.items()})
    images = len(flight.time_s)
    pose = np.column_stack([flight.position_ned_m, flight.height_m, flight.attitude]).astype(np.float32)
    arrays = (
        np.rint(flight.time_s * 1e6).astype(np.int64), np.ascontiguousarray(pose),
        np.ascontiguousarray(flight.pixel_px, np.float32), np.ascontiguousarray(flight.seen, np.uint8),
        *boxes_of(flight),
    )  # fmt: skip
    track = _Track(images, *(array.ctypes.data for array in arrays))
    if cameras is not None:
        numbers = np.ascontiguousarray(cameras, np.uint8)
        track.camera = numbers.ctypes.data
    label = np.zeros((images, len(LABELS)), np.int32)
    number = np.zeros((images, len(NUMBERS)), np.float32)
    covariance = np.zeros((images, 6, 6), np.float32)
    bad = ctypes.c_char_p()
    status = library.goe_batch_run(
        _settings(library, values), ctypes.byref(track),
        ctypes.byref(_Answer(label.ctypes.data, number.ctypes.data, covariance.ctypes.data)), ctypes.byref(bad),
    )  # fmt: skip
    if status != 0:
        raise ValueError(f"the library refuses the setting {bad.value.decode()}" if bad.value else f"status {status}")
    return _track(label, number.astype(float), covariance.astype(float))


def _track(label: np.ndarray, number: np.ndarray, covariance: np.ndarray) -> Track:
    column = dict(zip(LABELS, label.T))
    valid = (column["valid"][:, None] & np.array(VALID_BITS)) != 0
    return Track(
        column["status"], column["method"], column["model"], column["fresh"] != 0, column["suspect"] != 0,
        np.where(valid, number[:, :6] * TO_RADIANS, np.nan), np.where(valid, number[:, 6:12] * TO_RADIANS, np.nan),
        covariance * TO_RADIANS[:, None] * TO_RADIANS, number[:, 12], column["nis_rows"], number[:, 13],
    )  # fmt: skip
