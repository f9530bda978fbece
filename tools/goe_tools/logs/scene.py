"""Synthetic observation logs of one upright box or cylinder on flat ground, recorded by a flying camera.

The obstacle is placed in the trajectory frame T of the first image (X right, Z forward, level). A box has the middle
of its front edge (length W, on the side of the start) at (X0, Z0), and alpha turns its length axis from Z, clockwise
from above; a cylinder has its center at (X0, Z0). X0 < 0 is left of the flight path.

Features are exact points of the obstacle: the silhouette's left and right are taken at half the obstacle's height (for
a cylinder on its exact tangents), the top is the highest point in the image, and of the base only the corners of
visible faces are given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .obslog import FEATURES, Camera, Frame, ObservationLog, Pixel, Truth
from .projection import CAMERA_AXES_IN_BODY, Pose, project, quaternion_of, yaw_pitch_roll

GRAVITY_MPS2 = 9.80665


@dataclass
class Scene:
    """All inputs of a synthetic log."""

    shape: str = "box"  # box or cylinder
    width_m: float = 2.5  # front edge of the box, diameter of the cylinder
    length_m: float = 7.0
    height_m: float = 2.5
    x0_m: float = -12.0
    z0_m: float = 200.0
    alpha_deg: float = 0.0  # of the length axis, from Z
    run_s: float = 8.0
    fps_hz: float = 8.0
    speed_mps: float = 17.0
    acceleration_mps2: float = 0.0
    path: str = "straight"  # straight, arc, weave
    arc_radius_m: float = 400.0  # positive: turns right
    weave_amplitude_m: float = 5.0
    weave_period_s: float = 6.0
    course_deg: float = 0.0  # direction of flight at the start, clockwise from north (weave: of its center line)
    altitude_m: float = 20.0  # vehicle above the ground at the first image
    glide_deg: float = 0.0  # positive: descending
    pitch_deg: float = 0.0  # constant, added to the glide path's
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


@dataclass
class Placed:
    """The obstacle in NED. ``corners_ne_m``: 4 x 2, clockwise from above, from the front left; of a cylinder: None."""

    heading_rad: float  # of T's Z axis
    center_ne_m: np.ndarray
    corners_ne_m: np.ndarray | None


def place(scene: Scene, first: Pose) -> Placed:
    """Puts the obstacle at (X0, Z0) of the trajectory frame of the first pose."""
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
    """The obstacle's top point that is highest in the (undistorted) image, NED."""
    top_d = scene.ground_d_m - scene.height_m
    to_camera = pose.ned_from_camera.T
    if placed.corners_ne_m is not None:
        points = np.column_stack([placed.corners_ne_m, np.full(4, top_d)])
        rays = (points - pose.camera_ned_m) @ to_camera.T
        ahead = rays[:, 2] > 0.0
        slope = np.where(ahead, rays[:, 1] / np.where(ahead, rays[:, 2], 1.0), np.inf)
        return points[int(np.argmin(slope))]
    # On the rim C + r (cos t, sin t) the image's y is a ratio of two sinusoids, (a0 + a.e(t)) / (b0 + b.e(t)); its
    # least value y solves a0 - y b0 = |a - y b|, in the direction -(a - y b).
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
    """The features that the obstacle itself does not hide, as points in NED."""
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


def _in_track(scene: Scene, placed: Placed, frames: list[Frame]) -> tuple[float, float, float]:
    """X0, Z0 and the heading of T's Z axis, deg: T starts at the first image with a visible feature."""
    heading_deg = math.degrees(placed.heading_rad)
    shown = [any(getattr(frame, name) is not None for name in FEATURES) for frame in frames]
    if shown[0] or not any(shown):
        return scene.x0_m, scene.z0_m, heading_deg
    begin = pose_at(scene, shown.index(True) / scene.fps_hz)
    if scene.camera.heading_deg is None:
        heading_deg = math.degrees(math.atan2(begin.ned_from_body[1, 0], begin.ned_from_body[0, 0]))
    reference = placed.center_ne_m
    if placed.corners_ne_m is not None:
        reference = 0.5 * (placed.corners_ne_m[0] + placed.corners_ne_m[3])  # the middle of the front edge
    north, east = reference - begin.camera_ned_m[:2]
    c, s = math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg))
    return float(c * east - s * north), float(c * north + s * east), heading_deg


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
            raise ValueError(f"the camera hits the ground after {t:g} s: start higher or use a shorter run")
        pixels: dict[str, Pixel | None] = {}
        for name, point in feature_points(scene, pose, placed).items():
            pixel = project(scene.camera, pose, point, scene.clip)
            if scene.pixel_sigma_px > 0.0:
                noise = generator.normal(0.0, scene.pixel_sigma_px, 2)  # also if clipped: one stream per frame
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
    length_heading = math.remainder(math.degrees(placed.heading_rad) + scene.alpha_deg, 360.0)
    x0_m, z0_m, heading_deg = _in_track(scene, placed, frames)
    turned_deg = math.remainder(heading_deg - math.degrees(placed.heading_rad), 360.0)
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
            "x0_m": repr(float(x0_m)),
            "z0_m": repr(float(z0_m)),
            "orientation_deg": repr(float(scene.alpha_deg - turned_deg)) if is_box else "",
            "track_heading_deg": repr(heading_deg),
        },
    )
    return ObservationLog(scene.camera, frames, {scene.id: truth})
