"""What one image shows, what a track has collected, and what is told of it."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np
from goe_tools.logs.estimates import Estimate

from ..gates import Gates
from ..settings import Settings
from .window import Fit, Row


@dataclass
class Edge:
    left: tuple[float, float]
    right: tuple[float, float]
    counts: bool
    heading_deg: float | None  # None: no orientation
    roundoff_deg: float = 0.0


@dataclass
class View:
    """Aligned points of the usable features, and the edges of the base."""

    points: dict[str, tuple[float, float]] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    front: Edge | None = None
    side: Edge | None = None
    side_is_right: bool = False
    measured: bool = False


@dataclass
class Mean:
    """Sliding mean. Beside each value: baseline / W of the solution that it was made of."""

    values: deque[float]
    ratios: deque[float]

    @classmethod
    def of(cls, length: int) -> Mean:
        return cls(deque(maxlen=length), deque(maxlen=length))

    def add(self, value: float, ratio: float) -> tuple[float, float]:
        """Mean of the newest values, and its variance from their spread (0 of a single one)."""
        self.values.append(value)
        self.ratios.append(ratio)
        n = len(self.values)
        return float(np.mean(self.values)), float(np.var(self.values, ddof=1)) / n if n > 1 else 0.0


@dataclass
class Track:
    """What one obstacle's track has collected."""

    settings: Settings
    heading: tuple[float, float] = (1.0, 0.0)  # cosine and sine of the heading of T's Z axis
    origin_m: np.ndarray | None = None  # with the heading that of the latest image, until one has shown a feature
    sighted: bool = False
    dx_m: float = 0.0
    dz_m: float = 0.0
    roundoff_m: float = 0.0  # of dX, dZ in float32: that of the NED positions they are differences of
    time_us: int | None = None
    rows: dict[str, deque[Row]] = field(init=False)
    line_points: int = 0
    length: Mean = field(init=False)
    height: Mean = field(init=False)
    angle_deg: float = 0.0
    angle_variance: float = 0.0
    angles: int = 0
    model: str = "none"
    fit: Fit | None = None
    extents: dict[str, tuple[float, float, float]] = field(default_factory=dict)  # value, sigma, rounding
    angle_roundoff_deg: float = 0.0

    def __post_init__(self) -> None:
        window = self.settings.window
        self.rows = {"disc": deque(maxlen=window), "line": deque(maxlen=window)}
        self.length = Mean.of(window)
        self.height = Mean.of(window)


@dataclass
class Report:
    """One image's answer with what the comparison needs beside it."""

    estimate: Estimate
    gates: Gates
    roundoff: dict[str, float]  # by quantity: the sigma that float32 rounding alone would show
    conditioning: dict[str, float]  # by quantity: smallest baseline / W of the solutions that it was made of; 0: none
    residual: float
    camera_height_m: float
