"""The tables of requirements, tests/requirements/*.csv."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from goe_tools.logs.obslog import LogError
from goe_tools.places import ROOT

FOLDER = ROOT / "tests" / "requirements"
KINDS = {  # table: what its numbers begin with
    "api": "GOE-API",
    "statuses": "GOE-STA",
    "settings": "GOE-SET",
    "paper": "GOE-PAP",
    "refined": "GOE-REF",
    "readme": "GOE-RDM",
    "parts": "GOE-DES",
}
COLUMNS = ("id", "source", "anchor", "names", "text", "code", "tests", "open")
OF_INSIDES = "parts"  # the table that may name whole files
NO_PROMISE = "no_promise.csv"
NO_PROMISE_COLUMNS = ("source", "anchor", "why")
BREAKS = "breaks.csv"
BREAK_COLUMNS = ("id", "file", "old", "new", "test")


@dataclass(frozen=True)
class Requirement:
    id: str
    source: str  # file that promises it
    anchor: str  # words of that file: gone, the promise has changed
    names: tuple[str, ...]  # what of the interface it is about: GOE_OK, goe_pose_t.height_m, camera.k1, (R17)
    text: str  # in our words, one line
    code: tuple[str, ...]  # file:function; in parts.csv also file
    tests: tuple[str, ...]  # tests/c/x.c:function, tests/python/x.py::test, ctest:name, script.sh
    open: str  # why no test would fail without it; empty: one would
    table: str
    line: int

    @property
    def place(self) -> str:
        return f"tests/requirements/{self.table}.csv:{self.line} ({self.id})"


@dataclass(frozen=True)
class NoPromise:
    """A sentence of a source that binds nobody: it explains, advises, or tells a figure measured elsewhere."""

    source: str
    anchor: str
    why: str
    line: int


@dataclass(frozen=True)
class Break:
    """One line of the code, broken by hand, and the test that then fails."""

    id: str
    file: str
    old: str
    new: str
    test: str
    line: int


def table(path: Path, columns: tuple[str, ...]) -> list[tuple[int, dict[str, str]]]:
    """Rows with their line numbers."""
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file, strict=True)
        if tuple(reader.fieldnames or ()) != columns:
            raise LogError(path, 1, "", f"the columns must be {','.join(columns)}")
        found = []
        for row in reader:
            if None in row or None in row.values():
                raise LogError(path, reader.line_num, "", f"{len(columns)} columns are needed")
            found.append((reader.line_num, row))
    return found


def words(cell: str) -> tuple[str, ...]:
    return tuple(word.strip() for word in cell.split(";") if word.strip())


def requirements(folder: Path = FOLDER) -> list[Requirement]:
    found = []
    for name in KINDS:
        for line, row in table(folder / f"{name}.csv", COLUMNS):
            names, code, tests = words(row["names"]), words(row["code"]), words(row["tests"])
            found.append(
                Requirement(row["id"], row["source"], row["anchor"], names, row["text"], code, tests, row["open"],
                            name, line)
            )  # fmt: skip
    return found


def without_promise(folder: Path = FOLDER) -> list[NoPromise]:
    rows = table(folder / NO_PROMISE, NO_PROMISE_COLUMNS)
    return [NoPromise(row["source"], row["anchor"], row["why"], line) for line, row in rows]


def breaks(folder: Path = FOLDER) -> list[Break]:
    rows = table(folder / BREAKS, BREAK_COLUMNS)
    return [Break(row["id"], row["file"], row["old"], row["new"], row["test"], line) for line, row in rows]
