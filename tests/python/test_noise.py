"""The noise settings that ``noise`` fits to logs: the true ones on simulated logs, useful ones on recorded logs."""

from __future__ import annotations

import math
import os
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from goe_tools.__main__ import main
from goe_tools.flights.box_logs import kitti_feeds
from goe_tools.logs.obslog import read_log, write_log
from goe_tools.logs.scene import Scene, make_log
from goe_tools.noise import command
from goe_tools.noise.likelihood import fit, projected, score
from goe_tools.noise.rows import Effect, Fading, Rows

ROOT = Path(__file__).resolve().parents[2]
SIM = ROOT / "build" / "sim_host" / "goe_sim"
NOISE = {  # the simulator's noise, by the library's names
    "detector.box_noise_px": 0.8, "detector.box_noise_rel": 0.03, "navigation.attitude_white_sd_deg": 0.15,
    "navigation.attitude_bias_sd_deg": 0.6,
}  # fmt: skip
CLOSE = 0.25
FLIGHTS = 12
LEAST, MOST = 88.0, 98.0  # % within two sigma
# Known misses: more than MOST on the judged half. No factor of the settings makes the sigmas of RRC's X0 and Z0 small
# enough on its fitted half (96.3 %, not 94 %). --cover does not scale the height.
TOO_WIDE = {"RRC": {"X0"}, "YOLO-STRONG-SORT": {"H"}}  # 99.9 %, 99.1 %

# ------------------------------------------------------------------------------------------------------ the likelihood


def rows_of(rng: np.random.Generator, truth: dict[str, float], name: str = "x") -> Rows:
    """Thirty images of two series with white, correlated and constant errors, and an unconfigured slope."""
    time_s = np.repeat(np.arange(30) / 8.0, 2)
    series = np.tile([0, 1], 30)
    result = Rows(
        name, time_s, np.repeat(np.arange(30), 2), np.zeros(60), np.column_stack([np.ones(60), time_s]),
        {"white": Effect(np.ones((60, 1)), np.eye(60)), "constant": Effect(np.cos(time_s)[:, None])},
        {"share": Fading("time", 1.0 + time_s, series)},
    )  # fmt: skip
    root = np.linalg.cholesky(result.covariance(truth))
    return replace(result, residual=root @ rng.standard_normal(60) + result.unknown @ [300.0, -7.0])


TRUTH = {"white": 0.5, "constant": 2.0, "share": 0.3, "time": 0.8}


def test_slopes_of_the_likelihood_are_its_differences() -> None:
    rows, names, step = rows_of(np.random.default_rng(1), TRUTH), tuple(TRUTH), 1e-4

    def likelihood(values: dict[str, float]) -> float:
        covariance, x = rows.covariance(values), rows.unknown
        inner = x.T @ np.linalg.solve(covariance, x)
        sizes = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(inner)[1]
        return -0.5 * (sizes + rows.residual @ projected(rows, values) @ rows.residual)

    slopes, information = score(rows, TRUTH, names)
    for name, slope in zip(names, slopes):
        ends = [likelihood({**TRUTH, name: TRUTH[name] * math.exp(s)}) for s in (step, -step)]
        assert slope == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-3, abs=1e-3)
    assert np.linalg.eigvalsh(information).min() > 0.0


def test_the_information_is_the_spread_of_the_slopes() -> None:
    rng, names = np.random.default_rng(2), tuple(TRUTH)
    pairs = [score(rows_of(rng, TRUTH), TRUTH, names) for _ in range(400)]
    spread = np.cov(np.array([slope for slope, _ in pairs]).T)
    expected = np.mean([information for _, information in pairs], 0)
    assert np.diag(spread) / np.diag(expected) == pytest.approx(1.0, abs=0.3)
    assert np.abs(np.mean([slope for slope, _ in pairs], 0)).max() < 4.0 * np.sqrt(np.diag(expected).max() / 400)


def test_configured_noise_is_found_within_its_sigma_and_other_settings_are_left() -> None:
    rng = np.random.default_rng(3)
    tracks = [rows_of(rng, TRUTH) for _ in range(40)]
    given = {"white": 1.0, "constant": 1.0, "share": 0.1, "time": 0.8}
    result = fit(tracks, given, ("white", "share"), ("constant",))
    assert set(result.names) == {"white", "share", "constant"}
    for name in result.names:
        assert abs(math.log(result.values[name] / TRUTH[name])) < 3.5 * result.share[name] < 0.7
    few = fit(tracks[:2], given, ("white", "share"), ("constant",))
    assert "constant" not in few.names and few.values["constant"] == given["constant"]


def test_outliers_are_left_out() -> None:
    rng = np.random.default_rng(4)
    tracks = [rows_of(rng, TRUTH) for _ in range(20)]
    for rows in tracks[:5]:
        rows.residual[17] += 40.0
    result = fit(tracks, dict(TRUTH), ("white", "share"))
    assert 5 <= result.left_out < 10
    assert result.values["white"] == pytest.approx(TRUTH["white"], rel=0.15)


# ------------------------------------------------------------------------------------------------------ simulated logs


@pytest.fixture(scope="module")
def boxes(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Masts that a rolling aircraft passes."""
    if not SIM.is_file():
        pytest.skip(f"{SIM} is not built")
    folder, result = tmp_path_factory.mktemp("boxes"), []
    for seed in range(1, FLIGHTS + 1):
        out = folder / f"{seed}"
        words = [
            SIM, "--obstacle", "cylinder", "--x0", -12 + 3 * (seed % 4), "--yaw-camera", 0, "--reach", 14, "--run", 11,
            "--speed", 17, "--altitude", 20, "--features", "boxes", "--roll-amplitude-deg", 10,
            "--box-px", NOISE["detector.box_noise_px"], "--box-share", NOISE["detector.box_noise_rel"],
            "--box-correlation", 1.2,
            "--attitude-noise", NOISE["navigation.attitude_white_sd_deg"],
            "--attitude-bias", NOISE["navigation.attitude_bias_sd_deg"], "--altimeter-bias", 0.5,
            "--velocity-bias", 0.05,
            "--position-walk", 0.05, "--seed", seed, "--out", out,
        ]  # fmt: skip
        subprocess.run([str(word) for word in words], check=True, capture_output=True)
        result.append(out)
    return result


def found(text: str) -> dict[str, float]:
    """The --set line of the output."""
    return {name: float(value) for name, value in re.findall(r"--set (\S+)=(\S+)", text)}


def assert_close(values: dict[str, float], *names: str) -> None:
    for name in names:
        assert values[name] == pytest.approx(NOISE[name], rel=CLOSE), name


def test_the_noise_of_boxes_is_found(boxes: list[Path], capsys: pytest.CaptureFixture[str]) -> None:
    logs = [str(log) for log in boxes]
    assert main(["noise", *logs, "--without-truth"]) == 0
    text = capsys.readouterr().out
    assert "from the innovations" in text and "within 2 sigma" not in text
    detector = ("detector.box_noise_px", "detector.box_noise_rel", "navigation.attitude_white_sd_deg")
    assert_close(found(text), *detector)
    assert set(found(text)) == set(detector)
    assert main(["noise", *logs, "--all"]) == 0
    text = capsys.readouterr().out
    assert "from the errors, as the truth is known" in text
    assert_close(found(text), *detector, "navigation.attitude_bias_sd_deg")
    shares = re.search(r"the 12 tracks, as fitted: X0 (\S+) %, Z0 (\S+) %, H (\S+) %", text)
    assert shares is not None and all(float(share) > 80.0 for share in shares.groups())  # twelve tracks


def test_rows_before_the_first_box_change_nothing(
    boxes: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The library's track starts with the first box, so the truth is relative to that image."""
    printed = []
    for name in ("cut", "blank"):
        logs = []
        for box in boxes[:4]:
            log = read_log(box)
            first_s = next(frame.t_s for frame in log.frames if frame.box_px is not None)
            late = [f for f in log.frames if f.t_s >= first_s + 0.6]
            early = [replace(f, box_px=None) for f in log.frames if f.t_s < first_s + 0.6]
            log.frames = [*early, *late] if name == "blank" else late
            write_log(tmp_path / name / box.name, log)
            logs.append(str(tmp_path / name / box.name))
        assert main(["noise", *logs]) == 0
        printed.append(capsys.readouterr().out)
    assert "within 2 sigma" in printed[0] and printed[1] == printed[0]


def test_the_line_is_one_that_goe_replay_takes(boxes: list[Path], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["noise", *map(str, boxes[:4])]) == 0
    lines = capsys.readouterr().out.splitlines()
    line = next(line for line in lines if line.startswith("--set"))
    assert lines[-1].startswith("detector.box_noise_rel = 0.0") and lines[-1].endswith("keep 0.07 or more.")
    program = Path(os.environ.get("GOE_REPLAY") or ROOT / "build" / "sim_host" / "goe_replay")
    done = subprocess.run([str(program), *line.split(), str(boxes[0])], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_advice_is_given_below_the_default_alone() -> None:
    name = "detector.box_noise_rel"
    assert not command.advice_of({name: 0.07}) and not command.advice_of({name: 0.1}) and not command.advice_of({})
    assert "keep 0.07 or more" in command.advice_of({name: 0.0699})


def test_the_noise_of_points_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exact poses and white pixel noise; the output names only the pixel noise."""
    logs = []
    for seed in range(4):
        scene = Scene(
            shape="box", width_m=6.0, length_m=14.0, height_m=8.0, x0_m=-18.0, z0_m=130.0, alpha_deg=25.0, run_s=6.0,
            speed_mps=15.0, altitude_m=25.0, wobble_deg=2.0, pixel_sigma_px=0.8, seed=seed,
        )  # fmt: skip
        write_log(tmp_path / str(seed), make_log(scene))
        logs.append(str(tmp_path / str(seed)))
    assert main(["noise", *logs]) == 0
    text = capsys.readouterr().out
    assert "4 tracks with points" in text
    assert found(text)["detector.point_noise_px"] == pytest.approx(0.8, rel=0.1)
    assert main(["noise", *logs, "--without-truth"]) == 2
    assert "points need the truth" in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------------- recorded boxes


@pytest.mark.release
@pytest.mark.parametrize("feed", ["RRC", "YOLO-STRONG-SORT"])
def test_settings_from_one_half_fit_the_other(feed: str, capsys: pytest.CaptureFixture[str]) -> None:
    folders = [folder for folder in kitti_feeds() if folder.name == feed]
    if not folders:
        pytest.skip("KITTI's boxes are not there (GOE_BOXES_DIR)")
    logs = sorted(str(path.parent) for path in folders[0].glob("*/frames.csv"))
    assert main(["noise", *logs, "--cover", "94"]) == 0
    text = capsys.readouterr().out
    found_shares = re.search(
        r"judged on the 2nd, 4th, \.\.\.: \d+ tracks, as fitted: X0 (\S+) %, Z0 (\S+) %, H (\S+) %", text
    )
    assert found_shares is not None
    shares = dict(zip(("X0", "Z0", "H"), map(float, found_shares.groups())))
    assert min(shares.values()) >= LEAST, text
    assert {name for name, share in shares.items() if share > MOST} == TOO_WIDE[feed], text


# -------------------------------------------------------------------------------------------------------------- errors


def test_a_coverage_that_no_factor_gives_is_reported(boxes: list[Path], capsys: pytest.CaptureFixture[str]) -> None:
    """The report and the warning agree."""
    assert main(["noise", *(str(box) for box in boxes[:2]), "--cover", "50"]) == 0
    printed = capsys.readouterr()
    (reached,) = re.findall(r"scaled: (\S+) % of X0 and Z0 lie within 2 sigma", printed.out)
    assert ("--cover 50: no factor of the settings" in printed.err) == (abs(float(reached) - 50.0) > 1.0)


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    def run(*words: str) -> str:
        try:
            assert main(["noise", *words]) == 2
        except SystemExit as stop:
            assert stop.code == 2
        return capsys.readouterr().err

    return run


def test_wrong_input(boxes: list[Path], tmp_path: Path, refused: Callable[..., str]) -> None:
    log = str(boxes[0])
    assert f"{tmp_path / 'none'}: no such folder" in refused(str(tmp_path / "none"))
    assert "is not NAME=VALUE with one of detector.box_noise_px" in refused(log, "--set", "box_noise_px=1")
    assert "detector.box_noise_px: 'wide' is not a number" in refused(log, "--set", "detector.box_noise_px=wide")
    assert "detector.box_noise_px: '-1' must be at least 0" in refused(log, "--set", "detector.box_noise_px=-1")
    assert "'100' is not a percentage" in refused(log, "--cover", "100")
    assert "--cover needs boxes and their truth" in refused(log, "--without-truth", "--cover", "95")
    short = replace(read_log(boxes[0]))
    short.frames = short.frames[:5]
    write_log(tmp_path / "short", short)
    assert "no track has enough images (1 are too short or fit no obstacle)" in refused(str(tmp_path / "short"))
    two = read_log(boxes[0])
    two.camera2 = two.camera
    write_log(tmp_path / "two", two)
    assert "camera.ini: camera2: a second camera" in refused(str(tmp_path / "two"))
    (tmp_path / "short" / "frames.csv").write_text("t_s,id\n")
    assert "frames.csv:1: n_m: column is missing" in refused(str(tmp_path / "short"))
