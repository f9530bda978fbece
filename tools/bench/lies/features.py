"""The detector's reported features: those of a mix, with their errors, without missed or cut ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import errors
from .errors import EVEN_CUT, EVEN_PARTLY, PIXELS, SIDE_CORRELATED, SIDE_CUT, SIDE_WHITE, Draws
from .genes import Array, Params
from .motion import Motion
from .optics import View
from .seen import BASE_LEFT, BASE_NEAR, BASE_RIGHT, SIDES, TOP, Seen

BORDER_SHARE, CUT_SHARE = 0.012, 0.04  # goe.h
SMALLEST_PX = 1.0
BOTTOM = 3


@dataclass
class Detections:
    points: Array  # (N, 6, 2) NaN: not visible
    box: Array  # (N, 4)
    any_seen: np.ndarray  # (N,)
    near_hidden: np.ndarray  # (N,) base corners left and right are marked, but not the one between two visible faces
    cut: np.ndarray  # (N,) a side of a box cut by the image border is marked


def _points(p: Params, draws: Draws, kept: np.ndarray, flight: np.ndarray, looking: View, ideal: Seen) -> Array:
    rho = np.broadcast_to(p["point_correlation"][:, None], kept.shape)
    noise = errors.correlated(draws.series[..., PIXELS], rho)[kept].reshape(-1, 6, 2)
    share = np.where(np.arange(6) < BASE_LEFT, p["point_share"][flight, None], 0.0) * ideal.width[:, None]
    sigma = np.hypot(p["point_px"][flight, None], share) * p["pixel_scale"][flight, None]
    found = ideal.points + noise * sigma[..., None]
    inside = np.all((found >= 0.0) & (found <= looking.size[:, None]), -1)
    wanted = np.zeros((len(p["mix"]), 6), bool)
    wanted[:, :TOP] = p["has_sides"][:, None]
    wanted[:, TOP] = p["has_top"]
    wanted[:, BASE_LEFT:] = p["has_base"][:, None] & ~p["round"][:, None]
    for subset in range(1, 4):
        wanted[p["base_subset"] == subset, BASE_LEFT + subset - 1] = False
    wanted[p["has_box"], : TOP + 1] = False
    assert BASE_RIGHT == BASE_LEFT + 2
    return np.where((ideal.point_there & inside & wanted[flight])[..., None], found, np.nan)


def _cut(p: Params, flight: np.ndarray, looking: View, ideal: Seen) -> np.ndarray:
    """Whether the image border cuts the box by the library's definition: left or right is absent, or close to the
    border."""
    near = CUT_SHARE * looking.size[:, 0]
    right = looking.size[:, 0] - ideal.box[:, 2]
    return (ideal.box[:, 0] < near) | (right < near) | ~ideal.side_there[:, 0] | ~ideal.side_there[:, 2]


def _at_border(ideal: Seen, looking: View, even: Array) -> Array:
    """Sides of a box cut by the border, as a detector reports them."""
    inwards = even[:, None] * BORDER_SHARE * looking.size[:, :1] * 0.98
    limits = np.concatenate([0.0 * looking.size, looking.size], 1)
    sign = np.array([1.0, 1.0, -1.0, -1.0])
    beyond = sign * (ideal.box - limits) < 0.0
    return np.where(beyond, limits + sign * inwards, np.nan)


def _boxes(
    p: Params, draws: Draws, moved: Motion, kept: np.ndarray, flight: np.ndarray, looking: View, ideal: Seen
) -> Array:
    step = np.diff(moved.t_s, axis=1, prepend=moved.t_s[:, :1])
    fades = np.exp(-step / np.maximum(p["correlation_s"], 1e-6)[:, None])
    slow = errors.correlated(draws.series[..., SIDE_CORRELATED], fades)[kept]
    extent = np.stack([ideal.width, ideal.height] * 2, 1)
    cut = (_cut(p, flight, looking, ideal) & p["cut_drawn"][flight])[:, None] * p["cut_noise"][flight, None]
    noise = p["box_px"][flight, None] * draws.series[..., SIDE_WHITE][kept]
    noise = noise + extent * (p["box_share"][flight, None] * slow + cut * draws.series[..., SIDE_CUT][kept])
    found = np.where(ideal.side_there, ideal.box + noise * p["pixel_scale"][flight, None], np.nan)
    limits = np.concatenate([looking.size, looking.size], 1)
    found[(found < 0.0) | (found > limits)] = np.nan
    drawn = (p["cut_reported"] & p["size_configured"])[flight] & ideal.side_there.any(1) & ideal.whole_ahead
    border = _at_border(ideal, looking, draws.even[..., EVEN_CUT][kept])
    found = np.where(drawn[:, None] & np.isnan(found), border, found)
    found[~p["has_bottom"][flight], BOTTOM] = np.nan
    bad = (found[:, 2] - found[:, 0] < SMALLEST_PX) | (found[:, 3] - found[:, 1] < SMALLEST_PX) | ~p["has_box"][flight]
    found[bad] = np.nan
    return found


def detect(
    p: Params, draws: Draws, moved: Motion, kept: np.ndarray, flight: np.ndarray, looking: View, ideal: Seen,
    detected: np.ndarray,
) -> Detections:  # fmt: skip
    points, box = _points(p, draws, kept, flight, looking, ideal), _boxes(p, draws, moved, kept, flight, looking, ideal)
    part = draws.even[..., EVEN_PARTLY][kept] < p["partly_share"][flight, None]
    points[part[:, :6] | ~detected[:, None]] = np.nan
    box[part[:, 6:] | ~detected[:, None]] = np.nan
    assert box.shape[1] == SIDES
    given = np.isfinite(points[..., 0])
    near_hidden = given[:, BASE_LEFT] & given[:, BASE_RIGHT] & ~given[:, BASE_NEAR] & ideal.two_faces
    boxed = np.isfinite(box).any(1)
    return Detections(points, box, given.any(1) | boxed, near_hidden, boxed & ~ideal.side_there.all(1))
