"""The numbers of one precision: its constants, and functions of angles.

NumPy's scalars keep their precision only among themselves (before NumPy 2 a Python float makes a float64 of them), so
every constant of the method is in this file and is converted once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Callable, Union

import numpy as np

from . import polynomials

Real = Union[np.float32, np.float64]
DType = type[Real]
Rounding = float  # Python floats, for rounding estimates and margins of decisions, which do not affect results


@dataclass
class Numbers:
    """All constants; ``numbers`` converts them to one precision."""

    zero: Real = 0.0
    quarter: Real = 0.25
    half: Real = 0.5
    one: Real = 1.0
    two: Real = 2.0
    sixteenth: Real = 0.0625
    right_angle_deg: Real = 90.0
    half_turn_deg: Real = 180.0
    deg_per_rad: Real = 180.0 / math.pi
    norm_min: Real = 0.99  # of the attitude's quaternion
    norm_max: Real = 1.01
    level_nose_min: Real = 1e-3
    aside_min: Real = 1.7320508075688772  # tangent of 60 degrees
    forward_min: Real = 0.05
    width_min: Real = 1e-4
    ambiguous_deg: Real = 30.0
    parallax_min: Real = 1e-6
    metres_max: Real = 1e6
    sigma_max_m: Real = 1e9
    ray_max: Real = 20.0
    radial_min: Real = 0.05
    radial_max: Real = 1e6
    undistort_failed: Real = 1e-4
    undistort_done: Real = 0.0  # float64 iterates to its last digits
    real: DType = field(default=np.float64, repr=False)
    arctan_rad: Callable[[Real, Real], Real] = np.arctan2  # of y/x, x >= 0
    sincos_deg: Callable[[Real], tuple[Real, Real]] = field(
        default=lambda deg: (np.sin(np.radians(deg)), np.cos(np.radians(deg)))
    )

    def fold_deg(self, deg: Real) -> Real:
        """The angle of the same undirected line in (-90, 90], from one in (-270, 270)."""
        if deg > self.right_angle_deg:
            return deg - self.half_turn_deg
        return deg + self.half_turn_deg if deg <= -self.right_angle_deg else deg


def numbers(dtype: DType) -> Numbers:
    """The constants in float64 or float32, the latter with the library's polynomials."""
    if dtype not in (np.float32, np.float64):
        raise ValueError(f"{dtype}: neither float32 nor float64")
    made = Numbers()
    for constant in fields(Numbers):
        if isinstance(constant.default, float):
            setattr(made, constant.name, dtype(constant.default))
    if dtype is np.float32:
        made.real = np.float32
        made.arctan_rad, made.sincos_deg = polynomials.arctan_rad, polynomials.sincos_deg
        made.undistort_done = np.float32(1e-7)
    return made
