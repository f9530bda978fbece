"""The table of attacks, one entry each. A goal is the range of a figure; a figure without a goal is shown for
information.

Tracks with odd numbers judge and fill the table. Thresholds of the library are tuned on those with even numbers only
(``HALVES``), so no threshold is judged on the data it was fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from goe_tools.report.attack_lines import (
    ANSWERS,
    COVER,
    EVER,
    FLAGGED,
    IMAGES,
    IN_4_S,
    IN_8_S,
    LATENESS,
    MEDIAN,
    ODD,
    OR_COVERED,
    POSITION,
    REASON,
    SUSPECT,
    TIME,
    TRACKS,
    VELOCITY,
)

from .harder import HARDER
from .row import Ask, Row, cover, suspect, wrong
from .scenario import Scenario

TRACKS_EACH = 120  # of a row
HALVES = {"judge": 1, "settle": 0}  # remainder of a track's number by 2
MOVES, LATE = "moves", "late"  # words in the reasons of suspicion

BASE = Scenario()
BASELINE = Ask(COVER, (90.0, 98.0))
QUIET = Ask(ODD, (0.0, 1.0), (FLAGGED,))
STILL = Ask(REASON, (0.0, 1.0), (EVER,))  # nothing moves
ERROR_GOALS = (cover(90), wrong(4))
SHAPE_GOALS = (cover(88, "X0", "Z0"), wrong(5))
L_GOALS = (cover(88, "X0", "Z0"), wrong(5, POSITION))  # an L has no width and length in the library's sense
CONFUSED_GOALS = (Ask(SUSPECT, (85.0, 100.0), (OR_COVERED,)),)
DETECTED_GOALS = (Ask(ODD, (90.0, 100.0), (FLAGGED,)),)


def _also_by_boxes(rows: Sequence[Row]) -> list[Row]:
    """Repeats every row with upright boxes alone: position, height and the reported sizes."""
    return [each for row in rows for each in (row, replace(row, scenario=row.scenario.by(features="boxes")))]


SLOW = BASE.by(speed_m_s=(3.0, 3.0), reach_s=(20.0, 20.0), ahead_m=(60.0, 110.0))
GAP = BASE.by(speed_m_s=(12.0, 15.0), reach_s=(15.0, 25.0), gap_s=60.0)
CIRCLING = BASE.by(path="circling", reach_s=(600.0, 600.0))
AS_CONFIGURED = [
    Row("as configured", "baseline", BASE, asked=(BASELINE, suspect(1), QUIET, STILL), tracks_share=4.0),
    Row("as configured", "baseline", BASE.by(features="outline"), asked=(suspect(1), QUIET)),
    Row("as configured", "baseline", BASE.by(features="boxes"), asked=(cover(90), suspect(1), QUIET, STILL),
        tracks_share=4.0),
    Row("as configured", "slow flight, 3 m/s", SLOW, asked=(suspect(2), QUIET, STILL)),
    Row("as configured", "slow flight, 3 m/s", SLOW.by(features="boxes"), asked=(suspect(2), QUIET)),
    Row("as configured", "hover", BASE.by(path="hover", reach_s=(20.0, 20.0)), asked=(suspect(2), QUIET, STILL)),
    Row("as configured", "orbit", BASE.by(path="orbit"), asked=(cover(90), suspect(10))),
    Row("as configured", "orbit, most of a circle", BASE.by(path="full orbit"), asked=(suspect(10),)),
    Row("as configured", "60 Hz", BASE.by(rate_hz=60.0), asked=(cover(90),)),
    Row("as configured", "200 Hz", BASE.by(rate_hz=200.0), asked=(cover(90),)),
    Row("as configured", "60 s gap", GAP, asked=(cover(90),)),
    Row("as configured", "ten minutes of circling", CIRCLING, asked=(cover(90),), tracks_share=0.5),
    Row("as configured", "ahead only after a turn", BASE.by(path="after turn"),
        asked=(cover(90), Ask(ANSWERS, (90.0, 100.0), (TRACKS,)))),
]  # fmt: skip

LEVEL = BASE.by(height_m=(30.0, 60.0), climb_m_s=0.0)
CONFIGURED_ERRORS = [*_also_by_boxes([
    Row("configured errors", "height N(0,10), configured", BASE.by(height_bias_sd_m=10.0),
        {"navigation.height_bias_sd_m": 10.0}, asked=ERROR_GOALS),
    Row("configured errors", "attitude N(0,2 deg), configured", BASE.by(attitude_bias_sd_deg=2.0),
        {"navigation.attitude_bias_sd_deg": 2.0}, asked=ERROR_GOALS),
    Row("configured errors", "altimeter 1 m white, level", LEVEL.by(height_white_sd_m=1.0),
        if_known={"navigation.height_white_sd_m": 1.0}, asked=ERROR_GOALS),
    Row("configured errors", "altimeter 3 m white, level", LEVEL.by(height_white_sd_m=3.0),
        if_known={"navigation.height_white_sd_m": 3.0}, asked=ERROR_GOALS),
    Row("configured errors", "ground 5 m off, configured 5", BASE.by(ground_off_m=5.0),
        {"navigation.height_bias_sd_m": 5.0}, asked=ERROR_GOALS),
    Row("configured errors", "slope 3 %", BASE.by(slope=0.03), {"navigation.height_bias_sd_m": 10.0},
        {"navigation.terrain_slope_sd": 0.03}, asked=(cover(90),)),
]),
    Row("configured errors", "noise doubled, configured", BASE.by(point_noise_px=1.0), {"detector.point_noise_px": 1.0},
        asked=ERROR_GOALS),
    Row("configured errors", "2.5 % correlated, configured", BASE.by(features="outline", point_noise_rel=0.025),
        {"detector.point_noise_rel": 0.025, "detector.point_correlation": 0.88}, asked=ERROR_GOALS),
    Row("configured errors", "8 % correlated, configured", BASE.by(features="boxes", box_noise_rel=0.08),
        {"detector.box_noise_rel": 0.08}, asked=ERROR_GOALS),
    Row("configured errors", "mounting 2 deg off, configured 2", BASE.by(mount_off_deg=2.0),
        {"navigation.attitude_bias_sd_deg": 2.0}, asked=ERROR_GOALS),
    Row("configured errors", "height reset by 2 m, configured", BASE.by(reset_m=2.0)),
]  # fmt: skip

LATE_FLAGGED = Ask(LATENESS, (90.0, 100.0), (FLAGGED,))
UNCONFIGURED_ERRORS = [*_also_by_boxes([
    Row("unconfigured errors", "poses 50 ms late", BASE.by(late_s=0.05), asked=(cover(92),)),
    Row("unconfigured errors", "poses 100 ms late", BASE.by(late_s=0.1), asked=(cover(88), LATE_FLAGGED)),
    Row("unconfigured errors", "mounting 2 deg off", BASE.by(mount_off_deg=2.0),
        asked=(cover(80, "X0", "Z0", "W", "H"), wrong(10, POSITION))),
    Row("unconfigured errors", "focal length 3 % off", BASE.by(focal_share=0.03),
        asked=(cover(85, "X0", "Z0"), cover(75, "W", "H"))),
    Row("unconfigured errors", "k1 -0.05", BASE.by(k1=-0.05)),
    Row("unconfigured errors", "ground 5 m off, configured 0.5", BASE.by(ground_off_m=5.0)),
]),
    Row("unconfigured errors", "noise doubled", BASE.by(point_noise_px=1.0), asked=(cover(90),)),
    Row("unconfigured errors", "noise doubled, 8 %", BASE.by(features="boxes", box_noise_px=1.0, box_noise_rel=0.08),
        asked=(cover(90),)),
    Row("unconfigured errors", "noise five times", BASE.by(point_noise_px=2.5)),
    Row("unconfigured errors", "30 % outliers", BASE.by(outliers=0.3)),
]  # fmt: skip

CLIPPED = BASE.by(features="boxes", aside_m=(0.5, 5.0), size_m=(12.0, 25.0), speed_m_s=(12.0, 15.0), stop_s=0.2)
SHAPES = [
    *(Row("shapes", name, BASE.by(features=features, kind=kind), asked=L_GOALS if kind == "L" else SHAPE_GOALS)
      for features in ("outline", "boxes")
      for name, kind in (("boxes alone", "box"), ("gable roofs", "roof"), ("pylons", "pylon"), ("L-shapes", "L"))),
    Row("shapes", "clipped by the border", CLIPPED, asked=SHAPE_GOALS),
    *(Row("shapes", f"rolling by {roll:g} deg", BASE.by(features="boxes", sway_deg=(2.0, 1.5, roll)), asked=SHAPE_GOALS)
      for roll in (10.0, 25.0)),
    Row("shapes", "near corner wrong", BASE.by(kind="box", near_wrong=True), asked=CONFUSED_GOALS),
    Row("shapes", "two buildings as one", BASE.by(kind="two"), asked=CONFUSED_GOALS),
    Row("shapes", "two buildings as one", BASE.by(kind="two", features="boxes")),
]  # fmt: skip


def _mover(way: str, speed_m_s: float, features: str = "corners", *asked: Ask) -> Row:
    scenario = BASE.by(moves=way, moves_m_s=speed_m_s, features=features, collides=True)
    return Row("moving obstacles", f"{way} {speed_m_s:g} m/s", scenario, asked=asked)


def _in_4_s(percent: float) -> Ask:
    return Ask(REASON, (percent, 100.0), (IN_4_S,))


ONCOMING = (Ask(REASON, (88.0, 100.0), (IN_8_S,)), Ask(TIME, (0.0, 10.0), (MEDIAN,)))
VELOCITY_GOAL = Ask(VELOCITY, (88.0, 100.0), (IMAGES,))
MOVERS = [
    *(_mover(way, speed, "corners", _in_4_s(70 if way == "diagonal" and speed == 2.0 else 90), VELOCITY_GOAL)
      for way in ("across", "diagonal") for speed in (2.0, 5.0, 10.0, 15.0)),
    _mover("oncoming", 5.0), _mover("oncoming", 15.0, "corners", *ONCOMING, VELOCITY_GOAL),
    _mover("along", 5.0), _mover("along", 10.0),
    *(_mover(way, speed, features)
      for features in ("outline", "boxes")
      for way, speed in (("across", 2.0), ("across", 5.0), ("across", 15.0), ("diagonal", 2.0), ("diagonal", 5.0),
                         ("diagonal", 15.0), ("oncoming", 15.0), ("along", 10.0))),
]  # fmt: skip

MOUNTED = {  # configured for a camera that looks ahead: yaw, pitch, roll, degrees
    "mounting yaw +90 deg": (90.0, 0.0, 0.0), "mounting yaw -90 deg": (-90.0, 0.0, 0.0),
    "mounting yaw 180 deg": (180.0, 0.0, 0.0), "mounting roll 90 deg": (0.0, 0.0, 90.0),
    "mounting roll 180 deg": (0.0, 0.0, 180.0),
}  # fmt: skip
OWN_HEADING = {"heading_auto": 1.0}  # Z from the first reported pose
LOOKING_DOWN = BASE.by(mount_deg=(0.0, -8.0, 0.0), mount_configured_deg=(0.0, 8.0, 0.0))
CLEAR_CONVENTIONS = ("conjugated", "ENU", "FLU body", "NWU", "xyzw")
CONVENTIONS = [
    *(Row("conventions", name, BASE.by(convention=name), OWN_HEADING, asked=DETECTED_GOALS)
      for name in CLEAR_CONVENTIONS),
    Row("conventions", "0.5 s late", BASE.by(late_s=0.5), OWN_HEADING, asked=DETECTED_GOALS),
    *(Row("conventions", name, BASE.by(mount_configured_deg=angles), OWN_HEADING, asked=DETECTED_GOALS)
      for name, angles in MOUNTED.items()),
    *(Row("conventions", name, BASE.by(convention=name), OWN_HEADING)
      for name in ("roll sign", "pitch sign", "position ENU", "height in feet", "all in feet")),
    Row("conventions", "mounting pitch sign (8 deg)", LOOKING_DOWN, OWN_HEADING),
    *(Row("conventions", f"{name}, {what}", flown.by(convention=name), OWN_HEADING)
      for what, flown in (("3 m/s", SLOW), ("cylinders", BASE.by(kind="cylinder"))) for name in CLEAR_CONVENTIONS),
    *(Row("conventions", name, BASE.by(features="boxes", convention=name), OWN_HEADING) for name in CLEAR_CONVENTIONS),
]  # fmt: skip

ROWS: tuple[Row, ...] = (
    *AS_CONFIGURED,
    *CONFIGURED_ERRORS,
    *UNCONFIGURED_ERRORS,
    *SHAPES,
    *MOVERS,
    *CONVENTIONS,
    *HARDER,
)


def row_named(title: str) -> Row:
    """The row with a title; ValueError with the known titles if there is none."""
    for row in ROWS:
        if row.title == title:
            return row
    raise ValueError(f"attack {title!r}: not one of {'; '.join(row.title for row in ROWS)}")


def numbers(half: str, count: int) -> range:
    """The track numbers of a half."""
    if half not in HALVES:
        raise ValueError(f"half {half!r}: not one of {', '.join(HALVES)}")
    return range(HALVES[half], HALVES[half] + 2 * count, 2)
