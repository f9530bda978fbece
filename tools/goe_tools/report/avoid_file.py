"""Reads the file of ``goe_avoid --csv FILE``: every run with the flight layer's orders followed and without them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..logs.obslog import LogError
from .columns import read_columns

KINDS = ("mast", "building", "truck")
COLLISION, PASS = COURSES = ("collision", "pass")
NO_ORDER = "none"
ACTIONS = (NO_ORDER, "left", "right", "climb", "go_around", "hold")
LABELS = {"kind": KINDS, "course": COURSES, "action": ACTIONS}
SETUP = ("delay_s", "margin_m", "collision_m", "pass_m")  # the same in every run
NUMBERS = ("seed", "delay_s", "margin_m", "collision_m", "closest_without_m", "suspect", "assessed")
FLAGS = ("late", "collided_without", "confident")
OF_COURSE = {  # numbers and flags that only runs of this course have
    COLLISION: (("closest_with_m",), ("collided_with",)),
    PASS: (("pass_m",), ("false_order",)),
}


@dataclass(frozen=True)
class Avoid:
    """Columns are arrays of one length; text in LABELS, float64 otherwise, NaN for an empty field."""

    columns: dict[str, np.ndarray]

    def __len__(self) -> int:
        return len(self.columns["kind"])

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]

    def where(self, mask: np.ndarray) -> Avoid:
        return Avoid({name: values[mask] for name, values in self.columns.items()})

    def flown(self, course: str, kind: str | None = None) -> Avoid:
        """The runs of a course; kind None: of all kinds."""
        of_kind = np.ones(len(self), dtype=bool) if kind is None else self["kind"] == kind
        return self.where((self["course"] == course) & of_kind)

    @property
    def ordered(self) -> np.ndarray:
        return self["action"] != NO_ORDER


class _Check:
    def __init__(self, path: Path, columns: dict[str, np.ndarray]) -> None:
        self.path, self.columns = path, columns

    def all(self, name: str, good: np.ndarray, reason: str) -> None:
        """``reason`` may name the field's ``{value}``."""
        bad = np.flatnonzero(~good)
        if len(bad):
            value = self.columns[name][bad[0]]
            text = f"{value:g}" if isinstance(value, float) else repr(str(value))
            raise LogError(self.path, int(bad[0]) + 2, name, reason.format(value=text))

    def number(self, name: str, where: np.ndarray) -> None:
        values = self.columns[name]
        self.all(name, ~where | ~np.isnan(values), "empty")
        self.all(name, ~where | np.isfinite(values) & (values >= 0.0), "{value} is not a number from 0 on")

    def flag(self, name: str, where: np.ndarray) -> None:
        self.number(name, where)
        self.all(name, ~where | np.isin(self.columns[name], (0.0, 1.0)), "{value} is not 0 or 1")

    def alike(self, name: str) -> None:
        values = self.columns[name]
        there = np.flatnonzero(~np.isnan(values))
        if len(there):
            first = there[0]
            alike = np.isnan(values) | (values == values[first])
            self.all(name, alike, f"{{value}}, but {values[first]:g} in line {first + 2}")


def read_avoid(path: Path) -> Avoid:
    columns = read_columns(path, LABELS)
    of_course = [name for parts in OF_COURSE.values() for part in parts for name in part]
    for name in (*LABELS, *NUMBERS, *FLAGS, "ahead_s", *of_course):
        if name not in columns:
            raise LogError(path, 1, name, "this column is missing")
    _check_fields(_Check(path, columns))
    _check_orders(_Check(path, columns))
    return Avoid(columns)


def _check_fields(check: _Check) -> None:
    everywhere = np.ones(len(check.columns["kind"]), dtype=bool)
    for name, values in LABELS.items():
        allowed = ", ".join(values[:-1]) + " or " + values[-1]
        check.all(name, np.isin(check.columns[name], values), f"{{value}} is not {allowed}")
    for name in NUMBERS:
        check.number(name, everywhere)
    for name in FLAGS:
        check.flag(name, everywhere)
    for course, (numbers, flags) in OF_COURSE.items():
        mine = check.columns["course"] == course
        for name in numbers:
            check.number(name, mine)
        for name in flags:
            check.flag(name, mine)
        owner = "pass" if course == PASS else "collision course"
        for name in (*numbers, *flags):
            check.all(name, mine | np.isnan(check.columns[name]), f"{{value}}, but only a {owner} has one")
    for name in SETUP:
        check.alike(name)


def _check_orders(check: _Check) -> None:
    """Agreement between columns."""
    columns = check.columns
    ordered = columns["action"] != NO_ORDER
    check.all("ahead_s", ordered | np.isnan(columns["ahead_s"]), "{value}, but there was no order")
    check.all("ahead_s", ~ordered | np.isfinite(columns["ahead_s"]), "empty, but there was an order")
    check.all("late", ordered | (columns["late"] == 0.0), "{value}, but there was no order")
    wrong = np.isnan(columns["false_order"]) | (columns["false_order"] == ordered)
    check.all("false_order", wrong, "{value}, but the action contradicts it")
    check.all("suspect", columns["suspect"] <= columns["assessed"], "{value}, more than were assessed")
    runs = list(zip(columns["kind"].tolist(), columns["course"].tolist(), columns["seed"].tolist()))
    first = {run: i for i, run in reversed(list(enumerate(runs)))}
    check.all("seed", np.array([first[run] == i for i, run in enumerate(runs)]), "{value} was flown before")
