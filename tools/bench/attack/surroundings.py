"""What a flat world without neighbors lacks: ground with steps and trees, bushes before the base, another obstacle, the
border of the image."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from . import solids
from .motion import Span
from .solids import Solid
from .view import Camera, Standpoint

CELL_M = 5.0  # a tree's crown
WOOD_M, GAP_M = (15.0, 60.0), (5.0, 25.0)  # lengths of woods and of the gaps between them
CLEARING_M = 15.0  # no trees this near to the obstacle's middle
BUSHES_MOST = 0.8  # of the obstacle's height that is hidden
NEIGHBOR_M = (3.0, 30.0)  # gap between the obstacle and the neighbor
HALF_VIEW_DEG = 35.0


def step_m(away_m: np.ndarray, size_m: float, rng: np.random.Generator) -> np.ndarray:
    """Height (K,) of the ground under the aircraft above the obstacle's: ``size_m``, up or down, in the first half of
    the way."""
    return size_m * rng.choice([-1.0, 1.0]) * (away_m > 0.5 * away_m[0])


def canopy_m(away_m: np.ndarray, height_m: Span, rng: np.random.Generator) -> np.ndarray:
    """Height (K,) of the trees' crowns under the aircraft, 0 in gaps; ``away_m``: distance from the obstacle."""
    cells = np.zeros(int(np.max(away_m) / CELL_M) + 1)
    begin = int(CLEARING_M / CELL_M)
    while begin < len(cells):
        end = begin + max(1, int(rng.uniform(*WOOD_M) / CELL_M))
        cells[begin:end] = rng.uniform(*height_m, len(cells[begin:end]))
        begin = end + max(1, int(rng.uniform(*GAP_M) / CELL_M))
    return cells[(away_m / CELL_M).astype(int)]


def hidden_m(
    solid: Solid, stand: Standpoint, low_m: Span, share: Span, until: float, rng: np.random.Generator
) -> np.ndarray:
    """Height (K,) below which bushes (``low_m``) or trees (``share`` of the obstacle's height) hide the obstacle, in
    the first part ``until`` of the images that show its middle."""
    height = min(rng.uniform(*low_m) + rng.uniform(*share) * solid.height_m, BUSHES_MOST * solid.height_m)
    in_view = np.flatnonzero(stand.camera.contains(stand.look(np.array([[0.0, 0.0, 0.5 * solid.height_m]])))[:, 0])
    first, last = (in_view[0], in_view[-1]) if len(in_view) else (0, len(stand.eye_m) - 1)
    ends = first + until * (last + 1 - first) if until < 1.0 else math.inf
    return height * (np.arange(len(stand.eye_m)) < ends)


def neighbor(solid: Solid, stand: Standpoint, size_m: Span, rng: np.random.Generator) -> tuple[Solid, Standpoint]:
    """Another obstacle next to the given one, and the same camera about it."""
    other = solids.drawn(str(rng.choice(["box", "cylinder"])), size_m, rng)
    bearing = rng.uniform(0.0, 2 * math.pi)
    distance = solid.half_m + other.half_m + rng.uniform(*NEIGHBOR_M)
    place = stand.middle_m + distance * np.array([math.sin(bearing), math.cos(bearing)])
    return other, replace(stand, middle_m=place, hidden_m=None)


def at_border(camera: Camera, place_m: np.ndarray, middle_m: np.ndarray, rng: np.random.Generator) -> Camera:
    """The camera, yawed so that the obstacle's middle is at the left or right border halfway; both places (K, ...)
    forward, right."""
    half = len(place_m) // 2
    forward, right = middle_m[half] - place_m[half, :2]
    yaw = math.degrees(math.atan2(right, forward)) + rng.choice([-1.0, 1.0]) * HALF_VIEW_DEG
    return replace(camera, mount_deg=(yaw, *camera.mount_deg[1:]))
