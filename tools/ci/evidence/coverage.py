"""Coverage: the lines, branches and independent conditions of the library that its unit tests reach.

tests/c reaches every line of lib/, every outcome of every condition, and every condition of a decision shown to decide
alone (MC/DC), or tests/coverage/reasons.csv has the reason; a reason that fits nothing, or a covered condition, is a
fault, too. Reported without a goal: the same without the safety tests, which reach much and check
little; port/flight; in long runs the text readers of sim_host, with the Python tests of the programs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from goe_tools.places import ROOT

from .coverage_build import Group, Readers, build, configure, count_readers, count_tests, need_tools, programs
from .coverage_counts import KINDS, Item, items
from .coverage_reasons import Verdict, read, settle
from .parts import Amount
from .record import Result, Row

REASONS = ROOT / "tests" / "coverage" / "reasons.csv"
GOAL = "100 % or a written reason"

LIBRARY = Group("lib", "goe", "tests/c", "c_", cut=True)
FLIGHT = Group("port/flight", "goe_flight", "tests/flight", "flight_")
READERS = Readers(
    "sim_host",
    {"GOE_REPLAY": "goe_replay", "GOE_SIM": "goe_sim"},
    ("tests/host", "tests/sim/test_sim_scenario.py", "tests/sim/test_sim_log.py"),
)
READING = (  # its folders and files that read text
    "sim_host/log/",
    "sim_host/text/",
    "sim_host/flight/recorded_flight.c",
    "sim_host/flight/scenario_file.c",
    "sim_host/flight/text_numbers.c",
)
WHAT = {
    "lines": "lines that the tests reach: {}",
    "branches": "outcomes of conditions: {}",
    "MC/DC": "conditions that decide alone (MC/DC): {}",
}


@dataclass(frozen=True)
class Count:
    """Counts of one kind, in one file or folder."""

    of: int = 0
    covered: int = 0
    reasoned: int = 0

    @property
    def missing(self) -> int:
        return self.of - self.covered - self.reasoned

    def figure(self) -> str:
        share = 100.0 * self.covered / self.of if self.of else 100.0
        text = f"{share:.2f} % ({self.covered:,} of {self.of:,}"
        return (
            text
            + "".join(f", {n} {word}" for n, word in ((self.reasoned, "reasoned"), (self.missing, "missing")) if n)
            + ")"
        )


def count(found: Sequence[Item], verdict: Verdict, kind: str, file: str = "") -> Count:
    """Counts over all files, or in one."""

    def here(item: Item) -> bool:
        return KINDS[item.outcome] == kind and (not file or item.file == file)

    of = [item for item in found if here(item)]
    return Count(len(of), sum(item.reached for item in of), sum(here(item) for item, _ in verdict.reasoned))


def per_file(found: Sequence[Item], verdict: Verdict) -> str:
    """A line for each file, with the counts of each kind: reached, total, reasoned, missing."""
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
    """Everything that violates the goal, one a line."""
    missing = [f"{i.file}:{i.line}: {i.function}: {i.text}: not reached: {i.outcome}" for i in verdict.missing]
    place = REASONS.relative_to(ROOT)
    return missing + [f"{place}:{r.row}: {r.function}: {r.text}: {r.outcome}: {fault}" for r, fault in verdict.stale]


def reason_lines(verdict: Verdict) -> list[str]:
    by_reason: dict[str, list[Item]] = {}
    for item, reason in verdict.reasoned:
        by_reason.setdefault(reason.reason, []).append(item)
    lines: list[str] = []
    for reason, because in by_reason.items():
        lines.append(f"* {reason}")
        lines += [f"    {item.file}:{item.line}: {item.function}: {item.text}: {item.outcome}" for item in because]
    return lines


def rows_of(name: str, found: Sequence[Item], verdict: Verdict, goal: str) -> list[Row]:
    rows: list[Row] = []
    for kind, what in WHAT.items():
        counted = count(found, verdict, kind)
        rows.append(Row(what.format(name), counted.figure(), goal, counted.missing == 0 if goal else None))
    return rows


def of_library(jobs: int) -> Result:
    every, judging = count_tests(LIBRARY, jobs)
    found = items(every, ROOT)
    verdict = settle(found, read(REASONS))
    stale = Row("reasons that fit nothing, or a covered item", str(len(verdict.stale)), "0", not verdict.stale)
    text = [per_file(found, verdict), "", *faults(verdict), "", "Not reached:", *reason_lines(verdict), ""]
    judged = of_others("lib/, safety tests left out", items(judging, ROOT))
    return Result([*rows_of("lib/", found, verdict, GOAL), stale, *judged.rows], "\n".join([*text, judged.report]))


def of_others(name: str, found: Sequence[Item]) -> Result:
    """Figures without a goal."""
    verdict = settle(found, [])
    text = [f"{name}:", "", per_file(found, verdict), "", *faults(verdict), ""]
    return Result(rows_of(name, found, verdict, ""), "\n".join(text))


def run(amount: Amount) -> Result:
    need_tools()
    configure()
    build([*programs(LIBRARY), *programs(FLIGHT), *(READERS.programs.values() if amount.long else ())], amount.jobs)
    results = [
        of_library(amount.jobs),
        of_others("port/flight/", items(count_tests(FLIGHT, amount.jobs)[0], ROOT)),
    ]
    if amount.long:
        found = items(count_readers(READERS), ROOT, strict=False)
        results.append(of_others("sim_host/, text readers", [item for item in found if item.file.startswith(READING)]))
    return Result([row for result in results for row in result.rows], "\n".join(result.report for result in results))
