"""A flight and the results of the methods."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from goe_tools.flights.flight import QUANTITIES, Flight, Obstacle
from goe_tools.flights.measured import measure
from goe_tools.flights.noise import Noise
from goe_tools.flights.rotations import fold
from goe_tools.flights.scene import Scene
from goe_tools.library import Track, estimate, known_shape, settings_of
from goe_tools.models import offline
from goe_tools.models.bound import bound
from goe_tools.models.judge import DISC_QUANTITIES, ORIENTATION, X0, Z0, Judgement, judge, renamed, renamed_sigma

SUSPECT_IMAGES = 8  # earliest image that the library may flag


@dataclass
class Task:
    scene: Scene
    noise: Noise
    seed: tuple[int, int]
    shape_known: bool = True  # a cylinder is configured as a disc, see ``known_shape``
    bound: bool = False
    offline: bool = False
    rivals: bool = False


@dataclass
class Outcome:
    """One flight: answers of the filter method and the window method, image by image."""

    name: str
    group: str
    truth: Obstacle
    time_s: np.ndarray
    reach_s: float
    filter: Judgement
    window: Judgement
    covariance: np.ndarray  # (6, 6) at the end
    nis: float  # sums over the track
    nis_rows: float
    nis_ratio: float  # at the end
    misfit_most: float  # over the track
    suspect: bool  # in any image
    answered: int  # images with an answer
    bound: np.ndarray | None = None  # (6,) under the naming of the last answer
    offline: np.ndarray | None = None  # (6,) errors
    rivals: dict[str, np.ndarray] = field(default_factory=dict)  # errors (6,) at the end
    seed: tuple[int, ...] = ()

    @property
    def box(self) -> bool:
        return self.truth.kind == "box"


def _misfit_most(track: Track) -> float:
    """The largest NIS ratio from the first image at which it counts."""
    return float(track.nis_ratio[np.cumsum(track.nis_rows > 0) >= SUSPECT_IMAGES].max(initial=0.0))


def outcome_of(flight: Flight, **shape: float) -> Outcome:
    """Runs both methods over a flight. ``shape``: settings for the obstacle's shape."""
    track = estimate(flight, **shape)
    position = track.valid[:, Z0]
    window = estimate(flight, settings_of(flight, method="window"), **shape)
    return Outcome(
        flight.name, flight.group, flight.truth, flight.time_s, flight.reach_s, judge(track, flight),
        judge(window, flight), track.covariance[-1], float(track.nis.sum()), float(track.nis_rows.sum()),
        float(track.nis_ratio[-1]), _misfit_most(track), bool(track.suspect.any()), int(position.sum()),
    )  # fmt: skip


def perform(task: Task) -> Outcome:
    flight = measure(task.scene, task.noise, task.seed)
    result = outcome_of(flight, **(known_shape(flight) if task.shape_known else {}))
    result.seed = task.seed
    if task.bound:
        best = bound(flight)
        last = result.filter.renamed[-1]
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


def _rival_errors(flight: Flight) -> dict[str, np.ndarray]:
    """Errors (6,) of the rivals at the end of a flight; empty if they are not installed."""
    try:
        from .. import rivals
    except ImportError:
        return {}
    absent, track = rivals.missing(), rivals.Track.of_flight(flight)
    result = {}
    for name, method in rivals.RIVALS.items():
        if name not in absent:
            result[name] = _rival_error(flight, method(track))
    return result


def _rival_error(flight: Flight, answers: dict[str, float]) -> np.ndarray:
    values = np.array([answers.get(name, math.nan) for name in QUANTITIES])
    truth, box = flight.truth, flight.truth.kind == "box"
    error = values - truth.values
    if not box:
        error[~DISC_QUANTITIES] = np.nan
    elif answers.get("box", 0.0) > 0.5:
        if abs(fold(error[ORIENTATION])) > math.pi / 4:
            others = [values - renamed(truth.values, side) for side in (-1, 1)]
            error = min(others, key=lambda e: abs(e[X0]) + abs(e[Z0]))
    else:
        error[:2] = values[:2] - truth.corners().mean(0)
        error[2:] = np.nan
    error[ORIENTATION] = fold(error[ORIENTATION])
    return error
