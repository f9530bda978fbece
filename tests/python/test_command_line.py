"""What the three packages of tools say of a mistyped command line."""

from __future__ import annotations

import pytest
from bench.__main__ import main as bench_main
from ci.__main__ import main as ci_main
from goe_tools.__main__ import main

MAIN = {"goe_tools": main, "bench": bench_main, "ci": ci_main}


@pytest.mark.parametrize(
    ("package", "words", "guess"),
    [
        ("goe_tools", ["tabel"], "did you mean table?"),
        ("goe_tools", ["table", "estimates.csv", "--thruth", "truth.csv"], "did you mean --truth?"),
        ("goe_tools", ["table", "estimates.csv", "--colour"], ""),
        ("bench", ["goals", "--quik"], "did you mean --quick?"),
        ("bench", ["goals", "--half", "setle"], ""),
        ("ci", ["evidnce"], "did you mean evidence?"),
    ],
)
def test_a_mistyped_word(package: str, words: list[str], guess: str, capsys) -> None:
    with pytest.raises(SystemExit) as end:
        MAIN[package](words)
    assert end.value.code == 2
    told = capsys.readouterr().err.strip()
    assert told.endswith(guess) and ("did you mean" in told) == bool(guess)
