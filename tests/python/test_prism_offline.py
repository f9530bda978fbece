"""The offline fit of a prism to upright boxes, against exact boxes, the bound, and the model of single images."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from goe_tools.flights.boxes import BUILDING, EXACT, MAST, BoxOptions, Solid, box_flight
from goe_tools.flights.flight import Flight
from goe_tools.models import prism_offline
from goe_tools.models.prism import (
    AXIS,
    STATES,
    UNKNOWNS,
    A,
    D,
    E,
    ErrorModel,
    Q,
    S,
    W,
    exact_side,
    focal_px,
    quantities,
    row_of,
    sights,
)
from goe_tools.models.prism_bound import VX, VZ, bound_of
from goe_tools.models.prism_filter import SHEAR_SHARE
from goe_tools.models.prism_offline import Track, fit

X0, Z0, WIDTH, HEIGHT = 0, 1, 3, 5
ESTIMATED = [X0, Z0, WIDTH, HEIGHT]
GAUSS = ErrorModel(
    box_noise_px=0.5, box_noise_rel=0.0, height_white_sd_m=0.0, terrain_height_sd_m=0.0, terrain_slope_sd=0.0, disc=True
)
WHITE = BoxOptions(box_noise_px=0.5, box_noise_rel=0.0)
LENS = {"k1": -0.1, "k2": 0.02, "p1": 0.001, "p2": 0.0005, "k3": -0.003}
OTHER_CAMERA = {"offset_x_m": 1.0, "offset_z_m": 0.2, "mount_pitch_deg": 2.0, "mount_roll_deg": 3.0, "fy": 900.0}


def framed(flight: Flight, configured: ErrorModel, state: np.ndarray) -> Flight:
    """Replaces the boxes by those of a prism with this state in the track's axes, at full accuracy."""
    track, boxes = Track(flight, configured), flight.box_px.copy()
    unknowns = np.append(state[: len(STATES)], np.zeros(UNKNOWNS - len(STATES)))
    center = np.array([flight.camera.cx, flight.camera.cy])[AXIS]
    for k, sight in enumerate(sights(flight, configured)):
        turned = sight.turned(track.turn, track.origin_m)
        for side in np.flatnonzero(np.isfinite(boxes[k])):
            guess = (boxes[k, side] - center[side]) / focal_px(flight.camera)[side]
            boxes[k, side] = exact_side(turned, unknowns, side, guess) * focal_px(flight.camera)[side] + center[side]
    return replace(flight, box_px=boxes)


def true_place(flight: Flight, track: Track) -> np.ndarray:
    """The truth as a state of the track, as deep as wide. Errors of attitude, height and velocity are unknown, thus
    0."""
    x, _, z = track.turn @ (np.array([flight.truth.x0_m, 0.0, flight.truth.z0_m]) - track.origin_m)
    state = np.zeros(len(STATES) + 2)
    state[[A, Q, W, E]] = np.array([x, 1.0, flight.truth.width_m / 2, flight.truth.height_m]) / z
    return state


# ------------------------------------------------------------------------------------------------------------ the model


@pytest.mark.parametrize(
    ("change", "most", "slope_most"),
    [({}, 1e-13, 1e-9), (LENS, 2e-7, 5e-4), ({**LENS, **OTHER_CAMERA}, 2e-7, 5e-4)],
    ids=["pinhole", "lens", "all"],
)
def test_sides_are_those_of_one_image(change: dict[str, float], most: float, slope_most: float) -> None:
    """Coordinates and derivatives. ``prism`` computes one side after the other, and with a lens stops an iteration
    earlier."""
    flight = box_flight(MAST, BoxOptions(roll_deg=25.0), 3)
    track = Track(replace(flight, camera=replace(flight.camera, **change)), ErrorModel())
    state = track.start()
    state[:3], state[S], state[D] = [0.01, -0.005, 0.008], 0.3 * state[W], 0.2
    state[Q] *= 0.9
    predicted, slope = track.predicted(state)
    size = np.where(np.arange(UNKNOWNS) == S, 4.0, 1.0)  # the shear is most sensitive to the touching point
    unknowns = np.append(state[: len(STATES)], np.zeros(UNKNOWNS - len(STATES)))
    for n in range(0, len(track.side), 7):
        sight, side = track.sight[n], track.side[n]
        at = exact_side(sight, unknowns, side, track.measured[n])
        row = row_of(sight, state[: len(STATES)], side, at)
        assert predicted[n] == pytest.approx(at, abs=most)
        assert slope[n] / size == pytest.approx(row.slope / size, rel=slope_most, abs=slope_most)


def test_a_velocity_error_moves_the_camera() -> None:
    flight = box_flight(MAST, replace(EXACT, roll_deg=10.0), 1)
    track = Track(flight, GAUSS)
    state, velocity = track.start(), np.array([0.3, 0.0, -0.2])
    state[[VX, VZ]] = velocity[[0, 2]]
    shifted = Track(flight, GAUSS)
    shifted.moved_m = shifted.moved_m - shifted.since_s[:, None] * velocity
    still = state.copy()
    still[[VX, VZ]] = 0.0
    assert track.predicted(state)[0] == pytest.approx(shifted.predicted(still)[0], abs=1e-12)


@pytest.mark.parametrize(
    "configured", [GAUSS, ErrorModel(attitude_walk_sd_deg=0.1, position_white_sd_m=0.5)], ids=["disc", "any"]
)
def test_derivatives_of_all_that_counts(configured: ErrorModel) -> None:
    """By central differences, for sides and prior rows."""
    track = Track(box_flight(MAST, BoxOptions(roll_deg=25.0), 2), configured)
    state = track.start()
    state[:3], state[[VX, VZ]], state[3] = [0.01, -0.005, 0.008], [0.1, -0.2], 0.003
    state[S], state[D] = 0.3 * state[W], 0.2
    assert (track.decide(state) == state).all() and track.estimates_depth
    whitening = np.eye(len(track.side))
    slope = track.residuals(state, whitening)[1]
    step = np.full(len(state), 1e-5)
    step[Q] = 1e-7
    for i in range(len(state)):
        move = np.eye(len(state))[i] * step[i]
        after, before = (track.residuals(state + m, whitening)[0] for m in (move, -move))
        size = max(1.0, np.abs(slope[:, i]).max())
        assert slope[:, i] / size == pytest.approx((after - before) / (2 * step[i] * size), abs=1e-5), i


# -------------------------------------------------------------------------------------------------------------- the fit


@pytest.mark.parametrize(
    "configured", [GAUSS, replace(GAUSS, disc=False), ErrorModel()], ids=["disc", "any depth", "defaults"]
)
@pytest.mark.parametrize("roll", [0.0, 10.0, 25.0])
def test_exact_boxes_give_the_truth(roll: float, configured: ErrorModel) -> None:
    """A mast is as deep as wide, so the initial guess of the depth is right, too."""
    flight = box_flight(MAST, replace(EXACT, roll_deg=roll), 2)
    state = true_place(flight, Track(flight, configured))
    found = fit(framed(flight, configured, state), configured)
    assert found.values[ESTIMATED] == pytest.approx(flight.truth.values[ESTIMATED], abs=1e-3)
    assert found.cost < 1e-6 and np.isnan(found.values[[2, 4]]).all()


UNEQUAL = replace(GAUSS, disc=False, box_noise_px=0.05)


@pytest.mark.parametrize("roll", [0.0, 25.0])
@pytest.mark.parametrize(("depth", "shear"), [(3.0, 0.0), (2.0, 0.6), (0.6, -0.6)])
def test_a_footprint_that_a_turn_shows(depth: float, shear: float, roll: float) -> None:
    """An ellipse with another depth than its width, turned; shear in half widths."""
    flight = box_flight(MAST, replace(EXACT, roll_deg=roll), 2)
    track = Track(flight, UNEQUAL)
    state = true_place(flight, track)
    state[S], state[D] = shear * state[W], np.log(depth)
    found = fit(framed(flight, UNEQUAL, state), UNEQUAL)
    wanted = quantities(state[: len(STATES)], track.turn)
    assert found.state[D] == pytest.approx(state[D], abs=0.02)
    assert found.state[S] == pytest.approx(state[S], abs=0.02 * state[W])
    assert found.values[ESTIMATED] == pytest.approx(wanted, abs=0.1)


def test_a_depth_that_no_turn_shows_is_considered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its part of the variances is what a small true depth moves the fit by, times its sigma (1) over that depth."""
    flight = box_flight(MAST, replace(EXACT, roll_deg=25.0), 2).first(60)
    track = Track(flight, UNEQUAL)
    state = true_place(flight, track)
    state[D] = 0.02
    boxes = framed(flight, UNEQUAL, state)
    found = fit(boxes, UNEQUAL)
    moved = found.values[ESTIMATED] - quantities(state[: len(STATES)], track.turn)
    monkeypatch.setattr(prism_offline, "footprint_sds", lambda errors, half: (SHEAR_SHARE * half, 0.0))
    known = fit(boxes, UNEQUAL)
    assert found.state[D] == 0.0
    considered = np.sqrt(found.sigma[ESTIMATED] ** 2 - known.sigma[ESTIMATED] ** 2)
    assert considered == pytest.approx(np.abs(moved) / state[D], rel=0.05, abs=0.01)


@pytest.mark.parametrize(("solid", "configured"), [(MAST, GAUSS), (BUILDING, ErrorModel())], ids=["mast", "building"])
def test_the_optimum_is_one_whatever_the_start(solid: Solid, configured: ErrorModel) -> None:
    for seed in (1, 3):
        flight = box_flight(solid, replace(WHITE, roll_deg=10.0), seed)
        once, again = fit(flight, configured), fit(flight, configured, true_place(flight, Track(flight, configured)))
        assert again.values[ESTIMATED] == pytest.approx(once.values[ESTIMATED], abs=2e-3)
        assert again.cost == pytest.approx(once.cost, rel=1e-6)


@pytest.mark.release
def test_errors_are_near_the_bound_and_the_cost_is_the_least() -> None:
    """Without path errors, which the bound does not model. 40 flights determine an RMSE to 11 %."""
    options = replace(WHITE, roll_deg=10.0, position_walk_sd_m=0.0, image_rate_hz=4.0)
    configured = replace(GAUSS, position_walk_sd_m=0.0)
    ratio, cost_share, sigma_share = [], [], []
    for seed in range(1, 41):
        flight = box_flight(MAST, options, seed)
        found, bound = fit(flight, configured), bound_of(flight, configured)
        track = Track(flight, configured)
        assert (track.decide(found.state) == found.state).all()
        whitening = track.whitening(found.state)
        assert track.cost(found.state, whitening) <= track.cost(true_place(flight, track), whitening)
        ratio.append((found.values - flight.truth.values)[ESTIMATED] / bound[ESTIMATED])
        sigma_share.append(found.sigma[[X0, Z0, HEIGHT]] / bound[[X0, Z0, HEIGHT]])
        cost_share.append(found.cost / sum(not sight.cut for sight in track.sight))  # cut sides do not count
    rmse = dict(zip(("X0", "Z0", "W", "H"), np.sqrt(np.mean(np.square(ratio), 0))))
    for name in ("X0", "Z0", "H"):
        assert 0.75 < rmse[name] < 1.25, rmse
    assert np.median(sigma_share, 0) == pytest.approx(1.0, abs=0.1)
    assert np.mean(cost_share) == pytest.approx(1.0, abs=0.1)
