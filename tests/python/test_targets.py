"""The logs that the target images carry."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from ci import embed_logs

TARGETS = Path(__file__).resolve().parents[1] / "targets"


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
