"""Position and attitude of the aircraft as functions of time. Course axes: forward, right, down, with their origin at
the start of the flight, on the obstacle's ground; heights are above that ground."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import turns

Span = tuple[float, float]  # from, to: limits of a uniformly drawn number
GRAVITY_M_S2 = 9.81
SWAY_PERIODS_S = ((1.8, 3.0), (2.5, 4.0), (2.0, 3.5))  # of yaw, pitch, roll
VELOCITY_STEP_S = 1e-3  # of the difference quotient
BANK_MOST_RAD = math.radians(35.0)
HOVER_PERIODS_S = (5.0, 12.0)
IMAGES_MOST = 6000
TURN_RATE_RAD_S = math.radians(15.0)


@dataclass(frozen=True)
class Flown:
    """Description of a flight; numbers are drawn uniformly from spans."""

    path: str = "past"  # one of PATHS
    speed_m_s: Span = (12.0, 30.0)
    reach_s: Span = (10.0, 20.0)  # past: until the obstacle is abeam, without gap; other paths: duration
    ahead_m: Span | None = None  # range of the obstacle at first; None: from speed and reach
    height_m: Span = (15.0, 60.0)  # of the camera above the obstacle's ground
    climb_m_s: float = 0.7  # at most, up or down
    aside_m: Span = (3.0, 40.0)  # lateral distance of the obstacle's outline from the path, left or right
    weave_m: float = 6.0  # amplitude at most; half of the flights go straight
    steady_climb_m_s: float = 0.0  # exact size on top, up or down
    sway_deg: tuple[float, float, float] = (2.0, 1.5, 5.0)  # amplitudes of yaw, pitch, roll
    sway_periods_s: tuple[Span, Span, Span] = SWAY_PERIODS_S
    crab_deg: Span = (0.0, 0.0)  # constant angle of the nose from the course, left or right
    rate_hz: float = 8.0
    stop_s: float = 1.0  # a pass ends this long before the outline is abeam
    gap_s: float = 0.0  # duration without images after the first third


@dataclass(frozen=True)
class Path:
    """A flight: ``at`` gives positions (K, 3) and matrices body -> course (K, 3, 3) at times (K,)."""

    time_s: np.ndarray
    at: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    obstacle_m: np.ndarray  # (2,) forward, right: initial place of the obstacle's middle
    axis_rad: float = 0.0  # T's Z axis, clockwise from the course's forward
    mount_yaw_deg: float = 0.0
    trimmed: bool = True  # the track starts with the first image that shows the obstacle

    def velocity(self, time_s: np.ndarray) -> np.ndarray:
        """(K, 3) over the ground."""
        after, before = (self.at(time_s + sign * VELOCITY_STEP_S)[0] for sign in (1.0, -1.0))
        return (after - before) / (2 * VELOCITY_STEP_S)


def _sway(flown: Flown, rng: np.random.Generator) -> Callable[[np.ndarray], np.ndarray]:
    """Yaw, pitch and roll (3, K), rad, relative to the path."""
    amplitude = np.radians(flown.sway_deg)
    period = np.array([rng.uniform(*p) for p in flown.sway_periods_s])
    phase = rng.uniform(0.0, 2 * math.pi, 3)
    return lambda t: amplitude[:, None] * np.sin(2 * math.pi * t / period[:, None] + phase[:, None])


def _times(flown: Flown, duration_s: float) -> np.ndarray:
    count = min(int(duration_s * flown.rate_hz), IMAGES_MOST)
    t = np.arange(count) / flown.rate_hz
    return t + flown.gap_s * (np.arange(count) > count // 3)


def _side(half_m: float, flown: Flown, rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0]) * (half_m + rng.uniform(*flown.aside_m)))


def _crab(flown: Flown, rng: np.random.Generator) -> float:
    """Without a crab angle it draws no number."""
    if not any(flown.crab_deg):
        return 0.0
    return math.radians(rng.uniform(*flown.crab_deg)) * float(rng.choice([-1.0, 1.0]))


def _steered(
    place: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    heading: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    flown: Flown,
    rng: np.random.Generator,
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """The nose along the path, the bank angle of the turn, plus sway. ``heading``: angle and lateral
    acceleration."""
    sway = _sway(flown, rng)
    height, climb = rng.uniform(*flown.height_m), rng.uniform(-1.0, 1.0)
    climb = climb * flown.climb_m_s + math.copysign(flown.steady_climb_m_s, climb)
    crab = _crab(flown, rng)

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        forward, right = place(t)
        yaw, lateral = heading(t)
        bank = np.clip(np.arctan2(lateral, GRAVITY_M_S2), -BANK_MOST_RAD, BANK_MOST_RAD)
        swayed = sway(t)
        level = np.stack([forward, right, -(height + climb * t)], 1)
        return level, turns.of_angles(yaw + crab + swayed[0], swayed[1], bank + swayed[2])

    return at


def past(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """Straight or weaving past the obstacle."""
    speed = rng.uniform(*flown.speed_m_s)
    reach = rng.uniform(*flown.reach_s) + flown.gap_s
    ahead = rng.uniform(*flown.ahead_m) if flown.ahead_m else speed * reach
    duration = min(reach, (ahead - half_m) / speed - flown.stop_s)
    amplitude = rng.uniform(0.0, flown.weave_m) * float(rng.random() < 0.5)
    rate, phase = 2 * math.pi / rng.uniform(8.0, 15.0), rng.uniform(0.0, 2 * math.pi)

    def place(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return speed * t, amplitude * (np.sin(rate * t + phase) - math.sin(phase))

    def heading(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sideways = amplitude * rate * np.cos(rate * t + phase)
        return np.arctan2(sideways, speed), -amplitude * rate * rate * np.sin(rate * t + phase)

    side = _side(half_m, flown, rng)
    at = _steered(place, heading, flown, rng)
    return Path(_times(flown, duration - flown.gap_s), at, np.array([ahead, side]))


def hover(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """In place, with a drift of a meter or less."""
    size = rng.uniform(0.2, 1.0, 3)
    rate = 2 * math.pi / rng.uniform(*HOVER_PERIODS_S, 3)
    phase = rng.uniform(0.0, 2 * math.pi, 3)
    height, sway = rng.uniform(*flown.height_m), _sway(flown, rng)

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        drift = size * np.sin(rate * t[:, None] + phase)
        return drift - [0.0, 0.0, height], turns.of_angles(*sway(t))

    ahead = rng.uniform(*(flown.ahead_m or (40.0, 100.0))) + half_m
    return Path(_times(flown, rng.uniform(*flown.reach_s)), at, np.array([ahead, ahead * rng.uniform(-0.4, 0.4)]))


def _circle(
    flown: Flown, radius: float, start: float, sense: float, speed: float, rng: np.random.Generator
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """About the origin, from the angle ``start``; sense 1: clockwise from above."""
    rate = sense * speed / radius

    def place(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return radius * np.cos(start + rate * t), radius * np.sin(start + rate * t)

    def heading(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return start + rate * t + sense * math.pi / 2, np.full(len(t), sense * speed * speed / radius)

    return _steered(place, heading, flown, rng)


def orbit(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """Part of a circle around the obstacle, with a camera that looks sideways and keeps it in view. T's Z axis is the
    middle line of sight; none is more than 75 degrees from it."""
    return _round(flown, half_m, (100.0, 150.0), 0.5, rng)


def full_orbit(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """Most of a circle around the obstacle; T's Z axis is the first line of sight, the last ones point back along
    it."""
    return _round(flown, half_m, (200.0, 330.0), 0.0, rng)


def _round(flown: Flown, half_m: float, arc_deg: Span, axis_share: float, rng: np.random.Generator) -> Path:
    radius, speed = half_m + rng.uniform(50.0, 120.0), rng.uniform(*flown.speed_m_s)
    sense, arc = float(rng.choice([-1.0, 1.0])), math.radians(rng.uniform(*arc_deg))
    start = rng.uniform(0.0, 2 * math.pi)
    axis = start + axis_share * sense * arc + math.pi
    times = _times(flown, arc * radius / speed)
    return Path(times, _circle(flown, radius, start, sense, speed, rng), np.zeros(2), axis, 90.0 * sense)


def circling(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """Circles next to the obstacle, which comes into view once in each."""
    radius, speed = rng.uniform(100.0, 160.0), rng.uniform(*flown.speed_m_s)
    distance = radius + half_m + rng.uniform(60.0, 160.0)
    bearing = rng.uniform(0.0, 2 * math.pi)
    middle = distance * np.array([math.cos(bearing), math.sin(bearing)])
    at = _circle(flown, radius, rng.uniform(0.0, 2 * math.pi), float(rng.choice([-1.0, 1.0])), speed, rng)
    return Path(_times(flown, rng.uniform(*flown.reach_s)), at, middle, bearing, trimmed=False)


def after_turn(flown: Flown, half_m: float, rng: np.random.Generator) -> Path:
    """The track starts before a turn of 95 to 150 degrees; the obstacle is ahead only after it."""
    speed, turn = rng.uniform(*flown.speed_m_s), math.radians(rng.uniform(95.0, 150.0))
    sense = float(rng.choice([-1.0, 1.0]))
    radius, ends = speed / TURN_RATE_RAD_S, turn / TURN_RATE_RAD_S
    out = np.array([math.cos(turn), sense * math.sin(turn)])  # forward, right
    corner = radius * np.array([math.sin(turn), sense * (1.0 - math.cos(turn))])

    def place(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle = TURN_RATE_RAD_S * np.clip(t, 0.0, ends)
        along = speed * np.maximum(t - ends, 0.0)
        before = speed * np.minimum(t, 0.0)
        forward = radius * np.sin(angle) + out[0] * along + before
        return forward, sense * radius * (1.0 - np.cos(angle)) + out[1] * along

    def heading(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turning = (t > 0.0) & (t < ends)
        return sense * TURN_RATE_RAD_S * np.clip(t, 0.0, ends), sense * speed * TURN_RATE_RAD_S * turning

    reach = rng.uniform(*flown.reach_s)
    side = _side(half_m, flown, rng)
    place_m = corner + speed * reach * out + side * np.array([-out[1], out[0]])
    times = _times(flown, ends + reach - half_m / speed - flown.stop_s)
    return Path(times, _steered(place, heading, flown, rng), place_m, trimmed=False)


PATHS: dict[str, Callable[[Flown, float, np.random.Generator], Path]] = {
    "past": past, "hover": hover, "orbit": orbit, "full orbit": full_orbit, "circling": circling,
    "after turn": after_turn,
}  # fmt: skip
