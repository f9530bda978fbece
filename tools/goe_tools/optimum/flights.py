"""Flights past obstacles as arrays over the images of one track.

Frames: NED earth (north, east, down), FRD body, camera (right, down, ahead), T = (right, down, forward) level, with its
origin at the camera of the track's first image. Metres, seconds, radians, pixels; attitudes are Hamilton quaternions
(w, x, y, z) body -> NED. Features in the order of ``FEATURES``.

A ``Scene`` is what is true, a ``Flight`` what an estimator is told, and the truth of the obstacle. ``measure`` makes a
flight of a scene and of a noise; the same seed gives the same flight.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..logs.obslog import FEATURES, Camera, Frame, LogError, ObservationLog, Truth, read_log
from ..places import ROOT

RECORDED_FOLDER = ROOT.parent / "shared" / "data" / "flights"
KITTI_FOLDER = ROOT.parent / "shared" / "data" / "kitti"

LEFT, RIGHT, TOP, BASE_LEFT, BASE_NEAR, BASE_RIGHT = range(6)
QUANTITIES = ("x0_m", "z0_m", "orientation_rad", "width_m", "length_m", "height_m")
AXES = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # camera -> body, un-mounted
ROUNDING_PX = 0.29  # 1 / sqrt(12)
MIN_PIXEL_PX = 0.05
MIN_DEPTH_SHARE = 0.05  # of a ray's length; what is nearer to the image plane has no image
GRAVITY_MPS2 = 9.81
IMAGE_RATE_HZ = 8.0
MIN_IMAGES = 40  # with the obstacle in view, for a random scene


# ------------------------------------------------------------------------------------------------------------ rotations


def euler(yaw: np.ndarray, pitch: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """Z-Y'-X'' rotations body -> NED of angles in rad, broadcast; (..., 3, 3)."""
    yaw, pitch, roll = np.broadcast_arrays(yaw, pitch, roll)
    cy, sy, cp, sp, cr, sr = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def multiply(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Products of quaternions (..., 4)."""
    w, v, s, u = p[..., :1], p[..., 1:], q[..., :1], q[..., 1:]
    return np.concatenate([w * s - (v * u).sum(-1, keepdims=True), w * u + s * v + np.cross(v, u)], -1)


def quaternions(yaw: np.ndarray, pitch: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """The quaternions (..., 4) of ``euler``'s rotations."""

    def about(axis: int, angle: np.ndarray) -> np.ndarray:
        q = np.zeros((*np.shape(angle), 4))
        q[..., 0], q[..., axis] = np.cos(angle / 2), np.sin(angle / 2)
        return q

    yaw, pitch, roll = np.broadcast_arrays(yaw, pitch, roll)
    return multiply(multiply(about(3, yaw), about(2, pitch)), about(1, roll))


def small_rotations(vector: np.ndarray) -> np.ndarray:
    """Quaternions (..., 4) of rotation vectors (..., 3) in rad."""
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle / 2), vector * 0.5 * np.sinc(angle / (2 * math.pi))], -1)


def matrices(q: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of quaternions (..., 4), which are normalised."""
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def level_axes(heading_rad: float) -> np.ndarray:
    """NED -> T, 3 x 3."""
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    return np.array([[-s, c, 0.0], [0.0, 0.0, 1.0], [c, s, 0.0]])


def mounting(camera: Camera) -> np.ndarray:
    """Camera -> body, 3 x 3."""
    angles = np.radians([camera.mount_yaw_deg, camera.mount_pitch_deg, camera.mount_roll_deg])
    return euler(*angles) @ AXES


def fold(angle: np.ndarray) -> np.ndarray:
    """Axis angles in rad, folded to +-90 degrees."""
    return (angle + math.pi / 2) % math.pi - math.pi / 2


# ---------------------------------------------------------------------------------------------------------------- types


@dataclass(frozen=True)
class Noise:
    """Errors of a run, which are also what a user would tell the estimator."""

    pixel_px: float = 0.5
    rounding: bool = False  # to whole pixels
    size_share: float = 0.0  # of the obstacle's width in the image
    correlation: float = 0.0  # from image to image
    shape_share: float = 0.0  # of the width: a silhouette that is no disc's
    attitude_bias_deg: float = 0.0  # each body axis
    attitude_white_deg: float = 0.0
    attitude_drift_deg: float = 0.0  # per sqrt(s)
    height_m: float = 0.0
    velocity_bias_m_s: float = 0.0  # north and east
    position_walk_m: float = 0.0  # per sqrt(s), each axis
    outliers: float = 0.0  # share of the points
    outlier_px: float = 15.0
    typical_size_m: float = 6.0

    @property
    def sigma_px(self) -> float:
        """One sigma of a coordinate of an image point, rounding included, px."""
        return max(math.hypot(self.pixel_px, ROUNDING_PX if self.rounding else 0.0), MIN_PIXEL_PX)


FIELD = Noise(
    attitude_bias_deg=0.5, attitude_white_deg=0.1, height_m=0.5, velocity_bias_m_s=0.05, position_walk_m=0.05,
    outliers=0.02,
)  # fmt: skip
NOISES = {
    "gauss0.3": Noise(pixel_px=0.3),
    "gauss1": Noise(pixel_px=1.0),
    "rounding": Noise(pixel_px=0.0, rounding=True),
    "field": FIELD,
}


@dataclass(frozen=True)
class Obstacle:
    """Truth, in T of the track's first image. Disc: (x0, z0) is the centre, the width the diameter, the length ditto;
    box: (x0, z0) is the middle of the front edge and the orientation that of the side edge from Z, clockwise."""

    kind: str  # box or disc
    x0_m: float
    z0_m: float
    orientation_rad: float
    width_m: float
    length_m: float
    height_m: float
    static: bool = True

    @property
    def values(self) -> np.ndarray:
        """(6,), in the order of ``QUANTITIES``."""
        return np.array([self.x0_m, self.z0_m, self.orientation_rad, self.width_m, self.length_m, self.height_m])

    def corners(self) -> np.ndarray:
        """Base corners (4, 2) as (X, Z): front left, back left, back right, front right; clockwise from above."""
        c, s = math.cos(self.orientation_rad), math.sin(self.orientation_rad)
        across, along = 0.5 * self.width_m * np.array([c, -s]), self.length_m * np.array([s, c])
        front = np.array([self.x0_m, self.z0_m])
        return np.array([front - across, front - across + along, front + across + along, front + across])


@dataclass
class Flight:
    """What an estimator is told about one obstacle, image by image, and the truth. K images.

    ``camera.heading_deg`` is always set: T is the same for everyone."""

    name: str
    group: str
    camera: Camera
    time_s: np.ndarray  # (K,)
    pixel_px: np.ndarray  # (K, 6, 2), 0 where not seen
    seen: np.ndarray  # (K, 6)
    position_ned_m: np.ndarray  # (K, 3) vehicle, estimated
    attitude: np.ndarray  # (K, 4) estimated
    height_m: np.ndarray  # (K,) camera above the ground, measured
    truth: Obstacle
    noise: Noise
    reach_s: float = math.nan  # from the first image until the obstacle's reference point is abeam
    top_is_highest: bool = False  # top: the roof's highest point in the image; otherwise the one nearest to the camera

    @property
    def heading_rad(self) -> float:
        return math.radians(self.camera.heading_deg or 0.0)

    def first(self, images: int) -> Flight:
        """The flight's beginning."""
        names = ("time_s", "pixel_px", "seen", "position_ned_m", "attitude", "height_m")
        return replace(self, **{name: getattr(self, name)[:images] for name in names})

    def path_m(self) -> float:
        """Length of the flown path over ground."""
        return float(np.linalg.norm(np.diff(self.position_ned_m[:, :2], axis=0), axis=1).sum())


@dataclass
class Scene:
    """What is true, and the pose that the aircraft believes in if it is given (recorded flights)."""

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
    noise: Noise = field(default_factory=Noise)  # told to the estimator, if the pose is believed

    def trimmed(self, start: int) -> Scene:
        """The scene from an image on, where the track then starts."""
        names = ("time_s", "pixel_px", "seen", "position_ned_m", "attitude", "height_m")
        t0 = self.time_s[start]
        moved = level_axes(math.radians(self.camera.heading_deg or 0.0)) @ (
            self.position_ned_m[start] - self.position_ned_m[0]
        )
        truth = replace(self.truth, x0_m=self.truth.x0_m - moved[0], z0_m=self.truth.z0_m - moved[2])
        result = replace(self, **{name: getattr(self, name)[start:] for name in names}, truth=truth)
        result.time_s = result.time_s - t0
        result.reach_s = self.reach_s - float(t0)
        return result


# ----------------------------------------------------------------------------------------------------------- projection


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
    first = np.argmax(visible & ~np.roll(visible, 1, 1), 1)  # corners come from left to right as clockwise from above
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


def _look(scene: Scene, ground_d: float) -> None:
    """Fills the scene's exact pixels from its true poses. No lever arm: the camera is at the vehicle's position."""
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


# -------------------------------------------------------------------------------------------------------------- scenes


def pinhole(yaw_deg: float = 0.0) -> Camera:
    """The paper's camera: 70 degrees, 1280 x 1280 pixels; T's heading is north."""
    return Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0, mount_yaw_deg=yaw_deg, heading_deg=0.0)


@dataclass
class Course:
    """A flight to simulate. ``argument``: of an arc the radius in m, positive to the right; of a weave the amplitude
    in m and the period in s."""

    run_s: float
    speed_mps: float
    altitude_m: float
    glide_deg: float
    reach_s: float
    acceleration_mps2: float = 0.0
    path: str = "straight"
    argument: tuple[float, ...] = ()


def simulate(name: str, group: str, camera: Camera, truth: Obstacle, course: Course, phases: np.ndarray) -> Scene:
    """Flies a course; ``phases``: (3,) rad, of the attitude's sway of 1 and 2 degrees."""
    t = np.arange(math.floor(course.run_s * IMAGE_RATE_HZ + 1e-9) + 1) / IMAGE_RATE_HZ
    s = course.speed_mps * t + 0.5 * course.acceleration_mps2 * t * t
    direction, north, east = np.zeros_like(t), s, np.zeros_like(t)
    if course.path == "arc":
        (radius,) = course.argument
        direction = s / radius
        north, east = radius * np.sin(direction), radius * (1.0 - np.cos(direction))
    elif course.path == "weave":
        amplitude, period = course.argument
        rate = 2 * math.pi / period
        east = amplitude * np.sin(rate * t)
        direction = np.arctan(amplitude * rate * np.cos(rate * t) / course.speed_mps)
    glide = math.radians(course.glide_deg)
    height = course.altitude_m + np.maximum(course.speed_mps * course.reach_s - s, 0.0) * math.tan(glide)
    bank = np.gradient(direction, t) * course.speed_mps / GRAVITY_MPS2
    sway = [math.radians(1.0) * np.sin(2 * math.pi * t / p + q) for p, q in zip((2.3, 3.1, 1.7), phases)]
    attitude = quaternions(direction + sway[0], math.radians(3.0) - glide + sway[1], bank + 2 * sway[2])
    position = np.stack([north, east, -height], 1)
    none = np.zeros((len(t), 6))
    scene = Scene(name, group, camera, t, none, none, position, attitude, height, truth, course.reach_s)
    _look(scene, 0.0)
    return scene


PAPER = (  # name, kind, W, L, H, offsets, altitudes, run, reach: m and s, Table 2 of the paper
    ("cylinder", "disc", 6.0, 6.0, 30.0, (0.0, 30.0, 60.0), (15.0,), 19.0, 20.0),
    ("building", "box", 15.0, 40.0, 89.0, (0.0, 75.0, 150.0), (44.5,), 30.0, 40.0),
    ("truck", "box", 2.5, 7.0, 2.5, (0.0, 12.5, 25.0), (2.5, 5.0), 18.0, 20.0),
    ("long-truck", "box", 2.5, 18.0, 4.0, (0.0, 12.5, 25.0), (4.0, 8.0), 18.0, 20.0),
)
PAPER_SPEED_MPS = 17.0


def paper_scenes() -> list[Scene]:
    """The 156 cases of the paper's Table 2."""
    phase = np.random.default_rng(5)
    result = []
    for name, kind, width, length, height, offsets, altitudes, run, reach in PAPER:
        angles = (-45, -20, 0, 20, 45) if kind == "box" else (0,)
        for x0, altitude, angle, glide in (
            (x, a, b, g) for x in offsets for a in altitudes for b in angles for g in (0, 6)
        ):
            truth = Obstacle(kind, -x0, PAPER_SPEED_MPS * reach, math.radians(angle), width, length, height)
            course = Course(run, PAPER_SPEED_MPS, altitude, glide, reach)
            label = f"{name} x{x0:g} altitude{altitude:g} angle{angle} glide{glide}"
            result.append(simulate(label, name, pinhole(-30.0), truth, course, phase.random(3) * 2 * math.pi))
    return result


def _random_scene(rng: np.random.Generator, number: int) -> Scene:
    log_uniform = lambda low, high: float(np.exp(rng.uniform(math.log(low), math.log(high))))  # noqa: E731
    box = rng.random() < 0.7
    width = log_uniform(1.5, 20.0)
    length, height = width * log_uniform(0.5, 5.0), log_uniform(2.0, 50.0)
    speed, reach = rng.uniform(10.0, 28.0), rng.uniform(12.0, 25.0)
    side = -1 if rng.random() < 0.5 else 1
    z0 = speed * reach
    x0 = side * rng.uniform(0.0, 0.35) * z0 * rng.random()
    angle = math.radians(rng.uniform(-42.0, 42.0))
    camera = pinhole(side * 30.0 if rng.random() < 0.7 else 0.0)
    path = ("straight", "arc", "weave")[rng.integers(3)]
    argument: tuple[float, ...] = ()
    if path == "arc":
        argument = (float(rng.choice([-1, 1]) * rng.uniform(500.0, 1500.0)),)
    elif path == "weave":
        argument = (float(rng.uniform(2.0, 10.0)), float(rng.uniform(5.0, 12.0)))
    altitude = rng.uniform(max(2.5, 0.4 * height), max(5.0, 1.5 * height))
    glide = float(rng.choice([0, 0, 3, 6]))
    run = reach - rng.uniform(1.5, 3.0) - (0.5 * width + 2.0) / speed
    if not box:
        length, angle = width, 0.0
    truth = Obstacle("box" if box else "disc", float(x0), float(z0), angle, width, length, height)
    course = Course(run, speed, altitude, glide, reach, rng.uniform(-0.3, 0.3), path, argument)
    group = "random box" if box else "random cylinder"
    return simulate(f"{group} {number}", group, camera, truth, course, rng.random(3) * 2 * math.pi)


def random_scenes(count: int, scenario: int = 7) -> list[Scene]:
    """Boxes and cylinders of random size, side, orientation, speed and path that stay in view for long enough; the
    track starts when the obstacle comes into view."""
    rng = np.random.default_rng(scenario)
    result: list[Scene] = []
    number = 0
    while len(result) < count:
        number += 1
        scene = _random_scene(rng, number)
        needed = [LEFT, RIGHT, BASE_LEFT, BASE_RIGHT] if scene.truth.kind == "box" else [LEFT, RIGHT]
        in_view = scene.seen[:, needed].all(1)
        if in_view.sum() >= MIN_IMAGES and in_view[:20].any():
            result.append(scene.trimmed(int(np.argmax(in_view))))
    return result


# --------------------------------------------------------------------------------------------------------- measurement


def _believed(scene: Scene, noise: Noise, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Estimated position, attitude and height of the true ones."""
    if scene.believed is not None:
        return scene.believed
    t = scene.time_s
    bias = math.radians(noise.attitude_bias_deg) * rng.standard_normal(3)
    white = math.radians(noise.attitude_white_deg) * rng.standard_normal((len(t), 3))
    step = noise.position_walk_m * np.sqrt(np.diff(t, prepend=t[0]))[:, None]
    position = scene.position_ned_m + np.cumsum(rng.standard_normal((len(t), 3)) * step, 0)
    position[:, :2] += noise.velocity_bias_m_s * rng.standard_normal(2) * (t - t[0])[:, None]
    height = scene.height_m + noise.height_m * rng.standard_normal()
    return position, multiply(scene.attitude, small_rotations(bias + white)), height


def measure(scene: Scene, noise: Noise, seed: int | Sequence[int] = 1) -> Flight:
    """What an estimator is told of a scene under a noise."""
    rng = np.random.default_rng(seed)
    position, attitude, height = _believed(scene, noise, rng)
    pixels = scene.pixel_px + noise.pixel_px * rng.standard_normal(scene.pixel_px.shape)
    camera = scene.camera
    if noise.rounding:  # the pixels' grid lies anew with every seed: otherwise there would be one rounding only
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


# ----------------------------------------------------------------------------------------------------- recorded flights

RECORDED_NOISE = {  # what a user of these autopilots would state
    "px4": Noise(
        attitude_bias_deg=1.2, attitude_white_deg=0.15, attitude_drift_deg=0.3, height_m=0.7, velocity_bias_m_s=0.05,
        position_walk_m=0.05,
    ),
    "arduplane": Noise(
        attitude_bias_deg=0.3, attitude_white_deg=0.05, attitude_drift_deg=0.05, height_m=0.5, velocity_bias_m_s=0.05,
        position_walk_m=0.05,
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


def _beside(recording: Recording, rng: np.random.Generator) -> Scene | None:
    """A random obstacle beside a random part of a recording; None if the part will not do."""
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
    _look(scene, ground_d)
    in_view = scene.seen[:, [LEFT, RIGHT]].all(1)
    return scene if in_view.sum() >= MIN_IMAGES and in_view[:10].any() else None


def recorded_scenes(count: int, folder: Path = RECORDED_FOLDER, seed: int = 1, tries: int = 5000) -> list[Scene]:
    """Up to ``count`` passes of each recorded flight in a folder, past obstacles put there; none without the folder."""
    result: list[Scene] = []
    for path in sorted(Path(folder).glob("*.csv")):
        recording, rng = read_recording(path), np.random.default_rng(seed)
        found: list[Scene] = []
        for _ in range(tries):
            if len(found) >= count:
                break
            scene = _beside(recording, rng)
            if scene is not None:
                found.append(scene)
        result += found
    return result


# ----------------------------------------------------------------------------------------------------------------- logs


def _value(number: float | None) -> float:
    return math.nan if number is None else number


def _heading_of(log: ObservationLog, frames: Sequence[Frame], truth: Truth) -> float:
    """Heading of T's Z axis, rad: the setting, the simulator's word, or the yaw at the track's first image."""
    if log.camera.heading_deg is not None:
        return math.radians(log.camera.heading_deg)
    if truth.extra.get("track_heading_deg"):
        return math.radians(float(truth.extra["track_heading_deg"]))
    forward = matrices(np.array(frames[0].attitude))[:, 0]
    return math.atan2(forward[1], forward[0])


def _obstacle_of(truth: Truth, origin_ne: np.ndarray, heading: float, kind: str | None) -> Obstacle:
    box = truth.length_m is not None if kind is None else kind == "box"
    x, z = level_axes(heading)[[0, 2], :2] @ (np.array([truth.center_n_m, truth.center_e_m]) - origin_ne)
    length = truth.width_m if truth.length_m is None else truth.length_m
    angle = float(fold(np.radians(_value(truth.heading_deg)) - heading)) if box else 0.0
    if box:
        x, z = x - 0.5 * length * math.sin(angle), z - 0.5 * length * math.cos(angle)
    told = [truth.extra.get(name, "") for name in ("x0_m", "z0_m", "track_heading_deg")]
    if all(told) and abs(math.radians(float(told[2])) - heading) < 1e-9 and kind is None:
        x, z = float(told[0]), float(told[1])  # of the true first pose, which the log does not know
    return Obstacle("box" if box else "disc", x, z, angle, truth.width_m, length, truth.height_m, truth.static)


def _flight_of(log: ObservationLog, frames: Sequence[Frame], truth: Truth, name: str, kind: str | None) -> Flight:
    heading = _heading_of(log, frames, truth)
    attitude = np.array([frame.attitude for frame in frames])
    position = np.array([frame.position_m for frame in frames])
    points = [[getattr(frame, feature) or (math.nan, math.nan) for feature in FEATURES] for frame in frames]
    pixels = np.array(points, float)
    seen = np.isfinite(pixels).all(-1)
    offset = np.array([log.camera.offset_x_m, log.camera.offset_y_m, log.camera.offset_z_m])
    origin = position[0] + matrices(attitude[0]) @ offset
    time_s = np.array([frame.t_s for frame in frames])
    return Flight(
        name, name.split("/")[0], replace(log.camera, heading_deg=math.degrees(heading)), time_s,
        np.where(seen[..., None], pixels, 0.0), seen, position, attitude,
        np.array([frame.height_m for frame in frames]), _obstacle_of(truth, origin[:2], heading, kind), FIELD,
    )  # fmt: skip


def from_log(folder: Path, kind: str | None = None) -> list[Flight]:
    """A flight for each track with truth of a log folder; images with a bad pose are left out.

    kind: None: box if the truth has a length, otherwise disc; or one of the two (disc: (x0, z0) is the centre)."""
    folder = Path(folder)
    log = read_log(folder)
    if not log.truth:
        raise LogError(folder / "truth.csv", 0, "", "there is no truth")
    result = []
    for key, frames in log.tracks().items():
        good = [f for f in frames if np.isfinite([f.t_s, *f.position_m, *f.attitude, f.height_m]).all()]
        if key in log.truth and good:
            result.append(_flight_of(log, good, log.truth[key], f"{folder.name}/{key}", kind))
    return result


KITTI_NOISE = Noise(
    pixel_px=0.7, size_share=0.025, correlation=0.54, shape_share=0.12, attitude_bias_deg=0.2, attitude_white_deg=0.03,
    attitude_drift_deg=0.05, height_m=0.1, velocity_bias_m_s=0.05, position_walk_m=0.02, typical_size_m=3.0,
)  # fmt: skip


def kitti_flights(folder: Path = KITTI_FOLDER) -> Iterator[Flight]:
    """Every car, as a disc at its middle; none without the folder."""
    for path in sorted(p.parent for p in Path(folder).glob("*/frames.csv")):
        for flight in from_log(path, kind="disc"):
            yield replace(flight, group="kitti", noise=KITTI_NOISE)
