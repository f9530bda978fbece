"""Every figure that the project promises, beside the figure that is reached.

Flights are simulated here (``flights``), not by goe_sim, so that thousands take seconds; the recorded flights and
KITTI's logs are used where they lie beside the project. The estimator is the C library as firmware would run it.

    python -m goe_tools goals [--quick] [--only GROUP,...] [--json FILE] [--jobs N]
"""

from __future__ import annotations

import argparse
import json
import math
import multiprocessing
import signal
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from tqdm import tqdm

from . import offline
from .bound import bound
from .flights.flight import QUANTITIES, Flight, Obstacle
from .flights.logged import KITTI_FOLDER, kitti_flights
from .flights.measured import measure
from .flights.noise import NOISES, Noise
from .flights.recorded import RECORDED_FOLDER, recorded_scenes
from .flights.rotations import fold
from .flights.scene import Scene
from .flights.simulated import paper_scenes, random_scenes
from .judge import DISC_QUANTITIES, HEIGHT, LENGTH, ORIENTATION, WIDTH, X0, Z0, Judgement, judge, renamed_sigma
from .library import METHODS, Track, estimate, library_path, settings_of
from .paper_table3 import FRACTION, MOST, PAPER_TABLE3, TABLE3_QUANTITIES, holding_range
from .precision import Rounding, rounding_of

NAMES = ("X0", "Z0", "orientation", "W", "L", "H")
ALL = tuple(range(6))
UNITS = np.where(np.arange(6) == ORIENTATION, 180.0 / math.pi, 1.0)  # angles are told in degrees
Figures = dict[str, float]
Result = TypeVar("Result")
Range = tuple[float, float]  # what is wanted, ends included
OPEN = (-math.inf, math.inf)
KNOWN_SHARE = 0.1  # the range counts as known when two sigma are less than this share of it
KITTI_PATH_M = 3.0
FALSE_FLAGS = (0.0, 0.02, 0.05, 0.1, 0.2)
FALSE_ALLOWED = 0.05
COVERAGE = (90.0, 98.0)
SUSPECT_IMAGES = 8  # before which the library suspects nothing
ROUNDING_MOST = 0.05  # of one sigma
ROUNDING_TITLE = "float32 against float64"


@dataclass
class Goal:
    """A line of the table. ``wanted`` holds for the values named in ``asked``; without, it is told for information."""

    group: str
    name: str
    unit: str
    values: Figures
    wanted: Range = OPEN
    asked: tuple[str, ...] = ()

    @property
    def met(self) -> bool | None:
        if not self.asked:
            return None
        low, high = self.wanted
        return all(low <= self.values.get(name, math.nan) <= high for name in self.asked)

    @property
    def missed(self) -> tuple[str, ...]:
        low, high = self.wanted
        return tuple(name for name in self.asked if not low <= self.values.get(name, math.nan) <= high)


@dataclass
class Amount:
    """How much is computed."""

    seeds: int
    field_seeds: int
    random: int
    offline: int  # of the first seed's flights with field noise, drawn at random
    rivals: int  # likewise
    recorded: int  # passes of each recorded flight and seed
    recorded_seeds: int
    precision_seeds: int
    jobs: int = 1
    worst: int = 0  # flights to be named, those of the largest NEES


QUICK = Amount(
    seeds=6, field_seeds=4, random=100, offline=90, rivals=40, recorded=40, recorded_seeds=2,
    precision_seeds=1,
)  # fmt: skip
FULL = Amount(
    seeds=24, field_seeds=16, random=400, offline=10**6, rivals=300, recorded=60, recorded_seeds=3,
    precision_seeds=3,
)  # fmt: skip


# -------------------------------------------------------------------------------------------------------------- flights


@dataclass
class Task:
    scene: Scene
    noise: Noise
    seed: tuple[int, int]
    bound: bool = False
    offline: bool = False
    rivals: bool = False


@dataclass
class Outcome:
    """One flight: what the refined method and the window method answer, image by image."""

    name: str
    group: str
    truth: Obstacle
    time_s: np.ndarray
    reach_s: float
    refined: Judgement
    window: Judgement
    covariance: np.ndarray  # (6, 6) at the end
    nis: float  # sums over the track
    nis_rows: float
    misfit: float  # at the end
    misfit_most: float  # over the track
    suspect: bool  # in any image
    answered: int  # images with an answer
    answered_by_window: int
    bound: np.ndarray | None = None  # (6,) under the naming of the last answer
    offline: np.ndarray | None = None  # (6,) errors
    rivals: dict[str, np.ndarray] = field(default_factory=dict)  # errors (6,) at the end
    seed: tuple[int, ...] = ()

    @property
    def box(self) -> bool:
        return self.truth.kind == "box"


def _refined_only(track: Track) -> Track:
    """Without the answers that the window method gave before the refined one had started: their sigmas mean less."""
    track.values[track.method != METHODS["refined"]] = np.nan
    return track


def _misfit_most(track: Track) -> float:
    """The largest misfit from the image on from which it counts."""
    return float(track.misfit[np.cumsum(track.nis_rows > 0) >= SUSPECT_IMAGES].max(initial=0.0))


def outcome_of(flight: Flight) -> Outcome:
    """Runs both methods over a flight."""
    track = estimate(flight)
    position = track.valid[:, Z0]
    by_window = int((position & (track.method == METHODS["window"])).sum())
    window = estimate(flight, settings_of(flight, method="window"))
    return Outcome(
        flight.name, flight.group, flight.truth, flight.time_s, flight.reach_s, judge(_refined_only(track), flight),
        judge(window, flight), track.covariance[-1], float(track.nis.sum()), float(track.nis_rows.sum()),
        float(track.misfit[-1]), _misfit_most(track), bool(track.suspect.any()), int(position.sum()), by_window,
    )  # fmt: skip


def perform(task: Task) -> Outcome:
    flight = measure(task.scene, task.noise, task.seed)
    result = outcome_of(flight)
    result.seed = task.seed
    if task.bound:
        best = bound(flight)
        last = result.refined.renamed[-1]
        result.bound = renamed_sigma(flight.truth, best.covariance) if last else best.sigma
    if task.offline:
        result.offline = _offline_error(flight)
    if task.rivals:
        result.rivals = _rival_errors(flight)
    return result


def _offline_error(flight: Flight) -> np.ndarray:
    error = offline.fit(flight).values - flight.truth.values
    error[ORIENTATION] = fold(error[ORIENTATION])
    return np.where(True if flight.truth.kind == "box" else DISC_QUANTITIES, error, np.nan)


def _each(work: Callable[[Task], Result], tasks: Sequence[Task], jobs: int, title: str) -> list[Result]:
    progress = {"total": len(tasks), "desc": title, "disable": None, "leave": False}
    if jobs == 1:
        return [work(task) for task in tqdm(tasks, **progress)]
    with multiprocessing.Pool(jobs, signal.signal, (signal.SIGINT, signal.SIG_IGN)) as pool:  # Ctrl-C: ours alone
        return list(tqdm(pool.imap(work, tasks, chunksize=8), **progress))


def _perform_all(tasks: Sequence[Task], amount: Amount, title: str) -> list[Outcome]:
    outcomes = _each(perform, tasks, amount.jobs, title)
    print_worst(title, outcomes, amount.worst)
    return outcomes


# ------------------------------------------------------------------------------------------------------------- figures


def _named(values: Iterable[float], numbers: Sequence[int] = ALL) -> Figures:
    return {NAMES[i]: float(v) for i, v in zip(numbers, values)}


def _nan_quantile(values: np.ndarray, share: float) -> np.ndarray:
    """Along the first axis; NaN for columns without a number."""
    columns = [column[np.isfinite(column)] for column in values.T]
    return np.array([np.quantile(column, share) if len(column) else math.nan for column in columns])


def _ends(outcomes: Sequence[Outcome], method: str = "refined") -> np.ndarray:
    """(n, 6): errors at the end, NaN without an answer."""
    return np.array([getattr(o, method).error[-1] for o in outcomes])


def _asked(numbers: Sequence[int]) -> tuple[str, ...]:
    return tuple(NAMES[i] for i in numbers)


def efficiency(outcomes: Sequence[Outcome]) -> np.ndarray:
    """(cases, 6): RMSE over the seeds at the end of the run over the bound, of each case."""
    by_case: dict[str, list[np.ndarray]] = {}
    for o in outcomes:
        if o.bound is not None:
            by_case.setdefault(o.name, []).append(o.refined.error[-1] / np.maximum(o.bound, 1e-12))
    with np.errstate(invalid="ignore"):
        squares = [np.array(rows) ** 2 for rows in by_case.values()]
    rows = []
    for square in squares:
        count = np.isfinite(square).sum(0)
        rows.append(np.sqrt(np.where(count > 0, np.nansum(square, 0) / np.maximum(count, 1), np.nan)))
    return np.array(rows)


def efficiency_goals(group: str, outcomes: Sequence[Outcome], median: float, tail: float | None) -> list[Goal]:
    ratios = efficiency(outcomes)
    cases = len({o.name for o in outcomes})
    result = [
        Goal(group, f"RMSE / bound, median of {cases} cases", "1", _named(_nan_quantile(ratios, 0.5)),
             (0.0, median), NAMES),
        Goal(group, "RMSE / bound, 90th percentile", "1", _named(_nan_quantile(ratios, 0.9)),
             (0.0, tail or math.inf), NAMES if tail else ()),
    ]  # fmt: skip
    return result


def _share(hits: np.ndarray, there: np.ndarray) -> np.ndarray:
    """(6,) in percent, of boolean (n, 6)."""
    count = there.sum(0)
    return np.where(count > 0, 100.0 * (hits & there).sum(0) / np.maximum(count, 1), math.nan)


def coverage_goals(group: str, outcomes: Sequence[Outcome], wanted: Range = COVERAGE, asked: bool = True) -> list[Goal]:
    """How often the truth lies within two sigma: over all images with an answer, in the first of them, at the end."""
    result = []
    for label, box in (("boxes", True), ("cylinders", False)):
        chosen = [o for o in outcomes if o.box == box]
        if not chosen:
            continue
        numbers = ALL if box else tuple(np.flatnonzero(DISC_QUANTITIES))
        inside, there, first, last = [], [], [], []
        for o in chosen:
            valid = np.isfinite(o.refined.error) & np.isfinite(o.refined.sigma)
            with np.errstate(invalid="ignore"):
                hit = valid & (np.abs(o.refined.error) < 2 * o.refined.sigma)
            inside.append(hit)
            there.append(valid)
            start = np.argmax(valid, 0)
            first.append((hit[start, ALL], valid.any(0)))
            last.append((hit[-1], valid[-1]))
        shares = {
            "all answers": _share(np.concatenate(inside), np.concatenate(there)),
            "first answers": _share(*(np.array(part) for part in zip(*first))),
            "at the end": _share(*(np.array(part) for part in zip(*last))),
        }
        for name, share in shares.items():
            values = _named(share[list(numbers)], numbers)
            result.append(
                Goal(group, f"within 2 sigma, {label}, {name}", "%", values, wanted, _asked(numbers) if asked else ())
            )
        valid_share = 100.0 * np.array([part[1] for part in last]).mean(0)
        result.append(Goal(group, f"answers at the end, {label}", "%", _named(valid_share[list(numbers)], numbers)))
    return result


def nees(outcome: Outcome) -> float:
    """Normalised error squared over the number of quantities at the end; NaN unless all are answered."""
    numbers = np.arange(6) if outcome.box else np.flatnonzero(DISC_QUANTITIES)
    error = outcome.refined.error[-1, numbers]
    covariance = outcome.covariance[np.ix_(numbers, numbers)]
    if not np.isfinite(error).all() or (np.diag(covariance) <= 0).any():
        return math.nan
    scale = 1 / np.sqrt(np.diag(covariance))
    try:
        return float((error * scale) @ np.linalg.solve(covariance * np.outer(scale, scale), error * scale)) / len(error)
    except np.linalg.LinAlgError:
        return math.nan


def consistency_goals(group: str, outcomes: Sequence[Outcome], asked: bool) -> list[Goal]:
    result = []
    for label, box, size in (("boxes", True, 6), ("cylinders", False, 4)):
        chosen = [o for o in outcomes if o.box == box]
        ratios = np.array([nees(o) for o in chosen])
        ratios = ratios[np.isfinite(ratios)]
        if not len(ratios):
            continue
        half = 1.96 * math.sqrt(2.0 / (size * len(ratios)))
        rows = sum(o.nis_rows for o in chosen)
        values = {
            "mean": float(ratios.mean()), "median": float(np.median(ratios)),
            "mean without worst 1 %": float(np.sort(ratios)[: math.ceil(0.99 * len(ratios))].mean()),
        }  # fmt: skip
        result.append(
            Goal(group, f"NEES over quantities, {label}", "1", values, (1 - half, 1 + half), ("mean",) if asked else ())
        )
        nis = sum(o.nis for o in chosen) / max(rows, 1.0)
        result.append(Goal(group, f"NIS over rows, {label}", "1", {"mean": nis}))
    return result


def window_goals(
    group: str, outcomes: Sequence[Outcome], ratio: float, asked: Sequence[int], worse_asked: bool = True
) -> list[Goal]:
    """Median errors at the end against the window method's on the same flights."""
    ours, theirs = np.abs(_ends(outcomes)), np.abs(_ends(outcomes, "window"))
    sigma = np.array([o.refined.sigma[-1] for o in outcomes])
    both = np.isfinite(ours) & np.isfinite(theirs)
    median = _nan_quantile(np.where(both, ours, np.nan), 0.5)
    window = _nan_quantile(np.where(both, theirs, np.nan), 0.5)
    with np.errstate(invalid="ignore"):
        worse = 1000.0 * (both & (ours > theirs + 3 * sigma)).mean(0)
    return [
        Goal(group, f"median error, {len(outcomes)} flights", "m, deg", _named(median * UNITS)),
        Goal(group, "median error of the window method", "m, deg", _named(window * UNITS)),
        Goal(group, "refined / window", "1", _named(median / window), (0.0, ratio), _asked(asked)),
        Goal(group, "worse than window by > 3 own sigma", "per 1000", _named(worse), (0.0, 1.0),
             NAMES if worse_asked else ()),
    ]  # fmt: skip


def offline_goals(group: str, outcomes: Sequence[Outcome]) -> list[Goal]:
    chosen = [o for o in outcomes if o.offline is not None]
    if not chosen:
        print(f"left out: {offline.MISSING}")
        return []
    ours, best = np.abs(_ends(chosen)), np.abs(np.array([o.offline for o in chosen]))
    both = np.isfinite(ours) & np.isfinite(best)
    median = _nan_quantile(np.where(both, ours, np.nan), 0.5)
    fitted = _nan_quantile(np.where(both, best, np.nan), 0.5)
    asked = _asked((Z0, ORIENTATION, WIDTH, LENGTH))
    return [
        Goal(group, f"median error of the offline fit, {len(chosen)} flights", "m, deg", _named(fitted * UNITS)),
        Goal(group, "refined / offline fit", "1", _named(median / fitted), (0.0, 1.3), asked),
    ]


def start_goals(group: str, outcomes: Sequence[Outcome]) -> list[Goal]:
    answered = sum(o.answered for o in outcomes)
    by_window = sum(o.answered_by_window for o in outcomes)
    share = 100.0 * by_window / max(answered, 1)
    return [Goal(group, "answers", "%", {"by the window method": share}), *suspect_goals(group, outcomes)]


def suspect_goals(group: str, outcomes: Sequence[Outcome]) -> list[Goal]:
    """How often obstacles that do stand still are told as suspect, in whatever image, and how near the others come."""
    flagged = {"in any image": 100.0 * float(np.mean([o.suspect for o in outcomes]))}
    most = np.array([o.misfit_most for o in outcomes])
    values = {"median": float(np.median(most)), "99th": float(np.quantile(most, 0.99)), "most": float(most.max())}
    return [
        Goal(group, f"static, yet told as suspect, {len(outcomes)} flights", "%", flagged),
        Goal(group, "largest misfit of a flight", "1", values),
    ]


# -------------------------------------------------------------------------------------------------------------- groups


def _tasks(noise: str, seeds: int, amount: Amount, **options: object) -> list[Task]:
    scenes = paper_scenes() + random_scenes(amount.random)
    return [
        Task(scene, NOISES[noise], (seed, number), **options)  # type: ignore[arg-type]
        for seed in range(1, seeds + 1)
        for number, scene in enumerate(scenes)
    ]


def _drawn(tasks: list[Task], count: int) -> list[Task]:
    """Some of the tasks, the same ones every time."""
    order = np.random.default_rng(3).permutation(len(tasks))[:count]
    return [tasks[i] for i in sorted(order)]


def gauss_group(group: str, amount: Amount) -> list[Goal]:
    """Gaussian pixel noise, or rounding to whole pixels, and nothing else."""
    outcomes = _perform_all(_tasks(group, amount.seeds, amount, bound=True), amount, group)
    rounding = group == "rounding"
    result = efficiency_goals(group, outcomes, 2.0 if rounding else 1.25, None if rounding else 2.0)
    result += coverage_goals(group, outcomes)
    return result + consistency_goals(group, outcomes, not rounding) + start_goals(group, outcomes)


def field_group(group: str, amount: Amount) -> list[Goal]:
    """All errors of a small aircraft's usual sensors, and outliers."""
    tasks = _tasks("field", amount.field_seeds, amount)
    for task in _drawn(tasks[: len(tasks) // amount.field_seeds], amount.offline):
        task.offline = offline.available()
    outcomes = _perform_all(tasks, amount, group)
    result = window_goals(group, outcomes, 0.4, (Z0, ORIENTATION, WIDTH, LENGTH))
    result += offline_goals(group, outcomes) + coverage_goals(group, outcomes)
    return result + consistency_goals(group, outcomes, False) + start_goals(group, outcomes)


def recorded_group(group: str, amount: Amount) -> list[Goal]:
    """Recorded flights of real autopilots past obstacles put there."""
    result: list[Goal] = []
    scenes = [s for seed in range(amount.recorded_seeds) for s in recorded_scenes(amount.recorded, seed=seed + 1)]
    for autopilot in sorted({scene.group for scene in scenes}):
        tasks = [
            Task(scene, scene.noise, (1, number)) for number, scene in enumerate(scenes) if scene.group == autopilot
        ]
        outcomes = _perform_all(tasks, amount, autopilot)
        name = f"{group} {autopilot}"
        result += window_goals(name, outcomes, 0.5, (Z0, WIDTH, HEIGHT), worse_asked=False)
        result += [g for g in coverage_goals(name, outcomes, (88.0, 100.0)) if "first" not in g.name]
        result += consistency_goals(name, outcomes, False) + start_goals(name, outcomes)
    return result


def _by_obstacle(outcomes: Sequence[Outcome]) -> dict[str, list[Outcome]]:
    result: dict[str, list[Outcome]] = {}
    for o in outcomes:
        result.setdefault(o.group, []).append(o)
    return result


def _extent(outcome: Outcome, quantity: int) -> float:
    """|mean| + 2 sigma of the last answers' errors in Table 3's unit: percent, or metres for the height."""
    errors = outcome.refined.error[:, quantity]
    known = errors[np.isfinite(errors)]
    if not len(known):
        return math.nan
    known = known[int((1 - FRACTION) * len(known)) :]
    size = outcome.truth.values
    if outcome.refined.renamed[-1]:
        size = size[[X0, Z0, ORIENTATION, LENGTH, WIDTH, HEIGHT]]
    scale = 1.0 if quantity == HEIGHT else 100.0 / abs(size[quantity]) if size[quantity] else math.nan
    return float((abs(known.mean()) + 2 * known.std()) * scale)


TABLE3_NUMBERS = dict(zip(TABLE3_QUANTITIES, (Z0, X0, WIDTH, LENGTH, HEIGHT)))


def _bound_when_judged(task: Task) -> np.ndarray:
    """(6,) two sigma of the Cramer-Rao bound at the time from which Table 3 judges, in its units."""
    flight = measure(task.scene, task.noise, task.seed)
    seen = flight.seen.copy()
    seen[int((1 - FRACTION) * len(seen)) :] = False
    sigma = bound(replace(flight, seen=seen)).sigma
    size = np.abs(flight.truth.values)
    with np.errstate(divide="ignore"):
        scale = np.where(size > 0, 100.0 / size, math.nan)
    scale[HEIGHT] = 1.0
    return 2.0 * sigma * scale


def table3_bounds(group: str, tasks: Sequence[Task], outcomes: Sequence[Outcome], amount: Amount) -> list[Goal]:
    """What no unbiased estimator can better: the bound with the images up to the first one that Table 3 judges."""
    bounds = dict(zip([id(o) for o in outcomes], _each(_bound_when_judged, tasks, amount.jobs, f"{group} bounds")))
    result = []
    for obstacle, chosen in _by_obstacle(outcomes).items():
        asked = (X0, Z0, WIDTH, LENGTH, HEIGHT) if chosen[0].box else (X0, Z0, WIDTH, HEIGHT)
        values = np.nanmedian(np.array([bounds[id(o)] for o in chosen])[:, asked], axis=0)
        label = f"{obstacle}: bound (2 sigma) at {1 - FRACTION:.0%} of the run"
        result.append(Goal(group, label, "%, m", _named(values, asked)))
    return result


def table3_group(group: str, amount: Amount) -> list[Goal]:
    """Table 3 of the paper on its own 156 cases: whole pixels, no other error."""
    tasks = [Task(scene, NOISES["rounding"], (1, number)) for number, scene in enumerate(paper_scenes())]
    outcomes = _perform_all(tasks, amount, group)
    result = []
    for obstacle, chosen in _by_obstacle(outcomes).items():
        paper = PAPER_TABLE3[(obstacle, "line" if chosen[0].box else "disc")]
        cells = [(name, TABLE3_NUMBERS[name], cell) for name, cell in paper.items() if cell is not None]
        extents = {NAMES[i]: np.array([_extent(o, i) for o in chosen]) for _, i, _ in cells}
        paper_range = {NAMES[i]: cell.value for _, i, cell in cells}
        for share, asked in ((MOST, True), (0.9, False)):
            ours = {name: holding_range(values, share) for name, values in extents.items()}
            label = f"{obstacle}, {share:.0%} of the runs"
            result.append(Goal(group, f"{label}: errors within", "%, m", ours))
            factors = {name: paper_range[name] / max(value, 1e-12) for name, value in ours.items()}
            wanted = tuple(factors) if asked else ()
            result.append(Goal(group, f"{label}: times better than the paper", "1", factors, (5.0, math.inf), wanted))
    return result + table3_bounds(group, tasks, outcomes, amount)


def _known_since(outcome: Outcome, good: np.ndarray) -> float:
    """Seconds before the obstacle is reached from which on ``good`` (K,) holds until the end; 0: never."""
    bad = np.flatnonzero(~good)
    start = bad[-1] + 1 if len(bad) else 0
    return outcome.reach_s - float(outcome.time_s[start]) if start < len(good) else 0.0


def early_group(group: str, amount: Amount) -> list[Goal]:
    """How soon the range is known: the time that is left to fly around."""
    result = []
    for noise in ("rounding", "field"):
        tasks = [Task(scene, NOISES[noise], (1, number)) for number, scene in enumerate(paper_scenes())]
        outcomes = _perform_all(tasks, amount, f"{group} {noise}")
        criteria: dict[str, Callable[[Outcome], np.ndarray]] = {
            "refined, own 2 sigma": lambda o: 2 * o.refined.sigma[:, Z0] < KNOWN_SHARE * o.truth.z0_m,
            "refined, true error": lambda o: np.abs(o.refined.error[:, Z0]) < KNOWN_SHARE * o.truth.z0_m,
            "window, true error": lambda o: np.abs(o.window.error[:, Z0]) < KNOWN_SHARE * o.truth.z0_m,
        }
        for label, criterion in criteria.items():
            with np.errstate(invalid="ignore"):
                values = {
                    obstacle: float(np.median([_known_since(o, criterion(o)) for o in chosen]))
                    for obstacle, chosen in _by_obstacle(outcomes).items()
                }
            result.append(
                Goal(f"{group}: Z0 known to {KNOWN_SHARE:.0%}", f"{noise}, {label}", "s before abeam", values)
            )
    return result


def caught(static: np.ndarray, moving: np.ndarray, false_share: float) -> float:
    """Percent of the moving ones above a threshold that so many of the static ones exceed at most."""
    allowed = math.floor(false_share * len(static) + 1e-9)
    threshold = np.sort(static)[::-1][allowed]
    return 100.0 * float(np.mean(moving > threshold))


def flag_goals(group: str, static: Sequence[Outcome], moving: Sequence[Outcome]) -> list[Goal]:
    """How much of what moves the misfit catches at a share of false flags: its largest value, and its last."""
    result = []
    told = (
        ("misfit_most", f"{len(moving)} moving cars caught, at a share of false flags", "misfit as a flag", True),
        ("misfit", "caught by the last misfit instead of the largest", "last misfit as a flag", False),
    )
    for field_name, caught_name, area_name, asked in told:
        scores = [np.array([getattr(o, field_name) for o in cars]) for cars in (static, moving)]
        curve = {f"{100 * share:g} %": caught(*scores, share) for share in FALSE_FLAGS}
        wanted = (f"{100 * FALSE_ALLOWED:g} %",) if asked else ()
        result.append(Goal(group, caught_name, "%", curve, (60.0, 100.0), wanted))
        above = (scores[1][:, None] > scores[0]) + 0.5 * (scores[1][:, None] == scores[0])
        result.append(Goal(group, area_name, "1", {"area under the curve": float(above.mean())}))
    return result


def kitti_group(group: str, amount: Amount) -> list[Goal]:
    """KITTI's cars, detector boxes and all."""
    flights = [f for f in kitti_flights() if f.path_m() > KITTI_PATH_M]
    if not flights:
        return []
    progress = tqdm(flights, desc=group, disable=None, leave=False)
    outcomes = [outcome_of(flight) for flight in progress]
    static, moving = ([o for o in outcomes if o.truth.static == kind] for kind in (True, False))
    result = []
    for label, method, asked in (("refined", "refined", True), ("window", "window", False)):
        error = np.abs(_ends(static, method))
        error[np.isnan(error)] = math.inf  # no answer is worse than any
        z = 100.0 * error[:, Z0] / np.array([o.truth.z0_m for o in static])
        values = {"median": float(np.median(z)), "90th": float(np.sort(z)[math.ceil(0.9 * len(z)) - 1])}
        wanted = ("median",) if asked else ()
        name = f"Z0 error, {len(static)} parked cars, {label}"
        result.append(Goal(group, f"{name}, median", "%", {"median": values["median"]}, (0.0, 2.0), wanted))
        result.append(
            Goal(group, f"{name}, 90th percentile", "%", {"90th": values["90th"]}, (0, 7.0), ("90th",) if asked else ())
        )
        x = {"median": float(np.median(error[:, X0]))}
        result.append(Goal(group, f"X0 error, {label}", "m", x, (0.0, 0.15), wanted))
    for goal in coverage_goals(group, static, (90.0, 100.0)):
        goal.values = {name: goal.values[name] for name in ("X0", "Z0")}
        goal.asked = tuple(name for name in goal.asked if name in goal.values and "first" not in goal.name)
        goal.name = goal.name.replace("cylinders", "parked cars")
        result.append(goal)
    result += flag_goals(group, static, moving)
    flags = {
        name: 100.0 * float(np.mean([o.suspect for o in c])) for name, c in (("parked", static), ("moving", moving))
    }
    result.append(Goal(group, "told as suspect with the default threshold", "%", flags))
    return result


def _rounding(task: Task) -> Rounding:
    return rounding_of(measure(task.scene, task.noise, task.seed))


def float32_group(group: str, amount: Amount) -> list[Goal]:
    """The library in float32 against itself in float64: the largest difference over a flight's images, in sigmas."""
    result = []
    try:
        library_path(double=True)
    except FileNotFoundError as reason:
        print(f"left out: {reason}")
        return []
    for noise in ("gauss0.3", "gauss1", "field"):
        tasks = _tasks(noise, amount.precision_seeds, amount)
        flights = _each(_rounding, tasks, amount.jobs, f"{group} {noise}")
        largest = np.array([r.worst for r in flights])
        for label, share in (("99th percentile", 0.99), ("worst", 1.0)):
            values = _named(_nan_quantile(largest, share))
            name = f"{noise}, largest of a flight, {label} of {len(flights)}"
            result.append(Goal(ROUNDING_TITLE, name, "sigma", values, (0.0, ROUNDING_MOST), NAMES))
        images = {
            "compared": float(sum(r.answered - r.apart for r in flights)),
            "decided otherwise": float(sum(r.apart for r in flights)),
        }
        result.append(Goal(ROUNDING_TITLE, f"{noise}, images with an answer", "1", images))
    return result


def _rival_errors(flight: Flight) -> dict[str, np.ndarray]:
    """Errors (6,) of the rivals at the end of a flight; nothing where they are not installed."""
    try:
        from . import rivals
    except ImportError:
        return {}
    absent, track = rivals.missing(), rivals.Track.of_flight(flight)
    result = {}
    for name, method in rivals.RIVALS.items():
        if name not in absent:
            result[name] = _rival_error(flight, method(track))
    return result


def _rival_error(flight: Flight, told: dict[str, float]) -> np.ndarray:
    from .judge import renamed

    values = np.array([told.get(name, math.nan) for name in QUANTITIES])
    truth, box = flight.truth, flight.truth.kind == "box"
    error = values - truth.values
    if not box:
        error[~DISC_QUANTITIES] = np.nan
    elif told.get("box", 0.0) > 0.5:
        if abs(fold(error[ORIENTATION])) > math.pi / 4:
            others = [values - renamed(truth.values, side) for side in (-1, 1)]
            error = min(others, key=lambda e: abs(e[X0]) + abs(e[Z0]))
    else:
        error[:2] = values[:2] - truth.corners().mean(0)
        error[2:] = np.nan
    error[ORIENTATION] = fold(error[ORIENTATION])
    return error


def rivals_group(group: str, amount: Amount) -> list[Goal]:
    """Other people's methods on the same flights."""
    result = []
    for noise in ("gauss1", "field"):
        tasks = _drawn(_tasks(noise, 1, amount, rivals=True), amount.rivals)
        outcomes = _perform_all(tasks, amount, f"{group} {noise}")
        names = list(dict.fromkeys(name for o in outcomes for name in o.rivals))
        errors = {name: np.array([o.rivals[name] for o in outcomes]) for name in names}
        errors = {"refined": _ends(outcomes), "window": _ends(outcomes, "window"), **errors} if names else {}
        for name, error in errors.items():
            median = _nan_quantile(np.abs(error), 0.5) * UNITS
            result.append(Goal(group, f"{noise}, median error, {len(error)} flights: {name}", "m, deg", _named(median)))
            there = 100.0 * np.isfinite(error).mean(0)
            result.append(Goal(group, f"{noise}, answers: {name}", "%", _named(there)))
    return result


GROUPS: dict[str, Callable[[str, Amount], list[Goal]]] = {
    "gauss0.3": gauss_group,
    "gauss1": gauss_group,
    "rounding": gauss_group,
    "field": field_group,
    "float32": float32_group,
    "table3": table3_group,
    "early": early_group,
    "recorded": recorded_group,
    "kitti": kitti_group,
    "rivals": rivals_group,
}
ABSENT = {
    "float32": "the target goe_batch_double is not built",
    "recorded": f"no flights in {RECORDED_FOLDER}",
    "kitti": f"no logs in {KITTI_FOLDER}",
    "rivals": "the rivals are not there",
}


# -------------------------------------------------------------------------------------------------------------- output


def _range_text(goal: Goal) -> str:
    low, high = goal.wanted
    if not goal.asked:
        return ""
    if low <= 0.0:
        return f"<= {high:g}"
    return f">= {low:g}" if high in (100.0, math.inf) else f"{low:.4g} .. {high:.4g}"


def _number_text(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def print_goal(goal: Goal) -> None:
    verdict = {None: "", True: "met", False: "missed: " + ", ".join(goal.missed)}[goal.met]
    unit = f" [{goal.unit}]" if goal.unit != "1" else ""
    if set(goal.values) <= set(NAMES):
        cells = "".join(f"{_number_text(goal.values.get(name, math.nan)):>9}" for name in NAMES)
    else:
        cells = "  " + "   ".join(f"{name} {_number_text(value)}" for name, value in goal.values.items())
    print(f"  {goal.name + unit:58.58}{_range_text(goal):>14}{cells}   {verdict}", flush=True)


def print_worst(title: str, outcomes: Sequence[Outcome], count: int) -> None:
    """Names the flights whose answers at the end are farthest from the truth by their own measure."""
    ratios = np.nan_to_num(np.array([nees(o) for o in outcomes]))
    for i in np.argsort(-ratios)[:count]:
        o = outcomes[i]
        with np.errstate(invalid="ignore"):
            sigmas = o.refined.error[-1] / o.refined.sigma[-1]
        cells = "".join(f"{_number_text(value):>9}" for value in sigmas)
        print(f"  {f'{title}: {o.name}, seed {o.seed}':70} NEES {_number_text(ratios[i]):>8}{cells}")


def print_group(name: str, goals: Sequence[Goal]) -> None:
    for title in dict.fromkeys(goal.group for goal in goals):
        heads = "".join(f"{head:>9.9}" for head in ("X0", "Z0", "orient.", "W", "L", "H"))
        print(f"\n{title:60.60}{'wanted':>14}{heads}")
        for goal in goals:
            if goal.group == title:
                print_goal(goal)
    if not goals:
        print(f"\n{name}: skipped, {ABSENT.get(name, 'nothing to tell')}")


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def as_json(goals: Sequence[Goal], quick: bool) -> dict[str, object]:
    """For the report: {"quick", "goals": [{group, name, unit, wanted: [low, high], asked, values, met}]}."""
    rows = [
        {
            "group": goal.group,
            "name": goal.name,
            "unit": goal.unit,
            "wanted": [_plain(end) for end in goal.wanted] if goal.asked else None,
            "asked": list(goal.asked),
            "values": {name: _plain(value) for name, value in goal.values.items()},
            "met": goal.met,
        }
        for goal in goals
    ]
    return {"quick": quick, "goals": rows}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quick", action="store_true", help="fewer flights: a minute instead of many")
    parser.add_argument("--only", metavar="GROUPS", help=f"some of {','.join(GROUPS)}")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    parser.add_argument(
        "--worst", type=int, default=0, metavar="N", help="name the N worst flights, errors in own sigmas"
    )
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="processes (default 1)")


def run(arguments: argparse.Namespace) -> int:
    chosen = arguments.only.split(",") if arguments.only else list(GROUPS)
    for name in chosen:
        if name not in GROUPS:
            raise ValueError(f"--only {name}: not one of {', '.join(GROUPS)}")
    if arguments.jobs < 1:
        raise ValueError(f"--jobs {arguments.jobs}: must be at least 1")
    library_path()  # its absence is told before the work begins
    amount = Amount(**{**vars(QUICK if arguments.quick else FULL), "jobs": arguments.jobs, "worst": arguments.worst})
    goals: list[Goal] = []
    for name in chosen:
        found = GROUPS[name](name, amount)
        print_group(name, found)
        goals += found
    asked = [goal for goal in goals if goal.met is not None]
    print(f"\n{sum(bool(goal.met) for goal in asked)} of {len(asked)} goals met")
    if arguments.json:
        arguments.json.write_text(json.dumps(as_json(goals, arguments.quick), indent=1) + "\n", encoding="utf-8")
    return 0
