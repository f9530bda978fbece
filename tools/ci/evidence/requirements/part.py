"""The part ``requirements``: no promise without a test, no test without a promise; long: broken code is detected."""

from __future__ import annotations

from goe_tools.places import ROOT

from ..parts import Amount
from ..record import Result, Row
from . import breaks, marks

TABLE = ROOT / "build" / "evidence" / "requirements.csv"


def rows_of_breaks(amount: Amount) -> tuple[list[Row], list[str]]:
    outcomes, failing = breaks.try_all(breaks.read(), amount.jobs)
    noticed = sum(outcome.noticed for outcome in outcomes)
    lines = [
        f"{outcome.broken.mark} {outcome.broken.file}: {outcome.broken.old!r} -> {outcome.broken.new!r}: "
        f"{outcome.broken.test} {'fails' if outcome.noticed else 'DOES NOT FAIL'}: {outcome.message}"
        for outcome in outcomes
    ]
    lines += [f"fails with nothing broken: {test}" for test in failing]
    met = noticed == len(outcomes) and not failing
    what = "lines broken on purpose: the test with the mark fails"
    return [Row(what, f"{noticed:,} of {len(outcomes):,}", "all", met)], lines


def run(amount: Amount) -> Result:
    found = marks.joined()
    marks.write_table(found, TABLE)
    stale = list(breaks.stale(breaks.read(), found))
    marked = sum(bool(promise.text) for promise in found.promises)
    pairs = sum(len(tests) for tests in found.by_key.values())
    table = [
        Row("promises: marked sentences", f"{marked:,}", "", None),
        Row("... names, equations and sources", f"{len(found.promises) - marked:,}", "", None),
        Row("pairs of promise and test", f"{pairs:,}", "", None),
        Row("orphans: no test, no promise", f"{len(found.orphans)}", "0", not found.orphans),
        Row("stale lines of breaks.csv", f"{len(stale)}", "0", not stale),
    ]
    report = [*found.orphans, *stale, f"the table: {TABLE}"]
    if amount.long:
        more, lines = rows_of_breaks(amount)
        table += more
        report += lines
    return Result(table, "\n".join(report))
