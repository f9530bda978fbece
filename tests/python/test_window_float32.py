"""The window method in float32: single precision throughout, and close to the one in float64."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from bench.reference import minimax
from bench.reference.compare import MAX_RELATIVE, relative_difference
from bench.reference.settings import Settings
from bench.reference.window import WindowMethod
from bench.reference.window.polynomials import ATAN, COS, SIN, F, arctan_rad, sincos_deg
from bench.reference.window.precision import numbers
from goe_tools.logs.obslog import Camera, ObservationLog
from goe_tools.logs.scene import Scene, make_log

ROOT = Path(__file__).resolve().parents[2]


def test_arctangent() -> None:
    generator = np.random.default_rng(1)
    worst = 0.0
    for _ in range(4000):
        y, x = F(generator.normal() * 10.0 ** generator.integers(-5, 6)), F(abs(generator.normal()))
        angle = arctan_rad(y, x)
        assert type(angle) is np.float32
        worst = max(worst, abs(float(angle) - math.atan2(float(y), float(x))))
    assert worst <= 2e-7


def test_sine_and_cosine() -> None:
    worst = 0.0
    for deg in np.linspace(-720.0, 720.0, 4001).astype(np.float32):
        s, c = sincos_deg(deg)
        assert type(s) is type(c) is np.float32
        angle = math.radians(float(deg))
        worst = max(worst, abs(float(s) - math.sin(angle)), abs(float(c) - math.cos(angle)))
    assert worst <= 2e-7
    assert sincos_deg(F(90.0)) == (F(1.0), F(0.0))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_fold(dtype) -> None:
    fold_deg = numbers(dtype).fold_deg
    assert [float(fold_deg(dtype(deg))) for deg in (90.0, 90.5, -90.0, 0.0, 180.0, -270.0)] == [
        90,
        -89.5,
        90,
        0,
        0,
        -90,
    ]


def test_polynomials_are_those_of_the_library() -> None:
    """One set of constants in three places: the generator, the C source and the method in float32."""
    source = (ROOT / "lib" / "maths" / "goe_angle.c").read_text()
    in_c = {name: F(value) for name, value in re.findall(r"#define (\w+_\d) ([0-9.e-]+)f", source)}
    in_python = {"ATAN": ATAN, "SIN": SIN, "COS": COS}
    for problem in minimax.PROBLEMS:
        if problem.name not in in_python:  # the window method does not use it
            continue
        for number, coefficient in enumerate(minimax.remez(problem).coefficients, start=1):
            name = f"{problem.name}_{number}"
            assert in_c[name] == in_python[problem.name][number - 1], name
            assert float(in_c[name]) == pytest.approx(abs(coefficient), rel=1e-6), name


@pytest.mark.parametrize("rounding", ["none", "pixel"])
@pytest.mark.parametrize("model", ["auto", "disc", "line"])
def test_near_the_reference(rounding: str, model: str, real_camera: Camera) -> None:
    settings = Settings(model=model)
    for alpha, path in ((20.0, "weave"), (-30.0, "arc"), (5.0, "straight")):
        scene = Scene(
            width_m=12.0, length_m=20.0, height_m=25.0, x0_m=-25.0, z0_m=200.0, alpha_deg=alpha, path=path,
            weave_amplitude_m=3.0, altitude_m=20.0, wobble_deg=2.0, run_s=6.0, rounding=rounding, clip=True,
            camera=real_camera,
        )  # fmt: skip
        log = make_log(scene)
        single, double = WindowMethod(log.camera, settings, np.float32), WindowMethod(log.camera, settings)
        compared = 0
        for frame in log.frames:
            answer = single.update(frame)
            result = answer.estimate
            report = double.update(frame, answer.gates.taken)
            exact = report.estimate
            assert (result.status, result.model, result.images_used) == (exact.status, exact.model, exact.images_used)
            assert result.values.keys() == exact.values.keys()
            assert not report.gates.disputed
            if report.conditioning["width_m"] < 0.5:
                continue
            for name, value in result.values.items():
                assert type(value) is np.float32, name
                if not name.startswith(("height", "length", "center")):  # these also include older solutions
                    compared += 1
                    assert relative_difference(name, float(value), report) < MAX_RELATIVE, name
        assert compared > 200


def test_decisions_are_noted_under_the_same_names(corner_log: ObservationLog) -> None:
    """If only one precision noted a decision, the decisions could not be compared."""
    for model in ("auto", "disc", "line"):
        settings = Settings(model=model)
        camera = corner_log.camera
        single, double = WindowMethod(camera, settings, np.float32), WindowMethod(camera, settings)
        names = set()
        for frame in corner_log.frames:
            guide = single.update(frame).gates.taken
            taken = double.update(frame, guide).gates.taken
            assert taken == guide
            names |= taken.keys()
        assert {"baseline", "parallax", "abeam"} <= names


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e38, -1e38, 0.0, 1e-45])
def test_outputs_are_finite_whatever_comes(value: float, corner_log: ObservationLog) -> None:
    method = WindowMethod(corner_log.camera, dtype=np.float32)
    for k, frame in enumerate(corner_log.frames):
        if k % 5 == 3:
            frame.left = (value, value)
        if k % 7 == 4:
            frame.agl_m = value
        assert all(np.isfinite(number) for number in method.update(frame).estimate.values.values())
