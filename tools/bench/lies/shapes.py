"""Upright cuboids and cylinders on level ground, from outside: corners, edges and rims, relative to the camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .genes import Array

SIGNS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])  # of corners, in circular order
EDGE_POINTS, RIM_POINTS = 17, 64


@dataclass
class Solid:
    """One for each of N images; NED relative to the camera."""

    round: np.ndarray  # (N,) bool
    center: Array  # (N, 2) of the base
    half: Array  # (N, 2) half the sides along axis a and across; radius twice
    heading: Array  # (N,) of axis a, rad
    foot: Array  # (N,) down of the ground
    roof: Array  # (N,) down of the roof

    def take(self, chosen: np.ndarray) -> Solid:
        return Solid(*(getattr(self, name)[chosen] for name in ("round", "center", "half", "heading", "foot", "roof")))

    def axes(self) -> Array:
        """(N, 2, 2): rows are axis a and the axis to its right."""
        c, s = np.cos(self.heading), np.sin(self.heading)
        return np.stack([np.stack([c, s], 1), np.stack([-s, c], 1)], 1)

    def corners(self) -> Array:
        """(N, 4, 2) of the base."""
        return self.center[:, None] + (SIGNS * self.half[:, None]) @ self.axes()

    def camera(self) -> Array:
        """(N, 2): place of the camera, along the solid's axes, from its center."""
        return -(self.axes() @ self.center[..., None])[..., 0]

    def distance(self) -> Array:
        """(N,): horizontal distance from the camera to the outline; negative inside."""
        beyond = np.abs(self.camera()) - self.half
        cuboid = np.hypot(*np.maximum(beyond, 0.0).T) + np.minimum(beyond.max(1), 0.0)
        return np.where(self.round, np.hypot(*self.center.T) - self.half[:, 0], cuboid)


def upright(level: Array, down: Array) -> Array:
    """(N, P, 3) from points on the ground (N, P, 2) and their down coordinate (N,) or (N, P)."""
    return np.concatenate([level, np.broadcast_to(down.reshape(len(level), -1), level.shape[:2])[..., None]], 2)


def bearings(solid: Solid, level: Array) -> Array:
    """(N, P): from the line to the center, clockwise from above (to the right)."""
    c, s = (solid.center / np.hypot(*solid.center.T)[:, None]).T
    return np.arctan2(
        c[:, None] * level[..., 1] - s[:, None] * level[..., 0], c[:, None] * level[..., 0] + s[:, None] * level[..., 1]
    )


def visible_corners(solid: Solid) -> tuple[Array, np.ndarray]:
    """Base corners left, near, right (N, 3, 2), and whether they are visible; only near may be missing."""
    corners, rows = solid.corners(), np.arange(len(solid.round))
    angle = bearings(solid, corners)
    place = solid.camera()
    near = np.argmax(np.einsum("ni,ci->nc", np.sign(place), SIGNS), 1)
    two_faces = np.all(np.abs(place) > solid.half, 1)
    found = np.stack([corners[rows, angle.argmin(1)], corners[rows, near], corners[rows, angle.argmax(1)]], 1)
    there = np.stack([~solid.round, two_faces & ~solid.round, ~solid.round], 1)
    return found, there


def sides(solid: Solid) -> Array:
    """(N, 2, 2): places of the silhouette's left and right edge: corners, or tangent points of a cylinder."""
    corners, rows = solid.corners(), np.arange(len(solid.round))
    angle = bearings(solid, corners)
    cuboid = np.stack([corners[rows, angle.argmin(1)], corners[rows, angle.argmax(1)]], 1)
    away = np.hypot(*solid.center.T)
    sine = np.clip(solid.half[:, 0] / away, 0.0, 1.0)
    length, half = np.sqrt(np.maximum(away**2 - solid.half[:, 0] ** 2, 0.0)), np.arcsin(sine)
    to = np.arctan2(solid.center[:, 1], solid.center[:, 0])
    turned = np.stack([to - half, to + half], 1)
    cylinder = length[:, None, None] * np.stack([np.cos(turned), np.sin(turned)], 2)
    return np.where(solid.round[:, None, None], cylinder, cuboid)


def nearest_of_rim(solid: Solid) -> Array:
    """(N, 2): the nearest base corner; for a cylinder the nearest point of its rim."""
    corners = solid.corners()
    nearest = corners[np.arange(len(corners)), np.hypot(corners[..., 0], corners[..., 1]).argmin(1)]
    away = np.hypot(*solid.center.T)[:, None]
    return np.where(solid.round[:, None], solid.center * (1.0 - solid.half[:, :1] / away), nearest)


def rim_points(solid: Solid, count: int = RIM_POINTS) -> Array:
    """(N, count, 2) around a cylinder."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return solid.center[:, None] + solid.half[:, :1, None] * np.stack([np.cos(angle), np.sin(angle)], 1)


def wire(solid: Solid) -> Array:
    """(N, P, 3): points along all edges of a cuboid, or around both rims and along both sides of a cylinder, since a
    lens bends straight edges."""
    corners, step = solid.corners(), np.linspace(0.0, 1.0, EDGE_POINTS)
    ring = np.concatenate([corners + (np.roll(corners, -1, 1) - corners) * s for s in step[:-1]], 1)
    spots = np.where(solid.round[:, None, None], rim_points(solid, ring.shape[1]), ring)
    posts = np.where(solid.round[:, None, None], np.repeat(sides(solid), 2, 1), corners)
    levels = [upright(posts, solid.foot + (solid.roof - solid.foot) * s) for s in step[1:-1]]
    return np.concatenate([upright(spots, solid.foot), upright(spots, solid.roof), *levels], 1)
