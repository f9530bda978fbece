"""The window method in float64: exact on exact data, with correct sigmas, and wrong only by the terms that the paper
omits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from bench.reference import dense
from bench.reference.gates import Gates
from bench.reference.settings import Settings
from bench.reference.window import Report, WindowMethod
from bench.reference.window.fit import Fit, Row, solve
from bench.reference.window.precision import numbers
from goe_tools.logs.obslog import Camera, Frame, ObservationLog
from goe_tools.logs.scene import Scene, make_log


def fly(log: ObservationLog, **settings: object) -> list[Report]:
    reference = WindowMethod(log.camera, Settings(**settings))
    return [reference.update(frame) for frame in log.frames]


DOUBLE = numbers(np.float64)


def solved(rows: list[Row]) -> tuple[str, Fit | None]:
    return solve(DOUBLE, rows, np.float64(0.1), Gates())


def row(xi: float, zeta: float, dx_m: float, dz_m: float) -> Row:
    return Row(*(np.float64(value) for value in (xi, zeta, dx_m, dz_m)))


def random_rows(generator: np.random.Generator, noise: float) -> list[Row]:
    width, x0, z0 = generator.uniform(2.0, 20.0), generator.uniform(-60.0, 60.0), generator.uniform(80.0, 400.0)
    rows = []
    for k in range(generator.integers(3, 20)):
        dx, dz = generator.normal(0.0, 1.0), 4.0 * k
        xi, zeta = (x0 - dx) / width, (z0 - dz) / width
        rows.append(row(xi + noise * generator.normal(), zeta + noise * generator.normal(), dx, dz))
    return rows


def check_against_dense(rows: list[Row], fit: Fit, generator: np.random.Generator) -> None:
    """In the dense system each image has its own orientation, as in the paper."""
    paper = []
    for item in rows:
        b = generator.uniform(-0.7, 0.7)
        c, s = math.cos(b), math.sin(b)
        forward, aside = c * item.zeta + s * item.xi, c * item.xi - s * item.zeta
        paper.append(dense.DenseRow(forward, aside, c, s, item.dx_m, item.dz_m))
    expected = dense.solve(paper)
    noise = expected.residual * math.sqrt(2 * len(rows) / (2 * len(rows) - 3))  # of a row, estimated from its residuals
    rounding = math.sqrt(np.mean([item.roundoff**2 + (item.roundoff_m / expected.width_m) ** 2 for item in rows]))
    for name in ("width_m", "x0_m", "z0_m"):
        assert getattr(fit, name) == pytest.approx(getattr(expected, name), rel=1e-9)
        assert fit.sigma[name] == pytest.approx(expected.sigma[name], rel=1e-9)
        assert fit.roundoff[name] == pytest.approx(rounding * expected.sigma[name] / noise, rel=1e-9)
    assert fit.residual == pytest.approx(expected.residual, rel=1e-9)
    assert fit.baseline_m == pytest.approx(expected.baseline_m, rel=1e-12)


def test_closed_form_is_the_dense_solution() -> None:
    """[(5)]"""
    generator = np.random.default_rng(1)
    for _ in range(100):
        rows = random_rows(generator, 0.02)
        status, fit = solved(rows)
        assert status == "ok"
        check_against_dense(rows, fit, generator)


@pytest.mark.parametrize("model", ["disc", "line"])
def test_every_window_of_a_flight_is_the_dense_solution(model: str, corner_log: ObservationLog) -> None:
    generator, method, checked = np.random.default_rng(4), WindowMethod(corner_log.camera, Settings(model=model)), 0
    for frame in corner_log.frames:
        if method.update(frame).fresh:
            check_against_dense(method.rows[model].items, method.fit, generator)
            checked += 1
    assert checked > 20


def test_sigmas_are_the_spread_of_the_solutions() -> None:
    generator = np.random.default_rng(2)
    clean, noise = random_rows(generator, 0.0), 1e-4
    fits = []
    for _ in range(1000):
        noisy = [replace(item, xi=item.xi + noise * generator.normal(), zeta=item.zeta + noise * generator.normal())
                 for item in clean]  # fmt: skip
        fits.append(solved(noisy)[1])
    for name in ("width_m", "x0_m", "z0_m"):
        spread = np.std([getattr(fit, name) for fit in fits])
        assert math.sqrt(np.mean([fit.sigma[name] ** 2 for fit in fits])) == pytest.approx(spread, rel=0.1)


def test_a_system_without_a_solution_is_refused() -> None:
    assert solved([row(1.0, 20.0, 0.0, 0.0)] * 8)[0] == "no_baseline"
    assert solved([row(1.0, 20.0, 0.0, 2.0 * k) for k in range(8)])[0] == "no_parallax"
    assert solved([row(1.0, 20.0 + k, 0.0, 2.0 * k) for k in range(8)])[0] == "no_parallax"
    assert solved([row(1.0, (5.0 - 2.0 * k) / 3.0, 0.0, 2.0 * k) for k in range(8)])[0] == "abeam"


@pytest.mark.parametrize("path", ["straight", "arc", "weave"])
@pytest.mark.parametrize("glide_deg", [0.0, 6.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("acceleration", [0.0, 1.5])
def test_exact_boxes_are_recovered(
    path: str, glide_deg: float, side: float, acceleration: float, real_camera: Camera
) -> None:
    for alpha in (-35.0, -15.0, 20.0, 40.0):
        scene = Scene(
            width_m=15.0, length_m=20.0, height_m=60.0, x0_m=30.0 * side, z0_m=220.0, alpha_deg=alpha, path=path,
            arc_radius_m=-900.0 * side, weave_amplitude_m=3.0, altitude_m=45.0, glide_deg=glide_deg, course_deg=123.0,
            acceleration_mps2=acceleration, wobble_deg=2.0, run_s=4.0, fps_hz=6.0, start_ne_m=(300.0, -200.0),
            ground_d_m=-70.0, camera=real_camera, clip=True,
        )  # fmt: skip
        log = make_log(scene)
        report = fly(log)[-1]
        values = report.estimate.values
        assert report.estimate.model == "line"
        assert values["x0_m"] == pytest.approx(scene.x0_m, rel=1e-9)
        assert values["z0_m"] == pytest.approx(220.0, rel=1e-9)
        assert values["width_m"] == pytest.approx(15.0, rel=1e-9)
        assert values["length_m"] == pytest.approx(20.0, rel=1e-9)
        assert values["orientation_deg"] == pytest.approx(alpha, abs=1e-9)
        assert values["center_n_m"] == pytest.approx(log.truth[1].center_n_m, rel=1e-9)
        assert values["center_e_m"] == pytest.approx(log.truth[1].center_e_m, rel=1e-9)
        assert report.residual < 1e-10
        for name in ("x0_sd_m", "z0_sd_m", "width_sd_m", "orientation_sd_deg"):
            assert values[name] < 1e-6


def test_height_is_off_by_the_top_points_own_distance() -> None:
    """(8) takes the height at the reference point's distance: h - (h - H) Z/Z_top exactly."""
    scene = Scene(
        width_m=15.0, length_m=20.0, height_m=60.0, x0_m=-30.0, z0_m=250.0, alpha_deg=20.0, altitude_m=45.0, run_s=6.0
    )
    log = make_log(scene)
    report = fly(log)[-1]
    near = 250.0 - 7.5 * math.sin(math.radians(20.0))  # the front edge's right end is the nearest corner
    predicted = []
    for k in range(len(log.frames) - 8, len(log.frames)):
        flown = 17.0 * k / 8.0
        predicted.append(45.0 - (45.0 - 60.0) * (250.0 - flown) / (near - flown))
    assert abs(np.mean(predicted) - 60.0) > 0.1
    assert report.estimate.values["height_m"] == pytest.approx(np.mean(predicted), rel=1e-9)


@pytest.mark.parametrize("x0_m", [0.0, 15.0, -40.0])
def test_disc_rows_are_off_as_the_analysis_says(x0_m: float) -> None:
    """(2): the position row is exact, the size row is off by r^2 X^2 / (Z^2 d^2)."""
    log = make_log(Scene("cylinder", 6.0, 6.0, 30.0, x0_m=x0_m, z0_m=180.0, altitude_m=15.0, run_s=6.0))
    reference = WindowMethod(log.camera, Settings(model="disc"))
    for k, frame in enumerate(log.frames):
        reference.update(frame)
        ring = reference.rows["disc"]
        newest = ring.items[ring.next - 1]
        z = 180.0 - 17.0 * k / 8.0
        predicted = 9.0 * x0_m**2 / (z**2 * (x0_m**2 + z**2))
        assert newest.xi / newest.zeta == pytest.approx(x0_m / z, rel=2e-6, abs=1e-12)
        assert abs(newest.zeta * 6.0 / (2.0 * z) * 2.0 - 1.0) == pytest.approx(predicted, rel=0.1, abs=1e-9)
    values = reference.update(replace(log.frames[-1], t_s=99.0)).estimate.values
    if x0_m == 0.0:
        assert values["width_m"] == pytest.approx(6.0, rel=1e-7)
        assert values["z0_m"] == pytest.approx(180.0, rel=1e-7)


def frame_at(t_s: float, **changes: object) -> Frame:
    fields = {"left": (500.0, 600.0), "right": (520.0, 600.0)}
    return Frame(t_s, 1, (t_s * 17.0, 0.0, -30.0), (1.0, 0.0, 0.0, 0.0), **{**fields, **changes})


@pytest.mark.parametrize(
    ("frame", "status"),
    [
        (frame_at(1.0, left=(math.nan, 0.0)), "not_finite"),
        (frame_at(1.0, agl_m=math.inf), "not_finite"),
        (frame_at(1.0, left=(2e5, math.nan)), "not_finite"),
        (frame_at(1.0, left=(2e5, 0.0)), "out_of_range"),
        (frame_at(1.0, agl_m=2e5), "out_of_range"),
        (frame_at(0.0), "bad_time"),
        (frame_at(-1.0), "bad_time"),
        (replace(frame_at(1.0), t_s=math.nan), "bad_time"),
        (replace(frame_at(1.0), attitude=(0.0, 0.0, 0.0, 0.0)), "bad_attitude"),
        (replace(frame_at(1.0), attitude=(1.02, 0.0, 0.0, 0.0)), "bad_attitude"),
        (replace(frame_at(1.0), attitude=(5.0, 0.0, 0.0, 0.0)), "bad_attitude"),
        (replace(frame_at(1.0), attitude=(1.005, 0.0, 0.0, 0.0)), "converging"),
        (frame_at(1.0, left=(520.0, 600.0), right=(500.0, 600.0)), "swapped"),
        (frame_at(1.0, base_left=(520.0, 700.0), base_right=(500.0, 700.0)), "swapped"),
        (frame_at(1.0, left=None, right=None), "no_detection"),
        (frame_at(1.0, left=None), "converging"),
        (replace(frame_at(1.0), attitude=(0.0, 0.0, 0.0, 1.0)), "converging"),
        (replace(frame_at(1.0), attitude=(0.0, 0.0, 0.0, 1.0), left=None, right=None), "no_detection"),
    ],
)
def test_statuses_of_one_image(frame: Frame, status: str) -> None:
    camera = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0)
    double, single = WindowMethod(camera), WindowMethod(camera, dtype=np.float32)
    for method in (double, single):
        assert method.update(frame_at(0.0)).estimate.status == "converging"
        assert method.update(frame).estimate.status == status


def test_a_turn_begins_no_track_where_the_heading_is_set() -> None:
    camera = Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0, heading_deg=0.0)
    double, single = WindowMethod(camera), WindowMethod(camera, dtype=np.float32)
    behind = replace(frame_at(1.0), attitude=(0.0, 0.0, 0.0, 1.0))
    for method in (double, single):
        assert method.update(frame_at(0.0)).estimate.status == "converging"
        assert method.update(behind).estimate.status == "behind_camera"


def test_refused_images_change_nothing() -> None:
    log = make_log(Scene(width_m=10.0, alpha_deg=20.0, run_s=4.0))
    camera, frames = log.camera, log.frames
    clean, dirty = WindowMethod(camera), WindowMethod(camera)
    for k, frame in enumerate(frames):
        expected = clean.update(frame).estimate
        assert dirty.update(frame).estimate == expected
        if k % 3 == 0:
            bad = replace(frame, t_s=frame.t_s + 0.01, position_m=(math.nan, 0.0, 0.0))
            refused = dirty.update(bad).estimate
            assert refused.status == "not_finite"
            assert refused.values == expected.values


def test_disc_is_reported_until_the_line_takes_over() -> None:
    log = make_log(Scene(width_m=12.0, length_m=20.0, alpha_deg=20.0, run_s=6.0))
    models = [report.estimate.model for report in fly(log)]
    assert models[:7] == ["none"] * 7
    assert set(models[7:]) == {"line"}
    models = [report.estimate.model for report in fly(log, line_points=20)]
    assert models[7:19] == ["disc"] * 12
    assert set(models[19:]) == {"line"}
    assert {report.estimate.model for report in fly(log, model="disc")[7:]} == {"disc"}


def test_guided_decisions() -> None:
    gates = Gates({"near": True, "far": True, "same": True})
    assert gates.decide("near", False, -1e-7, 1.0)
    assert not gates.decide("far", False, -1e-3, 1.0)
    assert gates.decide("same", True, 1.0, 1.0)
    assert not gates.decide("unknown", False, -1e-9, 1.0)
    assert gates.followed == ["near"]
    assert gates.disputed == ["far"]
