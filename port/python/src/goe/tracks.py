"""Whole tracks: numpy arrays in, numpy arrays out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._goe import ffi
from ._layout import ESTIMATE, HAZARD, IMAGE
from ._renamed import Renamed
from .estimate import BITS, Estimate, estimate_of
from .hazard import Hazard, hazard_of
from .image import POINTS, SIDE_BITS, SIDES, Kind, kind_numbers

Array = npt.NDArray[Any]

QUANTITIES = ("x0_m", "z0_m", "orientation_deg", "width_m", "length_m", "height_m")
"""Of ``Track.values``, ``Track.sigma`` and every covariance, in this order."""
QUANTITY_BITS = np.array([BITS[name] for name in ("position", "position", "orientation", "width", "length", "height")])


class _Places:
    """Numbers of a goe_image_t that lie at even distances, as one array."""

    def __init__(self, dtype: type[np.generic], first: int, steps: Sequence[int], shape: tuple[int, ...]) -> None:
        self.dtype, self.first, self.steps, self.shape = dtype, first, tuple(steps), shape

    def of(self, c: Array) -> Array:
        """(K, ...): a view."""
        return np.ndarray(c.shape + self.shape, self.dtype, c, self.first, c.strides + self.steps)


def _point_offsets(field: str) -> list[int]:
    assert IMAGE.fields is not None
    inner = IMAGE["left"].fields
    assert inner is not None
    return [IMAGE.fields[name][1] + inner[field][1] for name in POINTS]


def _step(offsets: Sequence[int]) -> int:
    steps = set(np.diff(offsets).tolist())
    if len(steps) != 1:
        raise ImportError("goe_image_t: its points or sides do not lie at even distances")
    return int(steps.pop())


def _side_offsets() -> list[int]:
    assert IMAGE.fields is not None
    inner = IMAGE["box"].fields
    assert inner is not None
    return [IMAGE.fields["box"][1] + inner[f"{name}_px"][1] for name in SIDES]


_U, _V, _VISIBLE, _SIDES = _point_offsets("u_px"), _point_offsets("v_px"), _point_offsets("visible"), _side_offsets()
POINT_PLACES = _Places(np.float32, _U[0], (_step(_U), _step([_U[0], _V[0]])), (len(POINTS), 2))
POINT_VISIBLE_PLACES = _Places(np.bool_, _VISIBLE[0], (_step(_VISIBLE),), (len(POINTS),))
SIDE_PLACES = _Places(np.float32, _SIDES[0], (_step(_SIDES),), (len(SIDES),))


@dataclass
class Images(Renamed):
    """K images of one obstacle, as columns; meaning, units and frames as in ``Image`` and ``Pose``.

    Boxes or points, or both; NaN in them means not visible. Anything that numpy can turn into an array of the shape.
    """

    time_us: Any
    """(K,) int64, strictly increasing."""
    position_ned_m: Any
    """(K, 3)"""
    attitude: Any
    """(K, 4) w, x, y, z; body to NED."""
    height_m: Any
    """(K,) of the camera above the ground at the obstacle."""
    box_px: Any = None
    """(K, 4) left, top, right, bottom; NaN: that side is not visible. None: no boxes."""
    points_px: Any = None
    """(K, 6, 2) u and v of ``POINTS``; NaN: not visible. None: no points."""
    points_visible: Any = None
    """(K, 6) bool, where a NaN must not mean "not visible": the library refuses a NaN in a visible feature."""
    reset_count: Any = None
    """(K,) of the autopilot's filter. None: no resets."""
    reset_delta_ned_m: Any = None
    """(K, 3) by what it jumped; NaN: not known. None: of no reset."""
    noise: Any = None
    """(K, 3) this image's own sigmas: attitude, degrees; height, m; pixels, px; 0: as in the settings."""
    kind: Any = None
    """What the detector's class says: a ``Kind``, such as ``KINDS["car"]``, of all images; or (K, 5) width, its sigma,
    height, its sigma, m; ``KindShape``; 0: not known."""
    camera: Any = None
    """(K,) number of the camera that took it. None: the first."""
    velocity_ned_m_s: Any = None
    """(K, 3) planned, for the decisions; None: no decisions."""

    def __len__(self) -> int:
        return len(self.time_us)

    def to_c(self) -> Array:
        """(K,) of goe_image_t: what ``Estimator.run`` takes as well. ValueError names the column of a wrong shape."""
        c = np.zeros(len(self), IMAGE)
        with np.errstate(over="ignore"):  # what single precision cannot hold is infinite, and refused by the library
            self._fill(c, len(self))
        return c

    def _fill(self, c: Array, count: int) -> None:
        pose, noise = c["pose"], c["noise"]
        for place, name in ((pose, "time_us"), (pose, "position_ned_m"), (pose, "attitude"), (pose, "height_m")):
            _put(place, name, getattr(self, name), name)
        if self.points_px is not None:
            self._put_points(c, count)
        if self.box_px is not None:
            self._put_boxes(c, count)
        if self.reset_count is not None:
            _put(pose, "reset_count", self.reset_count, "reset_count")
        if self.reset_delta_ned_m is not None:
            self._put_resets(pose, count)
        if self.noise is not None:
            columns = _shaped(self.noise, (count, 3), "noise").T
            noise["attitude_sd_deg"], noise["height_sd_m"], noise["pixel_sd_px"] = columns
        if self.kind is not None:
            one = isinstance(self.kind, (Kind, str))
            columns = kind_numbers(self.kind) if one else _kind_columns(self.kind, count)
            for name, column in zip(("width_m", "width_sd_m", "height_m", "height_sd_m", "shape"), columns):
                c["kind"][name] = column
        if self.camera is not None:
            _put(c, "camera", self.camera, "camera")

    def _put_points(self, c: Array, count: int) -> None:
        pixels = _shaped(self.points_px, (count, len(POINTS), 2), "points_px")
        if self.points_visible is None:
            seen = np.isfinite(pixels).all(2)
        else:
            seen = _shaped(self.points_visible, (count, len(POINTS)), "points_visible").astype(bool)
        POINT_PLACES.of(c)[...] = np.where(seen[..., None], pixels, 0.0)
        POINT_VISIBLE_PLACES.of(c)[...] = seen

    def _put_boxes(self, c: Array, count: int) -> None:
        sides = _shaped(self.box_px, (count, len(SIDES)), "box_px")
        seen = np.isfinite(sides)
        SIDE_PLACES.of(c)[...] = np.where(seen, sides, 0.0)
        c["box"]["sides"] = seen @ np.array(SIDE_BITS, np.uint8)

    def _put_resets(self, pose: Array, count: int) -> None:
        delta = _shaped(self.reset_delta_ned_m, (count, 3), "reset_delta_ned_m")
        known = np.isfinite(delta).all(1)
        pose["reset_delta_known"] = known
        pose["reset_delta_ned_m"] = np.where(known[:, None], delta, 0.0)


def _shaped(values: Any, shape: tuple[int, ...], name: str) -> Array:
    array = np.asarray(values)
    if array.shape != shape:
        raise ValueError(f"{name}: shape {array.shape}, not {shape}")
    return array


def _kind_columns(values: Any, count: int) -> Array:
    columns = _shaped(values, (count, 5), "kind").T
    shapes = columns[4]
    is_shape = (shapes >= 0) & (shapes <= 255) & (shapes == np.floor(shapes))
    if not is_shape.all():  # a cast would make another shape of it
        raise ValueError("kind: a shape that is not a whole number within 0 to 255")
    return columns


def _put(place: Array, field: str, values: Any, name: str) -> None:
    to = place[field]
    array = _shaped(values, to.shape, name)
    if to.dtype.kind in "iu" and array.dtype.kind not in "iub":
        raise ValueError(f"{name}: {array.dtype}, not whole numbers")
    if to.dtype.kind != "f" and array.size and not np.can_cast(array.dtype, to.dtype):
        low, high = np.iinfo(to.dtype).min, np.iinfo(to.dtype).max
        if array.min() < low or array.max() > high:
            raise ValueError(f"{name}: not within {low} to {high}")
    to[...] = array


@dataclass
class Track:
    """The estimates after each of K images.

    ``track[k]`` is the ``Estimate`` after image k; columns are read from ``estimates``: ``track.estimates["z_m"]``,
    ``track.estimates["sigma"]["z_m"]``. Fields are those of goe_estimate_t in goe.h, where ``valid`` marks the valid
    ones; ``values`` and ``sigma`` have NaN for the others.
    """

    status: Array
    """(K,) int32, of ``Status``."""
    estimates: Array
    """(K,) of goe_estimate_t: float32, int32, bool."""
    covariance: Array | None
    """(K, 6, 6) float32 of ``QUANTITIES``, m and degrees; 0 where not valid. None: not asked for."""
    decision: Array
    """(K, R) int32 for R rules, of ``Decision``."""
    hazard_status: Array
    """(K, R) int32: 0 where there is a hazard, otherwise why there is none."""
    hazards: Array
    """(K, R) of goe_hazard_t, by margins that have grown as ``Rule`` says."""

    def __len__(self) -> int:
        return len(self.status)

    def __getitem__(self, k: int) -> Estimate:
        index = range(len(self))[k]
        row = np.ascontiguousarray(self.estimates[index : index + 1])
        return estimate_of(int(self.status[index]), ffi.from_buffer("goe_estimate_t[]", row)[0])

    def __iter__(self) -> Iterator[Estimate]:
        return (self[k] for k in range(len(self)))

    @property
    def valid(self) -> Array:
        """(K, 6) bool: which of ``QUANTITIES`` hold an answer."""
        told: Array = (self.estimates["valid"][:, None] & QUANTITY_BITS) != 0
        return told

    @property
    def values(self) -> Array:
        """(K, 6) float32 of ``QUANTITIES``; NaN where not valid."""
        columns = np.stack([self.estimates[name] for name in QUANTITIES], 1)
        return np.where(self.valid, columns, np.float32(np.nan))

    @property
    def sigma(self) -> Array:
        """(K, 6) float32: one sigma of each; NaN where not valid."""
        columns = np.stack([self.estimates["sigma"][name] for name in QUANTITIES], 1)
        return np.where(self.valid, columns, np.float32(np.nan))

    def hazard(self, k: int, rule: int = 0) -> Hazard | None:
        """After image k, by a rule; None: there is no position, or the intent was refused (``hazard_status``)."""
        row = np.ascontiguousarray(self.hazards[k, rule]).reshape(1)
        return hazard_of(ffi.from_buffer("goe_hazard_t[]", row)[0]) if self.hazard_status[k, rule] == 0 else None


ImagesOrC = Union[Images, Array]


def empty_track(count: int, rules: int, covariance: bool) -> Track:
    """Room for the answers, all zero."""
    return Track(
        np.zeros(count, np.int32), np.zeros(count, ESTIMATE),
        np.zeros((count, len(QUANTITIES), len(QUANTITIES)), np.float32) if covariance else None,
        np.zeros((count, rules), np.int32), np.zeros((count, rules), np.int32), np.zeros((count, rules), HAZARD),
    )  # fmt: skip


def images_to_c(images: ImagesOrC) -> Array:
    """(K,) of goe_image_t, in one piece."""
    if isinstance(images, Images):
        return images.to_c()
    if images.dtype != IMAGE or images.ndim != 1:
        raise ValueError(f"images: {images.dtype} of shape {images.shape}, not (K,) of goe.IMAGE")
    return np.ascontiguousarray(images)


def velocities(images: ImagesOrC, given: Any, rules: Sequence[Any]) -> Array:
    """(K, 3) planned; nothing without rules."""
    if given is None and isinstance(images, Images):
        given = images.velocity_ned_m_s
    if not rules:
        return np.zeros((0, 3), np.float32)
    if given is None:
        raise ValueError("velocity_ned_m_s: not given, but there are rules")
    return np.ascontiguousarray(_shaped(given, (len(images), 3), "velocity_ned_m_s"), np.float32)
