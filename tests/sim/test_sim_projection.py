"""The simulator's images against an independent projection to 1e-9 px; hidden corners and the image border by brute
force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sim_support import FEATURES, Camera, Log, box_corners, fly, passes_through_box, poses

PIXEL = 1e-9

# turbulence gives every frame another attitude; the options cover both sides, all slopes, lenses, mountings and courses
WILD = ("--wind", "dryden:moderate", "--noise", "none")
LENS = ("--k1", "-0.21", "--k2", "0.07", "--p1", "0.0012", "--p2", "-0.0009", "--k3", "-0.01")
MOUNT = (
    "--yaw-camera",
    "-17",
    "--pitch-camera",
    "-6",
    "--roll-camera",
    "4",
    "--offset-x",
    "1.5",
    "--offset-y",
    "-0.4",
    "--offset-z",
    "0.3",
)

BOXES = {
    "building": ("--obstacle", "building", "--alpha", "-20"),
    "building, level, still air": ("--obstacle", "building", "--alpha", "20", "--wind", "none"),
    "building, one face": ("--obstacle", "building", "--alpha", "0", "--x0", "0"),
    "truck from above": ("--obstacle", "truck", "--altitude", "12", "--glide", "6", "--alpha", "45"),
    "truck on the right": ("--obstacle", "truck", "--altitude", "9", "--x0", "12.5", "--yaw-camera", "30"),
    "long truck, lens": ("--obstacle", "long-truck", "--altitude", "15", "--alpha", "70", *LENS),
    "long truck, mounting": ("--obstacle", "long-truck", "--altitude", "15", "--alpha", "-110", *MOUNT),
    "box, odd camera": (
        "--obstacle",
        "box:9,3,5",
        "--altitude",
        "15",
        "--fx",
        "700",
        "--fy",
        "650",
        "--cx",
        "600",
        "--cy",
        "500",
        "--image-width",
        "1024",
        "--image-height",
        "768",
    ),
    "box, passed": (
        "--obstacle",
        "box:30,20,25",
        "--altitude",
        "30",
        "--x0",
        "-45",
        "--run",
        "26",
        "--yaw-camera",
        "-60",
        "--course",
        "217",
    ),
    "box on a weaving path": ("--obstacle", "box:9,3,5", "--path", "weave:6,9", "--altitude", "15", "--course", "-35"),
    "box on an arc": ("--obstacle", "box:9,3,5", "--path", "arc:900", "--altitude", "15"),
}
CYLINDERS = {
    "chimney": ("--obstacle", "cylinder"),
    "chimney, still air": ("--obstacle", "cylinder", "--wind", "none"),
    "chimney ahead": ("--obstacle", "cylinder", "--x0", "0", "--yaw-camera", "-5", "--run", "14"),
    "disc from above, lens": ("--obstacle", "disc:14,3", "--altitude", "25", *LENS),
    "disc, mounting": ("--obstacle", "disc:3,12", "--altitude", "20", "--course", "120", *MOUNT),
    "tall, cut by the frame": ("--obstacle", "disc:30,150", "--x0", "-50", "--altitude", "40"),
}


@pytest.fixture(scope="module", params=BOXES)
def box_log(request: pytest.FixtureRequest, goe_sim: Path, tmp_path_factory: pytest.TempPathFactory) -> Log:
    return fly(goe_sim, tmp_path_factory.mktemp("box") / "log", *WILD, "--seed", "5", *BOXES[request.param])


@pytest.fixture(scope="module", params=CYLINDERS)
def cylinder_options(request: pytest.FixtureRequest) -> tuple[str, ...]:
    return CYLINDERS[request.param]


def same(found: np.ndarray, pixel: np.ndarray) -> bool:
    return bool(np.all(np.abs(found - pixel) <= PIXEL))


def test_box_corners_are_where_an_independent_projection_puts_them(box_log: Log) -> None:
    """Base corners: exactly those inside the image that no part of the box hides, in order of bearing; top: above
    the nearest base corner."""
    camera, corners = Camera(box_log.camera), box_corners(box_log.truth)
    position, attitude = poses(box_log.exact)
    found = {name: box_log.pixels(name) for name in FEATURES}
    compared = 0
    for k in range(len(position)):
        eye = camera.eye(position[k], attitude[k])
        pixels, depth = camera.project(position[k], attitude[k], corners)
        surely, maybe = camera.inside(pixels, depth, PIXEL), camera.inside(pixels, depth, -PIXEL)
        to_center = np.arctan2(box_log.truth["center_e_m"] - eye[1], box_log.truth["center_n_m"] - eye[0])
        bearing = np.arctan2(corners[:4, 1] - eye[1], corners[:4, 0] - eye[0]) - to_center
        bearing = (bearing + np.pi) % (2 * np.pi) - np.pi
        visible = sorted(
            (i for i in range(4) if not passes_through_box(box_log.truth, eye, corners[i])), key=lambda i: bearing[i]
        )
        assert len(visible) in (2, 3)
        names = ("base_left", "base_near", "base_right") if len(visible) == 3 else ("base_left", "base_right")
        if len(visible) == 2:
            assert np.isnan(found["base_near"][k]).all()
        for name, i in zip(names, visible):
            if np.isnan(found[name][k, 0]):
                assert not surely[i]
            else:
                assert maybe[i] and same(found[name][k], pixels[i])
                compared += 1
        nearest = 4 + int(np.argmin(np.hypot(corners[:4, 0] - eye[0], corners[:4, 1] - eye[1])))
        if np.isnan(found["top"][k, 0]):
            assert not surely[nearest]
        else:
            assert maybe[nearest] and same(found["top"][k], pixels[nearest])
            compared += 1
    assert compared > 100


def test_box_silhouette_ends_at_the_outermost_corners(box_log: Log) -> None:
    camera, corners = Camera(box_log.camera), box_corners(box_log.truth)
    position, attitude = poses(box_log.exact)
    checked = 0
    for name, sign in (("left", 1.0), ("right", -1.0)):
        found = box_log.pixels(name)
        for k in range(len(position)):
            pixels, depth = camera.project(position[k], attitude[k], corners)
            if not (depth > 1e-3).all():
                assert np.isnan(found[k]).all() or np.nanmin(np.abs(found[k] - pixels)) <= PIXEL
                continue
            outermost = int(np.argmin(sign * pixels[:, 0]))
            inside = camera.inside(pixels, depth)
            ties = np.abs(pixels[:, 0] - pixels[outermost, 0]) <= PIXEL  # base and roof of one edge, camera level
            if np.isnan(found[k, 0]):
                assert not inside[ties].all()
            else:
                checked += 1
                assert any(same(found[k], pixels[i]) for i in np.flatnonzero(ties))
    assert checked > 50


def stretch_middle(camera: Camera, position: np.ndarray, attitude, foot: np.ndarray, height: float) -> np.ndarray:
    """Pixel of the middle of the visible part of an upright line, searched at 33 heights; NaN if none is visible."""
    line = foot + np.outer(np.linspace(0.0, 1.0, 33), [0.0, 0.0, -height])
    inside = np.flatnonzero(camera.inside(*camera.project(position, attitude, line)))
    if len(inside) == 0:
        return np.full(2, np.nan)
    middle = foot - np.array([0.0, 0.0, height * (inside[0] + inside[-1]) / 64.0])
    return camera.project(position, attitude, middle[None, :])[0][0]


def test_cylinder_tangents(goe_sim: Path, tmp_path: Path, cylinder_options: tuple[str, ...]) -> None:
    """Tangent points by Thales' circle: they lie on the circle whose diameter joins the eye and the axis."""
    log = fly(goe_sim, tmp_path / "log", *WILD, "--cylinder", "tangent", *cylinder_options)
    camera, truth = Camera(log.camera), log.truth
    position, attitude = poses(log.exact)
    axis, radius = np.array([truth["center_n_m"], truth["center_e_m"]]), truth["width_m"] / 2
    compared = 0
    for k in range(len(position)):
        eye = camera.eye(position[k], attitude[k])
        way = axis - eye[:2]
        distance = np.hypot(*way)
        ahead, aside = way / distance, np.array([-way[1], way[0]]) / distance
        reach = np.sqrt(distance**2 - radius**2)  # from the eye to a point of contact
        for name, sign in (("left", -1.0), ("right", 1.0)):
            touch = eye[:2] + reach / distance * (reach * ahead + sign * radius * aside)
            expected = stretch_middle(
                camera, position[k], attitude[k], np.array([*touch, truth["ground_d_m"]]), truth["height_m"]
            )
            found = log.pixels(name)[k]
            assert np.isnan(found).all() == np.isnan(expected).all()
            if not np.isnan(found).any():
                assert same(found, expected)
                compared += 1
        top = np.array([*(axis - radius * ahead), truth["ground_d_m"] - truth["height_m"]])
        pixel, depth = camera.project(position[k], attitude[k], top[None, :])
        assert np.isnan(log.pixels("top")[k, 0]) == (not camera.inside(pixel, depth)[0])
        if not np.isnan(log.pixels("top")[k, 0]):
            assert same(log.pixels("top")[k], pixel[0])
        assert all(np.isnan(log.pixels(name)[k]).all() for name in ("base_left", "base_near", "base_right"))
    assert compared > 100


def test_cylinder_cloud(goe_sim: Path, tmp_path: Path, cylinder_options: tuple[str, ...]) -> None:
    """The cloud (120 azimuths, 5 rings) ends at its own outermost points, just inside the tangents."""
    log = fly(goe_sim, tmp_path / "cloud", *WILD, "--cylinder", "cloud", *cylinder_options)
    camera, truth = Camera(log.camera), log.truth
    position, attitude = poses(log.exact)
    azimuth = np.radians(np.arange(0.0, 360.0, 3.0))
    radius = truth["width_m"] / 2
    ring = np.column_stack(
        [truth["center_n_m"] + radius * np.cos(azimuth), truth["center_e_m"] + radius * np.sin(azimuth)]
    )
    levels = truth["ground_d_m"] - truth["height_m"] * np.linspace(0.0, 1.0, 5)
    cloud = np.vstack([np.column_stack([ring, np.full(len(ring), d)]) for d in levels])
    compared = 0
    for k in range(len(position)):
        pixels, depth = camera.project(position[k], attitude[k], cloud)
        inside = camera.inside(pixels, depth)
        for name, outermost in (("left", int(np.argmin(pixels[:, 0]))), ("right", int(np.argmax(pixels[:, 0])))):
            found = log.pixels(name)[k]
            if (depth > 1e-3).all():
                ties = np.abs(pixels[:, 0] - pixels[outermost, 0]) <= PIXEL
                assert np.isnan(found[0]) == (not inside[ties].any())
                if not np.isnan(found[0]):
                    assert any(same(found, pixels[i]) for i in np.flatnonzero(ties))
                    compared += 1
    assert compared > 100


def test_cloud_fills_the_tangents_to_one_percent(goe_sim: Path, tmp_path: Path) -> None:
    """The ends of the cloud never pass the tangents, and miss little of the angle between them."""
    options = ("--noise", "none", "--obstacle", "cylinder", "--glide", "6", "--run", "16")
    bearings = {}
    for model in ("tangent", "cloud"):
        log = fly(goe_sim, tmp_path / model, *options, "--cylinder", model)
        camera = Camera(log.camera)
        _, attitude = poses(log.exact)
        for name in ("left", "right"):
            pixel = log.pixels(name)
            ray = np.column_stack([(pixel[:, 0] - 640) / 914, (pixel[:, 1] - 640) / 914, np.ones(len(pixel))])
            ned = attitude.apply(ray @ camera.axes_in_body)
            bearings[model, name] = np.arctan2(ned[:, 1], ned[:, 0])
    angle = bearings["tangent", "right"] - bearings["tangent", "left"]
    missed_left = (bearings["cloud", "left"] - bearings["tangent", "left"]) / angle
    missed_right = (bearings["tangent", "right"] - bearings["cloud", "right"]) / angle
    assert len(angle) == 129 and np.isfinite(angle).all()
    for missed in (missed_left, missed_right):
        assert (missed > -1e-12).all() and missed.max() < 0.01


def test_frame_cuts_features_off(goe_sim: Path, tmp_path: Path) -> None:
    """A flight past the obstacle's Z: at first all features are in the image, at the end none, and they vanish one
    by one."""
    log = fly(goe_sim, tmp_path / "log", "--obstacle", "building", "--alpha", "20", "--noise", "none", "--run", "60")
    count = sum((~np.isnan(log.pixels(name)[:, 0])).astype(int) for name in FEATURES)
    assert count[0] == 6 and count[-1] == 0
    assert set(range(1, 6)) & set(count.tolist())
    behind = log.exact["n_m"] > log.truth["center_n_m"] + 60
    assert behind.any() and (count[behind] == 0).all()


def test_lens_does_not_fold_the_outside_into_the_image(goe_sim: Path, tmp_path: Path) -> None:
    """A strong barrel lens maps rays beyond 60 degrees off its axis back into the image: they must not be visible."""
    log = fly(
        goe_sim,
        tmp_path / "log",
        "--obstacle",
        "truck",
        "--altitude",
        "5",
        "--x0",
        "-40",
        "--noise",
        "none",
        "--k1",
        "-0.3",
        "--run",
        "22",
        "--yaw-camera",
        "0",
    )
    camera = Camera(log.camera)
    position, attitude = poses(log.exact)
    folded = 0
    for k in range(len(position)):
        center = np.array([[log.truth["center_n_m"], log.truth["center_e_m"], log.truth["ground_d_m"]]])
        pixel, depth = camera.project(position[k], attitude[k], center)
        off_axis = np.degrees(np.arctan2(40.0, max(depth[0], 1e-9)))
        if off_axis > 50:
            folded += int(camera.inside(pixel, depth)[0])
            assert all(np.isnan(log.pixels(name)[k]).all() for name in FEATURES)
    assert folded > 0


@pytest.mark.parametrize("alpha", [-135.0, -90.0, -45.0, 0.0, 20.0, 90.0, 180.0])
@pytest.mark.parametrize("x0", [-30.0, 30.0])
def test_truth_says_where_the_obstacle_is(goe_sim: Path, tmp_path: Path, alpha: float, x0: float) -> None:
    """x0 counts to the right; front reference: middle of the near edge across the length axis; orientation mod 180."""
    log = fly(
        goe_sim,
        tmp_path / "log",
        "--obstacle",
        "long-truck",
        "--x0",
        x0,
        "--alpha",
        alpha,
        "--course",
        "70",
        "--offset-x",
        "2",
    )
    truth, course = log.truth, np.radians(70.0)
    assert truth["x0_m"] == pytest.approx(x0, abs=1e-9)
    axis_pitch = np.array(poses(log.exact)[1][0].apply([2.0, 0.0, 0.0]))
    assert truth["z0_m"] == pytest.approx(17.0 * 20.0 - np.hypot(*axis_pitch[:2]), abs=1e-9)
    right, ahead = np.array([-np.sin(course), np.cos(course)]), np.array([np.cos(course), np.sin(course)])
    center = np.array([truth["center_n_m"], truth["center_e_m"]])
    assert center == pytest.approx(340.0 * ahead + x0 * right, abs=1e-9)
    assert -90 < truth["orientation_deg"] <= 90
    assert (truth["orientation_deg"] - alpha) % 180 == pytest.approx(0.0, abs=1e-9)
    front = np.array([truth["front_x0_m"], truth["front_z0_m"]]) - np.array([truth["x0_m"], truth["z0_m"]])
    assert np.hypot(*front) == pytest.approx(9.0) and front[1] <= 1e-9
    assert np.degrees(np.arctan2(front[0], front[1])) % 180 == pytest.approx(truth["orientation_deg"] % 180, abs=1e-9)
