"""Sentences on Table 3: the result, the paper's conclusion, runs that do not count, effect of the part of the run."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Cases
from ..style import NAMES, SYMBOLS, number, with_unit
from .words import listed, plural


def paper_cells(cases: Cases) -> list[st.Cell]:
    return [cell for _, _, cells in st.table3(cases) for cell in cells if cell is not None and cell.paper is not None]


def summary(cases: Cases) -> list[str]:
    """The result in a few sentences."""
    cells = paper_cells(cases)
    count = Counter(cell.verdict for cell in cells)
    parts = [
        f"{count[st.REPRODUCED]} are reproduced",
        f"{count[st.BETTER]} are better",
        f"{count[st.MEANS_ONLY]} agree in the means but not in the mean ± 2σ bars",
        f"{count[st.WORSE]} are not reproduced",
    ]
    said = [f"Of the {len(cells)} numbers in the paper's Table 3, {', '.join(parts[:-1])} and {parts[-1]}."]
    misses = [cell for cell in cells if cell.verdict == st.WORSE]
    if misses:
        by_quantity = Counter(cell.quantity for cell in misses)
        names = [f"{SYMBOLS[q]} ({n})" for q, n in by_quantity.most_common()]
        widest = max(misses, key=lambda cell: cell.factor)
        said.append(
            f"Not reproduced: {', '.join(names)}. The widest miss is {SYMBOLS[widest.quantity]} of the "
            f"{NAMES[widest.obstacle].lower()} ({widest.model} model): {number(widest.factor)} times the paper's range."
        )
    return said + advice(cases)


def advice(cases: Cases) -> list[str]:
    """Does the paper's conclusion hold: disc model for distance and height, line model for side distance and size?"""
    boxes = ("building", "truck", "long-truck")
    holds, fails = [], []
    for quantity, wanted in (("z0", "disc"), ("height", "disc"), ("x0", "line"), ("width", "line")):
        ranges = {}
        for model in ("disc", "line"):
            cells = [st.make_cell(cases, obstacle, model, quantity) for obstacle in boxes]
            values = [cell.bars for cell in cells if cell is not None and math.isfinite(cell.bars)]
            ranges[model] = float(np.median(values)) if values else math.nan
        other = "line" if wanted == "disc" else "disc"
        if not all(math.isfinite(value) for value in ranges.values()):
            continue
        slack = 1.25 if wanted == "disc" else 1.0  # the paper calls the disc only about as good
        disc, line = (with_unit(ranges[model], quantity) for model in ("disc", "line"))
        text = f"{SYMBOLS[quantity]} (disc ±{disc}, line ±{line})"
        (holds if ranges[wanted] <= slack * ranges[other] else fails).append(text)
    said = []
    if holds:
        said.append(
            "The paper concludes: disc model for distance and height, line model for side distance and size. This "
            f"holds here for {listed(holds)}; medians over the box-shaped obstacles."
        )
    if fails:
        said.append(f"It does not hold here for {listed(fails)}.")
    return said


def missing(cases: Cases) -> list[str]:
    """The runs that do not count in Table 3."""
    said = []
    for obstacle, model in t3.PAPER_TABLE3:
        flown = st.flown_runs(cases, obstacle, model)
        counted = st.paper_runs(cases, obstacle, model)
        name = f"{NAMES[obstacle].lower()}/{model}"
        if len(counted) < len(flown):
            said.append(
                f"{name}: {len(flown) - len(counted)} of {plural(len(flown), 'run')} never have the line "
                "model's 8 points and stay with the disc."
            )
        for quantity in t3.TABLE3_QUANTITIES:
            if quantity == "length" and model == "disc":
                continue
            errors = st.errors_of(counted, quantity)
            if errors.without_estimate:
                said.append(f"{name}: {plural(errors.without_estimate, 'run')} without {SYMBOLS[quantity]}.")
            if errors.without_percent:
                said.append(
                    f"{name}: {plural(errors.without_percent, 'run')} with {SYMBOLS[quantity]} = 0, for which there is "
                    "no percentage."
                )
    return said


def better(cases: Cases) -> str:
    cells = [cell for cell in paper_cells(cases) if cell.verdict == st.BETTER]
    if not cells:
        return ""
    names = [
        f"{NAMES[c.obstacle].lower()}/{c.model} {SYMBOLS[c.quantity]} (±{with_unit(c.bars, c.quantity)}, paper "
        f"{c.paper})"
        for c in cells
    ]
    return f"Better than in the paper: {'; '.join(names)}."


def fraction_effect(cases: Cases) -> str:
    """How Table 3 depends on the part of the run, in one sentence."""
    levels = cases.levels("fraction")
    ratios = []
    for obstacle, model in t3.PAPER_TABLE3:
        for quantity in t3.TABLE3_QUANTITIES:
            short, long = (st.make_cell(cases, obstacle, model, quantity, level) for level in (levels[0], levels[-1]))
            if short is not None and long is not None and long.bars > 0.0:
                ratios.append(short.bars / long.bars)
    ratios = [ratio for ratio in ratios if math.isfinite(ratio)]
    if len(levels) < 2 or not ratios:
        return ""
    narrower = sum(ratio < 1.0 for ratio in ratios)
    return (
        f"Over the last {levels[0] * 100:.0f} % alone, {narrower} of the {len(ratios)} ranges are narrower than "
        f"over all solved images; the median ratio is {number(float(np.median(ratios)))}."
    )
