"""Scenes of recorded flights: true and estimated states of an autopilot, with added obstacles."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..places import ROOT
from .flight import LEFT, RIGHT, Obstacle
from .noise import FIELD, Noise
from .rotations import level_axes
from .scene import Scene, look
from .simulated import IMAGE_RATE_HZ, MIN_IMAGES, pinhole

RECORDED_FOLDER = ROOT.parent / "shared" / "data" / "flights"
RECORDED_NOISE = {  # a user's configuration for these autopilots
    "px4": Noise(
        attitude_bias_sd_deg=1.2, attitude_white_sd_deg=0.15, attitude_walk_sd_deg=0.3, height_m=0.7,
        velocity_bias_sd_m_s=0.05,
        position_walk_sd_m=0.05,
    ),
    "arduplane": Noise(
        attitude_bias_sd_deg=0.3, attitude_white_sd_deg=0.05, attitude_walk_sd_deg=0.05, height_m=0.5,
        velocity_bias_sd_m_s=0.05,
        position_walk_sd_m=0.05,
    ),
}  # fmt: skip


@dataclass
class Recording:
    """True and estimated states of a flown autopilot, at about 8 Hz."""

    group: str
    time_s: np.ndarray
    true_position: np.ndarray
    true_attitude: np.ndarray
    position: np.ndarray
    attitude: np.ndarray


def read_recording(path: Path) -> Recording:
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))

    def columns(prefix: str, *names: str) -> np.ndarray:
        return np.array([[float(row[prefix + name]) for name in names] for row in rows])

    t = columns("", "t_s")[:, 0]
    step = max(1, round(1.0 / (IMAGE_RATE_HZ * float(np.median(np.diff(t))))))
    position, attitude = ("n_m", "e_m", "d_m"), ("qw", "qx", "qy", "qz")
    arrays = (columns("true_", *position), columns("true_", *attitude), columns("est_", *position))
    return Recording(
        path.stem.split("_")[0], t[::step], *(a[::step] for a in arrays), columns("est_", *attitude)[::step]
    )


def _scene_near(recording: Recording, rng: np.random.Generator) -> Scene | None:
    """A random obstacle near a random part of a recording; None if the part is unsuitable."""
    t, true = recording.time_s, recording.true_position
    start = int(rng.integers(0, len(t) - 60))
    run = rng.uniform(8.0, 18.0)
    end = int(np.searchsorted(t, t[start] + run))
    if end >= len(t):
        return None
    abeam = min(len(t) - 1, int(np.searchsorted(t, t[start] + run + rng.uniform(1.5, 3.0))))
    way = true[abeam, :2] - true[start, :2]
    z0 = float(np.linalg.norm(way))
    if z0 < 60.0:
        return None
    heading = math.atan2(way[1], way[0])
    side, box = (-1 if rng.random() < 0.5 else 1), rng.random() < 0.7
    width = float(np.exp(rng.uniform(math.log(1.5), math.log(12.0))))
    length = width * float(np.exp(rng.uniform(0.0, math.log(4.0)))) if box else width
    height = float(np.exp(rng.uniform(math.log(2.0), math.log(30.0))))
    x0, angle = side * rng.uniform(0.0, 0.15) * z0, math.radians(rng.uniform(-42.0, 42.0)) if box else 0.0
    part = slice(start, end)
    ground_d = float(true[part, 2].max() + rng.uniform(3.0, 8.0))
    moved = (true[part] - true[start]) @ level_axes(heading).T
    if (np.hypot(moved[:, 0] - x0, moved[:, 2] - z0) < 0.5 * math.hypot(width, 2 * length) + 3.0).any():
        return None
    camera = replace(pinhole(), heading_deg=math.degrees(heading))
    truth = Obstacle("box" if box else "disc", x0, z0, angle, width, length, height)
    none = np.zeros((end - start, 6))
    scene = Scene(
        f"{recording.group} {start}", recording.group, camera, t[part] - t[start], none, none, true[part],
        recording.true_attitude[part], ground_d - true[part, 2], truth, float(t[abeam] - t[start]),
        believed=(recording.position[part], recording.attitude[part], ground_d - recording.position[part, 2]),
        noise=RECORDED_NOISE.get(recording.group, FIELD),
    )  # fmt: skip
    look(scene, ground_d)
    in_view = scene.seen[:, [LEFT, RIGHT]].all(1)
    if in_view.sum() < MIN_IMAGES or not in_view[:10].any():
        return None
    begin = int(np.argmax(scene.seen.any(1)))
    return scene.trimmed(begin) if begin else scene


def recorded_scenes(count: int, folder: Path = RECORDED_FOLDER, seed: int = 1, tries: int = 5000) -> list[Scene]:
    """Up to ``count`` passes of each recorded flight in a folder, with added obstacles; none without the folder."""
    result: list[Scene] = []
    for path in sorted(Path(folder).glob("*.csv")):
        recording, rng = read_recording(path), np.random.default_rng(seed)
        found: list[Scene] = []
        for _ in range(tries):
            if len(found) >= count:
                break
            scene = _scene_near(recording, rng)
            if scene is not None:
                found.append(scene)
        result += found
    return result
