"""The estimator's output. All lengths are meters, angles degrees; X points right, Z ahead, both level."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from ._goe import lib
from ._renamed import Renamed
from .status import Method, Model, Reason, Status


class Length(NamedTuple):
    """A length and its one sigma, m."""

    m: float
    sd_m: float


class Position(NamedTuple):
    """Position of the reference point: of a disc or prism the center, of a line or box the middle of the front edge."""

    x0: Length
    """From where the camera was at the track's first image, across."""
    z0: Length
    """... and along."""
    x: Length
    """From where the camera is at the latest image, across: negative is left."""
    z: Length
    """... and ahead."""
    residual: float
    """Window: root mean square residual of the fit, in its rows' own unit; filter: 0."""
    baseline_m: float
    """Window: spread of the flown baseline; filter: distance from where the track began."""


class Orientation(NamedTuple):
    """Orientation of a box or a line."""

    side_deg: float
    """The side edge (length) from Z, clockwise as viewed from above; over -90, up to 90."""
    side_sd_deg: float
    """Its one sigma."""
    side_raw_deg: float
    """Window: the same of the latest image alone; filter: ``side_deg``."""
    front_deg: float
    """The front edge (width) from Z."""
    length_axis: tuple[float, float]
    """Unit vector along the side edge, (X, Z)."""
    width_axis: tuple[float, float]
    """Unit vector along the front edge, (X, Z)."""
    length_axis_ne: tuple[float, float]
    """Unit vector along the side edge, (north, east)."""
    width_axis_ne: tuple[float, float]
    """Unit vector along the front edge, (north, east)."""


class Center(NamedTuple):
    """The middle of the base in the pose's north and east."""

    north: Length
    east: Length
    covariance_m2: float
    """Covariance of the two."""


class Velocity(NamedTuple):
    """Of an obstacle that moves and is followed, m/s."""

    north_m_s: float
    east_m_s: float
    north_sd_m_s: float
    """One sigma."""
    east_sd_m_s: float
    """One sigma."""


@dataclass(frozen=True)
class Estimate(Renamed):
    """The estimate after an image. A quantity that is not valid is None: "no position" does not mean "safe"."""

    status: Status
    """What became of the image."""
    method: Method | None
    """Behind this estimate; None: nothing is solved."""
    model: Model | None
    """The shape behind position and sizes; None: nothing is solved."""
    fresh: bool
    """Solved from the latest image; otherwise stale: the last good answer."""
    suspect: bool
    """Its sigmas may be too small: widen the margins, never drop a warning."""
    reason: Reason | None
    """Why; LATE also if it is not suspect."""
    images_used: int
    """Behind the answer."""
    age_s: float
    """Since the image of the last solution, s; 0 if fresh or none; at most 4000."""
    position: Position | None
    """Where the obstacle is."""
    width: Length | None
    """Disc: diameter; prism: across the first line of sight; line, box: the front edge."""
    length: Length | None
    """The side edge."""
    height: Length | None
    """Top above ground."""
    orientation: Orientation | None
    """Orientation."""
    center: Center | None
    """The middle of its base."""
    velocity: Velocity | None
    """If it moves and is followed."""
    trajectory_heading_deg: float
    """Of Z, clockwise from north, -180 to 180; from the track's first image on."""
    latency_s: float
    """What the poses are late by against the images, s; negative: early. It is taken off. 0: nothing is known."""
    latency_sd_s: float
    """Its one sigma, s."""
    nis: float
    """Normalized innovation squared of the latest image. Filter method."""
    nis_rows: int
    """Its expectation: the rows that made it; 0: none."""
    nis_ratio: float
    """Running mean of ``nis / nis_rows``: 1 is what the settings predict. Filter method."""


METHODS = {int(method): method for method in Method}
MODELS = {int(model): model for model in Model}
REASONS = {int(reason): reason for reason in Reason}
STATUSES = {int(status): status for status in Status}


def _orientation(c: Any) -> Orientation:
    axes = (c.length_axis, c.width_axis, c.length_axis_ne, c.width_axis_ne)
    pairs = (tuple(axis) for axis in axes)
    return Orientation(
        c.orientation_deg, c.sigma.orientation_deg, c.orientation_raw_deg, c.front_orientation_deg, *pairs
    )


def estimate_of(status: int, c: Any) -> Estimate:
    """Of a goe_estimate_t."""
    valid, sd = c.valid, c.sigma
    has = {name: bool(valid & bit) for name, bit in BITS.items()}
    position = Position(
        Length(c.x0_m, sd.x0_m), Length(c.z0_m, sd.z0_m), Length(c.x_m, sd.x_m), Length(c.z_m, sd.z_m),
        c.residual, c.baseline_m,
    ) if has["position"] else None  # fmt: skip
    center = Center(
        Length(c.center_north_m, sd.center_north_m), Length(c.center_east_m, sd.center_east_m), c.center_ne_m2
    ) if has["center"] else None  # fmt: skip
    velocity = Velocity(
        c.velocity_north_m_s, c.velocity_east_m_s, sd.velocity_north_m_s, sd.velocity_east_m_s
    ) if has["velocity"] else None  # fmt: skip
    return Estimate(
        STATUSES[status], METHODS.get(c.method), MODELS.get(c.model), c.fresh, c.suspect, REASONS.get(c.reason),
        c.images_used, c.age_s, position,
        Length(c.width_m, sd.width_m) if has["width"] else None,
        Length(c.length_m, sd.length_m) if has["length"] else None,
        Length(c.height_m, sd.height_m) if has["height"] else None,
        _orientation(c) if has["orientation"] else None,
        center, velocity, c.trajectory_heading_deg, c.latency_s, sd.latency_s, c.nis, c.nis_rows, c.nis_ratio,
    )  # fmt: skip


BITS = {
    "position": lib.GOE_HAS_POSITION, "length": lib.GOE_HAS_LENGTH, "height": lib.GOE_HAS_HEIGHT,
    "orientation": lib.GOE_HAS_ORIENTATION, "center": lib.GOE_HAS_CENTER, "width": lib.GOE_HAS_WIDTH,
    "velocity": lib.GOE_HAS_VELOCITY,
}  # fmt: skip
