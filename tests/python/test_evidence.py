"""The evidence: its command, table and record."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.evidence import command
from ci.evidence.parts import Amount, NotHereError
from ci.evidence.record import Kept, Result, Row, read

ROOT = Path(__file__).resolve().parents[2]
GOOD = Result([Row("lines", "10 of 10", "all", True), Row("seconds", "3", "", None)], "why")
BAD = Result([Row("lines", "9 of 10", "all", False)])


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Two parts that run, one that cannot, and the path of the record."""

    def absent(amount: Amount) -> Result:
        raise NotHereError("no such compiler")

    runs = {"good": lambda amount: GOOD, "bad": lambda amount: BAD, "absent": absent}
    monkeypatch.setattr(command, "MODULES", dict.fromkeys(runs, "a description"))
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


def test_a_part_that_does_not_build_fails_and_the_others_run(
    made_up: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(amount: Amount) -> Result:
        raise RuntimeError("probe.c: no such member")

    runs = {"broken": broken, "good": lambda amount: GOOD}
    monkeypatch.setattr(command, "MODULES", dict.fromkeys(runs, "a description"))
    monkeypatch.setattr(command, "runner", runs.__getitem__)
    assert main(["evidence", "--quick", "--only", "broken", "--only", "good", "--record", str(made_up)]) == 1
    said = capsys.readouterr()
    assert "| good | lines | 10 of 10 |" in said.out
    assert "broken: FAILED: probe.c: no such member" in said.err and "no figures of broken" in said.err


def test_long_keeps_its_rows_and_those_of_others(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
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


def recorded(commit: str = 40 * "a", amount: str = "long") -> list[dict[str, object]]:
    entry = Kept("good", amount, "2026-01-01", "0", 1.0, "a machine", GOOD.rows, commit, 2)
    return [asdict(entry), {**asdict(entry), "part": "bad"}, {**asdict(entry), "part": "absent"}]


def test_a_release_is_one_file_of_one_commit(
    made_up: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(command, "RELEASES", tmp_path / "releases")
    made_up.write_text(json.dumps(recorded()))
    assert main(["evidence", "--release", "0.10.0", "--record", str(made_up)]) == 0
    written = json.loads((tmp_path / "releases" / "0.10.0.json").read_text())
    assert (written["version"], written["commit"], written["cores"]) == ("0.10.0", 40 * "a", 2)
    assert [part["part"] for part in written["parts"]] == ["good", "bad", "absent"] and written["parts"][0]["seconds"]
    (tmp_path / "releases" / "0.9.0.json").write_text("{")  # older, though later in the alphabet
    capsys.readouterr()
    monkeypatch.setattr(command, "RECORD", tmp_path / "none.json")
    assert main(["evidence", "--show"]) == 0
    assert "| good | lines | 10 of 10 |" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("version", "record", "message"),
    [
        ("0.4", recorded(), "not a version"),
        ("0.4.0", recorded()[:2], "no long run of absent"),
        ("0.4.0", recorded(amount="quick"), "no long run of good, bad, absent"),
        ("0.4.0", recorded("b+"), "parts ran on b\\+"),
        ("0.4.0", recorded("b")[:1] + recorded("c")[1:], "parts ran on b, c"),
    ],
)
def test_no_release_of_a_mixed_record(
    version: str, record: list[object], message: str, made_up: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made_up.write_text(json.dumps(record))
    assert main(["evidence", "--release", version, "--record", str(made_up)]) == 2
    assert re.search(message, capsys.readouterr().err)
    assert not (command.RELEASES / f"{version}.json").exists()


def test_the_commit_names_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "ROOT", tmp_path)
    assert command.commit() == ""
    for words in (["init"], ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "--allow-empty", "-m", "Begin"]):
        subprocess.run(["git", *words], cwd=tmp_path, check=True, capture_output=True)
    assert re.fullmatch("[0-9a-f]{40}", command.commit())
    (tmp_path / "new").write_text("")
    assert re.fullmatch("[0-9a-f]{40}\\+", command.commit())


def test_the_releases_that_are_here_can_be_read() -> None:
    files = list(command.RELEASES.glob("*.json"))
    assert files
    for file in files:
        assert re.fullmatch("[0-9a-f]{40}", json.loads(file.read_text())["commit"]) and read(file)


def test_the_script_is_the_command(tmp_path: Path) -> None:
    """In a copy whose set-up only prints a line: the set-up runs first, and only the table is written to standard
    output."""
    tools, python = tmp_path / "tools", tmp_path / ".venv" / "bin" / "python"
    tools.mkdir()
    python.parent.mkdir(parents=True)
    shutil.copy(ROOT / "tools" / "evidence.sh", tools)
    command = [str(tools / "evidence.sh"), "--show", "--record", str(tmp_path / "none.json")]

    def run(after_set_up: str) -> subprocess.CompletedProcess[str]:
        for file, line in (
            (tools / "setup.sh", f"echo set up $#; {after_set_up}"),
            (python, f'exec "{sys.executable}" "$@"'),
        ):
            file.write_text(f"#!/bin/sh\n{line}\n")
            file.chmod(0o755)
        settings = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
        return subprocess.run(command, env=settings, capture_output=True, text=True, check=False)

    done = run("true")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("| part | what |") and done.stderr == "set up 0\n"
    failed = run("exit 1")
    assert failed.returncode == 1 and not failed.stdout
