"""How often the loops do turn over the embedded logs, held against the table: a bound that is too small is found."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..building import Build
from ..instructions import PUBLIC, build_plugin
from .longest_path import Code, inlined_by, is_tested_at_its_end, table_rows_of
from .loop_bounds import Row
from .loops import Loop
from .machine_code import Function

PLUGIN = "count_loops"


@dataclass(frozen=True)
class Trips:
    """The most that a loop turned, and may turn, by a line of the table."""

    function: str
    header: int
    row: Row
    measured: int
    most: int


@dataclass(frozen=True)
class Counter:
    function: Function
    loop: Loop
    row: Row
    most: int  # that the loop's first block may run


DEPTH = {"outer": 1, "outer2": 2}  # loops around that a bound speaks of


def depth_of(loop: Loop) -> int:
    return 0 if loop.outer is None else 1 + depth_of(loop.outer)


def counters_of(code: Code) -> Iterator[Counter]:
    """One for each loop and each line of the table that bounds it; not where a size decides."""
    for function in code.functions.values():
        for loop in code.loops[function.start]:
            for row in table_rows_of(code, function, loop):
                if row.per[:2] == "> ":
                    continue  # what bounds the rows of an image is bounded by the entry, too
                if not re.search(r"size|over", row.most) and depth_of(loop) >= DEPTH.get(row.per, 0):
                    once = is_tested_at_its_end(code, function, loop, row)
                    enters = 1 if row.per == "entry" else 0
                    yield Counter(function, loop, row, code.bound(row) + (0 if once else enters))


def resets_of(code: Code, counter: Counter) -> list[int]:
    """Addresses after which a bound counts anew."""
    function, scope = counter.function, counter.loop
    for _ in range(DEPTH.get(counter.row.per, 0)):
        assert scope.outer is not None
        scope = scope.outer
    if counter.row.per == "call":
        return [function.start]
    return [function.blocks[at].last.address for at, _ in scope.entries]


def switch_lines(code: Code, texts: list[str]) -> Iterator[str]:
    """On at calls by a line with that text, off behind them; and one that is on while a public call runs."""
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


def map_of(code: Code, counters: list[Counter]) -> str:
    lines = list(switch_lines(code, code.texts))
    for number, counter in enumerate(counters):
        lines.append(f"count {counter.loop.header:x} {number}")
        lines.append(f"needs {number} {len(code.texts)}")
        lines += [f"reset {address:x} {number}" for address in resets_of(code, counter)]
        here = inlined_by(code, counter.function, counter.loop)
        needed = set(counter.row.passes) - here
        lines += [f"needs {number} {code.texts.index(text)}" for text in sorted(needed)]
        others = (
            set(o.row.passes) - here
            for o in counters
            if o.loop is counter.loop and set(o.row.passes) > set(counter.row.passes)
        )
        lines += [f"bars {number} {code.texts.index(text)}" for text in sorted(set().union(*others) - needed)]
    return "\n".join(lines) + "\n"


def measured(built: Build, code: Code, folder: Path) -> list[Trips]:
    """Over the embedded logs, under QEMU."""
    counters = list(counters_of(code))
    events, out = folder / "events", folder / "turns"
    events.write_text(map_of(code, counters), encoding="utf-8")
    plugin = build_plugin(folder, PLUGIN)
    built.run_image(built.image("replay"), "-plugin", f"{plugin},map={events},out={out}")
    turns = [int(line) for line in out.read_text(encoding="utf-8").split()]
    turns += [0] * (len(counters) - len(turns))
    return [Trips(c.function.name, c.loop.header, c.row, turn, c.most) for c, turn in zip(counters, turns)]


def exceeded(trips: list[Trips]) -> list[str]:
    return [
        f"{trip.function}: a loop turned {trip.measured} times, line {trip.row.number} of the table says {trip.most}"
        for trip in trips
        if trip.measured > trip.most
    ]
