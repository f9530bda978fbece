"""The paper's figures 6 to 14: mean errors in ascending order with two-sigma bars."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Campaign, Cases
from ..style import COLOURS, INK, MARKERS, NAMES, OBSTACLES, PAPER_COLOUR, QUANTITY_NAMES, SOFT, SYMBOLS, UNITS, number
from .drawing import Draw, panels

NICE_LIMITS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0,
               120.0, 150.0, 200.0, 300.0, 400.0, 500.0, 600.0, 800.0, 1000.0)  # fmt: skip


def axis_limit(cell: st.Cell) -> float:
    """Shows the ranges of Table 3, the paper's and ours, and all but the outermost bars."""
    wanted = max(1.15 * cell.paper.value if cell.paper else 0.0, 1.1 * cell.bars)
    wanted = max(wanted, min(1.05 * float(np.max(cell.errors.extent)), 1.6 * wanted))
    return next((limit for limit in NICE_LIMITS if limit >= wanted), NICE_LIMITS[-1])


def sorted_error_cells(campaign: Campaign, quantity: str, model: str) -> list[st.Cell]:
    cases = st.first_seed(campaign.cases)
    cells = [st.make_cell(cases, obstacle, model, quantity) for obstacle in OBSTACLES]
    return [cell for cell in cells if cell is not None and len(cell.errors.mean)]


def _draw_bars(axes: Axes, cell: st.Cell, limit: float) -> int:
    """Means in ascending order with +-2 sigma; returns how many bars leave the axis."""
    order = np.argsort(cell.errors.mean, kind="stable")
    mean, half = cell.errors.mean[order], cell.errors.two_sigma[order]
    x = np.arange(1, len(mean) + 1)
    colour = COLOURS[cell.obstacle]
    low, high = np.maximum(mean - half, -limit), np.minimum(mean + half, limit)
    seen = (low < limit) & (high > -limit)
    bars = [((i, a), (i, b)) for i, a, b in zip(x[seen], low[seen], high[seen])]
    width = 1.1 if len(x) > 30 else 1.7
    axes.add_collection(LineCollection(bars, colors=colour, alpha=0.5, linewidths=width))
    inside = np.abs(mean) <= limit
    size = 7.0 if len(x) > 30 else 13.0
    axes.scatter(x[inside], mean[inside], s=size, color=colour, marker=MARKERS[cell.obstacle], linewidths=0, zorder=3)
    for sign, marker in ((1.0, "^"), (-1.0, "v")):
        gone = sign * mean > limit
        axes.scatter(
            x[gone], np.full(np.sum(gone), sign * 0.975 * limit), s=15, marker=marker, facecolors="white",
            edgecolors=colour, linewidths=0.9, zorder=3,
        )  # fmt: skip
    axes.set_xlim(0.0, len(x) + 1.0)
    axes.set_ylim(-limit, limit)
    axes.set_xticks([1, len(x)] if len(x) < 20 else [1, *range(10, len(x) + 1, 10 if len(x) <= 40 else 20)])
    return int(np.sum((mean - half < -limit) | (mean + half > limit)))


def _draw_ranges(axes: Axes, cell: st.Cell, limit: float) -> None:
    if cell.paper is not None:
        value = cell.paper.value
        if cell.paper.beyond:
            for sign in (-1.0, 1.0):
                axes.axhline(sign * value, color=PAPER_COLOUR, linewidth=1.0, linestyle=(0, (1, 1.5)), zorder=1)
        else:
            axes.axhspan(-value, value, color="#e4e9ef", zorder=0, linewidth=0)
    if cell.bars <= limit:
        for sign in (-1.0, 1.0):
            axes.axhline(sign * cell.bars, color=INK, linewidth=0.9, linestyle=(0, (5, 3)), zorder=1)
    axes.axhline(0.0, color=SOFT, linewidth=0.7, zorder=1)


def draw_sorted_errors(quantity: str, model: str) -> Draw:
    def draw(campaign: Campaign, narrow: bool) -> Figure | None:
        cells = sorted_error_cells(campaign, quantity, model)
        if not cells:
            return None
        unit = UNITS[quantity]
        figure, axes = panels(
            len(cells), narrow, 2.15 if narrow else 3.5, [max(len(c.errors.mean), 16) ** 0.55 for c in cells]
        )
        for one, cell in zip(axes, cells):
            limit = axis_limit(cell)
            _draw_ranges(one, cell, limit)
            gone = _draw_bars(one, cell, limit)
            paper = "not in the paper's table" if cell.paper is None else (
                f"paper: most beyond ±{cell.paper.value:g} {unit}" if cell.paper.beyond
                else f"paper ±{cell.paper.value:g} {unit}"
            )  # fmt: skip
            ours = f"ours ±{number(cell.bars)} {unit}"
            text = f"{ours}, {paper}" if narrow else f"{ours}\n{paper}"
            one.set_title(NAMES[cell.obstacle], pad=17 if narrow else 28, color=COLOURS[cell.obstacle])
            one.text(0.0, 1.035, text, transform=one.transAxes, fontsize=7.8, color=SOFT, linespacing=1.3)
            if gone:
                one.text(0.985, 0.03, f"{gone} of {len(cell.errors.mean)} bars leave the axis", fontsize=7.2,
                         color=SOFT, transform=one.transAxes, ha="right", va="bottom", zorder=5,
                         bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2, "alpha": 0.85})  # fmt: skip
            one.grid(axis="y")
            one.yaxis.set_major_locator(MaxNLocator(6 if narrow else 8))
            one.tick_params(axis="y", labelsize=7.8)
            if narrow:
                one.set_ylabel(f"error of {SYMBOLS[quantity]} [{unit}]")
        figure.supxlabel("case, sorted by mean error [-]", fontsize=9, y=0.04 / (2.15 * len(cells) if narrow else 3.5))
        axes[0].set_ylabel(f"error of {QUANTITY_NAMES[quantity]} [{unit}]" if not narrow else axes[0].get_ylabel())
        return figure

    return draw


def describe_sorted_errors(quantity: str, model: str) -> Callable[[Campaign], tuple[str, str]]:
    def describe(campaign: Campaign) -> tuple[str, str]:
        cells = sorted_error_cells(campaign, quantity, model)
        unit = UNITS[quantity]
        longest, said = [], []
        for cell in cells:
            mean, half, runs = cell.errors.mean, cell.errors.two_sigma, cell.errors.runs
            i = int(np.argmax(cell.errors.extent))
            longest.append(
                f"{NAMES[cell.obstacle].lower()} {number(mean[i])} ± {number(half[i])} {unit} ({case_text(runs, i)})"
            )
            said.append(
                f"{NAMES[cell.obstacle]}, {len(mean)} cases: means from {number(float(np.min(mean)))} to "
                f"{number(float(np.max(mean)))} {unit}, {t3.MOST:.0%} of the bars within ±{number(cell.bars)} {unit}"
            )
        caption = f"Farthest from zero: {'; '.join(longest)}."
        start = f"Sorted mean errors of the {QUANTITY_NAMES[quantity]} with two-sigma bars, {model} model. "
        return caption, start + ". ".join(said) + "."

    return describe


def case_text(runs: Cases, i: int) -> str:
    """A run's case in words: 75 m aside, −45°, slope 6°."""
    angle = "" if runs["obstacle"][i] == "cylinder" else f", {runs['alpha_deg'][i]:g}°".replace("-", "−")
    return f"{runs['side_m'][i]:g} m aside{angle}, {runs['altitude_m'][i]:g} m high, slope {runs['glide_deg'][i]:g}°"
