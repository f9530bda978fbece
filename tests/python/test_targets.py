"""The logs that the target images carry."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from ci import embed_logs

ROOT = Path(__file__).resolve().parents[2]
TARGETS = ROOT / "tests" / "targets"


def test_embedded_logs_are_those_of_the_generator() -> None:
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


ARITHMETIC = {"m0plus", "m4f", "m7-dp", "m55", "rv32imafc"}  # none, single, single and double, Helium, RISC-V's


def test_a_usual_run_has_every_arithmetic_and_every_pair_of_compiler_and_level() -> None:
    text = (TARGETS / "host.cmake").read_text(encoding="utf-8")
    listed = re.search(r"set\(targets_of_every_run\s+([^)]*)\)", text)
    processors = re.search(r"foreach\(processor ([^)]*)\)", text)
    assert listed and processors
    chosen = [re.fullmatch(r"(.+)-(gcc|clang)-(os|o2)", name) for name in listed[1].split()]
    kinds = {match.groups() for match in chosen if match}
    assert len(kinds) == len(chosen)
    assert ARITHMETIC <= {name for name, _, _ in kinds} <= set(processors[1].split())
    both = {(compiler, level) for compiler in ("gcc", "clang") for level in ("os", "o2")}
    assert {(compiler, level) for _, compiler, level in kinds} == both
    script = (ROOT / "tools" / "test.sh").read_text(encoding="utf-8")
    measured = re.search(r"ci ledger --check (.*)", script)
    assert measured and set(measured[1].split()) <= set(listed[1].split())
