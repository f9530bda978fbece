"""The evidence of the worst case: its rows, and that line markers do not change the code."""

from __future__ import annotations

import subprocess
from collections import Counter
from pathlib import Path

import pytest
from ci.cost.building import OBJECTS, Build
from ci.cost.instructions import PUBLIC
from ci.cost.longest import identity
from ci.cost.longest.loop_bounds import Row
from ci.cost.longest.proving import Proof
from ci.cost.longest.trip_counts import Trips
from ci.evidence import worst_case
from ci.evidence.worst_case import call_rows, report, table_rows


@pytest.mark.parametrize(
    ("measured", "proved", "stated", "met"),
    [(8, 9, 10, True), (10, 10, 10, True), (9, 8, 10, False), (8, 11, 10, False)],
)
def test_measured_is_below_proved_is_below_stated(measured: int, proved: int, stated: int, met: bool) -> None:
    figures = {"instructions: goe_update: max": measured}
    limits = {"instructions proved: goe_update": stated, **{f"stack bytes computed: {name}": 64 for name in PUBLIC}}
    figures |= {f"stack bytes computed: {name}": 64 for name in PUBLIC}
    figures |= {f"stack bytes painted: {name}": 60 for name in PUBLIC}
    first, *stacks = call_rows(figures, {"goe_update": Proof(proved, Counter())}, limits)
    assert (first.met, first.figure) == (met, f"{measured}, {proved}, {proved / measured:.2f}")
    assert [row.met for row in stacks] == [True] * len(PUBLIC)
    figures["stack bytes computed: goe_reset"] = 65
    assert [row.met for row in call_rows(figures, {}, limits)].count(False) == 1


def test_a_contradiction_of_the_table_is_missed() -> None:
    row = Row(3, "loop", "f", "for (;;) {", "", "2", "entry", "for a test")
    trips = [Trips("f", 0x100, row, turns, 2) for turns in (0, 2, 3)]
    assert [r.met for r in table_rows(trips[:2], [], [])] == [True] * 4
    exceeded, *_ = table_rows(trips, [], [])
    assert (exceeded.met, exceeded.figure) == (False, "1 of 3 (1 reached exactly, 1 never run)")
    assert [r.met for r in table_rows([], ["line 3"], ["goe_box"])] == [True, False, False, True]
    text = report({"goe_update": Proof(9, Counter({"update": 9}))}, trips, ["line 3"])
    assert "goe_update: 9 instructions" in text
    assert "    3     2  f at 100, line 3" in text


def test_lines_leave_the_code_as_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = tmp_path / "lib" / "one.c"
    source.parent.mkdir()
    source.write_text("int f(int a);\nint f(int a) { return a * 3 + (a > 4 ? f(a - 1) : 2); }\n", encoding="utf-8")
    monkeypatch.setattr(identity, "ROOT", tmp_path)
    kept = tmp_path / OBJECTS / "one.c.obj"
    kept.parent.mkdir(parents=True)
    built = Build("host", tmp_path, "none", "", "gcc", ["gcc", "-O2", "-g1"], [])
    for flags, wrong in ((["-O2", "-g1"], []), (["-O0", "-g1"], ["one"])):
        subprocess.run(["gcc", *flags, "-o", kept, "-c", source], check=True)
        assert identity.changed(built, tmp_path) == wrong


def test_without_a_compiler_the_part_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worst_case, "missing_tool", lambda preset: "arm-none-eabi-gcc")
    with pytest.raises(worst_case.NotHereError, match="no arm-none-eabi-gcc"):
        worst_case.run(worst_case.Amount())
