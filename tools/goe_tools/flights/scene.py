"""The truth: poses and an obstacle, and its image in a camera."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ..logs.obslog import Camera
from .flight import BASE_LEFT, BASE_NEAR, BASE_RIGHT, LEFT, RIGHT, TOP, Obstacle
from .noise import Noise
from .rotations import level_axes, matrices, mounting

MIN_DEPTH_SHARE = 0.05  # of a ray's length; points nearer to the image plane have no image


@dataclass
class Scene:
    """The truth, and for recorded flights the pose estimated by the autopilot."""

    name: str
    group: str
    camera: Camera
    time_s: np.ndarray
    pixel_px: np.ndarray
    seen: np.ndarray
    position_ned_m: np.ndarray
    attitude: np.ndarray
    height_m: np.ndarray
    truth: Obstacle
    reach_s: float
    believed: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None  # position, attitude, height
    noise: Noise = field(default_factory=Noise)  # configured in the estimator, if the pose is a recorded estimate

    def trimmed(self, start: int) -> Scene:
        """The scene from an image on; the track then starts there."""
        names = ("time_s", "pixel_px", "seen", "position_ned_m", "attitude", "height_m")
        t0 = self.time_s[start]
        moved = level_axes(math.radians(self.camera.heading_deg or 0.0)) @ (
            self.position_ned_m[start] - self.position_ned_m[0]
        )
        truth = replace(self.truth, x0_m=self.truth.x0_m - moved[0], z0_m=self.truth.z0_m - moved[2])
        result = replace(self, **{name: getattr(self, name)[start:] for name in names}, truth=truth)
        if self.believed is not None:
            result.believed = tuple(values[start:] for values in self.believed)  # type: ignore[assignment]
        result.time_s = result.time_s - t0
        result.reach_s = self.reach_s - float(t0)
        return result


def project(camera: Camera, ned_from_camera: np.ndarray, eye_ned_m: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Pixels (K, N, 2) of points (K, N, 3) in NED; NaN behind the image plane. Without lens distortion."""
    ray = np.einsum("kji,knj->kni", ned_from_camera, points - eye_ned_m[:, None])
    depth = np.where(ray[..., 2] > MIN_DEPTH_SHARE * np.linalg.norm(ray, axis=-1), ray[..., 2], np.nan)
    return ray[..., :2] / depth[..., None] * [camera.fx, camera.fy] + [camera.cx, camera.cy]


def in_image(camera: Camera, pixel: np.ndarray) -> np.ndarray:
    u, v = pixel[..., 0], pixel[..., 1]
    with np.errstate(invalid="ignore"):
        return (u >= -0.5) & (u < camera.width - 0.5) & (v >= -0.5) & (v < camera.height - 0.5)


def _box_pixels(scene: Scene, see: object, corners_ne: np.ndarray, ground_d: float) -> np.ndarray:
    images = len(scene.time_s)
    points = np.empty((8, 3))
    points[:4, :2] = points[4:, :2] = corners_ne
    points[:4, 2], points[4:, 2] = ground_d, ground_d - scene.truth.height_m
    uv = see(np.broadcast_to(points, (images, 8, 3)))  # type: ignore[operator]
    eye = scene.position_ned_m[:, None, :2]
    edge = np.roll(corners_ne, -1, 0) - corners_ne
    ray = eye - corners_ne
    visible = edge[:, 0] * ray[..., 1] - edge[:, 1] * ray[..., 0] < 0  # clockwise: outside is left of the edge
    faces = visible.sum(1)
    first = np.argmax(visible & ~np.roll(visible, 1, 1), 1)  # clockwise from above is from left to right in the image
    k = np.arange(images)
    pixels = np.full((images, 6, 2), np.nan)
    with np.errstate(invalid="ignore"):
        u = uv[..., 0]
        ok = np.isfinite(uv).all((1, 2)) & (faces > 0)
    u = np.where(ok[:, None], u, 0.0)
    pixels[:, LEFT], pixels[:, RIGHT] = uv[k, np.argmin(u, 1)], uv[k, np.argmax(u, 1)]
    pixels[:, TOP] = uv[k, 4 + np.argmin(np.linalg.norm(ray, axis=-1), 1)]
    pixels[:, BASE_RIGHT], pixels[:, BASE_LEFT] = uv[k, first], uv[k, (first + faces) % 4]
    pixels[:, BASE_NEAR] = np.where((faces == 2)[:, None], uv[k, (first + 1) % 4], np.nan)
    return np.where(ok[:, None, None], pixels, np.nan)


def _cylinder_pixels(scene: Scene, see: object, center_ne: np.ndarray, ground_d: float) -> np.ndarray:
    images, radius, height, steps = len(scene.time_s), 0.5 * scene.truth.width_m, scene.truth.height_m, 33
    pixels = np.full((images, 6, 2), np.nan)
    eye = scene.position_ned_m[:, :2] - center_ne
    distance = np.linalg.norm(eye, axis=1)
    toward = np.arctan2(eye[:, 1], eye[:, 0])
    half = np.arccos(np.clip(radius / distance, -1.0, 1.0))

    def wall(azimuth: np.ndarray, levels: np.ndarray) -> np.ndarray:
        points = np.empty((images, levels.shape[-1], 3))
        points[..., 0] = (center_ne[0] + radius * np.cos(azimuth))[:, None]
        points[..., 1] = (center_ne[1] + radius * np.sin(azimuth))[:, None]
        points[..., 2] = ground_d - levels
        return see(points)  # type: ignore[operator]

    for feature, azimuth in ((LEFT, toward + half), (RIGHT, toward - half)):
        in_view = in_image(scene.camera, wall(azimuth, np.linspace(0.0, height, steps)))
        lowest, highest = np.argmax(in_view, 1), steps - 1 - np.argmax(in_view[:, ::-1], 1)
        middle = wall(azimuth, (height * (lowest + highest) / (2 * (steps - 1)))[:, None])[:, 0]
        pixels[:, feature] = np.where(in_view.any(1)[:, None], middle, np.nan)
    pixels[:, TOP] = wall(toward, np.full((images, 1), height))[:, 0]
    pixels[distance <= radius] = np.nan
    return pixels


def look(scene: Scene, ground_d: float) -> None:
    """Computes the scene's exact pixels from its true poses. No lever arm: the camera is at the vehicle's position."""
    heading = math.radians(scene.camera.heading_deg or 0.0)
    t_from_ned = level_axes(heading)
    origin = scene.position_ned_m[0, :2]
    ned_from_camera = matrices(scene.attitude) @ mounting(scene.camera)

    def see(points: np.ndarray) -> np.ndarray:
        return project(scene.camera, ned_from_camera, scene.position_ned_m, points)

    def in_ned(xz: np.ndarray) -> np.ndarray:
        return origin + xz @ t_from_ned[[0, 2], :2]

    if scene.truth.kind == "box":
        pixels = _box_pixels(scene, see, in_ned(scene.truth.corners()), ground_d)
    else:
        center = in_ned(np.array([scene.truth.x0_m, scene.truth.z0_m]))
        pixels = _cylinder_pixels(scene, see, center, ground_d)
    scene.seen = np.isfinite(pixels).all(-1) & in_image(scene.camera, pixels)
    scene.pixel_px = np.where(scene.seen[..., None], pixels, 0.0)
