"""The size and the shape that a detector's class states: right, wrong, late, changing, invalid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from unittest import mock

import goe
import numpy as np
import pytest
from bench.attack import approach, judging, scenario, solids
from bench.attack.harder import GROUND_SD_M, HARD
from bench.attack.scenario import Inputs, Scenario
from bench.attack.solids import Solid
from bench.optimum.goals.attack import PLANS, answers_of, images_of
from goe_tools.library import MODEL_DISC, Track, ready, reason_names, run

SHAPE, MOVES = (reason_names().index(str(reason)) for reason in (goe.Reason.SHAPE, goe.Reason.MOVES))
UNKNOWN, ROUND, OTHER = (float(shape) for shape in goe.KindShape)
NO_GROUND = {"navigation.terrain_height_sd_m": 1000.0}
X0, Z0, WIDTH, HEIGHT = judging.X0, judging.Z0, judging.WIDTH, judging.HEIGHT
BOXES = HARD.by(features="boxes", height_bias_sd_m=GROUND_SD_M)
SEEN = {
    "boxes": BOXES,
    "boxes with corners": BOXES.by(features="boxes with corners"),
    "outline": HARD.by(features="outline"),
    "corners": HARD,
}


@dataclass(frozen=True)
class Sort:
    """A class of obstacles: what the detector states, and what there is; mean and sigma."""

    width_m: tuple[float, float]  # of the silhouette
    height_m: tuple[float, float]
    front_m: tuple[float, float]
    side_m: tuple[float, float]

    def stated(self, shape: float = UNKNOWN) -> np.ndarray:
        return np.array([*self.width_m, *self.height_m, shape])

    def one(self, rng: np.random.Generator) -> Solid:
        front, side, height = (rng.normal(*of) for of in (self.front_m, self.side_m, self.height_m))
        return Solid("box", math.radians(rng.uniform(-45.0, 45.0)), front, side, height)


SORTS = {
    "car": Sort((3.2, 0.9), (1.5, 0.15), (1.8, 0.07), (4.4, 0.25)),
    "truck": Sort((5.2, 1.7), (3.6, 0.4), (2.5, 0.05), (8.0, 1.2)),
    "person": Sort((0.55, 0.12), (1.72, 0.1), (0.5, 0.05), (0.4, 0.04)),
}
LEARNED_S = 2.0
POLE_M = (0.4, 0.06)
POLES = Scenario(kind="cylinder", collides=True).by(
    speed_m_s=(1.0, 1.0), ahead_m=(3.0, 3.0), height_m=(0.7, 1.5), aside_m=(-0.2, 1.0), climb_m_s=0.0, weave_m=0.0,
    sway_deg=(2.0, 1.5, 2.0), stop_s=0.5, box_noise_px=1.0, box_noise_rel=0.07, box_correlation_time_s=1.2,
)  # fmt: skip


def pole(rng: np.random.Generator) -> Solid:
    width_m = rng.normal(*POLE_M)
    return Solid("cylinder", 0.0, width_m, width_m, rng.uniform(1.5, 4.0))


@contextmanager
def instead(one: Callable[[np.random.Generator], Solid]) -> Iterator[None]:
    """The flights are past such obstacles."""
    with mock.patch.object(solids, "drawn", lambda kind, size_m, rng: one(rng)):
        yield


@cache
def flights(flown: Scenario, seeds: range, one: Callable[[np.random.Generator], Solid] | None = None) -> list[Inputs]:
    if one is None:
        return [scenario.fly(flown, seed) for seed in seeds]
    with instead(one):
        return [scenario.fly(flown, seed) for seed in seeds]


def track_of(inputs: Inputs, kind: np.ndarray | None, settings: dict[str, float] | None = None) -> Track:
    """``kind``: (5,) or (K, 5)."""
    images = images_of(inputs, PLANS)
    if kind is not None:
        images = replace(images, kind=np.broadcast_to(kind, (len(inputs.time_s), 5)))
    return run(images, {**inputs.settings, **(settings or {})})


def judged(inputs: Inputs, track: Track) -> judging.Outcome:
    return judging.judge(answers_of(track, inputs.time_s), inputs.truth)


def ratios(outcome: judging.Outcome, quantity: int = Z0) -> np.ndarray:
    """Errors in sigmas of the images with an answer."""
    ratio = np.abs(outcome.error[:, quantity]) / outcome.sigma[:, quantity]
    return ratio[np.isfinite(ratio)]


def has(track: Track, reason: int) -> np.ndarray:
    return np.asarray(track.more["reason"] == reason)


def silhouette_m(solid: Solid) -> tuple[float, float]:
    """Mean and deviation over all directions of view."""
    angle = np.arange(0.0, math.pi, math.pi / 36)
    if solid.kind == "cylinder":
        return solid.width_m, 0.0
    width = solid.width_m * np.abs(np.cos(angle)) + solid.length_m * np.abs(np.sin(angle))
    return float(width.mean()), float(width.std())


def right(solid: Solid, rng: np.random.Generator, share: float = 0.1) -> np.ndarray:
    """A class that is off by its own sigma."""
    width_m, turned_m = silhouette_m(solid)
    width_off, height_off = share * rng.standard_normal(2)
    sd_m = math.hypot(turned_m, share * width_m)
    shape = ROUND if solid.kind == "cylinder" else OTHER
    return np.array(
        [(1.0 + width_off) * width_m, sd_m, (1.0 + height_off) * solid.height_m, share * solid.height_m, shape]
    )


def setup_module() -> None:
    ready()


# --------------------------------------------------------------------------------------------------------------- range


@pytest.mark.parametrize("name", SORTS)
def test_the_class_gives_the_range_without_ground(name: str) -> None:
    """[goe_kind_t.height_m] From the second answer on the sigmas hold; without a class the first answer is later, and
    worse than that with a class in the same image."""
    first, inside, later, errors = [], [], [], []
    for inputs in flights(BOXES, range(6100, 6150), SORTS[name].one):
        known, unknown = (judged(inputs, track_of(inputs, k, NO_GROUND)) for k in (SORTS[name].stated(), None))
        range_m = inputs.truth.middle_m[Z0]
        ratio = ratios(known)
        if not len(ratio):
            continue
        begins = int(np.argmax(np.isfinite(known.error[:, Z0])))
        first.append(abs(known.error[begins, Z0]) / range_m)
        inside.append(ratio[1:] < 2.0)
        there = np.isfinite(unknown.error[:, Z0])
        k = int(np.argmax(there))
        later.append(inputs.time_s[k] - inputs.time_s[begins] if there.any() else math.inf)
        if there.any() and np.isfinite(known.error[k, Z0]):
            errors.append(np.abs([known.error[k, Z0], unknown.error[k, Z0]]) / range_m)
    assert len(first) > 45
    assert np.median(first) < 0.15, np.median(first)
    for image in (0, 1, 3, 7, 15):
        covered = np.mean([of[image] for of in inside if len(of) > image])
        assert 0.9 <= covered <= 1.0, (image, covered)
    assert np.median(later) > 0.3, np.median(later)
    with_class, without = np.mean(errors, axis=0)
    assert with_class < without, (with_class, without)


@pytest.mark.parametrize("features", ["boxes", "outline"])
def test_the_width_of_a_pole_gives_its_range(features: str) -> None:
    """[goe_kind_t.width_m] First and last answer of a small drone at 1 m/s; sigmas hold."""
    first, last, inside = [], [], []
    for inputs in flights(POLES.by(features=features), range(6200, 6600), pole):
        outcome = judged(inputs, track_of(inputs, np.array([*POLE_M, 0.0, 0.0, ROUND])))
        error = np.abs(outcome.error[:, Z0])[np.isfinite(outcome.error[:, Z0])]
        if not len(error):
            continue
        range_m = np.linalg.norm(inputs.truth.eye_ned_m[:, :2], axis=1)
        first.append(error[0] / range_m[0])
        last.append(error[-1] / range_m[0])
        inside.append(np.mean(ratios(outcome) < 2.0))
    assert len(first) > 375, len(first)
    assert np.median(first) < 0.15, np.median(first)
    assert np.median(last) < 0.15, np.median(last)
    assert np.mean(inside) > 0.86, np.mean(inside)


# ---------------------------------------------------------------------------------------------------- right and wrong


@pytest.mark.parametrize("features", SEEN)
def test_a_right_class_is_not_flagged(features: str) -> None:
    """[GOE_REASON_SHAPE]"""
    flagged, inside = [], []
    for inputs in flights(SEEN[features], range(6301, 6376)):
        kind = right(inputs.truth.solid, np.random.default_rng([6, inputs.number]))
        track = track_of(inputs, kind)
        flagged.append(bool(has(track, SHAPE).any()))
        ratio = ratios(judged(inputs, track))
        inside += [np.mean(ratio < 2.0)] if len(ratio) else []
    assert np.mean(flagged) <= 0.02, np.mean(flagged)
    assert np.mean(inside) > 0.9, np.mean(inside)


def off_sigmas(kind: np.ndarray, track: Track) -> float:
    """Of the class from the last answer without it, in sigmas of their difference."""
    answered = np.flatnonzero(np.isfinite(track.values[:, Z0]))
    if not len(answered):
        return 0.0
    value, sigma = track.values[answered[-1]], track.sigma[answered[-1]]
    off = [abs(kind[i] - value[q]) / math.hypot(kind[i + 1], sigma[q]) for i, q in ((0, WIDTH), (2, HEIGHT))]
    return float(np.nanmax([0.0, *off]))


def later(outcome: judging.Outcome) -> judging.Outcome:
    """Without the answers of the first LEARNED_S."""
    answered = np.isfinite(outcome.error[:, Z0])
    time_s = outcome.answers.time_s
    early = time_s < time_s[np.argmax(answered)] + LEARNED_S
    return replace(outcome, error=np.where(early[:, None], np.nan, outcome.error))


ENOUGH = 120  # flights that are wrong by four sigmas


@pytest.mark.parametrize("features", SEEN)
@pytest.mark.parametrize(("real", "stated"), [("truck", "car"), ("car", "truck"), ("car", "person")])
def test_a_wrong_class_is_flagged(real: str, stated: str, features: str) -> None:
    """[GOE_REASON_SHAPE] If it is wrong by four sigmas; then it is not used. Before images know the range, a wrong
    class gives a wrong one: confident errors count from ``LEARNED_S`` after the first answer on."""
    kind, flagged, inside, lies = SORTS[stated].stated(), [], [], []
    for inputs in flights(SEEN[features], range(6500, 6860), SORTS[real].one):
        if len(flagged) == ENOUGH:
            break
        if off_sigmas(kind, track_of(inputs, None)) < 4.0:
            continue
        track = track_of(inputs, kind)
        outcome = judged(inputs, track)
        flagged.append(bool(has(track, SHAPE).any()))
        lies.append(judging.is_confidently_wrong(later(outcome), judging.POSITION))
        if flagged[-1]:
            assert track.suspect[has(track, SHAPE)].all()
            inside += [ratios(outcome, q)[-1] < 2.0 for q in (X0, Z0) if len(ratios(outcome, q))]
    if not flagged:
        pytest.skip("none is wrong by four sigmas")
    assert np.mean(flagged) >= 0.8, (np.mean(flagged), len(flagged))
    assert np.mean(inside) >= 0.9, (np.mean(inside), len(inside))
    assert np.mean(lies) <= 0.05, np.mean(lies)


# -------------------------------------------------------------------------------------------------------------- movers


def test_oncoming_cars_are_reported_as_moving() -> None:
    """[goe_kind_t.height_m, GOE_REASON_MOVES] At 15 m/s, by boxes."""
    oncoming = BOXES.by(moves="oncoming", moves_m_s=15.0, collides=True, ahead_m=(100.0, 200.0))
    outcomes, velocity, left, soon = [], [], [], []
    for inputs in flights(oncoming, range(6600, 6680), SORTS["car"].one):
        track = track_of(inputs, SORTS["car"].stated())
        outcomes.append(judged(inputs, track))
        outcomes[-1].answers.time_to_go_s = np.where(
            track.hazard["status"][:, 0] == 0, track.hazard["tcpa_s"][:, 0], np.nan
        )
        velocity.append(inputs.truth.velocity_ned_m_s)
        closing = inputs.truth.path_velocity_ned_m_s[0] - np.append(velocity[-1], 0.0)
        left.append(approach.closest(inputs.truth, 0, closing).time_s - inputs.time_s)
        if inputs.time_s[-1] >= 4.0:
            soon.append(bool(has(track, MOVES)[inputs.time_s <= 4.0].any()))
    assert np.mean(soon) >= 0.8, (np.mean(soon), len(soon))
    assert judging.time_error(outcomes, left, "move", 1.0) < 10.0
    assert judging.velocity_covered(outcomes, velocity) >= 88.0


# ------------------------------------------------------------------------------------------------------------- invalid


NAN, INF = math.nan, math.inf
INVALID = {
    "width NaN": ((NAN, 0.5, 0.0, 0.0), goe.Status.NOT_FINITE),
    "width sigma NaN": ((3.0, NAN, 0.0, 0.0), goe.Status.NOT_FINITE),
    "height NaN": ((0.0, 0.0, NAN, 0.5), goe.Status.NOT_FINITE),
    "height sigma NaN": ((0.0, 0.0, 3.0, NAN), goe.Status.NOT_FINITE),
    "width inf": ((INF, 0.5, 0.0, 0.0), goe.Status.NOT_FINITE),
    "width sigma inf": ((3.0, INF, 0.0, 0.0), goe.Status.NOT_FINITE),
    "height -inf": ((0.0, 0.0, -INF, 0.5), goe.Status.NOT_FINITE),
    "height sigma inf": ((0.0, 0.0, 3.0, INF), goe.Status.NOT_FINITE),
    "negative width": ((-3.0, 0.5, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "negative height": ((0.0, 0.0, -3.0, 0.5), goe.Status.OUT_OF_RANGE),
    "negative width sigma": ((3.0, -0.5, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "negative height sigma": ((0.0, 0.0, 3.0, -0.5), goe.Status.OUT_OF_RANGE),
    "no width sigma": ((3.0, 0.0, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "no height sigma": ((0.0, 0.0, 3.0, 0.0), goe.Status.OUT_OF_RANGE),
    "small width sigma": ((3.0, 0.029, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "small height sigma": ((0.0, 0.0, 3.0, 0.029), goe.Status.OUT_OF_RANGE),
    "large width": ((1001.0, 50.0, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "large height": ((0.0, 0.0, 1001.0, 50.0), goe.Status.OUT_OF_RANGE),
    "large width sigma": ((3.0, 1001.0, 0.0, 0.0), goe.Status.OUT_OF_RANGE),
    "large height sigma": ((0.0, 0.0, 3.0, 1001.0), goe.Status.OUT_OF_RANGE),
    "shape 3": ((0.0, 0.0, 0.0, 0.0, 3), goe.Status.OUT_OF_RANGE),
    "shape 255": ((3.0, 0.5, 3.0, 0.5, 255), goe.Status.OUT_OF_RANGE),
}
BAD_AT = 9  # image


def c_images(inputs: Inputs, kind: np.ndarray | None) -> np.ndarray:
    return goe.Images(
        np.rint(inputs.time_s * 1e6).astype(np.int64), inputs.position_ned_m, inputs.attitude, inputs.height_m,
        inputs.box_px, inputs.pixel_px, inputs.seen,
        kind=None if kind is None else np.broadcast_to(kind, (len(inputs.time_s), 5)),
    ).to_c()  # fmt: skip


@pytest.mark.parametrize("features", SEEN)
@pytest.mark.parametrize("case", INVALID)
def test_an_invalid_class_is_refused(case: str, features: str) -> None:
    """[A16, A17, A21] With each mix of features; afterward the estimate is that of a twin without the image."""
    bad, status = INVALID[case]
    inputs = flights(SEEN[features], range(6700, 6701))[0]
    settings = goe.Settings.from_names(inputs.settings)
    images = c_images(inputs, right(inputs.truth.solid, np.random.default_rng(6)))
    twin = goe.run(settings, np.delete(images, BAD_AT))
    names = ("width_m", "width_sd_m", "height_m", "height_sd_m", "shape")
    for name, value in zip(names, (*bad, 0)):
        images["kind"][name][BAD_AT] = value
    track = goe.run(settings, images)
    assert track.status[BAD_AT] == status
    assert not track.estimates["fresh"][BAD_AT]
    kept = np.delete(np.arange(len(images)), BAD_AT)
    for name in track.estimates.dtype.names or ():
        if name not in ("age_s", "sigma"):
            np.testing.assert_array_equal(track.estimates[name][kept], twin.estimates[name], name)
    np.testing.assert_array_equal(track.estimates["sigma"][kept], twin.estimates["sigma"])
    np.testing.assert_array_equal(track.status[kept], twin.status)


@pytest.mark.parametrize(
    "kind", [(0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.5, 0.0, 0.5, 0.0), (1000.0, 1000.0, 1000.0, 10.0, 2.0)]
)
def test_the_limits_are_accepted(kind: tuple[float, ...]) -> None:
    inputs = flights(BOXES, range(6710, 6711))[0]
    track = goe.run(goe.Settings.from_names(inputs.settings), c_images(inputs, np.array(kind)))
    assert not np.isin(track.status, [goe.Status.NOT_FINITE, goe.Status.OUT_OF_RANGE]).any()
    if kind[0] == 0.0:  # not known
        none = goe.run(goe.Settings.from_names(inputs.settings), c_images(inputs, None))
        np.testing.assert_array_equal(track.estimates, none.estimates)


def test_the_package_names_the_shapes() -> None:
    """[GOE_KIND_ROUND] And not those of the setting ``model`` by the same name."""
    assert goe.Image().kind.shape is goe.KindShape.UNKNOWN
    assert [(shape.name, int(shape)) for shape in goe.KindShape] == [("UNKNOWN", 0), ("ROUND", 1), ("OTHER", 2)]


# ------------------------------------------------------------------------------------------------------------ warnings


def classes(inputs: Inputs) -> dict[str, np.ndarray]:
    """(K, 5) each."""
    count = len(inputs.time_s)
    known = right(inputs.truth.solid, np.random.default_rng([7, inputs.number]))
    image = np.arange(count)[:, None]
    sizes = np.array([1.0, 1.0, 1.0, 1.0, 0.0])
    return {
        "right": np.tile(known, (count, 1)),
        "three times too large": np.tile(known * 3.0 * sizes, (count, 1)),
        "three times too small": np.tile(known / 3.0 * sizes, (count, 1)),
        "late": np.where(image < 20, 0.0, known),
        "late and too large": np.where(image < 20, 0.0, known * 3.0 * sizes),
        "changing": np.where(image % 2 == 0, SORTS["car"].stated(), SORTS["truck"].stated()),
    }


@pytest.mark.parametrize("features", ["boxes", "outline", "corners"])
def test_no_class_takes_a_warning_away(features: str) -> None:
    """[goe_decide] Each violator is warned as early as the campaigns of ``approach`` want it, whatever the class."""
    violators, lost = 0, []
    for inputs in flights(approach.HAZARD_BASE.by(features=features), range(6801, 6861)):
        true = approach.closest(inputs.truth)
        if not (true.violates and true.time_s > approach.AHEAD_S):
            continue
        violators += 1
        for name, kind in ({"none": None} | classes(inputs)).items():
            acts = track_of(inputs, kind).hazard["act"][:, 1]
            first_s = inputs.time_s[np.argmax(acts)] if acts.any() else math.inf
            if true.time_s - first_s < approach.AHEAD_S:
                lost.append((name, inputs.number, round(true.time_s - first_s, 1)))
    assert violators > 12
    assert not lost, lost


# --------------------------------------------------------------------------------------------------------------- round


def test_a_round_obstacle_is_a_disc() -> None:
    """[GOE_KIND_ROUND] By points, with and without a size."""
    for size in (False, True):
        inside = []
        for inputs in flights(SEEN["outline"].by(kind="cylinder"), range(7000, 7030)):
            known = right(inputs.truth.solid, np.random.default_rng([8, inputs.number]))
            track = track_of(inputs, known * ([1, 1, 1, 1, 1] if size else [0, 0, 0, 0, 1]))
            answered = track.valid[:, Z0]
            assert (track.model[answered] == MODEL_DISC).all()
            outcome = judged(inputs, track)
            inside += [np.mean(ratios(outcome, q) < 2.0) for q in (X0, Z0) if len(ratios(outcome, q))]
        assert np.mean(inside) > 0.9, (size, np.mean(inside))


def test_another_shape_is_no_disc() -> None:
    """[GOE_KIND_OTHER] Also with the model disc; unknown: that model counts."""
    disc = {"model": float(MODEL_DISC)}
    for inputs in flights(SEEN["outline"].by(kind="box"), range(7100, 7120)):
        other, unknown, plain = (
            track_of(inputs, kind, settings)
            for kind, settings in ((np.eye(5)[4] * OTHER, disc), (None, disc), (None, {}))
        )
        np.testing.assert_array_equal(other.values, plain.values)
        np.testing.assert_array_equal(other.sigma, plain.sigma)
        assert (other.model[other.valid[:, Z0]] != MODEL_DISC).all()
        assert (unknown.model[unknown.valid[:, Z0]] == MODEL_DISC).all()
