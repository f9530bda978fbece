"""Detects jumps of the autopilot's filter that its log does not report: motion between two samples that is
unexplained."""

from __future__ import annotations

import math

import numpy as np

from ..flights.rotations import multiply
from .recording import Jump, Series, conjugate, linear, turned_by

STEP_M = 0.5  # a position error above this ...
STEP_SHARE = 0.1  # ... and above this share of the distance since the last sample is a jump
TURN_RAD = math.radians(3.0)  # an attitude error above this ...
TURN_SHARE = 0.2  # ... and above this share of the turn is a jump
LONGEST_S = 0.5  # between samples; jumps in a longer gap are undetectable
RARE, RARE_SHARE = 5, 0.02  # more steps than both, of the samples: no resets, but signals that do not belong together


def unexplained_m(position: Series, velocity: Series) -> np.ndarray:
    """(N - 1, 3): difference of each position to the previous one plus the integrated velocity, trapezoidal rule."""
    speed = linear(velocity, position.time_s)
    way = 0.5 * (speed[1:] + speed[:-1]) * np.diff(position.time_s)[:, None]
    return np.diff(position.value, axis=0) - way


def _if_rare(jumps: list[Jump], samples: int) -> list[Jump]:
    """No jumps if there are too many for resets: then unit, axes or sign of a signal are wrong."""
    return jumps if len(jumps) <= max(RARE, RARE_SHARE * samples) else []


def position_jumps(position: Series, velocity: Series, cause: str) -> list[Jump]:
    """Steps of the position that the velocity does not explain, with their size."""
    off = unexplained_m(position, velocity)
    way = np.linalg.norm(np.diff(position.value, axis=0) - off, axis=1)
    large = np.linalg.norm(off, axis=1) > STEP_M + STEP_SHARE * way
    large &= np.diff(position.time_s) <= LONGEST_S
    jumps = [
        Jump(float(position.time_s[k + 1]), tuple(float(x) for x in off[k]), cause)  # type: ignore[arg-type]
        for k in np.flatnonzero(large)
    ]
    return _if_rare(jumps, len(position.time_s))


def attitude_jumps(attitude: Series, gyro: Series, cause: str) -> list[Jump]:
    """Turns of the attitude that the rates do not explain."""
    turns = multiply(conjugate(attitude.value[:-1]), attitude.value[1:])
    angle = 2.0 * np.arctan2(np.linalg.norm(turns[:, 1:], axis=1), np.abs(turns[:, 0]))
    result = []
    for k in np.flatnonzero(angle > TURN_RAD):
        start, end = attitude.time_s[k], attitude.time_s[k + 1]
        if end - start > LONGEST_S or start < gyro.time_s[0] or end > gyro.time_s[-1]:
            continue
        left = multiply(conjugate(turned_by(gyro, start, end)), turns[k])
        off = 2.0 * math.atan2(float(np.linalg.norm(left[1:])), abs(float(left[0])))
        if off > TURN_RAD + TURN_SHARE * (float(angle[k]) - off):
            result.append(Jump(float(end), None, f"{cause} {math.degrees(off):.1f} deg"))
    return _if_rare(result, len(attitude.time_s))


def unreported(found: list[Jump], reported: list[Jump], within_s: float) -> list[Jump]:
    """Jumps detected from motion that no reported jump explains within this time."""
    return [one for one in found if all(abs(one.time_s - other.time_s) > within_s for other in reported)]


def merged(jumps: list[Jump]) -> list[Jump]:
    """Sorts by time and adds jumps at the same time; the sum is unknown if one of them is."""
    result: list[Jump] = []
    for jump in sorted(jumps, key=lambda one: one.time_s):
        if result and result[-1].time_s == jump.time_s:
            last = result.pop()
            both = None
            if last.delta_m is not None and jump.delta_m is not None:
                both = tuple(a + b for a, b in zip(last.delta_m, jump.delta_m))
            jump = Jump(jump.time_s, both, f"{last.cause}, {jump.cause}")  # type: ignore[arg-type]
        result.append(jump)
    return result
