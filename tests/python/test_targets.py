"""The tools of the target images: embedded logs and the cost ledger."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from goe_tools import ledger
from goe_tools.logs import embed_logs

TARGETS = Path(__file__).resolve().parents[1] / "targets"


def test_embedded_logs_are_what_the_generator_writes() -> None:
    committed = (TARGETS / "embedded_logs.c").read_text(encoding="utf-8")
    assert embed_logs.agrees(committed, embed_logs.c_text(embed_logs.make_book()))


def test_logs_may_differ_in_last_bits_only() -> None:
    assert embed_logs.agrees("{1, 0x3F800000u}", "{1, 0x3F800001u}")
    assert not embed_logs.agrees("{1, 0x3F800000u}", "{1, 0x3F800002u}")
    assert not embed_logs.agrees("{1, 0x3F800000u}", "{2, 0x3F800000u}")


@pytest.mark.parametrize(
    ("number", "bits"),
    [
        (1.0, "0x3F800000u"),
        (-0.0, "0x80000000u"),
        (1.0 + 2.0**-24, "0x3F800000u"),  # ties to even
        (1.0e-45, "0x00000001u"),
        (1.0e39, "0x7F800000u"),
        (-math.inf, "0xFF800000u"),
    ],
)
def test_bits_of_singles(number: float, bits: str) -> None:
    assert embed_logs.bits(number) == bits


@pytest.mark.parametrize(
    ("line", "frame"),
    [
        ("   0:\tpush\t{r4, r5, lr}", 12),
        ("   0:\tstmdb\tsp!, {r4, r5, r6, r7, r8, lr}", 24),
        ("   0:\tstmdb\tsp!, {r4-r8, lr}", 24),
        ("   0:\tvpush\t{d8}", 8),
        ("   0:\tvpush\t{d8-d15}", 64),
        ("   0:\tvpush\t{s16-s19}", 16),
        ("   0:\tsub\tsp, #248\t@ 0xf8", 248),
        ("   0:\tsub.w\tsp, sp, #1024", 1024),
        ("   0:\tstr.w\tlr, [sp, #-4]!", 4),
        ("   0:\taddi\tsp,sp,-32", 32),
        ("   0:\tadd\tsp,sp,-32", 32),
        ("   0:\tadd\tsp,sp,32", 0),
        ("   0:\tadd\tsp, #248", 0),
        ("   0:\tpop\t{r4, pc}", 0),
        ("   0:\tldr\tr0, [sp, #4]", 0),
    ],
)
def test_frames_from_machine_code(line: str, frame: int) -> None:
    assert ledger.frame_of_line(line) == frame


@pytest.mark.parametrize(
    ("line", "target"),
    [
        ("   0:\tbl\t1234 <goe_fold_deg>", "1234"),
        ("   0:\tb.w\t12a4 <memcpy>", "12a4"),
        ("   0:\tbne.n\t12 <goe_update+0x10>", None),
        ("   0:\tjal\t80003de8 <__mulsf3>", "80003de8"),
        ("   0:\tjal\tra,80003de8 <__mulsf3>", "80003de8"),
        ("   0:\tj\t80003de8 <memset>", "80003de8"),
    ],
)
def test_calls_from_machine_code(line: str, target: str | None) -> None:
    found = ledger.CALL.search(line)
    assert (found.group(1) if found else None) == target


def graph_of(**functions: tuple[int, list[int | str]]) -> dict[int, ledger.Function]:
    """Functions at addresses 0, 1, ...: name = (frame, callees)."""
    return {
        address: ledger.Function(name, frame, set(callees))
        for address, (name, (frame, callees)) in enumerate(functions.items())
    }


def test_deepest_path_of_a_call_graph() -> None:
    graph = graph_of(top=(16, [1, 2]), shallow=(100, []), deep=(8, [3]), deeper=(96, []))
    assert ledger.deepest(graph, 0) == 16 + 8 + 96


def test_recursion_is_refused() -> None:
    with pytest.raises(ledger.LedgerError, match="recursion: a -> b -> a"):
        ledger.deepest(graph_of(a=(8, [1]), b=(8, [0])), 0)


@pytest.mark.parametrize("callee", [7, "an indirect call"])
def test_an_unknown_callee_is_refused(callee: int | str) -> None:
    with pytest.raises(ledger.LedgerError, match="unknown callee: a -> "):
        ledger.deepest(graph_of(a=(8, [callee])), 0)


def test_growth_beyond_two_percent_is_told() -> None:
    before = {"bytes": {"code": 1000, "data": 0}, "compiler": "x"}
    assert ledger.grown(before, {"bytes": {"code": 1020, "data": 0}, "compiler": "y"}) == []
    assert ledger.grown(before, {"bytes": {"code": 1021, "data": 0}}) == ["bytes: code: 1000 -> 1021"]
    assert ledger.grown(before, {"bytes": {"code": 1, "data": 1}}) == ["bytes: data: 0 -> 1"]
    assert ledger.grown(before, {"bytes": {"code": 1, "rodata": 1}}) == ["bytes: rodata: 1, not in the ledger"]


def test_tables_go_between_the_markers(tmp_path: Path) -> None:
    readme = tmp_path / "README.md"
    readme.write_text(f"before\n{ledger.BEGIN}\nold\n{ledger.END}\nafter\n", encoding="utf-8")
    assert ledger.with_tables(readme, "new\n") == f"before\n{ledger.BEGIN}\nnew\n{ledger.END}\nafter\n"
    readme.write_text("no markers\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"README\.md: needs the lines"):
        ledger.with_tables(readme, "new\n")
