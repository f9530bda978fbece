"""Synthetic observation logs of one upright box or cylinder on flat ground, seen from a flying camera.

The obstacle is placed in the trajectory frame T of the first image (X right, Z forward, level): a box with the middle
of its front edge (length W, on the side of the start) at (X0, Z0) and its length axis turned from Z by alpha, clockwise
seen from above; a cylinder with its centre at (X0, Z0). X0 < 0 stands left of the flight path.

Features are exact points of the obstacle: the silhouette's left and right are taken at half the obstacle's height (on a
cylinder on its exact tangents), the top is the highest point in the image, and of the base only the corners of visible
faces are given.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .obslog import Camera, Frame, LogError, ObservationLog, Pixel, Truth, write_log

GRAVITY_MPS2 = 9.80665
MIN_DEPTH_FRACTION = 0.05  # of the ray's length: below this a point counts as out of view
LENS_SAMPLES = 33
LENS_SLOPE_MIN = 0.2  # of d(distorted radius)/d(radius); a lens model that flat has left its valid field

# name: shape, W, L, H in metres (of the cylinder: diameter, diameter, height)
PRESETS = {
    "cylinder": ("cylinder", 6.0, 6.0, 30.0),
    "building": ("box", 15.0, 40.0, 89.0),
    "truck": ("box", 2.5, 7.0, 2.5),
    "long-truck": ("box", 2.5, 18.0, 4.0),
}


@dataclass
class Scene:
    """All that a synthetic log depends on."""

    shape: str = "box"  # box or cylinder
    width_m: float = 2.5  # front edge of the box, diameter of the cylinder
    length_m: float = 7.0
    height_m: float = 2.5
    x0_m: float = -12.0
    z0_m: float = 200.0
    alpha_deg: float = 0.0  # length axis from Z
    run_s: float = 8.0
    fps_hz: float = 8.0
    speed_mps: float = 17.0
    acceleration_mps2: float = 0.0
    path: str = "straight"  # straight, arc, weave
    arc_radius_m: float = 400.0  # positive: turns right
    weave_amplitude_m: float = 5.0
    weave_period_s: float = 6.0
    course_deg: float = 0.0  # direction of flight at the start, clockwise from north (weave: of its middle line)
    altitude_m: float = 20.0  # vehicle above the ground at the first image
    glide_deg: float = 0.0  # positive: descending
    pitch_deg: float = 0.0  # constant, on top of the glide path's
    wobble_deg: float = 0.0  # amplitude of a three-axis attitude oscillation
    start_ne_m: tuple[float, float] = (0.0, 0.0)
    ground_d_m: float = 0.0
    rounding: str = "none"  # none, pixel (whole pixels)
    pixel_sigma_px: float = 0.0
    seed: int = 1
    clip: bool = False  # points outside the image are not measured
    id: int = 1
    t0_s: float = 0.0
    camera: Camera = field(default_factory=lambda: Camera(1280.0, 1280.0, 914.0, 914.0, 640.0, 640.0))


def rotation(axis: int, angle_rad: float) -> np.ndarray:
    """Right-handed rotation by an angle about axis 0, 1 or 2; 3 x 3."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    result = np.eye(3)
    result[i, i] = result[j, j] = c
    result[i, j], result[j, i] = -s, s
    return result


def yaw_pitch_roll(yaw_deg: float, pitch_deg: float, roll_deg: float) -> np.ndarray:
    """Z-Y'-X'' rotation matrix; 3 x 3."""
    return (
        rotation(2, math.radians(yaw_deg)) @ rotation(1, math.radians(pitch_deg)) @ rotation(0, math.radians(roll_deg))
    )


def quaternion_of(matrix: np.ndarray) -> tuple[float, float, float, float]:
    """The unit quaternion (w, x, y, z), w >= 0, of a rotation matrix (largest-component method)."""
    m = matrix
    squares = np.array(
        [
            1.0 + m[0, 0] + m[1, 1] + m[2, 2],
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
        ]
    )
    products = {
        (0, 1): m[2, 1] - m[1, 2],
        (0, 2): m[0, 2] - m[2, 0],
        (0, 3): m[1, 0] - m[0, 1],
        (1, 2): m[0, 1] + m[1, 0],
        (1, 3): m[0, 2] + m[2, 0],
        (2, 3): m[1, 2] + m[2, 1],
    }
    big = int(np.argmax(squares))
    scale = 2.0 * math.sqrt(squares[big])
    q = np.array([scale / 4.0 if i == big else products[tuple(sorted((i, big)))] / scale for i in range(4)])
    if q[0] < 0.0:
        q = -q
    q /= np.linalg.norm(q)
    return tuple(float(value) for value in q)  # type: ignore[return-value]


def distort(camera: Camera, x: float, y: float) -> tuple[float, float]:
    """Brown-Conrady distortion of a normalised image point, OpenCV's order of the coefficients."""
    r2 = x * x + y * y
    radial = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3))
    return (
        x * radial + 2.0 * camera.p1 * x * y + camera.p2 * (r2 + 2.0 * x * x),
        y * radial + camera.p1 * (r2 + 2.0 * y * y) + 2.0 * camera.p2 * x * y,
    )


def lens_bends_back(camera: Camera, x: float, y: float) -> bool:
    """Whether the lens model has turned around before this point, so that a farther ray would meet the same pixel."""
    r2 = np.linspace(0.0, x * x + y * y, LENS_SAMPLES)
    return bool(np.any(1.0 + r2 * (3.0 * camera.k1 + r2 * (5.0 * camera.k2 + 7.0 * r2 * camera.k3)) <= LENS_SLOPE_MIN))


@dataclass
class Pose:
    """Vehicle and camera at one time. ``ned_from_camera`` turns camera axes into NED."""

    vehicle_ned_m: np.ndarray
    ned_from_body: np.ndarray
    camera_ned_m: np.ndarray
    ned_from_camera: np.ndarray


CAMERA_AXES_IN_BODY = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # un-mounted: z forward, x right


def pose_at(scene: Scene, t: float) -> Pose:
    """The pose t seconds after the first image."""
    course = math.radians(scene.course_deg)
    speed = scene.speed_mps + scene.acceleration_mps2 * t
    along = scene.speed_mps * t + 0.5 * scene.acceleration_mps2 * t * t
    across, turn, roll_deg = 0.0, 0.0, 0.0
    forward = along
    if scene.path == "arc":
        turn = along / scene.arc_radius_m
        forward = scene.arc_radius_m * math.sin(turn)
        across = scene.arc_radius_m * (1.0 - math.cos(turn))
        roll_deg = math.degrees(math.atan(speed * speed / (GRAVITY_MPS2 * scene.arc_radius_m)))
    elif scene.path == "weave":
        rate = 2.0 * math.pi / scene.weave_period_s
        across = scene.weave_amplitude_m * math.sin(rate * t)
        turn = math.atan2(scene.weave_amplitude_m * rate * math.cos(rate * t), speed)
        lateral = -scene.weave_amplitude_m * rate * rate * math.sin(rate * t)
        roll_deg = math.degrees(math.atan(lateral / GRAVITY_MPS2))
    elif scene.path != "straight":
        raise ValueError(f"unknown path '{scene.path}'")
    down = scene.ground_d_m - scene.altitude_m + along * math.tan(math.radians(scene.glide_deg))
    north = scene.start_ne_m[0] + forward * math.cos(course) - across * math.sin(course)
    east = scene.start_ne_m[1] + forward * math.sin(course) + across * math.cos(course)
    wobble = [
        scene.wobble_deg * math.sin(2.0 * math.pi * t / period + phase)
        for period, phase in ((2.3, 0.4), (3.1, 1.3), (1.7, 2.2))
    ]
    ned_from_body = yaw_pitch_roll(
        scene.course_deg + math.degrees(turn) + wobble[0],
        scene.pitch_deg - scene.glide_deg + wobble[1],
        roll_deg + wobble[2],
    )
    camera = scene.camera
    mount = yaw_pitch_roll(camera.mount_yaw_deg, camera.mount_pitch_deg, camera.mount_roll_deg)
    vehicle = np.array([north, east, down])
    offset = np.array([camera.offset_x_m, camera.offset_y_m, camera.offset_z_m])
    return Pose(vehicle, ned_from_body, vehicle + ned_from_body @ offset, ned_from_body @ mount @ CAMERA_AXES_IN_BODY)


def project(camera: Camera, pose: Pose, point_ned_m: np.ndarray, clip: bool = False) -> Pixel | None:
    """The pixel of a point in NED; None if it lies behind the image plane, where the lens
    model holds no more, or, with clip, outside the image."""
    ray = pose.ned_from_camera.T @ (np.asarray(point_ned_m) - pose.camera_ned_m)
    if ray[2] <= MIN_DEPTH_FRACTION * np.linalg.norm(ray):
        return None
    x, y = ray[0] / ray[2], ray[1] / ray[2]
    if lens_bends_back(camera, x, y):
        return None
    x, y = distort(camera, x, y)
    u, v = camera.fx * x + camera.cx, camera.fy * y + camera.cy
    if clip and not (0.0 <= u <= camera.width and 0.0 <= v <= camera.height):
        return None
    return float(u), float(v)


@dataclass
class Placed:
    """The obstacle in NED. ``corners_ne_m``: 4 x 2, clockwise from above, from the front left; of a cylinder: None."""

    heading_rad: float  # of T's Z axis
    center_ne_m: np.ndarray
    corners_ne_m: np.ndarray | None


def place(scene: Scene, first: Pose) -> Placed:
    """Puts the obstacle where (X0, Z0) says, T being that of the first pose."""
    if scene.camera.heading_deg is None:
        forward = first.ned_from_body[:, 0]
        heading = math.atan2(forward[1], forward[0])
    else:
        heading = math.radians(scene.camera.heading_deg)
    z_axis = np.array([math.cos(heading), math.sin(heading)])
    x_axis = np.array([-math.sin(heading), math.cos(heading)])
    reference = first.camera_ned_m[:2] + scene.x0_m * x_axis + scene.z0_m * z_axis
    if scene.shape == "cylinder":
        return Placed(heading, reference, None)
    if scene.shape != "box":
        raise ValueError(f"unknown shape '{scene.shape}'")
    alpha = math.radians(scene.alpha_deg)
    along = math.sin(alpha) * x_axis + math.cos(alpha) * z_axis
    across = math.cos(alpha) * x_axis - math.sin(alpha) * z_axis
    half, length = 0.5 * scene.width_m * across, scene.length_m * along
    corners = np.array([reference - half, reference - half + length, reference + half + length, reference + half])
    return Placed(heading, reference + 0.5 * length, corners)


def _bearing_order(camera_ne_m: np.ndarray, toward_ne_m: np.ndarray, points_ne_m: np.ndarray) -> np.ndarray:
    """Bearings of points from the camera, rad, clockwise, relative to the direction of ``toward``."""
    base, rays = toward_ne_m - camera_ne_m, points_ne_m - camera_ne_m
    return np.arctan2(base[0] * rays[:, 1] - base[1] * rays[:, 0], rays @ base)


def _highest(scene: Scene, pose: Pose, placed: Placed) -> np.ndarray:
    """The point of the obstacle's top that lies highest in the (undistorted) image, NED."""
    top_d = scene.ground_d_m - scene.height_m
    to_camera = pose.ned_from_camera.T
    if placed.corners_ne_m is not None:
        points = np.column_stack([placed.corners_ne_m, np.full(4, top_d)])
        rays = (points - pose.camera_ned_m) @ to_camera.T
        ahead = rays[:, 2] > 0.0
        slope = np.where(ahead, rays[:, 1] / np.where(ahead, rays[:, 2], 1.0), np.inf)
        return points[int(np.argmin(slope))]
    # On the rim C + r (cos t, sin t) the image's y is a ratio of two sinusoids, (a0 + a.e(t)) / (b0 + b.e(t)); its
    # least value y is the one for which a0 - y b0 = |a - y b|, and is met in the direction of -(a - y b).
    center = np.array([*placed.center_ne_m, top_d])
    radius = 0.5 * scene.width_m
    ray = to_camera @ (center - pose.camera_ned_m)
    a0, b0 = ray[1], ray[2]
    a, b = radius * to_camera[1, :2], radius * to_camera[2, :2]
    quadratic, linear, constant = b0 * b0 - b @ b, a0 * b0 - a @ b, a0 * a0 - a @ a
    y = (linear - math.sqrt(max(linear * linear - quadratic * constant, 0.0))) / quadratic
    direction = -(a - y * b)
    return center + radius * np.array([*(direction / np.linalg.norm(direction)), 0.0])


def feature_points(scene: Scene, pose: Pose, placed: Placed) -> dict[str, np.ndarray]:
    """The features that are not hidden by the obstacle itself, as points in NED."""
    camera_ne = pose.camera_ned_m[:2]
    middle_d = scene.ground_d_m - 0.5 * scene.height_m

    def at(point_ne: np.ndarray, down: float) -> np.ndarray:
        return np.array([point_ne[0], point_ne[1], down])

    result = {"top": _highest(scene, pose, placed)}
    if placed.corners_ne_m is None:
        away = placed.center_ne_m - camera_ne
        distance, radius = float(np.hypot(*away)), 0.5 * scene.width_m
        if distance <= radius:
            return {}
        unit = away / distance
        right = np.array([-unit[1], unit[0]])
        sine = radius / distance
        foot = placed.center_ne_m - radius * sine * unit
        half_chord = radius * math.sqrt(1.0 - sine * sine)
        result["left"] = at(foot - half_chord * right, middle_d)
        result["right"] = at(foot + half_chord * right, middle_d)
        return result
    corners = placed.corners_ne_m
    outside = []
    for i in range(4):
        edge = corners[(i + 1) % 4] - corners[i]
        ray = camera_ne - corners[i]
        # clockwise from above, so the outer side is on the left of the edge's direction
        outside.append(edge[0] * ray[1] - edge[1] * ray[0] < -1e-9 * float(edge @ edge))
    faces = [i for i in range(4) if outside[i]]
    if not faces:
        return {}
    bearings = _bearing_order(camera_ne, placed.center_ne_m, corners)
    order = np.argsort(bearings)
    result["left"] = at(corners[order[0]], middle_d)
    result["right"] = at(corners[order[-1]], middle_d)
    visible = {i for face in faces for i in (face, (face + 1) % 4)}
    in_order = [i for i in order if i in visible]
    names = ("base_left", "base_near", "base_right") if len(in_order) == 3 else ("base_left", "base_right")
    result.update({name: at(corners[i], scene.ground_d_m) for name, i in zip(names, in_order)})
    return result


def make_log(scene: Scene) -> ObservationLog:
    """Flies the scene and returns its log, truth included."""
    if scene.rounding not in ("none", "pixel"):
        raise ValueError(f"unknown rounding '{scene.rounding}'")
    generator = np.random.default_rng(scene.seed)
    first = pose_at(scene, 0.0)
    placed = place(scene, first)
    frames = []
    for k in range(math.floor(scene.run_s * scene.fps_hz + 1e-9) + 1):
        t = k / scene.fps_hz
        pose = pose_at(scene, t)
        agl = scene.ground_d_m - float(pose.camera_ned_m[2])
        if agl <= 0.0:
            raise ValueError(f"the camera meets the ground after {t:g} s: start higher or run shorter")
        pixels: dict[str, Pixel | None] = {}
        for name, point in feature_points(scene, pose, placed).items():
            pixel = project(scene.camera, pose, point, scene.clip)
            if scene.pixel_sigma_px > 0.0:
                noise = generator.normal(0.0, scene.pixel_sigma_px, 2)  # drawn also if clipped: one stream per frame
                pixel = None if pixel is None else (pixel[0] + float(noise[0]), pixel[1] + float(noise[1]))
            if pixel is not None and scene.rounding == "pixel":
                pixel = (float(np.rint(pixel[0])), float(np.rint(pixel[1])))
            pixels[name] = pixel
        frames.append(
            Frame(
                t_s=scene.t0_s + t,
                id=scene.id,
                position_m=tuple(float(value) for value in pose.vehicle_ned_m),  # type: ignore[arg-type]
                attitude=quaternion_of(pose.ned_from_body),
                agl_m=agl,
                **pixels,
            )
        )
    is_box = placed.corners_ne_m is not None
    heading_deg = math.degrees(placed.heading_rad)
    length_heading = math.remainder(heading_deg + scene.alpha_deg, 360.0)
    truth = Truth(
        id=scene.id,
        static=True,
        center_n_m=float(placed.center_ne_m[0]),
        center_e_m=float(placed.center_ne_m[1]),
        ground_d_m=scene.ground_d_m,
        width_m=scene.width_m,
        length_m=scene.length_m if is_box else None,
        height_m=scene.height_m,
        heading_deg=length_heading if is_box else None,
        extra={
            "shape": scene.shape,
            "x0_m": repr(float(scene.x0_m)),
            "z0_m": repr(float(scene.z0_m)),
            "orientation_deg": repr(float(scene.alpha_deg)) if is_box else "",
            "track_heading_deg": repr(heading_deg),
        },
    )
    return ObservationLog(scene.camera, frames, {scene.id: truth})


# -------------------------------------------------------------------------------------------------------------- shell


def _numbers(text: str, count: int) -> tuple[float, ...]:
    parts = text.split(",")
    if len(parts) != count:
        raise argparse.ArgumentTypeError(f"'{text}': {count} numbers with commas between them are needed")
    try:
        values = tuple(float(part) for part in parts)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}': not numbers") from None
    if not all(math.isfinite(value) for value in values):
        raise argparse.ArgumentTypeError(f"'{text}': not finite")
    return values


def _obstacle(text: str) -> tuple[str, float, float, float]:
    if text in PRESETS:
        return PRESETS[text]
    kind, _, sizes = text.partition(":")
    if kind == "box":
        shape = ("box", *_numbers(sizes, 3))
    elif kind == "disc":
        diameter, height = _numbers(sizes, 2)
        shape = ("cylinder", diameter, diameter, height)
    else:
        raise argparse.ArgumentTypeError(f"'{text}': one of {', '.join(PRESETS)}, box:W,L,H or disc:D,H")
    if min(shape[1:]) <= 0.0:  # type: ignore[type-var]
        raise argparse.ArgumentTypeError(f"'{text}': sizes must be positive")
    return shape  # type: ignore[return-value]


def _path(text: str) -> dict[str, object]:
    kind, _, rest = text.partition(":")
    if text == "straight":
        return {"path": "straight"}
    if kind == "arc":
        (radius,) = _numbers(rest, 1)
        if radius != 0.0:
            return {"path": "arc", "arc_radius_m": radius}
    if kind == "weave":
        amplitude, period = _numbers(rest, 2)
        if period > 0.0:
            return {"path": "weave", "weave_amplitude_m": amplitude, "weave_period_s": period}
    raise argparse.ArgumentTypeError(f"'{text}': straight, arc:R (m, positive right) or weave:A,T (m, s)")


def _speed_profile(text: str) -> float:
    kind, _, rest = text.partition(":")
    if text == "constant":
        return 0.0
    if kind == "ramp":
        return _numbers(rest, 1)[0]
    raise argparse.ArgumentTypeError(f"'{text}': constant or ramp:A (m/s^2)")


def _noise(text: str) -> dict[str, object]:
    kind, _, rest = text.partition(":")
    if text == "none":
        return {}
    if text == "rounding":
        return {"rounding": "pixel"}
    if kind == "pixel":
        return {"pixel_sigma_px": _numbers(rest, 1)[0]}
    raise argparse.ArgumentTypeError(f"'{text}': none, rounding or pixel:SIGMA (px)")


def _heading(text: str) -> float | None:
    return None if text == "auto" else _numbers(text, 1)[0]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "--obstacle",
        type=_obstacle,
        default=PRESETS["truck"],
        metavar="WHAT",
        help=f"{', '.join(PRESETS)}, box:W,L,H or disc:D,H (m); default truck",
    )
    add("--x0", type=float, default=-12.0, metavar="M", help="reference point right of the start (default -12)")
    add("--z0", type=float, metavar="M", help="reference point ahead of the start (default: speed times reach)")
    add("--reach", type=float, default=12.0, metavar="S", help="time to come abeam at the first speed (default 12)")
    add("--run", type=float, default=10.0, metavar="S", help="duration of the log (default 10)")
    add("--alpha", type=float, default=0.0, metavar="DEG", help="length axis from the flight direction (default 0)")
    add("--altitude", type=float, default=20.0, metavar="M", help="above the ground at the start (default 20)")
    add("--glide", type=float, default=0.0, metavar="DEG", help="descent angle (default 0)")
    add("--speed", type=float, default=17.0, metavar="MPS", help="default 17")
    add("--fps", type=float, default=8.0, metavar="HZ", help="images per second (default 8)")
    add("--course", type=float, default=0.0, metavar="DEG", help="direction of flight at the start (default 0: north)")
    add(
        "--path",
        type=_path,
        default={"path": "straight"},
        metavar="P",
        help="straight, arc:R (m, positive: right) or weave:A,T (m, s)",
    )
    add("--speed-profile", type=_speed_profile, default=0.0, metavar="P", help="constant or ramp:A (m/s^2)")
    add("--pitch", type=float, default=0.0, metavar="DEG", help="constant pitch on top of the glide path's")
    add("--wobble", type=float, default=0.0, metavar="DEG", help="amplitude of an attitude oscillation (default 0)")
    add("--noise", type=_noise, default={}, metavar="N", help="none, rounding (whole pixels) or pixel:SIGMA (px)")
    add("--seed", type=int, default=1, metavar="N", help="of the pixel noise (default 1)")
    add("--clip", action="store_true", help="points outside the image are not measured")
    add(
        "--start",
        type=lambda text: _numbers(text, 3),
        default=(0.0, 0.0, 0.0),
        metavar="N,E,D",
        help="NED of the ground point under the start (m)",
    )
    add("--t0", type=float, default=0.0, metavar="S", help="time stamp of the first image (default 0)")
    add("--id", type=int, default=1, metavar="N", help="track id (default 1)")
    add("--image", type=lambda text: _numbers(text, 2), default=(1280.0, 1280.0), metavar="W,H", help="px")
    add("--focal", type=float, default=914.0, metavar="PX", help="focal length (default 914)")
    add("--yaw-camera", type=float, default=0.0, metavar="DEG", help="mounting, negative looks left (default 0)")
    add("--pitch-camera", type=float, default=0.0, metavar="DEG", help="mounting, positive looks up (default 0)")
    add("--roll-camera", type=float, default=0.0, metavar="DEG", help="mounting (default 0)")
    add("--lens", type=lambda text: _numbers(text, 5), default=(0.0,) * 5, metavar="K1,K2,P1,P2,K3", help="distortion")
    add(
        "--offset",
        type=lambda text: _numbers(text, 3),
        default=(0.0,) * 3,
        metavar="X,Y,Z",
        help="camera in body axes (m)",
    )
    add("--t-heading", type=_heading, default=None, metavar="DEG", help="T's Z axis; default auto: the first yaw")
    add("--out", type=Path, required=True, metavar="DIR", help="folder to write")


def scene_of(arguments: argparse.Namespace) -> Scene:
    """The scene that a command line asks for."""
    shape, width, length, height = arguments.obstacle
    camera = Camera(
        arguments.image[0],
        arguments.image[1],
        arguments.focal,
        arguments.focal,
        0.5 * arguments.image[0],
        0.5 * arguments.image[1],
        *arguments.lens,
        mount_roll_deg=arguments.roll_camera,
        mount_pitch_deg=arguments.pitch_camera,
        mount_yaw_deg=arguments.yaw_camera,
        offset_x_m=arguments.offset[0],
        offset_y_m=arguments.offset[1],
        offset_z_m=arguments.offset[2],
        heading_deg=arguments.t_heading,
    )
    return Scene(
        shape=shape,
        width_m=width,
        length_m=length,
        height_m=height,
        x0_m=arguments.x0,
        z0_m=arguments.speed * arguments.reach if arguments.z0 is None else arguments.z0,
        alpha_deg=arguments.alpha,
        run_s=arguments.run,
        fps_hz=arguments.fps,
        speed_mps=arguments.speed,
        acceleration_mps2=arguments.speed_profile,
        course_deg=arguments.course,
        altitude_m=arguments.altitude,
        glide_deg=arguments.glide,
        pitch_deg=arguments.pitch,
        wobble_deg=arguments.wobble,
        start_ne_m=(arguments.start[0], arguments.start[1]),
        ground_d_m=arguments.start[2],
        seed=arguments.seed,
        clip=arguments.clip,
        id=arguments.id,
        t0_s=arguments.t0,
        camera=camera,
        **arguments.path,
        **arguments.noise,
    )


def run(arguments: argparse.Namespace) -> int:
    log = make_log(scene_of(arguments))
    try:
        write_log(arguments.out, log, "made by goe_tools scene")
    except OSError as error:
        raise LogError(arguments.out, 0, "", error.strerror or str(error)) from None
    print(f"{arguments.out}: {len(log.frames)} rows")
    return 0
