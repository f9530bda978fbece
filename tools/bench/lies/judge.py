"""Errors of answers over their sigmas, against the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import answers, approach, shapes
from .answers import RULES, Answers
from .genes import Array
from .world import World, relative_to

POSITION, LENGTH, HEIGHT, ORIENTATION, CENTER, WIDTH = 0x01, 0x02, 0x04, 0x08, 0x10, 0x20  # GOE_HAS_...
DISC, LINE, BOX, PRISM = 2, 3, 4, 5
MODELS = {0: "none", 2: "disc", 3: "line", 4: "box", 5: "prism"}
WINDOW, FILTER = 1, 2
QUANTITIES = ("x0", "z0", "x", "z", "width", "length", "height", "orientation", "north", "east")
FLIGHT_QUANTITIES = ("time", "miss", "clearance")
REFUSED_STATUS = (-13, -10)
SIGMA_LEAST = 1e-4  # of any quantity: float rounding
TOLERANCE_M = 0.5  # least true violation of margin and clearance
HEADING_STEP_DEG = 0.01  # of T: more than float rounding
LATERAL_SLACK = 0.02  # of a width defined by the visible part


@dataclass
class Judged:
    """Of N images; NaN if there is nothing to judge."""

    ratio: Array  # (N, quantities) error over sigma
    error: Array  # (N, quantities)
    hazard_ratio: Array  # (N, RULES, flight quantities)
    violation: Array  # (N, RULES) NaN: no answer
    violated: np.ndarray  # (N, RULES) true violation beyond the tolerance
    met: Array  # (N, RULES, 2) true miss and clearance, m


def _wrapped(degrees: Array, period: float) -> Array:
    return (degrees + 0.5 * period) % period - 0.5 * period


def _extent(world: World, camera: Array) -> Array:
    """(N,): extent of the outline across the line of sight from ``camera`` (N, 2) to its middle."""
    own = world.solid.take(world.flight)
    to = own.center - camera
    across = np.stack([-to[:, 1], to[:, 0]], 1) / np.hypot(*to.T)[:, None]
    spans = np.abs(np.einsum("nij,nj->ni", own.axes(), across)) * own.half
    return np.where(own.round, 2.0 * own.half[:, 0], 2.0 * spans.sum(1))


def track_begins(world: World) -> np.ndarray:
    """(N,): first image of the current track: the flight's first, or that of an unknown reset; if that image was
    refused, the next one."""
    begin = np.zeros(len(world.flight), int)
    begin[world.start[:-1]] = world.start[:-1]
    taken = world.unknown & ~world.refused
    late = np.flatnonzero(world.unknown & world.refused)
    after = np.minimum(late + 1, len(begin) - 1)
    taken[after[world.flight[after] == world.flight[late]]] = True
    begin[taken] = np.flatnonzero(taken)
    return np.maximum.accumulate(begin)


def first_seen(world: World, begin: np.ndarray) -> np.ndarray:
    """(N,): first image of the current track with a detection; the latest image if there is none yet."""
    number = np.arange(len(begin))
    at = np.where(world.detected & ~world.refused, number, len(begin))
    key = np.unique(begin, return_inverse=True)[1]
    least = np.full(key.max() + 1, len(begin))
    np.minimum.at(least, key, at)
    return np.minimum(least[key], number)


def latest_taken(world: World, status: np.ndarray) -> np.ndarray:
    """(N,): reference image of x, z and the hazards: this one, or the last before it that was not refused."""
    number = np.arange(len(status))
    refused = (status >= REFUSED_STATUS[0]) & (status <= REFUSED_STATUS[1])
    at = np.maximum.accumulate(np.where(refused, 0, number))
    return np.maximum(at, world.start[world.flight])


class _Truth:
    """The correct values of each answer, for its model and its naming of the sides."""

    def __init__(self, world: World, found: Answers) -> None:
        e = found.estimates
        self.world, self.e = world, e
        self.at = latest_taken(world, found.status)
        self.own = world.solid.take(world.flight)
        self.model, self.valid = e["model"], e["valid"]
        z_axis = np.radians(e["trajectory_heading_deg"].astype(float))
        self.right = np.stack([-np.sin(z_axis), np.cos(z_axis)], 1)
        self.ahead = np.stack([np.cos(z_axis), np.sin(z_axis)], 1)
        self._name_sides(z_axis)
        self.is_box = np.isin(self.model, (LINE, BOX)) & ~self.own.round

    def _name_sides(self, z_axis: Array) -> None:
        """Length is along the side nearest to the reported orientation."""
        reported = z_axis + np.radians(self.e["orientation_deg"].astype(float))
        off = _wrapped(np.degrees(reported - self.own.heading), 180.0)
        swapped = np.abs(off) > 45.0
        self.turned = np.where(swapped, _wrapped(off - 90.0, 180.0), off)
        sides = 2.0 * self.own.half
        self.length = np.where(swapped, sides[:, 1], sides[:, 0])
        self.width = np.where(swapped, sides[:, 0], sides[:, 1])
        true = reported - np.radians(self.turned)
        self.side_axis = np.stack([np.cos(true), np.sin(true)], 1)

    def references(self) -> Array:
        """(N, candidates, 2): middle of the front edge; otherwise the center. Without orientation the middle of any
        side is accepted."""
        center = self.own.center
        front = center - 0.5 * self.length[:, None] * self.side_axis
        oriented = (self.valid & ORIENTATION) != 0
        steep = np.abs(self.e["orientation_deg"]) > 80.0
        axes = self.own.axes()
        others = [center + sign * self.own.half[:, i : i + 1] * axes[:, i] for i in (0, 1) for sign in (-1.0, 1.0)]
        back = np.where(steep[:, None], center + 0.5 * self.length[:, None] * self.side_axis, front)
        known = np.stack([front, back, front, back], 1)
        any_side = np.where(oriented[:, None, None], known, np.stack(others, 1))
        return np.where(self.is_box[:, None, None], any_side, center[:, None])

    def in_t(self, level: Array) -> Array:
        """(N, ..., 2): X and Z."""
        extra = (1,) * (level.ndim - 2)
        right, ahead = (axis.reshape(len(axis), *extra, 2) for axis in (self.right, self.ahead))
        return np.stack([(level * right).sum(-1), (level * ahead).sum(-1)], -1)


def _nearest(reported: Array, candidates: Array, sigma: Array) -> Array:
    """(N, 2): errors against the candidate (N, C, 2) that is the fewest sigmas away."""
    errors = reported[:, None] - candidates
    with np.errstate(invalid="ignore", divide="ignore"):
        size = np.sum((errors / np.maximum(sigma, SIGMA_LEAST)[:, None]) ** 2, -1)
    return errors[np.arange(len(reported)), size.argmin(1)]


def _pair(e: np.ndarray, one: str, other: str) -> Array:
    return np.stack([e[one], e[other]], 1).astype(float)


def _origin(world: World, e: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(N,): origin image of x0 and z0: the track's first one with a feature; with ``heading_auto`` a later one in which
    T's heading changes, since the track starts again there."""
    number = np.arange(len(seen))
    before = np.maximum(number - 1, 0)
    heading = e["trajectory_heading_deg"].astype(float)
    follows = np.isnan(world.heading_deg)[world.flight]
    turned = follows & (np.abs(_wrapped(heading - heading[before], 360.0)) > HEADING_STEP_DEG)
    return np.maximum(seen, np.maximum.accumulate(np.where(turned, number, 0)))


def _positions(truth: _Truth) -> tuple[Array, Array]:
    """(N, 4) errors of x0, z0, x, z, and (N, 2) of north, east."""
    world, e, spots = truth.world, truth.e, truth.references()
    sigma = e["sigma"]
    origin = world.camera[_origin(world, e, first_seen(world, track_begins(world))), None, :2]
    started = truth.in_t(spots - origin)
    now = truth.in_t(spots - world.camera[truth.at, None, :2])
    first = _nearest(_pair(e, "x0_m", "z0_m"), started, _pair(sigma, "x0_m", "z0_m"))
    latest = _nearest(_pair(e, "x_m", "z_m"), now, _pair(sigma, "x_m", "z_m"))
    center = truth.own.center + (world.reported - world.vehicle)[truth.at, :2]
    return np.concatenate([first, latest], 1), _pair(e, "center_north_m", "center_east_m") - center


def _width(truth: _Truth) -> Array:
    """(N,): errors. For a cuboid that is not reported as a box: the extent of its visible part, across the line of
    sight, of the first image or of this one, or along X of T."""
    world, e = truth.world, truth.e
    reported = e["width_m"].astype(float)
    begin = track_begins(world)
    extents = np.stack([_extent(world, world.camera[at, :2]) for at in (begin, first_seen(world, begin))], 1)
    posts = truth.in_t(shapes.sides(relative_to(world.solid, world.flight, world.camera)))
    extents = np.column_stack([extents, _extent(world, world.camera[:, :2]), np.abs(posts[:, 1, 0] - posts[:, 0, 0])])
    low, high = extents.min(1) * (1.0 - LATERAL_SLACK), extents.max(1) * (1.0 + LATERAL_SLACK)
    between = np.maximum(reported - high, 0.0) + np.minimum(reported - low, 0.0)
    box = reported - truth.width
    either = np.minimum(np.abs(reported - truth.width), np.abs(reported - truth.length)) * np.sign(box)
    box = np.where((truth.valid & ORIENTATION) != 0, box, either)
    return np.where(truth.own.round, reported - truth.width, np.where(truth.is_box, box, between))


def _quantities(world: World, found: Answers) -> tuple[Array, Array]:
    truth, e = _Truth(world, found), found.estimates
    position, center = _positions(truth)
    box = truth.is_box
    oriented = ((truth.valid & ORIENTATION) != 0) & box
    length = np.where(oriented, e["length_m"] - truth.length, np.nan)
    height = e["height_m"] - world.height_m[world.flight]
    error = np.column_stack([position, _width(truth), length, height, np.where(box, truth.turned, np.nan), center])
    error[truth.own.round & np.isin(truth.model, (LINE, BOX)), :6] = np.nan  # a cylinder has no front edge
    bits = np.array([POSITION] * 4 + [WIDTH, LENGTH, HEIGHT, ORIENTATION, CENTER, CENTER])
    error[(truth.valid[:, None] & bits) == 0] = np.nan
    names = (
        "x0_m",
        "z0_m",
        "x_m",
        "z_m",
        "width_m",
        "length_m",
        "height_m",
        "orientation_deg",
        "center_north_m",
        "center_east_m",
    )
    sigma = np.stack([e["sigma"][name] for name in names], 1).astype(float)
    return error / np.maximum(sigma, SIGMA_LEAST), error


@dataclass
class Met:
    """The true encounter of each plan: (N, RULES)."""

    time_s: Array
    dcpa_m: Array
    clearance_m: Array
    at_reported_m: Array  # clearance at the reported time


def meet(world: World, at: np.ndarray, reported_s: Array) -> Met:
    """From the camera's place in the images ``at``."""
    numbers = answers.rule_numbers(world.p)[world.flight]
    since, velocity = numbers[..., 2], np.repeat(world.velocity[:, None], RULES, 1)
    own = world.solid.take(world.flight)
    start = world.camera[at, None] + velocity * since[..., None]
    near = approach.closest(
        own.round[:, None], np.repeat(own.axes()[:, None], RULES, 1), np.repeat(own.half[:, None], RULES, 1),
        start[..., :2] - own.center[:, None], velocity[..., :2],
    )  # fmt: skip
    over = -start[..., 2] - world.height_m[world.flight][:, None]
    crosses = near.dcpa_m <= 0.0
    when = np.where(crosses & (velocity[..., 2] > 0.0), near.leaves_s, near.time_s)
    return Met(near.time_s, near.dcpa_m, over - velocity[..., 2] * when, over - velocity[..., 2] * reported_s)


def _hazards(world: World, found: Answers, tolerance_m: float) -> tuple[Array, Array, np.ndarray, Array]:
    h, there = found.hazards, found.hazard_status == 0
    reported_s = h["tcpa_s"].astype(float)
    truth, numbers = (
        meet(world, latest_taken(world, found.status), reported_s),
        answers.rule_numbers(world.p)[world.flight],
    )
    both_enter = (truth.dcpa_m <= 0.0) == (h["dcpa_m"] <= 0.0)
    time = np.where((h["tcpa_sd_s"] > 0.0) & (truth.time_s > 0.0) & both_enter, reported_s - truth.time_s, np.nan)
    clearance = np.where(h["has_clearance"], h["clearance_m"] - truth.clearance_m, np.nan)
    errors = np.stack([time, h["dcpa_m"] - truth.dcpa_m, clearance], -1)
    errors[~there] = np.nan
    sigma = np.stack([h["tcpa_sd_s"], h["dcpa_sd_m"], h["clearance_sd_m"]], -1).astype(float)
    margin, least = numbers[..., 0], numbers[..., 1]
    high = np.maximum(truth.clearance_m, truth.at_reported_m)
    violated = (truth.dcpa_m < margin - tolerance_m) & (high < least - tolerance_m)
    met = np.stack([truth.dcpa_m, truth.clearance_m], -1)
    return errors / np.maximum(sigma, SIGMA_LEAST), np.where(there, h["conflict_probability"], np.nan), violated, met


def judge(world: World, found: Answers) -> Judged:
    ratio, error = _quantities(world, found)
    hazard_ratio, violation, violated, met = _hazards(world, found, TOLERANCE_M)
    return Judged(ratio, error, hazard_ratio, violation, violated, met)
