"""Generated flights: the library's input in every image, and the truth.

Flat arrays of all images of all flights.
"""

from __future__ import annotations

from dataclasses import dataclass

import goe
import numpy as np

from . import errors, features, mishaps, motion, optics, seen
from .genes import ORBIT, TURNING, Array, Params
from .mishaps import LONG_ATTITUDE, NAN_ATTITUDE, OLD_TIME, Mishaps
from .motion import Motion
from .shapes import Solid

COLLISION_SHARE = 0.45  # of the offsets
MARGINS_MOST = 4.0
CLOSEST_M = 1.0  # a flight ends when the camera comes nearer to the outline
NEAREST_START_M = 20.0
PITCH_MOST_DEG = 50.0
ALTERNATING = 0.3


@dataclass
class World:
    """F flights with N images in all; those of flight i are ``start[i]`` to ``start[i + 1]``."""

    p: Params
    start: np.ndarray  # (F + 1,)
    flight: np.ndarray  # (N,)
    t_s: Array  # (N,) true
    camera: Array  # (N, 3) true, NED over the ground at the obstacle
    vehicle: Array  # (N, 3) true
    reported: Array  # (N, 3) position as given
    velocity: Array  # (N, 3) planned
    detected: np.ndarray  # (N,) a feature is marked as visible
    known: np.ndarray  # (N,) with a filter reset of known size
    unknown: np.ndarray  # (N,)
    refused: np.ndarray  # (N,) must be refused
    near_hidden: np.ndarray  # (N,) as in features.Detections
    cut: np.ndarray  # (N,)
    roll_deg: Array  # (N,)
    solid: Solid  # (F,) relative to the origin, not to a camera
    height_m: Array  # (F,)
    heading_deg: Array  # (F,) setting; NaN: auto
    mount_deg: Array  # (F, 2, 3) yaw, pitch, roll of both cameras
    images: np.ndarray  # (N,) of goe.IMAGE

    def slice(self, i: int) -> slice:
        return slice(int(self.start[i]), int(self.start[i + 1]))


OF_IMAGES = (
    "flight", "t_s", "camera", "vehicle", "reported", "velocity", "detected", "known", "unknown", "refused",
    "near_hidden", "cut", "roll_deg", "images",
)  # fmt: skip


def quaternion(angles: Array, error: Array) -> Array:
    """(..., 4) from yaw, pitch, roll, with an error of small rotations about the body's axes, rad."""
    cy, cp, cr = (np.cos(0.5 * angles[..., i]) for i in range(3))
    sy, sp, sr = (np.sin(0.5 * angles[..., i]) for i in range(3))
    w, x = cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr
    y, z = cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr
    half = 0.5 * np.sqrt(np.sum(error**2, -1))
    sinc = np.sinc(half / np.pi) * 0.5
    ew, (ex, ey, ez) = np.cos(half), np.moveaxis(error * sinc[..., None], -1, 0)
    return np.stack(
        [w * ew - x * ex - y * ey - z * ez, w * ex + x * ew + y * ez - z * ey,
         w * ey - x * ez + y * ew + z * ex, w * ez + x * ey - y * ex + z * ew], -1,
    )  # fmt: skip


def _solid(p: Params, moved: Motion) -> Solid:
    """Ahead of the path at the image ``mid``, or in the middle of an orbit."""
    rows = np.arange(len(p["mix"]))
    mid = np.where(
        p["kind"] == TURNING, moved.first + (p["mid"] * (moved.count - moved.first - 1)).astype(int), moved.first
    )
    course = np.where(p["kind"] == TURNING, moved.course[rows, mid], np.radians(p["course_deg"]))
    here, begun = moved.position[rows, mid, :2], moved.position[rows, moved.first, :2]
    ahead, right = np.stack([np.cos(course), np.sin(course)], 1), np.stack([-np.sin(course), np.cos(course)], 1)
    half = 0.5 * np.stack([p["a_m"], p["b_m"]], 1)
    turned = np.radians(p["turned_deg"])
    lateral = np.where(
        p["round"], half[:, 0], np.abs(half[:, 0] * np.sin(turned)) + np.abs(half[:, 1] * np.cos(turned))
    )
    hit, miss = p["offset"] / COLLISION_SHARE, (p["offset"] - COLLISION_SHARE) / (1.0 - COLLISION_SHARE)
    aside = np.where(hit < 1.0, lateral * (2.0 * hit - 1.0), lateral + MARGINS_MOST * p["margin_m"] * miss) * p["side"]
    extent = np.hypot(half[:, 0], half[:, 1])
    flown = np.hypot(*(here - begun).T)
    distance = np.maximum(p["range_m"] - flown, NEAREST_START_M + extent)
    distance = np.sqrt(np.maximum(distance**2 - aside**2, (0.5 * distance) ** 2))
    center = here + ahead * distance[:, None] + right * aside[:, None]
    wobble = (p["offset"] - 0.5) * 0.4 * p["range_m"]
    orbit = begun + right * (p["side"] * p["range_m"])[:, None] + ahead * wobble[:, None]
    center = np.where((p["kind"] == ORBIT)[:, None], orbit, center)
    zero = np.zeros(len(rows))
    return Solid(p["round"], center, half, np.radians(p["course_deg"]) + turned, zero, -p["h_m"])


def _mount(p: Params, moved: Motion, solid: Solid) -> Array:
    """(F, 2, 3) degrees: both cameras point approximately at the obstacle in the middle of the flight."""
    rows, mid = np.arange(len(p["mix"])), moved.first + (p["mid"] * (moved.count - moved.first - 1)).astype(int)
    to = solid.center - moved.position[rows, mid, :2]
    yaw = np.arctan2(to[:, 1], to[:, 0]) - moved.angles[rows, mid, 0]
    yaw = np.degrees((yaw + np.pi) % (2.0 * np.pi) - np.pi)
    looks = p["look"] | (p["kind"] == ORBIT)
    yaw = np.where(looks, yaw, 0.0) + p["jitter_yaw_deg"]
    over = -moved.position[rows, mid, 2] - 0.5 * p["h_m"]
    pitch = np.degrees(-np.arctan2(over, np.hypot(*to.T))) - np.where(
        looks, np.degrees(moved.angles[rows, mid, 1]) * np.cos(np.radians(yaw)), 0.0
    )
    pitch = np.clip(pitch, -PITCH_MOST_DEG, PITCH_MOST_DEG) + p["jitter_pitch_deg"]
    one = np.stack([yaw, pitch, p["mount_roll_deg"]], 1)
    other = one + np.stack([p["second_yaw_deg"], 0.0 * yaw, 0.0 * yaw], 1)
    return np.stack([one, other], 1)


def _camera_number(p: Params, moved: Motion) -> np.ndarray:
    number = np.arange(moved.t_s.shape[1])
    alternate = (p["second_share"] < ALTERNATING)[:, None]
    late = number >= moved.first[:, None] + (p["second_share"][:, None] * (moved.count - moved.first)[:, None])
    return np.where(p["two_cameras"][:, None], np.where(alternate, number % 2 == 1, late), False).astype(np.uint8)


def _heading(p: Params, camera: Array, solid: Solid) -> Array:
    to = solid.center - camera[:, 0, :2]
    given = np.degrees(np.arctan2(to[:, 1], to[:, 0])) + p["heading_off_deg"]
    given = (given + 180.0) % 360.0 - 180.0
    return np.where(p["heading_auto"] & (p["kind"] != ORBIT), np.nan, given)


def relative_to(solid: Solid, flight: np.ndarray, camera: Array) -> Solid:
    """(N,) from (F,): relative to the cameras."""
    own = solid.take(flight)
    return Solid(
        own.round, own.center - camera[:, :2], own.half, own.heading, own.foot - camera[:, 2], own.roof - camera[:, 2]
    )


def _kept(moved: Motion, camera: Array, solid: Solid) -> np.ndarray:
    """(F, K): until the camera comes too close."""
    count, most = camera.shape[:2]
    near = relative_to(solid, np.repeat(np.arange(count), most), camera.reshape(-1, 3)).distance().reshape(count, most)
    ended = np.cumsum(near < CLOSEST_M, 1) > 0
    found = ~ended & (np.arange(most) < moved.count[:, None])
    found[:, 0] = True
    return found


def _risen(moved: Motion, camera: Array, solid: Solid, slope: Array) -> Array:
    """(F, K): height of the ground under the aircraft over that at the obstacle."""
    begun = solid.center - camera[np.arange(len(slope)), moved.first, :2]
    ahead = begun / np.hypot(*begun.T)[:, None]
    return slope[:, None] * np.einsum("fkj,fj->fk", solid.center[:, None] - camera[..., :2], ahead)


def _plan(p: Params, moved: Motion) -> Array:
    """(F, K, 3): planned velocities: as flown, constant for a while."""
    number = np.arange(moved.t_s.shape[1])
    block = np.maximum(number - moved.first[:, None], 0) // p["plan_hold"][:, None] * p["plan_hold"][:, None]
    at = np.minimum(block + moved.first[:, None], moved.t_s.shape[1] - 1)
    found = np.take_along_axis(moved.velocity, at[..., None], 1)
    c, s = np.cos(np.radians(p["plan_turn_deg"]))[:, None], np.sin(np.radians(p["plan_turn_deg"]))[:, None]
    climb = p["plan_climb_m_s"][:, None]
    down = np.where(np.isnan(climb), found[..., 2], -climb)
    return np.stack([c * found[..., 0] - s * found[..., 1], s * found[..., 0] + c * found[..., 1], down], -1)


def _given_pose(world: dict[str, Array], attitude: Array, refused: np.ndarray, kind: np.ndarray) -> None:
    """Makes the poses of images to be refused invalid."""
    attitude[refused & (kind == NAN_ATTITUDE)] = np.nan
    attitude[refused & (kind == LONG_ATTITUDE)] *= 1.1
    late = np.flatnonzero(refused & (kind == OLD_TIME))
    world["time_us"][late] = world["time_us"][late - 1]


def fly(p: Params) -> World:
    counts = p["images"] + motion.pre_images(p)
    draws = errors.draw(p["seed"], counts)
    moved = motion.move(p, draws)
    happened: Mishaps = mishaps.happen(p, draws, moved)
    wrong = errors.pose_errors(p, draws, moved.t_s, np.cumsum(happened.unknown, 1) > 0)
    solid = _solid(p, moved)
    lever = np.stack([p[f"lever_{axis}_m"] for axis in "xyz"], 1)
    camera = moved.position + np.einsum("fkij,fj->fki", moved.turned, lever)
    kept = _kept(moved, camera, solid)
    flight, k = np.nonzero(kept)
    start = np.concatenate([[0], np.cumsum(kept.sum(1))])
    mount, number = _mount(p, moved, solid), _camera_number(p, moved)[kept]
    axes = optics.mounted(*np.moveaxis(mount, -1, 0))[flight, number]
    looking = optics.view(p, moved.turned[kept], axes, flight)
    hides = p["hidden_always"][flight] | (2 * k < p["images"][flight])
    bushes = np.where(hides, p["hidden_m"][flight], 0.0)
    ideal = seen.look(p, flight, looking, relative_to(solid, flight, camera[kept]), bushes)
    detections = features.detect(p, draws, moved, kept, flight, looking, ideal, happened.detected[kept])
    origin = np.stack([p[f"origin_{axis}_m"] for axis in "ned"], 1)[flight]
    reported = (moved.position + wrong.position + happened.jump)[kept] + origin
    attitude = quaternion(moved.angles[kept], wrong.attitude[kept])
    columns = {"time_us": np.round(moved.t_s[kept] * 1e6).astype(np.int64) + 1_000_000}
    refused = happened.refused[kept] & (k > 0)
    _given_pose(columns, attitude, refused, p["refused_kind"][flight])
    delta = happened.delta[kept]
    risen = _risen(moved, camera, solid, wrong.slope)
    over_ground = (wrong.height + happened.jump_height - risen)[kept] - camera[kept][:, 2]
    images = goe.Images(
        columns["time_us"], reported, attitude, over_ground,
        box_px=detections.box, points_px=detections.points, reset_count=(happened.count[kept] % 256).astype(np.uint8),
        reset_delta_ned_m=delta, camera=number,
    ).to_c()  # fmt: skip
    return World(
        p, start, flight, moved.t_s[kept], camera[kept], moved.position[kept], reported, _plan(p, moved)[kept],
        detections.any_seen, happened.known[kept], happened.unknown[kept], refused, detections.near_hidden,
        detections.cut,
        np.degrees(moved.angles[kept][:, 2]), solid,
        p["h_m"], _heading(p, camera, solid), mount, images,
    )  # fmt: skip
