"""Sentences on the default method (filter) and on the goals, computed from the numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from .. import paper_table3 as t3
from .. import refined as rf
from ..data import Campaign
from ..goals_file import GoalRow, Goals
from ..style import GOAL_SYMBOLS, NAMES, SYMBOLS, number, with_unit
from .words import listed, plural

FEW_WORST = 0.95  # if a mean without the worst 1 % is less than this share of it, few flights dominate it
NOISE_NAMES = {
    "rounding": "Whole pixels and no other error",
    "gauss1": "Gaussian pixel noise of 1 px",
    "field": "All errors of a small aircraft's sensors",
}
METHOD_NAMES = {
    "filter": "filter (this library)",
    "window": "window (the paper's)",
    "triangulation": "triangulation (GTSAM)",
    "inverse_depth": "inverse-depth Kalman filter",
    "bearing_angle": "bearing-angle filter",
    "inverse_size": "inverse-size line fit (Atherton et al., BMVC 1991)",
}
STRENGTHS: dict[str, str] = {
    "triangulation": "Uses all images at once; needs no ground, height or start value; mostly library calls.",
    "inverse_depth": "Uses any point from its first image on; twelve numbers of memory per point.",
    "bearing_angle": "Linear, three states, no start value, no corner to be recognized; designed for cylinders.",
    "inverse_size": "A straight-line fit, by far the cheapest; attitude errors have no effect on a size in the image.",
}


def _cell_name(cell: rf.Trio) -> str:
    return f"{SYMBOLS[cell.quantity]} of {NAMES[cell.obstacle].lower()}/{cell.model}"


def table3(campaign: Campaign) -> list[str]:
    """How much narrower than the paper's ranges the default method is, and where it is not."""
    cells = [cell for cell in rf.papers(campaign) if math.isfinite(cell.factor)]
    if not cells:
        return []
    factors = np.array([cell.factor for cell in cells])
    fivefold, better = int(np.sum(factors >= rf.FIVEFOLD)), int(np.sum(factors > 1.0))
    said = [
        f"The default method is better than the paper in {better} of the {len(cells)} numbers of Table 3, in "
        f"{fivefold} of them at least fivefold. The median range is {number(float(np.median(factors)))} times narrower."
    ]
    short = sorted((cell for cell in cells if cell.factor < rf.FIVEFOLD), key=lambda cell: cell.factor)
    if short:
        names = [
            f"{_cell_name(cell)} (±{with_unit(cell.refined, cell.quantity)}, paper ±{cell.paper}, "
            f"×{number(cell.factor)})"
            for cell in short
        ]
        said.append(f"Less than fivefold: {listed(names)}.")
    ratios = np.array([cell.window / cell.refined for cell in cells if cell.window > 0.0])
    if len(ratios):
        said.append(
            f"Compared with the window method on the same images: {number(float(np.min(ratios)))} to "
            f"{number(float(np.max(ratios)))} times narrower, {number(float(np.median(ratios)))} in the median."
        )
    lost = [f"{_cell_name(cell)} in {plural(cell.without, 'run')}" for cell in cells if cell.without]
    if lost:
        said.append(f"Without an estimate: {listed(lost)}.")
    return said


def studies(campaign: Campaign) -> list[str]:
    """The default method's error on curved paths, in wind, with sensor errors."""
    ratios = {row.label: row.errors["z0"][1] / row.errors["z0"][0] for row in rf.studies(campaign)
              if row.errors["z0"][0] > 0.0}  # fmt: skip
    ratios = {label: ratio for label, ratio in ratios.items() if math.isfinite(ratio)}
    if len(ratios) < 2:
        return []
    best, worst = min(ratios, key=lambda label: ratios[label]), max(ratios, key=lambda label: ratios[label])
    count = sum(ratio < 1.0 for ratio in ratios.values())
    return [
        f"The default method has a smaller error of Z₀ than the window method in {count} of {len(ratios)} studies: "
        f"{number(100.0 * ratios[best])} % of the window method's in the best study ({best}), "
        f"{number(100.0 * ratios[worst])} % in the worst ({worst})."
    ]


# --------------------------------------------------------------------------------------------------------------- goals


def goal_value(value: float) -> str:
    return number(value, 3) if abs(value) < 1000.0 else number(value, 4)


def value_name(name: str) -> str:
    return GOAL_SYMBOLS.get(name, name)


def value_label(name: str) -> str:
    """The label of a value in text: X₀ 1.02, but 5 %: 34."""
    return f"{name}:" if name.endswith("%") else value_name(name)


def wanted(row: GoalRow) -> str:
    """The required range: ≤ 1.25, ≥ 88, 90 … 98."""
    if not row.asked:
        return ""
    if row.low <= 0.0:
        return f"≤ {row.high:g}"
    if row.high == math.inf or (row.unit == "%" and row.high == 100.0):
        return f"≥ {row.low:g}"
    return f"{row.low:.3g} … {row.high:.3g}"


def unit_text(row: GoalRow) -> str:
    return "" if row.unit == "1" else row.unit.replace("deg", "°")


def _with_goal_unit(row: GoalRow, value: float) -> str:
    unit = unit_text(row)
    return goal_value(value) + (f"\u00a0{unit}" if unit and "," not in unit else "")


def verdict(goals: Goals) -> list[str]:
    met = sum(bool(row.met) for row in goals.asked)
    recorded = f", as recorded on {goals.date}" if goals.date else ""
    said = [f"{met} of {len(goals.asked)} goals are met{recorded}."] if goals.asked else []
    short = len(goals.asked) - met
    if short:
        groups = dict.fromkeys(rf.group_title(row.group) for row in goals.asked if not row.met)
        verb = "is" if short == 1 else "are"
        said.append(f"{short} {verb} missed, in: {'; '.join(groups)}.")
    if any(group.startswith("recorded") for group in goals.groups):
        said.append(
            "The autopilots' flights were recorded with their own simulators and filters; simulated obstacles stand "
            "along the recorded paths."
        )
    if goals.quick:
        said.append("This was a quick run: too few flights for a verdict.")
    absent = [title for start, title in rf.GROUPS.items() if not any(g.startswith(start) for g in goals.groups)]
    if absent:
        said.append(f"Not in this run: {'; '.join(absent)}.")
    return said


def missed(goals: Goals) -> list[str]:
    """Every missed figure with its required range."""
    said = []
    for row in goals.asked:
        if row.met:
            continue
        values = [f"{value_label(name)} {_with_goal_unit(row, row.values.get(name, math.nan))}" for name in row.missed]
        text = wanted(row).replace(" ", "\u00a0")
        said.append(f"{rf.group_title(row.group)}, {row.name}: {listed(values)} (required {text}).")
    return said


def early(goals: Goals, only: str | None = None) -> list[str]:
    """``only``: of one kind of noise."""
    said = []
    for noise, ways in rf.early_rows(goals).items():
        if only not in (None, noise):
            continue
        ours, window = ways.get("filter, true error"), ways.get("window, true error")
        if ours is None or window is None:
            continue
        parts = [
            f"{NAMES.get(obstacle, obstacle).lower()} {number(value, 3)} s instead of "
            f"{number(window.values.get(obstacle, math.nan), 3)} s"
            for obstacle, value in ours.values.items()
        ]
        said.append(
            f"{NOISE_NAMES.get(noise, noise)}: time before abeam from which on the error of Z₀ stays below 10 %: "
            f"{listed(parts)} with the window method (medians over the paper's cases)."
        )
        own = ways.get("filter, own 2 sigma")
        if own is not None:
            parts = [f"{NAMES.get(o, o).lower()} {number(value, 3)} s" for o, value in own.values.items()]
            said.append(f"By goe's own 2σ: {listed(parts)}.")
    return said


def bounds(goals: Goals) -> list[str]:
    said = []
    for group, (median, tail) in rf.bound_rows(goals).items():
        middle, outer = _finite(median.values.values()), _finite(tail.values.values())
        if middle and outer:
            said.append(
                f"{rf.group_title(group)}: root mean square error over the Cramér-Rao bound, median of the cases, "
                f"{number(min(middle), 3)} to {number(max(middle), 3)} over the six quantities; 90th percentile "
                f"{number(min(outer), 3)} to {number(max(outer), 3)}."
            )
    return said


def _finite(values: Iterable[float]) -> list[float]:
    return [value for value in values if math.isfinite(value)]


def _shares(goals: Goals) -> list[tuple[float, GoalRow, str, str]]:
    """Every share within 2 sigma that has a goal: percent, line, quantity, group."""
    return [
        (value, row, name, group)
        for group, rows in rf.coverage_rows(goals).items()
        for row in rows.values()
        for name, value in row.values.items()
        if name in row.asked and math.isfinite(value)
    ]


def covered_shares(goals: Goals) -> list[float]:
    return [value for value, _, _, _ in _shares(goals)]


def coverage(goals: Goals) -> list[str]:
    shares = _shares(goals)
    if not shares:
        return []
    inside = sum(row.low <= value <= row.high for value, row, _, _ in shares)
    low, row, name, group = min(shares, key=lambda share: share[0])
    kind, moment = row.name.split(", ")[1:]
    over = sum(value > row.high for value, row, _, _ in shares)
    return [
        f"{inside} of {len(shares)} shares within 2σ are in the required range, {over} above it (the sigma is too "
        f"large), {len(shares) - inside - over} below (too small). The lowest is {number(low, 3)} %: "
        f"{value_name(name)}, {rf.group_title(group)}, {kind}, {moment}."
    ]


def nees(goals: Goals) -> list[str]:
    """Normalized error squared: one sentence for the groups with a goal, one for the others."""
    said = []
    for asked, start in ((True, "NEES over all quantities at the end of the run (1: the covariance is right; more: too "
                                "small): "), (False, "With errors that are not Gaussian: ")):  # fmt: skip
        parts = [_nees_part(row) for row in rf.nees_rows(goals) if bool(row.asked) is asked]
        if parts:
            said.append(start + "; ".join(parts) + ".")
    return said


def _nees_part(row: GoalRow) -> str:
    kind = row.name.split(", ")[-1]
    mean, without = row.values.get("mean", math.nan), row.values.get("mean without worst 1 %", math.nan)
    text = f"{rf.group_title(row.group)}, {kind} {number(mean, 3)}"
    if without < FEW_WORST * mean and row.met is not True:
        text += f" ({number(without, 3)} without the worst 1 %)"
    return text + (f", required {wanted(row)}, {'met' if row.met else 'missed'}" if row.asked else "")


def flags(goals: Goals) -> list[str]:
    found = rf.flags(goals)
    if found is None:
        return []
    row = found.goal
    parts = [f"{_with_goal_unit(row, row.values.get(name, math.nan))} at {name} false flags" for name in row.asked]
    said = [f"Area under the curve for moving cars: {number(found.area)} (chance: 0.5)."]
    if parts:
        said.insert(
            0,
            "A car that moves does not fit a static obstacle. By this NIS ratio the following share of the moving "
            f"cars is flagged: {listed(parts)}. Goal {wanted(row)} %: {'met' if row.met else 'missed'}.",
        )
    if found.default is not None:
        said.append(
            f"With its default threshold the library flags {number(found.default[1])} % of the moving cars and "
            f"{number(found.default[0])} % of the parked ones."
        )
    return said


def rivals(goals: Goals) -> list[str]:
    """Where another method has a smaller error than the default method, and where it has not."""
    said = []
    for noise, rows in rf.rivals(goals).items():
        ours = next((row for row in rows if row.name == "filter"), None)
        if ours is None:
            continue
        others = [row for row in rows if row.name not in ("filter", "window")]
        better = [
            f"{value_name(q)} by {METHOD_NAMES.get(row.name, row.name)} "
            f"({_error_text(q, row.errors[q])} against {_error_text(q, ours.errors[q])}{_few(row, q)})"
            for row in others
            for q in ours.errors
            if row.errors[q] < ours.errors[q]
        ]
        name = NOISE_NAMES.get(noise, noise)
        best = [value_name(q) for q in ours.errors if _is_best(ours, others, q)]
        said.append(
            f"{name}: goe has the smallest median error of {listed(best) if best else 'no quantity'}"
            + (f"; smaller than goe's: {listed(better)}." if better else ".")
        )
    return said


def _is_best(ours: rf.Rival, others: Sequence[rf.Rival], quantity: str) -> bool:
    return math.isfinite(ours.errors[quantity]) and not any(
        row.errors[quantity] < ours.errors[quantity] for row in others
    )


def _few(row: rf.Rival, quantity: str) -> str:
    answers = row.answers.get(quantity, math.nan)
    return f", which has an estimate in {number(answers)} % of the flights" if answers < 50.0 else ""


def _error_text(quantity: str, error: float) -> str:
    return number(error) + ("°" if quantity == "orientation" else "\u00a0m")


def real_data(campaign: Campaign) -> str:
    """The part of the goals' data that is not simulated; empty if there is none."""
    if campaign.goals is None or "kitti" not in campaign.goals.groups:
        return ""
    return "the goals on the KITTI data set: cars that a detector found in the images of a camera on a driving car"


def lead(campaign: Campaign) -> str:
    """The comparison with the paper in one sentence."""
    cells = [cell for cell in rf.papers(campaign) if math.isfinite(cell.factor)]
    if not cells:
        return ""
    median = float(np.median([cell.factor for cell in cells]))
    return (
        f"goe's default method has errors {number(median)} times smaller than the paper, in the median of the "
        f"{len(cells)} numbers of Table 3, over the last {t3.FRACTION * 100:.0f} % of the same flights."
    )
