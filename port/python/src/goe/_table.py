"""The settings as the C library lists them: names, ranges, defaults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count, takewhile
from typing import Any

import numpy as np

from ._goe import ffi, lib

COUNT, TRUTH, CHOICE = lib.GOE_PYTHON_COUNT, lib.GOE_PYTHON_TRUTH, lib.GOE_PYTHON_CHOICE


@dataclass(frozen=True)
class Row:
    """One setting. A default outside the range: it must be set."""

    name: str  # as in C: "detector.point_noise_px"
    unit: str  # "px"; "": none, or the flight layer's, where the name ends in it
    text: str  # description; "" in the flight layer
    kind: int
    low: float
    high: float
    default: float

    @property
    def whole(self) -> bool:
        """Takes whole numbers only."""
        return self.kind in (COUNT, TRUTH, CHOICE)


def shortest(number: float) -> float:
    """The shortest decimal number that is the same in single precision: 0.05, not 0.05000000074505806."""
    return float(str(np.float32(number)))


def _rows(row_of: Callable[[int], Any]) -> tuple[Row, ...]:
    def text(place: Any) -> str:
        return ffi.string(place).decode()

    found = takewhile(lambda row: row != ffi.NULL, (row_of(number) for number in count()))
    return tuple(
        Row(text(r.name), text(r.unit), text(r.text), r.kind, *(shortest(n) for n in (r.low, r.high, r.value)))
        for r in found
    )


ROWS = _rows(lib.goe_python_setting)
CAMERA_ROWS = ROWS[: lib.goe_python_camera_settings()]
FLIGHT_ROWS = _rows(lib.goe_python_flight_setting)

_DEFAULTS = {row.name: row.default for row in ROWS}
_FLIGHT_DEFAULTS = {row.name: row.default for row in FLIGHT_ROWS}


def real(name: str) -> float:
    """The default of a setting of the estimator."""
    return _DEFAULTS[name]


def whole(name: str) -> int:
    """The same of one that is a whole number."""
    return int(_DEFAULTS[name])


def flight(name: str) -> float:
    """The default of a setting of the flight layer."""
    return _FLIGHT_DEFAULTS[name]
