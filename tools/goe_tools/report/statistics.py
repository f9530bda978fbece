"""Statistics of the campaign: Table 3, its verdicts, comparisons of studies, rank correlations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .data import IN_PERCENT, SAME_CASE, Campaign, Cases
from .paper_table3 import FRACTION, PAPER_TABLE3, TABLE3_QUANTITIES, PaperRange, holding_range

ROUNDING = 1.25  # the paper's ranges are round numbers: a range up to so many times wider counts as reproduced
MUCH = 0.5  # of the paper's range; narrower counts as better

BETTER, REPRODUCED, MEANS_ONLY, WORSE, NOT_IN_PAPER = (
    "better",
    "reproduced",
    "means only",
    "not reproduced",
    "ours only",
)


# flown in the paper, but not in its table; "switching": disc and line solutions of a run together
ALSO_FLOWN = (("building", "disc"), ("building", "switching"), ("truck", "switching"), ("long-truck", "switching"))
MODEL_IN_CASES = {"disc": "disc", "line": "line", "switching": "auto"}
PURE = 0.999  # share of line solutions above which a run counts as line only


def column(quantity: str, measure: str) -> str:
    """The column of cases.csv in Table 3's unit: percent of the truth for quantities with percentages in the paper."""
    return f"{quantity}_{measure}" + ("_pct" if quantity in IN_PERCENT else "")


@dataclass(frozen=True)
class Errors:
    """A quantity's mean errors and 2 sigma over a set of runs, in Table 3's unit, without runs that have no value."""

    runs: Cases
    mean: np.ndarray
    two_sigma: np.ndarray
    without_estimate: int
    without_percent: int  # with an estimate, but the truth is 0

    @property
    def extent(self) -> np.ndarray:
        """Largest distance from 0 of the bar mean +- 2 sigma."""
        return np.abs(self.mean) + self.two_sigma


def errors_of(runs: Cases, quantity: str) -> Errors:
    mean, two_sigma = runs[column(quantity, "mean")], runs[column(quantity, "two_sigma")]
    there = np.isfinite(mean) & np.isfinite(two_sigma)
    estimated = np.isfinite(runs[f"{quantity}_mean"])
    return Errors(
        runs.where(there), mean[there], two_sigma[there], int(np.sum(~estimated)), int(np.sum(estimated & ~there))
    )


def line_apart(cases: Cases) -> bool:
    """Whether the campaign has separate statistics (line) of the line solutions of the switching runs (auto)."""
    return bool(np.any(cases["model"] == "line"))


def flown_runs(cases: Cases, obstacle: str, model: str, fraction: float = FRACTION) -> Cases:
    """The paper-study rows of a model; for the line those of the switching runs if it has no rows of its own."""
    name = MODEL_IN_CASES[model] if model != "line" or line_apart(cases) else "auto"
    return cases.select(study="paper", obstacle=obstacle, model=name, fraction=fraction)


def paper_runs(cases: Cases, obstacle: str, model: str, fraction: float = FRACTION) -> Cases:
    """The runs of a row of Table 3. For the line model: those with a line solution."""
    runs = flown_runs(cases, obstacle, model, fraction)
    return runs.where((runs["used"] > 0) & ~(runs["fresh_line_share"] <= 0.0)) if model == "line" else runs


@dataclass(frozen=True)
class Cell:
    """One number of Table 3, the paper's and the window method's (percent; meters for the height)."""

    obstacle: str
    model: str
    quantity: str
    paper: PaperRange | None
    errors: Errors
    bars: float  # range that contains the bars of MOST of the runs
    means: float  # range that contains the means of MOST of the runs
    verdict: str

    @property
    def outside(self) -> np.ndarray:
        """The runs whose bars leave the paper's range."""
        assert self.paper is not None
        return self.errors.extent > self.paper.value

    @property
    def factor(self) -> float:
        """The range in multiples of the paper's."""
        return self.bars / self.paper.value if self.paper else math.nan


def judge(paper: PaperRange | None, errors: Errors) -> str:
    if paper is None or not len(errors.mean):
        return NOT_IN_PAPER
    if paper.beyond:
        return REPRODUCED if np.mean(errors.extent > paper.value) > 0.5 else BETTER
    if holding_range(errors.extent) <= MUCH * paper.value:
        return BETTER
    if holding_range(errors.extent) <= ROUNDING * paper.value:
        return REPRODUCED
    return MEANS_ONLY if holding_range(np.abs(errors.mean)) <= ROUNDING * paper.value else WORSE


def make_cell(cases: Cases, obstacle: str, model: str, quantity: str, fraction: float = FRACTION) -> Cell | None:
    """None if the model has no such quantity: a disc has no length."""
    if quantity == "length" and model == "disc":
        return None
    paper = PAPER_TABLE3.get((obstacle, model), {}).get(quantity)
    errors = errors_of(paper_runs(cases, obstacle, model, fraction), quantity)
    bars, means = holding_range(errors.extent), holding_range(np.abs(errors.mean))
    return Cell(obstacle, model, quantity, paper, errors, bars, means, judge(paper, errors))


def table3(cases: Cases, fraction: float = FRACTION) -> list[tuple[str, str, list[Cell | None]]]:
    """Rows (obstacle, model, cells in the order of TABLE3_QUANTITIES)."""
    also = [(o, m) for o, m in ALSO_FLOWN if m != "switching" or line_apart(cases)]
    rows = (*PAPER_TABLE3, *also)
    return [(o, m, [make_cell(cases, o, m, q, fraction) for q in TABLE3_QUANTITIES]) for o, m in rows]


def first_seed(cases: Cases) -> Cases:
    """The figures show one run per case, as the paper's do."""
    return cases.select(seed=min(cases.levels("seed"))) if len(cases) else cases


def rank_correlation(a: np.ndarray, b: np.ndarray) -> float:
    """Spearman's; ties share their mean rank. NaN for fewer than 5 pairs or no variation."""
    there = np.isfinite(a) & np.isfinite(b)
    a, b = a[there], b[there]
    if len(a) < 5 or np.all(a == a[0]) or np.all(b == b[0]):
        return math.nan
    return float(np.corrcoef(_ranks(a), _ranks(b))[0, 1])


def _ranks(values: np.ndarray) -> np.ndarray:
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(counts)
    return (last - (counts - 1) / 2.0)[inverse]


# ------------------------------------------------------------------------------------------------ what drives an error

FACTORS = {
    "side_m": ("side distance", "{:g} m"),
    "alpha_deg": ("orientation", "{:g}°"),
    "altitude_m": ("altitude", "{:g} m"),
    "glide_deg": ("glide slope", "{:g}°"),
}


@dataclass(frozen=True)
class Driver:
    """The level of a factor at which runs leave a range most often, compared with the other levels."""

    factor: str
    level: float
    out: int
    of: int
    out_elsewhere: int
    of_elsewhere: int

    @property
    def contrast(self) -> float:
        return self.out / self.of - self.out_elsewhere / max(self.of_elsewhere, 1)


def strongest_driver(runs: Cases, outside: np.ndarray, least: float = 0.3) -> Driver | None:
    """The level at which the share of runs outside a range is highest, if it exceeds the share at the other levels by
    at least ``least``."""
    found: list[Driver] = []
    for factor in FACTORS:
        levels = runs.levels(factor)
        for level in levels if len(levels) > 1 else []:
            here = runs[factor] == level
            out = int(np.sum(outside[here])), int(np.sum(outside[~here]))
            found.append(Driver(factor, level, out[0], int(np.sum(here)), out[1], int(np.sum(~here))))
    best = max(found, key=lambda driver: driver.contrast, default=None)
    return best if best is not None and best.contrast >= least else None


# ---------------------------------------------------------------------------------------- studies beyond the paper's

STUDIES = ("arc", "weave", "ramp", "wind", "attitude", "position", "field")
STUDY_QUANTITIES = ("z0", "x0", "width", "length", "height", "orientation")


@dataclass(frozen=True)
class Variant:
    """One setting of a study beyond the paper: all its runs of one fraction."""

    study: str
    label: str
    runs: Cases


def variants(cases: Cases, model: str = "auto") -> list[Variant]:
    """In the order of STUDIES. The cylinder has only the disc and belongs to both models."""
    found = []
    for study in STUDIES:
        rows = cases.select(study=study, fraction=FRACTION)
        rows = rows.where((rows["model"] == model) | (rows["obstacle"] == "cylinder"))
        settings = dict.fromkeys(rows.keys(("path", "speed_profile", "wind", "noise")))
        for path, speed, wind, noise in settings:
            runs = rows.select(path=path, speed_profile=speed, wind=wind, noise=noise)
            found.append(Variant(study, variant_label(study, path, speed, wind), runs))
    return found


def variant_label(study: str, path: str, speed: str, wind: str) -> str:
    _, _, path_numbers = path.replace("-", "−").partition(":")
    if study == "arc":
        return f"arc, R = {path_numbers} m" if path_numbers else "arc"
    if study == "weave":
        amplitude, _, period = path_numbers.partition(",")
        return f"weave, ±{amplitude} m in {period} s" if period else "weave"
    if study == "ramp":
        rate = speed.replace("-", "−").partition(":")[2]
        return f"speed ramp, {rate} m/s²" if rate else "speed ramp"
    if study == "wind":
        return "wind, " + (wind.split(":")[-1])
    return {"attitude": "attitude error", "position": "own position error", "field": "field sensors"}.get(study, study)


def median_rmse(runs: Cases, quantity: str) -> float:
    values = runs[column(quantity, "rmse")]
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else math.nan


def like_for_like(cases: Cases, runs: Cases) -> Cases:
    """The paper-study runs of the same cases, for comparison with the variant."""
    paper = cases.select(study="paper", fraction=FRACTION)
    wanted = set(runs.keys(SAME_CASE))
    return paper.where(np.array([key in wanted for key in paper.keys(SAME_CASE)], dtype=bool))


# -------------------------------------------------------------------------------------------------------- conditioning

CONDITIONING_FACTORS = ("window", "side_m", "alpha_deg", "fps_hz")


def nominal_rows(rows: Cases, factor: str, others: Sequence[str] = CONDITIONING_FACTORS) -> Cases:
    """The rows that vary ``factor`` alone: every other setting has its most frequent value (of several such, the
    middle one). All rows if the factor does not vary among these."""
    mask = np.ones(len(rows), dtype=bool)
    for name in others:
        if name == factor:
            continue
        for obstacle in rows.levels("obstacle"):
            here = rows["obstacle"] == obstacle
            values, counts = np.unique(rows[name][here], return_counts=True)
            commonest = values[counts == counts.max()]
            mask &= ~here | (rows[name] == commonest[len(commonest) // 2])
    kept = rows.where(mask)
    return kept if len(kept) and len(kept.levels(factor)) > 1 else rows


def quartiles_by(rows: Cases, factor: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Levels of the factor, and (levels, 3) lower quartile, median, upper quartile of ``values`` there."""
    levels, bands = [], []
    for level in rows.levels(factor):
        here = values[(rows[factor] == level) & np.isfinite(values)]
        if len(here):
            levels.append(level)
            bands.append(np.percentile(here, (25.0, 50.0, 75.0)))
    return np.array(levels), np.array(bands).reshape(-1, 3)


def campaign_counts(campaign: Campaign) -> dict[str, Any]:
    """The counts of goe_campaign; if they are missing, counts of the rows, in which an image of two runs counts
    twice."""
    whole = campaign.cases.select(fraction=max(campaign.cases.levels("fraction")))
    flights = set(whole.keys(("study", "case", "seed", "path", "speed_profile", "wind", "noise", "roll_deg")))
    return {
        "runs": campaign.facts.get("runs", len(whole)),
        "flights": campaign.facts.get("flights", len(flights)),
        "paper_cases": len(set(whole.select(study="paper").keys(("case",)))),
        "seeds": len(whole.levels("seed")),
        "images": campaign.facts.get("frames", int(np.sum(whole["frames"]))),
    }
