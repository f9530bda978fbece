"""goe_sim --scenario: several obstacles in one flight."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from sim_support import run

FLIGHT = """# a mast, a building and a truck
[flight]
speed = 18
run = 6
reach = 15
altitude = 30
features = boxes
noise = detector
yaw-camera = 0
"""
MAST = "[obstacle 1]\nwhat = disc:4,50\nx0 = 8\n"
BUILDING = "[obstacle 2]\nwhat = building\nx0 = -60\nz0 = 320\nalpha = 20\n"
TRUCK = "[obstacle 3]\nwhat = truck\nx0 = -5\nz0 = 250\n"
SAME = ("--speed", 18, "--run", 6, "--reach", 15, "--altitude", 30, "--features", "boxes", "--noise", "detector")
ALONE = (*SAME, "--yaw-camera", 0, "--obstacle", "disc:4,50", "--x0", 8)
POSE = ("t_s", "n_m", "e_m", "d_m", "agl_m", "qw", "qx", "qy", "qz")
SIDES = ("box_left_px", "box_top_px", "box_right_px", "box_bottom_px")


def rows(folder: Path, name: str = "frames.csv") -> dict[int, list[dict[str, str]]]:
    """Rows by track."""
    tracks: dict[int, list[dict[str, str]]] = {}
    with (folder / name).open(newline="") as file:
        for row in csv.DictReader(file):
            tracks.setdefault(int(row["id"]), []).append(row)
    return tracks


def numbers(track: list[dict[str, str]], names: tuple[str, ...]) -> np.ndarray:
    return np.array([[float(row[name] or "nan") for name in names] for row in track])


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "three.ini"
    path.write_text(text)
    return path


def test_one_obstacle_is_the_command_line_s_flight(goe_sim: Path, tmp_path: Path) -> None:
    run(goe_sim, "--scenario", write(tmp_path, FLIGHT + MAST), "--out", tmp_path / "file")
    run(goe_sim, *ALONE, "--out", tmp_path / "line")
    for path in (tmp_path / "line").iterdir():
        assert path.read_bytes() == (tmp_path / "file" / path.name).read_bytes()


def test_others_change_nothing_of_the_first(goe_sim: Path, tmp_path: Path) -> None:
    run(goe_sim, "--scenario", write(tmp_path, FLIGHT + MAST + BUILDING + TRUCK), "--out", tmp_path / "three")
    run(goe_sim, *ALONE, "--out", tmp_path / "one")
    three, alone = rows(tmp_path / "three"), rows(tmp_path / "one")
    assert list(three) == [1, 2, 3] and three[1] == alone[1]
    assert all(np.array_equal(numbers(three[i], POSE), numbers(three[1], POSE)) for i in (2, 3))


def test_each_is_logged_as_in_a_flight_past_it_alone(goe_sim: Path, tmp_path: Path) -> None:
    """Exact boxes of the second obstacle. The path is straight: the same past any obstacle."""
    run(goe_sim, "--scenario", write(tmp_path, FLIGHT + MAST + BUILDING), "--out", tmp_path / "two")
    alone = (*SAME, "--yaw-camera", 0, "--obstacle", "building", "--x0", -60, "--z0", 320, "--alpha", 20)
    run(goe_sim, *alone, "--out", tmp_path / "one")
    logged, expected = rows(tmp_path / "two", "truth_frames.csv")[2], rows(tmp_path / "one", "truth_frames.csv")[1]
    assert np.allclose(numbers(logged, SIDES), numbers(expected, SIDES), rtol=0, atol=1e-9, equal_nan=True)
    truth, single = rows(tmp_path / "two", "truth.csv")[2][0], rows(tmp_path / "one", "truth.csv")[1][0]
    assert {key: truth[key] for key in single if key != "id"} == {key: single[key] for key in single if key != "id"}


def test_errors_are_each_obstacle_s_own(goe_sim: Path, tmp_path: Path) -> None:
    twin = MAST.replace("obstacle 1", "obstacle 2") + "z0 = 270\n"
    run(goe_sim, "--scenario", write(tmp_path, FLIGHT + MAST + twin), "--out", tmp_path / "log")
    tracks, exact = rows(tmp_path / "log"), rows(tmp_path / "log", "truth_frames.csv")
    assert np.allclose(numbers(exact[1], SIDES), numbers(exact[2], SIDES), rtol=0, atol=1e-9)
    error = [numbers(tracks[i], SIDES) - numbers(exact[i], SIDES) for i in (1, 2)]
    assert abs(np.corrcoef(error[0].ravel(), error[1].ravel())[0, 1]) < 0.5 and np.abs(error[1]).max() > 0.1


def test_an_option_goes_before_the_file(goe_sim: Path, tmp_path: Path) -> None:
    file = write(tmp_path, FLIGHT + MAST + TRUCK.replace("3", "2"))
    run(goe_sim, "--speed", 20, "--scenario", file, "--fps", 4, "--out", tmp_path / "log")
    time_north = numbers(rows(tmp_path / "log")[2], ("t_s", "n_m"))
    assert time_north[-1] == pytest.approx((6.0, 120.0), abs=0.5) and len(time_north) == 25


def test_the_flight_ends_at_any_of_them(goe_sim: Path, tmp_path: Path) -> None:
    wall = "[obstacle 2]\nwhat = box:50,10,60\nx0 = 0\nz0 = 60\n"
    done = run(goe_sim, "--scenario", write(tmp_path, FLIGHT + MAST + wall), "--out", tmp_path / "log", expect=1)
    tracks = rows(tmp_path / "log")
    assert "flew into the obstacle" in done.stderr
    assert len(tracks[1]) == len(tracks[2]) and float(tracks[1][-1]["n_m"]) < 55.0


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("speed = 18", "sped = 18", "3: sped: unknown option; did you mean speed?"),
        ("speed = 18", "speed = fast", "3: speed: invalid numeric value 'fast'"),
        ("speed = 18", "wind = storm", "3: wind: 'storm' cannot be taken: none, dryden:light or dryden:moderate"),
        ("speed = 18", "speed = 88", "3: speed: the aircraft flies 12 to 28 m/s"),
        ("speed = 18", "speed = 18\npixel-noise = -1", "4: pixel-noise: a noise figure must be 0 to 1e6"),
        ("speed = 18", "speed = 18\nfy = 0", "4: fx, fy: the focal length must be 1 to 100000 px"),
        ("x0 = 8", "x0 = 1e9", "12: x0: must lie within"),
        ("speed = 18", "speed", "3: a line is [section] or key = value"),
        ("speed = 18", "out = elsewhere", "3: out: belongs on the command line"),
        ("z0 = 320\n", "", "14: [obstacle 2]: z0 is missing"),
        ("what = building\n", "", "14: [obstacle 2]: the kind of obstacle (what) is missing"),
        ("what = building", "what = castle", "14: what: 'castle' is not cylinder, building"),
        ("z0 = 320", "z0 = far", "16: z0: 'far' is not a number"),
        ("z0 = 320", "z0 = 1e9", "14: [obstacle 2]: x0 and z0: must lie within"),
        ("[obstacle 2]", "[obstacle 4]", "14: what: obstacle 4 comes before obstacle 3"),
        ("[obstacle 2]", "[obstacle two]", "14: what: [obstacle two] is neither [flight] nor"),
        ("speed = 18", "speed =", "3: speed: no value"),
        ("x0 = 8", "x0 =", "12: x0: no value"),
        ("what = disc:4,50", "what = castle", "11: what: 'castle' is not cylinder"),
        ("[obstacle 2]", "[obstacle 2", "13: a line is [section] or key = value"),
        ("alpha = 20", "z0 = 310", "17: z0: [obstacle 2] has it twice, first in line 16"),
        ("[obstacle 3]", "[obstacle 2]", "19: what: [obstacle 2] has it twice, first in line 14"),
        (MAST, "", "11: what: obstacle 2 comes before obstacle 1"),
        ("alpha = 20", f"alpha = {'1' * 300}", "17: the line is longer than"),
        ("alpha = 20", "paint = 20", "17: paint: an obstacle has what, x0, z0 and alpha"),
    ],
)
def test_a_bad_file(goe_sim: Path, tmp_path: Path, old: str, new: str, fault: str) -> None:
    text = FLIGHT + MAST + BUILDING + TRUCK
    assert old in text
    file = write(tmp_path, text.replace(old, new))
    done = run(goe_sim, "--scenario", file, "--out", tmp_path / "log", expect=2)
    assert done.stderr.startswith(f"goe_sim: {file}:{fault}"), done.stderr
    assert not (tmp_path / "log").exists()


def test_a_bad_option_on_top_of_a_file_is_not_blamed_on_it(goe_sim: Path, tmp_path: Path) -> None:
    file, out = write(tmp_path, FLIGHT + MAST), tmp_path / "log"
    for words, fault in (
        (("--speed", "88"), "goe_sim: cannot fly: speed: the aircraft flies 12 to 28 m/s\n"),
        (("--noise=fields",), "goe_sim: --noise: 'fields' cannot be taken: none, rounding"),
    ):
        assert run(goe_sim, "--scenario", file, *words, "--out", out, expect=2).stderr.startswith(fault)


def test_no_file(goe_sim: Path, tmp_path: Path) -> None:
    done = run(goe_sim, "--scenario", tmp_path / "none.ini", "--out", tmp_path / "log", expect=2)
    assert done.stderr == f"goe_sim: {tmp_path / 'none.ini'}: cannot be opened: No such file or directory\n"
    done = run(goe_sim, "--scenario", tmp_path, "--out", tmp_path / "log", expect=2)
    assert done.stderr == f"goe_sim: {tmp_path}:0: cannot be read: Is a directory\n"
