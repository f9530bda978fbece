"""The attack flights: simulated images against another projection, measured figures against outcomes with known
figures."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench.__main__ import main
from bench.attack import approach, errors, judging, rows, scenario, turns, view
from bench.attack import command as attack_command
from bench.attack.judging import BOX, DISC, PRISM, X0, Z0, Answers, Outcome
from bench.attack.scenario import Inputs, Scenario, Truth
from bench.attack.solids import Solid
from bench.optimum.goals import attack, hazard
from bench.optimum.goals.goal import NAMES, Goal
from bench.optimum.goals.work import QUICK
from goe_tools.library import METHODS, Track, named_settings, package, run, to_package
from goe_tools.models.coverage import coverage
from goe_tools.places import ROOT
from goe_tools.report import attack_lines

NAN = math.nan
EXACT = {
    "point_noise_px": 0.0, "box_noise_px": 0.0, "box_noise_rel": 0.0, "attitude_bias_sd_deg": 0.0,
    "attitude_white_sd_deg": 0.0,
    "velocity_bias_sd_m_s": 0.0, "position_walk_sd_m": 0.0, "height_bias_sd_m": 0.0,
}  # fmt: skip
BASE = Scenario(kind="box").by(**EXACT)
AMOUNT = replace(QUICK, attack=3, hazard=3)


# ----------------------------------------------------------------------------------- another projection, point by point


def turned(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """v rotated by q: the Hamilton product q v q*."""
    w, u = q[0], q[1:]
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def pixel(inputs: Inputs, image: int, point_ned: np.ndarray) -> np.ndarray:
    """The pixel of a point by the exact pose of the inputs. The camera looks along its yaw."""
    back = inputs.attitude[image] * [1.0, -1.0, -1.0, -1.0]
    forward, right, down = turned(back, point_ned - inputs.position_ned_m[image])
    yaw = math.radians(inputs.settings["camera.mount_yaw_deg"])
    ahead, aside = (
        forward * math.cos(yaw) + right * math.sin(yaw),
        right * math.cos(yaw) - forward * math.sin(yaw),
    )
    focal = inputs.settings["camera.fx_px"]
    return 640.0 + focal / ahead * np.array([aside, down])


def bearing(inputs: Inputs, image: int, shown: np.ndarray) -> float:
    """Bearing of a pixel's ray from north, rad."""
    x, y = (shown - 640.0) / inputs.settings["camera.fx_px"]
    yaw = math.radians(inputs.settings["camera.mount_yaw_deg"])
    ray = np.array([math.cos(yaw) - x * math.sin(yaw), math.sin(yaw) + x * math.cos(yaw), y])
    north, east, _ = turned(inputs.attitude[image], ray)
    return math.atan2(east, north)


def in_ned(inputs: Inputs, image: int, x: float, z: float, up: float) -> np.ndarray:
    """Position in an image of an obstacle's point, given relative to its middle in T's axes."""
    truth, t = inputs.truth, inputs.time_s[image]
    heading = math.radians(inputs.settings["heading_deg"])
    z_all, x_all = truth.middle_m[1] + z, truth.middle_m[0] + x
    north = z_all * math.cos(heading) - x_all * math.sin(heading) + truth.velocity_ned_m_s[0] * t
    east = z_all * math.sin(heading) + x_all * math.cos(heading) + truth.velocity_ned_m_s[1] * t
    ground = inputs.position_ned_m[0, 2] + inputs.height_m[0]
    return np.array([inputs.position_ned_m[0, 0] + north, inputs.position_ned_m[0, 1] + east, ground - up])


def box_corners(solid: Solid) -> list[tuple[float, float]]:
    b = solid.orientation_rad
    result = []
    for across, along in ((-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)):
        a, s = across * solid.width_m, along * solid.length_m
        result.append((a * math.cos(b) + s * math.sin(b), -a * math.sin(b) + s * math.cos(b)))
    return result


SCENE_OF = {
    "static": BASE,
    "mover": BASE.by(moves="diagonal", moves_m_s=5.0),
    "orbit": BASE.by(path="orbit"),
    "hover": BASE.by(path="hover"),
}


@pytest.mark.parametrize("name", SCENE_OF)
def test_points_and_boxes_are_those_of_the_projected_corners(name: str) -> None:
    for number in (1, 3):
        by_points = scenario.fly(SCENE_OF[name], number)
        by_boxes = scenario.fly(SCENE_OF[name].by(features="boxes"), number)
        for inputs in (by_points, by_boxes):
            checked = 0
            for k in np.flatnonzero(inputs.shown)[::9]:
                corners = box_corners(inputs.truth.solid)
                foot = np.array([pixel(inputs, k, in_ned(inputs, k, x, z, 0.0)) for x, z in corners])
                roof = np.array(
                    [pixel(inputs, k, in_ned(inputs, k, x, z, inputs.truth.solid.height_m)) for x, z in corners]
                )
                both = np.concatenate([foot, roof])
                if inputs.box_px is not None:
                    sides = np.array([*both.min(0), *both.max(0)])
                    assert inputs.box_px[k] == pytest.approx(np.clip(sides, 0.0, 1279.0), abs=1e-6)
                    checked += 1
                    continue
                for feature, wanted in ((view.LEFT, np.argmin(both[:, 0])), (view.RIGHT, np.argmax(both[:, 0]))):
                    if inputs.seen[k, feature]:
                        assert inputs.pixel_px[k, feature] == pytest.approx(both[wanted], abs=1e-6)
                        checked += 1
                base = inputs.pixel_px[k, [view.BASE_LEFT, view.BASE_NEAR, view.BASE_RIGHT]]
                base = base[inputs.seen[k, [view.BASE_LEFT, view.BASE_NEAR, view.BASE_RIGHT]]]
                assert all(np.abs(foot - point).max(1).min() < 1e-6 for point in base)
                bearings = [bearing(inputs, k, point) for point in base]
                assert (np.diff(np.unwrap(bearings)) > 0.0).all()
            assert checked >= 2


def test_three_base_corners_show_two_faces() -> None:
    """The near corner is the nearest one, left and right are its neighbors, and the fourth is hidden."""
    inputs = scenario.fly(BASE, 3)
    k = int(np.flatnonzero(inputs.seen[:, view.BASE_LEFT :].all(1))[0])
    corners = box_corners(inputs.truth.solid)
    ground = [in_ned(inputs, k, x, z, 0.0) for x, z in corners]
    near = int(np.argmin([np.hypot(*(g - inputs.position_ned_m[k])[:2]) for g in ground]))
    around = [pixel(inputs, k, ground[(near + step) % 4]) for step in (-1, 0, 1)]
    shown = inputs.pixel_px[k, view.BASE_LEFT :]
    assert shown[1] == pytest.approx(around[1], abs=1e-6)
    assert sorted(shown[[0, 2], 0]) == pytest.approx(sorted(a[0] for a in (around[0], around[2])), abs=1e-6)


def test_a_cylinder_is_projected_by_its_tangents_and_by_its_rims() -> None:
    scene = Scenario(kind="cylinder").by(**EXACT)
    inputs, boxed = scenario.fly(scene, 5), scenario.fly(scene.by(features="boxes"), 5)
    radius = 0.5 * inputs.truth.solid.width_m
    for k in np.flatnonzero(inputs.seen[:, [view.LEFT, view.RIGHT]].all(1))[::7]:
        to_middle = (in_ned(inputs, k, 0.0, 0.0, 0.0) - inputs.position_ned_m[k])[:2]
        away = float(np.hypot(*to_middle))
        middle = math.atan2(to_middle[1], to_middle[0])
        for feature, side in ((view.LEFT, -1.0), (view.RIGHT, 1.0)):
            off = (bearing(inputs, k, inputs.pixel_px[k, feature]) - middle + math.pi) % (2 * math.pi) - math.pi
            assert off == pytest.approx(side * math.asin(radius / away), abs=1e-9)
    for k in np.flatnonzero(boxed.shown)[::7]:
        angle = np.linspace(0.0, 2 * math.pi, 721)
        rim = np.array([
            pixel(boxed, k, in_ned(boxed, k, radius * math.sin(a), radius * math.cos(a), up))
            for a in angle for up in (0.0, boxed.truth.solid.height_m)
        ])  # fmt: skip
        sides = np.clip([*rim.min(0), *rim.max(0)], 0.0, 1279.0)
        assert boxed.box_px is not None and boxed.box_px[k] == pytest.approx(sides, abs=0.05)


def test_a_mover_looks_like_a_static_obstacle_from_a_frame_that_moves_along() -> None:
    rng = np.random.default_rng(7)
    solid = Solid("box", 0.4, 6.0, 9.0, 8.0)
    eye = np.array([0.0, 0.0, 20.0]) + np.cumsum(rng.uniform(0.0, 2.0, (30, 3)) * [0.2, 1.0, 0.1], 0)
    attitude = turns.of_angles(*(0.1 * rng.standard_normal((3, 30))))
    path = np.array([5.0, 90.0]) + np.outer(np.arange(30), [0.7, -1.1])
    moving = view.Standpoint(view.Camera(), eye, attitude, path)
    along = np.pad(path - path[0], ((0, 0), (0, 1)))
    still = view.Standpoint(view.Camera(), eye - along, attitude, np.broadcast_to(path[0], path.shape))
    assert view.points(solid, moving, True) == pytest.approx(view.points(solid, still, True), abs=1e-9, nan_ok=True)
    assert view.boxes(solid, moving) == pytest.approx(view.boxes(solid, still), abs=1e-9)


@pytest.mark.parametrize("kind", ["roof", "pylon", "L", "two"])
def test_other_shapes_lie_within_their_rectangle(kind: str) -> None:
    solid = Solid(kind, 0.3, 12.0, 8.0, 10.0, gap_m=3.0, setback_m=2.0)
    points = solid.points()
    across, along = points[:, :2] @ solid.across, points[:, :2] @ solid.along
    assert [np.ptp(across), np.ptp(along), points[:, 2].max()] == pytest.approx([12.0, 8.0, 10.0])
    assert np.hypot(points[:, 0], points[:, 1]).max() <= solid.half_m + 1e-9


def test_turns_and_quaternions_agree() -> None:
    rng = np.random.default_rng(3)
    angles = rng.uniform(-1.4, 1.4, (3, 50))
    matrix = turns.of_angles(*angles)
    assert np.array(turns.angles_of(matrix)) == pytest.approx(angles, abs=1e-12)
    vector = rng.standard_normal(3)
    for m, q in zip(matrix, turns.quaternion(matrix)):
        assert turned(q, vector) == pytest.approx(m @ vector, abs=1e-12)
    half = turns.quaternion(turns.of_angles(math.pi, 0.0, 0.0))  # w is 0
    assert np.abs(half) == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-12)
    spin = rng.standard_normal(3)
    assert turns.of_vector(spin) @ spin == pytest.approx(spin) and np.linalg.det(
        turns.of_vector(spin)
    ) == pytest.approx(1)


# ----------------------------------------------------------------------------------------------------------- the errors


def test_the_same_number_gives_the_same_flight_whatever_the_errors_are() -> None:
    exact, late = scenario.fly(BASE, 1), scenario.fly(BASE.by(late_s=0.1), 1)
    assert exact.pixel_px == pytest.approx(late.pixel_px)
    flown = np.linalg.norm(np.diff(exact.position_ned_m, axis=0), axis=1) * 8.0
    lag = np.linalg.norm(exact.position_ned_m - late.position_ned_m, axis=1)
    assert lag[1:] == pytest.approx(0.1 * flown, rel=0.02)
    assert scenario.fly(BASE, 3).truth.solid != exact.truth.solid


def test_conventions_say_the_same_pose_in_other_axes() -> None:
    inputs = scenario.fly(BASE, 1)
    enu, xyzw = (scenario.fly(BASE.by(convention=name), 1) for name in ("ENU", "xyzw"))
    n, e, d = inputs.position_ned_m.T
    assert enu.position_ned_m == pytest.approx(np.stack([e, n, -d], 1))
    nose_ned, nose_enu = (turned(t.attitude[4], np.array([1.0, 0.0, 0.0])) for t in (inputs, enu))
    assert nose_enu == pytest.approx(nose_ned[[1, 0, 2]] * [1, 1, -1])
    left_ned, left_enu = (turned(t.attitude[4], v) for t, v in ((inputs, -np.eye(3)[1]), (enu, np.eye(3)[1])))
    assert left_enu == pytest.approx(left_ned[[1, 0, 2]] * [1, 1, -1])
    assert xyzw.attitude[:, [3, 0, 1, 2]] == pytest.approx(inputs.attitude)
    feet = scenario.fly(BASE.by(convention="height in feet"), 1)
    assert (
        feet.height_m == pytest.approx(inputs.height_m / 0.3048)
        and (feet.position_ned_m == inputs.position_ned_m).all()
    )


def test_a_reset_is_reported_once_and_moves_height_and_position() -> None:
    inputs, jumped = scenario.fly(BASE, 1), scenario.fly(BASE.by(reset_m=2.0), 1)
    (k,) = np.flatnonzero(np.diff(jumped.reset_count, prepend=0))
    assert abs(jumped.reset_m[k, 2]) == 2.0 and np.count_nonzero(jumped.reset_m) == 1
    moved = jumped.position_ned_m - inputs.position_ned_m
    assert moved[:k] == pytest.approx(0.0) and moved[k:, 2] == pytest.approx(jumped.reset_m[k, 2])
    assert (jumped.height_m - inputs.height_m)[k:] == pytest.approx(-jumped.reset_m[k, 2])


def test_boxes_are_cut_at_the_border() -> None:
    inputs = scenario.fly(rows.CLIPPED, 1)
    assert inputs.box_px is not None
    box = inputs.box_px[np.isfinite(inputs.box_px).all(1)]
    assert box.min() >= 0.0 and box.max() <= 1279.0 and ((box == 0.0) | (box == 1279.0)).any()


def test_configured_errors_have_the_configured_size() -> None:
    rng = np.random.default_rng(1)
    process = errors.correlated(np.arange(4000) * 0.125, 1.0, 4, rng)
    assert process.std() == pytest.approx(1.0, abs=0.06)
    after_1_s = (process[8:] * process[:-8]).mean()
    assert after_1_s == pytest.approx(math.exp(-1.0), abs=0.06)
    mount = errors.configured_mounting((0.0, 0.0, 0.0), errors.Wrong(mount_off_deg=2.0), rng)
    assert np.abs(mount) == pytest.approx(2.0, abs=0.1)


# ------------------------------------------------------------------------------------------------------------ measuring


def outcome(
    error: list[float] | np.ndarray, suspect: list[bool] | None = None, reason: list[str] | None = None
) -> Outcome:
    """An outcome with sigma 1 that reports Z0 alone, one image a second."""
    count = len(error)
    values = np.full((count, 6), NAN)
    values[:, Z0] = error
    flags = np.zeros(count, bool) if suspect is None else np.array(suspect)
    answers = Answers(
        np.arange(count, dtype=float), values, np.where(np.isfinite(values), 1.0, NAN), np.full(count, DISC),
        np.zeros(count, int), flags, np.zeros(count, bool), None if reason is None else np.array(reason),
    )  # fmt: skip
    return Outcome(answers, values, answers.sigma)


def test_coverage_of_known_figure() -> None:
    rng = np.random.default_rng(5)
    share = coverage([outcome(rng.standard_normal(200)) for _ in range(100)])
    assert share[Z0] == pytest.approx(95.45, abs=0.5) and np.isnan(share[X0])
    assert coverage([outcome([0.0] * 30 + [3.0] * 10), outcome([NAN, 2.5]), outcome([NAN])])[Z0] == 37.5


@pytest.mark.parametrize(
    ("error", "suspect", "wrong"),
    [
        ([6.0] * 5, None, True),
        ([-6.0] * 5 + [0.0], None, True),
        ([6.0] * 4 + [0.0] + [6.0] * 4, None, False),
        ([6.0] * 4 + [NAN] + [6.0] * 4, None, False),
        ([4.9] * 9, None, False),
        ([6.0] * 9, [False] * 4 + [True] + [False] * 4, False),
        ([6.0] * 10, [True] * 5 + [False] * 5, True),
    ],
)
def test_confident_errors_are_runs_of_five(error: list[float], suspect: list[bool] | None, wrong: bool) -> None:
    judged = outcome(error, suspect)
    assert judging.is_confidently_wrong(judged) is wrong
    assert judging.confident([judged, outcome([0.0])]) == {"any": 50.0 * wrong, "position": 50.0 * wrong}
    assert not judging.is_confidently_wrong(judged, (judging.WIDTH,))


def test_flags_and_reasons() -> None:
    quiet, late, early = (outcome([0.0] * 10, [k >= first for k in range(10)]) for first in (10, 6, 2))
    assert judging.flagged_within([quiet, late, early], "moves", 4.0) == pytest.approx(100 / 3)
    assert judging.flagged_within([quiet, late, early], "moves", math.inf) == pytest.approx(200 / 3)
    assert judging.suspected([quiet, early]) == {"tracks": 50.0, "images": 40.0}
    said = outcome([0.0] * 4, [True] * 4, ["", "poses late", "it moves", "it moves"])
    assert judging.first_flag_s(said.answers, judging.flagged(said.answers, "moves")) == 2.0
    assert judging.flagged_within([said], "late", 3.0) == 100.0 and judging.flagged_within([said], "shape", 3.0) == 0.0
    assert judging.suspect_or_covered([quiet, outcome([3.0] * 9), early, outcome([NAN])]) == 50.0


def test_odd_answers_within_three_seconds() -> None:
    def odd(**changes: object) -> bool:
        return judging.is_odd_within(replace(outcome([0.0] * 10).answers, **changes), 3.0)  # type: ignore[arg-type]

    at = lambda *images: np.isin(np.arange(10), images)  # noqa: E731
    assert not odd() and odd(suspect=at(3)) and not odd(suspect=at(4))
    assert odd(restarted=at(1, 2)) and not odd(restarted=at(1, 5))
    assert odd(status=np.where(at(0, 1, 2), -1, 0)) and not odd(status=np.where(at(0, 1, 7, 8, 9), -1, 0))


def truth_of(solid: Solid, x_m: float = 10.0, z_m: float = 100.0) -> Truth:
    still = np.zeros((1, 3))
    return Truth(solid, np.array([x_m, z_m]), 0.0, np.zeros(2), still, still)


def answers_of(model: int, values: list[float]) -> Answers:
    inputs = np.array([values])
    return replace(outcome([0.0]).answers, values=inputs, sigma=np.ones((1, 6)), model=np.array([model]))


def test_a_box_may_be_named_either_way_and_a_disc_is_its_middle() -> None:
    truth = truth_of(Solid("box", math.radians(30.0), 8.0, 20.0, 5.0))
    s, c = math.sin(math.radians(30.0)), math.cos(math.radians(30.0))
    front = [10.0 - 10.0 * s, 100.0 - 10.0 * c, math.radians(30.0), 8.0, 20.0, 5.0]
    side = [10.0 - 4.0 * c, 100.0 + 4.0 * s, math.radians(-60.0), 20.0, 8.0, 5.0]  # the left face is hidden
    right = [10.0 + 4.0 * c, 100.0 - 4.0 * s, math.radians(-60.0), 20.0, 8.0, 5.0]  # the right face is visible
    for values, good in ((front, True), (right, True), (side, False)):
        error = judging.judge(answers_of(BOX, values), truth).error[0]
        assert (np.abs(error).max() < 1e-9) == good
    disc = judging.judge(answers_of(DISC, [10.0, 100.0, NAN, 14.0, NAN, 5.0]), truth).error[0]
    assert disc[:2] == pytest.approx(0.0) and np.isnan(disc[2:]).all()
    corners = np.array(box_corners(truth.solid)) @ [100.0, -10.0] / math.hypot(100.0, 10.0)
    prism = judging.judge(answers_of(PRISM, [10.0, 100.0, NAN, float(np.ptp(corners)), NAN, 5.0]), truth).error[0]
    assert prism[[0, 1, 3, 5]] == pytest.approx(0.0, abs=1e-9) and np.isnan(prism[[2, 4]]).all()


# ------------------------------------------------------------------------------------------------------------- warnings


def test_closest_approach_to_a_disc_and_to_a_box() -> None:
    def flown(solid: Solid, east_m: float, down_m_s: float = 0.0) -> approach.Approach:
        eye, velocity = np.array([[-100.0, east_m, -20.0]]), np.array([[10.0, 0.0, down_m_s]])
        return approach.closest(replace(truth_of(solid), eye_ned_m=eye, path_velocity_ned_m_s=velocity))

    disc, box = Solid("cylinder", 0.0, 10.0, 10.0, 12.0), Solid("box", 0.0, 10.0, 40.0, 12.0)
    passed = flown(disc, 30.0)
    assert [passed.time_s, passed.dcpa_m, passed.clearance_m] == pytest.approx([10.0, 25.0, 8.0], abs=0.01)
    head_on = flown(disc, 0.0)
    assert [head_on.time_s, head_on.dcpa_m] == pytest.approx([9.5, 0.0], abs=0.011) and head_on.violates
    assert flown(disc, 3.0).time_s == pytest.approx(10.0 - 0.4, abs=0.011)  # enters 4 m before the middle
    along = flown(box, 30.0)
    assert [along.time_s, along.dcpa_m] == pytest.approx([8.0, 25.0], abs=0.011) and not along.violates
    assert flown(box, 0.0, 0.5).clearance_m == pytest.approx(8.0 - 0.5 * 12.0, abs=0.02)  # leaves the outline here


def run_of(inputs: float, violates: bool, earliest_tcpa_s: float = 30.0, dcpa_m: float = 40.0) -> approach.Run:
    time = np.arange(20.0)
    level, to_go = np.full(20, inputs), 25.0 - time
    there = np.ones(20)
    warnings = approach.Warnings(
        time, there > 0, to_go, there, np.full(20, 3.0), there, np.full(20, 1.0), there, level,
        (level >= 0.1) & (earliest_tcpa_s - time < 12.0),
    )  # fmt: skip
    happened = approach.Approach(25.0, 0.0 if violates else dcpa_m, 0.0)
    return approach.Run(warnings, happened)


def test_probabilities_warnings_and_coverage_of_known_figures() -> None:
    runs = [run_of(0.3, violates=k < 4) for k in range(10)] + [run_of(0.9, violates=True)]
    inputs = approach.probabilities(runs)
    assert inputs["0.2 to 0.5"] == (pytest.approx(0.3), pytest.approx(0.4), 200)
    assert inputs["0.8 to 0.95"] == (pytest.approx(0.9), 1.0, 20)
    covered = approach.coverage([run_of(0.3, violates=False, dcpa_m=2.0), run_of(0.3, violates=False)])
    assert covered == {"time": 100.0, "miss": 50.0, "clearance": 100.0}
    in_time, too_late, never = run_of(0.3, True, 25.0), run_of(0.3, True, 35.0), run_of(0.05, True)
    assert [approach.first_warning_s(r.warnings) for r in (in_time, never)] == [14.0, math.inf]
    assert approach.first_warning_s(too_late.warnings) == math.inf  # the violation lasts 20 s
    assert approach.unwarned([in_time, too_late, never]) == pytest.approx(200 / 3)
    assert (
        approach.false_warnings([run_of(0.3, False), run_of(0.05, False), run_of(0.9, False, dcpa_m=20.0)]) == 100 / 2
    )


def test_the_margins_are_the_readmes() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"{approach.MARGIN_M}f, {approach.CLEARANCE_M}f, since_s, 0.0f}}; /* margin, clearance, m */" in readme


def test_warnings_follow_the_library_s_decision_rule(built: None) -> None:
    """Warnings use the decision rule with growing margins; the reported hazard uses constant margins."""
    row = approach.ROWS[0]
    inputs = scenario.fly(row.scenario, 3)
    track = run(attack.images_of(inputs, attack.PLANS), inputs.settings)
    flown = hazard.perform(row, 3)
    goe = package()
    images = to_package(attack.images_of(inputs, attack.PLANS))
    by_rule = goe.run(
        named_settings(tuple(inputs.settings.items())),
        images,
        rules=[goe.Rule(approach.MARGIN_M, approach.CLEARANCE_M)],
    )
    assert np.array_equal(flown.warnings.acts, by_rule.decision[:, 0] == goe.Decision.ACT)
    there = track.hazard["status"][:, 0] == 0
    assert np.array_equal(flown.warnings.violation[there], track.hazard["conflict_probability"][there, 0])
    assert there.any()


# ------------------------------------------------------------------------------------------------------------ the goals


def test_rows_are_named_once_and_a_wrong_name_is_reported() -> None:
    titles = [(row.section, row.title) for row in rows.ROWS]
    assert len(set(titles)) == len(titles)
    assert rows.row_named("hover").scenario.flown.path == "hover"
    with pytest.raises(ValueError, match=r"attack 'hoover': not one of baseline; .*hover"):
        rows.row_named("hoover")
    with pytest.raises(ValueError, match="half 'odd': not one of judge, settle"):
        rows.numbers("odd", 3)
    with pytest.raises(TypeError, match="no_such_error"):
        BASE.by(no_such_error=1.0)


def test_halves_share_no_track_and_two_of_three_are_boxes() -> None:
    judge, settle = (set(rows.numbers(half, 120)) for half in ("judge", "settle"))
    assert not judge & settle and len(judge) == len(settle) == 120
    kinds = [scenario.kind_of(Scenario(), number) for number in judge]
    assert kinds.count("box") == 80 and kinds.count("cylinder") == 40


def good_track(inputs: Inputs, more: dict[str, np.ndarray] | None = None) -> Track:
    """Correct answers of sigma 1 m, as a disc or a box from the first image on."""
    count, solid = len(inputs.time_s), inputs.truth.solid
    values = np.tile(judging.namings(inputs.truth)[0], (count, 1))
    if solid.kind == "cylinder":
        values[:, :2] = inputs.truth.middle_m
    zeros, flags = np.zeros(count), np.zeros(count, bool)
    model = np.full(count, DISC if solid.kind == "cylinder" else BOX)
    return Track(
        zeros, np.full(count, METHODS["filter"]), model, ~flags, flags, values, np.ones((count, 6)),
        np.zeros((count, 6, 6)), zeros, zeros, zeros, np.arange(count), {}, more or {},
    )  # fmt: skip


def test_good_answers_meet_the_goals(monkeypatch: pytest.MonkeyPatch) -> None:
    truths: list[Inputs] = []
    fly = scenario.fly
    monkeypatch.setattr(scenario, "fly", lambda *given: truths.append(fly(*given)) or truths[-1])
    monkeypatch.setattr(attack, "run", lambda images, settings: good_track(truths[-1]))
    monkeypatch.setattr(attack, "has_setting", lambda name: False)
    for title in ("baseline", "gable roofs, outline"):
        row = replace(rows.row_named(title), asked=(rows.cover(90), rows.wrong(4), rows.suspect(1)))
        goals = attack.goals_of("attack", row, [attack.perform(row, number) for number in (1, 3, 5)])
        met = {goal.name.split(": ")[1]: goal.met for goal in goals}
        assert (
            met[attack_lines.COVER]
            and met[attack_lines.WRONG]
            and met[attack_lines.SUSPECT]
            and met[attack_lines.ANSWERS] is None
        )
    mover = rows.row_named("across 5 m/s")
    goals = attack.goals_of("attack", mover, [attack.perform(mover, 1)])
    inputs = {goal.name.split(": ")[1]: goal for goal in goals}
    assert inputs[attack_lines.REASON].values[attack_lines.IN_4_S] == 0.0 and inputs[attack_lines.REASON].met is False
    assert (
        math.isnan(inputs[attack_lines.VELOCITY].values[attack_lines.IMAGES])
        and inputs[attack_lines.VELOCITY].met is False
    )


def test_reasons_and_velocities_of_a_later_library_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    inputs = scenario.fly(BASE.by(moves="across", moves_m_s=5.0), 1)
    count, velocity = len(inputs.time_s), inputs.truth.velocity_ned_m_s
    more = dict(
        zip(attack.VELOCITY, ([velocity[0] + 1.0] * count, [velocity[1]] * count, [1.0] * count, [1.0] * count))
    )
    more = {name: np.array(values) for name, values in more.items()}
    more["reason"] = np.arange(count) // 4 % 2
    monkeypatch.setattr(attack, "reason_names", lambda: ("none", "moves"))
    answers = attack.answers_of(good_track(inputs, more), inputs.time_s)
    assert judging.first_flag_s(answers, judging.flagged(answers, rows.MOVES)) == pytest.approx(0.5)
    of_track = Outcome(answers, answers.values, answers.sigma)
    assert judging.velocity_covered([of_track], [velocity]) == 100.0
    assert judging.velocity_covered([of_track], [velocity - [2.0, 0.0]]) == 50.0
    monkeypatch.setattr(attack, "reason_names", tuple)
    assert attack.reasons_of(good_track(inputs, more)) is None


def lines_of(goals: list[Goal], title: str) -> dict[str, Goal]:
    return {goal.name.split(": ")[1]: goal for goal in goals if goal.name.startswith(f"{title}: ")}


def test_the_library_over_some_rows(
    built: None, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """End to end: a good row is good, late poses are worse, and an unknown setting is skipped."""
    slope = replace(rows.row_named("slope 3 %"), if_known={"navigation.no_such_setting": 1.0})
    names = ("baseline", "baseline, by boxes", "poses 100 ms late", "ENU")
    chosen = (*(replace(rows.row_named(name), tracks_share=4.0) for name in names), slope)
    monkeypatch.setattr(rows, "ROWS", chosen)
    monkeypatch.setattr(attack, "recorded_scenes", lambda count, seed: [])
    goals = attack.attack_group("attack", AMOUNT)
    baseline, late = lines_of(goals, "baseline"), lines_of(goals, "poses 100 ms late")
    assert min(baseline[attack_lines.COVER].values.values()) > 80.0 and set(baseline[attack_lines.COVER].values) == set(
        NAMES
    )
    assert late[attack_lines.COVER].values["Z0"] < baseline[attack_lines.COVER].values["Z0"]
    by_boxes = lines_of(goals, "baseline, by boxes")[attack_lines.COVER]
    assert by_boxes.met and math.isnan(by_boxes.values["L"]) and by_boxes.asked == ("X0", "Z0", "W", "H")
    assert lines_of(goals, "ENU")[attack_lines.ODD].values[attack_lines.FLAGGED] > 60.0
    left = lines_of(goals, "slope 3 %")["settings left out"]
    assert left.values == {"navigation.no_such_setting": 1.0} and left.met is None
    said = capsys.readouterr().out
    assert "left out: settings that the library does not have: navigation.no_such_setting" in said
    assert "left out: no recorded flights" in said


def test_the_library_warns_of_collision_courses(built: None) -> None:
    row = approach.ROWS[0]
    runs = [hazard.perform(row, number) for number in rows.numbers("judge", 40)]
    violators = [r for r in runs if r.approach.violates]
    assert len(violators) >= 5 and approach.unwarned(runs) == 0.0
    goals = {goal.name.split(": ")[1]: goal for goal in hazard.goals_of("hazard", row, runs)}
    assert goals["within 2 sigma"].values["time"] > 80.0
    assert goals["flown"].values["violators"] == len(violators)


# --------------------------------------------------------------------------------------------------- tables of the page


def _goal(
    group: str, name: str, values: dict[str, float], wanted: tuple[float, float] | None = None
) -> dict[str, object]:
    met = None if wanted is None else all(wanted[0] <= value <= wanted[1] for value in values.values())
    asked = [] if wanted is None else list(values)
    return {"group": group, "name": name, "unit": "%", "wanted": wanted, "asked": asked, "values": values, "met": met}


def test_tables_of_the_page_show_the_results_of_the_goals(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = [
        _goal("attack: as configured", f"calm: {attack_lines.COVER}", {"X0": 97.4, "Z0": 88.6}, (90.0, 100.0)),
        _goal(
            "attack: as configured", f"calm: {attack_lines.WRONG}", {attack_lines.ANY: 2.0, attack_lines.POSITION: 1.0}
        ),
        _goal(
            "attack: moving obstacles",
            f"away: {attack_lines.REASON}",
            {attack_lines.IN_4_S: 24.0, attack_lines.IN_8_S: 56.0, attack_lines.EVER: 78.0},
        ),
        _goal(
            "hazard", f"corners: {attack_lines.COVERED}", {"time": 97.0, "miss": 98.0, "clearance": 95.0}, (90.0, 100.0)
        ),
        _goal("hazard", f"corners: {attack_lines.UNWARNED}", {"violators": 0.3}),
        _goal("hazard", f"corners: {attack_lines.FALSE}", {"passes": 4.6}),
    ]
    file, page = tmp_path / "goals.json", tmp_path / "README.md"
    file.write_text(json.dumps({"quick": False, "goals": found}), encoding="utf-8")
    page.write_text("before\n<!-- attack: begin -->\nold\n<!-- attack: end -->\nafter\n", encoding="utf-8")
    monkeypatch.setattr(attack_command, "PAGE", page)
    assert main(["attack_tables", str(file)]) == 0
    inputs = capsys.readouterr().out
    assert main(["attack_tables", str(file), "--write"]) == 0
    text = page.read_text(encoding="utf-8")
    assert text == f"before\n<!-- attack: begin -->\n{inputs.rstrip()}\n<!-- attack: end -->\nafter\n"
    assert "| calm | 97/89/-/-/-/- | 2/1 | missed |" in inputs
    assert "| away | 24/56/78 |  |" in inputs
    assert "| corners | 97/98/95 | 0.3 | 5 | met |" in inputs
    assert "1 of 2 goals are met." in inputs


def test_tables_of_the_page_are_whole() -> None:
    """The page's tables contain each row of an attack that has a goal."""
    text = attack_command.PAGE.read_text(encoding="utf-8")
    for row in rows.ROWS:
        assert f"| {row.name}" in text, row.name
