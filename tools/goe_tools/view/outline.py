"""The outline of an estimate from above, as goe_hazard uses it, and its 2-sigma region.

Outline: the box; without orientation or length, and for discs and prisms, the circle of its width around the
reference point. goe_hazard's circle of a prism is that across the present line of sight, as near as the near
side: after a turn it differs from the drawn one. Region: the hull of the 2-sigma ellipses of the outline's points (a
box's corners, points of a circle), each to the first order from the covariance of x, z, orientation, width, length.

Axes: T's, (x right, z forward) from the camera, meters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SIGMAS = 2.0
RIM_POINTS = 24  # of a circle, for its region
REGION_POINTS = 40
TINY_M = 1e-6
CORNERS = np.array([[-0.5, 0.0], [0.5, 0.0], [0.5, 1.0], [-0.5, 1.0]])  # across in widths, along in lengths


@dataclass
class Outlines:
    """Over K images; NaN: none. A row has a circle or corners."""

    circle: np.ndarray  # (K, 3) x, z, radius
    corner: np.ndarray  # (K, 4, 2)
    region: np.ndarray  # (K, REGION_POINTS, 2)


def corners(x: np.ndarray, z: np.ndarray, angle: np.ndarray, width: np.ndarray, length: np.ndarray) -> np.ndarray:
    """(K, 4, 2): near left, near right, far right, far left; ``angle`` of the length axis from z, clockwise, rad."""
    along, across = np.stack([np.sin(angle), np.cos(angle)], -1), np.stack([np.cos(angle), -np.sin(angle)], -1)
    steps = (CORNERS[:, 0] * width[:, None])[..., None] * across[:, None]
    steps = steps + (CORNERS[:, 1] * length[:, None])[..., None] * along[:, None]
    return np.stack([x, z], -1)[:, None] + steps


def _corner_slopes(angle: np.ndarray, width: np.ndarray, length: np.ndarray) -> np.ndarray:
    """(K, 4, 2, 5): derivatives of the corners by x, z, angle, width, length."""
    along, across = np.stack([np.sin(angle), np.cos(angle)], -1), np.stack([np.cos(angle), -np.sin(angle)], -1)
    slopes = np.zeros((len(angle), 4, 2, 5))
    slopes[:, :, 0, 0] = slopes[:, :, 1, 1] = 1.0
    for i, (side, end) in enumerate(CORNERS):
        slopes[:, i, :, 2] = (end * length)[:, None] * across - (side * width)[:, None] * along
        slopes[:, i, :, 3], slopes[:, i, :, 4] = side * across, end * along
    return slopes


def _rim(count: int) -> np.ndarray:
    turn = 2.0 * np.pi * np.arange(count) / count
    return np.stack([np.sin(turn), np.cos(turn)], -1)


def _rim_slopes(count: int) -> np.ndarray:
    """(RIM_POINTS, 2, 5)"""
    slopes = np.zeros((count, 2, 5))
    slopes[:, 0, 0] = slopes[:, 1, 1] = 1.0
    slopes[:, :, 3] = 0.5 * _rim(count)
    return slopes


def _directions(spread: np.ndarray, size: np.ndarray) -> np.ndarray:
    """(K, REGION_POINTS, 2): outward normals for evenly distributed points of the hull, also of a long thin one."""
    shape = spread + (size**2)[:, None, None] * np.eye(2)
    variance, axes = np.linalg.eigh(shape)
    narrow = _rim(REGION_POINTS) @ (axes / np.sqrt(np.maximum(variance, TINY_M**2))[:, None]).transpose(0, 2, 1)
    return narrow / np.linalg.norm(narrow, axis=-1, keepdims=True)


def hull(points: np.ndarray, spreads: np.ndarray, size: np.ndarray) -> np.ndarray:
    """(K, REGION_POINTS, 2): points on the hull of the 2-sigma ellipses around points (K, P, 2) with covariances
    (K, P, 2, 2); ``size`` (K,) of the outline, m."""
    normal = _directions(spreads[:, 0], size)
    pushed = np.einsum("kpij,kdj->kdpi", spreads, normal)
    sigma = np.sqrt(np.maximum(np.einsum("kdi,kdpi->kdp", normal, pushed), TINY_M**2))
    reach = np.einsum("kdi,kpi->kdp", normal, points) + SIGMAS * sigma
    best = reach.argmax(-1)[..., None, None]
    edge = points[:, None] + SIGMAS * pushed / sigma[..., None]
    return np.take_along_axis(edge, np.broadcast_to(best, (*best.shape[:3], 2)), 2)[:, :, 0]


def outlines(
    column: dict[str, np.ndarray], model: list[str], covariance: np.ndarray, spare_m: np.ndarray | float = 0.0
) -> Outlines:
    """Of the columns x_m, z_m, orientation_deg, width_m, length_m. ``spare_m``: least radius of a circle that
    represents a box, or without a known width."""
    x, z = column["x_m"], column["z_m"]
    angle, width, length = np.radians(column["orientation_deg"]), column["width_m"], column["length_m"]
    count, there = len(x), np.isfinite(z)
    solid = np.array([name not in ("disc", "prism") for name in model], bool)
    box = there & solid & np.isfinite(angle) & np.isfinite(width) & np.isfinite(length)
    round_ = there & ~box
    result = Outlines(*(np.full((count, *shape), np.nan) for shape in ((3,), (4, 2), (REGION_POINTS, 2))))
    radius = 0.5 * np.nan_to_num(width)
    radius = np.where(solid | ~np.isfinite(width), np.maximum(radius, spare_m), radius)[round_]
    result.circle[round_] = np.stack([x[round_], z[round_], radius], -1)
    rim = result.circle[round_][:, None, :2] + radius[:, None, None] * _rim(RIM_POINTS)
    slopes = np.broadcast_to(_rim_slopes(RIM_POINTS), (len(rim), RIM_POINTS, 2, 5))
    result.region[round_] = _hull(rim, slopes, covariance[round_], radius)
    result.corner[box] = corners(x[box], z[box], angle[box], width[box], length[box])
    slopes = _corner_slopes(angle[box], width[box], length[box])
    size = 0.5 * np.maximum(width[box], length[box])
    result.region[box] = _hull(result.corner[box], slopes, covariance[box], size)
    return result


def _hull(points: np.ndarray, slopes: np.ndarray, covariance: np.ndarray, size: np.ndarray) -> np.ndarray:
    return hull(points, np.einsum("kpiu,kuv,kpjv->kpij", slopes, covariance, slopes), size)


def nearest_on_outline(point: np.ndarray, circle: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """(K, 2): of each row's outline, the point nearest to ``point`` (K, 2); the point itself inside."""
    result = np.full(point.shape, np.nan)
    middle, radius = circle[:, :2], circle[:, 2]
    away = point - middle
    distance = np.linalg.norm(away, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        onto = middle + away * (radius / distance)[:, None]
        result = np.where((distance > radius)[:, None], onto, point)
    boxes = np.isfinite(corner[:, 0, 0])
    if boxes.any():
        start = corner[boxes]
        edge = np.roll(start, -1, 1) - start
        off = point[boxes, None] - start
        share = np.clip((off * edge).sum(-1) / np.maximum((edge * edge).sum(-1), TINY_M**2), 0.0, 1.0)
        foot = start + share[..., None] * edge
        best = np.linalg.norm(point[boxes, None] - foot, axis=-1).argmin(1)
        side = edge[..., 0] * off[..., 1] - edge[..., 1] * off[..., 0]
        inside = (side <= 0.0).all(1) | (side >= 0.0).all(1)
        result[boxes] = np.where(inside[:, None], point[boxes], foot[np.arange(len(foot)), best])
    return result
