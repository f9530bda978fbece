"""Reads the file of ``python -m bench goals --json FILE``: every goal's required and measured figures."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..logs.fields import JSON_BYTES_MAX, LogError, read_text

QUANTITIES = ("X0", "Z0", "orientation", "W", "L", "H")  # names in the file, in the order of its tables


@dataclass(frozen=True)
class GoalRow:
    """One line: figures by name, NaN: none. ``low`` and ``high``: limits of the figures in ``asked``. A line without
    limits is for information and has ``met`` None."""

    group: str
    name: str
    unit: str
    values: dict[str, float]
    low: float
    high: float
    asked: tuple[str, ...]
    met: bool | None

    @property
    def missed(self) -> tuple[str, ...]:
        return tuple(name for name in self.asked if not self.low <= self.values.get(name, math.nan) <= self.high)

    @property
    def by_quantity(self) -> bool:
        return set(self.values) <= set(QUANTITIES)


@dataclass(frozen=True)
class Goals:
    rows: tuple[GoalRow, ...]
    quick: bool  # fewer flights than a full run
    date: str = ""  # of the run

    @property
    def asked(self) -> tuple[GoalRow, ...]:
        return tuple(row for row in self.rows if row.met is not None)

    @property
    def groups(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.group for row in self.rows))

    def find(self, group: str, name: str) -> GoalRow | None:
        """The first line of a group whose name begins with ``name``."""
        return next((row for row in self.rows if row.group == group and row.name.startswith(name)), None)


def read_goals(path: Path) -> Goals:
    try:
        content = json.loads(read_text(path, JSON_BYTES_MAX))
    except json.JSONDecodeError as error:
        raise LogError(path, error.lineno, "", error.msg) from None
    if not isinstance(content, dict) or not isinstance(content.get("goals"), list) or not content["goals"]:
        raise LogError(path, 1, "goals", "no list of goals; goals --json writes one")
    rows = tuple(_row(path, number, entry) for number, entry in enumerate(content["goals"], start=1))
    quick = bool(content.get("quick", False))
    if quick:
        rows = tuple(replace(row, asked=(), met=None) for row in rows)  # too few flights for a verdict
    return Goals(rows, quick, str(content.get("date", "")))


def _row(path: Path, number: int, entry: Any) -> GoalRow:
    try:
        low, high = entry["wanted"] if entry["wanted"] is not None else (None, None)
        values = {str(name): _number(value, math.nan) for name, value in entry["values"].items()}
        row = GoalRow(
            str(entry["group"]), str(entry["name"]), str(entry["unit"]), values, _number(low, -math.inf),
            _number(high, math.inf), tuple(entry["asked"]), entry["met"],
        )  # fmt: skip
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        reason = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise LogError(path, 0, "goals", f"goal {number}: {reason}") from None
    if row.met is not None and row.met is not (not row.missed):
        raise LogError(path, 0, "met", f"goal {number}: says {row.met}, its figures say {not row.missed}")
    return row


def _number(value: float | None, none: float) -> float:
    return none if value is None else float(value)
