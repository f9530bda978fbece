"""PX4 logs that are cut, damaged or without a position: ``convert`` reports the loss and makes no reset of it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from autopilot_logs import Flown, ulog_topics, write_detections, write_ulog
from goe_tools.__main__ import main
from goe_tools.logs.obslog import read_log

pytest.importorskip("pyulog", reason="pyulog is not installed (tools/setup.sh)")

FLOWN = Flown()


def words(log: Path) -> list[str]:
    folder = log.parent
    files = ["--detections", str(folder / "detections.csv"), "--camera", str(folder / "camera.ini")]
    return ["convert", "--ulog", str(log), *files, "--out", str(folder / "log"), "--offset", "0"]


def test_a_cut_log_of_px4_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_ulog(tmp_path / "a.ulg", ulog_topics(FLOWN))
    write_detections(tmp_path, FLOWN, 0.0)
    path.write_bytes(path.read_bytes()[:-5])
    assert main(words(path)) == 0
    reason = "the file is cut: it ends within a message, after the data of 3"
    assert capsys.readouterr().err.startswith(f"warning: {path}: {reason}")


SYNC = b"\x08\x00S\x2f\x73\x13\x20\x25\x0c\xbb\x12"


@pytest.mark.parametrize("synchronized", [True, False])
def test_a_damaged_log_of_px4_loses_what_is_damaged_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], synchronized: bool
) -> None:
    """The damage begins within a message of the position; its counters do not become a reset."""
    path = write_ulog(tmp_path / "a.ulg", ulog_topics(FLOWN))
    write_detections(tmp_path, FLOWN, 0.0)
    whole, at, sizes = path.read_bytes(), 16, []
    while at < len(whole):
        end = at + 3 + int.from_bytes(whole[at : at + 2], "little")
        if whole[at + 2 : at + 5] == b"D\0\0":  # the topic of the position
            sizes.append((at, end))
        at = end
    start, again = sizes[150][0] + 40, sizes[170][0]
    sync = SYNC if synchronized else b""
    path.write_bytes(whole[:start] + bytes([0xFF]) * (again - start) + sync + whole[again:])
    assert main(words(path)) == 0
    printed = capsys.readouterr()
    lost = r"the data from 22\.9\d\d s on, " + (r"until 23\.4\d\d s" if synchronized else "no data follows")
    assert f"warning: {path}: the file is damaged at byte {sizes[150][0]}: " in printed.err
    assert re.search(lost, printed.err)
    assert "reset at" not in printed.out
    end_s = read_log(tmp_path / "log").frames[-1].t_s
    assert end_s > 29.0 if synchronized else end_s < 23.0


def test_a_log_of_px4_without_a_valid_position(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    topics = ulog_topics(FLOWN)
    topics["vehicle_local_position"] = [
        (kind, name, 0 * values if name == "xy_valid" else values)
        for kind, name, values in topics["vehicle_local_position"]
    ]
    path = write_ulog(tmp_path / "a.ulg", topics)
    write_detections(tmp_path, FLOWN, 0.0)
    reason = "vehicle_local_position.xy_valid, z_valid: marks 0 of 551 samples as valid: the autopilot knew no position"
    assert main(words(path)) == 2
    assert f"goe_tools convert: {path}: {reason}" in capsys.readouterr().err
