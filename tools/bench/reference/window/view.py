"""Content of one image, and its report."""

from __future__ import annotations

from dataclasses import dataclass, field

from goe_tools.logs.estimates import Estimate

from ..gates import Gates
from .geometry import Point
from .precision import Real, Rounding


@dataclass
class Edge:
    left: Point
    right: Point
    counts: bool
    heading_deg: Real | None  # None: no orientation
    roundoff_deg: Rounding = 0.0


@dataclass
class View:
    """Content of one image: its features, and the rows it added."""

    gates: Gates
    points: dict[str, Point] = field(default_factory=dict)  # aligned, of the usable features
    faults: list[str] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    measured: bool = False  # the orientation
    front: Edge | None = None
    side: Edge | None = None
    side_is_right: bool = False
    sin_b: Real = 0.0
    cos_b: Real = 1.0
    added: set[str] = field(default_factory=set)  # models that got a row


@dataclass
class Report:
    """One image's answer, with details for comparisons."""

    estimate: Estimate
    gates: Gates
    roundoff: dict[str, Rounding]  # by quantity: the sigma from float32 rounding alone
    conditioning: dict[str, Rounding]  # by quantity: smallest baseline / W of its solutions; 0: none
    residual: Real
    baseline_m: Real
    fresh: bool  # solved with this image
    camera_height_m: float
