"""goe_replay from a user's view: its output, and its reaction to bad logs, bad options and bad disks.

The program is $GOE_REPLAY, by default build/sim_host/goe_replay of this checkout.
"""

import csv
import io
import math
import os
import signal
import struct
import subprocess
import time
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any, Optional

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GOE_REPLAY", str(ROOT / "build" / "sim_host" / "goe_replay"))

# A path that the caller named must exist: without the program the tests fail.
pytestmark = pytest.mark.skipif(
    "GOE_REPLAY" not in os.environ and not Path(PROGRAM).exists(), reason=f"{PROGRAM} is not built"
)

HEADER = (
    "t_s,id,status,model,images_used,x0_m,x0_sd_m,z0_m,z0_sd_m,x_m,x_sd_m,z_m,z_sd_m,width_m,width_sd_m,"
    "length_m,length_sd_m,height_m,height_sd_m,orientation_deg,orientation_sd_deg,"
    "center_n_m,center_n_sd_m,center_e_m,center_e_sd_m,suspect,reason"
)
RESIDUALS = (
    ",nis,nis_rows,nis_ratio,velocity_n_m_s,velocity_n_sd_m_s,velocity_e_m_s,velocity_e_sd_m_s,latency_s,latency_sd_s"
)
PAPER = ("--method", "window")
CORNER = ROOT / "tests" / "data" / "corner"
LEVEL = ("--set", "navigation.terrain_height_sd_m=0", "--set", "navigation.terrain_slope_sd=0")  # as in the logs
POSE = ["t_s", "id", "n_m", "e_m", "d_m", "agl_m", "qw", "qx", "qy", "qz"]
POINTS = ["left", "right", "top", "base_left", "base_near", "base_right"]
COLUMNS = POSE + [f"{point}_{axis}" for point in POINTS for axis in "uv"]
SIDES = ["box_left_px", "box_top_px", "box_right_px", "box_bottom_px"]
JUMP = ["reset_n_m", "reset_e_m", "reset_d_m"]
RESETS = ["reset_count", *JUMP]
CAMERA = """# a wide lens
camera.width = 1920
camera.height = 1080
camera.fx = 1000   # px
camera.fy = 1000
camera.cx = 960
camera.cy = 540
"""
ALTITUDE_M = 50.0
Row = dict[str, Any]
HANG_S = 600  # guard against a hang

# ------------------------------------------------------------------------------------------------------------- logs


def pixel(north_m: float, east_m: float, down_m: float) -> tuple[float, float]:
    """Pixel of a point, given relative to a level camera that looks north."""
    return 960.0 + 1000.0 * east_m / north_m, 540.0 + 1000.0 * down_m / north_m


def pose_row(t_s: float, n_m: float, track: int = 1) -> Row:
    """A row without image points, moving north at ALTITUDE_M."""
    row: Row = {column: "" for column in COLUMNS}
    row.update(t_s=f"{t_s:.2f}", id=track, n_m=n_m, e_m=0.0, d_m=-ALTITUDE_M, agl_m=ALTITUDE_M)
    row.update(qw=1.0, qx=0.0, qy=0.0, qz=0.0)
    return row


def put(row: Row, point: str, at: tuple[float, float]) -> None:
    row[point + "_u"], row[point + "_v"] = (f"{value:.9g}" for value in at)


def chimney(frames: int = 20, track: int = 1, north_m: float = 200.0, east_m: float = -30.0) -> list[Row]:
    """A chimney of 6 m diameter and 20 m height from a straight flight at 15 m/s."""
    rows = []
    for k in range(frames):
        n_m = 1.5 * k
        row = pose_row(0.1 * k, n_m, track)
        ahead, bearing = north_m - n_m, math.atan2(east_m, north_m - n_m)
        half = math.asin(3.0 / math.hypot(ahead, east_m))
        v_px = pixel(ahead, east_m, 40.0)[1]
        put(row, "left", (960.0 + 1000.0 * math.tan(bearing - half), v_px))
        put(row, "right", (960.0 + 1000.0 * math.tan(bearing + half), v_px))
        put(row, "top", pixel(ahead, east_m, ALTITUDE_M - 20.0))
        rows.append(row)
    return rows


def box(frames: int = 40) -> list[Row]:
    """A box of 20 m (front) x 12 m (side), its side turned 25 degrees clockwise from north; base corners only."""
    turn = math.radians(25.0)
    front, side = (-math.sin(turn), math.cos(turn)), (math.cos(turn), math.sin(turn))  # (north, east) unit vectors
    near = (260.0, -45.0)
    left = (near[0] - 20.0 * front[0], near[1] - 20.0 * front[1])
    right = (near[0] + 12.0 * side[0], near[1] + 12.0 * side[1])
    rows = []
    for k in range(frames):
        row = pose_row(0.1 * k, 2.0 * k)
        for point, (n_m, e_m) in (("base_left", left), ("base_near", near), ("base_right", right)):
            put(row, point, pixel(n_m - 2.0 * k, e_m, ALTITUDE_M))
        rows.append(row)
    return rows


def table(rows: Sequence[Row], columns: Sequence[str] = COLUMNS) -> str:
    lines = [",".join(columns)] + [",".join(str(row.get(column, "")) for column in columns) for row in rows]
    return "\n".join(lines) + "\n"


def write_log(folder: Path, frames: "str | bytes", camera: "str | bytes" = CAMERA) -> Path:
    folder.mkdir(exist_ok=True)
    for name, content in (("frames.csv", frames), ("camera.ini", camera)):
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


# -------------------------------------------------------------------------------------------------------------- calls


def call(*arguments: "str | Path", check: Optional[int] = 0) -> "subprocess.CompletedProcess[str]":
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)
    if check is not None:
        assert done.returncode == check, (done.returncode, done.stderr)
    return done


def replay(folder: Path, *options: "str | Path", check: int = 0) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(call(*options, folder, check=check).stdout)))


def number(row: dict[str, str], column: str) -> float:
    assert row[column] != "", f"{column} is empty"
    return float(row[column])


@pytest.fixture(name="log")
def chimney_log(tmp_path: Path) -> Path:
    return write_log(tmp_path / "log", table(chimney()))


# ------------------------------------------------------------------------------------------------------------- output


def test_header_is_the_contract(log: Path) -> None:
    assert call(log).stdout.splitlines()[0] == HEADER


def test_one_row_per_row_with_time_as_it_was_read(tmp_path: Path) -> None:
    rows = chimney(4)
    for row, text in zip(rows, ["0", "1.0e-1", "0.2000", "+.3"]):
        row["t_s"] = text
    out = replay(write_log(tmp_path, table(rows)), check=1)
    assert [row["t_s"] for row in out] == ["0", "1.0e-1", "0.2000", "+.3"]
    assert {row["id"] for row in out} == {"1"}


def test_chimney_is_found(log: Path) -> None:
    out = replay(log, *PAPER)
    assert [row["status"] for row in out] == ["converging"] * 7 + ["ok"] * 13
    assert [row["images_used"] for row in out] == ["0"] * 7 + ["8"] * 13
    assert [row["model"] for row in out] == ["none"] * 7 + ["disc"] * 13
    last = out[-1]
    # (2) is exact for the position; its size row is off by r^2 X^2 / (Z^2 d^2) < 1e-5 here. Text has 9 digits.
    assert number(last, "x0_m") == pytest.approx(-30.0, rel=2e-3)
    assert number(last, "z0_m") == pytest.approx(200.0, rel=2e-3)
    assert number(last, "z_m") == pytest.approx(200.0 - 1.5 * 19, rel=2e-3)
    assert number(last, "width_m") == pytest.approx(6.0, rel=2e-3)
    assert number(last, "height_m") == pytest.approx(20.0, rel=5e-3)
    assert number(last, "center_n_m") == pytest.approx(200.0, rel=2e-3)
    assert number(last, "center_e_m") == pytest.approx(-30.0, rel=2e-3)
    assert last["length_m"] == last["length_sd_m"] == last["orientation_deg"] == last["orientation_sd_deg"] == ""


def test_box_is_found(tmp_path: Path) -> None:
    last = replay(write_log(tmp_path, table(box())), *PAPER)[-1]
    assert (last["status"], last["model"]) == ("ok", "line")
    assert number(last, "width_m") == pytest.approx(20.0, rel=2e-3)
    assert number(last, "length_m") == pytest.approx(12.0, rel=5e-3)
    assert number(last, "orientation_deg") == pytest.approx(25.0, abs=0.05)
    assert number(last, "orientation_sd_deg") < 0.05
    assert last["height_m"] == ""


def test_forced_model(tmp_path: Path) -> None:
    folder = write_log(tmp_path, table(box()))
    assert replay(folder, *PAPER, "--model", "line")[-1]["model"] == "line"
    assert {row["model"] for row in replay(folder, *PAPER, "--model=disc", check=1)} == {"none"}


def test_window(log: Path) -> None:
    for window in (3, 8, 13):
        out = replay(log, *PAPER, "--window", str(window))
        assert [row["status"] for row in out].index("ok") == window - 1
        assert out[-1]["images_used"] == str(window)


def test_window_64(tmp_path: Path) -> None:
    """[GOE_WINDOW_MAX]"""
    out = replay(write_log(tmp_path, table(chimney(70))), *PAPER, "--window=64")
    assert [row["status"] for row in out].index("ok") == 63


@pytest.mark.parametrize("method", ["window", "filter"])
def test_numbers_are_floats_with_nine_digits(tmp_path: Path, method: str) -> None:
    """Each number is the shortest %.9g text of one float, as a C library prints it."""
    numbers = 0
    for name, rows in (("chimney", chimney()), ("box", box())):
        for row in replay(write_log(tmp_path / name, table(rows)), "--method", method, "--residuals"):
            for column, text in list(row.items())[5:]:
                if text and column != "reason":
                    nearest = struct.unpack("f", struct.pack("f", float(text)))[0]
                    assert text == f"{nearest:.9g}"
                    numbers += 1
    assert numbers > 500


@pytest.mark.parametrize("method", ["window", "filter"])
def test_every_quantity_is_followed_by_its_sigma(log: Path, method: str) -> None:
    for row in replay(log, "--method", method):
        texts = list(row.values())[5:]
        assert [text == "" for text in texts[0::2]] == [text == "" for text in texts[1::2]]


def test_interleaved_tracks_do_not_touch_each_other(tmp_path: Path) -> None:
    ids = (7, -1, 9223372036854775807, -9223372036854775808, 0)
    tracks = [chimney(track=track, east_m=-30.0 - 5.0 * i) for i, track in enumerate(ids)]
    together = replay(write_log(tmp_path / "all", table([row for rows in zip(*tracks) for row in rows])))
    for track, rows in zip(ids, tracks):
        alone = replay(write_log(tmp_path / "one", table(rows)))
        assert [row for row in together if row["id"] == str(track)] == alone
        assert alone[-1]["status"] == "ok"


def test_many_tracks(tmp_path: Path) -> None:
    rows = [pose_row(0.1 * k, 1.0 * k, track=(7919 * i) % 5003 - 2500) for k in range(2) for i in range(5003)]
    out = replay(write_log(tmp_path, table(rows)), check=1)
    assert [row["status"] for row in out] == ["no_detection"] * len(rows)


# ------------------------------------------------------------------------------------------- the filter method


def test_refined_is_the_default(log: Path) -> None:
    for folder in (log, CORNER):
        refined = call(folder).stdout
        assert call("--method", "filter", folder).stdout == refined
        assert call(*PAPER, folder).stdout != refined


def test_refined_chimney(log: Path) -> None:
    """No later than the window method, and within the sigmas: the log has no errors."""
    out = replay(log)
    start = [row["status"] for row in out].index("ok")
    assert start <= 7
    assert [row["status"] for row in out] == ["converging"] * start + ["ok"] * (20 - start)
    assert [row["model"] for row in out] == ["none"] * start + ["prism"] * (20 - start)
    for name, truth in {
        "x0": -30.0,
        "z0": 200.0,
        "center_n": 200.0,
        "center_e": -30.0,
        "width": 6.0,
        "height": 20.0,
    }.items():
        first, last = float(out[start][f"{name}_sd_m"] or math.inf), number(out[-1], f"{name}_sd_m")
        assert 0.0 < last < first
        assert abs(number(out[-1], f"{name}_m") - truth) < last
    assert out[-1]["length_m"] == out[-1]["orientation_deg"] == ""


def test_refined_box() -> None:
    """The corner log: the box replaces the footprint, sooner than the window's line does, and stays."""
    out = replay(CORNER, *LEVEL)
    models = [row["model"] for row in out]
    start = models.index("box")
    assert 0 < start < [row["model"] for row in replay(CORNER, *PAPER)].index("line")
    assert set(models[1:start]) == {"prism"} and set(models[start:]) == {"box"}  # one image alone gives no answer
    (truth,) = csv.DictReader((CORNER / "truth.csv").read_text(encoding="utf-8").splitlines())
    last = out[-1]
    for name, column in {"width_m": "width_m", "length_m": "length_m", "height_m": "height_m"}.items():
        assert number(last, name) == pytest.approx(float(truth[column]), rel=0.02)
    for name, column in {"center_n_m": "center_n_m", "center_e_m": "center_e_m"}.items():
        assert abs(number(last, name) - float(truth[column])) < 2.0 * number(last, name.replace("_m", "_sd_m"))


def test_refined_footprint_in_place_of_a_box_has_its_width_across() -> None:
    """Before its orientation is known, a box is estimated as an ellipse, whose width is that across the line of sight:
    here the front's, 15 m."""
    alone, first = replay(CORNER, *LEVEL)[:2]
    assert (alone["status"], alone["model"]) == ("converging", "none")
    assert (first["status"], first["model"]) == ("ok", "prism")
    assert abs(float(first["width_m"]) - 15.0) < 2.0 * float(first["width_sd_m"]) < 10.0


def test_refined_forced_model() -> None:
    assert {row["model"] for row in replay(CORNER, "--model=disc", *LEVEL)[1:]} == {"disc"}
    assert {row["model"] for row in replay(CORNER, "--model=line")} <= {"none", "line", "box"}


@pytest.mark.parametrize("method", ["window", "filter"])
def test_residuals_are_columns_at_the_end(method: str) -> None:
    plain = call("--method", method, CORNER).stdout.splitlines()
    wide = call("--method", method, "--residuals", CORNER).stdout.splitlines()
    assert plain[0] == HEADER and wide[0] == HEADER + RESIDUALS
    assert [line.rsplit(",", RESIDUALS.count(","))[0] for line in wide] == plain
    rows = list(csv.DictReader(wide))
    assert {row["suspect"] for row in rows} == {"0"} and {row["reason"] for row in rows} == {"none"}
    assert {row["velocity_n_m_s"] for row in rows} == {""}
    if method == "window":
        assert {(row["nis"], row["nis_rows"], row["nis_ratio"]) for row in rows} == {("", "0", "")}
        return
    assert [row["nis"] == "" for row in rows] == [row["nis_rows"] == "0" for row in rows]
    judged = [row for row in rows if row["nis"] != ""]
    assert len(judged) > 0.9 * len(rows)
    assert all(0.0 <= number(row, "nis") < 5.0 * number(row, "nis_rows") for row in judged)
    assert all(0.0 < number(row, "nis_ratio") < 1.0 for row in judged[10:])


def test_suspect() -> None:
    """The configured pixel noise is five times too small; then the limit is set."""
    configured = ("--set", "detector.point_noise_px=0.06", "--set", "navigation.attitude_white_sd_deg=1e-4")
    configured += (*LEVEL, "--set", "filter.gate_sigma=100", "--set", "filter.nis_ratio_max=1.5")
    out = replay(CORNER, "--residuals", *configured, "--set", "filter.huber_sigma=100")
    assert number(out[-1], "nis_ratio") > 1.5
    images = accumulate(int(row["nis_rows"]) > 0 for row in out)
    flagged = [row["suspect"] for row in out]
    assert {row["reason"] for row in out if row["suspect"] == "1"} <= {"noise", "base", "convention"}
    assert [row["suspect"] for row in replay(CORNER, *configured, "--set", "filter.huber_sigma=100")] == flagged
    assert flagged == [str(int(n >= 8 and float(row["nis_ratio"] or 0.0) > 1.5)) for n, row in zip(images, out)]
    bold = [row["suspect"] for row in replay(CORNER, "--residuals", *configured, "--set", "filter.nis_ratio_max=1e3")]
    assert bold.count("1") < flagged.count("1")  # remaining causes: base corners that proved wrong


SETTINGS = {  # by --set, and their defaults
    "navigation.attitude_bias_sd_deg": 0.5,
    "navigation.attitude_white_sd_deg": 0.1,
    "navigation.attitude_walk_sd_deg": 0,
    "navigation.height_bias_sd_m": 0.5,
    "navigation.velocity_bias_sd_m_s": 0.05,
    "navigation.position_walk_sd_m": 0.05,
    "navigation.position_white_sd_m": 0,
    "navigation.terrain_height_sd_m": 2,
    "detector.point_noise_px": 0.5,
    "detector.point_noise_rel": 0,
    "detector.point_correlation": 0,
    "detector.shape_error_rel": 0,
    "detector.box_noise_px": 1,
    "detector.box_noise_rel": 0.07,
    "detector.box_correlation_time_s": 1.2,
    "detector.truncation_noise_rel": 1,
    "filter.prior_width_m": 6,
    "filter.gate_sigma": 5,
    "filter.huber_sigma": 2.5,
    "filter.nis_ratio_max": 1.9,
    "filter.range_sd_rel_max": 0.25,
    "filter.top_is_highest": 0,
    "window.points": 8,
    "window.line_points": 8,
    "window.edge_min_px": 10,
    "window.orientation_min_px": 2,
    "window.side_min_px": 10,
    "window.orientation_memory": 20,
    "window.min_baseline_m": 0.1,
}
OTHERWISE = {  # values that change the filter method's answers to a log, or those of the window method
    "filter": {
        **{name: 0.2 for name in SETTINGS if name.startswith(("detector.", "navigation."))},
        "filter.prior_width_m": 30,
        "filter.gate_sigma": 1,
        "filter.huber_sigma": 0.5,
        "filter.range_sd_rel_max": 0.01,
        "filter.top_is_highest": 1,
    },
    "window": {
        "window.points": 5,
        "window.line_points": 20,
        "window.edge_min_px": 40,
        "window.orientation_min_px": 100,
        "window.side_min_px": 60,
        "window.orientation_memory": 3,
        "window.min_baseline_m": 100,
    },
}


def test_each_setting_is_set(log: Path, tmp_path: Path) -> None:
    cut = [{**row, "box_right_px": row["box_right_px"] if k < 30 else ""} for k, row in enumerate(boxes())]
    folders = (CORNER, log, write_log(tmp_path / "boxes", table(cut, COLUMNS + SIDES)))
    assert {"filter.nis_ratio_max"} | {name for configured in OTHERWISE.values() for name in configured} == set(
        SETTINGS
    )
    for method, configured in OTHERWISE.items():
        usual = [call("--method", method, folder, check=None).stdout for folder in folders]
        for name, value in configured.items():
            option = f"--set={name}={value}"
            changed = [call("--method", method, option, folder, check=None).stdout for folder in folders]
            assert all(changed) and changed != usual, name


def test_set_to_the_default_changes_nothing() -> None:
    for method in ("window", "filter"):
        configured = [option for name, value in SETTINGS.items() for option in ("--set", f"{name}={value}")]
        assert call("--method", method, *configured, CORNER).stdout == call("--method", method, CORNER).stdout


def test_the_last_of_two_counts() -> None:
    both = call("--set", "detector.point_noise_px=3", "--set=detector.point_noise_px=0.7", CORNER).stdout
    assert both == call("--set", "detector.point_noise_px=0.7", CORNER).stdout != call(CORNER).stdout


# ------------------------------------------------------------------------------------------------------- file formats


def variants() -> list[tuple[str, bytes]]:
    rows = chimney()
    plain = table(rows)
    shuffled = ["note", *sorted(COLUMNS, key=lambda name: name[::-1]), "score", ""]
    for row in rows:
        row.update(note='"a ""quoted"", note"', score="not a number")
    return [
        ("other order and unknown columns", table(rows, shuffled).encode()),
        ("CRLF", plain.replace("\n", "\r\n").encode()),
        ("byte order mark", b"\xef\xbb\xbf" + plain.encode()),
        ("byte order mark and CRLF", b"\xef\xbb\xbf" + plain.replace("\n", "\r\n").encode()),
        ("quoted fields", "".join('"' + line.replace(",", '","') + '"\n' for line in plain.splitlines()).encode()),
        ("blanks around fields", plain.replace(",", " ,\t").encode()),
        ("blank lines", ("\n \n" + plain.replace("\n", "\n\n")).encode()),
        ("no base corners", table(rows, [name for name in COLUMNS if not name.startswith("base")]).encode()),
        ("line break in quotes", table([{**row, "note": '"two\nlines"'} for row in rows], [*COLUMNS, "note"]).encode()),
    ]


@pytest.mark.parametrize("frames", [pytest.param(content, id=name) for name, content in variants()])
def test_same_log_written_otherwise(tmp_path: Path, log: Path, frames: bytes) -> None:
    assert call(write_log(tmp_path / "other", frames)).stdout == call(log).stdout


def test_camera_file_written_otherwise(tmp_path: Path, log: Path) -> None:
    lines = CAMERA.splitlines()[1:]
    camera = "\ufeff" + "\r\n".join("   " + line.replace(" = ", "=") for line in reversed(lines))
    camera += "\r\n\r\n  # " + "a long comment " * 100 + "; [x]: \r\ntrajectory.heading_deg = auto # the yaw"
    other = write_log(tmp_path / "other", table(chimney()), camera)
    assert call(other).stdout == call(log).stdout


def test_heading_setting(tmp_path: Path) -> None:
    other = write_log(tmp_path, table(chimney()), CAMERA + "trajectory.heading_deg = -20\n")
    last = replay(other)[-1]
    turn = math.radians(-20.0)
    assert number(last, "x0_m") == pytest.approx(-30.0 * math.cos(turn) - 200.0 * math.sin(turn), rel=1e-2)
    assert number(last, "z0_m") == pytest.approx(200.0 * math.cos(turn) - 30.0 * math.sin(turn), rel=1e-2)
    assert number(last, "center_n_m") == pytest.approx(200.0, rel=1e-2)


def test_files_named_singly(tmp_path: Path, log: Path) -> None:
    want = call(log).stdout
    assert call("--camera", log / "camera.ini", "--frames", log / "frames.csv").stdout == want
    moved = tmp_path / "elsewhere.csv"
    (log / "frames.csv").rename(moved)
    assert call("--frames", moved, log).stdout == want
    assert call("--frames", moved, f"{log}/").stdout == want


@pytest.mark.parametrize("how", ["empty", "absent"])
def test_height_above_ground_falls_back_to_altitude(tmp_path: Path, log: Path, how: str) -> None:
    rows = [{**row, "agl_m": ""} for row in chimney()]
    columns = [name for name in COLUMNS if how == "empty" or name != "agl_m"]
    assert call(write_log(tmp_path / "other", table(rows, columns))).stdout == call(log).stdout


def test_height_above_ground_is_used(tmp_path: Path, log: Path) -> None:
    other = replay(write_log(tmp_path / "other", table([{**row, "agl_m": 60.0} for row in chimney()])), *PAPER)
    assert number(other[-1], "height_m") == pytest.approx(number(replay(log, *PAPER)[-1], "height_m") + 10.0, abs=1e-4)


@pytest.mark.parametrize("columns", [SIDES, RESETS, SIDES[:1], RESETS[:1], SIDES + RESETS])
def test_empty_boxes_and_resets_change_nothing(tmp_path: Path, log: Path, columns: list[str]) -> None:
    other = write_log(tmp_path / "other", table(chimney(), COLUMNS + columns))
    assert call(other).stdout == call(log).stdout


# -------------------------------------------------------------------------------------------------- bounding boxes


def boxes(frames: int = 40) -> list[Row]:
    """A chimney of 6 m diameter and 20 m height at (200, -30) m as boxes of a detector, with its foot at the bottom."""
    rows = []
    for row, pose in zip(chimney(frames), [pose_row(0.1 * k, 1.5 * k) for k in range(frames)]):
        ahead = 200.0 - 1.5 * len(rows)
        top, bottom = (pixel(ahead, 0.0, down)[1] for down in (ALTITUDE_M - 20.0, ALTITUDE_M))
        pose.update(zip(SIDES, (row["left_u"], f"{top:.9g}", row["right_u"], f"{bottom:.9g}")))
        rows.append(pose)
    return rows


def test_boxes_alone_are_enough(tmp_path: Path) -> None:
    last = replay(write_log(tmp_path, table(boxes(), COLUMNS + SIDES)))[-1]
    assert (last["status"], last["model"]) == ("ok", "prism")
    for name, truth in {"center_n": 200.0, "center_e": -30.0, "width": 6.0, "height": 20.0}.items():
        if last[f"{name}_m"]:
            assert abs(number(last, f"{name}_m") - truth) < 2.0 * number(last, f"{name}_sd_m")
    assert number(last, "z_m") == pytest.approx(200.0 - 1.5 * 39, rel=0.1)


@pytest.mark.parametrize("side", SIDES)
def test_each_side_is_visible_if_it_is_given(tmp_path: Path, side: str) -> None:
    """The library refuses a NaN side, but ignores the number of a side that is not visible."""
    rows = [{**row, **{name: "" for name in SIDES if name != side}} for row in boxes(4)]
    rows[1][side], rows[2][side], rows[3][side] = "nan", "", "2e5"
    out = replay(write_log(tmp_path, table(rows, COLUMNS + SIDES)), check=1)
    assert [row["status"] for row in out] == ["box_incomplete", "not_finite", "no_detection", "out_of_range"]


@pytest.mark.parametrize(
    ("side", "border"),
    [("box_left_px", 1.0), ("box_right_px", 1919.0), ("box_bottom_px", 1079.0)],  # of 1920 x 1080 px
)
def test_a_side_at_the_border_is_none(tmp_path: Path, side: str, border: float) -> None:
    """The library knows the image size: a side at the border counts as empty, elsewhere it does not."""
    whole = boxes()
    at_border, empty = ([*whole[:20], *({**row, side: text} for row in whole[20:])] for text in (border, ""))
    configured = [call(write_log(tmp_path, table(rows, COLUMNS + SIDES))).stdout for rows in (whole, at_border, empty)]
    assert configured[0] != configured[1] == configured[2]


# ------------------------------------------------------------------------------------------- resets of the autopilot

JUMPED_M = (37.25, -12.5, 3.0)  # multiples of 1/4 m like the positions below: their sums are exact


def jumped(counts: Sequence[Any], deltas: Sequence[Sequence[Any]] = (JUMPED_M,)) -> list[Row]:
    """The chimney, with positions that jump at row 12. counts, deltas: of row 12, 13, ...; the last one stays."""
    rows = chimney()
    for k, row in enumerate(rows[12:]):
        for column, by in zip(("n_m", "e_m", "d_m"), JUMPED_M):
            row[column] += by
        row["reset_count"] = counts[min(k, len(counts) - 1)]
        row.update(zip(JUMP, deltas[min(k, len(deltas) - 1)]))
    return rows


def quantities(rows: Sequence[dict[str, str]]) -> list[dict[str, str]]:
    """Without the center, which is in the autopilot's own coordinates."""
    return [{name: text for name, text in row.items() if not name.startswith("center")} for row in rows]


@pytest.mark.parametrize("method", ["window", "filter"])
def test_a_known_jump_is_no_motion(tmp_path: Path, log: Path, method: str) -> None:
    plain = replay(log, "--method", method)
    folder = write_log(tmp_path / "jump", table(jumped([1]), COLUMNS + RESETS))
    out = replay(folder, "--method", method)
    assert quantities(out) == quantities(plain)
    for column, by in (("center_n_m", JUMPED_M[0]), ("center_e_m", JUMPED_M[1])):
        assert number(out[-1], column) == pytest.approx(number(plain[-1], column) + by, abs=5e-5)


def test_a_jump_is_reported_in_the_row_of_the_new_count_alone(tmp_path: Path, log: Path) -> None:
    once = table(jumped([1], [JUMPED_M, ("", "", "")]), COLUMNS + RESETS)
    assert quantities(replay(write_log(tmp_path, once), *PAPER)) == quantities(replay(log, *PAPER))


@pytest.mark.parametrize("lacking", [*JUMP, "columns"])
def test_an_unknown_jump_begins_a_new_track(tmp_path: Path, lacking: str) -> None:
    rows = [{**row, lacking: ""} for row in jumped([1])]
    columns = COLUMNS + (RESETS[:1] if lacking == "columns" else RESETS)
    out = replay(write_log(tmp_path / "jump", table(rows, columns)), *PAPER)
    assert out[11]["status"] == "ok" and out[11]["z0_m"] != ""
    assert [(row["status"], row["z0_m"]) for row in out[12:19]] == [("converging", "")] * 7
    assert number(out[19], "z0_m") == pytest.approx(200.0 - 1.5 * 12, rel=2e-3)  # of the new track's first image


def test_a_jump_that_is_not_counted_is_taken_for_motion(tmp_path: Path, log: Path) -> None:
    """Only the counter reports a jump: an empty one is 0, as in the rows before."""
    plain = replay(log, *PAPER)
    for counts in ([""], [0], ["0"]):
        out = replay(write_log(tmp_path / "jump", table(jumped(counts), COLUMNS + RESETS)), *PAPER)
        assert quantities(out[:12]) == quantities(plain[:12]) and quantities(out[12:]) != quantities(plain[12:])


def test_a_jump_that_is_no_number(tmp_path: Path) -> None:
    rows = jumped([1], [(37.25, "nan", 3.0), JUMPED_M])
    out = replay(write_log(tmp_path, table(rows, COLUMNS + RESETS)), *PAPER)
    assert (out[12]["status"], out[13]["status"]) == ("not_finite", "ok")  # the jump is reported again


# ------------------------------------------------------------------------------------------------ class of the obstacle

KIND = ["kind_width_m", "kind_width_sd_m", "kind_height_m", "kind_height_sd_m", "kind_shape"]


def test_the_size_of_the_class_is_used(tmp_path: Path, log: Path) -> None:
    def out(**kind: Any) -> list[dict[str, str]]:
        rows = [{**row, **kind} for row in chimney()]
        return replay(write_log(tmp_path / "kind", table(rows, [*COLUMNS, *KIND])))

    assert out() == out(kind_width_m=0, kind_height_sd_m=2, kind_shape=0) == replay(log)
    without, size = (
        [row["z_m"] != "" for row in rows].index(True) for rows in (out(), out(kind_width_m=6, kind_width_sd_m=0.3))
    )
    assert size < without  # it gives an answer until images know the range
    assert out(kind_height_m=20, kind_height_sd_m=1)[-1] not in (without, size)
    assert (out()[-1]["model"], out(kind_shape=1)[-1]["model"]) == ("prism", "disc")


@pytest.mark.parametrize(
    ("column", "text", "reason"),
    [
        ("kind_width_m", "-1", "-1 is out of range: 0 to 1000"),
        ("kind_height_m", "nan", "nan is out of range: 0 to 1000"),
        ("kind_height_sd_m", "0.29", "0.29 is less than 1 % of kind_height_m"),
        ("kind_width_sd_m", "", "0 is less than 1 % of kind_width_m"),
        ("kind_shape", "3", "3 is no shape: 0 unknown, 1 round, 2 not round"),
        ("kind_shape", "round", "'round' is not an integer of 64 bits"),
    ],
)
def test_a_bad_kind_is_bad_input(tmp_path: Path, column: str, text: str, reason: str) -> None:
    good = dict(zip(KIND, ("6", "1", "30", "3", "1")))
    rows = [{**row, **good, **({column: text} if k == 5 else {})} for k, row in enumerate(chimney())]
    folder = write_log(tmp_path, table(rows, [*COLUMNS, *KIND]))
    assert call(folder, check=2).stderr == f"{folder}/frames.csv:7: {column}: {reason}\n"


# --------------------------------------------------------------------------------------------------- a second camera

SECOND_CAMERA = CAMERA.replace("camera.", "camera2.")


def by_camera(rows: Sequence[Row], number: Any, first: int = 0) -> list[Row]:
    """The same rows, from row ``first`` on taken by the camera of that number."""
    return [{**row, "camera": number if k >= first else ""} for k, row in enumerate(rows)]


@pytest.mark.parametrize("method", ["window", "filter"])
def test_a_second_camera_like_the_first_changes_nothing(tmp_path: Path, log: Path, method: str) -> None:
    rows = by_camera(chimney(), 1, first=12)
    folder = write_log(tmp_path / "two", table(rows, [*COLUMNS, "camera"]), CAMERA + SECOND_CAMERA)
    assert replay(folder, "--method", method) == replay(log, "--method", method)


@pytest.mark.parametrize("key", ["width = 850", "height = 820", "fx = 1100", "fy = 900", "cx = 900", "cy = 500",
    "k1 = 0.1", "k2 = 0.5", "p1 = 0.02", "p2 = 0.01", "k3 = 2", "mount_roll_deg = 3", "mount_pitch_deg = 2",
    "mount_yaw_deg = -4", "offset_x_m = 2", "offset_y_m = -1.5", "offset_z_m = 1"])  # fmt: skip
def test_each_key_of_the_second_camera_is_read(tmp_path: Path, key: str) -> None:
    """A log of the second camera alone gives the same output as a log with this camera as the only one."""
    columns, name, value = [*COLUMNS, *SIDES], *key.split(" = ")
    rows = [{**row, "qw": math.cos(0.1), "qx": math.sin(0.1)} for row in boxes()]  # rolled: no offset is straight down
    changed = camera_with(f"camera.{name}", value)
    plain = replay(write_log(tmp_path / "plain", table(rows, columns)))
    alone = replay(write_log(tmp_path / "alone", table(rows, columns), changed))
    two = table(by_camera(rows, 1), [*columns, "camera"]), CAMERA + changed.replace("camera.", "camera2.")
    out = replay(write_log(tmp_path / "two", *two))
    assert out == alone != plain


@pytest.mark.parametrize("numbers", [("", ""), ("0", "0"), ("0", "")])
def test_the_first_camera_is_the_default(tmp_path: Path, log: Path, numbers: tuple[str, str]) -> None:
    other = camera_with("camera.fx", "500").replace("camera.", "camera2.")
    rows = [{**row, "camera": numbers[k % 2]} for k, row in enumerate(chimney())]
    for camera in (CAMERA, CAMERA + other):
        assert replay(write_log(tmp_path / "log", table(rows, [*COLUMNS, "camera"]), camera)) == replay(log)


def test_the_second_camera_is_no_other_track(tmp_path: Path) -> None:
    """Rows of one time are images of one track, in the order of the cameras; in another order the second is refused."""
    first, second = by_camera(chimney(), 0), by_camera(chimney(), 1)
    rows = [row for pair in zip(first, second) for row in pair]
    out = replay(write_log(tmp_path / "in_order", table(rows, [*COLUMNS, "camera"]), CAMERA + SECOND_CAMERA))
    assert "bad_time" not in {row["status"] for row in out} and out[-1]["status"] == "ok"
    rows = [row for pair in zip(second, first) for row in pair]
    out = replay(write_log(tmp_path / "exchanged", table(rows, [*COLUMNS, "camera"]), CAMERA + SECOND_CAMERA))
    assert {row["status"] for row in out[1::2]} == {"bad_time"} and out[-2]["status"] == "ok"


@pytest.mark.parametrize(("number", "cameras"), [("1", 1), ("2", 2), ("-1", 2), ("256", 2), ("257", 2), ("0x1", 2)])
def test_a_camera_that_is_not_described_is_bad_input(tmp_path: Path, number: str, cameras: int) -> None:
    rows = by_camera(chimney(), number, first=7)
    camera = CAMERA + (SECOND_CAMERA if cameras == 2 else "")
    folder = write_log(tmp_path / "log", table(rows, [*COLUMNS, "camera"]), camera)
    described = f"there is no camera {number}, the camera file describes 0 {'and 1' if cameras == 2 else 'alone'}"
    reason = "'0x1' is not an integer of 64 bits" if number == "0x1" else described
    assert call(folder, check=2).stderr == f"{folder}/frames.csv:9: camera: {reason}\n"


# --------------------------------------------------------------------------------------- bad measurements: a status


@pytest.mark.parametrize("empty", ["left_u", "left_v"])
def test_half_a_point_is_not_visible(tmp_path: Path, empty: str) -> None:
    rows = chimney()
    rows[15][empty] = ""
    out = replay(write_log(tmp_path, table(rows)), *PAPER)
    assert (out[15]["status"], out[15]["z0_m"]) == ("stale", out[14]["z0_m"])
    assert out[16]["status"] == "ok"


@pytest.mark.parametrize("column", ["n_m", "agl_m", "qw", "left_u", "right_v", "top_u"])
@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "NaN", "1e60", "-1e999"])
def test_number_that_is_not_finite(tmp_path: Path, column: str, text: str) -> None:
    rows = chimney()
    rows[15][column] = text
    out = replay(write_log(tmp_path, table(rows)))
    assert out[15]["status"] == "not_finite"
    assert (out[15]["model"], out[15]["z0_m"]) == ("prism", out[14]["z0_m"])
    assert out[16]["status"] == "ok"


@pytest.mark.parametrize("column", ["n_m", "e_m", "d_m", "qw", "qx", "qy", "qz"])
def test_missing_pose(tmp_path: Path, column: str) -> None:
    rows = chimney()
    rows[15][column] = ""
    out = replay(write_log(tmp_path, table(rows)))
    assert (out[15]["status"], out[16]["status"]) == ("not_finite", "ok")


@pytest.mark.parametrize("text", ["nan", "inf", "-1e30", "1e300", "9.3e12", "1.40", "0.3", "-5"])
def test_bad_time(tmp_path: Path, text: str) -> None:
    rows = chimney()
    rows[15]["t_s"] = text
    out = replay(write_log(tmp_path, table(rows)))
    assert (out[15]["t_s"], out[15]["status"]) == (text, "bad_time")
    assert out[16]["status"] == "ok"


def test_boxes_of_one_side_alone(tmp_path: Path) -> None:
    rows = [{**row, **{name: "" for name in SIDES[1:]}} for row in boxes(6)]
    done = call(write_log(tmp_path, table(rows, COLUMNS + SIDES)), check=1)
    assert "no row gave an estimate (box_incomplete: 6)" in done.stderr


def test_a_height_of_zero_with_a_box_is_none(tmp_path: Path) -> None:
    """This is reported, and the height counts as unknown: the bottom of the box measures no range."""
    rows = boxes(20)
    plain = replay(write_log(tmp_path / "plain", table(rows, COLUMNS + SIDES)))
    bare = [{**row, "agl_m": 0} for row in rows]
    out = replay(write_log(tmp_path / "bare", table(bare, COLUMNS + SIDES)))
    assert out[0]["status"] == "no_height" and {row["status"] for row in out[1:]} <= {"no_height", "partial"}
    assert "partial" not in {row["status"] for row in plain[5:]}
    assert number(out[-1], "z_sd_m") > number(plain[-1], "z_sd_m")


@pytest.mark.parametrize("q", ["0.98", "0", "1.02"])
def test_bad_attitude(tmp_path: Path, q: str) -> None:
    rows = chimney()
    rows[15]["qw"] = q
    out = replay(write_log(tmp_path, table(rows)))
    assert (out[15]["status"], out[16]["status"]) == ("bad_attitude", "ok")


# -------------------------------------------------------------------------------------------------- bad input: exit 2


def edited(row: int, **changes: Any) -> str:
    rows = chimney()
    rows[row].update(changes)
    return table(rows)


def edited_line(line: int, old: str, new: str) -> str:
    lines = table(chimney()).splitlines()
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new)
    return "\n".join(lines) + "\n"


def with_columns(drop: str = "", add: str = "") -> str:
    return table(chimney(), [name for name in COLUMNS if name != drop] + ([add] if add else []))


def with_side(text: str) -> list[Row]:
    """Boxes, with a text as the top of the fifth one."""
    rows = [{**row, **dict(zip(SIDES, (800.0, 300.0, 820.0, 900.0)))} for row in chimney()]
    rows[4]["box_top_px"] = text
    return rows


BAD_FRAMES = [
    ("empty file", "", 1, "t_s", "missing column"),
    ("blank file", "\n\n \r\n", 1, "t_s", "missing column"),
    *[(f"no {name}", with_columns(drop=name), 1, name, "missing column") for name in POSE if name != "agl_m"],
    *[(f"no {p}_{a}", with_columns(drop=f"{p}_{a}"), 1, f"{p}_{a}", "missing column") for p in POINTS for a in "uv"],
    ("column twice", with_columns(add="left_u"), 1, "left_u", "twice"),
    ("header after blank lines", "\n\n" + with_columns(drop="qz"), 3, "qz", "missing column"),
    ("text", edited(4, left_u="12 px"), 6, "left_u", "'12 px' is not a number"),
    ("decimal comma in quotes", edited(4, n_m='"1,5"'), 6, "n_m", "'1,5' is not a number"),
    ("hexadecimal", edited(4, qw="0x1"), 6, "qw", "'0x1' is not a number"),
    ("nan with text", edited(4, qw="nan(1)"), 6, "qw", "not a number"),
    ("control characters", edited(4, qw="\x1b[31m1"), 6, "qw", "'?[31m1' is not a number"),
    ("endless text", edited(4, qw="x" * 5000), 6, "qw", "xxx...' is not a number"),
    ("NUL", edited(4, qw="1\0"), 6, "qw", "holds a NUL byte"),
    (
        "NUL in a column of no meaning",
        table([{**r, "note": "\0"} for r in chimney()], [*COLUMNS, "note"]),
        2,
        "note",
        "NUL",
    ),
    ("NUL in the header", "\0" + table(chimney()), 1, "", "the header holds a NUL byte"),
    ("no time", edited(4, t_s=""), 6, "t_s", "not a number"),
    ("text for a time", edited(4, t_s="noon"), 6, "t_s", "not a number"),
    ("endless time", edited(4, t_s="0." + "3" * 70), 6, "t_s", "longer than 63 characters"),
    ("no id", edited(4, id=""), 6, "id", "not an integer"),
    ("fraction for an id", edited(4, id="1.0"), 6, "id", "not an integer"),
    ("huge id", edited(4, id="9223372036854775808"), 6, "id", "not an integer"),
    (
        "too few fields",
        table(chimney()).replace("\n0.40,1,", "\n0.40,"),
        6,
        "base_right_v",
        "21 fields, the header has",
    ),
    ("too many fields", table(chimney()).replace("\n0.40,1,", "\n0.40,1,1,"), 6, "base_right_v", "23 fields"),
    ("cut off", table(chimney())[:-60], 21, "", "the row ends before this column"),
    ("cut off in its last number", table(box())[:-2], 41, "base_right_v", "the file ends without a line break"),
    ("cut off behind its last number", table(box())[:-1], 41, "base_right_v", "the file ends without a line break"),
    ("cut off in the header", table([])[:-1], 1, "base_right_v", "the file ends without a line break"),
    ("quote inside a field", edited(4, qx='0"0'), 6, "qx", "quote"),
    ("quote not closed", edited(4, qx='"0'), 6, "qx", "quote"),
    (
        "line counted through quotes",
        table([{**r, "note": '"a\nb"'} for r in chimney()], [*COLUMNS, "note"]) + "x\n",
        42,
        "id",
        "the row ends before this column",
    ),
    ("text for a side", table(with_side("wide"), COLUMNS + SIDES), 6, "box_top_px", "'wide' is not a number"),
    ("side twice", with_columns(add="box_top_px,box_top_px"), 1, "box_top_px", "twice"),
    ("text for a jump", table(jumped([1], [("x", 0, 0)]), COLUMNS + RESETS), 14, "reset_n_m", "'x' is not a number"),
    ("text for a count", table(jumped(["one"]), COLUMNS + RESETS), 14, "reset_count", "'one' is not an integer"),
    ("fraction for a count", table(jumped(["1.0"]), COLUMNS + RESETS), 14, "reset_count", "'1.0' is not an integer"),
    ("camera twice", with_columns(add="camera,camera"), 1, "camera", "twice"),
    ("a jump without a count", with_columns(add="reset_e_m"), 1, "reset_count", "missing column, reset_e_m is there"),
    ("CRLF", edited(4, left_u="?").replace("\n", "\r\n"), 6, "left_u", "'?' is not a number"),
    ("CR alone", table(chimney()).replace("\n", "\r"), 1, "", ""),
    ("semicolons", table(chimney()).replace(",", ";"), 1, "t_s", "missing column"),
]


@pytest.mark.parametrize(
    ("frames", "line", "column", "reason"), [pytest.param(*case[1:], id=case[0]) for case in BAD_FRAMES]
)
def test_bad_frames(tmp_path: Path, frames: str, line: int, column: str, reason: str) -> None:
    folder = write_log(tmp_path / "log", frames)
    out = tmp_path / "out.csv"
    message = call("--out", out, folder, check=2).stderr
    assert message.startswith(f"{folder}/frames.csv:{line}: {column}")
    assert reason in message
    assert message.count("\n") == 1 and len(message) < 500 and message.rstrip("\n").isprintable()
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def camera_with(key: str, value: Optional[str]) -> str:
    lines = [line for line in CAMERA.splitlines() if not line.startswith(key + " ")]
    return "\n".join(lines + ([f"{key} = {value}"] if value is not None else [])) + "\n"


BAD_CAMERA = [
    ("empty file", "", 1, "camera.width: missing key"),
    *[
        (f"no {key}", camera_with(f"camera.{key}", None), 6, f"camera.{key}: missing key")
        for key in ("width", "height", "fx", "fy", "cx", "cy")
    ],
    ("unknown key", CAMERA + "camera.k4 = 0\n", 8, "camera.k4: unknown key; did you mean camera.k1?"),
    ("key twice", CAMERA + "camera.fx = 1000\n", 8, "camera.fx: the key appears twice, first in line 4"),
    ("unit", camera_with("camera.fx", "1000 px"), 7, "camera.fx: '1000 px' is not a number"),
    ("no value", camera_with("camera.fx", ""), 7, "camera.fx: '' is not a number"),
    ("auto where it is not allowed", camera_with("camera.fx", "auto"), 7, "camera.fx: 'auto' is not a number"),
    ("nan", camera_with("camera.k1", "nan"), 8, "camera.k1: out of range: -100 to 100"),
    ("huge", camera_with("camera.k1", "1e99"), 8, "camera.k1: out of range"),
    ("zero focal length", camera_with("camera.fy", "0"), 7, "camera.fy: out of range"),
    ("image without size", camera_with("camera.height", "0"), 7, "camera.height: out of range: 1 to 100000"),
    ("image too large", camera_with("camera.width", "100001"), 7, "camera.width: out of range"),
    ("lever arm", camera_with("camera.offset_z_m", "20000"), 8, "camera.offset_z_m: out of range"),
    ("heading", camera_with("trajectory.heading_deg", "north"), 8, "trajectory.heading_deg: 'north' is not a number"),
    ("heading out of range", camera_with("trajectory.heading_deg", "361"), 8, "trajectory.heading_deg: out of range"),
    *[
        (
            f"no {key} of the second",
            CAMERA + camera_with(f"camera.{key}", None).replace("camera.", "camera2."),
            13,
            f"camera2.{key}: missing key",
        )
        for key in ("width", "height", "fx", "fy", "cx", "cy")
    ],
    ("one key of the second", CAMERA + "camera2.mount_yaw_deg = 30\n", 8, "camera2.width: missing key"),
    ("a second camera alone", CAMERA.replace("camera.", "camera2."), 7, "camera.width: missing key"),
    ("no heading of a second camera", CAMERA + "camera2.heading_deg = 3\n", 8, "camera2.heading_deg: unknown key"),
    ("a third camera", CAMERA + CAMERA.replace("camera.", "camera3."), 9, "camera3.width: unknown key"),
    (
        "second twice",
        CAMERA + "camera2.k1 = 0\ncamera2.k1 = 0\n",
        9,
        "camera2.k1: the key appears twice, first in line 8",
    ),
    ("text for the second", CAMERA + "camera2.fx = wide\n", 8, "camera2.fx: 'wide' is not a number"),
    *[
        (
            f"{text} of the second",
            CAMERA + camera_with(f"camera.{name}", text).replace("camera.", "camera2."),
            line,
            f"camera2.{name}: out of range",
        )
        for name, text, line in (("fx", "0", 14), ("fy", "-1", 14), ("height", "0", 14), ("k1", "nan", 15))
    ],
    ("no equals sign", CAMERA + "camera.k1 0.1\n", 8, "'camera.k1 0.1' is not of the form"),
    ("no key", CAMERA + "= 0.1\n", 8, "'= 0.1' is not of the form"),
    ("colon", CAMERA + "camera.k1: 0.1\n", 8, "unexpected ':'"),
    ("section", "[camera]\n" + CAMERA, 1, "unexpected '['"),
    ("semicolon comment", CAMERA + "; camera.k1 = 0.1\n", 8, "unexpected ';'"),
    ("indented line is no continuation", CAMERA + "  1001\n", 8, "'1001' is not of the form"),
    ("long line", CAMERA + "camera.k1 = 0." + "0" * 5000 + "\n", 8, "the line is longer than"),
    ("NUL", CAMERA + "camera.k1 = 0\0\n", 8, "the line holds a NUL byte"),
]


@pytest.mark.parametrize(("camera", "line", "reason"), [pytest.param(*case[1:], id=case[0]) for case in BAD_CAMERA])
def test_bad_camera(tmp_path: Path, camera: str, line: int, reason: str) -> None:
    folder = write_log(tmp_path, table(chimney()), camera)
    message = call(folder, check=2).stderr
    assert message.startswith(f"{folder}/camera.ini:{line}: {reason}")
    assert message.count("\n") == 1


@pytest.mark.parametrize("name", ["camera.ini", "frames.csv"])
def test_missing_file_and_folder_in_its_place(log: Path, name: str) -> None:
    (log / name).unlink()
    assert call(log, check=2).stderr == f"{log}/{name}: cannot be opened: No such file or directory\n"
    (log / name).mkdir()
    assert call(log, check=2).stderr == f"{log}/{name}: cannot be read: Is a directory\n"


BAD_USAGE = [
    (["--window", "2"], "--window: must be 3 to 64, not 2"),
    (["--window", "65"], "--window: must be 3 to 64"),
    (["--window=-8"], "--window: must be 3 to 64"),
    (["--window", "x"], "--window: invalid numeric value 'x'"),
    (["--window"], "--window: missing argument"),
    (["--model", "box"], "box: --model must be auto, disc or line ("),
    (["--model", "dics"], "dics: --model must be auto, disc or line; did you mean disc?"),
    (["--model", ""], "--model must be auto, disc or line"),
    (["--method", "magic"], "magic: --method must be filter or window ("),
    (["--method", "widnow"], "widnow: --method must be filter or window; did you mean window?"),
    (["--method", "refined"], "--method refined: unknown value: now --method filter ("),
    (["--set", "navigation.slope=0.1"], "--set: unknown setting navigation.slope: now navigation.terrain_slope_sd"),
    (["--set", "refined.gate_sigma=4"], "--set: unknown setting refined.gate_sigma: now filter.gate_sigma"),
    (["--set"], "--set: missing argument"),
    (["--set", ""], "--set: '' is no setting; there are navigation.attitude_bias_sd_deg, "),
    (["--set", "box_noise_px=1"], "--set: 'box_noise_px' is no setting; did you mean detector.box_noise_px?"),
    (["--set", "pixel_px=1"], "--set: 'pixel_px' is no setting; there are navigation.attitude_bias_sd_deg, "),
    (["--set", "detector.point_p=1"], "--set: 'detector.point_p' is no setting; did you mean detector.point_noise_px?"),
    (
        ["--set", "detector.pixel_noise=1"],
        "--set: 'detector.pixel_noise' is no setting; did you mean detector.point_noise_px?",
    ),
    (["--metohd", "window"], "--metohd: unknown option; did you mean --method?"),
    (["--something-else"], "--something-else: unknown option ("),
    (["--set", "something.else=1"], "orientation_memory and window.min_baseline_m"),
    (["--set", "window=5"], "--set: 'window' is no setting"),
    (["--set", "camera.fx_px=5"], "--set: 'camera.fx_px' is no setting here; the camera has its own file or section"),
    (["--set", "\x1b[31m=5"], "--set: '?[31m' is no setting"),
    (
        ["--set", "detector.point_noise_px"],
        "--set: detector.point_noise_px: no value; write detector.point_noise_px=VALUE",
    ),
    (["--set", "detector.point_noise_px="], "--set: detector.point_noise_px: '' is not a number"),
    (["--set", "detector.point_noise_px=0.5px"], "--set: detector.point_noise_px: '0.5px' is not a number"),
    (["--set", "detector.point_noise_px= 1"], "--set: detector.point_noise_px: ' 1' is not a number"),
    (["--set", "detector.point_noise_px=1=1"], "--set: detector.point_noise_px: '1=1' is not a number"),
    (["--set", "detector.point_noise_px=" + "9" * 400 + "x"], "9...' is not a number"),
    (["--set", "detector.point_noise_px=nan"], "--set: detector.point_noise_px: out of range: 0.05 to 100"),
    (["--set", "detector.point_noise_px=1e99"], "--set: detector.point_noise_px: out of range: 0.05 to 100"),
    (["--set", "detector.point_correlation=1"], "--set: detector.point_correlation: out of range: 0 to 0.95"),
    (
        ["--set", "filter.gate_sigma=4", "--set", "filter.prior_width_m=-6"],
        "--set: filter.prior_width_m: out of range: 0.1 to 1000",
    ),
    (["--set", "window.line_points=2.5"], "--set: window.line_points: '2.5' is not a whole number"),
    (["--set", "window.line_points=nan"], "--set: window.line_points: 'nan' is not a whole number"),
    (["--set", "window.orientation_memory=0"], "--set: window.orientation_memory: out of range: 1 to 1000"),
    (["--set", "filter.top_is_highest=2"], "--set: filter.top_is_highest: '2' is not 0 or 1"),
    (["--set", "filter.top_is_highest=yes"], "--set: filter.top_is_highest: 'yes' is not a number"),
    (["--wat"], "--wat: unknown option"),
    (["another"], "another: one folder at a time"),
]


@pytest.mark.parametrize(("options", "reason"), BAD_USAGE)
def test_bad_usage(log: Path, options: list[str], reason: str) -> None:
    done = call(log, *options, check=2)
    assert done.stdout == ""
    assert reason in done.stderr and done.stderr.startswith("goe_replay: ")
    assert done.stderr.count("\n") == 1


def test_no_arguments() -> None:
    assert "name the log's folder" in call(check=2).stderr


def test_set_without_a_value_takes_the_folder(log: Path) -> None:
    assert f"--set: '{str(log)[:3]}" in call("--set", log, check=2).stderr


def test_help_and_version() -> None:
    text = call("--help").stdout
    for option in (
        *("--method", "--model", "--window", "--set", "--residuals"),
        *("--out", "--camera", "--frames", "--version"),
        *(f"{name}={value}" for name, value in SETTINGS.items()),
    ):
        assert option in text
    assert max(map(len, text.splitlines())) <= 120
    assert call("--version").stdout.startswith("goe_replay ")


# ------------------------------------------------------------------------------------------------ exit 1: no estimate


def test_header_alone(tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    done = call("--out", out, write_log(tmp_path / "log", table([])), check=1)
    assert out.read_text() == HEADER + "\n"
    assert "there are no rows" in done.stderr


def test_no_row_gave_an_estimate(tmp_path: Path) -> None:
    done = call(*PAPER, write_log(tmp_path, table(chimney(7))), check=1)
    assert len(done.stdout.splitlines()) == 8
    assert "no row gave an estimate (converging: 7)" in done.stderr
    done = call(write_log(tmp_path, table([pose_row(0.1 * k, 1.5 * k) for k in range(7)])), check=1)
    assert len(done.stdout.splitlines()) == 8
    assert "no row gave an estimate (no_detection: 7); is there a column of a box" in done.stderr


# ------------------------------------------------------------------------------------------------------------- output


def test_out_receives_the_standard_output(tmp_path: Path, log: Path) -> None:
    out = tmp_path / "out.csv"
    done = call("--out", out, log)
    assert (done.stdout, done.stderr) == ("", "")
    assert out.read_text() == call(log).stdout
    mask = os.umask(0)
    os.umask(mask)
    assert out.stat().st_mode & 0o777 == 0o666 & ~mask
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log", "out.csv"]


def test_out_in_the_working_directory(tmp_path: Path, log: Path) -> None:
    subprocess.run([PROGRAM, "-o", "out.csv", str(log)], cwd=tmp_path, check=True)
    assert (tmp_path / "out.csv").read_text() == call(log).stdout


def test_out_replaces_a_file_only_when_all_is_well(tmp_path: Path, log: Path) -> None:
    out = tmp_path / "out.csv"
    out.write_text("previous content\n")
    out.chmod(0o640)
    bad = write_log(tmp_path / "bad", edited(18, left_u="?"))
    call("--out", out, bad, check=2)
    assert out.read_text() == "previous content\n"
    call("--out", out, log)
    assert out.read_text() == call(log).stdout
    assert out.stat().st_mode & 0o777 == 0o640
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad", "log", "out.csv"]


def test_out_through_a_symbolic_link(tmp_path: Path, log: Path) -> None:
    (tmp_path / "real").mkdir()
    real, link = tmp_path / "real" / "out.csv", tmp_path / "link.csv"
    real.write_text("before\n")
    link.symlink_to(real)
    call("--out", link, log)
    assert link.is_symlink() and real.read_text() == call(log).stdout


@pytest.mark.parametrize("way", ["itself", "symbolic link", "hard link", "other folder"])
@pytest.mark.parametrize("name", ["frames.csv", "camera.ini", "truth.csv"])
def test_out_never_replaces_the_log(tmp_path: Path, log: Path, name: str, way: str) -> None:
    (log / "truth.csv").write_text("id,static\n1,1\n")
    before, out = (log / name).read_bytes(), log / name
    if way == "symbolic link":
        out = tmp_path / "link"
        out.symlink_to(log / name)
    elif way == "hard link":
        out = tmp_path / "link"
        os.link(log / name, out)
    words = ["--camera", log / "camera.ini", "--frames", log / "frames.csv"] if way == "other folder" else [log]
    assert "would replace the log" in call("--out", out, *words, check=2).stderr
    assert (log / name).read_bytes() == before and out.is_symlink() == (way == "symbolic link")


def test_out_through_a_link_that_leads_nowhere(tmp_path: Path, log: Path) -> None:
    """The link is not replaced, and no file is made at its target."""
    link = tmp_path / "link.csv"
    link.symlink_to(tmp_path / "nowhere.csv")
    assert f"{link}: cannot be written: No such file" in call("--out", link, log, check=2).stderr
    assert link.is_symlink() and sorted(path.name for path in tmp_path.iterdir()) == ["link.csv", "log"]


def test_out_makes_the_folders_on_its_way(tmp_path: Path, log: Path) -> None:
    call("--out", tmp_path / "no" / "such" / "out.csv", log)
    assert (tmp_path / "no" / "such" / "out.csv").read_text() == call(log).stdout


def test_out_that_cannot_be_written(tmp_path: Path, log: Path) -> None:
    assert "Not a directory" in call("--out", log / "frames.csv" / "out.csv", log, check=2).stderr
    assert "cannot be written: Is a directory" in call("--out", tmp_path, log, check=2).stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_full_disk(log: Path) -> None:
    assert "No space left" in call("--out", "/dev/full", log, check=2).stderr
    with open("/dev/full", "w", encoding="ascii") as full:
        done = subprocess.run([PROGRAM, str(log)], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2 and "standard output: cannot be written: No space left" in done.stderr


def test_file_size_limit_leaves_nothing(tmp_path: Path, log: Path) -> None:
    out = tmp_path / "out.csv"
    command = f'ulimit -f 1; exec "{PROGRAM}" --out "{out}" "{log}"'
    write_log(log, table(chimney(120)))
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "File too large" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_closed_pipe(log: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([PROGRAM, str(log)], stdout=writer, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writer)
    assert done.returncode == 2 and "Broken pipe" in done.stderr


@pytest.mark.parametrize("number_of_signal", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_interrupt_leaves_nothing(tmp_path: Path, log: Path, number_of_signal: signal.Signals) -> None:
    out = tmp_path / "out.csv"
    arguments = [PROGRAM, "--out", str(out), "--camera", str(log / "camera.ini"), "--frames", "/dev/stdin"]
    with subprocess.Popen(arguments, stdin=subprocess.PIPE, text=True) as running:
        assert running.stdin is not None
        running.stdin.write(table(chimney()))
        running.stdin.flush()
        until = time.monotonic() + HANG_S
        while len(list(tmp_path.iterdir())) < 2:  # the temporary file exists
            if time.monotonic() > until:
                raise TimeoutError
            assert running.poll() is None
            time.sleep(0.01)
        assert not out.exists()
        running.send_signal(number_of_signal)
        assert running.wait(timeout=HANG_S) == -number_of_signal
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


# -------------------------------------------------------------------------------------------------------------- size

ROWS = 300_000  # four bytes kept of each would exceed the limit below


def full_rows() -> list[str]:
    """The rows of one track with every column filled, without t_s and id."""
    frames = zip(box(40), chimney(40, north_m=260.0, east_m=-45.0))
    filled = [{**corners, **{k: v for k, v in disc.items() if v != ""}} for corners, disc in frames]
    assert all(row[column] != "" for row in filled for column in COLUMNS)
    return [",".join(str(row[column]) for column in COLUMNS[2:]) for row in filled]


def peak_memory_kib(process: int) -> int:
    for line in Path(f"/proc/{process}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1])
    raise AssertionError("no VmHWM")


def stream(folder: Path, rows: int) -> tuple[int, float]:
    """Feeds rows through a pipe. Returns the peak memory in KiB before the pipe is closed, and the processor time in
    s."""
    tails = full_rows()
    camera = write_log(folder, "").joinpath("camera.ini")
    arguments = [PROGRAM, "--out", "/dev/null", "--camera", str(camera), "--frames", "/dev/stdin"]
    with subprocess.Popen(arguments, stdin=subprocess.PIPE) as running:
        assert running.stdin is not None
        running.stdin.write((",".join(COLUMNS) + "\n").encode())
        for track in range(0, rows, len(tails)):  # ten ids; each starts again after a while, at a later time
            name = track // len(tails) % 10
            text = "".join(f"{(track + k) / 10:.1f},{name},{tail}\n" for k, tail in enumerate(tails))
            running.stdin.write(text.encode())
        running.stdin.flush()
        memory = peak_memory_kib(running.pid)
        running.stdin.close()
        _, status, usage = os.wait4(running.pid, 0)
        running.returncode = os.waitstatus_to_exitcode(status)
    assert running.returncode == 0
    return memory, usage.ru_utime + usage.ru_stime


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs /proc to measure memory")
def test_memory_does_not_grow_with_the_rows(tmp_path: Path) -> None:
    """At most 1 MiB more for twenty times the rows."""
    little, _ = stream(tmp_path, ROWS // 20)
    much, _ = stream(tmp_path, ROWS)
    assert much < little + 1024
