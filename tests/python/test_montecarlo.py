"""Many simulated flights of a scenario: python -m goe_tools montecarlo."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from goe_tools.__main__ import main
from goe_tools.logs.obslog import Truth
from goe_tools.montecarlo import flown
from goe_tools.montecarlo.course import course_of, distance_to_walls
from goe_tools.montecarlo.flown import FALSE, KEYS, MISSED, PROGRAM, QUIET, WARNED, Pass, Scenario, fly
from goe_tools.montecarlo.summary import BAND_RUNS, summaries
from goe_tools.spread import _client
from goe_tools.view.answers import Options

HANG_S = 600  # guard against a hang
AHEAD = """# a building ahead, a mast that the course passes
[flight]
speed = 18
run = 5
reach = 9
altitude = 25
fps = 4
features = boxes
yaw-camera = 0
[obstacle 1]
what = building
x0 = 5
[obstacle 2]
what = disc:4,50
x0 = -70
z0 = 250
"""
Z0, X0, Z, X = (KEYS.index(key) for key in ("z0", "x0", "z", "x"))


@pytest.fixture
def scenario(tmp_path: Path, built: None) -> Path:
    if not PROGRAM.exists():
        pytest.skip("goe_sim is not built")
    path = tmp_path / "scenario.ini"
    path.write_text(AHEAD)
    return path


def rows_of(folder: Path) -> list[dict[str, str]]:
    with (folder / "runs.csv").open(newline="") as file:
        return list(csv.DictReader(file))


# ------------------------------------------------------------------------------------------------------ the command


def test_table_page_and_files(scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "new" / "folder"
    assert main(["montecarlo", str(scenario), "--runs", "12", "--jobs", "2", "--out", str(out)]) == 0
    text = capsys.readouterr().out
    assert "All of this is simulation" in text and "within 2 sigma" in text
    assert "Warned in time: 12;" in text and "Missed: 0." in text
    assert "False warnings: 0 of 12 runs" in text
    page = (out / "montecarlo.html").read_text(encoding="utf-8")
    assert "All of this is simulation" in page and "12 runs, seeds 1 to 12" in page and "a building ahead" in page
    assert page.count("<picture>") == 2 and "<script" not in page and not re.search(r'(src|href)="http', page)
    assert (out / "obstacle_1.png").read_bytes().startswith(b"\x89PNG")
    facts = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert facts["runs"] == facts["runs_asked"] == 12 and "simulation" in facts["note"]
    ahead, aside = facts["obstacles"]
    assert ahead["warnings"]["violated"] == ahead["warnings"]["warned"] == len(ahead["warnings"]["lead_s"]) == 12
    assert aside["warnings"]["violated"] == aside["warnings"]["false"] == 0
    assert 0.0 <= ahead["quantities"]["z0"]["within_1_sigma"] <= ahead["quantities"]["z0"]["within_2_sigma"] <= 1.0
    rows = rows_of(out)
    assert [row["seed"] for row in rows] == [str(1 + k // 2) for k in range(24)]
    assert {row["verdict"] for row in rows[::2]} == {"warned"} and {row["verdict"] for row in rows[1::2]} == {"quiet"}
    assert not [path for path in out.rglob("*") if path.suffix == ".part"]


def test_the_seed_alone_decides(scenario: Path, tmp_path: Path) -> None:
    scenario.write_text(AHEAD.replace("speed = 18", "seed = 77\nspeed = 18"))  # the command's own seeds take precedence
    for name, words in (("one", ["--jobs", "1"]), ("two", ["--jobs", "2"]), ("other", ["--jobs", "1", "--seed", "3"])):
        assert main(["montecarlo", str(scenario), "--runs", "3", "--out", str(tmp_path / name), *words]) == 0
    for name in ("runs.csv", "summary.json", "montecarlo.html"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()
    one, other = rows_of(tmp_path / "one"), rows_of(tmp_path / "other")
    assert one[4:] == other[:2] and one[:2] != other[:2]


def test_on_a_cluster(scenario: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers of a cluster run elsewhere: they can access neither the file nor this folder."""
    distributed, dask = pytest.importorskip("distributed"), pytest.importorskip("dask")
    monkeypatch.setattr("goe_tools.spread.CONNECT_S", HANG_S)
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    own = scenario.rename(tmp_path / "here" / "own.ini")
    with (
        dask.config.set({"distributed.comm.timeouts.connect": f"{HANG_S}s"}),
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
    ):
        words = ["montecarlo", own.name, "--runs", "3"]
        assert main([*words, "--out", "far", "--scheduler", cluster.scheduler_address]) == 0
        _client(cluster.scheduler_address).close()
    assert main([*words, "--out", "near", "--jobs", "1"]) == 0
    assert Path("far/summary.json").read_bytes() == Path("near/summary.json").read_bytes()
    assert Path("far/runs.csv").read_bytes() == Path("near/runs.csv").read_bytes()


def test_a_cluster_that_does_not_answer_leaves_no_file(
    scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("distributed")
    out = tmp_path / "far"
    words = ["montecarlo", str(scenario), "--runs", "3", "--out", str(out), "--scheduler", "nonsense://1"]
    assert main(words) == 2
    assert "--scheduler nonsense://1: " in capsys.readouterr().err
    assert not out.exists()


def test_pictures_of_an_earlier_run_do_not_stay(scenario: Path, tmp_path: Path) -> None:
    words = ["montecarlo", str(scenario), "--runs", "1", "--jobs", "1", "--out", str(tmp_path / "out")]
    assert main(words) == 0
    for name in ("obstacle_77.png", "obstacle_x.png", "mine.png"):
        (tmp_path / "out" / name).touch()
    assert main(words) == 0
    left = {path.name for path in (tmp_path / "out").glob("*.png")}
    assert left >= {"obstacle_x.png", "mine.png"} and "obstacle_77.png" not in left


def test_options_of_the_replay_count(scenario: Path, tmp_path: Path) -> None:
    found = []
    for words in ([], ["--set", "detector.box_noise_px=30"], ["--margin", "90"]):
        assert main(["montecarlo", str(scenario), "--runs", "2", "--jobs", "1", "--out", str(tmp_path), *words]) == 0
        found.append(rows_of(tmp_path))
    assert float(found[1][1]["z0_sd_m"]) > 1.5 * float(found[0][1]["z0_sd_m"])
    assert found[0][1]["violated_s"] == "" and found[2][1]["violated_s"] != ""


@pytest.mark.parametrize(
    ("old", "new", "words", "said"),
    [
        ("speed = 18", "sped = 18", [], "{file}:3: sped: unknown option; did you mean speed?"),
        ("z0 = 250\n", "", [], "{file}:14: [obstacle 2]: z0 is missing"),
        ("speed = 18", "out = x", [], "{file}:3: out: belongs on the command line"),
        ("", "", ["--runs", "0"], "--runs 0: must be at least 1"),
        ("", "", ["--seed", "-1"], "--seed -1: must be 0 to"),
        ("", "", ["--jobs", "0"], "--jobs 0: must be at least 1"),
    ],
)
def test_a_mistake_is_reported_before_anything_is_made(
    scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, words: list[str], said: str
) -> None:
    scenario.write_text(AHEAD.replace(old, new, 1) if old else AHEAD)
    out = tmp_path / "out"
    assert main(["montecarlo", str(scenario), "--runs", "2", "--jobs", "1", "--out", str(out), *words]) == 2
    assert capsys.readouterr().err.startswith(f"goe_tools montecarlo: {said.format(file=scenario)}")
    assert not out.exists()


def test_an_obstacle_out_of_view_is_named(
    scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario.write_text(AHEAD.replace("yaw-camera = 0", "yaw-camera = 170", 1))
    words = ["--runs", "2", "--jobs", "1", "--out", str(tmp_path / "out")]
    assert main(["montecarlo", str(scenario), *words]) == 0
    assert capsys.readouterr().out.count("Was the obstacle in the camera's view?") == 2


def test_places_that_cannot_be(scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, words = tmp_path / "file", ["--runs", "1", "--jobs", "1"]
    file.write_text("mine")
    assert main(["montecarlo", str(tmp_path / "no.ini"), *words]) == 2
    assert "no.ini: No such file or directory" in capsys.readouterr().err
    for out in (file, file / "below"):
        assert main(["montecarlo", str(scenario), *words, "--out", str(out)]) == 2
        assert str(out) in capsys.readouterr().err
    assert file.read_text() == "mine"
    log = tmp_path / "log"
    log.mkdir()
    (log / "frames.csv").touch()
    assert main(["montecarlo", str(scenario), *words, "--out", str(log)]) == 2
    assert "is the folder of a log" in capsys.readouterr().err and len(list(log.iterdir())) == 1
    own = scenario.rename(tmp_path / "runs.csv")  # the name of an output
    assert main(["montecarlo", str(own), *words, "--out", str(tmp_path)]) == 2
    assert "the output would replace" in capsys.readouterr().err and own.read_text() == AHEAD


def wait_for(what: Callable[[], bool]) -> None:
    end_s = time.monotonic() + HANG_S
    while not what():
        if time.monotonic() > end_s:
            raise TimeoutError
        time.sleep(0.05)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM], ids=["Ctrl-C", "SIGTERM"])
def test_an_interrupt_keeps_the_finished_flights(scenario: Path, tmp_path: Path, how: signal.Signals) -> None:
    out, many = tmp_path / "out", 100000
    command = [sys.executable, "-m", "goe_tools", "montecarlo", str(scenario), "--runs", str(many), "--jobs", "1"]
    with subprocess.Popen(
        [*command, "--out", str(out)], start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as program:
        wait_for(out.exists)  # made when the first run is flown
        os.kill(program.pid, how)
        _, error = program.communicate(timeout=HANG_S)
    assert program.returncode == 130 and "Traceback" not in error
    assert error.strip().splitlines()[-1] == "goe_tools montecarlo: interrupted"
    facts = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert 1 <= facts["runs"] < facts["runs_asked"] == many
    assert len(rows_of(out)) == 2 * facts["runs"]
    assert f"stopped early: {facts['runs']} of {many} runs" in error
    assert f"{facts['runs']} of {many} runs" in (out / "montecarlo.html").read_text(encoding="utf-8")


# ------------------------------------------------------------------------------------------------- errors and truth


def scenario_of(text: str) -> Scenario:
    return Scenario("scenario.ini", text, os.getcwd(), str(PROGRAM), Options())


def test_exact_images_give_small_errors(scenario: Path) -> None:
    exact = AHEAD.replace("boxes", "corners\nnoise = none").replace("run = 5", "run = 8")
    for one in fly(scenario_of(exact), 1):
        assert np.nanmax(np.abs(one.error[-1])) < 1.0 and np.isfinite(one.error[-1, [Z0, X0, Z, X]]).all()
        assert np.nanmax(np.abs(one.error[-1] / one.sigma[-1])) < 2.0


def test_a_cylinder_is_as_wide_from_every_side(scenario: Path) -> None:
    """From exact boxes its width is exact: 4 m."""
    mast = fly(scenario_of(AHEAD.replace("boxes", "boxes\nnoise = none")), 1)[1]
    assert abs(mast.error[-1, KEYS.index("width")]) < 0.01


def test_drift_of_the_own_position_is_part_of_the_error(
    scenario: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The errors of Z and Z0 differ by the drift of the logged position since the start. This test reads the drift from
    the files."""
    logs: list[Path] = []
    simulate = flown._simulate

    def kept(of: Scenario, seed: int, folder: Path) -> bool:
        logs.append(tmp_path / "kept")
        logs[-1].mkdir()
        early = simulate(of, seed, folder)
        for name in ("frames.csv", "truth_frames.csv"):
            (logs[-1] / name).write_bytes((folder / "log" / name).read_bytes())
        return early

    monkeypatch.setattr(flown, "_simulate", kept)
    drifting = AHEAD.replace("features = boxes", "features = boxes\nposition-walk = 1\naltimeter-bias = 0")
    one = fly(scenario_of(drifting), 1)[0]

    def north(name: str) -> np.ndarray:
        with (logs[0] / name).open(newline="") as file:
            return np.array([float(row["n_m"]) for row in csv.DictReader(file) if row["id"] == "1"])

    drift = north("frames.csv") - north("truth_frames.csv")
    known = np.isfinite(one.error[:, Z])
    assert np.ptp(drift) > 2.0 and known.sum() > 10
    assert np.allclose((one.error[:, Z0] - one.error[:, Z])[known], (drift - drift[0])[known], atol=1e-3)


def truth(**change: object) -> Truth:
    square = Truth(1, True, 100.0, 0.0, 0.0, 10.0, 20.0, 30.0, 0.0)
    return replace(square, **change)  # type: ignore[arg-type]


def test_distance_to_walls() -> None:
    north, east = np.array([80.0, 100.0, 100.0, 113.0]), np.array([0.0, 0.0, 9.0, 9.0])
    assert distance_to_walls(truth(), north, east) == pytest.approx([10.0, 0.0, 4.0, 5.0])
    assert distance_to_walls(truth(heading_deg=90.0), north, east) == pytest.approx([15.0, 0.0, 0.0, 8.0])
    round_one = truth(length_m=None, heading_deg=None)
    assert distance_to_walls(round_one, north, east) == pytest.approx([15.0, 0.0, 4.0, math.hypot(13, 9) - 5.0])


@pytest.mark.parametrize(
    ("east_m", "down_m", "violated_s"),
    [(0.0, -20.0, 7.5), (19.0, -20.0, 9.0), (21.0, -20.0, math.nan), (0.0, -39.0, 7.5), (0.0, -41.0, math.nan)],
)  # fmt: skip
def test_a_violation_is_found_beyond_the_last_image(east_m: float, down_m: float, violated_s: float) -> None:
    """10 m/s to the north, images until 4 s. The wall is at 90 m, the margin is 15 m, the clearance over a height of 30
    m is 10 m."""
    time_s = np.arange(0.0, 4.1, 0.5)
    path = np.stack([10.0 * time_s, np.full_like(time_s, east_m), np.full_like(time_s, down_m)], -1)
    course = course_of(truth(), time_s, path, 15.0, 10.0)
    assert course.violated_s == pytest.approx(violated_s, abs=0.5, nan_ok=True)
    assert course.closest_m == pytest.approx(max(east_m - 5.0, 0.0), abs=0.1)


# ----------------------------------------------------------------------------------------------------------- counts


def passed(seed: int, violated_s: float = math.nan, warned_s: float = math.nan, ratio: float | None = None) -> Pass:
    """Judged flights with Gaussian errors of sigma 3, or with one constant ratio; the first two images have no
    answer."""
    random = np.random.default_rng(seed)
    error = 3.0 * (random.normal(size=(40, len(KEYS))) if ratio is None else np.full((40, len(KEYS)), ratio))
    error[:2] = np.nan
    sigma = np.where(np.isfinite(error), 3.0, np.nan)
    return Pass(seed, 1, False, 0.125 * np.arange(40), error, sigma, np.zeros(40, bool), 0.0, violated_s, warned_s)


def test_right_sigmas_have_the_coverage_of_a_gaussian() -> None:
    (found,) = summaries([passed(seed) for seed in range(400)])
    for row in found.rows:
        assert row.runs == 400 and row.rms == pytest.approx(1.0, abs=0.03)
        assert row.inside[1].mean == pytest.approx(0.683, abs=0.02) and row.inside[2].mean == pytest.approx(
            0.954, abs=0.01
        )
        assert row.inside[1].error == pytest.approx(math.sqrt(0.683 * 0.317 / 38 / 400), rel=0.2)
    level = found.over_time.level
    assert np.allclose(level[1:, :, [0, 1, 2, 3, 4]].mean((0, 1)), [-1.96, -0.994, 0.0, 0.994, 1.96], atol=0.05)


def test_a_run_counts_once() -> None:
    short = passed(1, ratio=0.5)
    short = replace(
        short, time_s=short.time_s[:4], error=short.error[:4], sigma=short.sigma[:4], suspect=short.suspect[:4]
    )
    (found,) = summaries([short, passed(2, ratio=1.5), passed(3, ratio=2.5)])
    assert found.row("z0").inside[1].mean == pytest.approx(1.0 / 3.0)
    assert found.row("z0").inside[2].mean == pytest.approx(2.0 / 3.0)
    assert np.isnan(found.over_time.level).all() and BAND_RUNS > 3
    assert found.over_time.runs[0, 0] == 3 and found.over_time.runs[5, 0] == 2


def test_verdicts() -> None:
    passes = [
        passed(1, 9.0, 4.0),
        passed(2, 9.0, 6.0),
        passed(3, 9.0),
        passed(4, 9.0, 9.5),
        passed(5, warned_s=1.0),
        passed(6),
    ]
    assert [one.verdict for one in passes] == [WARNED, WARNED, MISSED, MISSED, FALSE, QUIET]
    (found,) = summaries(passes)
    of = found.warnings
    assert (of.runs, of.violated, of.warned, of.missed, of.false, of.quiet) == (6, 4, 2, 2, 1, 1)
    assert of.leads_s == (3.0, 5.0) and of.suspect == 0
