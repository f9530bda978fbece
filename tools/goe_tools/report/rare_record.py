"""Events of ``goe_avoid``'s runs, counted, and the file that keeps the counts."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..logs.fields import JSON_BYTES_MAX, LogError, read_text
from ..logs.whole_file import write_whole
from .avoid_file import COLLISION, KINDS, PASS, Avoid

FIRST_SEED = 1_000_001  # far from those that tests, demo and README fly
WARNED_S = 3.0  # a first order later than this before the obstacle warns nobody
EVENTS = {  # by course: what is counted, of how many flights each run has of it
    COLLISION: ("unwarned", "collided", "confident"),
    PASS: ("false_order", "confident"),
}
FLIGHTS_OF_RUN = {COLLISION: 2, PASS: 1}  # a collision course is flown with and without the orders
TAIL = 0.025  # beyond either end of an interval of 95 %

Counts = dict[str, dict[str, dict[str, int]]]  # course, kind, event or "runs"


def events_of(avoid: Avoid) -> Counts:
    """Per course and kind: the runs, and in how many of them each event happened.

    doomed       it would have collided without orders
    unwarned     it would have collided, and the first order came less than WARNED_S ahead or never
    collided     it did, with the orders carried out
    false_order  an order on a pass at twice the margin
    confident    the obstacle's middle was five of its own sigmas off in five assessments on end, and not suspect
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
    """The runs in which the event could have happened."""
    return of["doomed"] if event == "unwarned" else of["runs"]


def flights(counts: Counts) -> int:
    return sum(FLIGHTS_OF_RUN[course] * of["runs"] for course, kinds in counts.items() for of in kinds.values())


def interval(times: int, runs: int) -> tuple[float, float]:
    """Of a share, by Clopper and Pearson: each end is missed with at most TAIL, whatever the share is."""
    from scipy.stats import beta  # here: it takes its time to start

    low = float(beta.ppf(TAIL, times, runs - times + 1)) if times > 0 else 0.0
    high = float(beta.ppf(1.0 - TAIL, times + 1, runs - times)) if times < runs else 1.0
    return low, high


@dataclass
class Record:
    """Runs with the seeds FIRST_SEED on, by one version of library and flight layer."""

    version: str
    flight_hash: str  # of the layer's bits
    date: str = ""
    runs: int = 0  # of each kind and course
    counts: Counts = field(default_factory=dict)
    first: Counts = field(default_factory=dict)  # of the first runs alone, to be flown again

    def write(self, path: Path) -> None:
        write_whole(path, json.dumps(asdict(self), indent=1) + "\n")


def read_record(path: Path) -> Record:
    text = read_text(path, JSON_BYTES_MAX)
    try:
        told: Any = json.loads(text)
        record = Record(**told)
        for course, names in EVENTS.items():
            for kind in KINDS:
                of = record.counts[course][kind]
                if of["runs"] != record.runs or not all(0 <= of[name] <= of["runs"] for name in names):
                    raise ValueError(f"{course}, {kind}: counts that cannot be")
    except (KeyError, TypeError, ValueError) as error:
        raise LogError(path, 0, "", f"not a record of rare events: {error}") from None
    return record
