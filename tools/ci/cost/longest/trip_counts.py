"""Compares the table with the embedded logs: actual turns of loops, and exclusions."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from bench.count_plugin import build_plugin

from ..building import Build
from ..instructions import PUBLIC
from .longest_path import (
    ANY,
    Code,
    Finder,
    Pair,
    inlined_by,
    is_tested_at_its_end,
    table_rows_of,
    terms_of,
)
from .loop_bounds import Row
from .loops import Loop
from .machine_code import Function

PLUGIN = "count_loops"


@dataclass(frozen=True)
class Trips:
    """The largest number of turns or sum of calls, and its limit by a line of the table."""

    function: str
    header: int
    row: Row
    measured: int
    most: int


@dataclass(frozen=True)
class Check:
    """A count that may reach `most` between two resets."""

    function: str
    address: int
    row: Row
    most: int
    counts: tuple[tuple[int, int], ...]  # addresses and their increments
    resets: tuple[int, ...]
    needs: frozenset[str] = frozenset()  # texts of lines that must be in the call stack
    bars: frozenset[str] = frozenset()  # ... that must not


DEPTH = {"outer": 1, "outer2": 2}  # number of enclosing loops in a bound


def depth_of(loop: Loop) -> int:
    return 0 if loop.outer is None else 1 + depth_of(loop.outer)


def resets_of(code: Code, function: Function, loop: Loop, row: Row) -> tuple[int, ...]:
    """Addresses that reset the count of a bound."""
    if row.per == "call":
        return (function.start,)
    if row.per == "all" or row.per.startswith("> "):
        return starts_of(code)
    scope = loop
    for _ in range(DEPTH.get(row.per, 0)):
        assert scope.outer is not None
        scope = scope.outer
    return tuple(function.blocks[at].last.address for at, _ in scope.entries)


def starts_of(code: Code) -> tuple[int, ...]:
    return tuple(function.start for function in code.functions.values() if function.name in PUBLIC)


def calls_of(code: Code, finder: Finder, pair: Pair) -> Iterator[int]:
    """Addresses of the calls of a pair."""
    for function in code.functions.values():
        for block in function.blocks.values():
            for call, to in block.calls:
                if pair in finder.pair_of(function, call, to):
                    yield call.address


def checks_of_loops(code: Code, finder: Finder) -> Iterator[Check]:
    """One for each loop and each line of the table that bounds it, except bounds by a size."""
    for function in code.functions.values():
        for loop in code.loops[function.start]:
            rows = table_rows_of(code, function, loop)
            here = inlined_by(code, function, loop)
            for row in rows:
                once = is_tested_at_its_end(code, function, loop, row)
                if re.search(r"size|over", row.most) or depth_of(loop) < DEPTH.get(row.per, 0):
                    continue
                most, counts = code.bound(row), [(loop.header, 1)]
                if row.per.startswith("> "):
                    if not once:
                        continue  # its entries are not counted
                    counts += [(at, -most) for at in calls_of(code, finder, (ANY, row.per[2:]))]
                    most = 0
                elif row.per == "entry" and not once:
                    most += 1
                needs = frozenset(row.passes) - here
                others = (set(other.passes) - here for other in rows if set(other.passes) > set(row.passes))
                yield Check(
                    function.name, loop.header, row, most, tuple(counts), resets_of(code, function, loop, row), needs,
                    frozenset().union(*others) - needs,
                )  # fmt: skip


def checks_of_statements(code: Code, finder: Finder) -> Iterator[Check]:
    """One for each statement and case of every public call; for inlined calls, one for each block."""
    for row in (*finder.statements, *finder.cases):
        calls: list[tuple[int, int]] = []
        placed: list[tuple[int, int]] = []
        for times, pair in terms_of(row):
            calls += [(at, times) for at in calls_of(code, finder, pair)]
            for function in code.functions.values():
                for block in function.blocks.values():
                    if pair in finder.inlined_in(block) and not finder.turns_within(function, block, pair):
                        placed.append((block.start, times))
        for part in placed or [None]:
            counts = tuple(calls) if part is None else (part, *calls)
            if counts:
                yield Check("any", counts[0][0], row, code.bound(row), counts, starts_of(code))


def switch_lines(code: Code, texts: list[str]) -> Iterator[str]:
    """Switches: on at calls from a line with that text, off after them; one more is on during a public call."""
    for function in code.functions.values():
        if function.name in PUBLIC:
            yield f"on {function.start:x} {len(texts)}"
            yield from (f"off {b.last.address:x} {len(texts)}" for b in function.blocks.values() if b.leaves)
        for block in function.blocks.values():
            for call, to in block.calls:
                lines = [place.text for place in code.at(call)]
                for number, text in enumerate(texts):
                    if not any(text in line for line in lines):
                        continue
                    yield f"on {call.address:x} {number}"
                    if call.name.startswith("bl"):
                        yield f"off {call.address + 4:x} {number}"
                    else:
                        ends = (b.last.address for b in code.functions[to].blocks.values() if b.leaves)
                        yield from (f"off {end:x} {number}" for end in ends)


def map_of(code: Code, checks: list[Check]) -> str:
    lines = list(switch_lines(code, code.texts))
    for number, check in enumerate(checks):
        for address, times in check.counts:
            lines += [f"{'count' if times > 0 else 'less'} {address:x} {number}"] * abs(times)
        lines.append(f"needs {number} {len(code.texts)}")
        lines += [f"reset {address:x} {number}" for address in check.resets]
        lines += [f"needs {number} {code.texts.index(text)}" for text in sorted(check.needs)]
        lines += [f"bars {number} {code.texts.index(text)}" for text in sorted(check.bars)]
    return "\n".join(lines) + "\n"


def measured(built: Build, code: Code, folder: Path) -> list[Trips]:
    """Counts over the embedded logs, under QEMU."""
    finder = Finder(code, "all")
    checks = [*checks_of_loops(code, finder), *checks_of_statements(code, finder)]
    events, out = folder / "events", folder / "turns"
    events.write_text(map_of(code, checks), encoding="utf-8")
    plugin = build_plugin(folder, PLUGIN)
    built.run_image(built.image("replay"), "-plugin", f"{plugin},map={events},out={out}")
    turns = [int(line) for line in out.read_text(encoding="utf-8").split()]
    turns += [0] * (len(checks) - len(turns))
    return [Trips(c.function, c.address, c.row, turn, c.most) for c, turn in zip(checks, turns)]


def exceeded(trips: list[Trips]) -> list[str]:
    return [
        f"{trip.function} at {trip.header:x}: counted {trip.measured}, line {trip.row.number} of the table has "
        f"{trip.most}"
        for trip in trips
        if trip.measured > trip.most
    ]
