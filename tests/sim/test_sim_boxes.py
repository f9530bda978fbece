"""Upright boxes of goe_sim against an independent projection; their noise; goe_replay on such logs."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from sim_support import FEATURES, Camera, Log, box_corners, fly, poses, run
from test_sim_projection import LENS, MOUNT

SIDES = ("box_left_px", "box_top_px", "box_right_px", "box_bottom_px")
BOXES = ("--features", "boxes")
EXACT = (*BOXES, "--noise", "none")
TOLERANCE_PX = 1e-3
RIM_POINTS, RINGS, EDGE_POINTS = 2000, 25, 2001
LEAST_PX = 2.0  # no smaller box is detected

# all of it stays in the image, for many frames: the noise is not clipped
LONG = ("--obstacle", "building", "--x0", "-150", "--reach", "80", "--run", "40", "--fps", "20")
ROLLING = ("--roll-amplitude-deg", "25")
# past a building until it is out of sight; it stays in front of the camera
PASSING = ("--obstacle", "building", "--x0", "-60", "--reach", "20", "--run", "18", "--yaw-camera", "0")
SCENES = {
    "chimney": ("--obstacle", "cylinder"),
    "chimney, rolling": ("--obstacle", "cylinder", *ROLLING),
    "building, rolling": ("--obstacle", "building", "--alpha", "20", *ROLLING, "--roll-rate-hz", "0.7"),
    "building, lens, mounting": ("--obstacle", "building", "--alpha", "-35", *LENS, *MOUNT, *ROLLING),
    "long truck, from above": ("--obstacle", "long-truck", "--altitude", "15", "--alpha", "70"),
    "disc, lens": ("--obstacle", "disc:14,3", "--altitude", "25", *LENS, *ROLLING),
    "wide image": ("--obstacle", "box:9,30,15", "--image-width", "1600", "--image-height", "500", *ROLLING),
}


def boxes(log: Log, exact: bool = False) -> np.ndarray:
    """(frames, 4) left, top, right, bottom; NaN where there is none."""
    table = log.exact if exact else log.frames
    return np.column_stack([table[name] for name in SIDES])


def surface(truth: dict[str, float], cylinder: bool) -> np.ndarray:
    """Points of all edges of a box; of a cylinder's wall, with both rims."""
    if cylinder:
        angle = np.linspace(0.0, 2.0 * np.pi, RIM_POINTS, endpoint=False)
        radius = truth["width_m"] / 2
        rim = np.column_stack([np.cos(angle) * radius, np.sin(angle) * radius, np.zeros(RIM_POINTS)])
        middle = np.array([truth["center_n_m"], truth["center_e_m"], truth["ground_d_m"]])
        levels = np.linspace(0.0, -truth["height_m"], RINGS)
        return np.vstack([middle + rim + [0.0, 0.0, level] for level in levels])
    corners = box_corners(truth)
    share = np.linspace(0.0, 1.0, EDGE_POINTS)[:, None]
    pairs = [(0, 1), (1, 3), (3, 2), (2, 0)]
    pairs += [(i + 4, j + 4) for i, j in pairs] + [(i, i + 4) for i in range(4)]
    return np.vstack([corners[i] * (1 - share) + corners[j] * share for i, j in pairs])


def framed(log: Log, cylinder: bool) -> np.ndarray:
    """Boxes (frames, 4) around the projected surface, uncut; the surface lies in front of the camera."""
    camera, points = Camera(log.camera), surface(log.truth, cylinder)
    position, attitude = poses(log.exact)
    found = []
    for k in range(len(position)):
        pixels, depth = camera.project(position[k], attitude[k], points)
        assert (depth > 0.5).all()
        found.append([*pixels.min(axis=0), *pixels.max(axis=0)])
    return np.array(found)


def cut(log: Log, whole: np.ndarray) -> np.ndarray:
    width, height = log.camera["camera.width"], log.camera["camera.height"]
    inside = np.clip(whole, 0.0, [width - 1, height - 1, width - 1, height - 1])
    size = inside[:, 2:] - inside[:, :2]
    return np.where((size >= LEAST_PX).all(axis=1)[:, None], inside, np.nan)


# ------------------------------------------------------------------------------------------------------------- geometry


@pytest.mark.parametrize("scene", SCENES)
def test_a_box_frames_the_whole_obstacle_and_ends_at_the_border(goe_sim: Path, tmp_path: Path, scene: str) -> None:
    log = fly(goe_sim, tmp_path / "log", *EXACT, *SCENES[scene])
    whole, found = framed(log, "chimney" in scene or "disc" in scene), boxes(log)
    assert np.allclose(found, cut(log, whole), atol=TOLERANCE_PX, rtol=0, equal_nan=True)
    assert np.array_equal(found, boxes(log, exact=True), equal_nan=True)
    assert np.isfinite(found).all(axis=1).sum() > 100


def test_cut_sides_are_at_the_border_and_lost_boxes_are_empty(goe_sim: Path, tmp_path: Path) -> None:
    """Past a building far higher than the image, until it is out of sight."""
    log = fly(goe_sim, tmp_path / "log", *EXACT, *PASSING, *ROLLING)
    whole, found = framed(log, cylinder=False), boxes(log)
    borders = np.array([0.0, 0.0, 1279.0, 1279.0])
    beyond = np.where(np.arange(4) < 2, whole < borders, whole > borders) & np.isfinite(found)
    assert beyond[:, [0, 1, 3]].any(axis=0).all()
    assert (found[beyond] == np.broadcast_to(borders, found.shape)[beyond]).all()
    lost = np.isnan(found).any(axis=1)
    assert lost.any() and not lost.all() and np.isnan(found[lost]).all()


def test_noise_does_not_carry_a_side_over_the_border(goe_sim: Path, tmp_path: Path) -> None:
    log = fly(goe_sim, tmp_path / "log", *BOXES, *PASSING, "--box-share", "0.3")
    found = boxes(log)[np.isfinite(boxes(log)).all(axis=1)]
    assert (found >= 0.0).all() and (found <= 1279.0).all() and (found[:, :2] + LEAST_PX <= found[:, 2:]).all()
    assert (found[:, 0] == 0.0).any() and (found[:, 3] == 1279.0).any()


def test_a_building_next_to_the_camera_keeps_its_box(goe_sim: Path, tmp_path: Path) -> None:
    """A part of it is behind the camera: the rest still reaches beyond the border on that side."""
    wall = ("--obstacle", "box:6,200,12", "--x0", "-20", "--altitude", "6", "--z0", "150", "--run", "6")
    log = fly(goe_sim, tmp_path / "log", *EXACT, *wall)
    camera, corners = Camera(log.camera), box_corners(log.truth)
    position, attitude = poses(log.exact)
    behind = [(camera.project(position[k], attitude[k], corners)[1] < 0).any() for k in range(len(position))]
    found = boxes(log)[behind]
    assert len(found) > 5 and (found[:, 0] == 0.0).all() and (found[:, 2] > 600.0).all()


# ---------------------------------------------------------------------------------------------------- what the log says


def test_logged_columns(goe_sim: Path, tmp_path: Path) -> None:
    """With corners, the log equals the one without the option, byte for byte. The flight is the same with any
    features."""
    options = ("--obstacle", "building", "--alpha", "20", "--noise", "field", "--seed", "4")
    logs = {
        name: fly(goe_sim, tmp_path / name, *options, *(("--features", name) if name != "usual" else ()))
        for name in ("usual", "corners", "points", "boxes")
    }
    for file in ("camera.ini", "frames.csv", "truth.csv", "truth_frames.csv"):
        assert (tmp_path / "usual" / file).read_bytes() == (tmp_path / "corners" / file).read_bytes()
    pose = ["t_s", "id", "n_m", "e_m", "d_m", "agl_m", "qw", "qx", "qy", "qz"]
    names = {name: [column for column in log.frames if column not in pose] for name, log in logs.items()}
    assert names["usual"] == [f"{feature}_{axis}" for feature in FEATURES for axis in "uv"]
    assert names["points"] == names["usual"][:6] and names["boxes"] == list(SIDES)
    for name, log in logs.items():
        for column in (*pose, *names[name]):
            if column in logs["usual"].frames:
                assert np.array_equal(log.frames[column], logs["usual"].frames[column], equal_nan=True)


def test_a_seed_repeats_its_boxes_and_another_differs(goe_sim: Path, tmp_path: Path) -> None:
    first, again, other = (
        fly(goe_sim, tmp_path / name, *BOXES, *ROLLING, "--seed", seed)
        for name, seed in (("first", 7), ("again", 7), ("other", 8))
    )
    assert np.array_equal(boxes(first), boxes(again), equal_nan=True)
    assert (boxes(first)[:100] != boxes(other)[:100]).all()
    assert np.array_equal(boxes(first, exact=True), boxes(other, exact=True), equal_nan=True)


# ---------------------------------------------------------------------------------------------------------------- noise


def errors_over_size(log: Log) -> np.ndarray:
    exact = boxes(log, exact=True)
    return (boxes(log) - exact) / np.tile(exact[:, 2:] - exact[:, :2], 2)


def test_white_noise_of_the_sides(goe_sim: Path, tmp_path: Path) -> None:
    for options in (("--noise", "pixel:0.8"), ("--noise", "none", "--box-px", "0.8")):
        log = fly(goe_sim, tmp_path / "log", *LONG, *BOXES, *options)
        error = boxes(log) - boxes(log, exact=True)
        assert error.shape[0] > 750
        assert error.std(axis=0) == pytest.approx([0.8] * 4, rel=0.08)
        assert abs((error[1:] * error[:-1]).mean()) < 0.1 * 0.8**2


@pytest.mark.parametrize("rate", [5, 20])
def test_the_detector_s_noise_keeps_for_its_time_constant_at_any_rate(goe_sim: Path, tmp_path: Path, rate: int) -> None:
    """The default noise of boxes: 0.04 of the width or height, of which 1/e remains after a second."""
    error = []
    for seed in range(25):
        log = fly(goe_sim, tmp_path / "log", *LONG, *BOXES, "--box-px", "0", "--seed", seed, "--fps", rate)
        error.append(errors_over_size(log))
    shares = np.array(error)
    assert shares.std(axis=(0, 1)) == pytest.approx([0.04] * 4, rel=0.12)
    after = (shares[:, rate:] * shares[:, :-rate]).mean() / (shares**2).mean()
    assert after == pytest.approx(np.exp(-1.0), abs=0.06)
    between_sides = np.corrcoef(shares.reshape(-1, 4).T) - np.eye(4)
    assert np.abs(between_sides).max() < 0.15


def test_the_usual_noise_of_boxes_is_the_detector_s(goe_sim: Path, tmp_path: Path) -> None:
    figures = ("--box-px", "0.5", "--box-share", "0.04", "--box-correlation", "1")
    usual, named, at_end = (
        boxes(fly(goe_sim, tmp_path / name, *BOXES, *options))
        for name, options in (("a", ()), ("b", ("--noise", "detector")), ("c", ("--noise", "none", *figures)))
    )
    assert np.array_equal(usual, named, equal_nan=True) and np.array_equal(usual, at_end, equal_nan=True)


def test_rounding_and_outliers_of_sides(goe_sim: Path, tmp_path: Path) -> None:
    rounded = fly(goe_sim, tmp_path / "rounded", *LONG, *BOXES, "--noise", "rounding")
    assert np.array_equal(boxes(rounded), np.floor(boxes(rounded, exact=True) + 0.5))
    outliers = ("--outlier-rate", "0.05", "--outlier-size", "15")
    log = fly(goe_sim, tmp_path / "outliers", *LONG, *EXACT, *outliers)
    jump = boxes(log) - boxes(log, exact=True)
    moved = np.abs(jump) > 1e-9
    assert moved.mean() == pytest.approx(0.05, abs=0.015)
    assert np.abs(jump[moved]) == pytest.approx(np.full(moved.sum(), 15.0), abs=1e-9)
    assert 0.3 < (jump[moved] > 0).mean() < 0.7


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--features", "circles"), "--features"),
        (("--box-px", "-1"), "noise"),
        (("--box-share", "nan"), "noise"),
        (("--box-correlation", "-1"), "noise"),
    ],
)
def test_bad_options_are_named(goe_sim: Path, tmp_path: Path, options: tuple[str, ...], complaint: str) -> None:
    done = run(goe_sim, "--out", tmp_path / "log", *options, expect=2)
    assert complaint in done.stderr and not list(tmp_path.iterdir())


# ----------------------------------------------------------------------------------------------------------- goe_replay


@pytest.mark.parametrize("roll", [0, 25])
def test_goe_replay_answers_a_prism_within_two_sigma(
    programs: dict[str, Path], goe_sim: Path, tmp_path: Path, roll: int
) -> None:
    """[GOE_MODEL_PRISM, (R31)] With the library's default settings, which allow larger errors than these boxes have."""
    replay, errors = programs["goe_replay"], []
    for seed in range(1, 9):
        options = ("--roll-amplitude-deg", roll, "--seed", seed, "--run", "17")
        log = fly(goe_sim, tmp_path / "log", *BOXES, *options)
        rows = list(csv.DictReader(run(replay, tmp_path / "log").stdout.splitlines()))
        last = rows[-1]
        assert last["model"] == "prism"
        errors.append(abs(float(last["z0_m"]) - log.truth["z0_m"]) / float(last["z0_sd_m"]))
    assert max(errors) < 2.0
