"""Makes the input of an estimator from a scene: the truth plus errors of a noise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .flight import Flight
from .noise import Noise
from .rotations import multiply, small_rotations
from .scene import Scene


def _believed(scene: Scene, noise: Noise, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Estimated position, attitude and height."""
    if scene.believed is not None:
        return scene.believed
    t = scene.time_s
    bias = math.radians(noise.attitude_bias_sd_deg) * rng.standard_normal(3)
    white = math.radians(noise.attitude_white_sd_deg) * rng.standard_normal((len(t), 3))
    step = noise.position_walk_sd_m * np.sqrt(np.diff(t, prepend=t[0]))[:, None]
    position = scene.position_ned_m + np.cumsum(rng.standard_normal((len(t), 3)) * step, 0)
    position[:, :2] += noise.velocity_bias_sd_m_s * rng.standard_normal(2) * (t - t[0])[:, None]
    height = scene.height_m + noise.height_m * rng.standard_normal()
    return position, multiply(scene.attitude, small_rotations(bias + white)), height


def measure(scene: Scene, noise: Noise, seed: int | Sequence[int] = 1) -> Flight:
    """The flight of a scene with a noise."""
    rng = np.random.default_rng(seed)
    position, attitude, height = _believed(scene, noise, rng)
    pixels = scene.pixel_px + noise.pixel_px * rng.standard_normal(scene.pixel_px.shape)
    camera = scene.camera
    if noise.rounding:  # every seed shifts the pixel grid; otherwise all would round the same way
        shift = rng.uniform(-0.5, 0.5, 2)
        camera = replace(camera, cx=camera.cx + shift[0], cy=camera.cy + shift[1])
        pixels = np.rint(pixels + shift)
    hit = rng.random(pixels.shape[:2]) < noise.outliers
    angle = rng.random(pixels.shape[:2]) * 2 * math.pi
    pixels = pixels + (noise.outlier_px * hit)[..., None] * np.stack([np.cos(angle), np.sin(angle)], -1)
    return Flight(
        scene.name, scene.group, camera, scene.time_s, np.where(scene.seen[..., None], pixels, 0.0), scene.seen,
        position, attitude, height, scene.truth, noise, scene.reach_s,
    )  # fmt: skip
