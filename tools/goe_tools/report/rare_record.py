"""Counts of events in the runs of ``goe_avoid``, and the file that contains them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..logs.fields import JSON_BYTES_MAX, LogError, read_text
from ..logs.whole_file import write_whole
from .avoid_file import COLLISION, KINDS, PASS, Avoid

FIRST_SEED = 1_000_001  # far from the seeds of tests, demo and README
WARNED_S = 3.0  # a first order less than this before the obstacle is too late
EVENTS = {  # by course: the events that are counted
    COLLISION: ("unwarned", "collided", "confident"),
    PASS: ("false_order", "confident"),
}
FLIGHTS_OF_RUN = {COLLISION: 2, PASS: 1}  # a collision course is flown with and without the orders
TAIL = 0.025  # probability beyond each end of a 95 % interval

Counts = dict[str, dict[str, dict[str, int]]]  # course, kind, event or "runs"


def events_of(avoid: Avoid) -> Counts:
    """Per course and kind: the number of runs, and of those with each event.

    doomed       a collision without orders
    unwarned     a collision without orders, and the first order came less than WARNED_S ahead or never
    collided     a collision with the orders followed
    false_order  an order on a pass at twice the margin
    confident    the obstacle's center was wrong by more than 5 sigma in five consecutive assessments, not suspect
    """
    counts: Counts = {}
    for course, names in EVENTS.items():
        counts[course] = {}
        for kind in KINDS:
            flown = avoid.flown(course, kind)
            late = ~flown.ordered | (np.nan_to_num(flown["ahead_s"]) < WARNED_S)
            happened = {
                "unwarned": (flown["collided_without"] == 1.0) & late,
                "collided": flown["collided_with"] == 1.0,
                "false_order": flown["false_order"] == 1.0,
                "confident": flown["confident"] == 1.0,
            }
            counts[course][kind] = {
                "runs": len(flown),
                "doomed": int((flown["collided_without"] == 1.0).sum()),
                **{name: int(happened[name].sum()) for name in names},
            }
    return counts


def added(one: Counts, other: Counts) -> Counts:
    return {
        course: {kind: {name: n + other[course][kind][name] for name, n in of.items()} for kind, of in kinds.items()}
        for course, kinds in one.items()
    }


def out_of(of: dict[str, int], event: str) -> int:
    """The number of runs in which the event was possible."""
    return of["doomed"] if event == "unwarned" else of["runs"]


def flights(counts: Counts) -> int:
    return sum(FLIGHTS_OF_RUN[course] * of["runs"] for course, kinds in counts.items() for of in kinds.values())


def interval(times: int, runs: int) -> tuple[float, float]:
    """Of a share, after Clopper and Pearson: the true share lies beyond each end with a probability of at most TAIL."""
    from scipy.stats import beta  # here, because the import is slow

    low = float(beta.ppf(TAIL, times, runs - times + 1)) if times > 0 else 0.0
    high = float(beta.ppf(1.0 - TAIL, times + 1, runs - times)) if times < runs else 1.0
    return low, high


@dataclass
class Record:
    """Runs from the seed FIRST_SEED on, with one version of library and flight layer."""

    version: str
    flight_hash: str  # of the flight layer's output
    date: str = ""
    runs: int = 0  # of each kind and course
    counts: Counts = field(default_factory=dict)
    first: Counts = field(default_factory=dict)  # of the first runs alone, for a check

    def write(self, path: Path) -> None:
        write_whole(path, json.dumps(asdict(self), indent=1) + "\n")


def read_record(path: Path) -> Record:
    text = read_text(path, JSON_BYTES_MAX)
    try:
        content: Any = json.loads(text)
        record = Record(**content)
        for course, names in EVENTS.items():
            for kind in KINDS:
                of = record.counts[course][kind]
                if of["runs"] != record.runs or not all(0 <= of[name] <= of["runs"] for name in names):
                    raise ValueError(f"{course}, {kind}: impossible counts")
    except (KeyError, TypeError, ValueError) as error:
        raise LogError(path, 0, "", f"not a record of rare events: {error}") from None
    return record
