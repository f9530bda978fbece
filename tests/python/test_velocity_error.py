"""A constant error of the own velocity in the reference filter: how the estimate depends on it, and what its sigmas
say of it.

A solid that is no larger than a footprint of the model, exact boxes and a start at the truth leave no residuals. The
filter is then linear in a small error of the reported path."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache

import numpy as np
import pytest
from goe_tools.flights.boxes import EXACT, MAST, BoxOptions, Solid, box_flight
from goe_tools.flights.flight import Flight
from goe_tools.models.prism import A, D, E, ErrorModel, Q, W, sights
from goe_tools.models.prism_filter import PrismFilter, follow

POST = Solid("post", "disc", 3.0, 3.0, 6.0)
SWAYING = replace(EXACT, roll_deg=12.0, altitude_m=8.0)
SLOW = replace(SWAYING, speed_mps=2.0, image_rate_hz=2.0, ahead_m=(50.0, 70.0), aside_m=(-15.0, -5.0), stop_m=15.0)
FAST = replace(SWAYING, speed_mps=15.0, image_rate_hz=5.0, ahead_m=(180.0, 220.0), aside_m=(-30.0, -5.0), stop_m=25.0)
FLIGHTS = {"slow": SLOW, "fast": FAST}
STEP_M_S = 1e-3
LEVEL = [0, 2]  # X and Z of three axes


@dataclass
class Course:
    """The filter after each image."""

    state: np.ndarray  # (K, 10)
    by_velocity: np.ndarray  # (K, 10, 2) X and Z of T
    values: np.ndarray  # (K, 4)
    gained: np.ndarray  # (K, 4): the growth of the variances with the own velocity's error, per (m/s)^2


def flown(flight: Flight, errors: ErrorModel, drift: tuple[float, float] = (0.0, 0.0)) -> Course:
    """From the truth. ``drift``: error of the own velocity along X and Z of T, m/s."""
    moved = flight.position_ned_m.copy()
    moved[:, :2] += flight.time_s[:, None] * drift[::-1]
    prism, truth = PrismFilter(errors), flight.truth
    parts = []
    for sight in sights(replace(flight, position_ned_m=moved), errors):
        if prism.state is None:
            prism.first_s = sight.time_s
            assert prism.start(prism.altimeter.read(sight, False, 0.0))
            x, _, z = prism.turn @ [truth.x0_m, 0.0, truth.z0_m]
            prism.state[[A, Q, W, E]] = np.array([x, 1.0, 0.5 * truth.width_m, truth.height_m]) / z
        prism.take(sight)
        turn = prism.turn[np.ix_(LEVEL, LEVEL)]
        values, with_error = prism.report(sight)
        prism.errors = replace(errors, velocity_bias_sd_m_s=0.0)
        without = prism.report(sight)[1]
        prism.errors = errors
        gained = (with_error**2 - without**2) / errors.velocity_bias_sd_m_s**2
        parts.append((prism.state, prism.by_velocity @ turn, values, gained))
    return Course(*(np.array(part) for part in zip(*parts)))


@cache
def compared(name: str) -> tuple[Course, Course]:
    """The course of a flight, and its central differences by an own velocity error along X and Z of T."""
    flight, errors = box_flight(POST, FLIGHTS[name], 2), ErrorModel(velocity_bias_sd_m_s=0.2)
    pairs = [[flown(flight, errors, (s * x, s * z)) for s in (STEP_M_S, -STEP_M_S)] for x, z in ((1, 0), (0, 1))]
    slopes = (
        np.stack([(getattr(a, part.name) - getattr(b, part.name)) / (2 * STEP_M_S) for a, b in pairs], -1)
        for part in fields(Course)
    )
    return flown(flight, errors), Course(*slopes)


@pytest.mark.parametrize("name", FLIGHTS)
def test_the_filter_knows_how_its_state_depends_on_the_own_velocity(name: str) -> None:
    """With the sides' memories, before and after images give the depth."""
    base, slope = compared(name)
    size = np.abs(base.by_velocity).max((0, 2))
    assert (size > 0).all() and (base.by_velocity[len(size), D] == 0).all()  # images give the depth later
    off = np.abs(slope.state - base.by_velocity).max(2) / size
    assert off.max() < 0.01, np.unravel_index(off.argmax(), off.shape)


@pytest.mark.parametrize("name", FLIGHTS)
def test_the_variances_contain_the_changes_by_the_own_velocity(name: str) -> None:
    """[(R21)] The squares of what an error of one sigma along X, and one along Z, changes."""
    base, slope = compared(name)
    late = slice(len(base.values) // 4, None)
    assert base.gained[late] == pytest.approx((slope.values[late] ** 2).sum(2), rel=0.03)


@pytest.mark.release
def test_slow_flights_with_an_own_velocity_error_are_covered() -> None:
    """[navigation.velocity_bias_sd_m_s] Of a mast known to be round, as the depth would hide it."""
    errors = ErrorModel(
        velocity_bias_sd_m_s=0.2, box_noise_rel=0.04, box_noise_px=0.5, box_correlation_time_s=1.0, disc=True,
        terrain_height_sd_m=0.0, terrain_slope_sd=0.0,
    )  # fmt: skip
    options = replace(
        BoxOptions(), roll_deg=10.0, speed_mps=2.0, image_rate_hz=4.0, ahead_m=(40.0, 60.0), aside_m=(-15.0, -5.0),
        velocity_bias_sd_m_s=0.2,
    )  # fmt: skip
    ratio = []
    for seed in range(40):
        flight = box_flight(MAST, options, seed)
        track = follow(flight, errors)
        ratio.append((track.values[-1, 1] - flight.truth.z0_m) / track.sigma[-1, 1])
    assert 0.75 < np.sqrt(np.mean(np.square(ratio))) < 1.25
