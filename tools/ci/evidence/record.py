"""Rows of the table of evidence, the file that keeps those of long runs, and the file of a release."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from goe_tools.logs.fields import JSON_BYTES_MAX, LogError, read_text
from goe_tools.logs.whole_file import write_whole


@dataclass(frozen=True)
class Row:
    what: str  # "lines of lib/ that the unit tests run"
    figure: str  # as printed: "99.9 % (3,201 of 3,204)"
    goal: str  # "100 % or a written reason"
    met: bool | None  # None: a figure without a goal


@dataclass(frozen=True)
class Result:
    """A part's result. ``report``: text with details, in a separate file."""

    rows: list[Row]
    report: str = ""


@dataclass(frozen=True)
class Kept:
    """A part's rows and the circumstances of the run."""

    part: str
    amount: str  # "quick" or "long"
    date: str
    golden_hash: str  # of the library's bits at the time
    seconds: float
    machine: str  # processor, compiler
    rows: list[Row] = field(default_factory=list)
    commit: str = ""  # of the sources; a trailing "+": changed since
    cores: int = 0


@dataclass(frozen=True)
class Release:
    version: str
    commit: str
    date: str
    machine: str
    cores: int
    parts: list[Kept]


def read(path: Path) -> dict[str, Kept]:
    """Rows by part, from a record or a release's file. An absent file has none."""
    if not path.exists():
        return {}
    text = read_text(path, JSON_BYTES_MAX)
    try:
        content = json.loads(text)
        parts: list[dict[str, Any]] = content["parts"] if isinstance(content, dict) else content
        kept = [Kept(**{**entry, "rows": [Row(**row) for row in entry["rows"]]}) for entry in parts]
    except (KeyError, TypeError, ValueError) as error:
        raise LogError(path, 0, "", f"not a record of evidence: {error}") from None
    return {entry.part: entry for entry in kept}


def write(path: Path, kept: Iterable[Kept]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json.dumps([asdict(entry) for entry in kept], indent=1) + "\n")


def write_release(path: Path, release: Release) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json.dumps(asdict(release), indent=1) + "\n")


def newest_release(folder: Path) -> Path | None:
    """The file VERSION.json of the highest version."""
    found = {tuple(map(int, path.stem.split("."))): path for path in folder.glob("*.*.*.json")}
    return found[max(found)] if found else None


WORDS = {True: "met", False: "MISSED", None: ""}


def run_of(entry: Kept) -> str:
    return f"{entry.amount}, {entry.date}, {entry.golden_hash[:8]}"


def cells(row: Row) -> str:
    """What, figure, goal, verdict: the common Markdown columns of all tables of rows."""
    return f"{row.what} | {row.figure} | {row.goal} | {WORDS[row.met]}"


def table(kept: Iterable[Kept]) -> str:
    """Markdown: a line for each row."""
    lines = ["| part | what | figure | goal | | run |", "|---|---|---|---|---|---|"]
    lines += [f"| {entry.part} | {cells(row)} | {run_of(entry)} |" for entry in kept for row in entry.rows]
    return "\n".join(lines)
