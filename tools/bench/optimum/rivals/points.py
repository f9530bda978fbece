"""From single located points to the obstacle: the common part of all point-wise methods.

A method that locates points does not model boxes or cylinders. This file associates image points with corners, for all
such methods: while the near corner stays visible, the three base corners keep their identity, and likewise while it
stays invisible; the longest such sequence of images is used. A cylinder has no corners, but the bisector of
its tangents passes through its axis in every image, so the axis is located as a point.
"""

from __future__ import annotations

from typing import Callable, Optional

import numpy as np
from goe_tools.flights.flight import BASE_LEFT, BASE_NEAR, BASE_RIGHT, TOP

from .track import MIN_IMAGES, Silhouette, Track

Located = Optional[tuple[np.ndarray, np.ndarray]]  # point (3,) m and its covariance (3,3) m^2, T
Locate = Callable[[np.ndarray, np.ndarray, float], Located]  # aligned points (n,2), cameras (n,3) m, sigma
Values = dict[str, float]

TWO_FACES_SHARE = 0.25  # a sequence with two faces gives all sides: it is preferred from this share of the images on
OUTLIER = 5.0  # robust sigmas
STEP = 1e-4  # m, for numerical derivatives
RIM_WANDER = 0.125  # of the width
FLAT = [0, 2]  # X and Z of a point


def estimate(track: Track, locate: Locate) -> Values:
    """Box if its base corners are visible, otherwise cylinder; empty if neither can be located."""
    stretch = corner_stretch(track)
    return cylinder(track, locate) if stretch is None else box(track, locate, *stretch)


def corner_stretch(track: Track) -> tuple[np.ndarray, list[int]] | None:
    """Image numbers (n,) in which the base corners keep their identity, and which corners they are."""
    left, near, right = track.seen[:, [BASE_LEFT, BASE_NEAR, BASE_RIGHT]].T
    faces = np.where(near & (left | right), 2, np.where(left & right & ~near, 1, 0))
    rows = np.flatnonzero(faces)
    if len(rows) < MIN_IMAGES:
        return None
    stretches = np.split(rows, np.flatnonzero(np.diff(faces[rows])) + 1)
    two = [s for s in stretches if faces[s[0]] == 2 and len(s) >= max(MIN_IMAGES, TWO_FACES_SHARE * len(rows))]
    best = max(two or stretches, key=len)
    return best, [BASE_LEFT, BASE_NEAR, BASE_RIGHT] if faces[best[0]] == 2 else [BASE_LEFT, BASE_RIGHT]


def located(track: Track, locate: Locate, rows: np.ndarray, feature: int) -> Located:
    """Locates one feature from the images ``rows`` in which it is visible."""
    rows = rows[track.seen[rows, feature]]
    if len(rows) < MIN_IMAGES:
        return None
    return locate(track.points[rows, feature], track.cameras()[rows], track.point_sigma)


def box(track: Track, locate: Locate, rows: np.ndarray, corners: list[int]) -> Values:
    """Two or three base corners and the top, each located separately -> the box."""
    found = [located(track, locate, rows, feature) for feature in corners]
    if any(f is None for f in found):
        return {}
    top = located(track, locate, rows, TOP)
    points = np.array([f[0] for f in [*found, top] if f is not None])
    covariances = [f[1] for f in [*found, top] if f is not None]
    weights = edge_weights(points[: len(corners)], covariances)
    names = ["x0_m", "z0_m", "orientation_rad", "width_m"]
    names += ["length_m"] * (len(corners) == 3) + ["height_m"] * (top is not None)

    def quantities(flat: np.ndarray) -> np.ndarray:
        return box_quantities(flat.reshape(-1, 3), len(corners), weights)

    covariance = np.zeros((points.size, points.size))
    for i, c in enumerate(covariances):
        covariance[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = c
    return {**with_sigmas(names, quantities, points.ravel(), covariance), "box": 1.0}


def edge_weights(corners: np.ndarray, covariances: list[np.ndarray]) -> np.ndarray:
    """1/variance of each edge's direction; corners (2 or 3, 3)."""
    weights = []
    for i in range(len(corners) - 1):
        edge = (corners[i + 1] - corners[i])[FLAT]
        across = np.array([-edge[1], edge[0]]) / (edge @ edge)
        spread = (covariances[i] + covariances[i + 1])[np.ix_(FLAT, FLAT)]
        weights.append(1.0 / (across @ spread @ across + 1e-12))
    return np.array(weights)


def box_quantities(points: np.ndarray, corners: int, weights: np.ndarray) -> np.ndarray:
    """x0, z0, orientation, width[, length][, height] from base corners, left to right, and then the top.

    A single edge is called the front; of two, the one more perpendicular to Z. Orientation: of the length axis, from Z
    towards X, rad.
    """
    base, top = points[:corners], points[corners:]
    edges = np.diff(base[:, FLAT], axis=0)
    angles = np.arctan2(-edges[:, 1], edges[:, 0])  # each edge taken as the front
    height = [base[1, 1] - top[0, 1] if corners == 3 else base[:, 1].mean() - top[0, 1]] if len(top) else []
    if corners == 2:
        half_turn = np.pi * np.round(angles[0] / np.pi)
        middle = base[:, FLAT].mean(0)
        return np.array([*middle, angles[0] - half_turn, np.linalg.norm(edges[0]), *height])
    angle = np.angle(np.sum(weights * np.exp(4j * angles))) / 4  # box sides are equal modulo a quarter turn
    width_axis = np.array([np.cos(angle), -np.sin(angle)])
    length_axis = np.array([np.sin(angle), np.cos(angle)])
    share = np.abs(edges @ width_axis) / np.linalg.norm(edges, axis=1)
    front = int(np.argmax(share))
    middle = base[front : front + 2, FLAT].mean(0)
    width, length = abs(edges[front] @ width_axis), abs(edges[1 - front] @ length_axis)
    return np.array([*middle, angle, width, length, *height])


def cylinder(track: Track, locate: Locate) -> Values:
    """The axis as a point; width and height from the axis' distance in every image."""
    outline = Silhouette.of(track)
    axis = cylinder_axis(track, outline, locate) if len(outline.rows) >= MIN_IMAGES else None
    if axis is None:
        return {}
    place, covariance = axis[0][FLAT], axis[1][np.ix_(FLAT, FLAT)]
    cameras = track.cameras()[outline.rows][:, FLAT]
    top = track.seen[outline.rows, TOP]
    rise = track.points[outline.rows[top], TOP, 1]
    names = ["x0_m", "z0_m", "width_m"] + ["height_m"] * bool(top.sum() >= MIN_IMAGES)

    def quantities(place: np.ndarray) -> np.ndarray:
        offset = place - cameras
        distance = np.linalg.norm(offset, axis=1)
        width = robust_mean(distance * outline.inverse_distance, distance**-2)
        depth = (offset[:, 1] * (1.0 - 0.5 * width / distance))[top]  # of the rim's nearest point
        height = [robust_mean(track.h[outline.rows[top]] - rise * depth, depth**-2)] if "height_m" in names else []
        return np.array([*place, width, *height])

    values = with_sigmas(names, quantities, place, covariance)
    distance = np.linalg.norm(place - cameras, axis=1)
    noise = outline.angle_sigma / np.sqrt(np.sum(distance**-2))  # contribution of the angle noise
    return {**values, "width_sd_m": float(np.hypot(values["width_sd_m"], noise)), "box": 0.0}


def cylinder_axis(track: Track, outline: Silhouette, locate: Locate) -> Located:
    """The more certain of two: the point on all bisectors, which is exact, and the middle of the outlines taken as
    points.

    Straight ahead the bisector has no parallax and only the outlines give the distance; but the tangent points move
    along the rim, which adds an error of an eighth of the width.
    """
    cameras = track.cameras()[outline.rows] * [1.0, 0.0, 1.0]

    def level(azimuth: np.ndarray, sigma: float) -> Located:
        return locate(np.stack([np.tan(azimuth), np.zeros_like(azimuth)], 1), cameras, sigma)

    found = [level(outline.bearing, outline.bearing_sigma)]
    left = level(outline.bearing - 0.5 * outline.angle, track.point_sigma)
    right = level(outline.bearing + 0.5 * outline.angle, track.point_sigma)
    if left is not None and right is not None:
        wander = RIM_WANDER * np.linalg.norm(left[0] - right[0])
        found.append((0.5 * (left[0] + right[0]), 0.25 * (left[1] + right[1]) + wander**2 * np.eye(3)))
    return min((f for f in found if f is not None), key=lambda f: np.trace(f[1]), default=None)


def robust_mean(values: np.ndarray, weights: np.ndarray) -> float:
    """Weighted mean without outliers from the median, measured by the spread about the median."""
    # Normalizes the residuals first: a weight is an inverse variance.
    residuals = (values - np.median(values)) * np.sqrt(weights)
    spread = 1.4826 * np.median(np.abs(residuals))
    keep = np.abs(residuals) <= OUTLIER * spread + 1e-12
    return float(np.average(values[keep], weights=weights[keep]))


def with_sigmas(
    names: list[str], quantities: Callable[[np.ndarray], np.ndarray], at: np.ndarray, covariance: np.ndarray
) -> Values:
    """Quantities and their one-sigma, by numerical derivatives; ``x0_m`` gets ``x0_sd_m`` and so on."""
    values = quantities(at)
    gradient = np.stack([(quantities(at + d) - quantities(at - d)) / (2 * STEP) for d in STEP * np.eye(len(at))], 1)
    sigmas = np.sqrt(np.einsum("ij,jk,ik->i", gradient, covariance, gradient))
    named = dict(zip(names, values.tolist()))
    return {**named, **{sigma_name(name): float(s) for name, s in zip(names, sigmas)}}


def sigma_name(name: str) -> str:
    """``width_m`` -> ``width_sd_m``."""
    stem, unit = name.rsplit("_", 1)
    return f"{stem}_sd_{unit}"
