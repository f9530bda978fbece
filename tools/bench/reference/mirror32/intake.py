"""What an image must be to be taken at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .single import Decisions, F, magnitude

POSITION_MAX_M, HEIGHT_MAX_M, PIXEL_MAX_PX, ATTITUDE_MAX = F(1.0e6), F(1.0e5), F(1.0e5), F(2.0)
NORM2_MIN, NORM2_MAX = F(0.99) * F(0.99), F(1.01) * F(1.01)
INFINITY_BITS = 0x7F800000


@dataclass
class Pose:
    time_us: int | None
    position_ned_m: list[np.float32]
    height_m: np.float32
    attitude: list[np.float32]


def intake_check(
    pose: Pose, pixels: dict[str, tuple[np.float32, np.float32]], last_time_us: int | None, taken: Decisions
) -> str:
    limits = [(pose.height_m, HEIGHT_MAX_M)]
    limits += [(value, POSITION_MAX_M) for value in pose.position_ned_m]
    limits += [(value, PIXEL_MAX_PX) for pixel in pixels.values() for value in pixel]
    q = pose.attitude
    if any(magnitude(value) >= INFINITY_BITS for value in [*q, *(value for value, _ in limits)]):
        return "not_finite"
    if any(magnitude(value) > magnitude(limit) for value, limit in limits):
        return "out_of_range"
    if pose.time_us is None or (last_time_us is not None and pose.time_us <= last_time_us):
        return "bad_time"
    if any(magnitude(value) > magnitude(ATTITUDE_MAX) for value in q):
        return "bad_attitude"
    norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    taken["attitude"] = bool(norm2 < NORM2_MIN or norm2 > NORM2_MAX)
    return "bad_attitude" if taken["attitude"] else "ok"
