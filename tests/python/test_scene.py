"""Synthetic logs: their geometry against an independent projection formula."""

from __future__ import annotations

import math
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench.reference.settings import Settings as SettingsOfWindow
from bench.reference.window import WindowMethod
from goe_tools.__main__ import main
from goe_tools.flights.logged import from_log
from goe_tools.logs.obslog import FEATURES, Camera, Frame, ObservationLog, read_log, write_log
from goe_tools.logs.projection import distort, quaternion_of, yaw_pitch_roll
from goe_tools.logs.scene import Scene, make_log

ROOT = Path(__file__).resolve().parents[2]

PINHOLE = Camera(1280.0, 1280.0, 914.0, 900.0, 640.0, 620.0)


def hamilton(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Product of two quaternions (w, x, y, z)."""
    w, v = a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.array([w, *v])


def turned_back(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """NED -> body: conjugate(q) v q, in quaternion arithmetic."""
    conjugate = np.array([q[0], -q[1], -q[2], -q[3]])
    return hamilton(hamilton(conjugate, np.array([0.0, *v])), q)[1:]


def turned(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return hamilton(hamilton(q, np.array([0.0, *v])), np.array([q[0], -q[1], -q[2], -q[3]]))[1:]


def axis_quaternion(axis: int, deg: float) -> np.ndarray:
    result = np.array([math.cos(math.radians(deg) / 2), 0.0, 0.0, 0.0])
    result[1 + axis] = math.sin(math.radians(deg) / 2)
    return result


def pixel_of(camera: Camera, frame: Frame, point: np.ndarray) -> tuple[float, float]:
    """Independent of the scene's matrices: quaternions all the way."""
    attitude = np.array(frame.attitude)
    lever = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
    ray = turned_back(attitude, point - (np.array(frame.position_m) + turned(attitude, lever)))
    mount = hamilton(
        hamilton(axis_quaternion(2, camera.mount_yaw_deg), axis_quaternion(1, camera.mount_pitch_deg)),
        axis_quaternion(0, camera.mount_roll_deg),
    )
    forward, right, down = turned_back(mount, ray)
    x, y = right / forward, down / forward
    r2 = x * x + y * y
    radial = 1 + camera.k1 * r2 + camera.k2 * r2**2 + camera.k3 * r2**3
    x, y = (
        x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x),
        y * radial + camera.p1 * (r2 + 2 * y * y) + 2 * camera.p2 * x * y,
    )
    return camera.fx * x + camera.cx, camera.fy * y + camera.cy


def box_corners(log: ObservationLog) -> dict[str, np.ndarray]:
    """The base corners of the only obstacle by its truth, in the view along its length axis: near/far, left/right."""
    (truth,) = log.truth.values()
    heading = math.radians(truth.heading_deg)
    along, across = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    center = np.array([truth.center_n_m, truth.center_e_m])
    result = {}
    for depth, a in (("near", -0.5), ("far", 0.5)):
        for side, b in (("left", -0.5), ("right", 0.5)):
            corner = center + a * truth.length_m * along + b * truth.width_m * across
            result[f"{depth}_{side}"] = np.array([*corner, truth.ground_d_m])
    return result


@pytest.mark.parametrize("path", ["straight", "arc", "weave"])
@pytest.mark.parametrize("glide_deg", [0.0, 6.0])
def test_box_left_of_the_path(path: str, glide_deg: float, real_camera: Camera) -> None:
    scene = Scene(
        width_m=10.0, length_m=16.0, height_m=12.0, x0_m=-40.0, z0_m=200.0, alpha_deg=10.0, path=path, run_s=3.0,
        arc_radius_m=-600.0, altitude_m=40.0, glide_deg=glide_deg, course_deg=-70.0, wobble_deg=2.0,
        acceleration_mps2=1.0, start_ne_m=(500.0, -300.0), ground_d_m=-120.0, camera=real_camera,
    )  # fmt: skip
    log = make_log(scene)
    corners = box_corners(log)
    # Left of the path: the front and the right side are visible, and meet at the near right corner.
    visible = {
        "base_left": corners["near_left"],
        "base_near": corners["near_right"],
        "base_right": corners["far_right"],
        "left": corners["near_left"] - [0, 0, 6.0],
        "right": corners["far_right"] - [0, 0, 6.0],
    }
    for frame in log.frames:
        for name, point in visible.items():
            assert getattr(frame, name) == pytest.approx(pixel_of(real_camera, frame, point), abs=1e-8), name
        tops = [pixel_of(real_camera, frame, corner - [0, 0, 12.0]) for corner in corners.values()]
        # (the highest of the undistorted image: the lens may exchange corners that are level to a fraction of a pixel)
        assert frame.top[1] == pytest.approx(min(v for _, v in tops), abs=1.5)
        assert min(math.dist(frame.top, pixel) for pixel in tops) < 1e-8


def test_box_right_of_the_path_shows_its_left_side() -> None:
    log = make_log(Scene(width_m=10.0, length_m=16.0, x0_m=40.0, z0_m=200.0, alpha_deg=-10.0, run_s=1.0))
    corners = box_corners(log)
    frame = log.frames[-1]
    assert frame.base_left == pytest.approx(pixel_of(log.camera, frame, corners["far_left"]))
    assert frame.base_near == pytest.approx(pixel_of(log.camera, frame, corners["near_left"]))
    assert frame.base_right == pytest.approx(pixel_of(log.camera, frame, corners["near_right"]))


def test_head_on_one_face_is_visible() -> None:
    log = make_log(Scene(width_m=10.0, length_m=16.0, x0_m=0.0, z0_m=200.0, alpha_deg=0.0, run_s=1.0, camera=PINHOLE))
    for frame in log.frames:
        assert frame.base_near is None
        assert frame.base_left[1] == pytest.approx(frame.base_right[1])
        assert frame.base_left[0] + frame.base_right[0] == pytest.approx(2 * PINHOLE.cx)


def test_truth_is_where_x0_z0_say() -> None:
    scene = Scene(x0_m=-12.0, z0_m=100.0, alpha_deg=30.0, length_m=8.0, course_deg=90.0, start_ne_m=(10.0, 20.0))
    (truth,) = make_log(scene).truth.values()
    # T: Z east, X south. Middle of the front edge at east 120, north 22; the center is 4 m farther along the length
    # axis.
    assert truth.center_e_m == pytest.approx(20.0 + 100.0 + 4.0 * math.cos(math.radians(30.0)))
    assert truth.center_n_m == pytest.approx(10.0 + 12.0 - 4.0 * math.sin(math.radians(30.0)))
    assert truth.heading_deg == pytest.approx(120.0)


@pytest.mark.parametrize("x0_m", [-30.0, 0.0, 25.0])
def test_cylinder_tangents_are_exact(x0_m: float) -> None:
    camera = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0)
    scene = Scene("cylinder", 6.0, 6.0, 30.0, x0_m=x0_m, z0_m=150.0, altitude_m=15.0, run_s=4.0, camera=camera)
    for k, frame in enumerate(make_log(scene).frames):
        x, z = x0_m, 150.0 - 17.0 * k / 8.0
        left, right = (math.atan((pixel[0] - 640.0) / 914.0) for pixel in (frame.left, frame.right))
        # the bearing of the center bisects the tangents, and the sine of half their angle is r/d
        assert 0.5 * (left + right) == pytest.approx(math.atan2(x, z), abs=1e-12)
        assert math.sin(0.5 * (right - left)) == pytest.approx(3.0 / math.hypot(x, z), rel=1e-11)
        assert frame.base_left is None


@pytest.mark.parametrize("altitude_m", [10.0, 60.0])
def test_cylinder_top_is_the_highest_point_of_the_rim(altitude_m: float, real_camera: Camera) -> None:
    camera = Camera(**{**vars(real_camera), "k1": 0.0, "k2": 0.0, "k3": 0.0, "p1": 0.0, "p2": 0.0})
    scene = Scene(
        "cylinder", 12.0, 12.0, 30.0, x0_m=-20.0, z0_m=90.0, altitude_m=altitude_m, run_s=1.0, wobble_deg=3.0,
        camera=camera,
    )  # fmt: skip
    log = make_log(scene)
    (truth,) = log.truth.values()
    for frame in log.frames[::2]:
        rim = []
        for angle in np.linspace(0.0, 2.0 * math.pi, 361):
            offset = np.array([6.0 * math.cos(angle), 6.0 * math.sin(angle), -30.0])
            point = np.array([truth.center_n_m, truth.center_e_m, truth.ground_d_m]) + offset
            rim.append(pixel_of(camera, frame, point)[1])
        assert frame.top[1] <= min(rim) + 1e-9
        assert frame.top[1] == pytest.approx(min(rim), abs=2e-3)  # the finest resolution of the samples


def test_rounding_is_to_whole_pixels_and_no_more() -> None:
    scene = {"alpha_deg": 20.0, "width_m": 10.0, "run_s": 4.0}
    exact = make_log(Scene(**scene))
    rounded = make_log(Scene(**scene, rounding="pixel"))
    for a, b in zip(exact.frames, rounded.frames):
        assert a.position_m == b.position_m
        for name in ("left", "right", "top", "base_left", "base_near", "base_right"):
            assert all(value == round(value) for value in getattr(b, name))
            assert np.max(np.abs(np.subtract(getattr(a, name), getattr(b, name)))) <= 0.5


def test_pixel_noise_is_reproducible_and_of_the_configured_size() -> None:
    scene = {"run_s": 25.0, "speed_mps": 1.0, "alpha_deg": 20.0}
    exact, first, again = (make_log(Scene(**scene, pixel_sigma_px=sigma, seed=3)) for sigma in (0.0, 2.0, 2.0))
    assert first.frames == again.frames
    noise = [np.subtract(a.left, b.left) for a, b in zip(exact.frames, first.frames)]
    assert np.std(noise) == pytest.approx(2.0, rel=0.1)
    assert abs(np.mean(noise)) < 0.3


def test_clipping_and_points_behind() -> None:
    log = make_log(Scene(x0_m=-30.0, z0_m=60.0, width_m=10.0, run_s=5.0, clip=True))
    inside = [frame for frame in log.frames if frame.left]
    outside = [frame for frame in log.frames if not frame.left]
    assert inside
    assert outside
    assert all(0.0 <= frame.left[0] <= 1280.0 for frame in inside)
    unclipped = make_log(Scene(x0_m=-30.0, z0_m=60.0, width_m=10.0, run_s=5.0))
    assert unclipped.frames[-1].left is None  # abeam: behind the image plane
    assert sum(frame.left is not None for frame in unclipped.frames) > len(inside)


def test_points_where_the_lens_model_bends_back_are_not_visible() -> None:
    camera = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0, k1=-0.3)
    turning = 1.0 / math.sqrt(0.9)  # r (1 - 0.3 r^2) is steepest up to here
    in_view = []
    for z in np.linspace(10.0, 60.0, 200):
        log = make_log(Scene("cylinder", 2.0, 2.0, 2.0, x0_m=-30.0, z0_m=float(z), run_s=0.0, camera=camera))
        if log.frames[0].left:
            in_view.append(30.0 / z)
    assert 0.7 * turning < max(in_view) < turning
    assert distort(camera, turning, 0.0)[0] > distort(camera, 1.2 * turning, 0.0)[0]


def test_quaternion_is_the_rotation() -> None:
    generator = np.random.default_rng(5)
    for yaw, pitch, roll in generator.uniform(-180.0, 180.0, (100, 3)):
        q = quaternion_of(yaw_pitch_roll(yaw, pitch, roll))
        parts = (axis_quaternion(2, yaw), axis_quaternion(1, pitch), axis_quaternion(0, roll))
        expected = hamilton(hamilton(parts[0], parts[1]), parts[2])
        expected *= 1.0 if expected[0] >= 0.0 else -1.0
        assert q == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("shape", ["cylinder", "box"])
def test_the_track_begins_with_the_first_image_that_shows_a_feature(shape: str, tmp_path: Path) -> None:
    """On an arc, with a camera that looks aside: truth and flight use the same T as an estimator."""
    scene = Scene(
        shape, 8.0, 14.0, 15.0, x0_m=60.0, z0_m=200.0, alpha_deg=40.0, path="arc", arc_radius_m=-900.0, run_s=10.0,
        clip=True, camera=replace(PINHOLE, mount_yaw_deg=60.0),
    )  # fmt: skip
    log = make_log(scene)
    shown = [any(getattr(frame, name) is not None for name in FEATURES) for frame in log.frames]
    assert 5 < shown.index(True) < 40
    of_log = {name: float(log.truth[1].extra[name]) for name in ("x0_m", "z0_m", "track_heading_deg")}
    assert of_log["track_heading_deg"] < -2.0
    settings = SettingsOfWindow(model="disc" if shape == "cylinder" else "line")
    method = WindowMethod(log.camera, settings, np.float32)
    values = [method.update(frame).estimate.values for frame in log.frames][-20]
    assert values["x0_m"] == pytest.approx(of_log["x0_m"], abs=0.5)
    assert values["z0_m"] == pytest.approx(of_log["z0_m"], abs=1.0)
    if shape == "box":
        assert values["orientation_deg"] == pytest.approx(float(log.truth[1].extra["orientation_deg"]), abs=1.0)
    write_log(tmp_path, log)
    (flight,) = from_log(tmp_path)
    assert (flight.truth.x0_m, flight.truth.z0_m) == (of_log["x0_m"], of_log["z0_m"])
    assert len(flight.time_s) == len(log.frames) - shown.index(True) and flight.seen[0].any()


def test_a_path_into_the_ground_is_refused() -> None:
    with pytest.raises(ValueError, match=r"hits the ground after 1.1"):
        make_log(Scene(altitude_m=2.0, glide_deg=6.0, run_s=8.0))


def test_command_line(tmp_path, capsys) -> None:
    out = tmp_path / "log"
    arguments = shlex.split(
        "scene --obstacle box:4,8,3 --x0 -9 --reach 10 --run 2 --alpha 15 --path arc:-400 --speed-profile ramp:1.5 "
        f"--noise rounding --out {out}"
    )
    assert main(arguments) == 0
    assert "17 rows" in capsys.readouterr().out
    log = read_log(out)
    assert len(log.frames) == 17
    assert log.truth[1].length_m == 8.0
    assert float(log.truth[1].extra["z0_m"]) == 170.0


@pytest.mark.parametrize(
    "arguments",
    [["--obstacle", "tower"], ["--obstacle", "box:1,2"], ["--obstacle", "box:1,2,-3"], ["--path", "arc:0"],
     ["--noise", "some"], ["--lens", "1,2"]],
)  # fmt: skip
def test_bad_usage(arguments: list[str], tmp_path, capsys) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["scene", *arguments, "--out", str(tmp_path / "log")])
    assert stop.value.code == 2
    assert arguments[1].rpartition(":")[2] in capsys.readouterr().err
    assert not (tmp_path / "log").exists()


@pytest.mark.parametrize(
    ("option", "value", "reason"),
    [
        ("--fps", "0", "must be 0.01 to 1000"),
        ("--fps", "-8", "must be 0.01 to 1000"),
        ("--fps", "nan", "is not finite"),
        ("--run", "-1", "must be 0 to 3600"),
        ("--run", "inf", "is not finite"),
        ("--speed", "0", "must be above 0"),
        ("--altitude", "-20", "must be above 0"),
        ("--x0", "left", "is not a number"),
        ("--glide", "90", "must be -80 to 80"),
    ],
)
def test_numbers_outside_their_range(
    option: str, value: str, reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["scene", f"{option}={value}", "--out", str(tmp_path / "log")])
    assert stop.value.code == 2
    assert f"argument {option}: '{value}' {reason}" in capsys.readouterr().err
    assert not (tmp_path / "log").exists()


def test_only_its_own_log_is_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of an edited or foreign log no byte changes."""
    words = ["scene", "--run", "2", "--out", str(tmp_path)]
    assert main(words) == 0 and main([*words, "--x0", "3"]) == 0
    capsys.readouterr()
    frames = tmp_path / "frames.csv"
    for edited in (frames.read_text() + "\n", None):
        if edited is None:
            (tmp_path / "camera.ini").unlink()
        else:
            frames.write_text(edited)
        before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        assert main(words) == 2
        reported = capsys.readouterr().err
        assert f"{tmp_path}: contains " in reported and "which this command did not write" in reported
        assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_bad_scene_writes_nothing(tmp_path, capsys) -> None:
    assert main(["scene", "--altitude", "1", "--glide", "6", "--out", str(tmp_path / "log")]) == 2
    assert "hits the ground" in capsys.readouterr().err
    assert not (tmp_path / "log").exists()


def test_the_committed_log_is_made_by_its_documented_command(tmp_path, capsys) -> None:
    """Pixels are whole and must be equal. Poses may differ in the last bits by another machine's sine."""
    text = (ROOT / "tests" / "data" / "README.md").read_text()
    (command,) = [part for part in text.split("\n\n") if part.strip().startswith("python -m goe_tools scene")]
    words = shlex.split(command.replace("\\\n", " "))
    assert words[-2:] == ["--out", "tests/data/corner"]
    assert main([*words[3:-1], str(tmp_path)]) == 0
    made, committed = read_log(tmp_path), read_log(ROOT / "tests" / "data" / "corner")
    assert made.camera == committed.camera
    assert len(made.frames) == len(committed.frames)
    for a, b in zip(made.frames, committed.frames):
        pose = {"position_m": b.position_m, "attitude": b.attitude, "agl_m": b.agl_m}
        assert replace(a, **pose) == b
        for name, value in pose.items():
            assert getattr(a, name) == pytest.approx(value, rel=1e-12, abs=1e-12)
    assert made.truth[1].center_n_m == pytest.approx(committed.truth[1].center_n_m)
