"""The window method's steps against other formulas: compositions, trigonometry, complex steps."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from bench.reference.gates import Gates
from bench.reference.settings import Settings
from bench.reference.window import WindowMethod
from bench.reference.window.fit import Mean, Ring
from bench.reference.window.geometry import (
    Lens,
    Point,
    disc_row,
    heading_deg,
    mounting_rotation,
    quaternion_rotation,
    undistort,
)
from bench.reference.window.orientation import Orientation
from bench.reference.window.precision import numbers
from bench.reference.window.view import Edge, View
from goe_tools.logs.obslog import Camera, ObservationLog
from goe_tools.logs.projection import CAMERA_AXES_IN_BODY, distort, quaternion_of, yaw_pitch_roll

N = numbers(np.float64)
PLAIN = Camera(1.0, 1.0, 1.0, 1.0, 0.0, 0.0)


def rodrigues(q: tuple[float, float, float, float]) -> np.ndarray:
    """The rotation matrix from the axis and the angle of the quaternion."""
    vector = np.asarray(q[1:])
    length = float(np.linalg.norm(vector))
    x, y, z = vector / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = 2.0 * math.atan2(length, q[0])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)


def test_rotations_against_compositions() -> None:
    generator = np.random.default_rng(3)
    for angles in generator.uniform(-180.0, 180.0, (50, 3)):
        matrix = yaw_pitch_roll(*angles)
        assert np.reshape(quaternion_rotation(N, quaternion_of(matrix)), (3, 3)) == pytest.approx(matrix, abs=1e-12)
        camera = replace(PLAIN, mount_yaw_deg=angles[0], mount_pitch_deg=angles[1], mount_roll_deg=angles[2])
        mounting = np.reshape(mounting_rotation(N, camera), (3, 3))
        assert mounting == pytest.approx(matrix @ CAMERA_AXES_IN_BODY, abs=1e-12)
    for q in generator.normal(0.0, 1.0, (50, 4)):  # of any length
        assert np.reshape(quaternion_rotation(N, q), (3, 3)) == pytest.approx(rodrigues(q), abs=1e-12)
    assert quaternion_rotation(N, (2.0, 0.0, 0.0, 0.0)) == pytest.approx(list(np.eye(3).ravel()))


def test_lens_is_inverted(real_camera: Camera) -> None:
    lens = Lens.of(N, real_camera)
    for x, y in itertools.product(np.linspace(-0.7, 0.7, 9), repeat=2):
        back_x, back_y, converged, _ = undistort(N, lens, *distort(real_camera, x, y))
        assert converged
        assert (back_x, back_y) == pytest.approx((x, y), abs=2e-9)
    fish = Lens.of(N, replace(real_camera, k1=-0.5, k2=0.0, k3=0.0))
    assert not undistort(N, fish, np.float64(1.2), np.float64(0.0))[2]


def aligned(x: float, y: float) -> Point:
    return Point(np.float64(x), np.float64(y), N.zero, N.zero)


def test_heading_is_the_printed_equation() -> None:
    """[(1)] With its fraction the right way up."""
    generator = np.random.default_rng(5)
    for xa, ya, xb, yb in generator.uniform(-1.0, 1.0, (200, 4)):
        dx = xa - ya * (xb - xa) / (yb - ya)
        assert heading_deg(N, aligned(xa, ya), aligned(xb, yb)) == pytest.approx(math.degrees(math.atan(dx)), abs=1e-9)
    assert heading_deg(N, aligned(-0.3, 0.2), aligned(0.4, 0.2)) == 90.0
    assert heading_deg(N, aligned(0.4, 0.2), aligned(-0.3, 0.2)) == 90.0


def test_disc_row_by_trigonometry() -> None:
    """[(2)]"""
    generator = np.random.default_rng(6)
    for left, right in np.sort(generator.uniform(-1.5, 1.5, (200, 2))):
        size = (right - left) * (math.cos(math.atan(left)) + math.cos(math.atan(right)))
        x = 0.5 * (left + right) * (1.0 - size**2 / 16.0)
        assert disc_row(N, left, right) == pytest.approx((2.0 * x / size, 2.0 / size), rel=1e-12)


def view_turned_by(b_deg: float) -> View:
    view = View(Gates())
    view.sin_b, view.cos_b = N.sincos_deg(np.float64(b_deg))
    return view


def test_turned_points_by_trigonometry() -> None:
    """[(4)]"""
    generator, method = np.random.default_rng(7), WindowMethod(PLAIN)
    for x, b in zip(generator.uniform(-1.5, 1.5, 300), generator.uniform(-90.0, 90.0, 300)):
        angle = math.atan(x) - math.radians(b)
        turned = method._turned(view_turned_by(b), "", aligned(x, 0.1))
        if math.cos(angle) > 0.05:
            assert turned == pytest.approx(math.tan(angle), rel=1e-9, abs=1e-12)
        else:
            assert turned is None


def test_sliding_mean() -> None:
    generator, mean, values = np.random.default_rng(8), Mean(Ring(8)), []
    for value in generator.normal(5.0, 1.0, 30):
        values = [*values, value][-8:]
        average, variance = mean.add(N, value, value)
        assert average == pytest.approx(np.mean(values), rel=1e-12)
        assert variance == pytest.approx(np.var(values, ddof=1) / len(values) if len(values) > 1 else 0.0, rel=1e-9)
        assert mean.ratio == min(values)


def shown(*headings_deg: float) -> View:
    """A view of edges with these headings."""
    edges = [Edge(aligned(0.0, 0.1), aligned(0.1, 0.2), True, np.float64(deg)) for deg in headings_deg]
    return View(Gates(), edges=edges)


def test_low_pass_of_lines_about_90_degrees() -> None:
    """The mean of the first 20, then each new one with weight 1/20. 91 and -89 degrees are the same line."""
    generator, orientation, steps = np.random.default_rng(9), Orientation(N, 20), [0.0]
    measured = generator.uniform(80.0, 100.0, 30)
    for k, deg in enumerate(measured):
        orientation._low_pass(Gates(), deg if deg <= 90.0 else deg - 180.0, 0.0, 180.0)
        if 0 < k < 20:
            steps.append(deg - np.mean(measured[:k]))
        if k < 20:
            assert orientation.deg % 180.0 == pytest.approx(np.mean(measured[: k + 1]), rel=1e-12)
            assert orientation.variance_deg2 == pytest.approx(np.mean(np.square(steps)), rel=1e-9)
    weights = np.concatenate([np.full(20, 0.95**10 / 20.0), 0.05 * 0.95 ** np.arange(9, -1, -1)])
    assert orientation.deg % 180.0 == pytest.approx(weights @ measured, rel=1e-12)


def test_a_guide_chooses_the_end_near_90_degrees() -> None:
    orientation, near = Orientation(N, 20), 90.0 - 1e-9
    assert orientation._choose_end(Gates({"end": False}), "end", near, 180.0) == near - 180.0
    assert orientation._choose_end(Gates({"end": True}), "end", -near, 180.0) == 180.0 - near
    assert orientation._choose_end(Gates({"end": True}), "end", near, 180.0) == near
    assert orientation._choose_end(Gates({"end": False}), "end", 80.0, 180.0) == 80.0  # too far to be followed


@pytest.mark.parametrize(("headings", "side"), [((46.0, -44.0), 0), ((-44.0, 46.0), 1), ((70.0, -20.0), 1)])
def test_the_low_pass_names_the_sides_where_the_angle_is_ambiguous(headings: tuple[float, float], side: int) -> None:
    orientation = Orientation(N, 20)
    for _ in range(5):
        orientation.update(shown(45.0))
    view = shown(*headings)
    orientation.update(view)
    assert view.side is view.edges[side] and view.front is view.edges[1 - side]
    assert view.side_is_right == (side == 1)


def spread_by_complex_steps(function, values: tuple[float, ...], sigmas: tuple[float, ...]) -> float:
    """The sigma of a function of independent values."""
    steps = [[value + (1e-30j if i == k else 0.0) for i, value in enumerate(values)] for k in range(len(values))]
    return math.sqrt(sum((function(*step).imag / 1e-30 * sigma) ** 2 for step, sigma in zip(steps, sigmas)))


def test_sigmas_of_quantities_derived_from_a_solution(corner_log: ObservationLog) -> None:
    """[(6), (7), (8)] The contribution of the solution to a length or height of one image and to the center."""
    camera, found = corner_log.camera, {"length_m": 0, "height_m": 0, "center": 0}
    method = WindowMethod(camera, Settings(model="line"))
    recorded: list[tuple[str, float, float]] = []
    take = method._take_extent

    def watched(gates, name, value, variance, roundoff, size) -> None:
        recorded.append((name, value, variance))
        take(gates, name, value, variance, roundoff, size)

    method._take_extent = watched
    for frame in corner_log.frames:
        recorded.clear()
        report = method.update(frame)
        fit, values, last = method.fit, report.estimate.values, {name: rest for name, *rest in recorded}
        if not report.fresh:
            continue
        solution = fit.x0_m, fit.z0_m, fit.width_m
        sigmas = fit.sigma["x0_m"], fit.sigma["z0_m"], fit.sigma["width_m"]
        b = math.radians(method.orientation.deg)
        if "height_m" in last:
            value, variance = last["height_m"]
            found["height_m"] += 1
            z = fit.z0_m - method.dz_m
            y = (frame.height_m - value) / z
            height = lambda x0, z0, w: frame.height_m - y * (z0 - method.dz_m)  # noqa: B023, E731
            assert math.sqrt(variance) == pytest.approx(spread_by_complex_steps(height, solution, sigmas), rel=1e-9)
        if "length_m" in last:
            value, variance = last["length_m"]
            found["length_m"] += 1
            half = 0.5 if fit.x0_m < 0.0 else -0.5  # an obstacle to the left shows its right side

            def across(x0, z0, w):  # (4) and (7): X_C of the side
                x, z = x0 - method.dx_m, z0 - method.dz_m
                return (x * math.cos(b) - z * math.sin(b)) + half * w  # noqa: B023

            inverse = value / across(*solution).real
            length = lambda x0, z0, w: inverse * across(x0, z0, w)  # noqa: B023, E731
            assert math.sqrt(variance) == pytest.approx(spread_by_complex_steps(length, solution, sigmas), rel=1e-9)
        if "center_n_m" in values:
            found["center"] += 1
            heading = math.atan2(*method.heading)
            inputs = fit.x0_m, fit.z0_m, values["length_m"], values["length_m"]
            off = sigmas[0], sigmas[1], values["length_sd_m"], values["length_sd_m"]

            def place(x0, z0, length_in_x, length_in_z):  # the method takes X and Z of the center as independent
                x, z = x0 + 0.5 * length_in_x * math.sin(b), z0 + 0.5 * length_in_z * math.cos(b)  # noqa: B023
                turn = complex(math.cos(heading), math.sin(heading))  # noqa: B023
                return z * turn.real - x * turn.imag, z * turn.imag + x * turn.real

            for i, axis in enumerate("ne"):
                expected = spread_by_complex_steps(lambda *v: place(*v)[i], inputs, off)  # noqa: B023
                assert values[f"center_{axis}_sd_m"] == pytest.approx(expected, rel=1e-9)
                middle = method.origin_m[i] + place(*inputs)[i]
                assert values[f"center_{axis}_m"] == pytest.approx(middle, rel=1e-12)
    assert min(found.values()) > 5, found
