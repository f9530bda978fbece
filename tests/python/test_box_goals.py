"""Evaluation of the goals of upright boxes, on invented answers."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench.optimum.goals import boxes
from bench.optimum.goals.goal import Goal
from bench.optimum.goals.work import QUICK
from goe_tools.flights.box_logs import FOLDER_VARIABLE
from goe_tools.flights.boxes import BUILDING, MAST, BoxOptions, box_flight
from goe_tools.flights.flight import Flight
from goe_tools.library import METHODS, MODEL_PRISM, Track, camera_settings, estimate, ready
from goe_tools.models.judge import HEIGHT, WIDTH, X0, Z0
from goe_tools.models.prism_offline import PrismFit

NAN = math.nan
AMOUNT = replace(QUICK, boxes=1)


def made_up(flight: Flight, error: float = 0.5, from_image: int = 2, method: str = "filter") -> Track:
    """Answers with sigma 1 m and an error of ``error`` m, from an image on."""
    images = len(flight.time_s)
    values = np.full((images, 6), flight.truth.values + error)
    values[:from_image] = NAN
    flags, zeros = np.zeros(images, bool), np.zeros(images)
    return Track(
        zeros, np.full(images, METHODS[method]), np.full(images, MODEL_PRISM), ~flags, flags, values,
        np.where(np.isfinite(values), 1.0, NAN), np.zeros((images, 6, 6)), zeros, zeros, zeros,
    )  # fmt: skip


def fitted(flight: Flight, error: float) -> PrismFit:
    """An offline fit with an error of ``error`` m."""
    return PrismFit(flight.truth.values + error, np.ones(6), np.zeros(12), 1.0, 1, 1)


def outcome(z0_errors: list[float]) -> boxes.BoxOutcome:
    """An outcome with sigma 1 that reports Z0 alone."""
    error = np.full((len(z0_errors), 6), NAN)
    error[:, Z0] = z0_errors
    sigma, suspect = np.where(np.isfinite(error), 1.0, NAN), np.zeros(len(z0_errors), bool)
    return boxes.BoxOutcome(box_flight(MAST, BoxOptions()), error, sigma, suspect)


def by_name(goals: list[Goal], start: str) -> list[Goal]:
    return [goal for goal in goals if goal.name.startswith(start)]


def test_the_last_answer_counts_where_the_last_image_has_none() -> None:
    errors = boxes.last_errors([outcome([9.0, -3.0, NAN]), outcome([NAN])])
    assert errors[:, Z0] == pytest.approx([3.0, NAN], nan_ok=True)


def test_images_until_an_answer() -> None:
    assert boxes.images_until_answer(outcome([0.0, 0.0])) == 1.0
    assert boxes.images_until_answer(outcome([NAN, NAN, 0.0])) == 3.0
    assert boxes.images_until_answer(outcome([NAN])) == math.inf


def test_the_windows_answers_and_other_quantities_are_not_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    task = boxes.Simulated(MAST, BoxOptions(), 1)
    monkeypatch.setattr(boxes, "estimate", lambda flight, settings: made_up(flight))
    judged = boxes.perform(task)
    assert np.isfinite(judged.error[-1]).nonzero()[0].tolist() == [X0, Z0, HEIGHT]
    assert np.isnan(judged.sigma[:, WIDTH]).all()
    monkeypatch.setattr(boxes, "estimate", lambda flight, settings: made_up(flight, method="window"))
    assert np.isnan(boxes.perform(task).error).all()


@pytest.mark.parametrize("solid", [MAST, BUILDING], ids=lambda solid: solid.name)
def test_answers_are_held_against_the_fit(monkeypatch: pytest.MonkeyPatch, solid: boxes.Solid) -> None:
    monkeypatch.setattr(boxes, "estimate", lambda flight, settings: made_up(flight))
    (task,) = boxes._gauss_tasks(solid, 10.0, AMOUNT)
    ours, best = boxes.with_fit(task)
    assert ours[list(boxes.JUDGED)] == pytest.approx(0.5) and np.isnan(ours[WIDTH])
    assert (best[list(boxes.JUDGED)] < [1.0, 5.0, 1.0]).all() and (best[list(boxes.JUDGED)] > 1e-3).all()


@pytest.fixture
def configured(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[dict[str, float]]:
    """Settings of all flights in the run, without recorded boxes and with an offline fit whose error is 0.4 m."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    monkeypatch.setattr(boxes, "fit", lambda flight, noise: fitted(flight, -0.4))
    return []


def test_good_answers_meet_every_goal(
    monkeypatch: pytest.MonkeyPatch, configured: list[dict[str, float]], capsys: pytest.CaptureFixture[str]
) -> None:
    def estimate(flight: Flight, settings: dict[str, float]) -> Track:
        configured.append(settings)
        return made_up(flight)

    monkeypatch.setattr(boxes, "estimate", estimate)
    monkeypatch.setattr(boxes, "bound_of", lambda flight, noise: np.full(6, 0.4))
    goals = boxes.boxes_group("boxes", AMOUNT)
    assert all(goal.met for goal in goals if goal.asked)
    assert sum(bool(goal.asked) for goal in goals) == 22 + 8 + 5 + 8 + 8  # rolling, Gaussian, bound, fit, height
    assert all(goal.values["Z0"] == pytest.approx(0.5 / 0.4) for goal in goals if goal.name.endswith("RMSE / bound"))
    ratios = [goal for goal in goals if goal.name.endswith("filter / offline fit")]
    assert len(ratios) == 8
    assert all(list(goal.values.values()) == pytest.approx([0.5 / 0.4] * 3) for goal in ratios)
    (first,) = by_name(goals, "mast: first answer")
    assert set(first.values.values()) == {3.0}
    assert "left out: KITTI's boxes, ODMD's val_robot" in capsys.readouterr().out
    others = {name for settings in configured for name in settings if not name.startswith("camera.")}
    of_bound = {
        "model": 2.0,
        "detector.box_noise_px": 0.5,
        "detector.box_noise_rel": 0.0,
        "navigation.height_white_sd_m": 0.0,
        "navigation.terrain_height_sd_m": 0.0,
        "navigation.terrain_slope_sd": 0.0,
    }
    assert others == {"heading_auto", "heading_deg", "navigation.height_bias_sd_m", *of_bound}
    of_both = [settings for settings in configured if "model" in settings]
    assert len(of_both) == 5 + 4 and all(of_bound.items() <= settings.items() for settings in of_both)
    assert sum("navigation.height_bias_sd_m" in settings for settings in configured) == 2  # without an altimeter
    assert {settings["camera.width_px"] for settings in configured} == {1280.0}


def test_silence_meets_no_goal(monkeypatch: pytest.MonkeyPatch, configured: list[dict[str, float]]) -> None:
    monkeypatch.setattr(boxes, "estimate", lambda flight, settings: made_up(flight, from_image=10**6))
    goals = boxes.boxes_group("boxes", AMOUNT)
    assert not any(goal.met for goal in goals if goal.asked)


def test_errors_beyond_the_sigma_are_reported(
    monkeypatch: pytest.MonkeyPatch, configured: list[dict[str, float]]
) -> None:
    monkeypatch.setattr(boxes, "estimate", lambda flight, settings: made_up(flight, error=6.0))
    goals = boxes.boxes_group("boxes", AMOUNT)
    (wrong,) = by_name(goals, "building: wrong by 5 sigma")
    assert set(wrong.values.values()) == {100.0} and not wrong.met
    covered = [goal for goal in goals if "within 2 sigma" in goal.name]
    assert len(covered) == 28 and not any(goal.met for goal in covered)


def write_log(folder: Path, frames: str, truth: str) -> None:
    folder.mkdir(parents=True)
    numbers = {"width": 640, "height": 480, "fx": 200, "fy": 200, "cx": 320, "cy": 240}
    (folder / "camera.ini").write_text("".join(f"camera.{name} = {value}\n" for name, value in numbers.items()))
    header = "t_s,id,n_m,e_m,d_m,agl_m,qw,qx,qy,qz,box_left_px,box_top_px,box_right_px,box_bottom_px\n"
    (folder / "frames.csv").write_text(header + frames)
    (folder / "truth.csv").write_text(truth)


def test_recorded_boxes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Two parked cars, one moving car, one car with a short pass; two tracks of ODMD, one of them without an answer."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    row = "{t},{key},{n},0,0,1.65,1,0,0,0,300,200,340,260\n"
    steps = {1: 1.0, 2: 1.0, 3: 1.0, 4: 0.1}
    frames = "".join(row.format(t=0.1 * k, key=key, n=step * k) for key, step in steps.items() for k in range(6))
    truth = "id,static,center_n_m,center_e_m,width_m,length_m,height_m\n"
    truth += "1,1,50,2,1.6,4,1.5\n2,1,25,2,1.6,4,1.5\n3,0,50,2,1.6,4,1.5\n4,1,50,2,1.6,4,1.5\n"
    write_log(tmp_path / "kitti_boxes/FEED/seq", frames, truth)
    write_log(tmp_path / "odmd/val_robot", frames, "id,depth_m\n1,100\n4,50\n")
    settings_of: dict[str, dict[str, float]] = {}

    def estimate(flight: Flight, settings: dict[str, float]) -> Track:
        every_track = "filter.range_sd_rel_max" in settings
        settings_of[f"{flight.name} every" if every_track else flight.name] = settings
        return made_up(flight, from_image=9 if flight.name == "val_robot/4" and not every_track else 0)

    monkeypatch.setattr(boxes, "estimate", estimate)
    goals = boxes.recorded_goals("boxes", AMOUNT)
    kitti = {goal.name: goal for goal in goals if goal.group == "boxes: KITTI, FEED"}
    assert kitti["within 2 sigma, 2 parked cars"].values == {"X0": 100.0, "Z0": 100.0, "H": 100.0}
    assert kitti["Z0 error at the end, median"].values["Z0"] == pytest.approx(1.5)  # of 1 % and 2 %
    assert kitti["Z0 error at the end, 90th percentile"].values["Z0"] == pytest.approx(1.9)
    assert kitti["X0 error at the end, median"].values["X0"] == pytest.approx(0.5)
    assert kitti["X0 error at the end, median"].met is False and kitti["no answer"].met
    odmd = {goal.name: goal for goal in goals if goal.group == "boxes: ODMD, val_robot"}
    assert odmd["depth error, mean"].values["Z0"] == pytest.approx(0.75)  # 0.5 m of 100 m and of 50 m
    assert odmd["answered, of 2"].values == {"tracks": 100.0} and odmd["answered, of 2"].met
    default = odmd["depth error with default settings"]
    assert default.values["mean"] == pytest.approx(0.5) and default.values["answered"] == 50.0
    assert default.met is None
    assert len(settings_of) == 6
    assert settings_of["val_robot/1"]["navigation.position_white_sd_m"] == 2.0
    assert not [name for name in settings_of["FEED/seq/1"] if name.startswith(("navigation.", "detector."))]


def test_the_library_estimates_prisms() -> None:
    """Boxes and default settings reach the library, and its answers are relative to the middle."""
    try:
        ready()
    except FileNotFoundError as reason:
        pytest.skip(str(reason))
    flight = box_flight(MAST, BoxOptions(roll_deg=10.0), 2)
    track = estimate(flight, camera_settings(flight))
    assert set(track.model[track.valid[:, Z0]]) == {MODEL_PRISM}
    judged = boxes.perform(boxes.Simulated(MAST, BoxOptions(roll_deg=10.0), 2))
    error = judged.error[-1, list(boxes.JUDGED)]
    assert (np.abs(error) < 4 * judged.sigma[-1, list(boxes.JUDGED)]).all()
    assert abs(judged.error[-1, Z0]) < 0.03 * flight.truth.z0_m
    assert boxes.images_until_answer(judged) <= 6
