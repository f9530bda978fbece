"""Conversion of autopilot logs and a detector's table into an observation log: poses, resets, the camera's clock, and
errors that name topic and time. The tests write the logs in the autopilots' own formats."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from autopilot_logs import (
    ARM_M,
    CAMERA,
    START_S,
    Fault,
    Flown,
    dataflash_messages,
    noisy,
    ulog_topics,
    write_dataflash,
    write_detections,
    write_tlog,
    write_ulog,
)
from goe_tools.__main__ import main
from goe_tools.flights.rotations import matrices, quaternions
from goe_tools.logs.obslog import Frame, ObservationLog, read_log

for module in ("pyulog", "pymavlink"):
    pytest.importorskip(module, reason=f"{module} is not installed (tools/setup.sh)")

FORMATS = ("ulog", "dataflash", "tlog")
OFFSET_TOLERANCE_S = 0.025
FLOWN = Flown()


def autopilot_log(folder: Path, kind: str, flown: Flown) -> Path:
    if kind == "ulog":
        return write_ulog(folder / "a.ulg", ulog_topics(flown))
    if kind == "dataflash":
        return write_dataflash(folder / "a.bin", dataflash_messages(flown))
    return write_tlog(folder / "a.tlog", flown)


def words(kind: str, log: Path, *more: str) -> list[str]:
    folder = log.parent
    files = ["--detections", str(folder / "detections.csv"), "--camera", str(folder / "camera.ini")]
    return ["convert", f"--{kind}", str(log), *files, "--out", str(folder / "log"), *more]


@pytest.fixture
def convert(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[ObservationLog, str]]:
    """Writes a flight and its detections, converts them, and returns the log and the output."""

    def run(kind: str, flown: Flown, offset_s: float, *more: str, **detections: object) -> tuple[ObservationLog, str]:
        log = autopilot_log(tmp_path, kind, flown)
        write_detections(tmp_path, flown, offset_s, **detections)  # type: ignore[arg-type]
        assert main(words(kind, log, *more)) == 0
        return read_log(tmp_path / "log"), capsys.readouterr().out

    return run


def printed_offset(text: str) -> tuple[float, float]:
    value, sigma = re.search(r"time offset, .*: (\S+) \+- (\S+) s", text).groups()  # type: ignore[union-attr]
    return float(value), float(sigma)


# ---------------------------------------------------------------------------------------------------------------- clock


@pytest.mark.parametrize(
    ("kind", "offset_s", "seed"),
    [("ulog", 0.0, 1), ("ulog", 0.05, 2), ("ulog", 0.12, 3), ("dataflash", 0.05, 4), ("dataflash", -0.2, 5),
     ("tlog", 0.0, 6), ("tlog", 0.12, 7)],
)  # fmt: skip
def test_the_offset_of_the_cameras_clock_is_found(
    convert: Callable[..., tuple[ObservationLog, str]], kind: str, offset_s: float, seed: int
) -> None:
    log, text = convert(kind, FLOWN, offset_s, seed=seed)
    found, sigma = printed_offset(text)
    assert abs(found - offset_s) < OFFSET_TOLERANCE_S
    assert abs(found - offset_s) < 3.5 * sigma
    assert sigma < OFFSET_TOLERANCE_S / 2
    assert len(log.frames) > 100 and set(log.tracks()) == {4, 9}


def test_a_slow_attitude_is_carried_on_by_the_gyro(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    """At 2 Hz, linear interpolation has a roll error of degrees."""
    _, text = convert("ulog", Flown(rate_hz=2.0), 0.12, "--gap", "1", seed=3)
    found, sigma = printed_offset(text)
    assert abs(found - 0.12) < OFFSET_TOLERANCE_S and sigma < OFFSET_TOLERANCE_S


def test_an_offset_is_looked_for_where_the_user_says(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    log, text = convert("ulog", FLOWN, 1000.05, "--about", "1000", "--within", "0.3")
    assert printed_offset(text)[0] == pytest.approx(1000.05, abs=OFFSET_TOLERANCE_S)
    assert log.frames[0].t_s == pytest.approx(START_S + 1.0, abs=OFFSET_TOLERANCE_S)


def test_an_unobservable_offset_has_to_be_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = autopilot_log(tmp_path, "ulog", FLOWN)
    reasons = {(0.9, (8, 80)): "turns and boxes determine no offset", (0.0, (8, 14)): "no track has known poses"}
    for (offset_s, images), reason in reasons.items():
        write_detections(tmp_path, FLOWN, offset_s, images=images)
        assert main(words("ulog", log)) == 2
        message = capsys.readouterr().err
        assert reason in message and "--offset" in message and "detections.csv: t_s: " in message
        assert main(words("ulog", log, "--offset", str(offset_s))) == 0


# ---------------------------------------------------------------------------------------------------------------- poses


@pytest.mark.parametrize("kind", FORMATS)
def test_poses_are_those_at_the_time_of_exposure(
    convert: Callable[..., tuple[ObservationLog, str]], kind: str, tmp_path: Path
) -> None:
    """The pose is logged at 50 Hz (tlog: times in whole ms); the images lie at any time in between."""
    log, _ = convert(kind, replace(FLOWN, rate_hz=47.0), 0.0333, "--offset", "0.0333")
    t = np.array([frame.t_s for frame in log.frames]) - START_S
    place = FLOWN.position(t)
    assert np.abs(np.array([f.position_m for f in log.frames]) - place).max() < 0.02
    message, true = matrices(np.array([f.attitude for f in log.frames])), matrices(quaternions(*FLOWN.angles(t)))
    angle = np.arccos(np.clip((np.einsum("kij,kij->k", message, true) - 1) / 2, -1, 1))
    assert np.degrees(angle.max()) < 0.06
    arm = np.einsum("kij,j->ki", true, np.array(ARM_M))
    height = -(place + arm)[:, 2]
    assert np.abs([f.agl_m - h for f, h in zip(log.frames, height)]).max() < 0.02  # type: ignore[operator]
    assert log.camera == CAMERA
    boxes = {(round(f.t_s - 0.0333, 6), f.id): f.box_px for f in log.frames}
    lines = [line.split(",") for line in (tmp_path / "detections.csv").read_text().splitlines()[1:]]
    assert all(boxes[round(float(t_s), 6), int(key)][0] == float(left) for t_s, key, left, *_ in lines)  # type: ignore[index]


def test_the_height_is_above_the_configured_or_measured_ground(
    convert: Callable[..., tuple[ObservationLog, str]],
) -> None:
    """The ground below is 2 m lower than the origin."""
    for kind in ("ulog", "dataflash"):
        heights = {}
        for name, more in {"origin": (), "ground": ("--ground", "1.5"), "sensor": ("--height", "sensor")}.items():
            log, _ = convert(kind, FLOWN, 0.0, "--offset", "0", *more)
            heights[name] = np.array([frame.agl_m for frame in log.frames])
        assert heights["ground"] - heights["origin"] == pytest.approx(1.5)
        assert heights["sensor"] - heights["origin"] == pytest.approx(2.0, abs=0.02)


def test_a_log_without_a_sensor_of_the_height(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = autopilot_log(tmp_path, "tlog", FLOWN)
    write_detections(tmp_path, FLOWN, 0.0)
    assert main(words("tlog", log, "--offset", "0", "--height", "sensor")) == 2
    assert "a.tlog: no sensor of the height above ground was logged" in capsys.readouterr().err


# --------------------------------------------------------------------------------------------------------------- resets

JUMP = (2.5, -3.0, 0.0)


def around(frames: list[Frame], time_s: float) -> tuple[Frame, Frame]:
    """The last row before a time and the first after it."""
    after = next(k for k, frame in enumerate(frames) if frame.t_s >= time_s)
    return frames[after - 1], frames[after]


@pytest.mark.parametrize("kind", FORMATS)
def test_a_known_jump_is_taken_along(convert: Callable[..., tuple[ObservationLog, str]], kind: str) -> None:
    at = START_S + 5.34
    log, text = convert(kind, replace(FLOWN, faults=[Fault(at, JUMP)]), 0.0, "--offset", "0")
    assert re.search(r"reset at 25\.3[34]\d s, .*: \+2\.[45]\d, -[23]\.[09]\d, [+-]0\.0\d m", text)
    for frames in log.tracks().values():
        before, after = around(frames, at)
        assert (before.reset_count, after.reset_count) == (0, 1)
        assert after.reset_delta_m == pytest.approx(JUMP, abs=0.05)
        others = [frame for frame in frames if frame is not after]
        assert all(frame.reset_delta_m is None for frame in others)
        t = np.array([frame.t_s for frame in frames])
        wanted = FLOWN.position(t - START_S) + np.where(t[:, None] >= at, JUMP, 0.0)
        assert np.abs(np.array([f.position_m for f in frames]) - wanted).max() < 0.02


UNCOUNTED = {  # NED m and degrees, and what the command prints
    (2.5, -3.0, 0.0, 0.0): ": a step: +2.50, -3.00, -0.00 m",
    (0.0, 0.0, -8.0, 0.0): ": a step: -0.00, +0.00, -8.00 m",
    (20.0, 0.0, 0.0, 0.0): ": a step: +20.00, +0.00, -0.00 m",
    (0.0, 0.0, 0.0, 11.0): ": a turn by 11.0 deg: the track is split",
}


@pytest.mark.parametrize("jump", UNCOUNTED)
def test_a_jump_that_px4_does_not_count_is_detected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], jump: tuple[float, ...]
) -> None:
    at = START_S + 5.34
    flown = replace(FLOWN, faults=[Fault(at, jump[:3], yaw_deg=jump[3])])  # type: ignore[arg-type]
    topics = {
        name: [column for column in columns if "reset_counter" not in column[1]]
        for name, columns in ulog_topics(flown).items()
    }
    write_ulog(tmp_path / "a.ulg", topics)
    write_detections(tmp_path, flown, 0.0)
    assert main(words("ulog", tmp_path / "a.ulg", "--offset", "0")) == 0
    text = capsys.readouterr().out
    assert text.count("reset at ") == 1
    printed, wanted = (re.sub(r"[+-]0\.00", "0", line) for line in (text, UNCOUNTED[jump]))
    assert wanted in printed
    _, after = around(read_log(tmp_path / "log").tracks()[4], at)
    assert after.reset_count == 1
    assert after.reset_delta_m == (None if jump[3] else pytest.approx(jump[:3], abs=0.05))


@pytest.mark.parametrize("fault", [Fault(START_S + 5.34, (4.0, 1.0, -3.0)), Fault(START_S + 5.34, yaw_deg=20.0)])
def test_a_counted_jump_is_counted_once(convert: Callable[..., tuple[ObservationLog, str]], fault: Fault) -> None:
    log, text = convert("ulog", replace(FLOWN, faults=[fault]), 0.0, "--offset", "0")
    assert text.count("reset at ") == 1 and "_reset_counter" in text
    assert log.frames[-1].reset_count == 1


def test_a_velocity_in_another_unit_is_no_jump_at_each_sample(tmp_path: Path) -> None:
    topics = ulog_topics(replace(FLOWN, rate_hz=10.0))
    topics["vehicle_local_position"] = [
        (kind, name, values / 0.3048 if name in ("vx", "vy", "vz") else values)
        for kind, name, values in topics["vehicle_local_position"]
    ]
    write_ulog(tmp_path / "a.ulg", topics)
    write_detections(tmp_path, FLOWN, 0.0)
    assert main(words("ulog", tmp_path / "a.ulg", "--offset", "0")) == 0
    assert all(frame.reset_count == 0 for frame in read_log(tmp_path / "log").frames)


def test_two_jumps_between_two_images_are_summed(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    faults = [Fault(START_S + 5.28, (1.0, 2.0, 0.0)), Fault(START_S + 5.34, (0.5, -4.0, 0.0))]
    log, _ = convert("ulog", replace(FLOWN, faults=faults), 0.0, "--offset", "0")
    _, after = around(log.tracks()[4], faults[0].time_s)
    assert after.reset_count == 2 and after.reset_delta_m == pytest.approx((1.5, -2.0, 0.0), abs=1e-6)


def test_a_jump_of_all_three_axes(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    log, _ = convert("ulog", replace(FLOWN, faults=[Fault(START_S + 5.34, (2.0, 1.0, -3.0))]), 0.0, "--offset", "0")
    _, after = around(log.tracks()[9], START_S + 5.34)
    assert (after.reset_count, after.reset_delta_m) == (1, pytest.approx((2.0, 1.0, -3.0)))


@pytest.mark.parametrize("kind", ["ulog", "dataflash"])
def test_a_jump_of_the_heading_cuts_the_track(convert: Callable[..., tuple[ObservationLog, str]], kind: str) -> None:
    at = START_S + 5.34
    log, text = convert(kind, replace(FLOWN, faults=[Fault(at, yaw_deg=20.0)]), 0.0, "--offset", "0")
    assert re.search(r"reset at 25\.3[34]\d s, .*: the track is split", text)
    for frames in log.tracks().values():
        before, after = around(frames, at)
        assert (before.reset_count, after.reset_count, after.reset_delta_m) == (0, 1, None)


def test_a_cut_does_not_spoil_the_offset(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    flown = replace(FLOWN, faults=[Fault(START_S + 4.0, (5.0, -9.0, 2.0)), Fault(START_S + 6.5, yaw_deg=4.0)])
    found, _ = printed_offset(convert("ulog", flown, 0.05, "--within", "0.3", seed=4)[1])
    assert found == pytest.approx(0.05, abs=0.03)


def test_an_image_between_the_samples_of_a_cut_is_left_out(convert: Callable[..., tuple[ObservationLog, str]]) -> None:
    flown = replace(FLOWN, rate_hz=5.0, gyro_hz=200.0, faults=[Fault(START_S + 5.4, yaw_deg=20.0)])
    log, text = convert("ulog", flown, 0.0, "--offset", "0")
    assert "left out: row at 25.250 s, ids 4, 9: the filter jumped between the samples around it, at 25.400 s" in text
    assert all(not START_S + 5.2 < frame.t_s < START_S + 5.4 for frame in log.frames)


def test_noise_of_the_attitude_is_no_jump(convert: Callable[..., tuple[ObservationLog, str]], tmp_path: Path) -> None:
    messages = dataflash_messages(FLOWN)
    kinds, columns, rows = messages["XKQ"]
    q = noisy(np.array([row[2:] for row in rows], float), 0.3, 5)
    messages["XKQ"] = (kinds, columns, [(*row[:2], *q[k]) for k, row in enumerate(rows)])
    log = write_dataflash(tmp_path / "a.bin", messages)
    write_detections(tmp_path, FLOWN, 0.0)
    assert main(words("dataflash", log, "--offset", "0")) == 0
    assert all(frame.reset_count == 0 for frame in read_log(tmp_path / "log").frames)


def test_odometry_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its counter reports that there was a reset, but not its size."""
    flown = replace(FLOWN, faults=[Fault(START_S + 5.34, JUMP)])
    log = write_tlog(tmp_path / "a.tlog", flown, odometry=True)
    write_detections(tmp_path, flown, 0.0)
    assert main(words("tlog", log, "--offset", "0")) == 0
    assert "ODOMETRY.reset_counter: the track is split" in capsys.readouterr().out
    _, after = around(read_log(tmp_path / "log").tracks()[4], START_S + 5.34)
    assert (after.reset_count, after.reset_delta_m) == (1, None)


# --------------------------------------------------------------------------------------------------------------- errors


def refused(capsys: pytest.CaptureFixture[str], arguments: list[str]) -> str:
    assert main(arguments) == 2
    message = capsys.readouterr()
    assert not (Path(arguments[-1]) / "frames.csv").exists()
    return message.err


def test_topics_and_fields_that_are_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_detections(tmp_path, FLOWN, 0.0)
    path = tmp_path / "a.ulg"
    for topic in ("vehicle_attitude", "vehicle_local_position"):
        write_ulog(path, {name: rows for name, rows in ulog_topics(FLOWN).items() if name != topic})
        assert f"{path}: {topic}: the log has no such topic" in refused(capsys, words("ulog", path))
    topics = ulog_topics(FLOWN)
    topics["vehicle_attitude"] = [row for row in topics["vehicle_attitude"] if row[1] != "q"]
    write_ulog(path, topics)
    assert f"{path}: vehicle_attitude.q[0]: the topic has no such field" in refused(capsys, words("ulog", path))
    path = tmp_path / "a.bin"
    for name, reason in (("XKF1", "the position was not logged"), ("XKQ", "the attitude was not logged")):
        messages = dataflash_messages(FLOWN)
        del messages[name]
        write_dataflash(path, messages)
        message = refused(capsys, words("dataflash", path))
        assert f"{path}: {name}: the log has no such message" in message and reason in message


def test_wrong_samples_are_reported_with_their_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_detections(tmp_path, FLOWN, 0.0)
    path = tmp_path / "a.ulg"

    def spoilt(topic: str, field: str, row: int, value: float) -> str:
        topics = ulog_topics(FLOWN)
        columns = dict((name, values.copy()) for _, name, values in topics[topic])
        columns[field][row] = value
        topics[topic] = [(kind, name, columns[name]) for kind, name, _ in topics[topic]]
        write_ulog(path, topics)
        return refused(capsys, words("ulog", path))

    where = f"{path}: vehicle_local_position.x, y, z: "
    assert where + "not finite at 22.000000 s" in spoilt("vehicle_local_position", "y", 100, math.nan)
    back = spoilt("vehicle_local_position", "timestamp_sample", 100, 1e6)
    assert where + "time runs back from 21.980000 s to 1.000000 s" in back
    message = spoilt("vehicle_attitude", "q", 50, 0.0)
    assert f"{path}: vehicle_attitude.q: is not a unit quaternion at 21.000000 s" in message


@pytest.mark.parametrize("kind", FORMATS)
def test_files_that_are_none(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str) -> None:
    write_detections(tmp_path, FLOWN, 0.0)
    path = tmp_path / "a.log"
    assert f"{path}: No such file" in refused(capsys, words(kind, path))
    for content in (b"", b"no log\n" * 100, bytes(range(256)) * 20):
        path.write_bytes(content)
        assert f"goe_tools convert: {path}: " in refused(capsys, words(kind, path))
    assert f"goe_tools convert: {tmp_path}: " in refused(
        capsys, [*words(kind, path)[:2], str(tmp_path), *words(kind, path)[3:]]
    )
    path.unlink()
    path.symlink_to("/dev/zero")
    assert f"goe_tools convert: {path}: is not a file" in refused(capsys, words(kind, path))
    path.unlink()
    with path.open("wb") as file:
        file.truncate(2**31 + 1)
    assert f"goe_tools convert: {path}: longer than 2147483648 bytes" in refused(capsys, words(kind, path))


def test_an_input_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Here the input is camera.ini of the output folder."""
    path = autopilot_log(tmp_path, "ulog", FLOWN)
    write_detections(tmp_path, FLOWN, 0.0)
    (tmp_path / "log").mkdir()
    (tmp_path / "camera.ini").rename(tmp_path / "log" / "camera.ini")
    (tmp_path / "camera.ini").symlink_to(tmp_path / "log" / "camera.ini")
    assert main(words("ulog", path, "--offset", "0")) == 2
    assert f"the output would replace the input {tmp_path / 'camera.ini'}" in capsys.readouterr().err
    assert [file.name for file in (tmp_path / "log").iterdir()] == ["camera.ini"]


@pytest.mark.parametrize("kind", FORMATS)
def test_a_log_that_ends_in_the_middle_of_a_message(
    convert: Callable[..., tuple[ObservationLog, str]], tmp_path: Path, kind: str
) -> None:
    """As after a loss of power: the complete messages are read."""
    path = autopilot_log(tmp_path, kind, FLOWN)
    write_detections(tmp_path, FLOWN, 0.0)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) * 2 // 3])
    assert main(words(kind, path, "--offset", "0")) == 0
    assert 20 < len(read_log(tmp_path / "log").frames) < 110


def test_detections_that_are_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = autopilot_log(tmp_path, "ulog", FLOWN)
    table, _ = write_detections(tmp_path, FLOWN, 0.0)
    header, first, *rest = table.read_text().splitlines()
    late = first.replace(first.split(",")[0], "19.5")
    cases = {
        f"{header.replace('t_s', 'time')}\n{first}": ":1: t_s: column is missing",
        "t_s,id\n1,2": ":1: box_left_px: column is missing, and so are all others",
        f"{header}\n{first}\n{first}": ":3: t_s: 21 s does not come after 21 s, of the same id 4",
        f"{header}\n{first}\n{late}": ":3: t_s: 19.5 s does not come after 21 s",
        f"{header}\n{first.replace(first.split(',')[0], 'nan')}": ":2: t_s: 'nan' is not finite",
        f"{header}\n{first.replace(',4,', ',4.5,')}": ":2: id: '4.5' is not an integer",
        header: ": there are no rows",
        "": ": empty: no header line",
    }
    for text, reason in cases.items():
        table.write_text(text + "\n")
        assert f"{table}{reason}" in refused(capsys, words("ulog", path, "--offset", "0")), text
    table.write_text("\n".join([header, first, *rest]) + "\n")
    assert "no row has a pose" in refused(capsys, words("ulog", path, "--offset", "1000"))


def test_a_misspelt_column_of_a_detector_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = autopilot_log(tmp_path, "ulog", FLOWN)
    table, _ = write_detections(tmp_path, FLOWN, 0.0)
    header, *rows = table.read_text().splitlines()
    lines = [f"{header},left_uu,left_vv,score", *(f"{row},500,400,0.9" for row in rows)]
    table.write_text("\n".join(lines) + "\n")
    assert main(words("ulog", path, "--offset", "0")) == 0
    reported = capsys.readouterr().err
    assert f"{table}:1: left_uu: unknown column, ignored; did you mean left_u?" in reported
    assert "score" not in reported


@pytest.mark.parametrize("flag", [("--offset", "soon"), ("--gap", "0"), ("--within", "nan"), ("--height", "radar")])
def test_flags_that_are_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str], flag: tuple[str, str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(words("ulog", tmp_path / "a.ulg", *flag))
    assert stop.value.code == 2 and flag[0] in capsys.readouterr().err


def test_exactly_one_source_is_required(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "a.ulg"
    for arguments in (
        words("ulog", log, "--tlog", str(log)),
        [w for w in words("ulog", log) if w not in ("--ulog", str(log))],
    ):
        with pytest.raises(SystemExit) as stop:
            main(arguments)
        assert stop.value.code == 2 and "--tlog" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = autopilot_log(tmp_path, "ulog", FLOWN)
    write_detections(tmp_path, FLOWN, 0.0)
    (tmp_path / "log").write_text("")
    assert main(words("ulog", path, "--offset", "0")) == 2
    assert f"{tmp_path / 'log'}: " in capsys.readouterr().err


def test_systems_of_a_tlog(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = autopilot_log(tmp_path, "tlog", FLOWN)
    write_detections(tmp_path, FLOWN, 0.0)
    assert main(words("tlog", path, "--offset", "0", "--system", "1")) == 0
    assert "system 1, component 1" in capsys.readouterr().out
    assert main(words("tlog", path, "--system", "7")) == 2
    assert f"{path}: HEARTBEAT: the log has none of system 7 from an autopilot" in capsys.readouterr().err
