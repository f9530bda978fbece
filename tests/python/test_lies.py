"""The search for wrong answers with small sigmas ("lies"): its simulator against independent properties, its judge
against planted lies, the command."""

from __future__ import annotations

import copy
import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import goe
import numpy as np
import pytest
from bench.__main__ import main
from bench.lies import (
    answers,
    approach,
    command,
    errors,
    evolve,
    genes,
    goals,
    motion,
    optics,
    search,
    seen,
    shapes,
    shrink,
    world,
)
from bench.lies.decode import decode
from bench.lies.finds import CAUSES, COLUMNS, FRESH_MOST_S, GONE_MOST, KINDS, SAFE_MOST, WARNS_LEAST, find
from bench.lies.genes import BASE, BOXES, MIXES, OUTLINES, POINTS, Params
from bench.lies.judge import BOX, DISC, PRISM, QUANTITIES, judge
from bench.lies.record import write
from bench.lies.search import Flown
from bench.lies.shapes import Solid
from bench.lies.show import from_json, misses
from bench.lies.shrink import Want
from bench.lies.tally import Example, Tally, tally_of
from ci.evidence import lies as evidence_lies
from goe_tools.logs.obslog import Frame, read_log
from goe_tools.spread import ALONE
from goe_tools.view.answers import Options, settings_of

RNG_SEED = 20
QUIET = ("constant_scale", "pose_scale", "pixel_scale")
NO_MISHAPS = {
    "unknown": 0, "reset_kind": 0, "refused": 0, "runs": 0, "every_n": 0, "missed_share": 0.0, "partly_share": 0.0,
    "gap_s": 0.0, "pre_turn": 0,
}  # fmt: skip


def params(mix: int, count: int, seed: int = 1, **changes: float) -> Params:
    p = decode(genes.draw(count, [mix], np.random.default_rng(seed)))
    return shrink.changed(p, changes)


def quiet(mix: int, count: int, seed: int = 1, **changes: float) -> Params:
    """Neither noise nor faults."""
    return params(mix, count, seed, **dict.fromkeys(QUIET, 0.0), **NO_MISHAPS, **changes)


def solids(count: int, rng: np.random.Generator) -> Solid:
    """Solids around the origin, where the camera is, but not over it."""
    angle, away = rng.uniform(0, 2 * np.pi, count), rng.uniform(25.0, 80.0, count)
    is_round = rng.random(count) < 0.4
    half = rng.uniform(1.0, 12.0, (count, 2))
    half[is_round, 1] = half[is_round, 0]
    center = away[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    foot = rng.uniform(2.0, 40.0, count)
    return Solid(is_round, center, half, rng.uniform(0, np.pi, count), foot, foot - rng.uniform(2.0, 60.0, count))


def views(solid: Solid, rng: np.random.Generator, lens: bool) -> optics.View:
    """Cameras that look roughly towards the middle, rolled and pitched."""
    count = len(solid.round)
    yaw = np.arctan2(solid.center[:, 1], solid.center[:, 0]) + rng.uniform(-0.2, 0.2, count)
    angles = [yaw, rng.uniform(-0.4, 0.1, count), rng.uniform(-0.5, 0.5, count)]
    axes = optics.mounted(*(np.degrees(angle) for angle in angles))
    bends = rng.uniform(-0.05, 0.05, (count, 4)) * np.array([1.0, 0.3, 0.02, 0.02]) * lens
    same = np.ones((count, 1))
    return optics.View(
        axes, same * [800.0, 820.0], same * [640.0, 480.0], same * [1280.0, 960.0], bends, 3.0 * same[:, 0]
    )


# ------------------------------------------------------------------------------------------------------- the simulator


def test_a_point_lies_where_hand_calculation_puts_it() -> None:
    one = np.ones((1, 1))
    level = optics.View(
        optics.mounted(np.zeros(1), np.zeros(1), np.zeros(1)), one * [1000.0, 900.0], one * [640.0, 480.0],
        one * [1280.0, 960.0], np.zeros((1, 4)), np.array([2.0]),
    )  # fmt: skip
    pixels, ahead = optics.project(level, np.array([[[100.0, 10.0, 5.0], [-100.0, 10.0, 5.0]]]))
    assert ahead.tolist() == [[True, False]]
    np.testing.assert_allclose(pixels[0, 0], [740.0, 525.0])
    left = optics.mounted(np.array([-90.0]), np.zeros(1), np.zeros(1))[0]  # the camera looks left
    np.testing.assert_allclose(left @ [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], atol=1e-12)
    up = optics.mounted(np.zeros(1), np.array([30.0]), np.zeros(1))[0]  # positive pitch is up
    np.testing.assert_allclose(up @ [np.cos(np.pi / 6), 0.0, -0.5], [0.0, 0.0, 1.0], atol=1e-12)
    tilted = optics.mounted(np.zeros(1), np.zeros(1), np.array([90.0]))[0]  # its right is the body's down
    np.testing.assert_allclose(tilted @ [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], atol=1e-12)


def test_the_lens_is_opencvs() -> None:
    k1, k2, p1, p2, x, y = -0.2, 0.05, 0.003, -0.002, 0.4, -0.3
    u, v = optics.bent(np.array(x), np.array(y), np.array([k1, k2, p1, p2]))
    # docs.opencv.org: x'' = x' (1 + k1 r2 + k2 r4) + 2 p1 x' y' + p2 (r2 + 2 x'2), and y'' with p1, p2 exchanged
    assert u == pytest.approx(0.4 * (1 - 0.2 * 0.25 + 0.05 * 0.0625) + 2 * 0.003 * -0.12 - 0.002 * (0.25 + 0.32))
    assert v == pytest.approx(-0.3 * (1 - 0.2 * 0.25 + 0.05 * 0.0625) + 0.003 * (0.25 + 0.18) - 2 * 0.002 * -0.12)


def test_a_quaternion_turns_as_its_rotation_and_its_error_is_about_body_axes() -> None:
    rng = np.random.default_rng(RNG_SEED)
    angles, small = rng.uniform(-1.2, 1.2, (50, 3)), rng.normal(0.0, 1e-4, (50, 3))
    w, x, y, z = world.quaternion(angles, small).T
    turned = np.stack([  # the quaternion's textbook formula
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], 1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], 1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1),
    ], 1)  # fmt: skip
    true = motion.rotation(*angles.T)
    error = np.swapaxes(true, 1, 2) @ turned
    np.testing.assert_allclose(np.stack([error[:, 2, 1], error[:, 0, 2], error[:, 1, 0]], 1), small, atol=1e-7)


def test_visible_corners_are_those_that_no_wall_hides() -> None:
    solid = solids(300, np.random.default_rng(RNG_SEED))
    found, there = shapes.visible_corners(solid)
    corners, axes = solid.corners(), solid.axes()
    steps = np.linspace(0.05, 0.9995, 400)
    for i in np.flatnonzero(~solid.round):
        path = corners[i][:, None] * steps[:, None]  # from the camera, at the origin, to each corner
        own = np.abs((path - solid.center[i]) @ axes[i].T)
        free = corners[i][~np.any(np.all(own < solid.half[i] - 1e-9, 2), 1)]
        shown = found[i][there[i]]
        assert len(shown) == len(free) in (2, 3)
        assert all(np.hypot(*(free - corner).T).min() < 1e-9 for corner in shown)
        angle = shapes.bearings(solid, found)[i][there[i]]
        assert np.all(np.diff(angle) > 0.0)  # in image order


@pytest.mark.parametrize("lens", [False, True], ids=["pinhole", "lens"])
def test_the_upright_box_touches_the_silhouette(lens: bool) -> None:
    rng = np.random.default_rng(RNG_SEED + lens)
    solid = solids(200, rng)
    seen_by = views(solid, rng, lens)
    touching, whole = seen._touching(seen_by, solid)
    ring = np.where(solid.round[:, None, None], shapes.rim_points(solid, 720), np.nan)
    corners, steps = solid.corners(), np.linspace(0, 1, 180, endpoint=False)
    edges = np.concatenate([corners + (np.roll(corners, -1, 1) - corners) * s for s in steps], 1)
    ring = np.where(solid.round[:, None, None], ring, edges)
    levels = [solid.foot + (solid.roof - solid.foot) * s for s in (0.0, 0.3, 0.7, 1.0)]
    pixels, ahead = optics.project(seen_by, np.concatenate([shapes.upright(ring, level) for level in levels], 1))
    good = whole & ahead.all(1)
    assert good.sum() > 100
    box = touching[:, np.arange(4), seen.SIDE_AXIS][good]
    dense = np.concatenate([pixels[good].min(1), pixels[good].max(1)], 1)
    reach = np.array([1, 1, -1, -1]) * (box - dense)  # positive: the dense outline reaches farther
    inside = optics.in_image(seen_by, touching)[good]
    assert inside.sum() > 200
    assert reach[inside].max() < (0.1 if lens else 1e-9) and reach[inside].min() > -0.1


def test_the_sides_of_a_cylinder_are_where_lines_touch_it() -> None:
    solid = solids(200, np.random.default_rng(RNG_SEED)).take(np.arange(200))
    posts = shapes.sides(solid)[solid.round]
    radius = posts - solid.center[solid.round][:, None]
    np.testing.assert_allclose(np.hypot(*np.moveaxis(radius, -1, 0)), solid.half[solid.round][:, :1].repeat(2, 1))
    np.testing.assert_allclose(np.sum(radius * posts, -1), 0.0, atol=1e-9)


def test_errors_are_as_configured() -> None:
    p = params(BOXES, 400, attitude_bias=0.7, attitude_white=0.2, attitude_drift=0.0, height_bias=0.3, ground=0.4,
               ground_drawn=1, height_white=0.0, velocity_bias=0.0, position_walk=0.5, position_white=0.0)  # fmt: skip
    counts = p["images"] + motion.pre_images(p)
    draws = errors.draw(p["seed"], counts)
    t = np.tile(np.arange(draws.series.shape[1]) * 0.25, (400, 1))
    found = errors.pose_errors(p, draws, t, np.zeros(t.shape, bool))
    degrees = np.degrees(found.attitude[:, :30])
    assert degrees.mean(1).std() == pytest.approx(0.7, rel=0.1)
    assert (degrees - degrees.mean(1, keepdims=True)).std() == pytest.approx(0.2, rel=0.1)
    assert found.height[:, 0].std() == pytest.approx(0.5, rel=0.15)
    walked = found.position[:, 16] - found.position[:, 0]
    assert walked.std() == pytest.approx(0.5 * np.sqrt(4.0), rel=0.1)
    fading = errors.correlated(np.random.default_rng(1).standard_normal((500, 30, 4)), np.full((500, 30), 0.8))
    assert fading.std() == pytest.approx(1.0, rel=0.03)
    assert np.mean(fading[:, 5:] * fading[:, :-5]) == pytest.approx(0.8**5, abs=0.05)


def test_a_closest_approach_is_that_of_many_small_steps() -> None:
    rng = np.random.default_rng(RNG_SEED)
    solid = solids(400, rng)
    start, velocity = -solid.center, rng.uniform(-15, 15, (400, 2))
    towards = rng.random(400) < 0.6
    velocity[towards] = (solid.center + rng.normal(0, 10, (400, 2)))[towards] * 0.2
    found = approach.closest(solid.round, solid.axes(), solid.half, start, velocity)
    times = np.linspace(0.0, 30.0, 30001)
    for i in range(400):
        moved = Solid(*(np.repeat(getattr(solid, n)[i : i + 1], len(times), 0) for n in Solid.__dataclass_fields__))
        moved.center = -(start[i] + velocity[i] * times[:, None])
        away = np.maximum(moved.distance(), 0.0)
        if found.time_s[i] < 29.0:
            assert found.dcpa_m[i] == pytest.approx(away.min(), abs=0.02)
            first = times[np.argmax(away <= away.min() + 1e-6)]
            slow = np.hypot(*velocity[i]) < 1.0
            assert slow or away[np.searchsorted(times, found.time_s[i])] == pytest.approx(away.min(), abs=0.05)
            assert found.dcpa_m[i] > 0.0 or found.time_s[i] == pytest.approx(first, abs=0.01)
            inside = times[away <= 0.0]
            if len(inside) and inside[-1] < 29.0:
                assert found.leaves_s[i] == pytest.approx(inside[-1], abs=0.01)


def test_the_library_finds_cylinders_without_noise() -> None:
    flown = search.fly(quiet(POINTS, 60, top_is_highest=0))
    e = flown.found.estimates
    answered = (e["method"] == 2) & ((e["valid"] & 1) != 0) & ~e["suspect"]
    assert answered.mean() > 0.3
    z, x = QUANTITIES.index("z"), QUANTITIES.index("x")
    off = np.abs(flown.judged.error[answered]) / np.hypot(e["x_m"], e["z_m"])[answered, None]
    assert np.median(off[:, z]) < 0.003 and np.median(off[:, x]) < 0.001
    assert np.nanpercentile(np.abs(flown.judged.ratio[answered][:, z]), 90) < 1.0


# ----------------------------------------------------------------------------------------------------------- the judge


@pytest.fixture(scope="module")
def honest() -> Flown:
    """Answers equal to the truth, with sigmas, for collision courses with cuboids."""
    p = quiet(
        BASE,
        40,
        offset=0.2,
        margin_m=10.0,
        plan_turn_deg=0.0,
        plan_climb_m_s=0.0,
        plan_hold=1000,
        turn_deg_s=0.0,
        heading_auto=0,
    )
    p["kind"][:] = genes.STRAIGHT
    p["height_m"] = np.minimum(p["height_m"], p["h_m"])
    flown = world.fly(p)
    return search.look_at(flown, truthful(flown))


def truthful(flown: world.World) -> answers.Answers:
    """Answers of an error-free estimator, computed from the truth by the definitions of goe.h."""
    n = len(flown.flight)
    found = answers.Answers(
        np.zeros(n, np.int32), np.zeros(n, goe.ESTIMATE), np.zeros((n, answers.RULES), np.int32),
        np.zeros((n, answers.RULES), goe.HAZARD),
    )  # fmt: skip
    e, own = found.estimates, flown.solid.take(flown.flight)
    e["method"], e["model"], e["valid"], e["fresh"], e["images_used"] = 2, 4, 0x3F, True, np.arange(n) + 1
    heading = np.degrees(own.heading)
    e["trajectory_heading_deg"] = heading - 20.0
    side, ahead = np.radians(heading), np.radians(heading - 20.0)
    along = np.stack([np.cos(side), np.sin(side)], 1)
    spot = own.center - along * own.half[:, :1]
    first = search.judge.first_seen(flown, search.judge.track_begins(flown))
    for name, camera in (("x0_m", flown.camera[first]), ("x_m", flown.camera)):
        to = spot - camera[:, :2]
        e[name] = to[:, 1] * np.cos(ahead) - to[:, 0] * np.sin(ahead)
        e["z" + name[1:]] = to[:, 0] * np.cos(ahead) + to[:, 1] * np.sin(ahead)
    e["width_m"], e["length_m"], e["orientation_deg"] = 2 * own.half[:, 1], 2 * own.half[:, 0], 20.0
    e["height_m"] = flown.height_m[flown.flight]
    e["center_north_m"], e["center_east_m"] = (own.center + (flown.reported - flown.vehicle)[:, :2]).T
    for name in goe.ESTIMATE["sigma"].names or ():
        e["sigma"][name] = 0.5
    h, numbers = found.hazards, answers.rule_numbers(flown.p)[flown.flight]
    met = search.judge.meet(flown, np.arange(n), np.zeros((n, answers.RULES)))
    h["dcpa_m"], h["clearance_m"], h["tcpa_s"], h["has_clearance"] = met.dcpa_m, met.clearance_m, met.time_s, True
    h["dcpa_sd_m"], h["clearance_sd_m"], h["tcpa_sd_s"] = 0.5, 0.5, 0.1
    h["conflict_probability"] = (met.dcpa_m < numbers[..., 0]) & (met.clearance_m < numbers[..., 1])
    return found


def judged(flown: Flown, change: Callable[[answers.Answers], None]) -> Flown:
    found = copy.deepcopy(flown.found)
    change(found)
    return search.look_at(flown.world, found)


def test_the_truth_is_no_lie(honest: Flown) -> None:
    assert np.nanmax(honest.lies.ratio) < 0.1
    assert np.isfinite(honest.lies.ratio[:, : len(QUANTITIES)]).all()
    assert honest.judged.violated.mean() > 0.3
    assert not honest.lies.false_safety.any() and not honest.lies.vanished.any()


def test_a_hazard_of_a_cylinder_counts_by_a_disc_and_by_a_prism(honest: Flown) -> None:
    cylinders, found = copy.copy(honest.world), copy.deepcopy(honest.found)
    cylinders.solid = replace(cylinders.solid, round=np.ones_like(cylinders.solid.round))
    for model, counts in ((DISC, True), (PRISM, True), (BOX, False)):
        found.estimates["model"] = model
        time = find(cylinders, found, honest.judged).ratio[:, COLUMNS.index("time")]
        assert np.isfinite(time).any() == counts


def test_names_of_sides_may_be_exchanged(honest: Flown) -> None:
    def turn(found: answers.Answers) -> None:
        e = found.estimates
        own = honest.world.solid.take(honest.world.flight)
        along = own.heading - np.pi / 2  # the other side edge
        spot = own.center - np.stack([np.cos(along), np.sin(along)], 1) * own.half[:, 1:]
        to, ahead = spot - honest.world.camera[:, :2], np.radians(e["trajectory_heading_deg"].astype(float))
        e["orientation_deg"] = -70.0
        e["width_m"], e["length_m"] = e["length_m"].copy(), e["width_m"].copy()
        e["x_m"] = to[:, 1] * np.cos(ahead) - to[:, 0] * np.sin(ahead)
        e["z_m"] = to[:, 0] * np.cos(ahead) + to[:, 1] * np.sin(ahead)

    ratio = judged(honest, turn).lies.ratio
    names = ["x", "z", "width", "length", "orientation", "height"]
    assert np.nanmax(ratio[:, [QUANTITIES.index(name) for name in names]]) < 0.1


@pytest.mark.parametrize(
    ("field", "column"),
    [("x0_m", "x0"), ("z_m", "z"), ("width_m", "width"), ("length_m", "length"), ("height_m", "height"),
     ("orientation_deg", "orientation"), ("center_east_m", "east")],
)  # fmt: skip
def test_a_planted_error_is_found(honest: Flown, field: str, column: str) -> None:
    def shift(sigmas: float, suspect: bool = False, method: int = 2) -> np.ndarray:
        def change(found: answers.Answers) -> None:
            found.estimates[field] += sigmas * 0.5
            found.estimates["suspect"], found.estimates["method"] = suspect, method

        return judged(honest, change).lies.confident[:, COLUMNS.index(column)]

    assert shift(6.5).all() and shift(-6.5).all()
    assert not shift(5.5).any()
    assert not shift(6.5, suspect=True).any() and not shift(6.5, method=1).any()


@pytest.mark.parametrize(("field", "column", "sd"), [("dcpa_m", "miss", 0.5), ("clearance_m", "clearance", 0.5)])
def test_a_planted_error_of_a_hazard_is_found(honest: Flown, field: str, column: str, sd: float) -> None:
    def change(found: answers.Answers) -> None:
        found.hazards[field] += 7.0 * sd

    assert judged(honest, change).lies.confident[:, COLUMNS.index(column)].all()


def test_false_safety_is_found_and_doubt_counted_apart(honest: Flown) -> None:
    def safe(**more: float) -> Flown:
        def change(found: answers.Answers) -> None:
            found.hazards["conflict_probability"] = 0.009
            for name, value in more.items():
                found.estimates[name] = value

        return judged(honest, change)

    assert np.array_equal(safe().lies.false_safety, honest.judged.violated)
    for more in ({"suspect": 1.0}, {"age_s": 1.5}):
        found = safe(**more).lies
        assert not found.false_safety.any() and np.array_equal(found.doubted, honest.judged.violated)


def one_image(honest: Flown, change: Callable[[answers.Answers, int], None]) -> tuple[Flown, int]:
    """The fifth image of a flight that warned before is changed."""
    flown = honest.world
    warns = honest.judged.violated[:, 0] & (honest.found.hazards["conflict_probability"][:, 0] > 0.5)
    k = next(int(s) + 5 for s in flown.start[:-1] if warns[s + 4 : s + 6].all() and flown.detected[s + 4 : s + 6].all())
    return judged(honest, lambda found: change(found, k)), k


def test_a_warning_that_vanishes_is_found_with_its_cause(honest: Flown) -> None:
    def quietly(found: answers.Answers, k: int) -> None:
        found.hazards["conflict_probability"][k] = 0.04

    def held(found: answers.Answers, k: int) -> None:
        quietly(found, k)
        found.status[k] = 3

    def refused(found: answers.Answers, k: int) -> None:
        found.hazard_status[k], found.status[k] = 2, -10

    def restarted(found: answers.Answers, k: int) -> None:
        quietly(found, k)
        found.estimates["images_used"][k] = 1

    for change, cause in (
        (quietly, "other"),
        (held, "held"),
        (refused, "refused image"),
        (restarted, "filter restart"),
    ):
        flown, k = one_image(honest, change)
        assert np.flatnonzero(flown.lies.vanished.any(1)).tolist() == [k]
        assert CAUSES[flown.lies.cause[k, 0]] == cause
        counts = tally_of(flown.world, flown.found, flown.judged, flown.lies, 0).counts
        assert counts["vanished", "base", cause] == counts["vanished", "base", "any"] == 1
        assert any("vanished in 1 flights" in line for line in misses(counts))


def test_an_unknown_reset_may_end_the_track_and_not_the_truth(honest: Flown) -> None:
    def silent(found: answers.Answers, k: int) -> None:
        found.hazard_status[k] = 2

    flown, k = one_image(honest, silent)
    assert CAUSES[flown.lies.cause[k, 0]] == "other"
    flown.world = copy.copy(flown.world)
    flown.world.unknown = np.arange(len(flown.world.flight)) == k
    again = find(flown.world, flown.found, judge(flown.world, flown.found))
    assert CAUSES[again.cause[k, 0]] == "unknown reset" and again.vanished[k, 0]
    flown.world.unknown = np.arange(len(flown.world.flight)) == k - 1
    taken = find(flown.world, flown.found, judge(flown.world, flown.found))
    assert CAUSES[taken.cause[k, 0]] == "other"
    flown.world.refused = flown.world.unknown  # the next image carries the counter
    refused = find(flown.world, flown.found, judge(flown.world, flown.found))
    assert CAUSES[refused.cause[k, 0]] == "unknown reset"


# ---------------------------------------------------------------------------------------------- shrinking and breeding


def lying(flown: world.World) -> answers.Answers:
    """The library, but from the eighth image of a flight on x is wrong by 30 m with a small sigma."""
    found = TRUE_FLY(flown)
    late = np.arange(len(flown.flight)) - flown.start[flown.flight] >= 7
    found.estimates["valid"] |= np.where(late, 1, 0).astype(np.uint32)
    found.estimates["method"], found.estimates["suspect"] = 2, False
    found.estimates["x_m"][late] += 1000.0
    found.estimates["sigma"]["x_m"][late] = 1.0
    return found


TRUE_FLY = answers.fly


def image_of(frame: Frame) -> goe.Image:
    """The image that goe_replay makes of a row."""
    pose = goe.Pose(
        frame.time_us or 0, frame.position_m, frame.height_m, frame.attitude, frame.reset_count, frame.reset_delta_m
    )
    points = {name: goe.Pixel(*pixel) for name in goe.POINTS if (pixel := getattr(frame, name)) is not None}
    box = None if frame.box_px is None else goe.BoundingBox(*frame.box_px)
    return goe.Image(pose, **points, bounding_box=box, camera=frame.camera)


def test_shrinking_keeps_the_find_and_leaves_the_rest_out(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(answers, "fly", lying)
    p = params(OUTLINES, 1, seed=4, missed_share=0.2, gap_s=1.0, k1=-0.05, refused=0, unknown=0, pre_turn=0)
    want = Want(KINDS[0], "x")
    before = search.fly(p)
    assert shrink.hits(before, want).any()
    small = shrink.shrink(p, want)
    assert shrink.hits(search.look_at(small), want).any()
    assert len(small.flight) == 8 < len(before.world.flight)
    assert not any(small.p[name][0] for name in (*QUIET, "missed_share", "gap_s", "k1"))
    text = write(tmp_path / "find", small, want)
    assert text["what"] == "x" and text["image"] == 7 and text["wrong"].endswith("sigma off")
    assert json.loads((tmp_path / "find" / "find.json").read_text())["plan"]["margin_m"] > 0.0


def test_a_find_is_the_same_log(tmp_path: Path) -> None:
    p = params(BOXES, 1, seed=9, reset_kind=3, two_cameras=0, refused=0, unknown=0, pre_turn=0)
    flown = world.fly(p)
    small = shrink.rounder(flown, Want(KINDS[0], "x"))  # no find: left as it is
    found = answers.fly(small)
    found.estimates["valid"][:] = 1
    lie = search.look_at(small, found)
    lie.lies.ratio[5, COLUMNS.index("x")] = 7.0
    log = tmp_path / "log"
    search_look = search.look_at
    try:
        search.look_at = lambda *_: lie  # type: ignore[assignment]
        write(log, small, Want(KINDS[0], "x"))
    finally:
        search.look_at = search_look
    read = read_log(log)
    assert len(read.frames) == len(small.flight) and list(read.truth) == [1]
    estimator = goe.Estimator(answers.settings(small, 0))
    replayed = [estimator.update(image_of(frame)) for frame in read.frames]
    assert [int(e.status) for e in replayed] == TRUE_FLY(small).status.tolist()
    truth, center = read.truth[1], small.solid.center[0]
    assert truth.center_n_m - p["origin_n_m"][0] == pytest.approx(center[0])


def test_breeding_goes_on_from_the_worst(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "BATCH", 40)
    monkeypatch.setattr(evolve, "BATCH", 40)
    monkeypatch.setattr(evolve, "PER_MIX", 40)
    monkeypatch.setattr(evolve, "SURVIVORS", 8)
    flights = search.flights_of(search.Task(1, 1 << 30, 40, (BASE,)))
    scored = evolve.score(flights)
    parents = evolve.survivors(flights, scored)
    assert len(parents) == 8
    again = evolve.score(parents).score
    assert again.max() == scored.score.max()
    young = evolve.children(parents, 30, np.random.default_rng(1))
    assert len(young) == 30 and (young.unit >= 0.0).all() and (young.unit <= 1.0).all()
    one, other = (evolve.evolve(1, [BASE], 1, ALONE) for _ in range(2))
    assert {key: best.score for key, best in one.items()} == {key: best.score for key, best in other.items()}
    assert evolve.evolve(1, [BASE], 1, ALONE).keys() >= evolve.evolve(1, [BASE], 0, ALONE).keys()


# ------------------------------------------------------------------------------------------------------ recorded finds

LIES = Path(__file__).parents[1] / "finds"
KNOWN = {row["find"]: row for row in csv.DictReader((LIES / "known.csv").read_text(encoding="utf-8").splitlines())}


def replayed(folder: Path, found: dict[str, Any]) -> list[tuple[goe.Estimate, goe.Hazard | None]]:
    """The answer to each image of a log, with the options and the plan of its find.json."""
    log = read_log(folder)
    words = found["replay"].split()
    named = dict(word.split("=") for word in words if not word.startswith("--") and "=" in word)
    model = next((word.partition("=")[2] for word in words if word.startswith("--model=")), "auto")
    options = Options(model=model, settings={name: float(value) for name, value in named.items()})
    estimator, plan = goe.Estimator(goe.Settings.from_names(settings_of(log, options))), goe.Intent(**found["plan"])
    return [(estimator.update(image_of(frame)), estimator.decide(plan)[1]) for frame in log.frames]


@pytest.mark.parametrize("folder", sorted(LIES.glob("*/")), ids=lambda folder: str(folder.name))
def test_a_recorded_find_is_cured_or_listed(folder: Path) -> None:
    """A find that is cured is removed from known.csv; its log stays."""
    found = json.loads((folder / "find.json").read_text(encoding="utf-8"))
    answered, k = replayed(folder, found), found["image"]
    (estimate, now), (_, before) = answered[k], answered[k - 1]
    figure = "no answer" if now is None else f"{now.conflict_probability:.3g}"
    if found["kind"] == "vanished":
        warned = before is not None and before.conflict_probability >= WARNS_LEAST
        lie = warned and (now is None or now.conflict_probability < GONE_MOST)
    else:
        trusted = not estimate.suspect and estimate.age_s <= FRESH_MOST_S
        lie = now is not None and now.conflict_probability < SAFE_MOST and trusted
    assert lie == (folder.name in KNOWN), f"now {figure}"
    if lie:
        recorded = KNOWN[folder.name]["figure"]
        assert recorded == figure or float(recorded) == pytest.approx(float(figure), abs=0.005)


def test_known_finds_have_logs_and_reasons() -> None:
    assert KNOWN.keys() <= {folder.name for folder in LIES.glob("*/")}
    assert all(len(row["reason"]) > 20 for row in KNOWN.values())


# --------------------------------------------------------------------------------------------------------- the command


def test_counts_do_not_depend_on_the_number_of_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [tmp_path / f"{jobs}.json" for jobs in (1, 2)]
    for jobs, file in zip((1, 2), files):
        assert main(["lies", "--flights", "620", "--seed", "3", "--jobs", str(jobs), "--json", str(file)]) == 0
    assert files[0].read_bytes() == files[1].read_bytes()
    printed = capsys.readouterr().out
    assert main(["lies", "--show", str(files[0])]) == 0
    assert capsys.readouterr().out == printed[: len(printed) // 2]
    assert "620 flights" in printed and "goals:" in printed and all(mix in printed for mix in MIXES)
    counts = json.loads(files[0].read_text())["counts"]
    assert counts["flights|points"] == 124 and counts["answered|points"] > 60


def test_finds_are_written_as_logs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(answers, "fly", lying)
    monkeypatch.setattr(command, "LOGS_MOST", 2)
    monkeypatch.setattr(command, "shrink", lambda p, _: world.fly(p))  # of another test
    for module in (search, evolve):
        monkeypatch.setattr(module, "BATCH", 30)
    monkeypatch.setattr(evolve, "PER_MIX", 30)
    words = ["lies", "--flights", "30", "--mix", "outlines", "--evolve", "1", "--jobs", "1", "--out", str(tmp_path)]
    assert main(words) == 0
    printed = capsys.readouterr().out
    assert "evolved" in printed and "outlines: confident, x: 10.00" in printed
    folders = sorted(tmp_path.iterdir())
    assert sum(not folder.name.startswith("bred-") for folder in folders) == 2
    assert (tmp_path / "bred-confident-outlines-x" / "frames.csv").exists()
    for folder in folders:
        found = json.loads((folder / "find.json").read_text())
        assert found["wrong"] in printed and len(read_log(folder).frames) > found["image"]


def test_lost_warnings_are_written_before_frequent_errors() -> None:
    tally = Tally()
    for kind, count in (("confident", 9), ("vanished", 1), ("vanished", 2), ("false safety", 5)):
        key = (kind, "base", f"{count}", "box", "cuboid", "0")
        tally.examples[key] = Example(0, 0, 0)
        tally.counts[("class", *key)] = count
    chosen = command._chosen(tally, 1, [BASE])
    assert [key[2] for key, _ in chosen.values()] == ["2", "1", "5", "9"]


def test_one_mix_for_some_seconds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "one.json"
    words = ["lies", "--mix", "points", "--seconds", "60", "--flights", "50", "--jobs", "1", "--json", str(file)]
    assert main(words) == 0
    found = json.loads(file.read_text())
    assert found["mixes"] == ["points"] and found["counts"]["flights|points"] == 50
    assert found["library"] == goe.FINGERPRINT


@pytest.mark.parametrize("text", ["", "{}", '{"format": 2, "counts": {}}', '{"format": 1, "counts": {"a": "b"}}'])
def test_a_file_of_something_else_is_refused(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "other.json"
    file.write_text(text)
    assert main(["lies", "--show", str(file)]) == 2
    assert "not written by lies --json" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--flights", "0"], ["--seed", "-1"], ["--evolve", "-1"]])
def test_bad_usage(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lies", *words]) == 2
    assert "too small" in capsys.readouterr().err


def test_the_evidence_lists_the_goals_by_mix() -> None:
    counts = {"flights|points": 1000, "confident|points|any": 4, "flights|base": 1000, "vanished|base|any": 1}
    rows = {row.what: row for row in evidence_lies.rows_of(counts, ["points", "base"])}
    assert rows["flights"].figure == "2,000"
    assert rows["points: flights with a confident error, > 6 sigma"].met is False
    assert rows["base: flights with a confident error, > 6 sigma"].met is True
    assert rows["... with a warning that vanished, of 1,000"].met is False  # of the last mix


# --------------------------------------------------------------------------------------------------------- the record


def test_the_page_has_the_table_of_the_record() -> None:
    about, counts = from_json(goals.RECORD)
    page = Path(goals.__file__).with_name("README.md")
    assert goals.BLOCK.of(page) == goals.block(about, counts)
    assert sum(counts["flights", mix] for mix in MIXES) == 1_000_000


def test_each_class_of_the_record_has_a_reason_and_each_reason_a_class() -> None:
    _, counts = from_json(goals.RECORD)
    assert goals.unexplained(counts) == [] and goals.idle(counts) == []
    counts["class", "vanished", "base", "invented", "box", "cuboid", "0"] = 1
    assert goals.unexplained(counts) == [("vanished", "base", "invented")]
    for key in [key for key in counts if key[:3] == ("class", "confident", "points")]:
        del counts[key]
    assert goals.idle(counts) == [("confident", "points", f"{model} of a cylinder") for model in ("disc", "prism")]


def test_the_command_writes_the_table(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- lies: begin -->\n<!-- lies: end -->\nbehind\n", encoding="utf-8")
    assert main(["lies", "--show", str(goals.RECORD), "--page", str(page)]) == 0
    about, counts = from_json(goals.RECORD)
    assert goals.BLOCK.of(page) == goals.block(about, counts)
    assert main(["lies", "--page", str(page)]) == 2
