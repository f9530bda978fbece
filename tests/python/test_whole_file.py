"""Output files are complete or not written at all, and never replace an input; failed standard output."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import view_logs
from goe_tools.__main__ import main
from goe_tools.logs import obslog
from goe_tools.logs.fields import LogError
from goe_tools.logs.obslog import read_log, write_log
from goe_tools.logs.whole_file import refuse_inputs, replacing, write_whole

ROOT = Path(__file__).resolve().parents[2]


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_replaced_when_all_is_written(tmp_path: Path) -> None:
    old, link, new = tmp_path / "old.txt", tmp_path / "link.txt", tmp_path / "new.txt"
    old.write_text("old")
    old.chmod(0o640)
    link.symlink_to(old)
    with replacing(link) as place:
        place.write_text("fresh")
        assert old.read_text() == "old"
    assert link.is_symlink() and old.read_text() == "fresh" and old.stat().st_mode & 0o777 == 0o640
    write_whole(new, "é")
    mask = os.umask(0)
    os.umask(mask)
    assert new.read_bytes() == "é".encode() and new.stat().st_mode & 0o777 == 0o666 & ~mask
    assert names(tmp_path) == ["link.txt", "new.txt", "old.txt"]


@pytest.mark.parametrize("end", [KeyboardInterrupt, RuntimeError])
def test_an_unfinished_file_leaves_nothing(tmp_path: Path, end: type[BaseException]) -> None:
    old = tmp_path / "old.txt"
    old.write_text("old")
    for path in (old, tmp_path / "new.txt"):
        with pytest.raises(end), replacing(path) as place:
            place.write_text("half")
            raise end
    assert names(tmp_path) == ["old.txt"] and old.read_text() == "old"


def test_folders_on_the_way_are_made(tmp_path: Path) -> None:
    write_whole(tmp_path / "no" / "such" / "file", "text")
    assert (tmp_path / "no" / "such" / "file").read_text() == "text"


def test_places_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    (tmp_path / "file").touch()
    for path, reason in (
        (tmp_path / "link", "is a symbolic link that leads nowhere"),
        (tmp_path, "is a folder"),
        (tmp_path / "file" / "file", "File exists"),
        (Path("/dev/full"), "No space left on device"),
    ):
        with pytest.raises(LogError) as error:
            write_whole(path, "text")
        assert str(error.value) == f"{path}: {reason}"
    assert names(tmp_path) == ["file", "link"]


def test_an_input_is_not_replaced_by_whatever_link(tmp_path: Path) -> None:
    read = tmp_path / "read"
    read.write_text("mine")
    (tmp_path / "soft").symlink_to(read)
    os.link(read, tmp_path / "hard")
    for out in ("read", "soft", "hard"):
        with pytest.raises(LogError, match=f"the output would replace the input {read}"):
            refuse_inputs(tmp_path / out, [None, tmp_path / "absent", read])
    refuse_inputs(tmp_path / "other", [read])


def test_a_log_is_written_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C in the middle of its last file: the previous log remains."""
    folder = view_logs.written(view_logs.one_frame(), tmp_path / "log")
    before, other = {path: path.read_bytes() for path in folder.iterdir()}, view_logs.boxes()

    def interrupted(path: Path, *_: object) -> None:
        path.write_text("half")
        raise KeyboardInterrupt

    assert "truth.csv" in names(folder)
    monkeypatch.setattr(obslog, "write_truth", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_log(folder, other)
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    monkeypatch.undo()
    write_log(folder, other)
    assert read_log(folder) == other
    with pytest.raises(LogError, match="would replace"):
        write_log(folder, other, inputs=[folder / "camera.ini"])


@pytest.mark.parametrize(
    "words",
    [
        ["view", "LOG", "--out", "OUT"],
        ["view", "LOG", "--svg", "OUT"],
        ["mcap", "LOG", "--out", "OUT"],
        ["report", "CAMPAIGN", "--approach", "LOG", "--out", "OUT"],
    ],
    ids=["view", "picture", "mcap", "report"],
)
def test_commands_refuse_their_inputs(words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from synthetic_campaign import write_campaign

    log = view_logs.written(view_logs.one_frame(), tmp_path / "log")
    campaign = write_campaign(tmp_path / "c", studies=False) if "CAMPAIGN" in words else tmp_path
    (tmp_path / "out").symlink_to(log / "truth.csv")
    before = (log / "truth.csv").read_bytes()
    places = {"LOG": str(log), "OUT": str(tmp_path / "out"), "CAMPAIGN": str(campaign)}
    assert main([places.get(word, word) for word in words]) == 2
    assert "out: the output would replace " in capsys.readouterr().err
    assert (log / "truth.csv").read_bytes() == before


def test_output_that_nobody_takes(tmp_path: Path) -> None:
    """A full disk, a closed pipe: every command reports it in one line."""
    log = view_logs.written(view_logs.one_frame(), tmp_path / "log")
    words = [sys.executable, "-m", "goe_tools", "bound", str(log)]
    with open("/dev/full", "w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, cwd=ROOT, check=False)
    assert (done.returncode, done.stderr) == (2, "goe_tools bound: standard output: No space left on device\n")
