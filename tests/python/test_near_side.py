"""The near side of obstacles by upright boxes, as goe_hazard() reports it to an aircraft that hovers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from goe_tools.flights.boxes import BUILDING, MAST, WALL, BoxOptions, Solid, box_flight
from goe_tools.library import METHODS, Plan, camera_settings, estimate, images_of, ready, run

FLIGHTS = 60
CONFIGURED = {  # the errors of BoxOptions
    "detector.box_noise_px": 0.5,
    "detector.box_noise_rel": 0.04,
    "detector.box_correlation_time_s": 1.0,
    "navigation.terrain_height_sd_m": 0.0,
}
PAST = BoxOptions(roll_deg=5.0)
AHEAD = BoxOptions(roll_deg=3.0, aside_m=(-2.0, 2.0), ahead_m=(300.0, 440.0), stop_m=40.0)
AT_CAR = BoxOptions(roll_deg=5.0, altitude_m=8.0, speed_mps=10.0, ahead_m=(60.0, 90.0), aside_m=(-12.0, -4.0))
CASES = {
    "mast": (MAST, PAST),
    "building": (BUILDING, PAST),
    "wall end-on": (WALL, PAST),
    "wall broadside": (replace(WALL, width_m=40.0, length_m=6.0), PAST),
    "car": (Solid("car", "box", 1.8, 4.4, 1.5, 90.0), AT_CAR),
    "building ahead": (replace(BUILDING, turned_deg=90.0), AHEAD),
    "wall ahead": (replace(WALL, turned_deg=90.0), replace(AHEAD, stop_m=60.0)),
}
Z0 = 1


def setup_module() -> None:
    ready()


def near_errors(solid: Solid, options: BoxOptions, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """(n,) error of the distance to the near side in each image with an answer, positive if too far, and its sigma."""
    flight = box_flight(solid, options, seed)
    hover = np.zeros((len(flight.time_s), 3))
    images = replace(images_of(flight), velocity_m_s=hover, plans=(Plan(5.0, 5.0),))
    track = run(images, {**camera_settings(flight), **CONFIGURED})
    known = (track.hazard["status"][:, 0] >= 0) & track.fresh
    truth, own = flight.truth, flight.position_ned_m - flight.position_ned_m[0]
    middle = np.stack([truth.x0_m - own[:, 1], truth.z0_m - own[:, 0]], 1)
    range_m = np.hypot(*middle.T)
    reach_m = (solid.outline(0.0, 0.0, truth.orientation_rad) @ (-middle / range_m[:, None]).T).max(0)
    return (track.hazard["dcpa_m"][:, 0] - (range_m - reach_m))[known], track.hazard["dcpa_sd_m"][known, 0]


def longest_run(flags: np.ndarray) -> int:
    """Most consecutive True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


@pytest.mark.parametrize("name", CASES)
def test_the_near_side_is_covered_and_never_confidently_too_far(name: str) -> None:
    """[goe_hazard] Both ends: a sigma that covers everything is as wrong as one that covers too little."""
    flown = [near_errors(*CASES[name], seed) for seed in range(1, FLIGHTS + 1)]
    error, sigma = (np.concatenate(parts) for parts in zip(*flown))
    covered = float(np.mean(np.abs(error) < 2.0 * sigma))
    assert 0.88 < covered < 0.99, covered
    assert max(longest_run(off > 4.0 * sd) for off, sd in flown) < 5


def test_a_house_straight_ahead_is_not_pushed_away() -> None:
    """[GOE_MODEL_PRISM] Corners look like depth: an estimated depth would grow without end in such flights."""
    rng = np.random.default_rng(5)
    for seed in range(40):
        width_m, length_m = rng.uniform(6.0, 20.0, 2)
        solid = Solid("house", "box", float(width_m), float(length_m), float(rng.uniform(8.0, 30.0)), 90.0)
        flight = box_flight(solid, AHEAD, seed)
        track = estimate(flight, camera_settings(flight))
        late = np.flatnonzero(track.fresh & (track.method == METHODS["filter"]))[-24:]
        error = np.abs(track.values[late, Z0] - flight.truth.z0_m)
        assert (error < 4.0 * track.sigma[late, Z0]).all() and error[-1] < max(width_m, length_m)
