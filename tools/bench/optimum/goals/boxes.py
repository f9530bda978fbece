"""Upright bounding boxes as detectors report them: simulated, of KITTI's parked cars, of ODMD.

Settings are the defaults except for the camera and the settings in a line's name. Z0, X0 and H are judged in all images
with an answer; "at the end" is a track's last answer. Shares of answers are computed per track and then averaged, so
all tracks have the same weight."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from goe_tools.flights import box_logs
from goe_tools.flights.boxes import BUILDING, MAST, WALL, BoxOptions, Solid, box_flight
from goe_tools.flights.flight import Flight
from goe_tools.library import METHODS, camera_settings, estimate
from goe_tools.models.coverage import BoxOutcome, coverage
from goe_tools.models.judge import HEIGHT, X0, Z0
from goe_tools.models.prism import ErrorModel
from goe_tools.models.prism_bound import bound_of
from goe_tools.models.prism_offline import fit
from goe_tools.spread import each

from ...attack.judging import CONFIDENT_IMAGES, is_confidently_wrong
from .goal import OPEN, Goal, Range, named, names_of
from .measures import nan_quantile
from .work import Amount

JUDGED = (X0, Z0, HEIGHT)
ROLLS_DEG = (0.0, 5.0, 10.0, 25.0)
SMALL_ROLL_DEG = 5.0  # for goals that do not depend on roll
COVERED: Range = (90.0, 100.0)
COVERED_RECORDED: Range = (88.0, 100.0)  # also Z0 of walls, which show only their near end
CONFIDENT_MOST: Range = (0.0, 1.0)  # % of the tracks
FIRST_MOST: Range = (0.0, 6.0)  # images until the first answer
BOUND_ROLLS_DEG = (0.0, 2.0, 5.0, 10.0, 25.0)
BOUND_MOST: Range = (0.0, 1.3)
LEVEL = {"height_white_sd_m": 0.0, "terrain_height_sd_m": 0.0, "terrain_slope_sd": 0.0}
BOUND_NOISE = ErrorModel(box_noise_px=0.5, box_noise_rel=0.0, disc=True, **LEVEL)  # the simulated noise
FIT_MOST: Range = (0.0, 1.3)
KITTI_PATH_M = 3.0
NO_ALTIMETER = {"navigation.height_bias_sd_m": 1000.0}
ODMD_SETTINGS = {  # no ground; positions as perturbed by the authors of the sets
    "val_robot": {**NO_ALTIMETER, "navigation.position_white_sd_m": 2.0},
    "val_perturb_motion": {**NO_ALTIMETER, "navigation.position_white_sd_m": 2.0},
    "val_perturb_detection": {**NO_ALTIMETER, "navigation.position_white_sd_m": 0.01},
}
EVERY_TRACK = {"filter.range_sd_rel_max": 10.0}  # reports a range of any uncertainty
ODMD_MEAN: dict[str, Range] = {
    "val_robot": (0.0, 11.2), "val_perturb_motion": (0.0, 5.0), "val_perturb_detection": (0.0, 4.0),
}  # fmt: skip
ODMD_MEDIAN: dict[str, Range] = {"val_perturb_detection": (0.0, 1.2)}


@dataclass(frozen=True)
class Simulated:
    """A flight to simulate and judge, and the settings that differ from the defaults."""

    solid: Solid
    options: BoxOptions
    seed: int
    settings: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Recorded:
    flight: Flight
    settings: dict[str, float] = field(default_factory=dict)


def _outcome(flight: Flight, settings: dict[str, float]) -> BoxOutcome:
    track = estimate(flight, {**camera_settings(flight), **settings})
    judged = track.valid & (track.method == METHODS["filter"])[:, None]
    judged[:, [i for i in range(6) if i not in JUDGED]] = False
    error, sigma = (np.where(judged, a, np.nan) for a in (track.values - flight.truth.values, track.sigma))
    return BoxOutcome(flight, error, sigma, track.suspect)


def perform(task: Simulated | Recorded) -> BoxOutcome:
    """Runs the library over a flight."""
    if isinstance(task, Recorded):
        return _outcome(task.flight, task.settings)
    return _outcome(box_flight(task.solid, task.options, task.seed), task.settings)


def over_bound(task: Simulated) -> np.ndarray:
    """(6,): error of a flight's last answers over the Cramer-Rao bound of the noise in ``BOUND_NOISE``."""
    outcome = perform(task)
    return last_errors([outcome])[0] / bound_of(outcome.flight, BOUND_NOISE)


def with_fit(task: Simulated) -> np.ndarray:
    """(2, 6): absolute errors of a flight's last answers, and of the offline fit with the same configuration."""
    outcome = perform(task)
    best = fit(outcome.flight, _gauss_errors(task.solid))
    return np.array([last_errors([outcome])[0], np.abs(best.values - outcome.flight.truth.values)])


# ------------------------------------------------------------------------------------------------------------- figures


def _rmse(errors: np.ndarray) -> np.ndarray:
    """Along the first axis, without NaN; NaN for columns without a number."""
    there = np.isfinite(errors)
    return np.sqrt(np.where(there.any(0), np.nansum(errors**2, 0) / np.maximum(there.sum(0), 1), math.nan))


def last_errors(outcomes: Sequence[BoxOutcome]) -> np.ndarray:
    """(n, 6): absolute error of each track's last answer, NaN without one."""
    result = np.full((len(outcomes), 6), math.nan)
    for i, o in enumerate(outcomes):
        for quantity in JUDGED:
            known = np.flatnonzero(np.isfinite(o.error[:, quantity]))
            if len(known):
                result[i, quantity] = abs(o.error[known[-1], quantity])
    return result


def images_until_answer(outcome: BoxOutcome) -> float:
    """Up to and including the first image with a position; infinite without one."""
    known = np.flatnonzero(np.isfinite(outcome.error[:, Z0]))
    return float(known[0] + 1) if len(known) else math.inf


def _share(flags: Sequence[bool]) -> float:
    return 100.0 * float(np.mean(flags))


def _named(values: np.ndarray) -> dict[str, float]:
    return named(values[list(JUDGED)], JUDGED)


def _line(group: str, name: str, unit: str, quantity: int, value: float, wanted: Range | None = None) -> Goal:
    """A line for one quantity; without ``wanted`` for information."""
    names = names_of((quantity,))
    return Goal(group, name, unit, {names[0]: float(value)}, wanted or OPEN, names if wanted else ())


# ----------------------------------------------------------------------------------------------------------- simulated


def _fly(
    solid: Solid, options: BoxOptions, amount: Amount, title: str, settings: dict[str, float] | None = None
) -> list[BoxOutcome]:
    tasks = [Simulated(solid, options, seed, settings or {}) for seed in range(1, amount.boxes + 1)]
    return each(perform, tasks, amount.workers, title)


def _coverage_goal(group: str, name: str, outcomes: Sequence[BoxOutcome], *asked: int) -> Goal:
    return Goal(group, f"{name}: within 2 sigma", "%", _named(coverage(outcomes)), COVERED, names_of(asked))


def _roll_goals(group: str, amount: Amount) -> list[Goal]:
    """Banked flight with a detector's noise."""
    result = []
    for solid in (MAST, BUILDING, WALL):
        by_roll = {
            roll: _fly(solid, BoxOptions(roll_deg=roll), amount, f"{group} {solid.name} {roll:g}") for roll in ROLLS_DEG
        }
        for roll, outcomes in by_roll.items():
            name = f"{solid.name}, roll {roll:g} deg"
            if solid is WALL:
                goal = _coverage_goal(group, name, outcomes, X0, HEIGHT)
                z0 = goal.values.pop("Z0")
                result += [goal, _line(group, f"{goal.name}, Z0", "%", Z0, z0, COVERED_RECORDED)]
            else:
                result.append(_coverage_goal(group, name, outcomes, *JUDGED))
            errors = nan_quantile(last_errors(outcomes), 0.5)
            result.append(Goal(group, f"{name}: error at the end, median", "m", _named(errors)))
        wrong = {_roll_name(r): _wrong_share(flown) for r, flown in by_roll.items()}
        first = {_roll_name(r): max(images_until_answer(o) for o in flown) for r, flown in by_roll.items()}
        name = f"{solid.name}: wrong by 5 sigma, {CONFIDENT_IMAGES} consecutive images"
        result.append(Goal(group, name, "%", wrong, CONFIDENT_MOST, tuple(wrong)))
        name = f"{solid.name}: first answer, latest flight"
        result.append(Goal(group, name, "images", first, FIRST_MOST, tuple(first)))
    return result


def _wrong_share(outcomes: Sequence[BoxOutcome]) -> float:
    """Share of the tracks with an answer; silent tracks are not counted as right."""
    answered = [o for o in outcomes if math.isfinite(images_until_answer(o))]
    return _share([is_confidently_wrong(o) for o in answered]) if answered else math.nan


def _roll_name(roll_deg: float) -> str:
    return f"{roll_deg:g} deg"


def _gauss_goals(group: str, amount: Amount) -> list[Goal]:
    """White noise alone in the boxes, otherwise as above."""
    result = []
    for roll in ROLLS_DEG:
        options = BoxOptions(roll_deg=roll, box_noise_px=0.5, box_noise_rel=0.0)
        outcomes = _fly(BUILDING, options, amount, f"{group} {roll:g}")
        name = f"{BUILDING.name}, roll {roll:g} deg"
        first_range = [math.hypot(o.flight.truth.x0_m, o.flight.truth.z0_m) for o in outcomes]
        share = 100.0 * last_errors(outcomes)[:, Z0] / first_range
        median = nan_quantile(share[:, None], 0.5)[0]
        result.append(_line(group, f"{name}: Z0 over first range, median", "%", Z0, median, (0.0, 1.0)))
        result.append(_coverage_goal(group, name, outcomes, Z0))
    return result


def _gauss_errors(solid: Solid) -> ErrorModel:
    """The noise of a mast; the defaults for a building, whose corners are a correlated error of the ellipse."""
    return BOUND_NOISE if solid == MAST else ErrorModel()  # compared by value: worker processes have copies


def _gauss_tasks(solid: Solid, roll_deg: float, amount: Amount) -> list[Simulated]:
    """White noise alone in the boxes."""
    usual = ErrorModel().settings()
    settings = {name: value for name, value in _gauss_errors(solid).settings().items() if value != usual[name]}
    options = BoxOptions(
        roll_deg=roll_deg, box_noise_px=BOUND_NOISE.box_noise_px, box_noise_rel=BOUND_NOISE.box_noise_rel
    )
    return [Simulated(solid, options, seed, settings) for seed in range(1, amount.boxes + 1)]


def _bound_goals(group: str, amount: Amount) -> list[Goal]:
    """Errors at the end over the Cramer-Rao bound: a mast, white noise alone in the boxes."""
    result = []
    for roll in BOUND_ROLLS_DEG:
        tasks = _gauss_tasks(MAST, roll, amount)
        ratio = _rmse(np.array(each(over_bound, tasks, amount.workers, f"{group} bound {roll:g}")))
        name = f"{MAST.name}, roll {roll:g} deg: RMSE / bound"
        result.append(Goal(group, name, "1", _named(ratio), BOUND_MOST, names_of(JUDGED)))
    return result


def _fit_goals(group: str, amount: Amount) -> list[Goal]:
    """Errors at the end over those of the fit of all images at once."""
    result = []
    for solid in (MAST, BUILDING):
        for roll in ROLLS_DEG:
            tasks = _gauss_tasks(solid, roll, amount)
            errors = np.array(each(with_fit, tasks, amount.workers, f"{group} {solid.name} fit {roll:g}"))
            ours = errors[:, 0]
            best = np.where(np.isfinite(ours), errors[:, 1], math.nan)
            name = f"{solid.name}, roll {roll:g} deg"
            result.append(Goal(group, f"{name}: RMSE of the offline fit", "m", _named(_rmse(best))))
            ratio = _named(_rmse(ours) / _rmse(best))
            result.append(Goal(group, f"{name}: filter / offline fit", "1", ratio, FIT_MOST, names_of(JUDGED)))
    return result


def _height_goals(group: str, amount: Amount) -> list[Goal]:
    """Noisy or missing altimeters, and terrain that is not level."""
    usual = BoxOptions(roll_deg=SMALL_ROLL_DEG)
    cases: tuple[tuple[str, BoxOptions, dict[str, float]], ...] = (
        ("altimeter noise 1 m", replace(usual, height_white_sd_m=1.0), {}),
        ("altimeter noise 3 m", replace(usual, height_white_sd_m=3.0), {}),
        ("no altimeter", replace(usual, altimeter=False), NO_ALTIMETER),
        ("ground off by 3 m", replace(usual, ground_off_m=3.0), {}),
    )
    result = []
    for solid in (MAST, BUILDING):
        for label, options, settings in cases:
            outcomes = _fly(solid, options, amount, f"{group} {solid.name} {label}", settings)
            result.append(_coverage_goal(group, f"{solid.name}, {label}", outcomes, *JUDGED))
            first = {"latest flight": max(images_until_answer(o) for o in outcomes)}
            result.append(Goal(group, f"{solid.name}, {label}: first answer", "images", first))
    return result


# ------------------------------------------------------------------------------------------------------------ recorded


def _kitti_goals(group: str, outcomes: Sequence[BoxOutcome]) -> list[Goal]:
    """Parked cars of one feed."""
    error = last_errors(outcomes)
    z0_share = 100.0 * error[:, Z0] / [o.flight.truth.z0_m for o in outcomes]
    median = nan_quantile(error, 0.5)
    z0_median, z0_90th = (nan_quantile(z0_share[:, None], share)[0] for share in (0.5, 0.9))
    none = {"tracks": _share([not math.isfinite(images_until_answer(o)) for o in outcomes])}
    return [
        Goal(group, f"within 2 sigma, {len(outcomes)} parked cars", "%", _named(coverage(outcomes)), COVERED_RECORDED,
             names_of((X0, Z0))),
        _line(group, "Z0 error at the end, median", "%", Z0, z0_median, (0.0, 2.0)),
        _line(group, "Z0 error at the end, 90th percentile", "%", Z0, z0_90th, (0.0, 8.0)),
        _line(group, "X0 error at the end, median", "m", X0, median[X0], (0.0, 0.2)),
        _line(group, "H error at the end, median", "m", HEIGHT, median[HEIGHT], (0.0, 0.1)),
        Goal(group, "no answer", "%", none, (0.0, 5.0), ("tracks",)),
    ]  # fmt: skip


def _depth_figures(outcomes: Sequence[BoxOutcome]) -> dict[str, float]:
    """Depth at each track's last image, percent; mean, median and coverage over the tracks with an answer."""
    depth = np.array([box_logs.final_depth(o.flight) for o in outcomes])
    error = np.array([o.error[-1, Z0] for o in outcomes])
    sigma = np.array([o.sigma[-1, Z0] for o in outcomes])
    there = np.isfinite(error)
    if not there.any():
        return {"mean": math.nan, "median": math.nan, "within 2 sigma": math.nan, "answered": 0.0}
    share = 100.0 * np.abs(error[there]) / depth[there]
    return {
        "mean": float(np.mean(share)),
        "median": float(np.median(share)),
        "within 2 sigma": _share(np.abs(error[there]) < 2 * sigma[there]),
        "answered": _share(there),
    }


def _odmd_goals(group: str, name: str, tracks: Sequence[Flight], amount: Amount) -> list[Goal]:
    """Depth at the last image of every track, as other methods are judged, and of the tracks that the defaults
    answer."""
    settings = ODMD_SETTINGS[name]
    every = [Recorded(f, {**settings, **EVERY_TRACK}) for f in tracks]
    figures = _depth_figures(each(perform, every, amount.workers, group))
    return [
        _line(group, "depth error, mean", "%", Z0, figures["mean"], ODMD_MEAN[name]),
        _line(group, "depth error, median", "%", Z0, figures["median"], ODMD_MEDIAN.get(name)),
        _line(group, "within 2 sigma", "%", Z0, figures["within 2 sigma"], COVERED_RECORDED),
        Goal(group, f"answered, of {len(tracks)}", "%", {"tracks": figures["answered"]}, (100.0, 100.0), ("tracks",)),
        Goal(group, "depth error with default settings", "%", _depth_figures(
            each(perform, [Recorded(f, settings) for f in tracks], amount.workers, group))),
    ]  # fmt: skip


def recorded_goals(group: str, amount: Amount) -> list[Goal]:
    """Goals for the folder of recorded boxes."""
    result, absent = [], []
    feeds = box_logs.kitti_feeds()
    for feed in feeds:
        tasks = [Recorded(f) for f in box_logs.kitti_box_flights(feed) if f.truth.static and f.path_m() > KITTI_PATH_M]
        if tasks:
            title = f"{group}: KITTI, {feed.name}"
            result += _kitti_goals(title, each(perform, tasks, amount.workers, title))
    if not feeds:
        absent.append("KITTI's boxes")
    for name in box_logs.ODMD_SETS:
        folder = box_logs.odmd_folder(name)
        if folder is None:
            absent.append(f"ODMD's {name}")
            continue
        result += _odmd_goals(f"{group}: ODMD, {name}", name, list(box_logs.odmd_flights(folder)), amount)
    if absent:
        print(f"left out: {', '.join(absent)}: not in {box_logs.boxes_folder()}")
    return result


def boxes_group(group: str, amount: Amount) -> list[Goal]:
    """Upright bounding boxes instead of points."""
    result = _roll_goals(f"{group}: detector noise, rolling", amount)
    result += _gauss_goals(f"{group}: Gaussian 0.5 px", amount)
    result += _bound_goals(f"{group}: Gaussian 0.5 px", amount)
    result += _fit_goals(f"{group}: Gaussian 0.5 px", amount)
    result += _height_goals(f"{group}: height above ground", amount)
    return result + recorded_goals(group, amount)
