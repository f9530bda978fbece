"""The part ``requirements``: no row without code and test, nothing without a row; long: broken code is noticed."""

from __future__ import annotations

from ..parts import Amount
from ..record import Result, Row
from . import breaks, check, rows


def of(count: int, total: int) -> str:
    return f"{count:,} of {total:,}"


def rows_of_breaks(amount: Amount) -> tuple[list[Row], list[str]]:
    outcomes, failing = breaks.try_all(rows.breaks(), amount.jobs)
    noticed = sum(outcome.noticed for outcome in outcomes)
    lines = [
        f"{outcome.broken.id} {outcome.broken.file}: {outcome.broken.old!r} -> {outcome.broken.new!r}: "
        f"{outcome.broken.test} {'fails' if outcome.noticed else 'DOES NOT FAIL'}: {outcome.told}"
        for outcome in outcomes
    ]
    lines += [f"fails with nothing broken: {test}" for test in failing]
    met = noticed == len(outcomes) and not failing
    what = "lines broken by hand: the test that the requirement names fails"
    return [Row(what, of(noticed, len(outcomes)), "all", met)], lines


def run(amount: Amount) -> Result:
    requirements, found = rows.requirements(), check.findings()
    with_code = sum(bool(requirement.code) for requirement in requirements)
    with_tests = sum(bool(requirement.tests) for requirement in requirements)
    open_ones = [requirement for requirement in requirements if requirement.open]
    total = len(requirements)
    table = [
        Row("requirements", f"{total:,}", "", None),
        Row("... with the code that does it", of(with_code, total), "all", with_code == total),
        Row("... with tests named for it", of(with_tests, total), "all", with_tests == total),
        Row("orphans: rows whose anchor, name, code or test is not there", f"{len(found.rows)}", "0", not found.rows),
        Row(
            f"orphans: names, equations, files, {found.tests:,} unit tests, {found.sentences:,} sentences of goe.h "
            "without a row",
            f"{len(found.orphans)}", "0", not found.orphans,
        ),
    ]  # fmt: skip
    report = [*found.all, *(f"open: {requirement.place}: {requirement.open}" for requirement in open_ones)]
    if amount.long:
        more, lines = rows_of_breaks(amount)
        table += more
        report += lines
    return Result(table, "\n".join(report))
