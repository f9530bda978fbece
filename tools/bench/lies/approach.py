"""Exact closest approach of a straight flight to an upright solid, in float64. Flat arrays, broadcast."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .genes import Array

TINY = 1e-12


@dataclass
class Approach:
    time_s: Array  # until the first minimum of the distance, or the entry into the outline
    leaves_s: Array  # until the exit; time_s without an entry
    dcpa_m: Array  # 0 if the outline is entered


def _to_disc(start: Array, velocity: Array, radius: Array) -> Approach:
    """``start``: (..., 2) from the center."""
    speed2 = np.maximum(np.sum(velocity**2, -1), TINY)
    along = -np.sum(start * velocity, -1) / speed2
    time = np.maximum(along, 0.0)
    nearest = np.hypot(*np.moveaxis(start + velocity * time[..., None], -1, 0))
    aside2 = np.sum((start + velocity * along[..., None]) ** 2, -1)
    half = np.sqrt(np.maximum(radius**2 - aside2, 0.0) / speed2)
    enters = nearest < radius
    return Approach(
        np.where(enters, np.maximum(along - half, 0.0), time), np.where(enters, along + half, time),
        np.maximum(nearest - radius, 0.0),
    )  # fmt: skip


def _inside_times(start: Array, velocity: Array, half: Array) -> tuple[Array, Array]:
    """Times at which a line enters and leaves two pairs of parallel sides; from > to: never inside."""
    still = np.abs(velocity) < TINY
    safe = np.where(still, 1.0, velocity)
    one, other = (-half - start) / safe, (half - start) / safe
    outside = np.abs(start) > half
    low = np.where(still, np.where(outside, np.inf, -np.inf), np.minimum(one, other))
    high = np.where(still, np.where(outside, -np.inf, np.inf), np.maximum(one, other))
    return low.max(-1), high.min(-1)


def _to_cuboid(start: Array, velocity: Array, half: Array) -> Approach:
    """``start`` and ``velocity`` (..., 2) along the cuboid's axes, from its center."""
    enter, leave = _inside_times(start, velocity, half)
    enters = (enter < leave) & (leave > 0.0)
    times, distances = (
        [np.zeros(start.shape[:-1])],
        [np.hypot(*np.moveaxis(np.maximum(np.abs(start) - half, 0.0), -1, 0))],
    )
    speed2 = np.maximum(np.sum(velocity**2, -1), TINY)
    for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        to = half * np.array(signs) - start
        time = np.maximum(np.sum(to * velocity, -1) / speed2, 0.0)
        times.append(time)
        distances.append(np.hypot(*np.moveaxis(to - velocity * time[..., None], -1, 0)))
    distance, time = np.stack(distances), np.stack(times)
    least = distance.min(0)
    first = np.where(distance <= least + 1e-9, time, np.inf).min(0)
    return Approach(
        np.where(enters, np.maximum(enter, 0.0), first), np.where(enters, leave, first), np.where(enters, 0.0, least)
    )


def closest(is_round: np.ndarray, axes: Array, half: Array, start: Array, velocity: Array) -> Approach:
    """``start``: (..., 2) of the aircraft, from the solid's center, NED; the rows of ``axes`` (..., 2, 2) are its
    axes."""
    own = np.einsum("...ij,...j->...i", axes, start)
    moving = np.einsum("...ij,...j->...i", axes, velocity)
    disc, cuboid = _to_disc(start, velocity, half[..., 0]), _to_cuboid(own, moving, half)
    return Approach(
        *(np.where(is_round, getattr(disc, n), getattr(cuboid, n)) for n in ("time_s", "leaves_s", "dcpa_m"))
    )
