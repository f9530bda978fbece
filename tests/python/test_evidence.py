"""The evidence: its command, its table, its record."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from goe_tools.__main__ import main
from goe_tools.evidence import command
from goe_tools.evidence.parts import Amount, NotHereError
from goe_tools.evidence.record import Result, Row, read

ROOT = Path(__file__).resolve().parents[2]
GOOD = Result([Row("lines", "10 of 10", "all", True), Row("seconds", "3", "", None)], "why")
BAD = Result([Row("lines", "9 of 10", "all", False)])


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Two parts and one that cannot run; the record's path."""

    def absent(amount: Amount) -> Result:
        raise NotHereError("no such compiler")

    runs = {"good": lambda amount: GOOD, "bad": lambda amount: BAD, "absent": absent}
    monkeypatch.setattr(command, "MODULES", dict.fromkeys(runs, "asks something"))
    monkeypatch.setattr(command, "REPORTS", tmp_path / "reports")
    monkeypatch.setattr(command, "runner", runs.__getitem__)
    return tmp_path / "record.json"


def test_quick_prints_and_keeps_nothing(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evidence", "--quick", "--only", "good", "--record", str(made_up)]) == 0
    said = capsys.readouterr()
    assert "| good | lines | 10 of 10 | all | met | quick, " in said.out
    assert not made_up.exists()
    assert (made_up.parent / "reports" / "good.txt").read_text() == "why\n"


def test_a_goal_that_is_missed_fails(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evidence", "--quick", "--record", str(made_up)]) == 1
    said = capsys.readouterr()
    assert "| bad | lines | 9 of 10 | all | MISSED |" in said.out
    assert "absent: left out: no such compiler" in said.err


def test_long_keeps_its_rows_beside_those_of_others(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evidence", "--long", "--only", "bad", "--record", str(made_up)]) == 1
    assert main(["evidence", "--long", "--only", "good", "--record", str(made_up)]) == 0
    kept = read(made_up)
    assert list(kept) == ["bad", "good"]
    assert kept["good"].rows == GOOD.rows and kept["good"].amount == "long"
    assert kept["good"].golden_hash == (ROOT / "tests/targets/golden_hash.txt").read_text().split()[0]
    capsys.readouterr()
    assert main(["evidence", "--show", "--record", str(made_up)]) == 0
    assert "| good | lines |" in capsys.readouterr().out


def test_a_record_that_is_none(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made_up.write_text(json.dumps([{"part": "good"}]))
    assert main(["evidence", "--show", "--record", str(made_up)]) == 2
    assert f"{made_up}: not a record of evidence" in capsys.readouterr().err


def test_the_script_is_the_command(tmp_path: Path) -> None:
    if not (ROOT / ".venv" / "installed").exists():
        pytest.skip("tools/setup.sh has not run")
    done = subprocess.run(
        [str(ROOT / "tools" / "evidence.sh"), "--show", "--record", str(tmp_path / "none.json")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("| part | what |")
