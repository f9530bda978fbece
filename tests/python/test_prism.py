"""The library's prism against a reference in another formulation, the reference's derivatives, and the bound.

Both get each flight rounded to float32, so that only rounding remains as difference."""

from __future__ import annotations

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from goe_tools.flights.boxes import BUILDING, EXACT, MAST, WALL, BoxOptions, box_flight
from goe_tools.flights.flight import Flight
from goe_tools.library import MODEL_DISC, MODEL_PRISM, Track, camera_settings, estimate, ready
from goe_tools.models import prism_filter
from goe_tools.models.prism import (
    BOX_BOTTOM,
    BOX_LEFT,
    BOX_RIGHT,
    BOX_TOP,
    PX,
    STATES,
    UNKNOWNS,
    A,
    D,
    E,
    ErrorModel,
    G,
    Q,
    S,
    Sight,
    W,
    doubtful_sides,
    exact_side,
    measured_sides,
    rim_point,
    row_of,
    sights,
    support,
    turned,
)
from goe_tools.models.prism_bound import bound_of, true_state
from goe_tools.models.prism_filter import DEPTH_TURNED, PrismFilter, PrismTrack, follow

X0, Z0, WIDTH, HEIGHT = 0, 1, 3, 5
ESTIMATED = [X0, Z0, WIDTH, HEIGHT]
# Differences over the reference's sigma, and relative differences of the sigmas. Measured in float64: 1e-5, because
# answers are float32, and 2e-7. In float32: 2e-4 (30 images/s, 13 s of white noise), otherwise 3e-5; sigmas 3e-5.
# A height's row waits until its information has grown by a threshold. Where that is a tie, float32 may take the row an
# image sooner or later than float64: the reference then decides as the library does.
VALUE_MOST = {True: 3e-5, False: 6e-4}
SIGMA_MOST = {True: 5e-7, False: 6e-5}
TIE = 3e-4  # of the threshold: the rounding of the difference that is compared with it
EVERY_IMAGE = {"filter.range_sd_rel_max": 10.0}
LENS = {"k1": -0.1, "k2": 0.02, "p1": 0.001, "p2": 0.0005, "k3": -0.003}
# Every run compares the formulas, with the tolerances of float64. A release compares their rounding, too, as
# test_rolling always does.
BOTH_AT_RELEASES = pytest.mark.parametrize(
    "double", [True, pytest.param(False, marks=pytest.mark.release)], ids=["float64", "float32"]
)
LEVER = {"offset_x_m": 1.0, "offset_y_m": 0.5, "offset_z_m": 0.2}
MOUNT = {"mount_pitch_deg": 2.0, "mount_yaw_deg": 1.0, "mount_roll_deg": 3.0, "fy": 900.0, "heading_deg": 20.0}


@pytest.fixture
def built() -> None:
    for double in (False, True):
        try:
            ready(double)
        except FileNotFoundError as reason:
            pytest.skip(str(reason))


def rounded(flight: Flight) -> Flight:
    """Rounded to float32."""

    def near(values: np.ndarray) -> np.ndarray:
        return np.asarray(values, np.float32).astype(float)

    return replace(
        flight, position_ned_m=near(flight.position_ned_m), attitude=near(flight.attitude),
        height_m=near(flight.height_m), box_px=near(flight.box_px), time_s=np.rint(flight.time_s * 1e6) / 1e6,
    )  # fmt: skip


def without(flight: Flight, sides: tuple[int, ...], first: int, last: int | None = None) -> Flight:
    """Removes sides of the images from ``first`` to before ``last``."""
    boxes = flight.box_px.copy()
    boxes[first:last, list(sides)] = np.nan
    return replace(flight, box_px=boxes)


def both(flight: Flight, configured: ErrorModel, double: bool) -> tuple[PrismTrack, Track]:
    flight = rounded(flight)
    settings = camera_settings(flight) | configured.settings() | EVERY_IMAGE
    track = estimate(flight, settings, double=double)
    assert set(track.model[track.fresh]) == {MODEL_DISC if configured.disc else MODEL_PRISM}
    reference = follow(flight, configured)
    if not double:
        decided = [reference, *(follow_with_threshold(flight, configured, 1 + tie) for tie in (-TIE, TIE))]
        reference = min(decided, key=lambda one: difference(one, track)[0].max())
    return reference, track


def follow_with_threshold(flight: Flight, configured: ErrorModel, share: float) -> PrismTrack:
    with mock.patch.object(prism_filter, "GROWN", share * prism_filter.GROWN):
        return follow(flight, configured)


def difference(reference: PrismTrack, track: Track) -> tuple[np.ndarray, np.ndarray]:
    """Of values, over the reference's sigma, and of sigmas, relative."""
    valid = track.fresh[:, None] & np.isfinite(track.values)
    valid[:, [2, 4]] = False
    with np.errstate(invalid="ignore"):
        off = np.where(valid, np.abs(track.values - reference.values) / reference.sigma, 0.0)
        wider = np.where(valid, np.abs(track.sigma / reference.sigma - 1), 0.0)
    return off, wider


def assert_same(reference: PrismTrack, track: Track, double: bool) -> None:
    """Compares every image that carries information; the first one has no answer."""
    there = np.flatnonzero(reference.fresh)
    assert np.array_equal(np.flatnonzero(track.fresh), there[1:]) and len(there) > 30
    assert np.isfinite(track.values[there[1:]][:, [X0, Z0]]).all()
    off, wider = difference(reference, track)
    assert off.max() < VALUE_MOST[double], np.unravel_index(off.argmax(), off.shape)
    assert wider.max() < SIGMA_MOST[double], np.unravel_index(wider.argmax(), wider.shape)


# ------------------------------------------------------------------------------------------- library and reference


def test_the_references_defaults_are_the_librarys(built: None) -> None:
    flight = box_flight(BUILDING, BoxOptions(roll_deg=10.0), 2)
    usual, configured = (estimate(flight, camera_settings(flight) | more) for more in ({}, ErrorModel().settings()))
    for name in ("values", "sigma", "nis", "nis_ratio"):
        assert np.array_equal(getattr(usual, name), getattr(configured, name), equal_nan=True)


@pytest.mark.parametrize("double", [True, False], ids=["float64", "float32"])
@pytest.mark.parametrize("roll", [0.0, 5.0, 10.0, 25.0])
@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.release)])
@pytest.mark.parametrize("solid", [MAST, BUILDING, WALL], ids=lambda solid: solid.name)
def test_rolling(built: None, solid: object, seed: int, roll: float, double: bool) -> None:
    """[A29, GOE_MODEL_PRISM]"""
    reference, track = both(box_flight(solid, BoxOptions(roll_deg=roll), seed), ErrorModel(), double)
    assert not reference.refused.any()
    assert_same(reference, track, double)
    assert np.isfinite(track.values[-1][ESTIMATED]).all()


@BOTH_AT_RELEASES
@pytest.mark.parametrize(
    ("sides", "first", "last"),
    [
        ((BOX_BOTTOM,), 0, None), ((BOX_BOTTOM,), 0, 40), ((BOX_BOTTOM,), 40, None), ((BOX_TOP,), 0, None),
        ((BOX_TOP,), 0, 60), ((BOX_LEFT,), 20, 40), ((BOX_LEFT, BOX_TOP, BOX_RIGHT), 20, 40), ((0, 1, 2, 3), 20, 40),
        ((BOX_RIGHT,), 0, 10),
    ],
)  # fmt: skip
def test_sides_that_are_missing(
    built: None, sides: tuple[int, ...], first: int, last: int | None, double: bool
) -> None:
    flight = without(box_flight(BUILDING, BoxOptions(roll_deg=10.0), 3), sides, first, last)
    reference, track = both(flight, ErrorModel(), double)
    assert_same(reference, track, double)


USUAL = BoxOptions(roll_deg=5.0)
WHITE = replace(USUAL, box_noise_rel=0.0, image_rate_hz=60.0)


@BOTH_AT_RELEASES
@pytest.mark.parametrize(
    ("solid", "options", "configured"),
    [
        (MAST, replace(USUAL, height_white_sd_m=3.0), ErrorModel()),
        (MAST, replace(USUAL, height_white_sd_m=1.0), ErrorModel(height_white_sd_m=1.0)),
        (MAST, replace(USUAL, altimeter=False), ErrorModel(height_bias_sd_m=1000.0)),
        (MAST, replace(USUAL, altimeter=False), ErrorModel(height_bias_sd_m=1000.0, disc=True)),
        (BUILDING, USUAL, ErrorModel(position_white_sd_m=0.5)),
        (BUILDING, USUAL, ErrorModel(attitude_walk_sd_deg=0.1)),
        (BUILDING, USUAL, ErrorModel(box_correlation_time_s=0.0)),
        (MAST, WHITE, ErrorModel(box_noise_px=0.5, box_noise_rel=0.0, disc=True)),
        (MAST, replace(USUAL, aside_m=(-60.0, -50.0), ahead_m=(150.0, 180.0)), ErrorModel()),
        (MAST, replace(USUAL, roll_deg=25.0, altitude_m=60.0), ErrorModel(border_rel=0.03, truncation_noise_rel=0.3)),
    ],
    ids=[
        "altimeter noise", "configured altimeter noise", "no altimeter", "disc without altimeter", "position noise",
        "drift", "no correlation",
        "60 images/s", "clipped soon", "from above, few sides at the border",
    ],
)  # fmt: skip
def test_other_flights_and_noise(
    built: None, solid: object, options: BoxOptions, configured: ErrorModel, double: bool
) -> None:
    """[navigation.terrain_height_sd_m, navigation.position_white_sd_m]"""
    reference, track = both(box_flight(solid, options, 3), configured, double)
    assert_same(reference, track, double)


@BOTH_AT_RELEASES
@pytest.mark.parametrize(
    "change", [LENS, LEVER, MOUNT, {**LENS, **LEVER, **MOUNT}], ids=["lens", "lever", "mount", "all"]
)
def test_other_cameras(built: None, change: dict[str, float], double: bool) -> None:
    """No such camera recorded the boxes; both sides must interpret them equally."""
    flight = box_flight(MAST, BoxOptions(roll_deg=25.0), 3)
    reference, track = both(
        replace(flight, camera=replace(flight.camera, **change)), ErrorModel(attitude_bias_sd_deg=5.0), double
    )
    assert_same(reference, track, double)


@pytest.mark.parametrize("double", [True, False], ids=["float64", "float32"])
def test_residuals_that_are_doubted(built: None, double: bool) -> None:
    """With too small noise settings, rows get a low weight or none, but not so often that the library restarts the
    track."""
    flight = box_flight(BUILDING, BoxOptions(roll_deg=25.0), 1)
    reference, track = both(flight, ErrorModel(box_noise_px=0.3, box_noise_rel=0.008), double)
    assert reference.doubted.sum() >= 10 and reference.refused.sum() >= 3
    assert_same(reference, track, double)


@pytest.mark.parametrize("solid", [MAST, BUILDING, WALL], ids=lambda solid: solid.name)
def test_images_estimate_the_depth_after_a_turn(solid: object) -> None:
    """Before, it keeps its prior; the last images of these flights are after it."""
    prism = PrismFilter(ErrorModel())
    variance = []
    for sight in sights(box_flight(solid, BoxOptions(roll_deg=10.0), 1), ErrorModel()):
        before = prism.state
        if prism.take(sight):
            known = before is not None and abs(turned(sight.turned(prism.turn, prism.origin_m), before)) > DEPTH_TURNED
            assert known or (prism.state[D], prism.depth_variance) == (0.0, 1.0)
            variance.append(prism.depth_variance)
    assert variance[-1] < variance[-2] < 1.0 and variance.count(1.0) > 60


def test_images_too_soon_are_not_used() -> None:
    flight = box_flight(MAST, WHITE, 3)
    every = np.diff(flight.time_s[follow(flight, ErrorModel()).fresh])
    assert np.allclose(every, 0.1, atol=1e-3)  # 0.08 * 1.2 s, in steps of 1/30 s
    assert follow(flight, ErrorModel(box_correlation_time_s=0.0)).fresh.all()


# -------------------------------------------------------------------------------------------------- the measurement


def shown(change: dict[str, float], roll_deg: float = 25.0) -> list[Sight]:
    flight = box_flight(MAST, BoxOptions(roll_deg=roll_deg), 5)
    images = sights(replace(flight, camera=replace(flight.camera, **change)), ErrorModel())
    return images[10:80:14]


RIM_POINTS = 20001


def some_state(rng: np.random.Generator, images: list[Sight]) -> np.ndarray:
    state = np.zeros(UNKNOWNS)
    state[:3] = 0.01 * rng.standard_normal(3)
    state[[G, A, Q, E, W]] = [0.01, -0.1, 1 / 240, rng.uniform(0.0, 0.1), 0.0125]
    state[[S, D]] = 0.0125 * rng.uniform(-1, 1), rng.uniform(-1, 1)
    return state


def framed(sight: Sight, state: np.ndarray, side: int) -> float:
    """The same box from many points of both rims, projected one by one."""
    angle = np.linspace(0, 2 * np.pi, RIM_POINTS)
    x = state[W] * np.cos(angle)
    z = state[S] * np.cos(angle) + state[W] * np.exp(state[D]) * np.sin(angle)
    return outermost(sight, state, side, np.stack([x, z], 1))


def outermost(sight: Sight, state: np.ndarray, side: int, rim: np.ndarray) -> float:
    """Side of the box around the prism over a rim (n, 2), which is about the middle; states of the footprint do not
    count."""
    x, z = (np.array([state[A], 1.0]) - (sight.moved_m + state[PX:])[[0, 2]] * state[Q] + rim).T
    level = (sight.height_m - state[PX + 1]) * state[Q]
    points = np.concatenate([np.stack([x, np.full_like(x, y), z], 1) for y in (level + state[G], level - state[E])])
    bx, by, bz = sight.axes_from_body @ state[:3]
    points = points @ np.array([[1.0, -bz, by], [bz, 1.0, -bx], [-by, bx, 1.0]]).T @ sight.axes_from_camera
    u, v = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    k = sight.camera
    r2 = u * u + v * v
    radial = 1 + k.k1 * r2 + k.k2 * r2**2 + k.k3 * r2**3
    image = (
        u * radial + 2 * k.p1 * u * v + k.p2 * (r2 + 2 * u * u),
        v * radial + k.p1 * (r2 + 2 * v * v) + 2 * k.p2 * u * v,
    )[side % 2]
    return float(image.min() if side < 2 else image.max())


@pytest.mark.parametrize(("change", "most"), [({}, 2e-9), (LENS, 2e-7)], ids=["pinhole", "lens"])
def test_a_side_is_the_outermost_point_of_the_rims(change: dict[str, float], most: float) -> None:
    rng = np.random.default_rng(1)
    images = shown(change)
    for sight in images:
        state = some_state(rng, images)
        for side in range(4):
            frame = framed(sight, state, side)
            assert exact_side(sight, state, side, frame + 0.003) == pytest.approx(frame, abs=most)


def turned_ellipse(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(2, 2) axes of a random ellipse, half axes times directions as columns, and the footprint's w, s, d."""
    angle, long, short = rng.uniform(-np.pi / 2, np.pi / 2), rng.uniform(0.02, 0.05), rng.uniform(0.005, 0.02)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    half, shear, deep = np.linalg.cholesky(turn @ np.diag([long**2, short**2]) @ turn.T)[[0, 1, 1], [0, 0, 1]]
    return turn * [long, short], np.array([half, shear, np.log(deep / half)])


def test_a_turned_ellipse_is_touched_where_its_axes_say() -> None:
    """By half axes l1, l2 along e1, e2: h = sqrt((l1 e1 u)^2 + (l2 e2 u)^2), touching (l1^2 e1 (e1 u) + ...)/h."""
    rng, state = np.random.default_rng(4), np.zeros(UNKNOWNS)
    for _ in range(20):
        axes, state[[W, S, D]] = turned_ellipse(rng)
        for angle in rng.uniform(0, 2 * np.pi, 8):
            u = np.array([np.cos(angle), np.sin(angle)])
            reach = float(np.hypot(*(u @ axes)))
            assert support(state, u) == pytest.approx(reach, rel=1e-12)
            assert rim_point(state, u) == pytest.approx(axes @ (axes.T @ u) / reach, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("roll", [0.0, 5.0, 10.0, 25.0])
def test_a_row_predicts_the_side_of_a_turned_ellipse(roll: float) -> None:
    """The outermost of many points of the ellipse, along its own axes. A measured side that is off by 1e-3 touches
    elsewhere, which moves the prediction to second order only."""
    rng = np.random.default_rng(5)
    images = shown({}, roll)
    angle = np.linspace(0, 2 * np.pi, RIM_POINTS)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    for sight in images:
        state = some_state(rng, images)
        state[PX:] = 0.0
        axes, state[[W, S, D]] = turned_ellipse(rng)
        for side in range(4):
            frame = outermost(sight, state, side, (axes @ circle).T)
            for off, most in ((0.0, 2e-9), (1e-3, 1e-6), (-1e-3, 1e-6)):
                row = row_of(sight, state[: len(STATES)], side, frame + off)
                assert row is not None and row.predicted == pytest.approx(frame, abs=most)


@pytest.mark.parametrize("change", [{}, LENS], ids=["pinhole", "lens"])
def test_derivatives_are_those_of_the_outermost_point(change: dict[str, float]) -> None:
    """By central differences of the points of both rims, projected one by one."""
    rng = np.random.default_rng(2)
    images = shown(change)
    step = np.full(UNKNOWNS, 1e-4)
    step[[Q, W, E, S]], step[PX:] = [1e-6, 1e-4, 1e-4, 1e-4], 0.05
    size = np.ones(UNKNOWNS)  # derivatives by each
    size[Q], size[D], size[PX:] = 100.0, 0.2, 0.005
    size[[W, S]] = (1.5, 3.0) if change else 1.0  # most sensitive to the direction of a bent side, which takes one step
    for sight in images:
        state = some_state(rng, images)
        state[PX:] = 0.0
        for side in range(4):
            frame = framed(sight, state, side)
            moved = [(framed(sight, state + m, side), framed(sight, state - m, side)) for m in np.diag(step)]
            slope = np.array([after - before for after, before in moved]) / (2 * step)
            row = row_of(sight, state[: len(STATES)], side, frame)
            assert row is not None and row.predicted == pytest.approx(frame, abs=1e-6)
            assert row.slope / size == pytest.approx(slope / size, abs=2e-5)


def test_sides_that_are_measured() -> None:
    nan = np.nan
    boxes = np.array([
        [100.0, 200.0, 300.0, 400.0],  # valid
        [300.0, 200.0, 100.0, 400.0],  # out of order
        [100.0, 400.0, 300.0, 200.0],
        [30.0, 200.0, 300.0, 400.0],  # left near the border: cut
        [10.0, 5.0, 300.0, 475.0],  # left, top and bottom at it
        [nan, 200.0, 300.0, 400.0],
        [100.0, 20.0, 300.0, 460.0],  # top and bottom near it: not cut, but doubtful
    ])  # fmt: skip
    sides, cut = measured_sides(boxes, (1000.0, 480.0), ErrorModel())
    assert np.isfinite(sides).sum(1).tolist() == [4, 0, 0, 4, 1, 3, 4]
    assert cut.tolist() == [False, True, True, True, True, True, False]
    _, cut = measured_sides(boxes, (1000.0, 480.0), ErrorModel(), rolled=np.arange(7) > 5)
    assert cut.tolist() == [False, True, True, True, True, True, True]
    assert np.isfinite(measured_sides(boxes, (0.0, 0.0), ErrorModel())[0]).sum(1).tolist() == [4, 0, 0, 4, 4, 3, 4]


def test_sides_that_may_be_cut() -> None:
    boxes = np.array([
        [100.0, 200.0, 300.0, 400.0],
        [100.0, 20.0, 300.0, 460.0],  # top and bottom near the border
        [100.0, 20.0, 300.0, 90.0],  # the bottom is far from it
        [100.0, 20.0, 300.0, np.nan],  # the box's height is not known
    ])  # fmt: skip
    doubtful = doubtful_sides(boxes, 480.0, ErrorModel())
    assert doubtful[:, [BOX_TOP, BOX_BOTTOM]].tolist() == [[False, False], [True, True], [False, False], [False, False]]
    assert not doubtful[:, [BOX_LEFT, BOX_RIGHT]].any()
    assert not doubtful_sides(boxes, 480.0, ErrorModel(box_noise_rel=0.0)).any()
    assert not doubtful_sides(boxes, 0.0, ErrorModel()).any()


# -------------------------------------------------------------------------------------------------------- the bound


def noise(times: float, **change: float) -> ErrorModel:
    """Settings with only the noise that counts for the bound."""
    usual = ErrorModel(
        box_noise_rel=0.0, height_white_sd_m=0.0, terrain_height_sd_m=0.0, terrain_slope_sd=0.0, disc=True
    )  # fmt: skip
    names = (
        "box_noise_px", "attitude_bias_sd_deg", "attitude_white_sd_deg", "height_bias_sd_m", "velocity_bias_sd_m_s",
    )  # fmt: skip
    return replace(usual, **{name: times * getattr(usual, name) for name in names}, **change)


def test_a_bound_grows_with_the_noise() -> None:
    flight = box_flight(MAST, replace(EXACT, roll_deg=10.0), 1)
    once, twice = (
        bound_of(flight, noise(1.0, truncation_noise_rel=0.5)),
        bound_of(flight, noise(2.0, truncation_noise_rel=1.0)),
    )
    assert twice[ESTIMATED] == pytest.approx(2 * once[ESTIMATED], rel=1e-3) and np.isnan(once[[2, 4]]).all()
    shorter = bound_of(flight.first(len(flight.time_s) // 2), noise(1.0))
    assert (shorter[ESTIMATED] > 1.2 * once[ESTIMATED]).all()


def test_a_correlated_error_is_not_a_white_one() -> None:
    """A correlation time shorter than the image interval lets an error average out; a long one does not, but
    differences cancel the error.
    """
    flight = box_flight(MAST, replace(EXACT, roll_deg=10.0), 1)
    still = {
        "attitude_bias_sd_deg": 0.0,
        "attitude_white_sd_deg": 0.0,
        "velocity_bias_sd_m_s": 0.0,
        "height_bias_sd_m": 0.0,
    }
    configured = replace(noise(1.0), box_noise_px=0.1, box_noise_rel=0.05, **still)
    white, usual, long = (
        bound_of(flight, replace(configured, box_correlation_time_s=tau)) for tau in (0.0, 1.2, 100.0)
    )
    equal = bound_of(flight, replace(configured, box_correlation_time_s=1e-3))
    assert equal[ESTIMATED] == pytest.approx(white[ESTIMATED], rel=1e-6)
    assert usual[Z0] > 1.5 * white[Z0] and long[Z0] < usual[Z0]


@pytest.mark.parametrize("roll", [2.0, 10.0])
def test_a_recursive_estimator_does_not_undercut_the_bound(monkeypatch: pytest.MonkeyPatch, roll: float) -> None:
    """With the error sources that both model: no path error, no white part of a side's error."""
    monkeypatch.setattr(prism_filter, "SCATTER_SHARE", 0.0)
    configured = replace(noise(1.0), velocity_bias_sd_m_s=0.0, position_walk_sd_m=0.0, box_noise_px=2.0)
    flight = box_flight(MAST, replace(EXACT, roll_deg=roll), 1)
    ratio = (follow(flight, configured).sigma[-1] / bound_of(flight, configured))[ESTIMATED]
    assert (ratio > 0.99).all() and (ratio < 1.5).all(), ratio


def test_the_bound_is_that_of_a_mast() -> None:
    assert (true_state(box_flight(MAST, EXACT, 1))[[S, D]] == 0.0).all()
    with pytest.raises(ValueError, match="disc"):
        bound_of(box_flight(BUILDING, EXACT, 1), ErrorModel())
