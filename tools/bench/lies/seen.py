"""Output of an ideal detector for a solid: image points and the upright box around its silhouette, without errors.

Also whether they are inside the image.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import optics, shapes
from .genes import Array, Params
from .optics import View
from .shapes import Solid

LEFT, RIGHT, TOP, BASE_LEFT, BASE_NEAR, BASE_RIGHT = range(6)  # points, as goe.POINTS
SIDES = 4  # left, top, right, bottom, as goe.SIDES
SIDE_AXIS = np.array([0, 1, 0, 1])
SIDE_SIGN = np.array([1.0, 1.0, -1.0, -1.0])  # sign of the coordinate that is smallest at the side


@dataclass
class Seen:
    """Of N images, px."""

    points: Array  # (N, 6, 2)
    point_there: np.ndarray  # (N, 6) in the image and not hidden by the solid itself
    box: Array  # (N, 4) of the whole silhouette
    side_there: np.ndarray  # (N, 4) the touching point of the side is in the image
    two_faces: np.ndarray  # (N,) of a cuboid are visible
    whole_ahead: np.ndarray  # (N,) the whole solid is ahead of the camera
    width: Array  # (N,) of the silhouette inside the image
    height: Array  # (N,)


def _rim_extremes(seen_by: View, solid: Solid, down: Array) -> Array:
    """(N, 4, 3): leftmost, rightmost, highest and lowest point of a rim in the image, without a lens. On a circle
    u = (a . e) / (d . e), e = (1, cos, sin), is stationary where P cos + Q sin + R = 0."""
    middle = np.einsum("nij,nj->ni", seen_by.axes, np.concatenate([solid.center, down[:, None]], 1))
    radius = solid.half[:, 0]
    e1, e2 = seen_by.axes[:, :, 0] * radius[:, None], seen_by.axes[:, :, 1] * radius[:, None]
    found = []
    for axis in (0, 1):
        a0, a1, a2 = middle[:, axis], e1[:, axis], e2[:, axis]
        d0, d1, d2 = middle[:, 2], e1[:, 2], e2[:, 2]
        p, q, r = a2 * d0 - a0 * d2, a0 * d1 - a1 * d0, a2 * d1 - a1 * d2
        size = np.maximum(np.hypot(p, q), 1e-12)
        turn, start = np.arccos(np.clip(-r / size, -1.0, 1.0)), np.arctan2(q, p)
        for angle in (start + turn, start - turn):
            level = solid.center + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
            found.append(np.concatenate([level, down[:, None]], 1))
    return np.stack(found, 1)


def _outline(seen_by: View, solid: Solid) -> Array:
    """(N, P, 3): points that include those touched by the upright box, unless a lens bends straight edges."""
    corners = solid.corners()
    cuboid = np.concatenate([shapes.upright(corners, solid.foot), shapes.upright(corners, solid.roof)], 1)
    cylinder = np.concatenate([_rim_extremes(seen_by, solid, solid.foot), _rim_extremes(seen_by, solid, solid.roof)], 1)
    return np.where(solid.round[:, None, None], cylinder, cuboid)


def extremes(pixels: Array, ahead: np.ndarray) -> Array:
    """(N, 4, 2): the touching points of the left, top, right and bottom side."""
    rows = np.arange(len(pixels))
    found = []
    for axis, sign in zip(SIDE_AXIS, SIDE_SIGN):
        key = np.where(ahead, sign * pixels[..., axis], np.inf)
        found.append(pixels[rows, key.argmin(1)])
    return np.stack(found, 1)


def _touching(seen_by: View, solid: Solid) -> tuple[Array, np.ndarray]:
    pixels, ahead = optics.project(seen_by, _outline(seen_by, solid))
    found, whole = extremes(pixels, ahead), ahead.all(1)
    bends = np.any(seen_by.lens != 0.0, 1)
    if bends.any():
        some, bent = solid.take(bends), seen_by.take(bends)
        more, more_ahead = optics.project(bent, shapes.wire(some))
        found[bends] = extremes(np.concatenate([pixels[bends], more], 1), np.concatenate([ahead[bends], more_ahead], 1))
        whole[bends] &= more_ahead.all(1)
    return found, whole


def _roof_extreme(seen_by: View, solid: Solid) -> Array:
    """(N, 3): highest point of the roof in the image."""
    corners = shapes.upright(solid.corners(), solid.roof)
    spots = np.where(solid.round[:, None, None], _rim_extremes(seen_by, solid, solid.roof), corners)
    pixels, ahead = optics.project(seen_by, spots)
    return spots[np.arange(len(spots)), np.where(ahead, pixels[..., 1], np.inf).argmin(1)]


def look(p: Params, flight: np.ndarray, seen_by: View, solid: Solid, hidden_m: Array) -> Seen:
    """``flight``: (N,) flight of each image. ``hidden_m``: (N,) height of the bushes in front of the base."""
    touching, whole = _touching(seen_by, replace(solid, foot=solid.foot - hidden_m))
    posts = shapes.sides(solid)
    level = solid.foot + (solid.roof - solid.foot) * p["side_height"][flight]
    top = shapes.upright(shapes.nearest_of_rim(solid)[:, None], solid.roof)
    highest = p["top_is_highest"][flight]
    top = np.where(highest[:, None, None], _roof_extreme(seen_by, solid)[:, None], top)
    base, base_there = shapes.visible_corners(solid)
    spots = np.concatenate([shapes.upright(posts, level), top, shapes.upright(base, solid.foot)], 1)
    points, ahead = optics.project(seen_by, spots)
    raw = p["sides_raw"][flight]
    points[raw, :2] = touching[raw][:, [0, 2]]
    ahead[raw, :2] = whole[raw, None]
    there = ahead & optics.in_image(seen_by, points)
    there[:, BASE_LEFT:] &= base_there & (hidden_m == 0.0)[:, None]
    box = touching[:, np.arange(SIDES), SIDE_AXIS]
    inside = np.clip(box.reshape(-1, 2, 2), 0.0, seen_by.size[:, None])
    extent = inside[:, 1] - inside[:, 0]
    side_there = optics.in_image(seen_by, touching) & whole[:, None]
    return Seen(points, there, box, side_there, base_there[:, 1], whole, extent[:, 0], extent[:, 1])
