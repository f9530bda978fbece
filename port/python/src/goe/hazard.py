"""What a planned flight will meet, and whether to act."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

from ._goe import ffi, lib
from ._renamed import Renamed, missing
from ._table import shortest
from .estimate import Length
from .image import vector

VELOCITY_MOST_M_S = 1e3  # each axis, as goe_intent_t has it
LENGTH_MOST_M = 1e4
SINCE_MOST_S = 1e3
VELOCITY_SD_MOST_M_S = 1e2
ACT_WITHIN_MOST_S = 1e4  # as goe_rule_t has it
SUSPECT_FACTOR_MOST = 1e2
STALE_GROWTH_MOST_M_S = 1e2

_DEFAULT = ffi.new("goe_rule_t *")
lib.goe_rule_default(_DEFAULT)
CONFLICT_PROBABILITY_MAX, ACT_WITHIN_S, SUSPECT_FACTOR, STALE_GROWTH_M_S = (
    shortest(getattr(_DEFAULT, name))
    for name in ("conflict_probability_max", "act_within_s", "suspect_factor", "stale_growth_m_s")
)


@dataclass
class Intent:
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
    """One sigma of the velocity, each axis, m/s; 0 to 100; 0: ``Navigation.velocity_bias_sd_m_s``."""

    def _to_c(self) -> Any:
        """A goe_intent_t; ValueError names a number outside its range."""
        velocity = vector(self.velocity_ned_m_s, 3, "velocity_ned_m_s")
        for value in velocity:
            _within("velocity_ned_m_s", value, -VELOCITY_MOST_M_S, VELOCITY_MOST_M_S)
        _check_intent(self)
        numbers = (self.margin_m, self.clearance_m, self.since_image_s, self.velocity_sd_m_s)
        return ffi.new("goe_intent_t *", (velocity, *numbers))


def _within(name: str, value: float, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise ValueError(f"{name} = {value:g}: not within {low:g} to {high:g}")


def _check_intent(intent: Intent | Rule) -> None:
    for name, most in (
        ("margin_m", LENGTH_MOST_M), ("clearance_m", LENGTH_MOST_M), ("since_image_s", SINCE_MOST_S),
        ("velocity_sd_m_s", VELOCITY_SD_MOST_M_S),
    ):  # fmt: skip
        _within(name, getattr(intent, name), 0.0, most)


def _check_rule(rule: DecisionRule | Rule) -> None:
    _within("conflict_probability_max", rule.conflict_probability_max, 0.0, 1.0)
    _within("act_within_s", rule.act_within_s, 0.0, ACT_WITHIN_MOST_S)
    _within("suspect_factor", rule.suspect_factor, 1.0, SUSPECT_FACTOR_MOST)
    _within("stale_growth_m_s", rule.stale_growth_m_s, 0.0, STALE_GROWTH_MOST_M_S)


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
class DecisionRule(Renamed):
    """When to act; the defaults are those of the C library."""

    conflict_probability_max: float = CONFLICT_PROBABILITY_MAX
    """Act from this probability on that margin and clearance are both violated; 0 to 1."""
    act_within_s: float = ACT_WITHIN_S
    """... if the obstacle may be reached within this time, s; 0 to 1e4."""
    suspect_factor: float = SUSPECT_FACTOR
    """Times margin and clearance while the estimate is suspect; 1 to 100."""
    stale_growth_m_s: float = STALE_GROWTH_M_S
    """Margin and clearance grow by this for each second without a new answer, m/s; 0 to 100."""

    def _to_c(self) -> Any:
        """A goe_rule_t; ValueError names a number outside its range."""
        _check_rule(self)
        numbers = (self.conflict_probability_max, self.act_within_s, self.suspect_factor, self.stale_growth_m_s)
        return ffi.new("goe_rule_t *", numbers)


class Rule(NamedTuple):
    """The decision after each image of a whole track: an ``Intent`` and a ``DecisionRule`` in one. The velocity is that
    of ``Images.velocity_ned_m_s``. For margins that never grow: ``suspect_factor=1, stale_growth_m_s=0``."""

    margin_m: float
    """As in ``Intent``."""
    clearance_m: float
    """As in ``Intent``."""
    suspect_factor: float = SUSPECT_FACTOR
    """Times both while the estimate is suspect."""
    stale_growth_m_s: float = STALE_GROWTH_M_S
    """Times the estimate's age and ``since_image_s``, added to both, m/s."""
    since_image_s: float = 0.0
    """As in ``Intent``, of every image."""
    conflict_probability_max: float = CONFLICT_PROBABILITY_MAX
    """As in ``DecisionRule``."""
    act_within_s: float = ACT_WITHIN_S
    """As in ``DecisionRule``."""
    velocity_sd_m_s: float = 0.0
    """As in ``Intent``."""

    def _check(self) -> None:
        _check_intent(self)
        _check_rule(self)


class Hazard(NamedTuple):
    """What will become of it. Sigmas are to first order."""

    tcpa_s: float
    """Until the distance to the obstacle's outline is smallest, or the path enters it, s; 0: the distance grows."""
    tcpa_sd_s: float
    """Its one sigma, s; 0 if the time is."""
    dcpa: Length
    """That distance; 0 m if the path crosses the outline."""
    clearance: Length | None
    """Camera above the top at that time, negative: below it; None: the height is not known."""
    conflict_probability: float
    """Probability, 0 to 1, that margin and clearance are both violated; without a height: that the margin is."""

    @property
    def earliest_tcpa_s(self) -> float:
        """The earliest time of the closest approach at two sigma, s."""
        c = ffi.new("goe_hazard_t *")
        c.tcpa_s, c.tcpa_sd_s = self.tcpa_s, self.tcpa_sd_s
        return float(lib.goe_earliest_tcpa_s(c))


for _kind in (Rule, Hazard):
    setattr(_kind, "__getattr__", missing)  # noqa: B010 - a checker knows the names


def hazard_of(c: Any) -> Hazard:
    """Of a goe_hazard_t."""
    clearance = Length(c.clearance_m, c.clearance_sd_m) if c.has_clearance else None
    return Hazard(c.tcpa_s, c.tcpa_sd_s, Length(c.dcpa_m, c.dcpa_sd_m), clearance, c.conflict_probability)
