"""The goals as a table for the terminal, and as JSON for the report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import date

import numpy as np

from .goal import NAMES, Goal
from .measures import nees
from .outcome import Outcome


def _range_text(goal: Goal) -> str:
    low, high = goal.wanted
    if not goal.asked:
        return ""
    if low <= 0.0:
        return f"<= {high:g}"
    return f">= {low:g}" if high in (100.0, math.inf) else f"{low:.4g} .. {high:.4g}"


def _number_text(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def print_goal(goal: Goal) -> None:
    verdict = {None: "", True: "met", False: "missed: " + ", ".join(goal.missed)}[goal.met]
    unit = f" [{goal.unit}]" if goal.unit != "1" else ""
    if set(goal.values) <= set(NAMES):
        cells = "".join(f"{_number_text(goal.values.get(name, math.nan)):>9}" for name in NAMES)
    else:
        cells = "  " + "   ".join(f"{name} {_number_text(value)}" for name, value in goal.values.items())
    print(f"  {goal.name + unit:58.58}{_range_text(goal):>14}{cells}   {verdict}", flush=True)


def print_worst(title: str, outcomes: Sequence[Outcome], count: int) -> None:
    """Prints the flights with the largest normalized errors at the end."""
    ratios = np.nan_to_num(np.array([nees(o) for o in outcomes]))
    for i in np.argsort(-ratios)[:count]:
        o = outcomes[i]
        with np.errstate(invalid="ignore"):
            sigmas = o.filter.error[-1] / o.filter.sigma[-1]
        cells = "".join(f"{_number_text(value):>9}" for value in sigmas)
        print(f"  {f'{title}: {o.name}, seed {o.seed}':70} NEES {_number_text(ratios[i]):>8}{cells}")


def print_group(name: str, goals: Sequence[Goal], absent: str) -> None:
    """``absent``: the reason if there are none."""
    for title in dict.fromkeys(goal.group for goal in goals):
        heads = "".join(f"{head:>9.9}" for head in ("X0", "Z0", "orient.", "W", "L", "H"))
        print(f"\n{title:60.60}{'wanted':>14}{heads}")
        for goal in goals:
            if goal.group == title:
                print_goal(goal)
    if not goals:
        print(f"\n{name}: skipped, {absent}")


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def as_json(goals: Sequence[Goal], quick: bool) -> dict[str, object]:
    """For the report: {"quick", "date", "goals": [{group, name, unit, wanted: [low, high], asked, values, met}]}."""
    rows = [
        {
            "group": goal.group,
            "name": goal.name,
            "unit": goal.unit,
            "wanted": [_plain(end) for end in goal.wanted] if goal.asked else None,
            "asked": list(goal.asked),
            "values": {name: _plain(value) for name, value in goal.values.items()},
            "met": goal.met,
        }
        for goal in goals
    ]
    return {"quick": quick, "date": date.today().isoformat(), "goals": rows}
