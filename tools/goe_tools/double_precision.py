"""The library computing in float64, over whole tracks: sim_host's shared library goe_python_double (ctypes).

It is compiled from the same sources as the package ``goe`` with every float a double, and has the same interface:
inputs are rounded to float32 before the call, answers after it."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .places import ROOT

if TYPE_CHECKING:
    import goe

LIBRARY_NAMES = ("libgoe_python_double.so", "libgoe_python_double.dylib")


def library_path() -> Path:
    """$GOE_PYTHON_DOUBLE, or the library in this checkout's host build."""
    configured = os.environ.get("GOE_PYTHON_DOUBLE")
    candidates = [Path(configured)] if configured else [ROOT / "build" / "sim_host" / name for name in LIBRARY_NAMES]
    for path in candidates:
        if path.is_file():
            return path
    raise FileNotFoundError(
        f"{candidates[0]}: not there; build the target goe_python_double, or name it with $GOE_PYTHON_DOUBLE"
    )


def widened(dtype: np.dtype[Any]) -> np.dtype[Any]:
    """The type of the same C struct with every float a double."""
    if dtype.subdtype is not None:
        item, shape = dtype.subdtype
        return np.dtype((widened(item), shape))
    if dtype.names is not None:
        return np.dtype([(name, widened(dtype[name])) for name in dtype.names], align=True)
    return np.dtype(np.float64) if dtype == np.float32 else dtype


@lru_cache(maxsize=1)
def library() -> tuple[ctypes.CDLL, tuple[np.dtype[Any], ...]]:
    """The library and the types of its image, its estimate and its hazard."""
    import goe

    path = library_path()
    found = ctypes.CDLL(str(path))
    found.goe_python_estimator_size.restype = ctypes.c_size_t
    found.goe_python_init.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p)
    pointers, size = ctypes.c_void_p, ctypes.c_size_t
    found.goe_python_update.argtypes = (
        pointers, size, pointers, pointers, pointers, pointers, size, pointers, pointers, pointers, pointers, pointers,
    )  # fmt: skip
    found.goe_python_update.restype = None
    types = tuple(widened(dtype) for dtype in (goe.IMAGE, goe.ESTIMATE, goe.HAZARD))
    sizes = (size * 3)()
    found.goe_python_sizes(sizes)
    if tuple(sizes) != tuple(dtype.itemsize for dtype in types):
        raise ValueError(f"{path}: is of another version; rebuild its target")
    return found, types


def _pointer(array: np.ndarray | None) -> int | None:
    return None if array is None else array.ctypes.data


def run(
    settings: goe.Settings, images: goe.Images, *, rules: Sequence[goe.Rule] = (), covariance: bool = False
) -> goe.Track:
    """Like goe.run."""
    from goe.tracks import Track, empty_track, velocities

    found, (image_type, estimate_type, hazard_type) = library()
    estimator = ctypes.create_string_buffer(found.goe_python_estimator_size())
    values = settings.numbers()
    status = found.goe_python_init(estimator, values.ctypes.data, 1 + len(settings.more_cameras), None)
    if status != 0:
        raise ValueError(f"status {status}")
    single = empty_track(len(images), len(rules), covariance)
    image = images.to_c().astype(image_type)
    estimates = np.zeros(len(single), estimate_type)
    covariances = None if single.covariance is None else single.covariance.astype(np.float64)
    hazards = single.hazards.astype(hazard_type)
    table = np.array([tuple(rule) for rule in rules], np.float32).astype(np.float64)
    velocity = velocities(images, None, rules).astype(np.float64)
    found.goe_python_update(
        estimator, len(image), image.ctypes.data, single.status.ctypes.data, estimates.ctypes.data,
        _pointer(covariances), len(rules), table.ctypes.data, velocity.ctypes.data,
        single.decision.ctypes.data, single.hazard_status.ctypes.data, hazards.ctypes.data,
    )  # fmt: skip
    return Track(
        single.status, estimates.astype(single.estimates.dtype),
        None if covariances is None else covariances.astype(np.float32), single.decision, single.hazard_status,
        hazards.astype(single.hazards.dtype),
    )  # fmt: skip
