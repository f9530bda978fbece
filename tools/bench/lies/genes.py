"""Unit numbers that define flights.

A flight is a row of numbers from 0 to 1 and the seed of its errors. Evolution changes the numbers, and ``decode.py``
converts them to parameters in physical units: one array for each name, with one entry for each flight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Params = dict[str, np.ndarray]

MIXES = ("points", "base", "boxes", "boxes_base", "outlines")
POINTS, BASE, BOXES, BOXES_BASE, OUTLINES = range(len(MIXES))

GENES = (
    "round", "kind", "size_a", "size_b", "size_h", "square", "turned", "speed", "rate", "images", "roof", "height",
    "flight_kind", "amplitude", "period", "phase", "climb", "crab", "side", "offset", "reach", "course", "pre_turn",
    "pre_turn_angle", "mid", "look", "mount_roll", "mount_jitter_yaw", "mount_jitter_pitch", "image_size", "aspect",
    "view_angle", "pixel_shape", "center", "lens", "lens_k1", "lens_k2", "lens_p1", "lens_p2", "lever", "lever_x",
    "lever_y", "lever_z", "heading_auto", "heading", "size_known", "cameras", "second_yaw", "second_share",
    "origin_n", "origin_e", "origin_d", "attitude_bias", "attitude_white", "attitude_drift", "height_bias",
    "velocity_bias", "position_walk", "position_white", "height_white", "ground", "ground_drawn", "slope",
    "slope_drawn", "hidden", "hidden_share", "hidden_always", "point_px",
    "point_share", "point_correlation", "box_px", "box_share", "correlation_s", "cut_noise", "typical",
    "top_is_highest", "sides_raw", "side_height", "top_seen", "sides_seen", "base_subset", "bottom_seen",
    "cut_reported",
    "model", "range_share", "disturbed", "missed", "missed_share", "every", "every_n", "runs", "run_s", "run_at",
    "two_runs", "run_at_2", "gaps", "gap_s", "gap_at", "partly", "partly_share", "reset", "reset_kind", "reset_n",
    "reset_e", "reset_d", "reset_at", "reset_again", "unknown", "unknown_at", "refused", "refused_at", "refused_kind",
    "jitter", "height_follows", "margin", "clearance", "plan_kind", "plan_climb", "plan_turn", "plan_hold", "since",
)  # fmt: skip
INDEX = {name: number for number, name in enumerate(GENES)}

STRAIGHT, SWAYING, WEAVING, CLIMBING, TURNING, ORBIT = range(6)  # kinds of flights
NO_RESET, HORIZONTAL, VERTICAL, BOTH = range(4)  # kinds of resets
DEFAULTS = {  # of goe.h
    "attitude_bias": 0.5, "attitude_white": 0.1, "height_bias": 0.5, "velocity_bias": 0.05, "position_walk": 0.05,
    "ground": 2.0, "slope": 0.01, "point_px": 0.5, "box_px": 1.0, "box_share": 0.07, "correlation_s": 1.2,
}  # fmt: skip


@dataclass
class Flights:
    """The numbers that define flights."""

    mix: npt.NDArray[np.int64]  # (F,)
    unit: Array  # (F, genes)
    seed: npt.NDArray[np.uint64]  # (F,) of their errors

    def __len__(self) -> int:
        return len(self.mix)

    def take(self, chosen: Sequence[int] | np.ndarray) -> Flights:
        return Flights(self.mix[chosen], self.unit[chosen], self.seed[chosen])


def draw(count: int, mixes: Sequence[int], rng: np.random.Generator) -> Flights:
    """Random flights, the same number of each mix."""
    mix = np.asarray(mixes, np.int64)[np.arange(count) % len(mixes)]
    return Flights(mix, rng.random((count, len(GENES))), rng.integers(0, 2**63, count).astype(np.uint64))
