"""The worst case of each public call on a Cortex-M4F (gcc -O2): measured, proved, stated.

Instructions are proved by the longest path through the machine code (tools/ci/cost/longest), stack by the
deepest path through the calls (tools/ci/cost/stack.py)."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.count_plugin import build_plugin
from goe_tools.places import interface

from ..cost import book, stated
from ..cost.book import Figures, key
from ..cost.building import build
from ..cost.instructions import PUBLIC
from ..cost.ledger import BUILDS
from ..cost.longest import identity, proving, trip_counts
from ..cost.longest.proving import Proof
from ..cost.longest.trip_counts import Trips
from ..cost.measuring import FULL_PRESET, instruction_figures, stack_figures
from ..cost.targets import missing_tool
from .parts import Amount, NotHereError
from .record import Result, Row

SHOWN = 25  # functions of a longest path in the report


def call_rows(figures: Figures, proofs: dict[str, Proof], limits: dict[str, int]) -> Iterator[Row]:
    for name, proof in proofs.items():
        measured, limit = book.number(figures, book.INSTRUCTIONS, name, "max"), limits.get(key(book.PROVED, name))
        yield Row(
            f"`{name}`: instructions: measured, proved, proved over measured",
            f"{measured:,.0f}, {proof.most:,}, {proof.most / max(measured, 1):.2f}",
            f"measured <= proved <= stated {limit:,}" if limit else "measured <= proved",
            measured <= proof.most <= (limit if limit else proof.most),
        )
    for name in PUBLIC:
        painted, computed = (book.number(figures, kind, name) for kind in (book.PAINTED, book.STACK))
        limit = limits[key(book.STACK, name)]
        yield Row(
            f"`{name}`: bytes of stack: painted, proved",
            f"{painted}, {computed}",
            f"painted <= proved <= stated {limit}",
            painted <= computed <= limit,
        )


def table_rows(trips: list[Trips], unused: list[str], changed: list[str]) -> Iterator[Row]:
    wrong = trip_counts.exceeded(trips)
    reached = sum(trip.measured == trip.most for trip in trips)
    yield Row(
        "bounds of loops that the embedded logs exceed",
        f"{len(wrong)} of {len(trips)} ({reached} reached exactly, {sum(not t.measured for t in trips)} never run)",
        "0",
        not wrong,
    )
    yield Row("unused lines of the table of bounds", str(len(unused)), "0", not unused)
    yield Row("modules whose code differs without debugging information", str(len(changed)), "0", not changed)
    words = "indirect calls, recursion, frames that grow at run time: each of them stops the proof"
    yield Row(words, "0", "0", True)


def report(proofs: dict[str, Proof], trips: list[Trips], others: list[str]) -> str:
    lines = []
    for name, proof in proofs.items():
        lines += [f"{name}: {proof.most} instructions on the longest path, by function:"]
        lines += [f"  {share:6d}  {function}" for function, share in proof.shares.most_common(SHOWN)]
    lines += ["", "turns of loops: measured, bound, function, line of tests/targets/loop_bounds.csv"]
    lines += [
        f"  {t.measured:5d} {t.most:5d}  {t.function} at {t.header:x}, line {t.row.number}: {t.row.line}" for t in trips
    ]
    return "\n".join([*lines, *others])


def run(amount: Amount) -> Result:
    missing = missing_tool(FULL_PRESET)
    if missing:
        raise NotHereError(f"no {missing}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        built = build(FULL_PRESET, BUILDS)
        code = proving.code_of(built, built.image("replay"))
        proofs = proving.proofs(code)
        figures = instruction_figures(built, build_plugin(folder), folder) | stack_figures(built)
        trips = trip_counts.measured(built, code, folder)
        changed = identity.changed(built, folder, jobs=amount.jobs)
    limits = stated.stated(interface())
    unused, wrong = proving.unused(code), trip_counts.exceeded(trips)
    rows = [*call_rows(figures, proofs, limits), *table_rows(trips, unused, changed)]
    return Result(rows, report(proofs, trips, [*unused, *wrong, *changed]))
