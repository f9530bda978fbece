"""One track: flight, obstacle, camera and errors together."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from . import errors, motion, solids, surroundings, turns, view
from .errors import Wrong
from .motion import Flown, Span
from .solids import Solid
from .view import Camera, Standpoint

SEED = 20260511
MIN_IMAGES = 12  # with features, for a track
MIXED = "mixed"  # two boxes to one cylinder
FEATURES = ("corners", "outline", "boxes", "boxes with corners")
ATTEMPTS = 200  # to draw a flight with the obstacle in view
BEHIND_COS = math.cos(math.radians(87.0))  # from T's Z axis: a larger angle cannot be used
KEPT_M = 3.0  # least distance of the camera from the obstacle's outline
ORIGIN_M = 3000.0  # largest coordinate of the flight's start in NED


@dataclass(frozen=True)
class Scenario:
    """The random generation of a track; the same values apply to all tracks of a row."""

    flown: Flown = field(default_factory=Flown)
    kind: str = MIXED  # a solid's, or mixed
    size_m: tuple[float, float] = (2.0, 25.0)
    features: str = (
        "corners"  # left, right, top and base corners; outline: without the corners; boxes: upright boxes alone
    )
    hidden_m: Span = (0.0, 0.0)  # height of the bushes before the base ...
    hidden_share: Span = (0.0, 0.0)  # ... or of trees, as a share of the obstacle's height ...
    hidden_until: float = 1.0  # ... in this first part of the images
    corners_lost: float = 0.5  # probability that hidden base corners are absent, not raised
    foreign: float = 0.0  # share of the images whose features are those of another obstacle nearby
    at_border: bool = False  # the border of the image cuts the obstacle halfway
    wrong: Wrong = field(default_factory=Wrong)
    mount_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)  # yaw, pitch, roll of the camera
    moves_m_s: float = 0.0
    moves: str = ""  # across, diagonal, along, oncoming
    collides: bool = False  # the camera may come nearer than KEPT_M

    def by(self, **changes: object) -> Scenario:
        """With other values; those of flight and errors are given by their names."""
        inner = {name: getattr(self, name) for name in ("flown", "wrong")}
        own: dict[str, object] = {}
        for name, value in changes.items():
            for part, of_part in inner.items():
                if name in type(of_part).__dataclass_fields__:
                    inner[part] = replace(of_part, **{name: value})
                    break
            else:
                own[name] = value
        return replace(self, **inner, **own)  # type: ignore[arg-type]


@dataclass
class Truth:
    """The truth in T axes."""

    solid: Solid
    middle_m: np.ndarray  # (2,) X, Z
    axis_rad: float  # T's Z axis, clockwise from north
    velocity_ned_m_s: np.ndarray  # (2,) north, east of the obstacle
    path_velocity_ned_m_s: np.ndarray  # (K, 3) of the aircraft, true
    eye_ned_m: np.ndarray  # (K, 3) true, about the obstacle's first middle; down from its ground


@dataclass
class Inputs:
    """Input of an estimator: K images, and settings by the library's names."""

    number: int
    time_s: np.ndarray
    position_ned_m: np.ndarray
    attitude: np.ndarray
    height_m: np.ndarray
    pixel_px: np.ndarray
    seen: np.ndarray
    box_px: np.ndarray | None
    reset_count: np.ndarray
    reset_m: np.ndarray
    velocity_ned_m_s: np.ndarray
    settings: dict[str, float]
    truth: Truth

    @property
    def shown(self) -> np.ndarray:
        """(K,): whether an image shows a part of the obstacle."""
        shown = self.seen.any(1)
        return shown if self.box_px is None else shown | np.isfinite(self.box_px).any(1)


def kind_of(scenario: Scenario, number: int) -> str:
    """Of three tracks of a half, two pass boxes and one passes a cylinder."""
    if scenario.kind != MIXED:
        return scenario.kind
    return "cylinder" if number // 2 % 3 == 2 else "box"


def _velocity(scenario: Scenario, rng: np.random.Generator) -> np.ndarray:
    """(2,): forward and right velocity of the obstacle."""
    side = float(rng.choice([-1.0, 1.0]))
    away = float(rng.choice([-1.0, 1.0]))
    direction = {
        "": (0.0, 0.0), "across": (0.0, side), "along": (1.0, 0.0), "oncoming": (-1.0, 0.0),
        "diagonal": (away * math.sqrt(0.5), side * math.sqrt(0.5)),
    }  # fmt: skip
    return scenario.moves_m_s * np.array(direction[scenario.moves])


def _settings(camera: Camera, wrong: Wrong, axis_deg: float, rng: np.random.Generator) -> dict[str, float]:
    focal = camera.focal_px * (1.0 + wrong.focal_share)
    mount = errors.configured_mounting(camera.mount_deg, wrong, rng)
    result = {"camera.fx_px": focal, "camera.fy_px": focal}
    result |= {"camera.cx_px": camera.middle_px, "camera.cy_px": camera.middle_px}
    result |= {"camera.width_px": camera.width_px, "camera.height_px": camera.height_px}
    result |= {f"camera.mount_{name}_deg": angle for name, angle in zip(("yaw", "pitch", "roll"), mount)}
    return result | {"heading_auto": 0.0, "heading_deg": (axis_deg + 180.0) % 360.0 - 180.0}


@dataclass(frozen=True)
class _World:
    """The true flight over all images of its path; course axes (forward, right, down)."""

    path: motion.Path
    to_ned: np.ndarray
    axis_rad: float  # T's Z axis, clockwise from north
    solid: Solid  # orientation from the course's forward
    velocity_m_s: np.ndarray  # (2,) of the solid
    middle_m: np.ndarray  # (K, 2) of the solid
    place_m: np.ndarray  # (K, 3) of the camera
    stand: Standpoint


def _world(scenario: Scenario, number: int, rng: np.random.Generator, harder: np.random.Generator) -> _World:
    solid = solids.drawn(kind_of(scenario, number), scenario.size_m, rng)
    path = motion.PATHS[scenario.flown.path](scenario.flown, solid.half_m, rng)
    heading, velocity, time = rng.uniform(-math.pi, math.pi), _velocity(scenario, rng), path.time_s
    crosses = scenario.moves in ("across", "diagonal")  # then it reaches the path's obstacle place halfway
    middle = path.obstacle_m + velocity * (time - (0.5 * (time[0] + time[-1]) if crosses else time[0]))[:, None]
    place, body = path.at(time)
    yaw, pitch, roll = scenario.mount_deg
    camera = Camera(k1=scenario.wrong.k1, mount_deg=(yaw + path.mount_yaw_deg, pitch, roll))
    if scenario.at_border:
        camera = surroundings.at_border(camera, place, middle, harder)
    turned = replace(solid, orientation_rad=solid.orientation_rad + path.axis_rad)
    eye = np.stack([place[:, 1], place[:, 0], -place[:, 2]], 1)
    stand = Standpoint(camera, eye, body, middle[:, ::-1])
    stand = replace(stand, hidden_m=_hidden(scenario, solid, stand, harder))
    return _World(path, turns.about(2, heading), heading + path.axis_rad, turned, velocity, middle, place, stand)


def _hidden(scenario: Scenario, solid: Solid, stand: Standpoint, rng: np.random.Generator) -> np.ndarray | None:
    """Height (K,) below which the obstacle is hidden; None: nowhere."""
    if not any(scenario.hidden_m + scenario.hidden_share):
        return None
    low, share = scenario.hidden_m, scenario.hidden_share
    return surroundings.hidden_m(solid, stand, low, share, scenario.hidden_until, rng)


Features = tuple[np.ndarray, np.ndarray]  # points (K, 6, 2), boxes (K, 4)


def _exact(scenario: Scenario, solid: Solid, stand: Standpoint, lost: bool) -> Features:
    """``lost``: hidden base corners are absent."""
    found = view.points(solid, stand, "corners" in scenario.features)
    if stand.hidden_m is not None and lost:
        found[stand.hidden_m > 0.0, view.BASE_LEFT :] = np.nan
    return found, view.boxes(solid, stand) if "boxes" in scenario.features else np.full((len(found), 4), np.nan)


def _shown(scenario: Scenario, world: _World, rng: np.random.Generator) -> Features:
    """The exact features; in some images those of a neighbor, if it is in view."""
    found = _exact(scenario, world.solid, world.stand, bool(rng.random() < scenario.corners_lost))
    if not scenario.foreign:
        return found
    other = _exact(scenario, *surroundings.neighbor(world.solid, world.stand, scenario.size_m, rng), False)
    hit = rng.random(len(found[0])) < scenario.foreign
    for own, foreign in zip(found, other):
        there = hit & np.isfinite(foreign).reshape(len(hit), -1).any(1)
        own[there] = foreign[there]
    return found


def _detected(
    scenario: Scenario, world: _World, rng: np.random.Generator, harder: np.random.Generator
) -> tuple[np.ndarray, np.ndarray | None]:
    """Points (K, 6, 2) and boxes (K, 4), NaN without one."""
    time, (exact, exact_box) = world.path.time_s, _shown(scenario, world, harder)
    box = None
    if "boxes" in scenario.features:
        given = errors.spoil_boxes(exact_box, time, scenario.wrong, rng)
        box = view.cut_at_border(given, exact_box, world.stand.camera)
    if scenario.features == "boxes":
        return np.full_like(exact, np.nan), box
    pixel = errors.spoil_points(exact, time, scenario.wrong, rng)
    if box is not None:
        pixel[:, : view.BASE_LEFT] = np.nan
        return np.where(np.isfinite(box[:, :1, None]), pixel, np.nan), box
    whole = np.isfinite(exact[:, [view.LEFT, view.RIGHT]]).all((1, 2))
    return np.where(whole[:, None, None], pixel, np.nan), None


def _is_behind(world: _World, start: int, visible: int) -> bool:
    """Whether the obstacle is first visible behind the path's Z axis; then the nose sets T's axis."""
    away = world.middle_m[visible] - world.place_m[visible, :2]
    axis = world.path.axis_rad
    return start != visible and float(away @ [math.cos(axis), math.sin(axis)]) < BEHIND_COS * float(np.hypot(*away))


def _truth(world: _World, part: slice, origin: int, axis: float) -> Truth:
    """``origin``: image that fixes T; ``axis``: T's Z axis from the course's forward."""
    path = world.path
    time, place, middle = path.time_s[part], world.place_m[part], world.middle_m[part]
    to_t = np.array([[-math.sin(axis), math.cos(axis)], [math.cos(axis), math.sin(axis)]])  # (forward, right) -> (X, Z)
    about_middle = place - np.append(middle[0], 0.0)
    return Truth(
        replace(world.solid, orientation_rad=world.solid.orientation_rad - axis),
        (middle[0] - world.place_m[origin, :2]) @ to_t, world.axis_rad - path.axis_rad + axis,
        world.velocity_m_s @ world.to_ned[:2, :2].T, path.velocity(time) @ world.to_ned.T,
        about_middle @ world.to_ned.T,
    )  # fmt: skip


def _one(scenario: Scenario, number: int, attempt: int) -> Inputs | None:
    """None if too few images show the obstacle, or the camera comes too near."""
    rng, noise, harder = (np.random.default_rng([SEED, number, attempt, part]) for part in range(3))
    world = _world(scenario, number, rng, harder)
    away = np.linalg.norm(world.place_m[:, :2] - world.middle_m, axis=1)
    if (away < world.solid.half_m + KEPT_M).any() and not scenario.collides:
        return None
    pixel, box = _detected(scenario, world, noise, harder)
    shown = np.isfinite(pixel).any((1, 2)) if box is None else np.isfinite(box).any(1)  # points come with a box
    if shown.sum() < MIN_IMAGES:
        return None
    part = slice(int(np.argmax(shown)) if world.path.trimmed else 0, len(shown) - int(np.argmax(shown[::-1])))
    time = world.path.time_s[part]
    origin = np.append(rng.uniform(-ORIGIN_M, ORIGIN_M, 2), 0.0)
    pose, jumped = errors.reported_pose(
        world.path, time, world.to_ned, origin, world.path.obstacle_m, scenario.wrong, noise, harder
    )
    steps = np.diff(jumped, axis=0, prepend=jumped[:1])
    seen = np.isfinite(pixel[part]).all(-1)
    first_visible, axis = int(np.argmax(shown)), world.path.axis_rad  # that image fixes T and its origin
    by_nose = _is_behind(world, part.start, first_visible)
    if by_nose:
        nose = pose.attitude[first_visible - part.start, :, 0]
        axis = math.atan2(nose[1], nose[0]) - world.axis_rad + world.path.axis_rad
    truth = _truth(world, part, first_visible, axis)
    settings = _settings(world.stand.camera, scenario.wrong, math.degrees(truth.axis_rad), noise)
    if by_nose:
        settings |= {"heading_auto": 1.0, "heading_deg": 0.0}
    return Inputs(
        number, time - time[0], pose.position_m, pose.quaternion, pose.height_m,
        np.where(seen[..., None], pixel[part], 0.0), seen, None if box is None else box[part],
        np.cumsum(np.abs(steps).max(1) > 0), steps, truth.path_velocity_ned_m_s + pose.velocity_error_m_s,
        settings, truth,
    )  # fmt: skip


def fly(scenario: Scenario, number: int) -> Inputs:
    """The track with a number: the same number gives the same flight; rows that differ only in errors share flights."""
    for attempt in range(ATTEMPTS):
        inputs = _one(scenario, number, attempt)
        if inputs is not None:
            return inputs
    raise ValueError(f"track {number}: no flight of {ATTEMPTS} has its obstacle in view; change the scenario")
