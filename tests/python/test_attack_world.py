"""The harder world of the attacks: drifting poses, uneven ground, hidden bases, foreign boxes. By other projections and
by statistics of many tracks, without the estimator."""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace

import numpy as np
import pytest
from bench.attack import errors, harder, judging, rows, scenario, surroundings, view
from bench.attack.errors import Wrong
from bench.attack.judging import Answers, Outcome
from bench.attack.scenario import Inputs, Scenario
from bench.attack.solids import Solid

EXACT = {
    "point_noise_px": 0.0, "box_noise_px": 0.0, "box_noise_rel": 0.0, "attitude_bias_sd_deg": 0.0,
    "attitude_white_sd_deg": 0.0, "velocity_bias_sd_m_s": 0.0, "position_walk_sd_m": 0.0, "height_bias_sd_m": 0.0,
}  # fmt: skip
BASE = Scenario(kind="box").by(**EXACT)
BOTH = BASE.by(features="boxes with corners")
NONE = Wrong(**EXACT)
TIME_S = np.arange(160) * 0.125


def digest(inputs: Inputs) -> str:
    """Of all arrays of a track, rounded so that another machine's last bits do not count."""
    box = np.zeros(0) if inputs.box_px is None else np.nan_to_num(inputs.box_px, nan=-1.0)
    arrays = (inputs.position_ned_m, inputs.attitude, inputs.height_m, inputs.pixel_px, box, inputs.velocity_ned_m_s)
    text = b"".join((np.round(a, 4) + 0.0).tobytes() for a in arrays)
    return hashlib.sha256(text).hexdigest()[:16]


# -------------------------------------------------------------------------------------------------- another pinhole


def rotation(q: np.ndarray) -> np.ndarray:
    """The matrix of a Hamilton quaternion, body to NED."""
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def pinhole(inputs: Inputs, image: int, level_m: float) -> np.ndarray:
    """(4, 2) pixels of a box's corners at a height above its ground, by the true place of the camera."""
    truth, solid = inputs.truth, inputs.truth.solid
    turn = truth.axis_rad + solid.orientation_rad
    along, across = np.array([math.cos(turn), math.sin(turn)]), np.array([-math.sin(turn), math.cos(turn)])
    result = []
    for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1)):
        place = 0.5 * (a * solid.width_m * across + b * solid.length_m * along)
        ray = np.append(place - truth.eye_ned_m[image, :2], -level_m - truth.eye_ned_m[image, 2])
        forward, right, down = rotation(inputs.attitude[image]).T @ ray
        yaw = math.radians(inputs.settings["camera.mount_yaw_deg"])
        ahead = forward * math.cos(yaw) + right * math.sin(yaw)
        aside = right * math.cos(yaw) - forward * math.sin(yaw)
        result.append([640.0 + 914.0 * aside / ahead, 640.0 + 914.0 * down / ahead])
    return np.array(result)


def sides(inputs: Inputs, image: int, low_m: float = 0.0) -> np.ndarray:
    """(4,) sides of the box around the part above ``low_m``, clipped at the border."""
    both = np.concatenate([pinhole(inputs, image, low_m), pinhole(inputs, image, inputs.truth.solid.height_m)])
    return np.clip([*both.min(0), *both.max(0)], 0.0, 1279.0)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"sway_deg": (0.0, 0.0, 0.0), "weave_m": 0.0},
        {"crab_deg": (10.0, 20.0)},
        {"sway_deg": (2.0, 1.5, 25.0)},
        {"steady_climb_m_s": 2.0, "height_m": (50.0, 85.0)},
        {"at_border": True, "size_m": (8.0, 30.0)},
    ],
)
def test_boxes_with_corners_are_those_of_a_pinhole(changes: dict[str, object]) -> None:
    for number in (1, 3):
        inputs = scenario.fly(BOTH.by(**changes), number)
        assert inputs.box_px is not None and not inputs.seen[:, : view.BASE_LEFT].any()
        for k in np.flatnonzero(np.isfinite(inputs.box_px).all(1))[::9]:
            assert inputs.box_px[k] == pytest.approx(sides(inputs, k), abs=1e-6)
            foot = pinhole(inputs, k, 0.0)
            for corner in inputs.pixel_px[k, view.BASE_LEFT :][inputs.seen[k, view.BASE_LEFT :]]:
                assert np.abs(foot - corner).max(1).min() < 1e-6
        assert inputs.seen.any()


# --------------------------------------------------------------------------------------------------------- flights


def test_attitudes_and_climbs_are_as_described() -> None:
    def angles(changes: dict[str, object], number: int) -> tuple[np.ndarray, Inputs]:
        inputs = scenario.fly(BASE.by(weave_m=0.0, **changes), number)
        noses = np.array([rotation(q)[:, 0] for q in inputs.attitude])
        course = np.arctan2(*np.diff(inputs.position_ned_m, axis=0)[0, [1, 0]])
        return (np.degrees(np.arctan2(noses[:, 1], noses[:, 0]) - course) + 180.0) % 360.0 - 180.0, inputs

    still = {"sway_deg": (0.0, 0.0, 0.0)}
    level, inputs = angles({**still, "climb_m_s": 0.0}, 1)
    assert level == pytest.approx(0.0, abs=1e-6) and np.ptp(inputs.height_m) < 1e-9
    for number in (1, 3, 5):
        crabbed, inputs = angles({**still, "crab_deg": (10.0, 20.0), "climb_m_s": 0.0, "steady_climb_m_s": 2.0}, number)
        assert np.ptp(crabbed) < 1e-6 and 10.0 <= abs(crabbed[0]) <= 20.0
        assert np.abs(np.diff(inputs.height_m) / np.diff(inputs.time_s)) == pytest.approx(2.0)
    flown = harder.ROLL.flown
    assert max(math.radians(a) * 2 * math.pi / p[0] for a, p in zip(flown.sway_deg[2:], flown.sway_periods_s[2:])) < (
        math.radians(30.0)
    )


def test_the_border_cuts_the_obstacle_for_a_part_of_the_track() -> None:
    shares = []
    for number in range(1, 21, 2):
        inputs = scenario.fly(BASE.by(features="boxes", at_border=True, size_m=(8.0, 30.0)), number)
        assert inputs.box_px is not None
        box = inputs.box_px[np.isfinite(inputs.box_px).all(1)]
        shares.append(((box[:, 0] == 0.0) | (box[:, 2] == 1279.0)).mean())
    assert min(shares) > 0.0 and 0.2 < np.mean(shares) < 0.8


# ------------------------------------------------------------------------------------------------- hidden and foreign


@pytest.mark.parametrize("until", [0.5, 1.0])
@pytest.mark.parametrize("low", [{"hidden_m": (0.5, 1.5)}, {"hidden_share": (0.2, 0.5)}])
def test_bushes_and_trees_only_raise_what_is_below_them(low: dict[str, object], until: float) -> None:
    for number in (1, 3):
        plain, bushy = scenario.fly(BOTH, number), scenario.fly(BOTH.by(hidden_until=until, **low), number)
        assert plain.box_px is not None and bushy.box_px is not None
        low_m, height = hidden_height(bushy), plain.truth.solid.height_m
        assert 0.5 <= low_m <= 1.5 if "hidden_m" in low else 0.2 * height <= low_m <= 0.5 * height
        count = len(plain.time_s)
        hidden, clear = (1.0, 1.0) if until == 1.0 else (0.4, 0.6)  # shares of the images; between them it ends
        for k in range(0, int(hidden * count), 5):
            assert bushy.box_px[k] == pytest.approx(sides(bushy, k, low_m), abs=1e-6)
        assert (plain.box_px == bushy.box_px)[math.ceil(clear * count) :].all()
        assert (plain.pixel_px == bushy.pixel_px)[math.ceil(clear * count) :].all()


def hidden_height(inputs: Inputs) -> float:
    """The height whose box has the lower side of the first image: by bisection."""
    assert inputs.box_px is not None and inputs.box_px[0, 3] < 1279.0
    low, high = 0.0, inputs.truth.solid.height_m
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sides(inputs, 0, middle)[3] > inputs.box_px[0, 3] else (low, middle)
    return low


def test_hidden_corners_are_absent_or_raised() -> None:
    hidden = BASE.by(hidden_m=(1.0, 1.0), hidden_until=0.5)
    plain, absent, raised = (
        scenario.fly(s, 1) for s in (BASE, hidden.by(corners_lost=1.0), hidden.by(corners_lost=0.0))
    )
    base, outline = slice(view.BASE_LEFT, None), slice(view.LEFT, view.BASE_LEFT)
    assert not absent.seen[:5, base].any() and absent.seen[-5:, base].any()
    assert absent.seen[:, outline].any()
    for k in range(5):
        level = pinhole(raised, k, 1.0)
        for corner in raised.pixel_px[k, base][raised.seen[k, base]]:
            assert np.abs(level - corner).max(1).min() < 1e-6
    assert (raised.pixel_px[-5:] == plain.pixel_px[-5:]).all()


def test_a_cylinder_s_outline_ends_at_the_bushes() -> None:
    scene = Scenario(kind="cylinder", features="boxes").by(**EXACT)
    plain, bushy = scenario.fly(scene, 5), scenario.fly(scene.by(hidden_m=(1.0, 1.0)), 5)
    assert plain.box_px is not None and bushy.box_px is not None
    assert (bushy.box_px[:, 1] == plain.box_px[:, 1]).all()
    radius, eye = 0.5 * plain.truth.solid.width_m, plain.truth.eye_ned_m[0]
    angle = np.linspace(0.0, 2 * math.pi, 721)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(721, -1.0)], 1) - eye
    body = rim @ rotation(plain.attitude[0])
    assert bushy.box_px[0, 3] == pytest.approx((640.0 + 914.0 * body[:, 2] / body[:, 0]).max(), abs=0.02)


def test_a_tenth_of_the_boxes_are_those_of_one_neighbor() -> None:
    off = []
    for number in range(1, 31, 2):
        own, mixed = (scenario.fly(BASE.by(features="boxes", foreign=share), number) for share in (0.0, 0.1))
        both = {round(float(t), 3): k for k, t in enumerate(own.truth.eye_ned_m[:, 0])}
        assert own.box_px is not None and mixed.box_px is not None
        for k, north in enumerate(mixed.truth.eye_ned_m[:, 0]):
            other = both.get(round(float(north), 3))
            if other is not None:
                off.append(not np.array_equal(own.box_px[other], mixed.box_px[k], equal_nan=True))
    assert 0.03 < np.mean(off) < 0.12


def test_a_neighbor_stands_apart_and_is_not_hidden() -> None:
    rng = np.random.default_rng(2)
    solid = Solid("box", 0.0, 6.0, 8.0, 5.0)
    eye, turn, middle = np.tile([0.0, 0.0, 20.0], (3, 1)), np.tile(np.eye(3), (3, 1, 1)), np.tile([0.0, 80.0], (3, 1))
    stand = view.Standpoint(view.Camera(), eye, turn, middle, np.full(3, 1.0))
    for _ in range(20):
        other, about = surroundings.neighbor(solid, stand, (0.3, 30.0), rng)
        gap = np.linalg.norm(about.middle_m[0] - middle[0]) - other.half_m - solid.half_m
        assert 3.0 - 1e-9 <= gap <= 30.0 + 1e-9 and about.hidden_m is None


# ------------------------------------------------------------------------------------------------ drifts and heights


def drifts(wrong: Wrong, count: int = 150) -> tuple[np.ndarray, np.ndarray]:
    """Errors of places and velocities (count, K, 3)."""
    found = [errors.drifting(TIME_S, wrong, np.random.default_rng(k)) for k in range(count)]
    return np.array([place for place, _ in found]), np.array([velocity for _, velocity in found])


def test_drifts_have_the_stated_sizes() -> None:
    place, velocity = drifts(replace(NONE, down_walk_m=0.1))
    after_s = TIME_S[-1]
    assert place[:, 0] == pytest.approx(0.0) and not place[..., :2].any() and not velocity.any()
    assert place[:, -1, 2].std() == pytest.approx(0.1 * math.sqrt(after_s), rel=0.15)
    place, velocity = drifts(replace(NONE, climb_off_m_s=0.1))
    assert np.abs(velocity[..., 2]) == pytest.approx(0.1) and np.abs(place[:, -1, 2]) == pytest.approx(0.1 * after_s)
    place, velocity = drifts(replace(NONE, velocity_off_m_s=0.3))
    assert np.hypot(*velocity[:, 0, :2].T) == pytest.approx(0.3) and np.ptp(velocity, axis=1) == pytest.approx(0.0)
    assert np.abs(velocity[:, 0, :2].mean(0)).max() < 0.05


def test_a_wandering_velocity_is_a_gauss_markov_process() -> None:
    place, velocity = drifts(replace(NONE, velocity_wander_m_s=0.3))
    assert velocity[..., :2].std() == pytest.approx(0.3, rel=0.1) and not velocity[..., 2].any()
    later = int(10.0 / 0.125)
    ratio = (velocity[:, later:, :2] * velocity[:, :-later, :2]).mean() / velocity[..., :2].var()
    assert ratio == pytest.approx(math.exp(-0.5), abs=0.12)
    assert np.diff(place, axis=1) / 0.125 == pytest.approx(velocity[:, 1:])


def height_errors(**changes: object) -> tuple[np.ndarray, list[Inputs]]:
    """Reported minus true heights of some tracks, end to end."""
    flown = [scenario.fly(BASE.by(height_m=(50.0, 85.0), **changes), number) for number in range(1, 25, 2)]
    return np.concatenate([i.height_m + i.truth.eye_ned_m[:, 2] for i in flown]), flown


def test_heights_differ_from_the_truth_as_stated() -> None:
    off, _ = height_errors(height_white_sd_m=1.0)
    assert off.std() == pytest.approx(1.0, rel=0.1) and abs(off.mean()) < 0.1
    off, _ = height_errors(climb_m_s=0.0, steady_climb_m_s=2.0, height_lag_s=0.5)
    assert np.abs(off) == pytest.approx(1.0)
    off, _ = height_errors(climb_m_s=0.0, height_lag_s=0.5)
    assert off == pytest.approx(0.0, abs=1e-9)
    _, flown = height_errors(down_walk_m=0.1, climb_off_m_s=0.1)
    for inputs in flown:  # down and height agree with each other
        sum_m = inputs.height_m + inputs.position_ned_m[:, 2]
        assert np.ptp(sum_m) == pytest.approx(0.0, abs=1e-9)
        assert np.ptp(inputs.height_m + inputs.truth.eye_ned_m[:, 2]) > 0.1
    off, _ = height_errors()
    assert off == pytest.approx(0.0, abs=1e-9)


def test_ground_steps_halfway_and_woods_have_gaps() -> None:
    away = np.linspace(400.0, 10.0, 200)
    rng = np.random.default_rng(4)
    steps = [surroundings.step_m(away, 3.0, rng) for _ in range(40)]
    assert {float(s[0]) for s in steps} == {3.0, -3.0}
    assert all((s[away > 200.0] == s[0]).all() and not s[away <= 200.0].any() for s in steps)
    crowns = np.array([surroundings.canopy_m(away, (10.0, 20.0), rng) for _ in range(40)])
    trees = crowns > 0.0
    assert crowns[trees].min() >= 10.0 and crowns.max() <= 20.0 and not crowns[:, away < 15.0].any()
    assert 0.5 < trees[:, away > 30.0].mean() < 0.9
    off, flown = height_errors(canopy_m=(10.0, 20.0))
    assert off.max() < 1e-9 and off.min() >= -20.0 and (off > -1e-9).any()
    assert min(inputs.height_m.min() for inputs in flown) > 0.0


def test_heights_of_the_rows_stay_above_the_ground() -> None:
    for row in harder.HARDER:
        if row.scenario.features in ("outline", "boxes") and not row.scenario.wrong.height_white_sd_m:
            assert scenario.fly(row.scenario, 1).height_m.min() > 0.0, row.title


# ------------------------------------------------------------------------------------------------------------ rows


def test_earlier_rows_are_unchanged() -> None:
    wanted = {
        "baseline": "e9461ec4dc529511",
        "baseline, by boxes": "d92cb3253344c3a0",
        "orbit": "3e20beb893a0ca8b",
        "slope 3 %": "e033ebd815492875",
        "height reset by 2 m, configured": "a4f8cee7318664a8",
        "clipped by the border, by boxes": "89f25e4fa08fa101",
        "two buildings as one": "dc21e0e2a398b20f",
        "across 5 m/s": "92343bbeb631b249",
    }
    assert {name: digest(scenario.fly(rows.row_named(name).scenario, 3)) for name in wanted} == wanted


def test_the_same_number_gives_the_same_flight() -> None:
    one, again, other = (scenario.fly(harder.EVERYDAY, number) for number in (1, 1, 3))
    assert digest(one) == digest(again) != digest(other)
    plain, drifted = scenario.fly(harder.HARD, 1), scenario.fly(harder.HARD.by(down_walk_m=0.1), 1)
    assert (plain.pixel_px == drifted.pixel_px).all() and (plain.truth.eye_ned_m == drifted.truth.eye_ned_m).all()


def test_each_demand_has_rows_by_the_features() -> None:
    names = {row.name for row in harder.HARDER}
    assert len({row.title for row in harder.HARDER}) == len(harder.HARDER)
    assert {"everyday", "forest", "bushes", "straight and level", "harder, oncoming 15 m/s"} <= names
    assert {row.scenario.features for row in harder.HARDER} == set(harder.KINDS)
    assert not any(row.settings or row.if_known for row in harder.HARDER)  # defaults alone


# --------------------------------------------------------------------------------------------------------- judging


def answers(count: int, **more: object) -> Answers:
    zeros = np.zeros(count)
    return Answers(
        0.125 * np.arange(count), np.zeros((count, 6)), np.ones((count, 6)), np.full(count, judging.PRISM), zeros,
        zeros > 0.0, zeros > 0.0, **more,
    )  # fmt: skip


def test_latency_and_typical_error_of_known_figures() -> None:
    def outcome(error: np.ndarray, late: list[float] | None = None) -> Outcome:
        count = len(error)
        more = {} if late is None else {"latency_s": np.array(late), "latency_sigma_s": np.full(count, 0.01)}
        return Outcome(answers(count, **more), np.tile(error[:, None], 6), np.full((count, 6), 2.0))

    rng = np.random.default_rng(1)
    drawn = [outcome(2.0 * rng.standard_normal(400)) for _ in range(50)]
    assert judging.typical_error(drawn) == pytest.approx(0.674, abs=0.03)
    good, bad = outcome(np.zeros(2), [0.05, math.nan]), outcome(np.zeros(2), [0.05, 0.08])
    assert judging.latency_covered([good, bad], 0.05) == 75.0 and math.isnan(judging.latency_covered(drawn, 0.0))
    assert judging.shortfall([90.0, math.nan], 0.0, (88.0, 80.0)) == 0.0
    assert judging.shortfall([70.0], 85.0, (88.0, 80.0)) == 0.0
    assert judging.shortfall([70.0, 95.0], 75.0, (88.0, 80.0)) == 5.0


def test_the_place_of_a_followed_obstacle_is_that_of_its_middle_now() -> None:
    inputs = scenario.fly(Scenario(kind="cylinder", moves="diagonal", moves_m_s=5.0).by(**EXACT), 5)
    truth, count = inputs.truth, len(inputs.time_s)
    now = truth.velocity_ned_m_s * inputs.time_s[:, None] - truth.eye_ned_m[:, :2]
    heading = truth.axis_rad
    z = now[:, 0] * math.cos(heading) + now[:, 1] * math.sin(heading)
    x = now[:, 1] * math.cos(heading) - now[:, 0] * math.sin(heading)
    velocity = np.tile(truth.velocity_ned_m_s, (count, 1))
    velocity[0] = math.nan
    given = answers(count, velocity_m_s=velocity, place_m=np.stack([x + 1.5, z - 3.0], 1),
                    place_sigma_m=np.ones((count, 2)))  # fmt: skip
    given = replace(given, time_s=inputs.time_s)
    followed = judging.followed(given, truth)
    assert followed is not None and np.isnan(followed[0]).all()
    assert followed[1:] == pytest.approx(np.tile([1.5, 3.0], (count - 1, 1)))
    outcome = Outcome(given, given.values, given.sigma, followed)
    assert judging.followed_covered([outcome]) == 50.0
    assert now[0] == pytest.approx(
        truth.middle_m @ [[-math.sin(heading), math.cos(heading)], [math.cos(heading), math.sin(heading)]]
    )
