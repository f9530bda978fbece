"""What is made of aligned points: the disc's row of (5), points turned by the orientation, the heading of an edge."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .angle import DEG_PER_RAD, arctan_rad, fold_deg
from .camera import FORWARD_MIN, Point
from .single import HALF, ONE, TWO, ZERO, F

WIDTH_MIN = F(1.0e-4)
SIXTEENTH = ONE / F(16.0)


def projection_disc(left: Point, right: Point) -> tuple[np.float32, np.float32] | None:
    """(2): (xi, zeta), or None."""
    raw_size = right.x - left.x
    if not raw_size > WIDTH_MIN:
        return None
    cos_left = ONE / np.sqrt(ONE + left.x * left.x)
    cos_right = ONE / np.sqrt(ONE + right.x * right.x)
    size = raw_size * (cos_left + cos_right)
    x = HALF * (left.x + right.x) * (ONE - size * size * SIXTEENTH)
    zeta = TWO / size
    return x * zeta, zeta


def projection_turn(point: Point, s: np.float32, c: np.float32) -> np.float32 | None:
    """(4)"""
    forward = c + point.x * s
    if not forward > FORWARD_MIN * np.sqrt(ONE + point.x * point.x):
        return None
    return (point.x * c - s) / forward


@dataclass
class Edge:
    left: Point
    right: Point
    counts: bool
    has_heading: bool
    heading_deg: np.float32


def heading_deg(a: Point, b: Point) -> np.float32:
    """(1)"""
    x = a.x * b.y - a.y * b.x
    z = b.y - a.y
    rad = arctan_rad(-x, -z) if z < ZERO else arctan_rad(x, z)
    return fold_deg(rad * DEG_PER_RAD)
