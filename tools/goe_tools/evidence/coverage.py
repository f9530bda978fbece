"""Coverage: which lines, branches and independent conditions of the library its unit tests reach.

Of lib/ every line, every outcome of every condition, and every condition of a decision shown to decide alone (MC/DC) is
reached by tests/c, or has its reason in tests/coverage/reasons.csv; a reason that fits nothing any more, or whose
condition is covered now, is a fault, too. Of port/flight the figures are told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..places import ROOT
from .coverage_build import Group, build, configure, export, need_tools, run_tests
from .coverage_counts import KINDS, Item, items
from .coverage_reasons import Verdict, read, settle
from .parts import Amount
from .record import Result, Row

REASONS = ROOT / "tests" / "coverage" / "reasons.csv"
GOAL = "100 % or a written reason"

LIBRARY = Group("lib", "lib/libgoe.a", "tests/c", "c_", cut=True)
FLIGHT = Group("port/flight", "port/flight/libgoe_flight.a", "tests/flight", "flight_")
WHAT = {
    "lines": "lines of {} that its unit tests reach",
    "branches": "outcomes of its conditions",
    "MC/DC": "conditions of its decisions that decide alone (MC/DC)",
}


@dataclass(frozen=True)
class Count:
    """Of one kind, in one file or folder."""

    of: int = 0
    covered: int = 0
    reasoned: int = 0

    @property
    def missing(self) -> int:
        return self.of - self.covered - self.reasoned

    def figure(self) -> str:
        share = 100.0 * self.covered / self.of if self.of else 100.0
        told = f"{share:.2f} % ({self.covered:,} of {self.of:,}"
        return (
            told
            + "".join(f", {n} {word}" for n, word in ((self.reasoned, "reasoned"), (self.missing, "missing")) if n)
            + ")"
        )


def count(found: Sequence[Item], verdict: Verdict, kind: str, file: str = "") -> Count:
    """Of all files, or of one."""

    def here(item: Item) -> bool:
        return KINDS[item.outcome] == kind and (not file or item.file == file)

    of = [item for item in found if here(item)]
    return Count(len(of), sum(item.reached for item in of), sum(here(item) for item, _ in verdict.reasoned))


def per_file(found: Sequence[Item], verdict: Verdict) -> str:
    """A line for each file, of each kind: how many were reached, of how many; reasoned; missing."""
    files = sorted({item.file for item in found})
    width = max(map(len, [*files, "all"]))
    blank = " " * width
    lines = [
        f"{blank}" + "".join(f"  {kind:^29}" for kind in WHAT),
        blank + "  reached     of  reason missing" * len(WHAT),
    ]
    for file in [*files, ""]:
        counts = [count(found, verdict, kind, file) for kind in WHAT]
        cells = "".join(f"  {c.covered:>7} {c.of:>6} {c.reasoned:>6} {c.missing:>6} " for c in counts)
        lines.append(f"{file or 'all':<{width}}{cells}")
    return "\n".join(line.rstrip() for line in lines)


def faults(verdict: Verdict) -> list[str]:
    """What stands between the library and its goal, one a line."""
    told = [f"{i.file}:{i.line}: {i.function}: {i.text}: not reached: {i.outcome}" for i in verdict.missing]
    place = REASONS.relative_to(ROOT)
    return told + [f"{place}:{r.row}: {r.function}: {r.text}: {r.outcome}: {fault}" for r, fault in verdict.stale]


def reasons_told(verdict: Verdict) -> list[str]:
    by_reason: dict[str, list[Item]] = {}
    for item, reason in verdict.reasoned:
        by_reason.setdefault(reason.reason, []).append(item)
    told: list[str] = []
    for reason, because in by_reason.items():
        told.append(f"* {reason}")
        told += [f"    {item.file}:{item.line}: {item.function}: {item.text}: {item.outcome}" for item in because]
    return told


def rows_of(group: Group, found: Sequence[Item], verdict: Verdict, goal: str) -> list[Row]:
    rows: list[Row] = []
    for kind, what in WHAT.items():
        counted = count(found, verdict, kind)
        rows.append(
            Row(what.format(f"{group.folder}/"), counted.figure(), goal, counted.missing == 0 if goal else None)
        )
    return rows


def run(amount: Amount) -> Result:
    need_tools()
    groups = (LIBRARY, FLIGHT)
    configure()
    build(groups, amount.jobs)
    rows: list[Row] = []
    report: list[str] = []
    for group in groups:
        found = items(export(group, run_tests(group, amount.jobs)), ROOT)
        held = group is LIBRARY
        verdict = settle(found, read(REASONS) if held else [])
        rows += rows_of(group, found, verdict, GOAL if held else "")
        report += [per_file(found, verdict), "", *faults(verdict), ""]
        if held:
            rows.append(
                Row("reasons that fit nothing, or what is covered", str(len(verdict.stale)), "0", not verdict.stale)
            )
            report += ["Not reached, and why:", *reasons_told(verdict), ""]
    return Result(rows, "\n".join(report))
