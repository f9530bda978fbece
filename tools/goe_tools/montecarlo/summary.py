"""Coverage, errors over time and warnings of many runs, for each obstacle.

A run counts once, however many images it has: shares are means over the runs of each run's share. The images of a run
have the same constant errors, so the standard error of a share is computed from the runs, too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .flown import FALSE, KEYS, MISSED, QUIET, WARNED, Pass

INSIDE = (1, 2)  # sigmas
EXPECTED = {1: 0.683, 2: 0.954}  # of a Gaussian error whose sigma is right
LEVELS = (2.5, 16.0, 50.0, 84.0, 97.5)  # percentiles over the runs
BAND_RUNS = 10  # fewer runs give no useful band
STEP_S = 0.5


@dataclass(frozen=True)
class Share:
    """Mean over runs, and its standard error; NaN without a run."""

    mean: float
    error: float


@dataclass(frozen=True)
class Row:
    """One quantity of one obstacle."""

    key: str
    runs: int  # with an answer and a truth to compare it with
    inside: dict[int, Share]  # by sigmas: share of the answers within
    last_error: float  # median over runs of the absolute error of the last answer
    last_sigma: float  # ... and of its sigma
    rms: float  # root mean square of error over sigma


@dataclass(frozen=True)
class Warnings:
    runs: int
    violated: int  # runs whose flown path violates margin and clearance
    warned: int
    missed: int
    false: int
    quiet: int
    leads_s: tuple[float, ...]  # ascending, of the warned runs
    suspect: int  # runs with an image whose answer is suspect


@dataclass(frozen=True)
class OverTime:
    """Percentiles over the runs of error over sigma of the last answer in each of T steps."""

    time_s: np.ndarray  # (T,) middle of the step
    level: np.ndarray  # (T, quantities, LEVELS); NaN where fewer than ``BAND_RUNS`` runs have an answer
    runs: np.ndarray  # (T, quantities)


@dataclass(frozen=True)
class Summary:
    obstacle: int
    rows: tuple[Row, ...]
    warnings: Warnings
    over_time: OverTime

    def row(self, key: str) -> Row:
        return next(row for row in self.rows if row.key == key)


def ratios(one: Pass) -> np.ndarray:
    """(K, quantities) error over sigma."""
    return one.error / one.sigma


def share_of(values: Sequence[float]) -> Share:
    if not len(values):
        return Share(math.nan, math.nan)
    spread = float(np.std(values, ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return Share(float(np.mean(values)), spread)


def inside_of(one: Pass, quantity: int, sigmas: int) -> float:
    """Share of a run's answers within this many sigmas; NaN without an answer."""
    ratio = ratios(one)[:, quantity]
    known = ratio[np.isfinite(ratio)]
    return float(np.mean(np.abs(known) < sigmas)) if len(known) else math.nan


def last_of(one: Pass, quantity: int) -> tuple[float, float]:
    """Error and sigma of the last answer of a run."""
    known = np.flatnonzero(np.isfinite(one.error[:, quantity]))
    if not len(known):
        return math.nan, math.nan
    return float(one.error[known[-1], quantity]), float(one.sigma[known[-1], quantity])


def _row(passes: Sequence[Pass], quantity: int) -> Row:
    answered = [one for one in passes if np.isfinite(one.error[:, quantity]).any()]
    if not answered:
        nothing = {sigmas: Share(math.nan, math.nan) for sigmas in INSIDE}
        return Row(KEYS[quantity], 0, nothing, math.nan, math.nan, math.nan)
    last = np.array([last_of(one, quantity) for one in answered])
    squares = [float(np.nanmean(ratios(one)[:, quantity] ** 2)) for one in answered]
    return Row(
        KEYS[quantity], len(answered),
        {sigmas: share_of([inside_of(one, quantity, sigmas) for one in answered]) for sigmas in INSIDE},
        float(np.median(np.abs(last[:, 0]))), float(np.median(last[:, 1])), math.sqrt(float(np.mean(squares))),
    )  # fmt: skip


def warnings_of(passes: Sequence[Pass]) -> Warnings:
    count = {verdict: sum(one.verdict == verdict for one in passes) for verdict in (WARNED, MISSED, FALSE, QUIET)}
    leads = sorted(one.lead_s for one in passes if one.verdict == WARNED)
    return Warnings(
        len(passes), count[WARNED] + count[MISSED], count[WARNED], count[MISSED], count[FALSE], count[QUIET],
        tuple(leads), sum(bool(one.suspect.any()) for one in passes),
    )  # fmt: skip


def _last_in_steps(one: Pass, steps: int) -> np.ndarray:
    """(T, quantities) error over sigma of the last answer in each step."""
    result = np.full((steps, len(KEYS)), np.nan)
    ratio, step = ratios(one), (one.time_s / STEP_S).astype(int)
    for k in range(len(one.time_s)):
        result[step[k]] = np.where(np.isfinite(ratio[k]), ratio[k], result[step[k]])
    return result


def over_time(passes: Sequence[Pass]) -> OverTime:
    steps = 1 + int(max(one.time_s[-1] for one in passes) / STEP_S)
    each = np.stack([_last_in_steps(one, steps) for one in passes])  # (runs, T, quantities)
    runs = np.isfinite(each).sum(0)
    level = np.full((steps, len(KEYS), len(LEVELS)), np.nan)
    for t, q in zip(*np.nonzero(runs >= BAND_RUNS)):
        known = each[:, t, q]
        level[t, q] = np.percentile(known[np.isfinite(known)], LEVELS)
    return OverTime((np.arange(steps) + 0.5) * STEP_S, level, runs)


def summaries(passes: Sequence[Pass]) -> list[Summary]:
    """One for each obstacle, in the scenario's order."""
    result = []
    for obstacle in sorted({one.obstacle for one in passes}):
        own = [one for one in passes if one.obstacle == obstacle]
        rows = tuple(_row(own, quantity) for quantity in range(len(KEYS)))
        result.append(Summary(obstacle, rows, warnings_of(own), over_time(own)))
    return result
