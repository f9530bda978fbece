"""Goals shared by several groups: efficiency, coverage, consistency, comparison with the window method."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from goe_tools.models import offline
from goe_tools.models.judge import DISC_QUANTITIES, LENGTH, ORIENTATION, WIDTH, Z0

from .goal import ALL, NAMES, UNITS, Goal, Range, named, names_of
from .outcome import Outcome

COVERAGE = (90.0, 98.0)


def nan_quantile(values: np.ndarray, share: float) -> np.ndarray:
    """Along the first axis; NaN for columns without a number."""
    columns = [column[np.isfinite(column)] for column in values.T]
    return np.array([np.quantile(column, share) if len(column) else math.nan for column in columns])


def ends(outcomes: Sequence[Outcome], method: str = "filter") -> np.ndarray:
    """(n, 6): errors at the end, NaN without an answer."""
    return np.array([getattr(o, method).error[-1] for o in outcomes])


def by_obstacle(outcomes: Sequence[Outcome]) -> dict[str, list[Outcome]]:
    result: dict[str, list[Outcome]] = {}
    for o in outcomes:
        result.setdefault(o.group, []).append(o)
    return result


def efficiency(outcomes: Sequence[Outcome]) -> np.ndarray:
    """(cases, 6): RMSE over the seeds at the end of the run, divided by the bound, for each case."""
    by_case: dict[str, list[np.ndarray]] = {}
    for o in outcomes:
        if o.bound is not None:
            by_case.setdefault(o.name, []).append(o.filter.error[-1] / np.maximum(o.bound, 1e-12))
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
        Goal(group, f"RMSE / bound, median of {cases} cases", "1", named(nan_quantile(ratios, 0.5)),
             (0.0, median), NAMES),
        Goal(group, "RMSE / bound, 90th percentile", "1", named(nan_quantile(ratios, 0.9)),
             (0.0, tail or math.inf), NAMES if tail else ()),
    ]  # fmt: skip
    return result


def _share(hits: np.ndarray, there: np.ndarray) -> np.ndarray:
    """(6,) in percent, of boolean (n, 6)."""
    count = there.sum(0)
    return np.where(count > 0, 100.0 * (hits & there).sum(0) / np.maximum(count, 1), math.nan)


def coverage_goals(group: str, outcomes: Sequence[Outcome], wanted: Range = COVERAGE, asked: bool = True) -> list[Goal]:
    """Share of the truth within two sigma: over all images with an answer, in the first of them, at the end."""
    result = []
    for label, box in (("boxes", True), ("cylinders", False)):
        chosen = [o for o in outcomes if o.box == box]
        if not chosen:
            continue
        numbers = ALL if box else tuple(np.flatnonzero(DISC_QUANTITIES))
        inside, there, first, last = [], [], [], []
        for o in chosen:
            valid = np.isfinite(o.filter.error) & np.isfinite(o.filter.sigma)
            with np.errstate(invalid="ignore"):
                hit = valid & (np.abs(o.filter.error) < 2 * o.filter.sigma)
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
            values = named(share[list(numbers)], numbers)
            result.append(
                Goal(group, f"within 2 sigma, {label}, {name}", "%", values, wanted, names_of(numbers) if asked else ())
            )
        valid_share = 100.0 * np.array([part[1] for part in last]).mean(0)
        result.append(Goal(group, f"answers at the end, {label}", "%", named(valid_share[list(numbers)], numbers)))
    return result


def nees(outcome: Outcome) -> float:
    """Normalized error squared over the number of quantities at the end; NaN unless all have an answer."""
    numbers = np.arange(6) if outcome.box else np.flatnonzero(DISC_QUANTITIES)
    error = outcome.filter.error[-1, numbers]
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
    """Median errors at the end compared with the window method's on the same flights."""
    ours, theirs = np.abs(ends(outcomes)), np.abs(ends(outcomes, "window"))
    sigma = np.array([o.filter.sigma[-1] for o in outcomes])
    both = np.isfinite(ours) & np.isfinite(theirs)
    median = nan_quantile(np.where(both, ours, np.nan), 0.5)
    window = nan_quantile(np.where(both, theirs, np.nan), 0.5)
    with np.errstate(invalid="ignore"):
        worse = 1000.0 * (both & (ours > theirs + 3 * sigma)).mean(0)
    return [
        Goal(group, f"median error, {len(outcomes)} flights", "m, deg", named(median * UNITS)),
        Goal(group, "median error of the window method", "m, deg", named(window * UNITS)),
        Goal(group, "filter / window", "1", named(median / window), (0.0, ratio), names_of(asked)),
        Goal(group, "worse than window by > 3 own sigma", "per 1000", named(worse), (0.0, 1.0),
             NAMES if worse_asked else ()),
    ]  # fmt: skip


def offline_goals(group: str, outcomes: Sequence[Outcome]) -> list[Goal]:
    chosen = [o for o in outcomes if o.offline is not None]
    if not chosen:
        print(f"left out: {offline.MISSING}")
        return []
    ours, best = np.abs(ends(chosen)), np.abs(np.array([o.offline for o in chosen]))
    both = np.isfinite(ours) & np.isfinite(best)
    median = nan_quantile(np.where(both, ours, np.nan), 0.5)
    fitted = nan_quantile(np.where(both, best, np.nan), 0.5)
    asked = names_of((Z0, ORIENTATION, WIDTH, LENGTH))
    return [
        Goal(group, f"median error of the offline fit, {len(chosen)} flights", "m, deg", named(fitted * UNITS)),
        Goal(group, "filter / offline fit", "1", named(median / fitted), (0.0, 1.3), asked),
    ]


def suspect_goals(group: str, outcomes: Sequence[Outcome]) -> list[Goal]:
    """Share of static obstacles flagged as suspect in any image, and the NIS ratio of the others."""
    flagged = {"in any image": 100.0 * float(np.mean([o.suspect for o in outcomes]))}
    most = np.array([o.misfit_most for o in outcomes])
    values = {"median": float(np.median(most)), "99th": float(np.quantile(most, 0.99)), "most": float(most.max())}
    return [
        Goal(group, f"static, but flagged as suspect, {len(outcomes)} flights", "%", flagged),
        Goal(group, "largest NIS ratio of a flight", "1", values),
    ]
