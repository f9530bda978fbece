"""What the estimator is given with each image."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ._goe import lib
from ._kinds import CLASSES, SIGMA_OF_SPAN
from ._renamed import Renamed
from ._table import shortest

POINTS = ("left", "right", "top", "base_left", "base_near", "base_right")
"""Points of an image, in the order of whole tracks."""
SIDES = ("left", "top", "right", "bottom")
"""Sides of a box, in the order of whole tracks."""
SIDE_BITS = (lib.GOE_SIDE_LEFT, lib.GOE_SIDE_TOP, lib.GOE_SIDE_RIGHT, lib.GOE_SIDE_BOTTOM)
TIME_UNKNOWN = -(2**63)
"""A pose's time that is not known: the image is refused."""


def vector(values: Sequence[float], count: int, name: str) -> tuple[float, ...]:
    """Exactly so many numbers; C would take fewer for zeros."""
    numbers = tuple(values)
    if len(numbers) != count:
        raise ValueError(f"{name}: {len(numbers)} numbers, not {count}")
    return numbers


class Pixel(NamedTuple):
    """A point of the raw image, px; each within 1e5."""

    u_px: float
    """From the left."""
    v_px: float
    """From the top."""


class BoundingBox(NamedTuple):
    """A detector's upright box in the raw image, px; each within 1e5. None: that side is cut, hidden or unreliable.

    Feed raw detections: a tracker's smoothed boxes lag, which no sigma knows of.
    """

    left_px: float | None = None
    top_px: float | None = None
    right_px: float | None = None
    """Right of the left one."""
    bottom_px: float | None = None
    """Below the top one."""


@dataclass
class Pose:
    """Where the aircraft was at the time of exposure, not when the image arrived."""

    time_us: int = 0
    """Any origin, microseconds; strictly increasing."""
    position_ned_m: Sequence[float] = (0.0, 0.0, 0.0)
    """The vehicle's reference point in north, east, down, m; each within 1e6."""
    height_m: float = 0.0
    """Of the camera itself above the ground at the obstacle, m; within 1e5. Exactly 0 with a box: not set
    (``Status.NO_HEIGHT``)."""
    attitude: Sequence[float] = (1.0, 0.0, 0.0, 0.0)
    """Quaternion w, x, y, z that turns body (forward, right, down) into north, east, down; refused if its norm is off 1
    by over 1 %."""
    reset_count: int = 0
    """Counter of the resets of the autopilot's filter, any start; only its lowest 8 bits are compared."""
    reset_delta_ned_m: Sequence[float] | None = None
    """By what the position jumped with them, new minus old, summed over all resets since the last image that was taken,
    m. None: not known; then a change of ``reset_count`` starts a new track."""


@dataclass
class ImageNoise(Renamed):
    """This image's own errors, one sigma each, instead of those of the settings; None: as there. Filter method."""

    attitude_sd_deg: float | None = None
    """Instead of ``Navigation.attitude_white_sd_deg``, degrees; up to 30. A late pose belongs here: 20 ms at 24 degrees
    a second are 0.5 degrees."""
    height_sd_m: float | None = None
    """Instead of ``Navigation.height_bias_sd_m``, m; up to 1e3."""
    pixel_sd_px: float | None = None
    """Instead of the detector's ``point_noise_px`` and ``box_noise_px``, px; up to 100."""


class KindShape(IntEnum):
    """What the detector's class says of the obstacle's shape."""

    UNKNOWN = 0
    """As the settings have it."""
    ROUND = 1
    """An upright cylinder: as with the setting ``Model.DISC``."""
    OTHER = 2
    """None, also with that setting."""

    def __str__(self) -> str:
        return self.name.lower()


@dataclass
class Kind:
    """What the detector's class says of the obstacle, for the filter method; None: unknown. A class that the images
    contradict is not used any more, and the estimate's reason is ``Reason.SHAPE``."""

    width_m: float | None = None
    """Width of the silhouette, from any side, m; up to 1e3."""
    width_sd_m: float = 0.0
    """One sigma of it, m; at least 1 % of the width."""
    height_m: float | None = None
    """Height, m; up to 1e3."""
    height_sd_m: float = 0.0
    """One sigma of it, m; at least 1 % of the height."""
    shape: KindShape = KindShape.UNKNOWN
    """Whether it is round."""


def _size(low_m: float, high_m: float) -> tuple[float | None, float]:
    """The middle and one sigma of a uniform distribution, in single precision as the companion computes them."""
    low, high = np.float32(low_m), np.float32(high_m)
    size_m = shortest(np.float32(0.5) * (low + high))
    return size_m or None, shortest(np.float32(SIGMA_OF_SPAN) * (high - low))


KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        name: Kind(*_size(*width_m), *_size(*height_m), KindShape[shape])
        for name, (width_m, height_m, shape) in CLASSES.items()
    }
)
"""Size and shape of usual classes, by name, as the companion has them: ``KINDS["car"]``. Of any other class nothing is
known: ``KINDS.get(name, Kind())``."""


@dataclass
class Image:
    """One image of one obstacle: a box, or points, or both. Any subset may be visible; none: pass it anyway."""

    pose: Pose = field(default_factory=Pose)
    """Where the aircraft was."""
    left: Pixel | None = None
    """Leftmost point of the silhouette."""
    right: Pixel | None = None
    """Rightmost point of the silhouette."""
    top: Pixel | None = None
    """Point of the roof's edge over the nearest base corner; of a disc the nearest point of its upper rim."""
    base_left: Pixel | None = None
    """Corner of the base on the ground, in image order."""
    base_near: Pixel | None = None
    """The one between two visible faces; not visible with a single face."""
    base_right: Pixel | None = None
    """The last in image order."""
    bounding_box: BoundingBox | None = None
    """What detectors give. It replaces left, right and top, which are not read then."""
    noise: ImageNoise = field(default_factory=ImageNoise)
    """This image's own errors."""
    kind: Kind = field(default_factory=Kind)
    """What the detector's class says of it."""
    camera: int = 0
    """Number of the camera that took it."""


def fill_points(c: Any, points: Any) -> None:
    """``points`` has the attributes of POINTS."""
    for name in POINTS:
        pixel, place = getattr(points, name), getattr(c, name)
        place.visible = pixel is not None
        place.u_px, place.v_px = (0.0, 0.0) if pixel is None else pixel


def fill_box(c: Any, box: BoundingBox | None) -> None:
    sides = box or BoundingBox()
    c.left_px, c.top_px, c.right_px, c.bottom_px = (0.0 if side is None else side for side in sides)
    c.sides = sum(bit for bit, side in zip(SIDE_BITS, sides) if side is not None)


def kind_numbers(kind: Kind) -> tuple[float, float, float, float, int]:
    """Width, its sigma, height, its sigma, shape; 0: unknown. TypeError: it is no ``Kind``."""
    if not isinstance(kind, Kind):
        is_name = isinstance(kind, str) and kind.lower() in CLASSES
        call = f"goe.KINDS[{kind.lower()!r}]" if is_name else "goe.Kind(width_m=..., width_sd_m=...)"
        raise TypeError(f"kind = {kind!r}: not a goe.Kind; use {call}")
    return kind.width_m or 0.0, kind.width_sd_m, kind.height_m or 0.0, kind.height_sd_m, int(kind.shape)


def fill_kind(c: Any, kind: Kind) -> None:
    c.width_m, c.width_sd_m, c.height_m, c.height_sd_m, c.shape = kind_numbers(kind)


def fill_image(c: Any, image: Image) -> None:
    """Writes all of a goe_image_t."""
    pose, to = image.pose, c.pose
    to.time_us = pose.time_us
    to.position_ned_m = vector(pose.position_ned_m, 3, "position_ned_m")
    to.height_m = pose.height_m
    to.attitude = vector(pose.attitude, 4, "attitude")
    to.reset_count = pose.reset_count & 0xFF
    to.reset_delta_known = pose.reset_delta_ned_m is not None
    delta = (0.0, 0.0, 0.0) if pose.reset_delta_ned_m is None else pose.reset_delta_ned_m
    to.reset_delta_ned_m = vector(delta, 3, "reset_delta_ned_m")
    fill_points(c, image)
    fill_box(c.box, image.bounding_box)
    c.noise.attitude_sd_deg = image.noise.attitude_sd_deg or 0.0
    c.noise.height_sd_m = image.noise.height_sd_m or 0.0
    c.noise.pixel_sd_px = image.noise.pixel_sd_px or 0.0
    fill_kind(c.kind, image.kind)
    c.camera = image.camera
