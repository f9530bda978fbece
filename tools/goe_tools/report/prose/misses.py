"""The numbers of Table 3 that are not reproduced, by how much, and the most likely cause."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import IN_PERCENT, Cases
from ..style import NAMES, SYMBOLS, UNITS, number, with_unit
from .table3 import paper_cells
from .words import listed

LARGE_TRUTH_RATIO = 0.6  # truths outside the range below this share of those inside: percent of a small number
MUCH_CLOSER = 0.6  # something is the cause if the range without it is below this share
SAME_SHARE = 1.25  # percentages of two quantities within this factor: one common error
BIAS_RATIO = 0.67  # mean error over two sigma below this: scatter
MIXED, SHARED_SCALE, SMALL_TRUTH, SCATTER, HEIGHT_POINT, NO_DISC, SUM_OF_ERRORS, LASTING = (
    "mixed", "shared scale", "small truth", "scatter", "height point", "no disc", "sum of errors", "lasting",
)  # fmt: skip
CAUSE_TITLES = {
    MIXED: "Disc and line solutions in one bar",
    SHARED_SCALE: "Width and side distance share one scale",
    SMALL_TRUTH: "Percent of a small number",
    SCATTER: "Scatter through a short window",
    NO_DISC: "The disc is not the obstacle's shape, or not where (2) is exact",
    HEIGHT_POINT: "Height at the wrong point's distance",
    SUM_OF_ERRORS: "Length inherits all other errors",
    LASTING: "Errors that last through a run",
}


@dataclass(frozen=True)
class Finding:
    """A cell of Table 3 that is not reproduced, with the common properties of the runs outside the paper's range."""

    name: str
    verdict: str
    paper: str
    ours: str
    means: str
    factor: str
    outside: str
    where: str
    bias: str  # mean error over two sigma, outside
    condition: str  # rank correlation of the bar with the condition number
    late: str  # range of the last 20 %


@dataclass(frozen=True)
class Cause:
    """Findings with the same most likely cause."""

    title: str
    sentences: list[str]
    findings: list[Finding]


def causes(cases: Cases) -> list[Cause]:
    """Every cell of Table 3 whose bars leave the paper's range, by the most likely cause; widest miss first."""
    cells = [cell for cell in paper_cells(cases) if cell.verdict in (st.WORSE, st.MEANS_ONLY)]
    groups: dict[str, list[st.Cell]] = {}
    for cell in sorted(cells, key=lambda cell: -cell.factor):
        groups.setdefault(likely_cause(cell), []).append(cell)
    return [
        Cause(CAUSE_TITLES[cause], _explain(cases, cause, members), [_finding(cases, cell) for cell in members])
        for cause, members in groups.items()
    ]


def _cell_name(cell: st.Cell) -> str:
    return f"{NAMES[cell.obstacle].lower()}/{cell.model} {SYMBOLS[cell.quantity]}"


def _finding(cases: Cases, cell: st.Cell) -> Finding:
    assert cell.paper is not None
    outside = cell.outside
    driver = st.strongest_driver(cell.errors.runs, outside)
    where = "anywhere"
    if driver is not None:
        name, form = st.FACTORS[driver.factor]
        level = form.format(driver.level).replace("-", "−")
        where = (
            f"{name} {level}: {driver.out} of {driver.of}; elsewhere {driver.out_elsewhere} of {driver.of_elsewhere}"
        )
    late = st.make_cell(cases, cell.obstacle, cell.model, cell.quantity, min(cases.levels("fraction")))
    return Finding(
        name=f"{NAMES[cell.obstacle]}/{cell.model}, {SYMBOLS[cell.quantity]}",
        verdict=cell.verdict,
        paper=f"±{cell.paper} {UNITS[cell.quantity]}",
        ours=f"±{with_unit(cell.bars, cell.quantity)}",
        means=f"±{with_unit(cell.means, cell.quantity)}",
        factor=number(cell.factor),
        outside=f"{int(np.sum(outside))} of {len(outside)}",
        where=where,
        bias=number(_bias_ratio(cell)),
        condition=number(st.rank_correlation(cell.errors.runs["condition"], cell.errors.extent)),
        late="–" if late is None else f"±{with_unit(late.bars, cell.quantity)}",
    )


def _bias_ratio(cell: st.Cell) -> float:
    """Mean error over two sigma, median of the runs outside the paper's range."""
    bias, scatter = np.abs(cell.errors.mean[cell.outside]), cell.errors.two_sigma[cell.outside]
    return float(np.median(bias / np.maximum(scatter, 1e-12)))


def _is_of_small_truth(cell: st.Cell) -> bool:
    """Is the truth much smaller in the runs outside the paper's range than in those inside?"""
    if cell.quantity not in IN_PERCENT or np.all(cell.outside):
        return False
    truth = np.abs(cell.errors.runs[f"{cell.quantity}_truth"])
    return bool(np.median(truth[cell.outside]) < LARGE_TRUTH_RATIO * np.median(truth[~cell.outside]))


def _pure_range(cell: st.Cell) -> float:
    """The range of the runs with the line model only."""
    return t3.holding_range(cell.errors.extent[cell.errors.runs["fresh_line_share"] >= st.PURE])


def _is_mixture(cell: st.Cell) -> bool:
    """Do most bars outside mix disc and line solutions, and do runs without the mixture stay much closer to zero?"""
    if cell.model != "line":
        return False
    mixed = cell.errors.runs["fresh_line_share"][cell.outside] < st.PURE
    return bool(np.mean(mixed) > 0.5 and _pure_range(cell) < MUCH_CLOSER * cell.bars)


def _width_by_side(cell: st.Cell) -> float:
    """Two sigma of W over two sigma of X0, both in percent, median of the runs that have both."""
    side = cell.errors.runs[st.column("x0", "two_sigma")]
    ratios = cell.errors.two_sigma[side > 0.0] / side[side > 0.0]
    return float(np.median(ratios)) if len(ratios) else math.nan


def _shares_scale(cell: st.Cell) -> bool:
    """Is the width of the line model off by the same share as X0, as (5) makes it?"""
    if cell.model != "line" or cell.quantity != "width":
        return False
    return 1.0 / SAME_SHARE <= _width_by_side(cell) <= SAME_SHARE


def likely_cause(cell: st.Cell) -> str:
    """The first that fits: a rule of thumb, as the page explains."""
    if _is_mixture(cell):
        return MIXED
    if _shares_scale(cell):
        return SHARED_SCALE
    if _is_of_small_truth(cell):
        return SMALL_TRUTH
    if _bias_ratio(cell) < BIAS_RATIO:
        return SCATTER
    if cell.quantity == "height" and cell.obstacle != "cylinder":
        return HEIGHT_POINT
    if cell.model == "disc":
        return NO_DISC
    return SUM_OF_ERRORS if cell.quantity == "length" else LASTING


def _explain(cases: Cases, cause: str, cells: list[st.Cell]) -> list[str]:
    if cause == MIXED:
        ranges = [
            f"{_cell_name(cell)} ±{with_unit(_pure_range(cell), cell.quantity)} "
            f"({int(np.sum(cell.errors.runs['fresh_line_share'] >= st.PURE))} of {len(cell.errors.mean)} runs)"
            for cell in cells
        ]
        return [
            "In many runs the line model takes over late, so the part that counts begins with disc solutions, which "
            f"treat a box as a disc. Runs with the line model throughout this part stay closer: {'; '.join(ranges)}."
        ]
    if cause == SHARED_SCALE:
        ratios = listed([f"{_cell_name(cell)} {number(_width_by_side(cell))}" for cell in cells])
        return [
            "(5) determines the ratio X₀/W far better than the scale 1/W, so X₀ and W have the same relative error. "
            f"Scatter of W over that of X₀, both in percent, median of the runs: {ratios}. The paper's range of W is 6 "
            "to 12 times narrower than its range of X₀. One solution of (5) cannot give both, so the paper probably "
            "computes W in another way, which it does not describe. Its X₀, Z₀ and L agree.",
            *_evidence_of_part(cases, cells),
        ]
    if cause == SMALL_TRUTH:
        return [_explain_small_truth(cell) for cell in cells]
    if cause == SCATTER:
        return [
            f"In the runs outside the paper's range the mean error is less than {number(BIAS_RATIO)} of the two sigma "
            "(median): the solution scatters from image to image. Rounding to whole pixels has this effect if the "
            "apparent size hardly changes within a window.",
            *_evidence_of_part(cases, cells),
            *_evidence_of_window(cases, cells),
        ]
    if cause == NO_DISC:
        return [
            "The mean error is as large as the scatter or larger. (2) uses the tangents of a disc; its size row is "
            "exact on the flight line only, and a box is not a disc."
        ]
    if cause == HEIGHT_POINT:
        return [
            "The mean error is as large as the scatter or larger. (8) uses the reference point's distance, but the top "
            "point of a box is above its near corner."
        ]
    if cause == SUM_OF_ERRORS:
        return ["(7) multiplies the errors of Z₀, X₀, W and the orientation into the length, as the paper notes."]
    return [
        "The mean error is as large as the scatter or larger: it lasts through the part of the run that counts. W, X₀ "
        "and Z₀ share one scale in (5) and have a common error. In a straight flight, rounding errors of neighboring "
        "images are similar, so a window does not average them out.",
        *_evidence_of_wind(cases, cells),
    ]


def _explain_small_truth(cell: st.Cell) -> str:
    runs, outside = cell.errors.runs, cell.outside
    truth = np.abs(runs[f"{cell.quantity}_truth"])
    meters = np.abs(runs[f"{cell.quantity}_mean"]) + runs[f"{cell.quantity}_two_sigma"]
    return (
        f"{NAMES[cell.obstacle]}/{cell.model}: {SYMBOLS[cell.quantity]} is "
        f"{number(float(np.median(truth[outside])))} m in "
        f"the runs outside the range (median), {number(float(np.median(truth[~outside])))} m in those inside. "
        "In meters, "
        f"{t3.MOST:.0%} of all bars stay within ±{number(t3.holding_range(meters))} m."
    )


def _evidence_of_part(cases: Cases, cells: list[st.Cell]) -> list[str]:
    """How many stay in the paper's range in the shortest last part of the run?"""
    part = min(cases.levels("fraction"))
    kept = 0
    for cell in cells:
        late = st.make_cell(cases, cell.obstacle, cell.model, cell.quantity, part)
        kept += late is not None and cell.paper is not None and late.bars <= st.ROUNDING * cell.paper.value
    return (
        [
            f"Over the last {part * 100:.0f} % of the run, {kept} of these {len(cells)} numbers stay in the paper's "
            "range; the paper may have used later parts of its runs."
        ]
        if kept
        else []
    )


def _evidence_of_window(cases: Cases, cells: list[st.Cell]) -> list[str]:
    """Does a longer window reduce the error, as it must if the cause is scatter?"""
    rows = cases.select(study="conditioning", fraction=t3.FRACTION)
    windows = rows.levels("window") if len(rows) else []
    usual = float(np.median(cells[0].errors.runs["window"]))
    if usual not in windows or windows[-1] <= usual:
        return []
    said = []
    for cell in cells:
        mine = rows.select(obstacle=cell.obstacle, model="disc" if cell.model == "disc" else "auto")
        short, long = (st.median_rmse(mine.select(window=w), cell.quantity) for w in (usual, windows[-1]))
        if math.isfinite(short) and math.isfinite(long):
            said.append(f"{_cell_name(cell)} {with_unit(short, cell.quantity)} → {with_unit(long, cell.quantity)}")
    if not said:
        return []
    return [
        f"Root mean square error with {usual:g} → {windows[-1]:g} images in the window, conditioning study (a smaller "
        f"error supports scatter as the cause, a larger one does not): {'; '.join(said)}."
    ]


def _evidence_of_wind(cases: Cases, cells: list[st.Cell]) -> list[str]:
    """Do the lasting errors disappear in turbulence, as they must if rounding to whole pixels causes them?"""
    wind = cases.select(study="wind", fraction=t3.FRACTION)
    if not len(wind):
        return []
    said = []
    for cell in cells:
        shaken = wind.select(obstacle=cell.obstacle, model="disc" if cell.model == "disc" else "auto")
        steady = st.like_for_like(cases, shaken)
        biases = [
            float(np.nanmedian(values)) if np.any(np.isfinite(values)) else math.nan
            for values in (np.abs(runs[st.column(cell.quantity, "mean")]) for runs in (steady, shaken))
        ]
        if all(math.isfinite(bias) for bias in biases):
            said.append(f"{_cell_name(cell)} {' → '.join(with_unit(bias, cell.quantity) for bias in biases)}")
    if not said:
        return []
    return [
        "Turbulence makes rounding errors random. Mean error of the same cases in still air → in turbulence (median; a "
        f"smaller error supports rounding as the cause, a larger one does not): {'; '.join(said)}."
    ]
