"""Logs and command line of goe_sim: sensor statistics, determinism, recorded flights, errors without data loss."""

from __future__ import annotations

import contextlib
import csv
import os
import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp
from sim_support import FEATURES, HANG_S, Camera, Log, fly, poses, read_log, run

FILES = ("camera.ini", "frames.csv", "truth.csv", "truth_frames.csv")
TRUCK = ("--obstacle", "truck", "--altitude", "5")
# a flight far from the obstacle in which all six features stay in the frame, with many frames
LONG = ("--obstacle", "building", "--alpha", "20", "--x0", "-150", "--reach", "80", "--run", "40", "--fps", "50")


def folder_bytes(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def errors(log: Log, name: str) -> np.ndarray:
    return log.pixels(name, exact=False) - log.pixels(name)


def test_defaults_are_the_paper_s_camera_and_rounded_pixels(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(goe_sim, tmp_path / "log", *TRUCK, "--course", "12.5")
    ini = log.camera
    assert (ini["camera.fx"], ini["camera.fy"], ini["camera.cx"], ini["camera.cy"]) == (914, 914, 640, 640)
    assert (ini["camera.width"], ini["camera.height"], ini["camera.mount_yaw_deg"]) == (1280, 1280, -30)
    assert 2 * np.degrees(np.arctan(640 / 914)) == pytest.approx(70, abs=0.01)
    assert ini["trajectory.heading_deg"] == pytest.approx(12.5, abs=1e-12)
    assert log.frames["t_s"] == pytest.approx(np.arange(145) / 8, abs=0)
    for name in FEATURES:
        visible = log.pixels(name, exact=False)
        assert np.array_equal(visible, np.floor(log.pixels(name) + 0.5), equal_nan=True)
    assert np.array_equal(log.frames["n_m"], log.exact["n_m"]) and np.array_equal(log.frames["qw"], log.exact["qw"])
    assert {key: log.truth[key] for key in ("width_m", "length_m", "height_m", "static")} == {
        "width_m": 2.5,
        "length_m": 7,
        "height_m": 2.5,
        "static": 1,
    }


def test_height_above_ground_is_the_camera_s(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(
        goe_sim, tmp_path / "log", *TRUCK, "--noise", "none", "--offset-x", "2", "--offset-z", "-1", "--glide", "6"
    )
    eye = Camera(log.camera).eye(*poses(log.exact))
    assert log.frames["agl_m"] == pytest.approx(-eye[:, 2], abs=1e-12)


def test_every_number_reads_back_as_it_was(goe_sim: Path, tmp_path: Path) -> None:
    """Noise-free frames and exact frames are printed from the same doubles; quaternions keep their norm up to
    rounding."""
    log = fly(goe_sim, tmp_path / "log", *TRUCK, "--noise", "none", "--wind", "dryden:light")
    norm = np.sqrt(sum(log.frames[key] ** 2 for key in ("qw", "qx", "qy", "qz")))
    assert norm == pytest.approx(np.ones(len(norm)), abs=4e-16)
    for name in FEATURES:
        assert np.array_equal(log.pixels(name), log.pixels(name, exact=False), equal_nan=True)


def test_white_pixel_noise(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(goe_sim, tmp_path / "log", *LONG, "--noise", "pixel:0.8")
    all_errors = np.concatenate([errors(log, name).ravel() for name in FEATURES])
    all_errors = all_errors[np.isfinite(all_errors)]
    assert len(all_errors) > 20_000
    assert all_errors.std() == pytest.approx(0.8, rel=0.03) and abs(all_errors.mean()) < 0.02
    one = errors(log, "left")[:, 0]
    assert abs(np.corrcoef(one[:-1], one[1:])[0, 1]) < 0.08


def test_detector_noise(goe_sim: Path, tmp_path: Path) -> None:
    """Variance (0.7 px)^2 + (0.025 width)^2, correlation 0.5 from frame to frame."""
    log = fly(goe_sim, tmp_path / "log", *LONG, "--noise", "detector")
    width = log.exact["right_u"] - log.exact["left_u"]
    sigma = np.hypot(0.7, 0.025 * width)
    assert width.max() > 1.5 * width.min()
    pooled, lagged = [], []
    for name in FEATURES:
        scaled = errors(log, name) / sigma[:, None]
        scaled = scaled[np.isfinite(scaled).all(axis=1)]
        pooled.append(scaled.ravel())
        lagged.append((scaled[1:] * scaled[:-1]).mean())
    assert np.concatenate(pooled).std() == pytest.approx(1.0, rel=0.04)
    assert np.mean(lagged) == pytest.approx(0.5, abs=0.05)


def test_outliers(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(goe_sim, tmp_path / "log", *LONG, "--noise", "none", "--outlier-rate", "0.02", "--outlier-size", "15")
    length = np.concatenate([np.hypot(*errors(log, name).T) for name in FEATURES])
    length = length[np.isfinite(length)]
    moved = length > 1e-9
    assert moved.mean() == pytest.approx(0.02, abs=0.004)
    assert length[moved] == pytest.approx(np.full(moved.sum(), 15.0), abs=1e-9)


def test_attitude_position_and_altimeter_errors(goe_sim: Path, tmp_path: Path) -> None:
    """Over 200 seeds: the sigma of each constant, white and random walk error."""
    options = (*TRUCK, "--noise", "none", "--run", "18", "--fps", "4")
    bias, white, position, agl = [], [], [], []
    quantities = (
        "--attitude-bias",
        "0.5",
        "--attitude-noise",
        "0.1",
        "--position-walk",
        "0.2",
        "--velocity-bias",
        "0.05",
        "--altimeter-bias",
        "0.5",
    )
    for seed in range(200):
        log = fly(goe_sim, tmp_path / "log", *options, *quantities, "--seed", seed)
        (true_position, true_attitude), (logged_position, logged_attitude) = poses(log.exact), poses(log.frames)
        turn = np.degrees((true_attitude.inv() * logged_attitude).as_rotvec())
        bias.append(turn.mean(axis=0))
        white.append(turn - turn.mean(axis=0))
        position.append(logged_position - true_position)
        agl.append(log.frames["agl_m"] - log.exact["agl_m"])
    assert np.std(bias, axis=0) == pytest.approx([0.5, 0.5, 0.5], rel=0.15)
    assert np.concatenate(white).std(axis=0) == pytest.approx([0.1, 0.1, 0.1], rel=0.03)
    moved = np.array(position)
    assert not moved[:, 0].any()
    for k in (24, 48, 72):
        t = k / 4
        assert moved[:, k].std(axis=0) == pytest.approx(np.full(3, np.sqrt(0.2**2 * t + (0.05 * t) ** 2)), rel=0.2)
    assert np.ptp(np.array(agl), axis=1).max() < 1e-12
    assert np.std(np.array(agl)[:, 0]) == pytest.approx(0.5, rel=0.15)


def test_attitude_bias_is_fixed_to_the_body(goe_sim: Path, tmp_path: Path) -> None:
    """On an arc the misalignment stays constant in the aircraft's axes, which turn over the ground."""
    options = ("--path", "arc:300", "--altitude", "20", "--noise", "none", "--attitude-bias", "2")
    log = fly(goe_sim, tmp_path / "log", "--obstacle", "truck", *options)
    (_, true_attitude), (_, logged_attitude) = poses(log.exact), poses(log.frames)
    in_body = (true_attitude.inv() * logged_attitude).as_rotvec()
    in_ned = (logged_attitude * true_attitude.inv()).as_rotvec()
    assert np.ptp(in_body, axis=0).max() < 1e-12 and np.ptp(in_ned, axis=0).max() > 0.01


def test_field_is_the_sum_of_its_figures(goe_sim: Path, tmp_path: Path) -> None:
    field = fly(goe_sim, tmp_path / "field", *TRUCK, "--noise", "field", "--seed", "3")
    rotated = fly(
        goe_sim,
        tmp_path / "rotated",
        *TRUCK,
        "--noise",
        "none",
        "--seed",
        "3",
        "--pixel-noise",
        "0.5",
        "--outlier-rate",
        "0.02",
        "--outlier-size",
        "15",
        "--attitude-bias",
        "0.5",
        "--attitude-noise",
        "0.1",
        "--position-walk",
        "0.05",
        "--velocity-bias",
        "0.05",
        "--altimeter-bias",
        "0.5",
    )
    for name in field.frames:
        assert np.array_equal(field.frames[name], rotated.frames[name], equal_nan=True)


def test_one_source_of_noise_does_not_disturb_another(goe_sim: Path, tmp_path: Path) -> None:
    """The attitude errors of a seed stay the same with pixel noise, lost frames and turbulence."""
    calm = fly(goe_sim, tmp_path / "a", *TRUCK, "--noise", "none", "--attitude-bias", "0.5")
    rough = fly(
        goe_sim,
        tmp_path / "b",
        *TRUCK,
        "--noise",
        "pixel:2",
        "--attitude-bias",
        "0.5",
        "--outlier-rate",
        "0.3",
        "--drop-rate",
        "0.2",
        "--wind",
        "dryden:light",
        "--altitude",
        "30",
    )
    turns = [(poses(log.exact)[1].inv() * poses(log.frames)[1]).as_rotvec() for log in (calm, rough)]
    assert len(turns[1]) < len(turns[0])
    assert turns[1].mean(axis=0) == pytest.approx(turns[0].mean(axis=0), abs=1e-12)


def test_lost_frames_and_jitter(goe_sim: Path, tmp_path: Path) -> None:
    whole = fly(goe_sim, tmp_path / "whole", *LONG, "--noise", "none")
    lost = fly(goe_sim, tmp_path / "lost", *LONG, "--noise", "none", "--drop-rate", "0.25")
    share = len(lost.frames["t_s"]) / len(whole.frames["t_s"])
    assert share == pytest.approx(0.75, abs=0.04)
    assert set(lost.frames["t_s"]) < set(whole.frames["t_s"])
    shaken = fly(goe_sim, tmp_path / "shaken", *LONG, "--noise", "none", "--time-jitter", "0.004")
    shift = shaken.frames["t_s"] - whole.frames["t_s"]
    assert np.abs(shift).max() <= 0.004 + 1e-9 and shift.std() == pytest.approx(0.004 / np.sqrt(3), rel=0.05)
    # the pose is that of the displaced exposure
    assert shaken.frames["n_m"] == pytest.approx(17.0 * shaken.frames["t_s"], abs=1e-6)
    wild = fly(goe_sim, tmp_path / "wild", *LONG, "--noise", "none", "--time-jitter", "5")
    assert (np.diff(wild.frames["t_s"]) > 0).all()


def test_the_flight_does_not_depend_on_the_camera_s_rate(goe_sim: Path, tmp_path: Path) -> None:
    options = (*TRUCK, "--altitude", "30", "--wind", "dryden:moderate", "--seed", "9")
    slow, fast = (fly(goe_sim, tmp_path / fps, *options, "--fps", fps) for fps in ("8", "80"))
    assert np.array_equal(slow.exact["e_m"], fast.exact["e_m"][::10])


def test_a_seed_repeats_and_another_differs(goe_sim: Path, tmp_path: Path) -> None:
    options = (
        "--obstacle",
        "building",
        "--noise",
        "field",
        "--wind",
        "dryden:light",
        "--drop-rate",
        "0.1",
        "--detector-px",
        "1",
        "--time-jitter",
        "0.01",
    )
    first, again, other = (tmp_path / name for name in ("first", "again", "other"))
    for folder, seed in ((first, 7), (again, 7), (other, 8)):
        run(goe_sim, *options, "--seed", seed, "--out", folder)
    assert folder_bytes(first) == folder_bytes(again)
    assert folder_bytes(first)["frames.csv"] != folder_bytes(other)["frames.csv"]


def test_the_truth_counts_from_the_first_image_that_shows_a_feature(goe_sim: Path, tmp_path: Path) -> None:
    """A camera that looks aside: the obstacle comes into view late, and T's origin is there."""
    log = fly(goe_sim, tmp_path / "log", "--obstacle", "disc:6,30", "--x0", -40, "--z0", 200, "--run", 10,
              "--yaw-camera", -60, "--course", 70)  # fmt: skip
    shown = np.isfinite([log.pixels(name, exact=False)[:, 0] for name in FEATURES]).any(0)
    begin = int(np.argmax(shown))
    assert begin > 10
    way = [log.truth[f"center_{axis}"] - log.exact[axis][begin] for axis in ("n_m", "e_m")]
    c, s = np.cos(np.radians(70.0)), np.sin(np.radians(70.0))
    assert log.truth["z0_m"] == pytest.approx(c * way[0] + s * way[1], abs=1e-6)
    assert log.truth["x0_m"] == pytest.approx(c * way[1] - s * way[0], abs=1e-6)


def test_paper_s_cases(goe_sim: Path, tmp_path: Path) -> None:
    """156 cases, the product of Table 2; each flight begins with its obstacle in view or has x0 = 0."""
    lines = run(goe_sim, "--list-cases").stdout.splitlines()
    names = [line.split()[1] for line in lines[1:]]
    assert {name: names.count(name) for name in set(names)} == {
        "cylinder": 6,
        "building": 30,
        "truck": 60,
        "long-truck": 60,
    }
    assert len({tuple(line.split()[1:]) for line in lines[1:]}) == 156
    for number in (1, 35, 90, 155):
        log = fly(goe_sim, tmp_path / "log", "--case", number)
        x0, altitude, alpha, glide, end, reach = lines[1 + number].split()[2:]
        assert log.truth["x0_m"] == pytest.approx(float(x0), abs=1e-9)
        assert log.truth["z0_m"] == pytest.approx(17 * float(reach), abs=1e-9)
        angle = np.nan if names[number] == "cylinder" else float(alpha)
        assert log.truth["orientation_deg"] == pytest.approx(angle, abs=1e-9, nan_ok=True)
        assert log.frames["t_s"][-1] == float(end)
        assert log.exact["agl_m"][-1] == pytest.approx(
            float(altitude) + 17 * (float(reach) - float(end)) * np.tan(np.radians(float(glide))), abs=1e-3
        )


RECORDED_COLUMNS = ["t_s"] + [
    f"{kind}_{axis}" for kind in ("est", "true") for axis in ("n_m", "e_m", "d_m", "qw", "qx", "qy", "qz")
]


def write_recording(path: Path, swap: bool = False) -> tuple[Rotation, np.ndarray]:
    """A level turn, 20 s at 10 Hz, from t = 3 s. The estimate is 1 m too far north and 2 degrees off in yaw, and its
    quaternion changes sign in every other row."""
    t = np.arange(0, 20.05, 0.1)
    heading = 0.3 + 0.02 * t
    position = np.column_stack(
        [np.cumsum(np.cos(heading)) * 1.5, np.cumsum(np.sin(heading)) * 1.5, np.full(len(t), -25.0)]
    )
    truth = Rotation.from_euler("ZYX", np.column_stack([heading, np.full(len(t), 0.03), np.full(len(t), 0.1)]))
    estimate = truth * Rotation.from_euler("Z", 2, degrees=True)

    def wxyz(rotation: Rotation, flip: bool) -> np.ndarray:
        q = rotation.as_quat()[:, [3, 0, 1, 2]]
        return q * np.where(np.arange(len(q)) % 2 == 1, -1, 1)[:, None] if flip else q

    rotated = position + np.array([1.0, 0.0, 0.0])
    columns = RECORDED_COLUMNS
    table = np.column_stack([t + 3, rotated, wxyz(estimate, True), position, wxyz(truth, False)])
    if swap:
        order = np.random.default_rng(1).permutation(len(columns))
        columns, table = [columns[i] for i in order], table[:, order]
    lines = [",".join(columns)] + [",".join(f"{value:.12g}" for value in row) for row in table]
    path.write_text("\n".join(lines) + "\n")
    return truth, position


@pytest.mark.parametrize("swap", [False, True])
def test_recorded_flight(goe_sim: Path, tmp_path: Path, swap: bool) -> None:
    truth, position = write_recording(tmp_path / "flight.csv", swap)
    log = fly(
        goe_sim,
        tmp_path / "log",
        "--flight",
        tmp_path / "flight.csv",
        "--flight-start",
        "2",
        "--run",
        "10",
        "--reach",
        "15",
        "--obstacle",
        "truck",
        "--x0",
        "-12",
        "--noise",
        "none",
        "--fps",
        "10",
        "--yaw-camera",
        "0",
    )
    true_position, true_attitude = poses(log.exact)
    logged_position, logged_attitude = poses(log.frames)
    assert len(true_position) == 101
    assert true_position == pytest.approx(position[20:121], abs=1e-9)
    assert (true_attitude.inv() * truth[20:121]).magnitude() == pytest.approx(np.zeros(101), abs=1e-9)
    assert logged_position - true_position == pytest.approx(np.tile([1.0, 0, 0], (101, 1)), abs=1e-9)
    assert np.degrees((true_attitude.inv() * logged_attitude).as_rotvec()) == pytest.approx(
        np.tile([0, 0, 2.0], (101, 1)), abs=1e-6
    )
    way = position[170, :2] - position[20, :2]
    assert log.truth["z0_m"] == pytest.approx(np.hypot(*way), abs=1e-9) and log.truth["x0_m"] == pytest.approx(
        -12, abs=1e-9
    )
    assert log.camera["trajectory.heading_deg"] == pytest.approx(np.degrees(np.arctan2(way[1], way[0])), abs=1e-9)
    # the camera's image is from the true pose
    camera = Camera(log.camera)
    center = np.array([[log.truth["center_n_m"], log.truth["center_e_m"], 0.0]])
    pixel, _ = camera.project(true_position[0], true_attitude[0], center)
    assert log.pixels("left")[0, 0] < pixel[0, 0] < log.pixels("right")[0, 0]


def test_between_the_rows_of_a_recording(goe_sim: Path, tmp_path: Path) -> None:
    """Position by linear interpolation, attitude by slerp, for any signs of the quaternions."""
    truth, position = write_recording(tmp_path / "flight.csv")
    options = ("--flight", tmp_path / "flight.csv", "--run", "10", "--noise", "none", "--fps", "40")
    log = fly(goe_sim, tmp_path / "log", *options)
    t, rows = log.exact["t_s"], np.arange(len(position)) / 10
    expected = Slerp(rows, truth)(t)
    rotated = expected * Rotation.from_euler("Z", 2, degrees=True)
    assert (poses(log.exact)[1].inv() * expected).magnitude().max() < 1e-9
    assert (poses(log.frames)[1].inv() * rotated).magnitude().max() < 1e-7
    for axis in range(3):
        assert poses(log.exact)[0][:, axis] == pytest.approx(np.interp(t, rows, position[:, axis]), abs=1e-9)


def test_from_inside_nothing_is_visible(goe_sim: Path, tmp_path: Path) -> None:
    """A recording that goes through the obstacle: features before it, none inside, although its far corners are
    ahead."""
    write_recording(tmp_path / "flight.csv")
    options = (
        "--flight",
        tmp_path / "flight.csv",
        "--obstacle",
        "box:12,40,26",
        "--x0",
        "0",
        "--z0",
        "60",
        "--run",
        "8",
    )
    log = fly(goe_sim, tmp_path / "log", *options, "--course", "20", "--yaw-camera", "0", "--noise", "none")
    n, e = log.exact["n_m"] - log.truth["center_n_m"], log.exact["e_m"] - log.truth["center_e_m"]
    c, s = np.cos(np.radians(20.0)), np.sin(np.radians(20.0))
    inside = (np.abs(c * n + s * e) < 20.0) & (np.abs(c * e - s * n) < 6.0)
    visible = sum((~np.isnan(log.pixels(name)[:, 0])).astype(int) for name in FEATURES)
    assert inside.sum() > 10 and (visible[inside] == 0).all() and visible[0] > 0


def test_recorded_flight_ends_with_its_recording(goe_sim: Path, tmp_path: Path) -> None:
    write_recording(tmp_path / "flight.csv")
    log = fly(
        goe_sim, tmp_path / "log", "--flight", tmp_path / "flight.csv", "--flight-start", "5", "--run", "60", expect=1
    )
    assert log.frames["t_s"][-1] == 15.0


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (lambda text: text.replace("true_qw", "qw"), ":1: true_qw: missing column"),
        (lambda text: text.replace("\n3.1,", "\n2.9,"), ":3: t_s: time does not increase"),
        (lambda text: text.replace("-25,", "x,", 1), ":2: est_d_m: 'x' is not a finite number"),
        (lambda text: text.replace("-25,", "nan,", 1), ":2: est_d_m: 'nan' is not a finite number"),
        (lambda text: text.replace("-25,", ",", 1), ":2: est_d_m: '' is not a finite number"),
        (lambda text: text.replace("-25,", "", 1), ":2: true_qz: the row ends before this column: 14 fields"),
        (lambda text: text.replace("est_n_m,", "t_s,", 1), ":1: t_s: the column appears twice"),
        (lambda text: text.replace("-25,", "-25,7,", 1), ":2: true_qz: the row goes on after this column: 16 fields"),
        (lambda text: text.replace("-25,", "-" + "0" * 70 + "x,", 1), ":2: est_d_m: '-000"),
        (lambda text: text.replace("-25,", "-25\0,", 1), ":2: est_d_m: the field holds a NUL byte"),
        (lambda text: text.replace("-25,", "-0x19,", 1), ":2: est_d_m: '-0x19' is not a finite number"),
        (lambda text: text.replace("-25,", "1e308,", 1), ":2: est_d_m: 1e+308 is out of range: -1e+06 to 1e+06"),
        (lambda text: text.replace("\n3.2,", "\n1e308,"), ":4: t_s: 1e+308 is out of range"),
        (lambda text: text.replace("\n", "\n\n").replace("-25,", "x,", 1), ":3: est_d_m: 'x' is not"),
        (lambda text: text.replace("\n3.2,", '\n"3\n.2",'), ":4: t_s: '3?.2' is not a finite number"),
        (lambda text: text[:-2], ":202: true_qz: the file ends without a line break"),
        (lambda text: text.replace("-25,", '"-25,', 1), "a quote is out of place or not closed"),
        (lambda text: text.splitlines()[0] + "\n", "fewer than two poses"),
        (lambda text: "", ":1: t_s: missing column, the file is empty"),
    ],
)
def test_bad_recordings_are_refused_with_their_place(goe_sim: Path, tmp_path: Path, change, complaint: str) -> None:
    path = tmp_path / "flight.csv"
    write_recording(path)
    path.write_text(change(path.read_text()))
    done = run(goe_sim, "--flight", path, "--out", tmp_path / "log", expect=2)
    assert complaint in done.stderr and str(path) in done.stderr
    assert not (tmp_path / "log").exists()


@pytest.mark.parametrize(
    "change",
    [
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("-25,", "-25." + "0" * 80 + ","),  # no field is truncated
        lambda text: "".join(f'"{line}, x",{line}\n' for line in text.splitlines()),
    ],
    ids=["byte order mark", "CRLF", "long numbers", "a column of one's own"],
)
def test_recordings_written_otherwise(goe_sim: Path, tmp_path: Path, change) -> None:
    path = tmp_path / "flight.csv"
    write_recording(path)
    words = ("--run", "3", "--flight", path)
    run(goe_sim, *words, "--out", tmp_path / "plain")
    path.write_bytes(change(path.read_text()).encode())
    run(goe_sim, *words, "--out", tmp_path / "other")
    assert folder_bytes(tmp_path / "other") == folder_bytes(tmp_path / "plain")


def test_out_never_replaces_an_input(goe_sim: Path, tmp_path: Path) -> None:
    (tmp_path / "log").mkdir()
    path = tmp_path / "log" / "frames.csv"
    write_recording(path)
    (tmp_path / "link.csv").symlink_to(path)
    before = path.read_bytes()
    for name in (path, tmp_path / "link.csv"):
        done = run(goe_sim, "--flight", name, "--out", tmp_path / "log", expect=2)
        assert done.stderr == f"goe_sim: {name}: the log would replace it\n"
    assert path.read_bytes() == before


def test_a_full_disk_leaves_nothing(goe_sim: Path, tmp_path: Path) -> None:
    command = f'ulimit -f 8; exec "{goe_sim}" --out "{tmp_path}/log" --case 3'
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stderr == f"goe_sim: {tmp_path}/log: File too large\n"
    assert list(tmp_path.iterdir()) == []
    for option in ("--help", "--list-cases"):
        with open("/dev/full", "w") as full:
            done = subprocess.run([goe_sim, option], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode == 2
        assert done.stderr == "goe_sim: standard output: cannot be written: No space left on device\n"


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--obstacle", "tree"), "--obstacle"),
        (("--obstacle", "box:1,2"), "--obstacle"),
        (("--obstacle", "box:1,2,3,4"), "--obstacle"),
        (("--obstacle", "box:1,-2,3"), "--obstacle"),
        (("--obstacle", "disc:1,nan"), "--obstacle"),
        (("--path", "arc:0"), "--path"),
        (("--path", "weave:3"), "--path"),
        (("--path", "weave:3,0"), "--path"),
        (("--speed-profile", "ramp:"), "--speed-profile"),
        (("--wind", "dryden:severe"), "--wind"),
        (("--noise", "pixel:-1"), "--noise"),
        (("--noise", "loud"), "--noise"),
        (("--cylinder", "round"), "--cylinder"),
        (("--speed", "60"), "speed"),
        (("--speed", "inf"), "speed"),
        (("--speed", "fast"), "--speed"),
        (("--speed=fast",), "--speed"),
        (("--speed", "nan"), "speed"),
        (("--z0", "nan"), "--z0"),
        (("--x0", "nan"), "x0"),
        (("--pixel-noise", "nan"), "noise"),
        (("--offset-x", "nan"), "offset"),
        (("--glide", "29"), "glide"),
        (("--altitude", "0"), "altitude"),
        (("--fps", "0"), "fps"),
        (("--run", "1e5", "--fps", "1000"), "fps"),
        (("--reach", "0"), "reach"),
        (("--seed", "-1"), "--seed"),
        (("--case", "156"), "--case"),
        (("--case", "3", "--obstacle", "truck"), "--obstacle"),
        (("--drop-rate", "1.5"), "rate"),
        (("--pixel-noise", "-1"), "noise"),
        (("--detector-correlation", "1"), "correlation"),
        (("--fx", "0"), "focal"),
        (("--image-width", "0"), "image size"),
        (("--k1", "1000"), "lens"),
        (("--wind-speed", "17"), "wind"),
        (("--flight", "/no/such/file"), "/no/such/file"),
        (("--flight", "/no/such/file", "--speed", "30"), "--speed: the recorded flight of --flight has its own"),
        (("--flight", "/no/such/file", "--path", "straight"), "the recorded flight of --flight has its own"),
        (("--flight-start", "5"), "--flight-start: needs --flight"),
        (("--nonsense",), "--nonsense"),
        (("stray",), "stray"),
    ],
)
def test_bad_usage_is_named_and_writes_nothing(
    goe_sim: Path, tmp_path: Path, options: tuple[str, ...], complaint: str
) -> None:
    done = run(goe_sim, "--out", tmp_path / "log", *options, expect=2)
    assert complaint in done.stderr and done.stderr.count("\n") == 1 and done.stdout == ""
    assert not list(tmp_path.iterdir())


def test_out_is_needed(goe_sim: Path) -> None:
    assert "--out" in run(goe_sim, expect=2).stderr


def test_a_log_is_replaced_and_nothing_else_is(goe_sim: Path, tmp_path: Path) -> None:
    log = tmp_path / "log"
    log.mkdir()  # an empty folder has nothing to lose
    run(goe_sim, *TRUCK, "--seed", "1", "--noise", "field", "--out", log)
    before = folder_bytes(log)
    run(goe_sim, *TRUCK, "--seed", "2", "--noise", "field", "--out", f"{log}/")
    assert set(folder_bytes(log)) == set(FILES) and folder_bytes(log) != before
    (log / "notes.txt").write_text("mine")
    before = folder_bytes(log)
    assert "no log" in run(goe_sim, *TRUCK, "--out", log, expect=2).stderr
    assert folder_bytes(log) == before
    plain = tmp_path / "plain"
    plain.write_text("mine")
    assert "not a folder" in run(goe_sim, *TRUCK, "--out", plain, expect=2).stderr
    assert plain.read_text() == "mine"
    assert "Not a directory" in run(goe_sim, *TRUCK, "--out", plain / "log", expect=2).stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log", "plain"]


def test_folders_on_the_way_are_made(goe_sim: Path, tmp_path: Path) -> None:
    run(goe_sim, *TRUCK, "--out", tmp_path / "no" / "such" / "folder")
    assert set(folder_bytes(tmp_path / "no" / "such" / "folder")) == set(FILES)


def change_a_digit(log: Path) -> None:
    text = (log / "frames.csv").read_text()
    (log / "frames.csv").write_text(text[:-3] + ("1" if text[-3] == "0" else "0") + text[-2:])


@pytest.mark.parametrize(
    "change",
    [
        change_a_digit,
        lambda log: (log / "camera.ini").write_text("# mine\n" + (log / "camera.ini").read_text()),
        lambda log: (log / "camera.ini").write_text("camera.fx = 914\n"),
        lambda log: (log / "camera.ini").write_text(""),
        lambda log: (log / "truth.csv").unlink(),
        lambda log: [path.unlink() for path in log.iterdir() if path.name != "frames.csv"],
    ],
    ids=["frames", "comment", "camera", "empty camera", "no truth", "frames alone"],
)
def test_a_log_of_others_is_not_replaced(goe_sim: Path, tmp_path: Path, change: Callable[[Path], object]) -> None:
    """Logs of another program, or edited ones."""
    log = tmp_path / "log"
    run(goe_sim, *TRUCK, "--out", log)
    change(log)
    before = folder_bytes(log)
    assert "a log that goe_sim did not write" in run(goe_sim, *TRUCK, "--out", log, expect=2).stderr
    assert folder_bytes(log) == before and [path.name for path in tmp_path.iterdir()] == ["log"]


def test_a_round_obstacle_has_neither_sides_nor_orientation(goe_sim: Path, tmp_path: Path) -> None:
    run(goe_sim, "--obstacle", "disc:6,30", "--run", "1", "--out", tmp_path / "log")
    with (tmp_path / "log" / "truth.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    empty = {name for name, text in row.items() if text == ""}
    assert empty == {"length_m", "heading_deg", "front_x0_m", "front_z0_m", "orientation_deg"}
    assert (row["width_m"], row["height_m"], row["kind"]) == ("6", "30", "cylinder")


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help(goe_sim: Path, word: str) -> None:
    done = run(goe_sim, word)
    assert "--obstacle" in done.stdout and done.stderr == ""


def written(folder: Path) -> int:
    """Bytes of all files in a folder, whose files may appear and vanish meanwhile."""
    size = 0
    for place, _, names in os.walk(folder):
        for name in names:
            with contextlib.suppress(FileNotFoundError):
                size += os.path.getsize(os.path.join(place, name))
    return size


def test_interrupted_runs_leave_no_part_of_a_log(goe_sim: Path, tmp_path: Path) -> None:
    """Killed at any amount of output, the log is complete or missing, and no other folder remains."""
    run(goe_sim, "--out", tmp_path / "whole", *LONG)
    size = written(tmp_path)
    shutil.rmtree(tmp_path / "whole")
    for part in range(25):
        process = subprocess.Popen([str(goe_sim), "--out", str(tmp_path / "log"), *LONG])
        while process.poll() is None and written(tmp_path) < part / 25 * size:
            pass
        process.send_signal(signal.SIGTERM)
        process.wait()  # killed, or done: the signal waited until the log was complete
        names = [path.name for path in tmp_path.iterdir()]
        assert names in ([], ["log"])
        if names:
            assert len(read_log(tmp_path / "log").frames["t_s"]) == 2001
            for name in FILES:
                os.unlink(tmp_path / "log" / name)
            os.rmdir(tmp_path / "log")


def test_an_interrupt_while_it_reads_ends_it(goe_sim: Path, tmp_path: Path) -> None:
    """A recorded flight that never arrives, so that the program cannot end by itself."""
    command = [str(goe_sim), "--flight", "/dev/stdin", "--out", str(tmp_path / "log")]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as process:
        process.send_signal(signal.SIGTERM)
        assert process.wait(timeout=HANG_S) == -signal.SIGTERM
    assert list(tmp_path.iterdir()) == []


def test_flying_into_the_ground_ends_the_log(goe_sim: Path, tmp_path: Path) -> None:
    done = run(
        goe_sim,
        "--obstacle",
        "truck",
        "--altitude",
        "0.2",
        "--wind",
        "dryden:moderate",
        "--out",
        tmp_path / "log",
        expect=1,
    )
    assert "hit the ground" in done.stderr
    log = read_log(tmp_path / "log")
    assert len(log.frames["t_s"]) < 145 and (log.exact["d_m"] < 0).all()
    assert (
        "flew into the obstacle"
        in run(
            goe_sim, "--obstacle", "building", "--x0", "0", "--run", "45", "--out", tmp_path / "log", expect=1
        ).stderr
    )
