"""Mutants that survive the tests, with reasons: survivors.csv, flight.csv and companion.csv in
tests/mutation, for lib/, port/flight and port/companion.

Columns: file, function, source, mutation, reason. ``source`` and ``mutation`` are the changed lines before and after,
as in the report of the part ``mutation``. An entry that fits no mutant of the current sources is wrong.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from goe_tools.logs.obslog import LogError
from goe_tools.places import ROOT

from .mutants import LIBRARY, mutants

LIST = ROOT / "tests" / "mutation" / "survivors.csv"
COLUMNS = ["file", "function", "source", "mutation", "reason"]


@dataclass(frozen=True)
class Survivor:
    line: int
    key: tuple[str, str, str, str]  # the key of a Mutant
    reason: str


def read(path: Path = LIST) -> list[Survivor]:
    with path.open(encoding="utf-8", newline="") as text:
        rows = csv.reader(text)
        if next(rows, None) != COLUMNS:
            raise LogError(path, 1, "", f"expected the columns {', '.join(COLUMNS)}")
        found = []
        for row in rows:
            if len(row) != len(COLUMNS) or not all(row[i].strip() for i in (0, 2, 4)):
                raise LogError(path, rows.line_num, "", "needs a file, a source and a reason in five columns")
            found.append(Survivor(rows.line_num, (row[0], row[1], row[2], row[3]), row[4]))
    return found


def reasons_of(path: Path) -> dict[tuple[str, str, str, str], str]:
    return {entry.key: entry.reason for entry in read(path)}


def strangers(entries: Iterable[Survivor], folder: Path = LIBRARY, flags: Sequence[str] = ()) -> list[Survivor]:
    """Entries that fit no mutant."""
    entries = list(entries)
    known: set[tuple[str, str, str, str]] = set()
    for file in sorted({entry.key[0] for entry in entries}):
        if (folder / file).exists():
            known.update(mutant.key for mutant in mutants(file, folder, flags))
    return [entry for entry in entries if entry.key not in known]
