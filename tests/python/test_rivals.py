"""The rival estimators: correct where their mathematics says so, and without an answer where the data do not determine
one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from bench.optimum import rivals
from bench.optimum.rivals import RIVALS, Track, history, missing
from bench.optimum.rivals.track import MIN_IMAGES
from goe_tools.flights.measured import measure
from goe_tools.flights.noise import Noise
from goe_tools.flights.simulated import paper_scenes
from goe_tools.report.prose.refined import STRENGTHS

SIGMA = 0.3 / 914.0  # 0.3 px
IMAGES = 120
STEP_M = 2.0
HEIGHT_M = 20.0  # of the camera
CYLINDER = {"x0_m": -25.0, "z0_m": 300.0, "width_m": 6.0, "height_m": 30.0}
BOX = {"x0_m": -25.0, "z0_m": 300.0, "orientation_rad": 0.3, "width_m": 6.0, "length_m": 9.0, "height_m": 12.0}
BY_POINTS = ["triangulation", "inverse_depth"]
BY_SIZE = ["bearing_angle", "inverse_size"]


@pytest.fixture(params=RIVALS)
def rival(request: pytest.FixtureRequest) -> str:
    return runnable(request.param)


@pytest.fixture(params=BY_POINTS)
def by_points(request: pytest.FixtureRequest) -> str:
    return runnable(request.param)


def runnable(name: str) -> str:
    if name in missing():
        pytest.skip(missing()[name])
    return name


def blank(dx: np.ndarray) -> Track:
    """Level flight along Z with displacement dx (K,) to the right; no feature is visible."""
    count = len(dx)
    time = np.arange(count) / 8.0
    nothing = np.zeros((count, 6, 2)), np.zeros((count, 6), bool)
    return Track(time, *nothing, dx, STEP_M * np.arange(count), np.full(count, HEIGHT_M), SIGMA)


def see(track: Track, image: int, feature: int, x: float, height: float, z: float) -> None:
    """Marks a feature as visible at place (x, z) from the camera and ``height`` over the ground."""
    track.points[image, feature] = x / z, (HEIGHT_M - height) / z
    track.seen[image, feature] = True


def past_cylinder(dx: np.ndarray) -> Track:
    track, radius = blank(dx), 0.5 * CYLINDER["width_m"]
    for k in range(len(dx)):
        x, z = CYLINDER["x0_m"] - track.dx[k], CYLINDER["z0_m"] - track.dz[k]
        distance, bearing = math.hypot(x, z), math.atan2(x, z)
        half = math.asin(radius / distance)
        see(track, k, 0, math.sin(bearing - half), HEIGHT_M, math.cos(bearing - half))
        see(track, k, 1, math.sin(bearing + half), HEIGHT_M, math.cos(bearing + half))
        near = 1.0 - radius / distance
        see(track, k, 2, x * near, CYLINDER["height_m"], z * near)
    return track


def past_box(dx: np.ndarray, orientation: float = BOX["orientation_rad"]) -> Track:
    """All corners are in view. The sides that face the camera determine the visible ones."""
    track = blank(dx)
    across, along = (
        np.array([math.cos(orientation), -math.sin(orientation)]),
        np.array([math.sin(orientation), math.cos(orientation)]),
    )
    front, w, n = np.array([BOX["x0_m"], BOX["z0_m"]]), 0.5 * BOX["width_m"] * across, BOX["length_m"] * along
    ring = [front - w, front - w + n, front + w + n, front + w]  # clockwise from above
    for k in range(len(dx)):
        corners = [c - (track.dx[k], track.dz[k]) for c in ring]
        faces = [i for i in range(4) if faces_camera(corners[i], corners[(i + 1) % 4])]
        ends = sorted({j for i in faces for j in (i, (i + 1) % 4)}, key=lambda j: math.atan2(*corners[j]))
        for feature, j in zip((3, 5) if len(ends) == 2 else (3, 4, 5), ends):
            see(track, k, feature, corners[j][0], 0.0, corners[j][1])
        see(track, k, 0, corners[ends[0]][0], 0.0, corners[ends[0]][1])
        see(track, k, 1, corners[ends[-1]][0], 0.0, corners[ends[-1]][1])
        nearest = min(corners, key=np.linalg.norm)
        see(track, k, 2, nearest[0], BOX["height_m"], nearest[1])
    return track


def faces_camera(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether the outside of the side from a to b, clockwise around the box, faces the origin."""
    return a[0] * (b[1] - a[1]) - a[1] * (b[0] - a[0]) > 0


def straight() -> np.ndarray:
    return np.zeros(IMAGES)


def noisy(track: Track, seed: int) -> Track:
    noise = track.sigma * np.random.default_rng(seed).standard_normal(track.points.shape)
    scale = 1.0 + track.points**2  # of the camera's angle, far from the axis
    return replace(track, points=track.points + noise * scale)


def test_everyone_has_a_strength() -> None:
    assert STRENGTHS.keys() == RIVALS.keys()


def test_cylinder_without_noise(rival: str) -> None:
    answer = RIVALS[rival](past_cylinder(straight()))
    assert answer["box"] == 0
    assert answer["z0_m"] == pytest.approx(CYLINDER["z0_m"], rel=1e-3)
    assert answer["x0_m"] == pytest.approx(CYLINDER["x0_m"], rel=1e-3)
    assert answer["width_m"] == pytest.approx(CYLINDER["width_m"], rel=2e-3)
    assert ("height_m" in answer) == (rival in BY_POINTS)
    assert answer.get("height_m", CYLINDER["height_m"]) == pytest.approx(CYLINDER["height_m"], rel=1e-3)
    assert "orientation_rad" not in answer
    assert "length_m" not in answer


def test_cylinder_straight_ahead(rival: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bisector has no parallax there; the outlines taken as points are off by up to an eighth of the width."""
    monkeypatch.setitem(CYLINDER, "x0_m", 0.0)
    answer = RIVALS[rival](past_cylinder(straight()))
    assert answer["z0_m"] == pytest.approx(CYLINDER["z0_m"], rel=0.01)
    assert answer["x0_m"] == pytest.approx(0.0, abs=0.01)
    assert answer["width_m"] == pytest.approx(CYLINDER["width_m"], rel=0.02)


@pytest.mark.parametrize("orientation", [-0.6, 0.0, 0.3, 0.7])
def test_box_without_noise(by_points: str, orientation: float) -> None:
    answer = RIVALS[by_points](past_box(straight(), orientation))
    truth = {**BOX, "orientation_rad": orientation}
    assert answer["box"] == 1
    assert {name: answer[name] for name in truth} == pytest.approx(truth, rel=5e-3, abs=2e-3)
    assert all(answer[name] > 0 for name in answer if "_sd_" in name)


@pytest.mark.parametrize("name", BY_SIZE)
def test_box_as_disc_is_only_roughly_right(name: str) -> None:
    """The documented bias: the outline of a box is not a disc's, and its width changes as the box turns."""
    answer = RIVALS[name](past_box(straight()))
    assert answer["box"] == 0
    assert "orientation_rad" not in answer
    assert answer["z0_m"] == pytest.approx(BOX["z0_m"] + 0.5 * BOX["length_m"] * math.cos(0.3), rel=0.05)


def test_corners_keep_their_identity(by_points: str) -> None:
    """At first only the front is visible, later a side, too: base_right then is another corner."""
    dx = np.linspace(-24.0, 12.0, IMAGES)
    track = past_box(dx, 0.0)
    two_faces = track.seen[:, 4]
    assert 20 < two_faces.sum() < IMAGES - 5
    answer = RIVALS[by_points](track)
    assert answer["z0_m"] == pytest.approx(BOX["z0_m"], rel=2e-3)
    assert answer["length_m"] == pytest.approx(BOX["length_m"], rel=0.02)


def test_one_face_has_no_length(by_points: str) -> None:
    track = past_box(BOX["x0_m"] + np.linspace(-2.0, 2.0, IMAGES), 0.0)
    assert not track.seen[:, 4].any()
    answer = RIVALS[by_points](track)
    assert "length_m" not in answer
    assert answer["width_m"] == pytest.approx(BOX["width_m"], rel=0.01)


@pytest.mark.parametrize("past", [past_cylinder, past_box])
def test_too_little_gives_nothing(rival: str, past) -> None:
    for count in range(MIN_IMAGES):
        assert RIVALS[rival](past(straight()).until(count)) == {}
    assert RIVALS[rival](blank(straight())) == {}


@pytest.mark.parametrize("past", [past_cylinder, past_box])
def test_no_parallax_gives_nothing(rival: str, past) -> None:
    track = past(straight())
    track.points[:], track.dz[:] = track.points[0], 0.0
    assert RIVALS[rival](noisy(track, 1)) == {}


@pytest.mark.parametrize("past", [past_cylinder, past_box])
def test_mirrored_scene(rival: str, past) -> None:
    track = noisy(past(np.linspace(0.0, 20.0, IMAGES)), 3)
    answer, mirrored = RIVALS[rival](track), RIVALS[rival](track.mirrored())
    for name in ("x0_m", "orientation_rad"):
        if name in mirrored:
            mirrored[name] *= -1.0
    assert mirrored == pytest.approx(answer, rel=1e-4, abs=1e-6)


def test_own_sigma_is_honest(rival: str) -> None:
    """White noise and a cylinder, for which all models are exact: squared errors of Z0 over their own variances."""
    squares = []
    for seed in range(40):
        answer = RIVALS[rival](noisy(past_cylinder(straight()), seed))
        squares.append(((answer["z0_m"] - CYLINDER["z0_m"]) / answer["z0_sd_m"]) ** 2)
    assert 0.5 < np.mean(squares) < 1.7  # chi squared of 40: 99 % within 0.52 and 1.67


def test_outliers_are_not_followed(rival: str) -> None:
    clean = noisy(past_cylinder(straight()), 5)
    wild = replace(clean, points=clean.points.copy())
    hit = np.random.default_rng(6).choice(np.arange(10, IMAGES), 4, replace=False)
    wild.points[hit, 1, 0] += 15.0 / 914.0
    a, b = RIVALS[rival](clean), RIVALS[rival](wild)
    assert abs(b["z0_m"] - a["z0_m"]) < 3.0 * a["z0_sd_m"]


def test_history_grows_with_the_images() -> None:
    answer = history("bearing_angle", noisy(past_cylinder(straight()), 7), 10)
    assert len(answer) == IMAGES // 10
    sigmas = [t["z0_sd_m"] for t in answer if t]
    assert len(sigmas) >= 8
    assert sigmas[-1] < 0.2 * sigmas[0]


def test_gtsam_absent_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    module = rivals._triangulation
    monkeypatch.setattr(module, "gtsam", lambda: None)
    assert "not installed" in missing()["triangulation"]
    with pytest.raises(RuntimeError, match="GTSAM is not installed"):
        RIVALS["triangulation"](past_box(straight()))


@pytest.mark.parametrize("group", ["cylinder", "truck"])
def test_simulated_flights_are_read(rival: str, group: str) -> None:
    """Removes lens, mounting and attitude of a simulated flight: the position is right."""
    scene = next(s for s in paper_scenes() if s.group == group and abs(s.truth.x0_m) > 10)
    track = Track.of_flight(measure(scene, Noise(pixel_px=0.0, outliers=0.0)))
    answer = RIVALS[rival](track)
    truth = scene.truth
    middle = 0.0 if answer["box"] or truth.kind == "disc" else 0.5 * truth.length_m * math.cos(truth.orientation_rad)
    within = 0.01 if truth.kind == "disc" or answer["box"] else 0.05
    assert answer["z0_m"] == pytest.approx(truth.z0_m + middle, rel=within)
