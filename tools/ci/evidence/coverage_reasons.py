"""Reasons for items that are not reached, and their comparison with the coverage."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from goe_tools.logs.obslog import LogError

from .coverage_counts import OUTCOMES, Item, plain

COLUMNS = ["file", "function", "text", "outcome", "reason"]


@dataclass(frozen=True)
class Reason:
    """Why an outcome of a condition is never taken, or a line never reached."""

    file: str
    function: str
    text: str
    outcome: str
    reason: str
    row: int  # in the file of reasons

    def fits(self, item: Item) -> bool:
        """Whether it applies. An outcome that is never taken also keeps its condition from deciding alone."""
        place = (item.file, item.function, item.text) == (self.file, self.function, self.text)
        also = item.outcome == "independent" and self.outcome in ("true", "false")
        return place and (item.outcome == self.outcome or (also and not item.reached))


@dataclass(frozen=True)
class Verdict:
    reasoned: list[tuple[Item, Reason]]
    missing: list[Item]  # not reached, and no reason
    stale: list[tuple[Reason, str]]  # with the fault


def read(path: Path) -> list[Reason]:
    """Raises LogError."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
    except (OSError, UnicodeDecodeError) as error:
        raise LogError(path, 0, "", str(error)) from None
    if not rows or rows[0] != COLUMNS:
        raise LogError(path, 1, "", f"the columns are {', '.join(COLUMNS)}")
    reasons: list[Reason] = []
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(COLUMNS) or not all(cell.strip() for cell in row):
            raise LogError(path, number, "", f"{len(COLUMNS)} cells are required, all with text")
        if row[3] not in OUTCOMES:
            raise LogError(path, number, "outcome", f"one of {', '.join(OUTCOMES)}")
        reasons.append(Reason(row[0], row[1], plain(row[2]), row[3], row[4], number))
    return reasons


def _fault(reason: Reason, items: Iterable[Item]) -> str:
    """The fault of a reason; empty without one."""
    fits = [item for item in items if reason.fits(item) and item.outcome == reason.outcome]
    if not fits:
        return "no longer fits anything"
    return "is covered now" if all(item.reached for item in fits) else ""


def settle(items: Sequence[Item], reasons: Sequence[Reason]) -> Verdict:
    reasoned: list[tuple[Item, Reason]] = []
    missing: list[Item] = []
    for item in items:
        if item.reached:
            continue
        reason = next((reason for reason in reasons if reason.fits(item)), None)
        if reason:
            reasoned.append((item, reason))
        else:
            missing.append(item)
    faults = [(reason, _fault(reason, items)) for reason in reasons]
    return Verdict(reasoned, missing, [(reason, fault) for reason, fault in faults if fault])
