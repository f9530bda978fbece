"""A solid in a camera's image: points of its outline and base corners, or the upright box around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import turns
from .solids import Solid

LEFT, RIGHT, TOP, BASE_LEFT, BASE_NEAR, BASE_RIGHT = range(6)
AHEAD_MIN = 0.05  # of a ray's length: points nearer to the image plane have no image
EDGE_STEPS = 33  # along a cylinder's edge, to find its part inside the image
MIN_WIDTH_PX = 2.0  # least width of an obstacle that a detector finds
MIN_INSIDE_PX = 20.0  # least part of its width and height inside the image


@dataclass(frozen=True)
class Camera:
    """70 degrees wide and high; mounting angles as in ``goe_camera_t``."""

    width_px: float = 1280.0
    height_px: float = 1280.0
    focal_px: float = 914.0
    middle_px: float = 640.0
    k1: float = 0.0
    mount_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)  # yaw, pitch, roll

    def to_body(self) -> np.ndarray:
        return turns.of_angles(*np.radians(self.mount_deg)) @ turns.CAMERA_TO_BODY

    def project(self, rays: np.ndarray) -> np.ndarray:
        """Pixels (..., 2) of rays (..., 3) in camera axes; NaN for rays that do not point ahead."""
        size = np.linalg.norm(rays, axis=-1)
        depth = np.where(rays[..., 2] > AHEAD_MIN * size, rays[..., 2], np.nan)
        x = rays[..., :2] / depth[..., None]
        return self.middle_px + self.focal_px * x * (1.0 + self.k1 * (x * x).sum(-1, keepdims=True))

    def contains(self, pixel: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            inside = (pixel >= -0.5) & (pixel < np.array([self.width_px, self.height_px]) - 0.5)
        return inside.all(-1)


@dataclass(frozen=True)
class Standpoint:
    """The camera over K images, in the course's axes turned to (X right, Z forward, up)."""

    camera: Camera
    eye_m: np.ndarray  # (K, 3) X, Z, height above ground
    to_body: np.ndarray  # (K, 3, 3) matrices body -> course (forward, right, down)
    middle_m: np.ndarray  # (K, 2) X, Z of the solid's middle
    hidden_m: np.ndarray | None = None  # (K,) height below which the solid is hidden

    def look(self, points: np.ndarray) -> np.ndarray:
        """Pixels (K, N, 2) of points (N, 3) or (K, N, 3) about the solid's middle."""
        offset = np.pad(self.middle_m, ((0, 0), (0, 1))) - self.eye_m
        x, z, up = np.moveaxis(points + offset[:, None], -1, 0)
        to_course = self.to_body @ self.camera.to_body()
        return self.camera.project(np.stack([z, x, -up], -1) @ to_course)

    def shown(self, points: np.ndarray) -> np.ndarray:
        """Points (N, 3) of the solid; the hidden ones raised (K, N, 3) to the lowest height that is not."""
        if self.hidden_m is None:
            return points
        raised = np.tile(points, (len(self.hidden_m), 1, 1))
        raised[..., 2] = np.maximum(raised[..., 2], self.hidden_m[:, None])
        return raised

    @property
    def eye_about_middle(self) -> np.ndarray:
        """(K, 2) X, Z"""
        return self.eye_m[:, :2] - self.middle_m


def _pick(points: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """(K, 2) of (K, N, 2)."""
    return points[np.arange(len(points)), chosen]


def _box_points(solid: Solid, stand: Standpoint) -> np.ndarray:
    """(K, 6, 2): extreme points of the outline, the top, no base corner."""
    pixel = stand.look(stand.shown(solid.points()))
    whole = np.isfinite(pixel).all((1, 2))
    u = np.where(whole[:, None], pixel[..., 0], 0.0)
    tops = solid.tops()
    top = stand.look(tops)
    if solid.kind == "roof":  # the ridge: its end that is higher in the image
        nearest = np.argmin(np.where(whole[:, None], top[..., 1], 0.0), 1)
    else:
        nearest = np.argmin(np.linalg.norm(tops[:, :2] - stand.eye_about_middle[:, None], axis=-1), 1)
    result = np.full((len(pixel), 6, 2), np.nan)
    result[:, LEFT], result[:, RIGHT] = _pick(pixel, np.argmin(u, 1)), _pick(pixel, np.argmax(u, 1))
    result[:, TOP] = _pick(top, nearest)
    result[~whole] = np.nan
    return result


def _cylinder_points(solid: Solid, stand: Standpoint) -> np.ndarray:
    """(K, 6, 2): the edges at half the height that is in the image, and the nearest point of the upper rim."""
    radius, eye = 0.5 * solid.width_m, stand.eye_about_middle
    distance = np.maximum(np.linalg.norm(eye, axis=1), 1e-9)
    toward = np.arctan2(eye[:, 0], eye[:, 1])  # clockwise from Z
    half = np.arccos(np.clip(radius / distance, -1.0, 1.0))
    levels = np.broadcast_to(np.linspace(0.0, solid.height_m, EDGE_STEPS), (len(eye), EDGE_STEPS))
    if stand.hidden_m is not None:
        levels = stand.hidden_m[:, None] + (1.0 - stand.hidden_m[:, None] / solid.height_m) * levels

    def wall(angle: np.ndarray, height: np.ndarray) -> np.ndarray:
        at = radius * np.stack([np.sin(angle), np.cos(angle)], -1)[:, None]
        return stand.look(np.concatenate([np.broadcast_to(at, (*height.shape, 2)), height[..., None]], -1))

    result, images = np.full((len(eye), 6, 2), np.nan), np.arange(len(eye))
    for feature, angle in ((LEFT, toward + half), (RIGHT, toward - half)):
        inside = stand.camera.contains(wall(angle, levels))
        lowest, highest = np.argmax(inside, 1), EDGE_STEPS - 1 - np.argmax(inside[:, ::-1], 1)
        between = 0.5 * (levels[images, lowest] + levels[images, highest])
        middle = wall(angle, between[:, None])[:, 0]
        result[:, feature] = np.where(inside.any(1)[:, None], middle, np.nan)
    result[:, TOP] = wall(toward, np.full((len(eye), 1), solid.height_m))[:, 0]
    result[distance <= radius] = np.nan
    return result


def base_corners(solid: Solid, stand: Standpoint) -> np.ndarray:
    """(K, 3, 2): left, near, right of the visible base corners; near is NaN if only one face is visible. Two buildings
    have the corners of both together."""
    corners = np.concatenate(solid.bases())
    pixel = stand.look(stand.shown(np.pad(corners, ((0, 0), (0, 1)))))
    ray = stand.eye_about_middle[:, None] - corners  # (K, N, 2)
    if solid.kind == "two":
        u = np.where(np.isfinite(pixel[..., 0]), pixel[..., 0], 0.0)
        near = np.argmin(np.linalg.norm(ray, axis=-1), 1)
        left, right = np.argmin(u, 1), np.argmax(u, 1)
        middle = (near != left) & (near != right)
    else:
        edge = np.roll(corners, -1, 0) - corners  # clockwise from above: the outside is on the left
        shown = ray[..., 0] * edge[:, 1] - ray[..., 1] * edge[:, 0] < 0.0  # the face from a corner to the next
        begins = shown & ~np.roll(shown, 1, 1)  # of a chain of faces
        first, faces = np.argmax(begins, 1), shown.sum(1)
        right, left = first, (first + faces) % len(corners)
        near, middle = (first + 1) % len(corners), faces == 2
        pixel = np.where((faces > 0)[:, None, None], pixel, np.nan)
    result = np.stack([_pick(pixel, left), _pick(pixel, near), _pick(pixel, right)], 1)
    result[~middle, 1] = np.nan
    return result


def points(solid: Solid, stand: Standpoint, corners: bool) -> np.ndarray:
    """Pixels (K, 6, 2) in the order of the library's features, NaN where not in the image."""
    if solid.kind == "cylinder":
        result = _cylinder_points(solid, stand)
    else:
        result = _box_points(solid, stand)
        if corners:
            result[:, BASE_LEFT:] = np.where(np.isfinite(result[:, LEFT]).all(-1)[:, None, None],
                                             base_corners(solid, stand), np.nan)  # fmt: skip
    return np.where(stand.camera.contains(result)[..., None], result, np.nan)


def boxes(solid: Solid, stand: Standpoint) -> np.ndarray:
    """Sides (K, 4) left, top, right, bottom of the smallest upright box around it, also beyond the border; NaN if a
    part of it has no image."""
    pixel = stand.look(stand.shown(solid.points()))
    return np.concatenate([pixel.min(1), pixel.max(1)], 1)


def cut_at_border(box: np.ndarray, exact: np.ndarray, camera: Camera) -> np.ndarray:
    """Boxes as reported by a detector: clipped; NaN if too narrow, or if too little is inside."""

    size = np.array([camera.width_px, camera.height_px])
    with np.errstate(invalid="ignore"):
        inside = (box[:, 2:] > MIN_INSIDE_PX).all(1) & (box[:, :2] < size - MIN_INSIDE_PX).all(1)
        inside &= exact[:, 2] - exact[:, 0] > MIN_WIDTH_PX
    return np.where(inside[:, None], np.clip(box, 0.0, np.tile(size - 1.0, 2)), np.nan)
