"""KITTI's cars: errors of the parked ones, and detection of the moving ones."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from goe_tools.flights.logged import kitti_flights
from goe_tools.models.judge import X0, Z0
from tqdm import tqdm

from .goal import Goal
from .measures import coverage_goals, ends
from .outcome import Outcome, outcome_of
from .work import Amount

KITTI_PATH_M = 3.0
FALSE_FLAGS = (0.0, 0.02, 0.05, 0.1, 0.2)
FALSE_ALLOWED = 0.05


def caught(static: np.ndarray, moving: np.ndarray, false_share: float) -> float:
    """Percent of the moving ones above the threshold that at most this share of the static ones exceeds."""
    allowed = math.floor(false_share * len(static) + 1e-9)
    threshold = np.sort(static)[::-1][allowed]
    return 100.0 * float(np.mean(moving > threshold))


def flag_goals(group: str, static: Sequence[Outcome], moving: Sequence[Outcome]) -> list[Goal]:
    """Share of moving obstacles that the NIS ratio detects at a share of false flags, largest and last."""
    result = []
    kinds = (
        ("misfit_most", f"{len(moving)} moving cars caught, at a share of false flags", "NIS ratio as a flag", True),
        ("nis_ratio", "caught by the last NIS ratio instead of the largest", "last NIS ratio as a flag", False),
    )
    for field_name, caught_name, area_name, asked in kinds:
        scores = [np.array([getattr(o, field_name) for o in cars]) for cars in (static, moving)]
        curve = {f"{100 * share:g} %": caught(*scores, share) for share in FALSE_FLAGS}
        wanted = (f"{100 * FALSE_ALLOWED:g} %",) if asked else ()
        result.append(Goal(group, caught_name, "%", curve, (60.0, 100.0), wanted))
        above = (scores[1][:, None] > scores[0]) + 0.5 * (scores[1][:, None] == scores[0])
        result.append(Goal(group, area_name, "1", {"area under the curve": float(above.mean())}))
    return result


def kitti_group(group: str, amount: Amount) -> list[Goal]:
    """KITTI's cars with detector boxes."""
    flights = [f for f in kitti_flights() if f.path_m() > KITTI_PATH_M]
    if not flights:
        return []
    progress = tqdm(flights, desc=group, disable=None, leave=False)
    outcomes = [outcome_of(flight) for flight in progress]
    static, moving = ([o for o in outcomes if o.truth.static == kind] for kind in (True, False))
    result = []
    for label, method, asked in (("filter", "filter", True), ("window", "window", False)):
        error = np.abs(ends(static, method))
        error[np.isnan(error)] = math.inf  # no answer counts as the worst
        z = 100.0 * error[:, Z0] / np.array([o.truth.z0_m for o in static])
        values = {"median": float(np.median(z)), "90th": float(np.sort(z)[math.ceil(0.9 * len(z)) - 1])}
        wanted = ("median",) if asked else ()
        name = f"Z0 error, {len(static)} parked cars, {label}"
        result.append(Goal(group, f"{name}, median", "%", {"median": values["median"]}, (0.0, 2.0), wanted))
        result.append(
            Goal(group, f"{name}, 90th percentile", "%", {"90th": values["90th"]}, (0, 7.0), ("90th",) if asked else ())
        )
        x = {"median": float(np.median(error[:, X0]))}
        result.append(Goal(group, f"X0 error, {label}", "m", x, (0.0, 0.15), wanted))
    for goal in coverage_goals(group, static, (90.0, 100.0)):
        goal.values = {name: goal.values[name] for name in ("X0", "Z0")}
        goal.asked = tuple(name for name in goal.asked if name in goal.values and "first" not in goal.name)
        goal.name = goal.name.replace("cylinders", "parked cars")
        result.append(goal)
    result += flag_goals(group, static, moving)
    flags = {
        name: 100.0 * float(np.mean([o.suspect for o in c])) for name, c in (("parked", static), ("moving", moving))
    }
    result.append(Goal(group, "flagged as suspect with the default threshold", "%", flags))
    return result
