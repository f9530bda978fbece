"""What goe_tools says of a mistyped command line."""

from __future__ import annotations

import pytest
from goe_tools.__main__ import main


@pytest.mark.parametrize(
    ("words", "guess"),
    [
        (["tabel"], "did you mean table?"),
        (["table", "estimates.csv", "--thruth", "truth.csv"], "did you mean --truth?"),
        (["table", "estimates.csv", "--colour"], ""),
        (["goals", "--quik"], "did you mean --quick?"),
        (["goals", "--half", "setle"], ""),
    ],
)
def test_a_mistyped_word(words: list[str], guess: str, capsys) -> None:
    with pytest.raises(SystemExit) as end:
        main(words)
    assert end.value.code == 2
    told = capsys.readouterr().err.strip()
    assert told.endswith(guess) and ("did you mean" in told) == bool(guess)
