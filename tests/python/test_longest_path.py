"""The longest path through machine code: graphs, loops, bounds, and the proof of the largest sum."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
from bench.running import LedgerError
from ci.cost.building import Build
from ci.cost.longest import loop_bounds, trip_counts
from ci.cost.longest.longest_path import Code, Context, Finder, constant_before
from ci.cost.longest.loop_bounds import HEAD, Row
from ci.cost.longest.loops import loops_of
from ci.cost.longest.machine_code import Function, functions_below
from ci.cost.longest.source_lines import Place, places_of
from ci.cost.longest.whole_numbers import Program, proved, solve

# 3 + 4 n instructions for n turns, tested at the end; each turn calls leaf().
LOOP = """
00000100 <root>:
 100:\tpush\t{r4, lr}
 102:\tmov\tr4, r0
 104:\tbl\t200 <leaf>
 108:\tsubs\tr4, #1
 10a:\tcmp\tr4, #0
 10c:\tbne.n\t104 <root+0x4>
 10e:\tpop\t{r4, pc}

00000200 <leaf>:
 200:\tcmp\tr0, #0
 202:\tit\teq
 204:\tbxeq\tlr
 206:\tmovs\tr0, #1
 208:\tb.w\t300 <tail>

00000300 <tail>:
 300:\tcbz\tr0, 304 <tail+0x4>
 302:\tnop
 304:\tbx\tlr
"""


def functions(text: str, root: str = "root") -> dict[int, Function]:
    return functions_below(text, [root])


def loop_row(most: str, line: str = "#1", when: str = "", per: str = "entry", function: str = "root") -> Row:
    return Row(2, "loop", function, line, when, most, per, "for a test")


def code_of(text: str, *rows: Row, places: dict[int, tuple[Place, ...]] | None = None) -> Code:
    return Code(functions(text), places or {}, list(rows), {"N": 5})


def most_of(code: Code, public: str = "root") -> int:
    start = next(start for start, function in code.functions.items() if function.name == "root")
    return Finder(code, public).most(start, Context())[0]


# -------------------------------------------------------------------------------------------------------- machine code


def test_blocks_of_conditional_returns_and_tail_calls() -> None:
    found = functions(LOOP)
    assert sorted(found) == [0x100, 0x200, 0x300]
    leaf = found[0x200]
    assert [block.followers for block in leaf.blocks.values()] == [[0x206], []]
    assert [block.leaves for block in leaf.blocks.values()] == [True, True]
    assert [to for _, to in leaf.blocks[0x206].calls] == [0x300]
    assert found[0x300].blocks[0x300].followers == [0x304, 0x302]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("blx\tr3", "an indirect call at 100"),
        ("bx\tr3", "a jump through r3"),
        ("mov\tpc, r3", "writes the program counter"),
        ("b.n\t202 <leaf+0x2>", "which is no function's start"),
        ("bl\t400 <gone>\n 104:\tbx\tlr", "which is not the start of a function"),
        ("nop", "nothing follows 100"),
    ],
)
def test_jumps_that_cannot_be_followed_are_refused(line: str, reason: str) -> None:
    text = f"00000100 <root>:\n 100:\t{line}\n\n00000200 <leaf>:\n 200:\tnop\n 202:\tbx\tlr\n"
    with pytest.raises(LedgerError, match=reason):
        functions(text)


def test_a_table_of_jumps_leads_to_its_entries() -> None:
    text = """
00000100 <root>:
 100:\ttbb\t[pc, r0]
 104:\t.short\t0x0302
 106:\t.short\t0x0004
 108:\tbx\tlr
 10a:\tnop
 10c:\tbx\tlr
"""
    assert functions(text)[0x100].blocks[0x100].followers == [0x108, 0x10A, 0x10C]
    with pytest.raises(LedgerError, match="an unreadable jump table"):
        functions("00000100 <root>:\n 100:\ttbh\t[pc, r0]\n 104:\tbx\tlr\n")


@pytest.mark.parametrize(
    ("before", "size"),
    [("movs\tr2, #40", 40), ("mov.w\tr2, #612\t@ 0x264", 612), ("mov\tr2, r4", None), ("movne\tr2, #4", None),
     ("ldrd\tr1, r2, [r0]", None), ("add\tr2, r2, #4", None), ("str\tr2, [r0]", 8), ("bl\t200 <memset>", None)],
)  # fmt: skip
def test_a_size_is_read_where_it_is_a_constant(before: str, size: int | None) -> None:
    text = f"""
00000100 <root>:
 0fc:\tnop
 100:\tmovs\tr2, #8
 102:\t{before}
 106:\tbl\t200 <memset>
 10a:\tbx\tlr

00000200 <memset>:
 200:\tbx\tlr
"""
    text = text.replace(" 0fc:\tnop\n", "")
    (block,) = functions(text)[0x100].blocks.values()
    assert constant_before(functions(text)[0x100], block, block.calls[-1][0]) == size


# ---------------------------------------------------------------------------------------------------------------- loops


def graph(edges: dict[int, list[int]]) -> Function:
    lines = ["00000000 <root>:"]
    for block, followers in sorted(edges.items()):
        targets = [f"beq.n\t{to:x} <root>" for to in followers] or ["bx\tlr"]
        lines += [f" {block + 2 * i:x}:\t{line}" for i, line in enumerate([*targets, "bx\tlr"])]
    return functions("\n".join(lines))[0]


def test_loops_lie_within_each_other() -> None:
    found = loops_of(graph({0x0: [], 0x10: [0x40], 0x20: [0x20], 0x30: [0x10], 0x40: []} | {0x0: [0x10]}))
    assert not found  # only the jumps lead from one to the next
    text = """
00000100 <root>:
 100:\tmovs\tr1, #3
 102:\tmovs\tr2, #3
 104:\tsubs\tr2, #1
 106:\tbne.n\t104 <root+0x4>
 108:\tsubs\tr1, #1
 10a:\tbne.n\t102 <root+0x2>
 10c:\tbx\tlr
"""
    outer, inner = loops_of(functions(text)[0x100])
    assert (outer.header, inner.header, inner.outer, outer.outer) == (0x102, 0x104, outer, None)
    assert inner.entries == [(0x102, 0x104)]
    assert outer.backs == [(0x108, 0x102)]


def test_a_second_way_into_a_loop_is_an_entry() -> None:
    text = """
00000100 <root>:
 100:\tcbz\tr0, 106 <root+0x6>
 102:\tnop
 104:\tnop
 106:\tsubs\tr1, #1
 108:\tbne.n\t102 <root+0x2>
 10a:\tbx\tlr
"""
    (loop,) = loops_of(functions(text)[0x100])
    assert not loop.has_one_way_in
    assert sorted(loop.entries) == [(0x100, 0x102), (0x100, 0x106)]
    assert len(loop.backs) == 1


# ------------------------------------------------------------------------------------------------------- longest path


def test_a_loop_turns_as_often_as_the_table_lets_it() -> None:
    leaf = 3 + 2 + 3  # the longer path, with tail()
    for turns in (1, 5):
        assert most_of(code_of(LOOP, loop_row(str(turns)))) == 3 + turns * (4 + leaf)
    with pytest.raises(LedgerError, match="a loop at 104 without a bound"):
        most_of(code_of(LOOP))


def test_a_loop_that_is_tested_first_begins_once_more() -> None:
    text = """
00000100 <root>:
 100:\tcbz\tr0, 106 <root+0x6>
 102:\tsubs\tr0, #1
 104:\tb.n\t100 <root>
 106:\tbx\tlr
"""
    assert most_of(code_of(text, loop_row("5"))) == 5 * 3 + 1 + 1


def test_a_loop_whose_line_counts_needs_no_table(tmp_path: Path) -> None:
    source = tmp_path / "root.c"
    source.write_text("void root(int n) {\n    for (int i = 0; i < N; i++) {\n        leaf();\n", encoding="utf-8")
    places = {address: (Place("root", str(source), 2),) for address in range(0x104, 0x10E, 2)}
    code = code_of(LOOP, places=places)
    assert most_of(code) == 3 + 5 * (4 + 8)


def test_statements_join_blocks_of_different_functions() -> None:
    text = """
00000100 <root>:
 100:\tcbz\tr0, 106 <root+0x6>
 102:\tbl\t200 <left>
 106:\tcbz\tr1, 10c <root+0xc>
 108:\tbl\t300 <right>
 10c:\tbx\tlr

00000200 <left>:
 200:\tnop
 202:\tbx\tlr

00000300 <right>:
 300:\tnop
 302:\tnop
 304:\tbx\tlr
"""
    both = 1 + 1 + 2 + 1 + 1 + 3 + 1

    def most(kind: str, line: str, limit: str = "1", public: str = "all") -> int:
        return most_of(code_of(text, Row(2, kind, public, line, "", limit, "", "for a test")))

    assert most_of(code_of(text)) == both
    assert most("most", "root > left | root > right") == both - 3
    assert most("most", "any > left", "0") == both - 3
    assert most("most", "root > left | root > right", public="another") == both
    assert most("most", "root > right | -1 root > left", "0") == both
    assert most("case", "root > left | root > right") == both - 3
    with pytest.raises(LedgerError, match="not <times> <caller> > <callee>"):
        most("most", "left and right")


def test_a_bound_may_depend_on_who_calls(tmp_path: Path) -> None:
    text = """
00000100 <root>:
 100:\tbl\t200 <turns>
 104:\tbl\t200 <turns>
 108:\tbx\tlr

00000200 <turns>:
 200:\tsubs\tr0, #1
 202:\tbne.n\t200 <turns>
 204:\tbx\tlr
"""
    source = tmp_path / "root.c"
    source.write_text("turns(2);\nturns(9);\n", encoding="utf-8")
    places = {0x100 + 4 * i: (Place("root", str(source), i + 1),) for i in range(2)}
    rows = [loop_row("9", function="turns"), loop_row("2", function="turns", when="turns(2);")]
    assert most_of(code_of(text, *rows, places=places)) == 3 + (2 * 9 + 1) + (2 * 2 + 1)


# ---------------------------------------------------------------------------------------------------------------- proof


def program() -> Program:
    """Maximizes 2 x1 + x2 for x1 + x2 <= 3, x1 <= 2."""
    made = Program()
    made.variable()
    made.variable(2)
    made.variable(1)
    made.at_most = [{1: 1, 2: 1, 0: -3}, {1: 1, 0: -2}]
    return made


def test_the_largest_sum_is_proved() -> None:
    found = solve(program())
    assert found is not None
    assert found.most == 5
    assert proved(program(), [], [Fraction(1), Fraction(1)]) == 5
    assert proved(program(), [], [Fraction(2), Fraction(0)]) == 6  # weaker, but a bound


@pytest.mark.parametrize("factors", [(1, 0), (-1, 3), (0, 2)])
def test_multipliers_that_prove_nothing_are_refused(factors: tuple[int, int]) -> None:
    with pytest.raises(LedgerError, match="prove no bound"):
        proved(program(), [], [Fraction(factor) for factor in factors])


def test_a_problem_without_bound_or_solution_is_reported() -> None:
    endless = program()
    endless.at_most = []
    with pytest.raises(LedgerError, match="is unbounded"):
        solve(endless)
    none = program()
    none.equal = [{0: 1, 1: 1}]
    assert solve(none) is None


# ---------------------------------------------------------------------------------------------------------------- table


@pytest.mark.parametrize(
    ("line", "turns"),
    [
        ("for (size_t i = 0; i < GOE_ROWS; i++) {", 9),
        ("for (size_t i = FIRST; i <= GOE_ROWS; i += 2) { #2", 4),
        ("for (int i = 0; i < GOE_ROWS * (GOE_ROWS + 1) / 2; i++) {", 45),
        ("for (size_t j = GOE_ROWS; j-- > FIRST;) {", 7),
        ("for (size_t i = 0; i < count; i++) {", None),
        ("while (*name++ != 0) {", None),
    ],
)
def test_a_line_that_counts_between_constants_needs_no_bound(line: str, turns: int | None) -> None:
    assert loop_bounds.counted(line, {"GOE_ROWS": 9, "FIRST": 2}) == turns


def test_constants_of_the_headers_and_of_one_source_alone() -> None:
    headers = '#define A 3\n#define B (A + 2u) /* two more */\nenum { ZERO, ONE, FIVE = 5, SIX };\n#define TEXT "x"\n'
    sources = ["#define OWN (B * 2)\n#define SAME 1\n#define OTHER 1\n", "#define SAME 1\n#define OTHER 2\n"]
    found = loop_bounds.constants_of(headers, sources)
    assert found == {"A": 3, "B": 5, "ZERO": 0, "ONE": 1, "FIVE": 5, "SIX": 6, "OWN": 10, "SAME": 1}
    with pytest.raises(LedgerError, match="neither a number nor a known constant"):
        loop_bounds.value_of("OTHER + 1", found)


@pytest.mark.parametrize("line", ["loop,f,#1,,3,entry,", "hoop,f,#1,,3,entry,why", "loop,f,#1,,3,turn,why", "loop,f"])
def test_a_table_without_reasons_is_refused(line: str, tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text(",".join(HEAD) + f"\n{line}\n", encoding="utf-8")
    with pytest.raises(LedgerError, match="line 2"):
        loop_bounds.read(file)


def test_every_line_of_the_committed_table_has_a_reason() -> None:
    rows = loop_bounds.read()
    assert len({(row.kind, row.function, row.line, row.when, row.per) for row in rows}) == len(rows)


def test_places_are_read_innermost_first() -> None:
    text = "0x00000100\ninner\n/a.c:3 (discriminator 2)\nouter\n/a.c:9\n0x00000102\n??\n??:0\n"
    assert places_of(text) == {0x100: (Place("inner", "/a.c", 3), Place("outer", "/a.c", 9)), 0x102: ()}


# ---------------------------------------------------------------------------------------------------------------- turns


class Machine(Build):
    """Counts the given addresses as if the loop had turned six times."""

    def image(self, kind: str) -> Path:
        return self.tree / kind

    def run_image(self, image: Path, *options: str) -> str:
        given = dict(word.split("=", 1) for word in options[1].split(",")[1:])
        events = Path(given["map"]).read_text(encoding="utf-8").splitlines()
        assert "count 104 0" in events
        assert "reset 102 0" in events
        Path(given["out"]).write_text("6\n", encoding="utf-8")
        return ""


@pytest.mark.parametrize(("most", "wrong"), [("N + 1", 0), ("N", 1)])
def test_a_bound_that_the_logs_exceed_is_found(
    most: str, wrong: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(trip_counts, "build_plugin", lambda folder, name: folder / name)
    built = Machine("m4f-gcc-o2", tmp_path, "none", "", "gcc", [], [])
    trips = trip_counts.measured(built, code_of(LOOP, loop_row(most)), tmp_path)
    assert [trip.measured for trip in trips] == [6]
    assert len(trip_counts.exceeded(trips)) == wrong


def test_blocks_that_exclude_each_other_are_counted_together() -> None:
    """Each statement applies to every call that it names. Times may be negative. An inlined block counts alone."""
    place = (Place("tail", "", 1), Place("leaf", "", 1))
    rows = [
        Row(4, "most", "all", "root > leaf | -2 =leaf > tail", "", "1", "", "for a test"),
        Row(5, "case", "all", "leaf > tail", "", "1", "", "for a test"),
        Row(6, "most", "another", "root > leaf", "", "0", "", "for a test"),
    ]
    code = code_of(LOOP, loop_row("5"), *rows, places={0x202: place})
    found = list(trip_counts.checks_of_statements(code, Finder(code, "all")))
    assert [check.counts for check in found] == [
        ((0x104, 1), (0x208, -2)),
        ((0x200, 1), (0x208, 1)),
    ]
    lines = trip_counts.map_of(code, found).splitlines()
    assert lines[:4] == ["count 104 0", "less 208 0", "less 208 0", "needs 0 0"]
