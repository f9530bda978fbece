"""Rows of a world harder than the real one: straight flights, drifting poses, uneven ground, hidden bases.

Errors without a setting of the row are those of the library's defaults, also those of boxes. All rows have the same
flights, except for what their names state."""

from __future__ import annotations

import math
from collections.abc import Iterator

from goe_tools.report.attack_lines import COVER, FOLLOWED, IMAGES, LATENCY, POSITION, SHORT, TYPICAL, VELOCITY

from .row import Ask, Range, Row, cover, suspect, wrong
from .scenario import Scenario

SECTION = "harder world"
SHARE = 0.5  # of the usual tracks
KINDS = ("corners", "outline", "boxes", "boxes with corners")
BASED = ("corners", "boxes", "boxes with corners")  # kinds that show the base
BOX_ERRORS = {"box_noise_px": 1.0, "box_noise_rel": 0.07, "box_correlation_time_s": 1.2}
HARD = Scenario(size_m=(0.3, 30.0)).by(speed_m_s=(5.0, 30.0), **BOX_ERRORS)
GROUND_SD_M = math.hypot(0.5, 2.0)  # with boxes: height_bias_sd_m and terrain_height_sd_m

CALIBRATED = (Ask(COVER, (90.0, 97.0)), Ask(TYPICAL, (0.4, 0.9)), wrong(4), suspect(2))
SURPRISED = (cover(85, "X0", "Z0"), wrong(5, POSITION))
FLAGGED_OR_COVERED = (Ask(SHORT, (0.0, 0.0)), wrong(5, POSITION))
LATE = (cover(88, "X0", "Z0"), wrong(5, POSITION), Ask(LATENCY, (88.0, 100.0), (IMAGES,)),
        Ask(VELOCITY, (88.0, 100.0), (IMAGES,), if_reported=True))  # fmt: skip
MOVING = (Ask(VELOCITY, (88.0, 97.0), (IMAGES,)), Ask(FOLLOWED, (90.0, 100.0), (IMAGES,)))


def _seen(scenario: Scenario, features: str) -> Scenario:
    """With these features, and the errors that the library expects with them."""
    ground = {"height_bias_sd_m": GROUND_SD_M} if "boxes" in features else {}
    return scenario.by(features=features, **ground)


def _rows(
    name: str, scenario: Scenario, asked: tuple[Ask, ...], kinds: tuple[str, ...] = KINDS, either: Range | None = None
) -> Iterator[Row]:
    for kind in kinds:
        yield Row(SECTION, name, _seen(scenario, kind), asked=asked, tracks_share=SHARE, either=either)


def _with_points(name: str, scenario: Scenario, asked: tuple[Ask, ...]) -> Iterator[Row]:
    """Also with left, right and top of box-shaped obstacles alone."""
    yield from _rows(name, scenario, asked)
    yield from _rows(f"{name}, box-shaped", scenario.by(kind="box"), asked, ("outline",))


HIGH = HARD.by(height_m=(50.0, 85.0))
LEVEL = HARD.by(climb_m_s=0.0)
STRAIGHT = LEVEL.by(weave_m=0.0, sway_deg=(0.0, 0.0, 0.0))
CLIMB = HIGH.by(climb_m_s=0.0, steady_climb_m_s=2.0)
ROLL = HARD.by(sway_deg=(2.0, 1.5, 25.0), sway_periods_s=((1.8, 3.0), (2.5, 4.0), (5.3, 8.0)))  # at most 30 deg/s
BUSHES, TREES, HALF = {"hidden_m": (0.5, 1.5)}, {"hidden_share": (0.2, 0.5)}, {"hidden_until": 0.5}
EVERYDAY = HIGH.by(
    sway_deg=(2.0, 1.5, 10.0), crab_deg=(3.0, 10.0), steady_climb_m_s=0.5, down_walk_m=0.03, climb_off_m_s=0.05,
    velocity_wander_m_s=0.1, slope=math.tan(math.radians(0.5)), step_m=0.5, hidden_m=(0.2, 0.6), hidden_until=0.5,
    foreign=0.02, height_white_sd_m=0.3, height_lag_s=0.2, mount_off_deg=0.5, late_s=0.02,
)  # fmt: skip

EXPECTED = [
    *_with_points("harder flights", HARD, CALIBRATED),
    *_rows("climb of 2 m/s", CLIMB, CALIBRATED),
    *_with_points("straight and level", STRAIGHT, CALIBRATED),
    *_rows("crab angle 10 to 20 deg", HARD.by(crab_deg=(10.0, 20.0)), CALIBRATED),
    *_with_points("roll rates up to 30 deg/s", ROLL, CALIBRATED),
    *_rows("cut by the border for half a track", HARD.by(at_border=True, size_m=(8.0, 30.0)), CALIBRATED, BASED[1:]),
    *_rows("height reset by 2 m, level", STRAIGHT.by(reset_m=2.0), (cover(90),), ("corners", "outline")),
]
UNEXPECTED = [
    *(row for size in (0.1, 0.3)
      for row in _rows(f"vertical drift {size:g} m", HARD.by(down_walk_m=size, climb_off_m_s=size), SURPRISED)),
    *_rows("own velocity wanders 0.3 m/s", HARD.by(velocity_wander_m_s=0.3), SURPRISED),
    *_rows("ground rises or falls 3 deg", HIGH.by(slope=math.tan(math.radians(3.0))), (wrong(5, POSITION),)),
    *_rows("ground steps by 3 m", HIGH.by(step_m=3.0), (wrong(5, POSITION),)),
    *_rows("forest", HIGH.by(canopy_m=(10.0, 20.0)), FLAGGED_OR_COVERED, either=(85.0, 80.0)),
    *_rows("bushes", HARD.by(**BUSHES), FLAGGED_OR_COVERED, BASED, (88.0, 80.0)),
    *_rows("bushes in the first half", HARD.by(**BUSHES, **HALF), FLAGGED_OR_COVERED, BASED, (88.0, 80.0)),
    *_rows("trees", HARD.by(**TREES), FLAGGED_OR_COVERED, BASED, (88.0, 80.0)),
    *_rows("trees in the first half", HARD.by(**TREES, **HALF), FLAGGED_OR_COVERED, BASED, (88.0, 80.0)),
    *_rows("10 % of another obstacle", HARD.by(foreign=0.1), SURPRISED),
    *_rows("altimeter 1 m, not configured, level", LEVEL.by(height_white_sd_m=1.0), SURPRISED),
    *_rows("altimeter 1 m, not configured, climb", CLIMB.by(height_white_sd_m=1.0), SURPRISED),
    *_rows("altimeter 0.5 s late, climb", CLIMB.by(height_lag_s=0.5), SURPRISED),
    *_rows("harder, mounting 2 deg off", HARD.by(mount_off_deg=2.0), SURPRISED),
    *(row for late in (20, 50, 100, 200)
      for row in _rows(f"harder, poses {late} ms late", HARD.by(late_s=late / 1000.0), LATE)),
    *_with_points("everyday", EVERYDAY, (cover(90), wrong(4))),
]  # fmt: skip


def _movers() -> Iterator[Row]:
    for way in ("across", "diagonal", "oncoming", "along"):
        for speed in (2.0, 5.0, 15.0):
            scenario = HARD.by(moves=way, moves_m_s=speed, collides=True)
            yield from _rows(f"harder, {way} {speed:g} m/s", scenario, MOVING, ("corners", "boxes"))


HARDER: tuple[Row, ...] = (*EXPECTED, *UNEXPECTED, *_movers())
