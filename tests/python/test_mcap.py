"""Logs as MCAP: mcap's own reader returns the content of the CSV files."""

from __future__ import annotations

import csv
import json
import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from goe_tools.__main__ import main
from goe_tools.exchange.mcap_command import run_replay
from goe_tools.exchange.messages import SCHEMAS, heading_turn, turned_up
from goe_tools.flights.rotations import matrices
from goe_tools.logs.obslog import ObservationLog, read_log, write_log
from goe_tools.logs.scene import Scene, make_log

reader = pytest.importorskip("mcap.reader", reason="mcap is not installed (tools/setup.sh)")
ROOT = Path(__file__).resolve().parents[2]
SCENE = Scene(shape="box", width_m=6.0, length_m=14.0, height_m=8.0, x0_m=-18.0, z0_m=130.0, alpha_deg=25.0, run_s=6.0,
              speed_mps=15.0, altitude_m=25.0, wobble_deg=2.0, course_deg=40.0, rounding="pixel")  # fmt: skip
Messages = dict[str, list[tuple[str, int, dict]]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of two obstacles with its estimates in the same folder."""
    program = Path(os.environ.get("GOE_REPLAY") or ROOT / "build" / "sim_host" / "goe_replay")
    if not program.is_file():
        pytest.skip(f"{program} is not built")
    folder = tmp_path_factory.mktemp("log")
    one, two = make_log(SCENE), make_log(replace(SCENE, shape="cylinder", id=2, x0_m=12.0, z0_m=160.0))
    frames = sorted([*one.frames, *two.frames], key=lambda frame: frame.t_s)
    write_log(folder, ObservationLog(one.camera, frames, {**one.truth, **two.truth}))
    run_replay(folder, folder / "estimates.csv")
    return folder


def read(path: Path) -> Messages:
    result: Messages = {}
    with path.open("rb") as stream:
        for schema, channel, message in reader.make_reader(stream).iter_messages():
            assert channel.message_encoding == "json" and schema.encoding == "jsonschema"
            assert message.log_time == message.publish_time
            content = json.loads(message.data)
            assert_of_schema(content, json.loads(schema.data), channel.topic)
            result.setdefault(channel.topic, []).append((schema.name, message.log_time, content))
    return result


def assert_of_schema(value: object, schema: dict, where: str) -> None:
    """Checks the parts of JSON Schema in use. Every field must have a schema."""
    kinds = {"number": (int, float), "integer": int, "string": str, "array": list, "object": dict, "boolean": bool}
    assert isinstance(value, kinds[schema["type"]]), where
    if isinstance(value, dict):
        for name, part in value.items():
            assert name in schema["properties"], f"{where}.{name}"
            assert_of_schema(part, schema["properties"][name], f"{where}.{name}")
    elif isinstance(value, list):
        for part in value:
            assert_of_schema(part, schema["items"], where)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_it_reads_back_as_the_csv_says(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "log.mcap"
    assert main(["mcap", str(folder), "--out", str(out)]) == 0
    printed, found = capsys.readouterr().out, read(out)
    assert all(f"{topic}: {len(rows)}\n" in printed for topic, rows in found.items())
    for name, topic in (("estimates.csv", "estimate"), ("frames.csv", "observation")):
        for key in ("1", "2"):
            rows = [row for row in table(folder / name) if row["id"] == key]
            messages = found[f"/{topic}/{key}"]
            assert len(rows) == len(messages) > 40
            for row, (schema, time_ns, content) in zip(rows, messages):
                assert schema == f"goe.{topic.capitalize()}"
                assert time_ns == round(float(row["t_s"]) * 1e9) == to_ns(content["timestamp"])
                for column in ("t_s", "id"):
                    row.pop(column)
                for column, text in row.items():
                    if text == "":
                        assert column not in content, column
                    elif column in ("status", "model", "reason"):
                        assert content[column] == text
                    else:
                        assert content[column] == float(text), column


def to_ns(stamp: dict) -> int:
    return stamp["sec"] * 1_000_000_000 + stamp["nsec"]


def test_poses_are_turned_to_east_north_up(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "log.mcap"
    assert main(["mcap", str(folder), "--estimates", str(folder / "estimates.csv"), "--out", str(out)]) == 0
    found = read(out)
    times = {frame.t_s: frame for frame in read_log(folder).frames}
    assert len(found["/pose"]) == len(found["/tf"]) == len(times)
    assert {name for name, _, _ in found["/pose"]} == {"foxglove.PoseInFrame"}
    assert {name for name, _, _ in found["/tf"]} == {"foxglove.FrameTransform"}
    to_enu = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    for _, time_ns, content in found["/pose"]:
        frame = times[time_ns / 1e9]
        place, turn = content["pose"]["position"], content["pose"]["orientation"]
        assert [place[axis] for axis in "xyz"] == pytest.approx(list(to_enu @ frame.position_m))
        wanted = to_enu @ matrices(np.array(frame.attitude)) @ np.diag([1.0, -1.0, -1.0])
        assert matrices(np.array([turn[axis] for axis in "wxyz"])) == pytest.approx(wanted, abs=1e-9)


def test_the_scene_has_the_obstacles(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "log.mcap"
    assert main(["mcap", str(folder), "--out", str(out)]) == 0
    found = read(out)
    rows = {(float(r["t_s"]), r["id"]): r for r in table(folder / "estimates.csv") if r["center_n_m"]}
    assert len(found["/obstacles"]) == len(rows) > 50
    boxes = 0
    for name, time_ns, content in found["/obstacles"]:
        assert name == "foxglove.SceneUpdate"
        (entity,) = content["entities"]
        row = rows[time_ns / 1e9, entity["id"].split()[1]]
        *solid, region = [*entity["cubes"], *entity["cylinders"]]
        assert region["size"]["x"] == pytest.approx(4.0 * float(row["center_e_sd_m"]))
        assert region["size"]["y"] == pytest.approx(4.0 * float(row["center_n_sd_m"]))
        place = solid[0]["pose"]["position"]
        assert (place["x"], place["y"]) == (float(row["center_e_m"]), float(row["center_n_m"]))
        if entity["cubes"]:
            boxes += 1
            turn = matrices(np.array([solid[0]["pose"]["orientation"][axis] for axis in "wxyz"]))
            heading = math.degrees(math.atan2(turn[0, 0], turn[1, 0]))  # length axis, clockwise from north
            first = read_log(folder).tracks()[1][0]
            forward = matrices(np.array(first.attitude))[:, 0]
            z_axis = math.degrees(math.atan2(forward[1], forward[0]))
            assert math.remainder(heading - z_axis - float(row["orientation_deg"]), 180.0) == pytest.approx(
                0.0, abs=1e-6
            )
    assert boxes > 10
    truth = {content["entities"][0]["id"]: content["entities"][0] for _, _, content in found["/truth"]}
    assert set(truth) == {"truth 1", "truth 2"} and truth["truth 1"]["cubes"] and truth["truth 2"]["cylinders"]
    assert truth["truth 1"]["cubes"][0]["size"] == {"x": 14.0, "y": 6.0, "z": 8.0}


def test_turns() -> None:
    assert turned_up((1.0, 0.0, 0.0, 0.0)) == pytest.approx(heading_turn(0.0))  # level, facing north
    east = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    assert np.abs(turned_up(east)) == pytest.approx([1.0, 0.0, 0.0, 0.0])
    assert set(SCHEMAS) == {"foxglove.PoseInFrame", "foxglove.FrameTransform", "foxglove.SceneUpdate"}


def test_bad_measurements_have_no_pose(folder: Path, tmp_path: Path) -> None:
    lines = (folder / "frames.csv").read_text().splitlines()
    lines[3] = ",".join(["nan", *lines[3].split(",")[1:]])
    fields = lines[5].split(",")
    lines[5] = ",".join([*fields[:2], "nan", "", *fields[4:]])
    (tmp_path / "frames.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "camera.ini").write_text((folder / "camera.ini").read_text())
    assert main(["mcap", str(tmp_path), "--out", str(tmp_path / "log.mcap")]) == 0
    found = read(tmp_path / "log.mcap")
    rows = sum(len(messages) for topic, messages in found.items() if topic.startswith("/observation"))
    assert rows == len(lines) - 2  # without the header and the row without a time
    assert any("n_m" not in content for _, _, content in found["/observation/1"])


def test_wrong_input(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str],
                     monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    out = tmp_path / "file" / "log.mcap"
    (tmp_path / "file").touch()

    def refused(*words: str) -> str:
        assert main(["mcap", *words]) == 2
        assert not list(tmp_path.glob("*.part"))
        return capsys.readouterr().err

    assert "no such folder" in refused(str(tmp_path / "none"), "--out", str(out))
    assert f"{out}: File exists" in refused(str(folder), "--out", str(out))
    missing = str(tmp_path / "e.csv")
    assert f"{missing}: No such file" in refused(str(folder), "--estimates", missing, "--out", str(out))
    Path(missing).write_text("t_s,id\n")
    assert f"{missing}:1: status: column is missing" in refused(str(folder), "--estimates", missing, "--out", str(out))
    (tmp_path / "frames.csv").write_text("t_s,id,n_m,e_m,d_m,qw,qx,qy,qz\nsoon,1,0,0,0,1,0,0,0\n")
    (tmp_path / "camera.ini").write_text((folder / "camera.ini").read_text())
    assert "frames.csv:2: t_s: 'soon' is not a number" in refused(str(tmp_path), "--out", str(out))
    monkeypatch.setenv("GOE_REPLAY", str(tmp_path / "nothing"))
    assert "not found; build it" in refused(str(folder), "--out", str(tmp_path / "log.mcap"))
