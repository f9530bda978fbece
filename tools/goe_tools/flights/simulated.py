"""Simulated scenes: those of the paper's Table 2, and random ones."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..logs.obslog import Camera
from .flight import BASE_LEFT, BASE_RIGHT, LEFT, RIGHT, Obstacle
from .rotations import quaternions
from .scene import Scene, look

GRAVITY_MPS2 = 9.81
IMAGE_RATE_HZ = 8.0
MIN_IMAGES = 40  # with the obstacle in view, for a random scene
PAPER = (  # name, kind, W, L, H, offsets, altitudes, run, reach: m and s, Table 2 of the paper
    ("cylinder", "disc", 6.0, 6.0, 30.0, (0.0, 30.0, 60.0), (15.0,), 19.0, 20.0),
    ("building", "box", 15.0, 40.0, 89.0, (0.0, 75.0, 150.0), (44.5,), 30.0, 40.0),
    ("truck", "box", 2.5, 7.0, 2.5, (0.0, 12.5, 25.0), (2.5, 5.0), 18.0, 20.0),
    ("long-truck", "box", 2.5, 18.0, 4.0, (0.0, 12.5, 25.0), (4.0, 8.0), 18.0, 20.0),
)
PAPER_SPEED_MPS = 17.0


def pinhole(yaw_deg: float = 0.0) -> Camera:
    """The paper's camera: 70 degrees, 1280 x 1280 pixels; T's heading is north."""
    return Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0, mount_yaw_deg=yaw_deg, heading_deg=0.0)


@dataclass
class Course:
    """A flight to simulate. ``argument``: for an arc the radius in m, positive to the right; for a weave the amplitude
    in m and the period in s."""

    run_s: float
    speed_mps: float
    altitude_m: float
    glide_deg: float
    reach_s: float
    acceleration_mps2: float = 0.0
    path: str = "straight"
    argument: tuple[float, ...] = ()


def simulate(name: str, group: str, camera: Camera, truth: Obstacle, course: Course, phases: np.ndarray) -> Scene:
    """Flies a course; ``phases``: (3,) rad, of the attitude's oscillations of 1 and 2 degrees."""
    t = np.arange(math.floor(course.run_s * IMAGE_RATE_HZ + 1e-9) + 1) / IMAGE_RATE_HZ
    s = course.speed_mps * t + 0.5 * course.acceleration_mps2 * t * t
    direction, north, east = np.zeros_like(t), s, np.zeros_like(t)
    if course.path == "arc":
        (radius,) = course.argument
        direction = s / radius
        north, east = radius * np.sin(direction), radius * (1.0 - np.cos(direction))
    elif course.path == "weave":
        amplitude, period = course.argument
        rate = 2 * math.pi / period
        east = amplitude * np.sin(rate * t)
        direction = np.arctan(amplitude * rate * np.cos(rate * t) / course.speed_mps)
    glide = math.radians(course.glide_deg)
    height = course.altitude_m + np.maximum(course.speed_mps * course.reach_s - s, 0.0) * math.tan(glide)
    bank = np.gradient(direction, t) * course.speed_mps / GRAVITY_MPS2
    sway = [math.radians(1.0) * np.sin(2 * math.pi * t / p + q) for p, q in zip((2.3, 3.1, 1.7), phases)]
    attitude = quaternions(direction + sway[0], math.radians(3.0) - glide + sway[1], bank + 2 * sway[2])
    position = np.stack([north, east, -height], 1)
    none = np.zeros((len(t), 6))
    scene = Scene(name, group, camera, t, none, none, position, attitude, height, truth, course.reach_s)
    look(scene, 0.0)
    return scene


def paper_scenes() -> list[Scene]:
    """The 156 cases of the paper's Table 2."""
    phase = np.random.default_rng(5)
    result = []
    for name, kind, width, length, height, offsets, altitudes, run, reach in PAPER:
        angles = (-45, -20, 0, 20, 45) if kind == "box" else (0,)
        for x0, altitude, angle, glide in (
            (x, a, b, g) for x in offsets for a in altitudes for b in angles for g in (0, 6)
        ):
            truth = Obstacle(kind, -x0, PAPER_SPEED_MPS * reach, math.radians(angle), width, length, height)
            course = Course(run, PAPER_SPEED_MPS, altitude, glide, reach)
            label = f"{name} x{x0:g} altitude{altitude:g} angle{angle} glide{glide}"
            result.append(simulate(label, name, pinhole(-30.0), truth, course, phase.random(3) * 2 * math.pi))
    return result


def _random_scene(rng: np.random.Generator, number: int) -> Scene:
    log_uniform = lambda low, high: float(np.exp(rng.uniform(math.log(low), math.log(high))))  # noqa: E731
    box = rng.random() < 0.7
    width = log_uniform(1.5, 20.0)
    length, height = width * log_uniform(0.5, 5.0), log_uniform(2.0, 50.0)
    speed, reach = rng.uniform(10.0, 28.0), rng.uniform(12.0, 25.0)
    side = -1 if rng.random() < 0.5 else 1
    z0 = speed * reach
    x0 = side * rng.uniform(0.0, 0.35) * z0 * rng.random()
    angle = math.radians(rng.uniform(-42.0, 42.0))
    camera = pinhole(side * 30.0 if rng.random() < 0.7 else 0.0)
    path = ("straight", "arc", "weave")[rng.integers(3)]
    argument: tuple[float, ...] = ()
    if path == "arc":
        argument = (float(rng.choice([-1, 1]) * rng.uniform(500.0, 1500.0)),)
    elif path == "weave":
        argument = (float(rng.uniform(2.0, 10.0)), float(rng.uniform(5.0, 12.0)))
    altitude = rng.uniform(max(2.5, 0.4 * height), max(5.0, 1.5 * height))
    glide = float(rng.choice([0, 0, 3, 6]))
    run = reach - rng.uniform(1.5, 3.0) - (0.5 * width + 2.0) / speed
    if not box:
        length, angle = width, 0.0
    truth = Obstacle("box" if box else "disc", float(x0), float(z0), angle, width, length, height)
    course = Course(run, speed, altitude, glide, reach, rng.uniform(-0.3, 0.3), path, argument)
    group = "random box" if box else "random cylinder"
    return simulate(f"{group} {number}", group, camera, truth, course, rng.random(3) * 2 * math.pi)


def random_scenes(count: int, scenario: int = 7) -> list[Scene]:
    """Boxes and cylinders of random size, side, orientation, speed and path that stay in view long enough; the
    track starts when the obstacle comes into view."""
    rng = np.random.default_rng(scenario)
    result: list[Scene] = []
    number = 0
    while len(result) < count:
        number += 1
        scene = _random_scene(rng, number)
        needed = [LEFT, RIGHT, BASE_LEFT, BASE_RIGHT] if scene.truth.kind == "box" else [LEFT, RIGHT]
        in_view = scene.seen[:, needed].all(1)
        if in_view.sum() >= MIN_IMAGES and in_view[:20].any():
            result.append(scene.trimmed(int(np.argmax(in_view))))
    return result
