"""Reads the folder of goe_campaign: cases.csv, campaign.json, series/*.csv."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..logs.fields import JSON_BYTES_MAX, LogError, read_text
from .avoid_file import Avoid, read_avoid
from .columns import read_columns
from .goals_file import Goals, read_goals
from .rare_record import Record, read_record

LABELS = ("study", "obstacle", "path", "speed_profile", "wind", "noise", "method", "model")
SETUP = ("case", "side_m", "alpha_deg", "altitude_m", "glide_deg", "seed", "window", "fps_hz", "fraction")
COUNTS = ("frames", "solved", "used")
QUANTITIES = ("z0", "x0", "width", "length", "height", "orientation")
IN_PERCENT = ("z0", "x0", "width", "length")
MEASURES = ("mean", "two_sigma", "rmse")
COVERED = ("z0", "x0", "height")
OPTIONAL = ("fresh_line_share", "swapped", "baseline_m", "condition", *(f"{q}_covered" for q in COVERED))
SAME_CASE = ("obstacle", "model", "side_m", "alpha_deg", "altitude_m", "glide_deg")


def _required() -> tuple[str, ...]:
    errors = [f"{q}_{part}" for q in QUANTITIES for part in ("truth", *MEASURES)]
    percents = [f"{q}_{part}_pct" for q in IN_PERCENT for part in MEASURES]
    return (*LABELS, *SETUP, *COUNTS, *errors, *percents)


@dataclass(frozen=True)
class Cases:
    """Rows of cases.csv. Columns are arrays of one length; text in LABELS, float64 otherwise, NaN for an
    empty field."""

    columns: dict[str, np.ndarray]

    def __len__(self) -> int:
        return len(self.columns["case"])

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]

    def where(self, mask: np.ndarray) -> Cases:
        return Cases({name: values[mask] for name, values in self.columns.items()})

    def select(self, **wanted: Any) -> Cases:
        """The rows whose columns have these values (a tuple: one of them)."""
        mask = np.ones(len(self), dtype=bool)
        for name, value in wanted.items():
            values = value if isinstance(value, tuple) else (value,)
            mask &= np.isin(self[name], np.array(values, dtype=self[name].dtype))
        return self.where(mask)

    def levels(self, name: str) -> list[Any]:
        """The distinct values of a column, ascending."""
        values = self[name]
        if values.dtype.kind == "f":
            return [float(value) for value in np.unique(values[np.isfinite(values)])]
        return [str(value) for value in np.unique(values)]

    def keys(self, names: Sequence[str] = SAME_CASE) -> list[tuple[Any, ...]]:
        """The key of each row's case, the same in all studies."""
        return list(zip(*(self[name].tolist() for name in names)))


@dataclass(frozen=True)
class Campaign:
    folder: Path
    cases: Cases
    facts: dict[str, Any]  # campaign.json
    refined: Cases | None = None  # rows of the filter method, if the campaign has any
    goals: Goals | None = None
    avoid: Avoid | None = None  # runs of goe_avoid
    rare: Record | None = None  # the record of the rare command
    approach: Path | None = None  # the log that the first page shows

    def series(self, case: int, model: str) -> Cases | None:
        """The time series of a case of the paper's study (first seed), or None if it was not written."""
        path = self.folder / "series" / f"{case}_{model}.csv"
        if not path.is_file():
            return None
        columns = read_columns(path, text=("status", "model"))
        columns["case"] = np.full(len(columns["t_s"]), float(case))
        return Cases(columns)


def read_campaign(
    folder: Path,
    method: str = "window",
    goals: Path | None = None,
    avoid: Path | None = None,
    rare: Path | None = None,
    approach: Path | None = None,
) -> Campaign:
    """Reads cases.csv and campaign.json, and the goals' file, goe_avoid's file and the record of rare events if they
    are given. ``cases``: the rows of one method."""
    if not folder.is_dir():
        raise LogError(folder, 0, "", "no such folder")
    path = folder / "cases.csv"
    columns = read_columns(path, LABELS)
    for name in _required():
        if name not in columns:
            raise LogError(path, 1, name, "this column is missing")
    for name in OPTIONAL:
        columns.setdefault(name, np.full(len(columns["case"]), np.nan))
    columns.setdefault("roll_deg", np.zeros(len(columns["case"])))
    for name in (*SETUP, *COUNTS):
        missing = np.flatnonzero(~np.isfinite(columns[name]))
        if len(missing):
            raise LogError(path, int(missing[0]) + 2, name, "empty")
    rows = Cases(columns)
    refined = rows.select(method="filter")
    return Campaign(
        folder, rows.select(method=method), _read_facts(folder / "campaign.json"), refined if len(refined) else None,
        read_goals(goals) if goals else None, read_avoid(avoid) if avoid else None,
        read_record(rare) if rare else None, approach,
    )  # fmt: skip


def _read_facts(path: Path) -> dict[str, Any]:
    try:
        facts = json.loads(read_text(path, JSON_BYTES_MAX))
    except json.JSONDecodeError as error:
        raise LogError(path, error.lineno, "", error.msg) from None
    if not isinstance(facts, dict):
        raise LogError(path, 1, "", "not an object")
    return facts
