"""The bound, the offline fit and the goals: independent checks of their foundations."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench.__main__ import main as bench_main
from bench.optimum.goals import command, outcome
from bench.optimum.goals.goal import Goal
from bench.optimum.goals.kitti import caught
from goe_tools.__main__ import main
from goe_tools.flights.flight import LEFT, RIGHT, TOP, Flight, Obstacle
from goe_tools.flights.logged import from_log
from goe_tools.flights.measured import measure
from goe_tools.flights.noise import FIELD, NOISES, Noise
from goe_tools.flights.rotations import multiply, small_rotations
from goe_tools.flights.scene import Scene
from goe_tools.flights.simulated import Course, paper_scenes, pinhole, simulate
from goe_tools.library import (
    MODEL_BOX,
    MODEL_DISC,
    MODEL_PRISM,
    Track,
    estimate,
    settings_of,
)
from goe_tools.logs.obslog import LogError, read_log, write_log
from goe_tools.models import model
from goe_tools.models.bound import bound
from goe_tools.models.judge import judge, renamed, renamed_sigma

CORNER = Path(__file__).resolve().parents[1] / "data" / "corner"
EXACT = Noise(pixel_px=0.0)
SENSORS = replace(FIELD, outliers=0.0, position_walk_sd_m=0.0)  # all errors that the model knows, and no other


def box_scene(**change: object) -> Scene:
    truth = Obstacle("box", -30.0, 300.0, math.radians(20.0), 8.0, 14.0, 12.0)
    course = Course(15.0, 18.0, 20.0, 0.0, 300.0 / 18.0, 0.1, "weave", (5.0, 9.0))
    return simulate("box", "box", pinhole(-15.0), replace(truth, **change), course, np.array([0.1, 0.2, 0.3]))


def disc_scene(x0: float = 25.0) -> Scene:
    truth = Obstacle("disc", x0, 300.0, 0.0, 6.0, 6.0, 25.0)
    course = Course(15.0, 18.0, 20.0, 0.0, 300.0 / 18.0)
    return simulate("disc", "disc", pinhole(), truth, course, np.zeros(3))


# --------------------------------------------------------------------------------------------------------------- model


@pytest.mark.parametrize("scene", [box_scene(), disc_scene()], ids=["box", "disc"])
def test_exact_points_leave_no_residuals(scene: Scene) -> None:
    """The simulator projects corners in NED, the model works in T: two derivations of the same pixels."""
    flight = measure(scene, EXACT)
    view, state = model.view_of(flight), model.true_state(flight)
    corners = model.correspond(view, state)
    rows = model.row_mask(corners.usable)
    assert rows.sum() > 300
    assert np.abs(model.residuals(view, corners, state)[rows]).max() < 1e-12


@pytest.mark.parametrize("scene", [box_scene(), disc_scene()], ids=["box", "disc"])
def test_complex_steps_agree_with_differences(scene: Scene) -> None:
    flight = measure(scene, FIELD, 3)
    flight.camera = replace(flight.camera, k1=-0.05, k2=0.01, p1=0.001, p2=-0.0005, k3=0.002)
    view, state = model.view_of(flight), model.true_state(flight)
    state[[model.BX, model.BY, model.BZ, model.DH, model.VX, model.VZ]] = [0.004, -0.003, 0.005, 0.3, 0.02, 0.03]
    corners = model.correspond(view, state)
    rows = model.row_mask(corners.usable)
    exact = model.jacobian(view, corners, state)
    for i in range(len(state)):
        step = np.zeros(len(state))
        step[i] = 1e-6 * max(abs(state[i]), 1e-2)
        there, back = (model.residuals(view, corners, state + sign * step) for sign in (1, -1))
        difference = (back - there) / (2 * step[i])
        scale = np.abs(exact[rows][:, i]).max()
        assert np.abs(difference - exact[..., i])[rows].max() <= 1e-6 * scale + 1e-9, model.STATES[i]


def test_an_attitude_error_is_undone_by_the_bias_states() -> None:
    scene = box_scene()
    flight = measure(scene, EXACT)
    turned = np.array([0.006, -0.004, 0.008])
    flight.attitude = multiply(flight.attitude, small_rotations(-turned))
    view, state = model.view_of(flight), model.true_state(flight)
    corners = model.correspond(view, state)
    rows = model.row_mask(corners.usable)
    state[:3] = turned
    assert np.abs(model.residuals(view, corners, state)[rows]).max() < 1e-6  # the model's rotation: third power / 12


def test_undistort_inverts_the_lens() -> None:
    camera = replace(pinhole(), k1=-0.2, k2=0.05, p1=0.001, p2=-0.002, k3=-0.01)
    pixel = np.random.default_rng(1).uniform(100.0, 1180.0, (50, 2))
    point, slope = model.undistort(camera, pixel)
    again = model.distorted(camera, point) * [camera.fx, camera.fy] + [camera.cx, camera.cy]
    assert np.abs(again - pixel).max() < 1e-9
    moved, _ = model.undistort(camera, pixel + np.array([1e-4, 0.0]))
    assert np.allclose((moved - point) / 1e-4, slope[..., 0], rtol=1e-5, atol=1e-9)


# --------------------------------------------------------------------------------------------------------------- bound


def test_the_bound_is_linear_in_the_pixel_noise() -> None:
    flight = measure(box_scene(), EXACT)
    small, large = (bound(flight, Noise(pixel_px=px)).sigma for px in (0.2, 0.8))
    assert np.allclose(large / small, 4.0, rtol=1e-3)


def test_twice_the_images_are_worth_the_square_root_of_two() -> None:
    noise = Noise(pixel_px=0.5, attitude_white_sd_deg=0.05)
    flight = measure(box_scene(), EXACT)
    names = ("time_s", "pixel_px", "seen", "position_ned_m", "attitude", "height_m")
    doubled = replace(flight, **{name: np.repeat(getattr(flight, name), 2, 0) for name in names})
    ratio = bound(flight, noise).sigma / bound(doubled, noise).sigma
    assert np.allclose(ratio, math.sqrt(2.0), rtol=1e-3)


def test_the_bound_of_a_distant_disc_is_that_of_three_numbers() -> None:
    """Far away a disc's outline is x = (a -+ w/2)/(1 - dZ q), and its information can be written in closed form."""
    scene = disc_scene(x0=0.0).trimmed(0)
    flight = measure(scene, EXACT).first(80)  # to 120 m before it
    flight.seen[:, TOP] = False
    noise = Noise(pixel_px=0.5)
    view = model.view_of(flight)
    q, w = 1 / 300.0, 6.0 / 300.0
    depth = 1 - view.dz_m * q
    rows = [np.stack([1 / depth, side * w / 2 * view.dz_m / depth**2, side / 2 / depth], -1) for side in (-1, 1)]
    jacobian = np.concatenate(rows) * 914.0 / 0.5
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    slopes = np.array([[0.0, -1 / q**2, 0.0], [0.0, -w / q**2, 1 / q]])  # Z0 = 1/q, W = w/q
    by_hand = np.sqrt(np.diag(slopes @ covariance @ slopes.T))
    assert np.allclose(bound(flight, noise).sigma[[1, 3]], by_hand, rtol=0.02)


def test_nuisances_only_raise_the_bound() -> None:
    flight = measure(box_scene(), EXACT)
    assert (bound(flight, SENSORS).sigma >= bound(flight, Noise(pixel_px=0.5)).sigma).all()


# ------------------------------------------------------------------------------------------------------------- offline


@pytest.mark.parametrize("scene", [box_scene(), disc_scene()], ids=["box", "disc"])
def test_the_fit_finds_the_truth_without_noise(scene: Scene) -> None:
    pytest.importorskip("scipy")
    from goe_tools.models.offline import fit

    flight = measure(scene, EXACT)
    start = model.true_state(flight)
    start[model.A :] *= [1.02, 0.98, 1.03, 0.98, 1.02, 1.02, 1.0, 1.0]
    if flight.truth.kind == "disc":
        start[[model.SX, model.SZ]] = model.true_state(flight)[[model.SX, model.SZ]]
    result = fit(flight, replace(SENSORS, pixel_px=20.0), start)  # so much noise that the start has no outliers
    shown = np.arange(6) if scene.truth.kind == "box" else [0, 1, 3, 5]
    assert np.abs((result.values - flight.truth.values)[shown]).max() < 1e-5
    assert np.abs(result.state[model.NUISANCES]).max() < 1e-6


@pytest.mark.release
def test_the_fit_reaches_the_bound() -> None:
    pytest.importorskip("scipy")
    from goe_tools.models.offline import fit

    ratios = []
    for seed in range(30):
        flight = measure(box_scene(), SENSORS, seed)
        error = fit(flight).values - flight.truth.values
        ratios.append(error / bound(flight).sigma)
    rmse = np.sqrt(np.mean(np.square(ratios), 0))
    assert (rmse > 0.8).all() and (rmse < 1.25).all(), rmse


def test_the_fit_leaves_outliers_out() -> None:
    pytest.importorskip("scipy")
    from goe_tools.models.offline import fit

    flight = measure(box_scene(), SENSORS, 1)
    bad = np.random.default_rng(2).random(flight.seen.shape) < 0.05
    bad &= flight.seen
    flight.pixel_px[bad] += [25.0, 25.0]
    result = fit(flight)
    assert not (result.used & bad).any()
    assert result.used.sum() > 0.97 * (flight.seen & ~bad).sum()
    assert (np.abs(result.values - flight.truth.values) < 4 * result.sigma).all()


# ---------------------------------------------------------------------------------------------------------------- logs


def test_a_log_becomes_a_flight() -> None:
    (flight,) = model.logged_flights(CORNER)
    truth = flight.truth
    assert (truth.kind, truth.width_m, truth.length_m, truth.height_m) == ("box", 15.0, 25.0, 60.0)
    assert (truth.x0_m, truth.z0_m) == (-50.0, 612.0)
    assert truth.orientation_rad == pytest.approx(math.radians(-5.0))
    assert len(flight.time_s) == 121 and flight.seen[:, LEFT].sum() > 100
    assert flight.top_is_highest  # from the scene: the highest point in the image


def test_the_truth_of_a_log_without_the_simulators_columns(tmp_path: Path) -> None:
    for name in ("camera.ini", "frames.csv"):
        (tmp_path / name).write_text((CORNER / name).read_text())
    lines = (CORNER / "truth.csv").read_text().splitlines()
    (tmp_path / "truth.csv").write_text("\n".join(",".join(line.split(",")[:9]) for line in lines) + "\n")
    (plain,), (configured,) = from_log(tmp_path), from_log(CORNER)
    assert np.allclose(plain.truth.values, configured.truth.values, atol=1e-6)


def test_the_boxes_of_a_log(tmp_path: Path) -> None:
    log = read_log(CORNER)
    frames = [replace(frame, box_px=(1.0, 2.0, None, 4.0)) for frame in log.frames]
    frames[3] = replace(frames[3], box_px=None)
    write_log(tmp_path, replace(log, frames=frames))
    (flight,), (plain,) = from_log(tmp_path), from_log(CORNER)
    assert flight.image_size_px == plain.image_size_px == (log.camera.width, log.camera.height)
    assert plain.box_px is None
    assert flight.box_px is not None and flight.box_px.shape == (121, 4)
    assert np.array_equal(flight.box_px[2], [1.0, 2.0, np.nan, 4.0], equal_nan=True)
    assert np.isnan(flight.box_px[3]).all()
    assert np.array_equal(flight.first(3).box_px, flight.box_px[:3], equal_nan=True)
    write_log(tmp_path, replace(log, frames=[*log.frames[:60], *(replace(f, reset_count=1) for f in log.frames[60:])]))
    with pytest.raises(LogError, match="reset_count: changes within track 1"):
        from_log(tmp_path)


@pytest.mark.parametrize("command", ["bound", "offline"])
def test_commands(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("scipy")
    noise = ["--pixel", "0.35", "--attitude-bias", "0", "--attitude-white", "0", "--height", "0", "--velocity", "0"]
    assert main([command, str(CORNER), *noise]) == 0
    text = capsys.readouterr().out
    assert "corner/1: box, 121 images" in text
    if command == "offline":
        line = next(line for line in text.splitlines() if line.startswith("error / one sigma"))
        assert np.abs(np.array(line.split()[4:], float)).max() < 3.0


def test_a_log_of_two_cameras_is_refused(tmp_path: Path) -> None:
    log = read_log(CORNER)
    write_log(tmp_path, replace(log, camera2=log.camera))
    with pytest.raises(LogError, match=r"camera\.ini: camera2: a second camera, a flight has one"):
        from_log(tmp_path)


def test_a_log_without_truth_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("camera.ini", "frames.csv"):
        (tmp_path / name).write_text((CORNER / name).read_text())
    assert main(["bound", str(tmp_path)]) == 2
    assert "there is no truth" in capsys.readouterr().err
    assert main(["bound", str(CORNER), "--correlation", "1"]) == 2
    assert "correlation" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["bound", "offline"])
def test_a_log_of_boxes_alone_is_refused(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("scipy")
    log = read_log(CORNER)
    points = dict.fromkeys(("left", "right", "top", "base_left", "base_near", "base_right"))
    frames = [replace(frame, **points, box_px=(500.0, 600.0, 540.0, 640.0)) for frame in log.frames]
    write_log(tmp_path, replace(log, frames=frames))
    assert main([command, str(tmp_path)]) == 2
    assert f"no points in the images of {tmp_path.name}/1; boxes are not used" in capsys.readouterr().err


def test_the_campaign_of_the_paper() -> None:
    scenes = paper_scenes()
    assert len(scenes) == 156
    assert all(s.seen[: len(s.time_s) // 2, [LEFT, RIGHT]].all(1).mean() > 0.8 for s in scenes)
    again = [measure(scenes[40], FIELD, (3, 4)) for _ in range(2)]
    assert np.array_equal(again[0].pixel_px, again[1].pixel_px)


# --------------------------------------------------------------------------------------------------------------- judge


def track_of(values: np.ndarray, model_number: int) -> Track:
    count = len(values)
    number, zero = np.full(count, model_number), np.zeros(count)
    return Track(
        zero, number, number, zero > 0, zero > 0, values, np.ones((count, 6)), np.zeros((count, 6, 6)), zero, zero, zero
    )


def test_names_of_front_and_side_may_be_exchanged() -> None:
    flight = measure(box_scene(), EXACT)
    truth = flight.truth.values
    twice = renamed(renamed(truth, 1), -1)
    assert np.allclose(twice, truth, atol=1e-9)
    other = renamed(truth, 1)  # the camera passes to the right of a box that is on the left
    error = judge(track_of(np.array([truth, other]), MODEL_BOX), flight)
    assert np.abs(error.error).max() < 1e-9
    assert error.renamed.tolist() == [False, True]


def test_the_bound_under_the_other_name() -> None:
    flight = measure(box_scene(), EXACT)
    best = bound(flight, Noise())
    other = renamed_sigma(flight.truth, best.covariance)
    assert np.allclose(other[[2, 3, 4, 5]], best.sigma[[2, 4, 3, 5]])


@pytest.mark.parametrize("model_number", [MODEL_DISC, MODEL_PRISM])
def test_a_footprint_for_a_box_is_held_against_its_middle(model_number: int) -> None:
    flight = measure(box_scene(), EXACT)
    values = np.tile(flight.truth.values, (2, 1))
    values[:, :2] = flight.truth.corners().mean(0)
    error = judge(track_of(values, model_number), flight).error
    assert np.abs(error[:, :2]).max() < 1e-9
    assert np.isnan(error[:, 2:]).all()


# ------------------------------------------------------------------------------------------------- library and goals


def test_the_library_over_a_flight(built: None) -> None:
    """[D5]"""
    flight = measure(box_scene(), NOISES["gauss0.3"], 1)
    track = estimate(flight)
    error = judge(track, flight)
    assert track.valid[-1].all()
    assert (np.abs(error.error[-1]) < 4 * error.sigma[-1]).all()
    assert np.allclose(np.sqrt(np.diag(track.covariance[-1])), track.sigma[-1], rtol=1e-3)
    window = estimate(flight, settings_of(flight, method="window"))
    assert set(window.method[window.valid[:, 1]]) == {1}
    with pytest.raises(ValueError, match=r"noise\.of_nothing"):
        estimate(flight, noise__of_nothing=1.0)
    with pytest.raises(ValueError, match=r"camera\.fx_px"):
        estimate(flight, camera__fx_px=-1.0)


def test_the_size_of_the_image_is_a_setting(built: None) -> None:
    flight = replace(measure(box_scene(), EXACT), image_size_px=(1280.0, 960.0))
    configured = settings_of(flight)
    assert (configured["camera.width_px"], configured["camera.height_px"]) == (1280.0, 960.0)
    with pytest.raises(ValueError, match=r"camera\.height_px"):
        estimate(replace(flight, image_size_px=(1280.0, -1.0)))


@pytest.mark.parametrize("double", [False, True])
def test_the_library_over_two_cameras(built: None, double: bool) -> None:
    """A second camera equal to the first changes no bit. A turned one changes the answers to its images. If no second
    camera is configured, its images are refused."""
    flight = measure(box_scene(), EXACT)
    one = settings_of(flight)
    cameras = np.arange(len(flight.time_s)) >= len(flight.time_s) // 2
    second = {name.replace("camera.", "more_cameras[0]."): one[name] for name in one if name.startswith("camera.")}
    turned = second | {"more_cameras[0].mount_yaw_deg": second["more_cameras[0].mount_yaw_deg"] + 5.0}
    plain, same, apart, none = (
        estimate(flight, one | settings, double=double, cameras=numbers)
        for settings, numbers in (({}, None), (second, cameras), (turned, cameras), ({}, cameras))
    )
    assert np.isfinite(plain.values[-1]).any() and np.array_equal(plain.values, same.values, equal_nan=True)
    assert np.array_equal(plain.values[~cameras], apart.values[~cameras], equal_nan=True)
    assert not np.array_equal(plain.values, apart.values, equal_nan=True)
    assert ((none.status == -11) == cameras).all()  # out of range
    with pytest.raises(ValueError, match=r"more_cameras\[0\]\.of_nothing"):
        estimate(flight, one | {"more_cameras[0].of_nothing": 1.0})


def test_a_cylinder_is_configured_as_one_where_the_shape_is_known(built: None, monkeypatch: pytest.MonkeyPatch) -> None:
    models: list[set[int]] = []

    def watched(*arguments: object, **change: object) -> Track:
        track = estimate(*arguments, **change)  # type: ignore[arg-type]
        models.append(set(track.model[track.valid[:, 1]]))
        return track

    monkeypatch.setattr(outcome, "estimate", watched)
    for scene, known in ((disc_scene(), True), (disc_scene(), False), (box_scene(), True)):
        outcome.perform(outcome.Task(scene, NOISES["gauss1"], (1, 1), shape_known=known))
    by_filter = models[::2]  # the window method comes second
    assert by_filter == [{MODEL_DISC}, {MODEL_PRISM}, {MODEL_PRISM, MODEL_BOX}]


def boxed(images: int) -> Flight:
    """Exact boxes without points of a disc in front of a level camera. Left and right are tangents; top and bottom
    touch the roof and the foot at their nearest points along the axis."""
    flight = measure(disc_scene(), EXACT).first(images)
    truth, camera = flight.truth, flight.camera
    ahead, radius = truth.z0_m - (flight.position_ned_m - flight.position_ned_m[0])[:, 0], 0.5 * truth.width_m
    bearing, half = np.arctan2(truth.x0_m, ahead), np.arcsin(radius / np.hypot(truth.x0_m, ahead))
    left, right = (camera.cx + camera.fx * np.tan(bearing + side * half) for side in (-1, 1))
    top, bottom = (camera.cy + camera.fy * down / (ahead - radius) for down in (20.0 - truth.height_m, 20.0))
    return replace(
        flight, seen=np.zeros_like(flight.seen), attitude=np.tile([1.0, 0.0, 0.0, 0.0], (images, 1)),
        box_px=np.stack([left, top, right, bottom], -1), image_size_px=(1280.0, 1280.0),
    )  # fmt: skip


@pytest.mark.parametrize("double", [False, True])
def test_the_library_over_boxes_alone(built: None, double: bool) -> None:
    flight = boxed(80)
    assert flight.box_px is not None
    flight.box_px[5] = np.nan
    track = estimate(flight, double=double)
    assert track.status[5] == 4  # nothing visible
    assert track.model[-1] == MODEL_PRISM
    error = (track.values[-1] - flight.truth.values)[[0, 1, 3, 5]]
    assert np.abs(error).max() < 0.01


def test_a_goal_is_met_within_its_range() -> None:
    goal = Goal("g", "n", "1", {"X0": 1.0, "Z0": 3.0}, (0.0, 2.0), ("X0",))
    assert goal.met and not replace(goal, asked=("X0", "Z0")).met
    assert replace(goal, asked=("X0", "Z0")).missed == ("Z0",)
    assert replace(goal, asked=()).met is None
    assert not replace(goal, values={"X0": math.nan}).met


def test_caught_at_a_share_of_false_flags() -> None:
    static, moving = np.arange(10.0), np.array([8.5, 9.5, 20.0, 1.0])
    assert caught(static, moving, 0.0) == 50.0
    assert caught(static, moving, 0.1) == 75.0


@pytest.mark.release
def test_goals_of_table3(built: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "goals.json"
    assert bench_main(["goals", "--quick", "--only", "table3", "--json", str(out)]) == 0
    assert "cylinder" in capsys.readouterr().out
    rows = json.loads(out.read_text())["goals"]
    assert set(rows[0]) == {"group", "name", "unit", "wanted", "asked", "values", "met"}
    assert sum((row["values"].get("Z0") or 0.0) > 5.0 for row in rows) >= 4
    assert not any(row["asked"] for row in rows)  # a quick run has no verdict


def test_goals_names_an_unknown_group(built: None, capsys: pytest.CaptureFixture[str]) -> None:
    assert bench_main(["goals", "--only", "everything"]) == 2
    assert "everything" in capsys.readouterr().err


def test_an_interrupt_ends_with_a_word(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> list[Goal]:
        raise KeyboardInterrupt

    monkeypatch.setitem(command.GROUPS, "field", interrupted)
    assert bench_main(["goals", "--quick", "--only", "field"]) == 130
    assert capsys.readouterr().err.splitlines()[-1] == "bench goals: interrupted"
