"""Observation logs: valid and refused input, and exact writing."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from goe_tools.logs.obslog import (
    Camera,
    LogError,
    ObservationLog,
    read_camera,
    read_cameras,
    read_frames,
    read_log,
    read_truth,
    write_log,
)
from goe_tools.logs.progress import Progress

CAMERA = "camera.width = 640\ncamera.height=480 # px\n\n# a comment\ncamera.fx = 500\ncamera.fy = 501\n" + (
    "camera.cx = 320\ncamera.cy = 240\n"
)
HEADER = "t_s,id,n_m,e_m,d_m,qw,qx,qy,qz"
ROW = "0.5,3,1,2,-30,1,0,0,0"
SIZE = ",kind_width_m,kind_width_sd_m"


def write(path: Path, text: str) -> Path:
    path.write_bytes(text.encode())
    return path


def frames(tmp_path: Path, *lines: str, end: str = "\n"):
    return read_frames(write(tmp_path / "frames.csv", end.join(lines) + end))


def test_round_trip_is_exact(tmp_path: Path, corner_log: ObservationLog) -> None:
    write_log(tmp_path / "log", corner_log, "a comment\nof two lines")
    again = read_log(tmp_path / "log")
    assert again.camera == corner_log.camera
    assert again.frames == corner_log.frames
    assert again.truth == corner_log.truth


def test_camera_defaults_and_comments(tmp_path: Path) -> None:
    camera = read_camera(write(tmp_path / "camera.ini", CAMERA))
    assert camera == Camera(640.0, 480.0, 500.0, 501.0, 320.0, 240.0)
    assert camera.heading_deg is None
    text = CAMERA + "trajectory.heading_deg = -12.5\ncamera.mount_yaw_deg = -35\n"
    camera = read_camera(write(tmp_path / "camera.ini", text))
    assert (camera.heading_deg, camera.mount_yaw_deg) == (-12.5, -35.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (CAMERA + "camera.f = 3\n", "camera.ini:9: camera.f: unknown key"),
        (CAMERA + "camera.heading_deg = 3\n", "camera.ini:9: camera.heading_deg: unknown key"),
        (CAMERA + "fx = 3\n", "camera.ini:9: fx: unknown key"),
        (CAMERA + "camera.k1 = wide\n", "camera.ini:9: camera.k1: 'wide' is not a number"),
        (CAMERA + "camera.k1 = 1_0\n", "camera.ini:9: camera.k1: '1_0' is not a number"),
        (CAMERA + "camera.k1 = nan\n", "camera.ini:9: camera.k1: 'nan' is not finite"),
        (CAMERA + "camera.fx = 400\n", "camera.ini:9: camera.fx: given twice"),
        (CAMERA + "camera.k1\n", "camera.ini:9: 'camera.k1' is not of the form key = value"),
        (CAMERA.replace("fx = 500", "fx = 0"), "camera.ini:5: camera.fx: '0' is out of range: 1 to 100000"),
        (CAMERA.replace("camera.fy = 501\n", ""), "camera.ini: camera.fy: missing"),
        ("", "camera.ini: camera.width: missing"),
    ],
)
def test_bad_camera(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(LogError) as error:
        read_camera(write(tmp_path / "camera.ini", text))
    assert str(error.value) == f"{tmp_path}/{message}"


SECOND = CAMERA.replace("camera.", "camera2.")  # lines 9 to 16 after the first


def test_two_cameras(tmp_path: Path) -> None:
    text = "camera2.k1 = 0.25\n" + CAMERA + SECOND + "trajectory.heading_deg = 30\n"
    first, second = read_cameras(write(tmp_path / "camera.ini", text))
    assert first == Camera(640.0, 480.0, 500.0, 501.0, 320.0, 240.0, heading_deg=30.0)
    assert second == replace(first, k1=0.25)
    assert read_cameras(write(tmp_path / "camera.ini", CAMERA)) == [replace(first, heading_deg=None)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (CAMERA + "camera2.mount_yaw_deg = 3\n", "camera.ini: camera2.width: missing"),
        (SECOND, "camera.ini: camera.width: missing"),
        (CAMERA + SECOND.replace("camera2.cy = 240\n", ""), "camera.ini: camera2.cy: missing"),
        (CAMERA + SECOND + "camera2.fx = 3\n", "camera.ini:17: camera2.fx: given twice"),
        (CAMERA + SECOND + "camera2.f = 3\n", "camera.ini:17: camera2.f: unknown key"),
        (CAMERA + SECOND + "camera2.heading_deg = 3\n", "camera.ini:17: camera2.heading_deg: unknown key"),
        (CAMERA + SECOND + "camera3.k1 = 3\n", "camera.ini:17: camera3.k1: unknown key"),
        (CAMERA + SECOND + "camera2.k1 = wide\n", "camera.ini:17: camera2.k1: 'wide' is not a number"),
    ],
)
def test_bad_second_camera(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(LogError) as error:
        read_cameras(write(tmp_path / "camera.ini", text))
    assert str(error.value) == f"{tmp_path}/{message}"


def test_a_second_camera_where_one_alone_is_read(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"camera\.ini: camera2: a second camera"):
        read_camera(write(tmp_path / "camera.ini", CAMERA + SECOND))


def test_the_number_of_the_camera(tmp_path: Path) -> None:
    text = "\n".join((HEADER + ",camera", ROW + ",1", ROW + ",0", ROW + ",", ""))
    path = write(tmp_path / "frames.csv", text)
    assert [frame.camera for frame in read_frames(path)] == [1, 0, 0]
    write(tmp_path / "camera.ini", CAMERA)
    with pytest.raises(LogError) as error:
        read_log(tmp_path)
    assert str(error.value) == f"{path}:2: camera: there is no camera 1"
    write(tmp_path / "camera.ini", CAMERA + SECOND)
    log = read_log(tmp_path)
    assert log.camera2 == log.camera and [frame.camera for frame in log.frames] == [1, 0, 0]


def test_two_cameras_are_written(tmp_path: Path, corner_log: ObservationLog) -> None:
    frames = [replace(frame, camera=k % 2, reset_count=k % 3) for k, frame in enumerate(corner_log.frames)]
    second = replace(corner_log.camera, k1=-0.1, mount_yaw_deg=40.0)
    write_log(tmp_path, ObservationLog(corner_log.camera, frames, corner_log.truth, second))
    assert read_log(tmp_path) == ObservationLog(corner_log.camera, frames, corner_log.truth, second)


def test_columns_in_any_order_and_unknown_ones(tmp_path: Path) -> None:
    (frame,) = frames(tmp_path, "score,id,t_s,e_m,n_m,d_m,qz,qy,qx,qw", "0.9,7,1.5,2,1,-3,0.4,0.3,0.2,0.1")
    assert frame.id == 7
    assert frame.position_m == (1.0, 2.0, -3.0)
    assert frame.attitude == (0.1, 0.2, 0.3, 0.4)
    assert frame.height_m == 3.0  # without an altimeter: -down
    assert frame.left is None


def test_empty_fields_are_not_measured(tmp_path: Path) -> None:
    header = HEADER + ",agl_m,left_u,left_v,top_u,top_v"
    full, half, pose = frames(
        tmp_path, header, ROW + ",31.5,10,20,30,40", ROW + ",,10,,30,40", "1,3,,2,-30,1,0,0,0,,,,,"
    )
    assert (full.height_m, full.left, full.top) == (31.5, (10.0, 20.0), (30.0, 40.0))
    assert (half.height_m, half.left, half.top) == (30.0, None, (30.0, 40.0))
    assert math.isnan(pose.position_m[0])  # a bad measurement, but valid input


def test_boxes_and_resets(tmp_path: Path) -> None:
    header = HEADER + ",reset_d_m,reset_count,box_bottom_px,box_left_px,box_right_px,box_top_px,reset_n_m,reset_e_m"
    whole, cut, none = frames(
        tmp_path, header, ROW + ",0.5,258,40,10,30,20,3,-2", ROW + ",0.5,,,10.5,,,3,", ROW + ",,,,,,,,"
    )
    assert (whole.box_px, whole.reset_count, whole.reset_delta_m) == ((10.0, 20.0, 30.0, 40.0), 258, (3.0, -2.0, 0.5))
    assert (cut.box_px, cut.reset_count, cut.reset_delta_m) == ((10.5, None, None, None), 0, None)
    assert (none.box_px, none.reset_count, none.reset_delta_m) == (None, 0, None)
    assert frames(tmp_path, HEADER, ROW) == [none]


def test_boxes_and_resets_are_written_where_there_are_any(tmp_path: Path, corner_log: ObservationLog) -> None:
    plain, first = corner_log.frames, corner_log.frames[0]
    boxes = [replace(first, box_px=(1.5, 2.5, 3.5, None)), *plain[1:]]
    resets = [replace(frame, reset_count=7, reset_delta_m=(0.1, -0.2, 0.3)) for frame in plain[1:]]
    for given in (plain, boxes, [first, *resets], boxes[:1] + resets, [first, replace(plain[1], reset_count=2)]):
        write_log(tmp_path, replace(corner_log, frames=given))
        assert read_frames(tmp_path / "frames.csv") == given
        header = (tmp_path / "frames.csv").read_text().splitlines()[0]
        assert ("box" in header) == (given[0].box_px is not None)
        assert ("reset" in header) == (given[1].reset_count != 0)


def test_kinds(tmp_path: Path, corner_log: ObservationLog) -> None:
    """The class's sizes and shape: read by both parsers, and written where there are any."""
    columns = ",kind_width_m,kind_width_sd_m,kind_height_m,kind_height_sd_m,kind_shape"
    rows = (
        ROW + ",3.3,0.87,1.6,0.14,2",
        ROW + ",,,30,3,",
        ROW + ",,,,,",
        ROW + ",0,1,0,0,1",
        ROW.replace("-30", "nan"),
    )
    read = frames(tmp_path, HEADER + columns, *rows[:4], rows[4] + ",3.3,0.87,,,")
    assert [frame.kind for frame in read] == [
        (3.3, 0.87, 1.6, 0.14, 2), (0.0, 0.0, 30.0, 3.0, 0), None, (0.0, 1.0, 0.0, 0.0, 1), (3.3, 0.87, 0.0, 0.0, 0),
    ]  # fmt: skip
    plain = corner_log.frames
    for given in (plain, [replace(plain[0], kind=(3.3, 0.87, 0.0, 0.0, 2)), *plain[1:]]):
        write_log(tmp_path, replace(corner_log, frames=given))
        assert read_frames(tmp_path / "frames.csv") == given
        header = (tmp_path / "frames.csv").read_text().splitlines()[0]
        assert ("kind" in header) == (given[0].kind is not None)


def test_line_ends_and_blank_lines(tmp_path: Path) -> None:
    assert len(frames(tmp_path, HEADER, ROW, "", ROW, end="\r\n")) == 2
    assert len(read_frames(write(tmp_path / "frames.csv", "\ufeff" + HEADER + "\n" + ROW + "\n"))) == 1
    assert frames(tmp_path, HEADER) == []


def test_numbers_that_are_no_measurement(tmp_path: Path) -> None:
    (frame,) = frames(tmp_path, HEADER, "nan,3,inf,2,-30,1,0,0,0")
    assert frame.time_us is None
    assert math.isinf(frame.position_m[0])


@pytest.mark.parametrize(
    ("t_s", "time_us"), [("0.1", 100000), ("2.5e-6", 2), ("3.5e-6", 4), ("1e30", None), ("-1", -1000000)]
)
def test_time_stamps(tmp_path: Path, t_s: str, time_us: int) -> None:
    (frame,) = frames(tmp_path, HEADER, t_s + ROW[3:])
    assert frame.time_us == time_us


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ((HEADER.replace(",qy", ""), ROW), "1: qy: column is missing"),
        ((HEADER + ",left_u", ROW + ",3"), "1: left_v: column is missing"),
        ((HEADER + ",reset_n_m", ROW + ",3"), "1: reset_count: column is missing, but reset_n_m is present"),
        ((HEADER + ",kind_width_m", ROW + ",3"), "1: kind_width_sd_m: column is missing"),
        ((HEADER + ",kind_height_sd_m", ROW + ",3"), "1: kind_height_m: column is missing"),
        ((HEADER + ",kind_shape", ROW + ",3"), "2: kind_shape: 3 is no shape: 0 unknown, 1 round, 2 not round"),
        ((HEADER + ",kind_shape", ROW + ",1.0"), "2: kind_shape: '1.0' is not an integer"),
        ((HEADER + SIZE, ROW + ",1001,20"), "2: kind_width_m: 1001 is out of range: 0 to 1000"),
        ((HEADER + SIZE, ROW + ",3,nan"), "2: kind_width_sd_m: nan is out of range: 0 to 1000"),
        ((HEADER + SIZE, ROW + ",3,"), "2: kind_width_sd_m: 0 is less than 1 % of kind_width_m"),
        ((HEADER + SIZE, ROW + ",3,-1"), "2: kind_width_sd_m: -1 is out of range: 0 to 1000"),
        ((HEADER + ",box_top_px,box_top_px", ROW + ",3,3"), "1: box_top_px: column is given twice"),
        ((HEADER + ",box_top_px", ROW + ",high"), "2: box_top_px: 'high' is not a number"),
        ((HEADER + ",reset_count", ROW + ",1.0"), "2: reset_count: '1.0' is not an integer"),
        ((HEADER + ",camera", ROW + ",2"), "2: camera: there is no camera 2"),
        ((HEADER + ",camera", ROW + ",-1"), "2: camera: there is no camera -1"),
        ((HEADER + ",camera", ROW + ",left"), "2: camera: 'left' is not an integer"),
        ((HEADER + ",camera,camera", ROW + ",0,0"), "1: camera: column is given twice"),
        ((HEADER + ",d_m", ROW + ",3"), "1: d_m: column is given twice"),
        ((HEADER, ROW, ROW + ",4"), "3: qz: 10 fields under 9 columns"),
        ((HEADER, ROW, "1,2"), "3: n_m: 2 fields under 9 columns"),
        ((HEADER, ROW.replace("-30", "low")), "2: d_m: 'low' is not a number"),
        ((HEADER, ROW.replace(",3,", ",3.5,")), "2: id: '3.5' is not an integer"),
        ((HEADER, ROW.replace("0.5,", ",")), "2: t_s: '' is not a number"),
        ((HEADER, "", ROW, ROW.replace("-30", "0x1f")), "4: d_m: '0x1f' is not a number"),
    ],
)
def test_bad_frames(tmp_path: Path, lines: tuple[str, ...], message: str) -> None:
    with pytest.raises(LogError) as error:
        frames(tmp_path, *lines)
    assert str(error.value) == f"{tmp_path}/frames.csv:{message}"


def test_missing_and_empty_files(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no such folder"):
        read_log(tmp_path / "none")
    with pytest.raises(LogError, match=r"camera\.ini: No such file"):
        read_log(tmp_path)
    with pytest.raises(LogError, match="empty: no header line"):
        read_frames(write(tmp_path / "frames.csv", ""))
    with pytest.raises(LogError, match="not UTF-8"):
        (tmp_path / "frames.csv").write_bytes(b"\xff\xfe\x00")
        read_frames(tmp_path / "frames.csv")


def test_truth(tmp_path: Path) -> None:
    header = "id,static,center_n_m,center_e_m,ground_d_m,width_m,length_m,height_m,heading_deg,frames"
    path = write(tmp_path / "truth.csv", header + "\n4,1,1,2,3,4,5,6,7,13\n5,0,1,2,3,4,,6,,9\n")
    truth = read_truth(path)
    assert truth[4].static
    assert truth[4].heading_deg == 7.0
    assert truth[4].extra == {"frames": "13"}
    assert (truth[5].length_m, truth[5].heading_deg) == (None, None)
    with pytest.raises(LogError, match=r"truth\.csv:3: id: 4 is given twice"):
        read_truth(write(path, header + "\n" + "4,1,1,2,3,4,5,6,7,13\n" * 2))


def test_progress_is_for_terminals_and_for_long_tasks(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = [0.0]
    monkeypatch.setattr("goe_tools.logs.progress.time.monotonic", lambda: clock[0])
    for terminal in (False, True):
        monkeypatch.setattr("sys.stderr.isatty", lambda now=terminal: now)
        clock[0] = 0.0
        progress = Progress("frames.csv", 200)
        for clock[0], done in ((1.9, 50), (2.1, 100), (2.2, 110), (2.4, 150)):
            progress.show(done, f", {done} rows")
        progress.end()
        shown = [part for part in capsys.readouterr().err.split("\r\x1b[K") if part]
        assert shown == (["frames.csv: 50%, 100 rows", "frames.csv: 75%, 150 rows"] if terminal else [])
