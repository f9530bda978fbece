"""What a planned flight will meet, and whether to act."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

from ._goe import ffi, lib
from ._table import shortest
from .estimate import Length
from .image import vector

VELOCITY_MOST_M_S = 1e3  # each axis, as goe_plan_t has it
LENGTH_MOST_M = 1e4
SINCE_MOST_S = 1e3
VELOCITY_SD_MOST_M_S = 1e2
ACT_MOST_S = 1e4  # as goe_rule_t has it
DOUBT_MOST = 1e2
DRIFT_MOST_M_S = 1e2

_DEFAULT = ffi.new("goe_rule_t *")
lib.goe_rule_default(_DEFAULT)
VIOLATION_MAX, ACT_S, DOUBT, DRIFT_M_S = (
    shortest(number) for number in (_DEFAULT.violation_max, _DEFAULT.act_s, _DEFAULT.doubt, _DEFAULT.drift_m_s)
)


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
    velocity_sd_m_s: float = 0.0
    """One sigma of the velocity, each axis, m/s; 0 to 100; 0: ``Navigation.velocity_bias_m_s``."""

    def _to_c(self) -> Any:
        """A goe_plan_t; ValueError names a number outside its range."""
        velocity = vector(self.velocity_ned_m_s, 3, "velocity_ned_m_s")
        for value in velocity:
            _within("velocity_ned_m_s", value, -VELOCITY_MOST_M_S, VELOCITY_MOST_M_S)
        _check_plan(self)
        numbers = (self.margin_m, self.clearance_m, self.since_image_s, self.velocity_sd_m_s)
        return ffi.new("goe_plan_t *", (velocity, *numbers))


def _within(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} = {value:g}: not within {low:g} to {high:g}")


def _check_plan(plan: Plan | Rule) -> None:
    for name, most in (
        ("margin_m", LENGTH_MOST_M), ("clearance_m", LENGTH_MOST_M), ("since_image_s", SINCE_MOST_S),
        ("velocity_sd_m_s", VELOCITY_SD_MOST_M_S),
    ):  # fmt: skip
        _within(name, getattr(plan, name), 0.0, most)


def _check_rule(rule: DecisionRule | Rule) -> None:
    _within("violation_max", rule.violation_max, 0.0, 1.0)
    _within("act_s", rule.act_s, 0.0, ACT_MOST_S)
    _within("doubt", rule.doubt, 1.0, DOUBT_MOST)
    _within("drift_m_s", rule.drift_m_s, 0.0, DRIFT_MOST_M_S)


class Decision(IntEnum):
    """Only CLEAR ends an action."""

    UNKNOWN = 0
    """There is no position, or too little is known to say, which does not make it safe: keep the previous decision."""
    CLEAR = 1
    """No reason to act now."""
    ACT = 2
    """Go around, or avoid."""
    KEEP = 3
    """The call failed: keep the previous decision."""

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True)
class DecisionRule:
    """When to act; the defaults are those of the C library."""

    violation_max: float = VIOLATION_MAX
    """Act from this probability on that margin and clearance are both violated; 0 to 1."""
    act_s: float = ACT_S
    """... if the obstacle may be reached within this time, s; 0 to 1e4."""
    doubt: float = DOUBT
    """Times margin and clearance while the estimate is suspect; 1 to 100."""
    drift_m_s: float = DRIFT_M_S
    """Margin and clearance grow by this for each second without a new answer, m/s; 0 to 100."""

    def _to_c(self) -> Any:
        """A goe_rule_t; ValueError names a number outside its range."""
        _check_rule(self)
        return ffi.new("goe_rule_t *", (self.violation_max, self.act_s, self.doubt, self.drift_m_s))


class Rule(NamedTuple):
    """The decision after each image of a whole track: a ``Plan`` and a ``DecisionRule`` in one. The velocity is that
    of ``Images.velocity_ned_m_s``. For margins that never grow: ``doubt=1, drift_m_s=0``."""

    margin_m: float
    """As in ``Plan``."""
    clearance_m: float
    """As in ``Plan``."""
    doubt: float = DOUBT
    """Times both while the estimate is suspect."""
    drift_m_s: float = DRIFT_M_S
    """Times the estimate's age and ``since_image_s``, added to both, m/s."""
    since_image_s: float = 0.0
    """As in ``Plan``, of every image."""
    violation_max: float = VIOLATION_MAX
    """As in ``DecisionRule``."""
    act_s: float = ACT_S
    """As in ``DecisionRule``."""
    velocity_sd_m_s: float = 0.0
    """As in ``Plan``."""

    def _check(self) -> None:
        _check_plan(self)
        _check_rule(self)


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

    @property
    def soonest_s(self) -> float:
        """The earliest time of the closest approach at two sigma, s."""
        c = ffi.new("goe_hazard_t *")
        c.time_s, c.time_sd_s = self.time_s, self.time_sd_s
        return float(lib.goe_soonest_s(c))


def hazard_of(c: Any) -> Hazard:
    """Of a goe_hazard_t."""
    clearance = Length(c.clearance_m, c.clearance_sd_m) if c.has_clearance else None
    return Hazard(c.time_s, c.time_sd_s, Length(c.miss_m, c.miss_sd_m), clearance, c.violation)
