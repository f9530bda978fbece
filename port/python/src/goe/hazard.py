"""What a planned flight will meet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from .estimate import Length
from .image import vector

VELOCITY_MOST_M_S = 1e3  # each axis, as goe_plan_t has it
LENGTH_MOST_M = 1e4
SINCE_MOST_S = 1e3


@dataclass
class Plan:
    """To fly on at constant velocity."""

    velocity_ned_m_s: Sequence[float]
    """Over the ground, north, east, down, m/s; each within 1e3."""
    margin_m: float
    """The outline of the obstacle must stay farther away than this, horizontally, m; 0 to 1e4."""
    clearance_m: float
    """... or its top must lie deeper than this below the aircraft, m; 0 to 1e4."""
    since_image_s: float = 0.0
    """How long ago the latest image was taken, s; 0 to 1e3. Times count from now."""

    def _check(self) -> None:
        for name in ("margin_m", "clearance_m"):
            _within(name, getattr(self, name), 0.0, LENGTH_MOST_M)
        for value in vector(self.velocity_ned_m_s, 3, "velocity_ned_m_s"):
            _within("velocity_ned_m_s", value, -VELOCITY_MOST_M_S, VELOCITY_MOST_M_S)
        _within("since_image_s", self.since_image_s, 0.0, SINCE_MOST_S)


def _within(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} = {value:g}: not within {low:g} to {high:g}")


class Rule(NamedTuple):
    """What is asked after each image of a whole track: margin and clearance that grow while the estimate is in doubt or
    old. The velocity is that of ``Images.velocity_ned_m_s``."""

    margin_m: float
    """As in ``Plan``."""
    clearance_m: float
    """As in ``Plan``."""
    doubt: float = 1.0
    """Times both while the estimate is suspect."""
    drift_m_s: float = 0.0
    """Times the estimate's age, added to both, m/s."""
    since_image_s: float = 0.0
    """As in ``Plan``, of every image."""


class Hazard(NamedTuple):
    """What will become of it. Sigmas are to first order."""

    time_s: float
    """Until the distance to the obstacle's outline is smallest, or the path enters it, s; 0: the distance grows."""
    time_sd_s: float
    """Its one sigma, s; 0 if the time is."""
    miss: Length
    """That distance; 0 m if the path crosses the outline."""
    clearance: Length | None
    """Camera above the top at that time, negative: below it; None: the height is not known."""
    violation: float
    """Probability, 0 to 1, that margin and clearance are both violated; without a height: that the margin is."""


def hazard_of(c: Any) -> Hazard:
    """Of a goe_hazard_t."""
    clearance = Length(c.clearance_m, c.clearance_sd_m) if c.has_clearance else None
    return Hazard(c.time_s, c.time_sd_s, Length(c.miss_m, c.miss_sd_m), clearance, c.violation)
