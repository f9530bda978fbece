"""The paper's figures 6 to 14: mean errors in ascending order with 2-sigma bars."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Campaign, Cases
from ..style import COLORS, INK, MARKERS, NAMES, OBSTACLES, PAPER_COLOR, QUANTITY_NAMES, SOFT, SYMBOLS, UNITS, number
from .drawing import Draw, panels

NICE_LIMITS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0,
               120.0, 150.0, 200.0, 300.0, 400.0, 500.0, 600.0, 800.0, 1000.0)  # fmt: skip

PAPER_BAND = "#e4e9ef"
HERE, BEYOND = (0, (5, 3)), (0, (1, 1.5))  # lines: range of the bars; limit that most of the paper's values exceed


def axis_limit(cell: st.Cell) -> float:
    """Contains both ranges of Table 3, and all bars but the outermost."""
    needed = max(1.15 * cell.paper.value if cell.paper else 0.0, 1.1 * cell.bars)
    needed = max(needed, min(1.05 * float(np.max(cell.errors.extent)), 1.6 * needed))
    return next((limit for limit in NICE_LIMITS if limit >= needed), NICE_LIMITS[-1])


def sorted_error_cells(campaign: Campaign, quantity: str, model: str) -> list[st.Cell]:
    cases = st.first_seed(campaign.cases)
    cells = [st.make_cell(cases, obstacle, model, quantity) for obstacle in OBSTACLES]
    return [cell for cell in cells if cell is not None and len(cell.errors.mean)]


def _handles(cells: list[st.Cell]) -> list[Line2D | Patch]:
    """The legend, with the range of the paper as it is drawn: band, dotted lines, or neither."""
    ranges = [cell.paper for cell in cells if cell.paper is not None]
    marker: dict[str, object] = {"color": SOFT, "linestyle": "none", "marker": "^", "markersize": 4.5}
    handles: list[Line2D | Patch] = [
        Line2D([], [], color=SOFT, linewidth=1.4, marker="o", markersize=4, label="mean error of a case, ±2σ"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle=HERE, label=f"range of {t3.MOST:.0%} of the bars"),
    ]
    if any(not one.beyond for one in ranges):
        handles.append(Patch(color=PAPER_BAND, label="the paper's range"))
    if any(one.beyond for one in ranges):
        label = "the paper: most beyond"
        handles.append(Line2D([], [], color=PAPER_COLOR, linewidth=1.0, linestyle=BEYOND, label=label))
    handles.append(Line2D([], [], **marker, markerfacecolor="white", label="mean outside the axis"))
    return handles


def _draw_bars(axes: Axes, cell: st.Cell, limit: float) -> int:
    """Means in ascending order with +-2 sigma; returns the number of bars that leave the axis."""
    order = np.argsort(cell.errors.mean, kind="stable")
    mean, half = cell.errors.mean[order], cell.errors.two_sigma[order]
    x = np.arange(1, len(mean) + 1)
    color = COLORS[cell.obstacle]
    low, high = np.maximum(mean - half, -limit), np.minimum(mean + half, limit)
    visible = (low < limit) & (high > -limit)
    bars = [((i, a), (i, b)) for i, a, b in zip(x[visible], low[visible], high[visible])]
    width = 1.1 if len(x) > 30 else 1.7
    axes.add_collection(LineCollection(bars, colors=color, alpha=0.5, linewidths=width))
    inside = np.abs(mean) <= limit
    size = 7.0 if len(x) > 30 else 13.0
    axes.scatter(x[inside], mean[inside], s=size, color=color, marker=MARKERS[cell.obstacle], linewidths=0, zorder=3)
    for sign, marker in ((1.0, "^"), (-1.0, "v")):
        gone = sign * mean > limit
        axes.scatter(
            x[gone], np.full(np.sum(gone), sign * 0.975 * limit), s=15, marker=marker, facecolors="white",
            edgecolors=color, linewidths=0.9, zorder=3,
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
                axes.axhline(sign * value, color=PAPER_COLOR, linewidth=1.0, linestyle=BEYOND, zorder=1)
        else:
            axes.axhspan(-value, value, color=PAPER_BAND, zorder=0, linewidth=0)
    if cell.bars <= limit:
        for sign in (-1.0, 1.0):
            axes.axhline(sign * cell.bars, color=INK, linewidth=0.9, linestyle=HERE, zorder=1)
    axes.axhline(0.0, color=SOFT, linewidth=0.7, zorder=1)


def draw_sorted_errors(quantity: str, model: str) -> Draw:
    def draw(campaign: Campaign, narrow: bool) -> Figure | None:
        cells = sorted_error_cells(campaign, quantity, model)
        if not cells:
            return None
        unit = UNITS[quantity]
        height = 2.25 if narrow else 3.75
        whole = height * len(cells) if narrow else height
        figure, axes = panels(len(cells), narrow, height, [max(len(c.errors.mean), 16) ** 0.55 for c in cells])
        figure.subplots_adjust(top=1.0 - (0.98 if narrow else 0.87) / whole)
        figure.legend(handles=_handles(cells), loc="upper center", ncols=2 if narrow else 5, borderaxespad=0.2,
                      columnspacing=1.2, handlelength=1.6, fontsize=7.4 if narrow else 8.2)  # fmt: skip
        for one, cell in zip(axes, cells):
            limit = axis_limit(cell)
            _draw_ranges(one, cell, limit)
            gone = _draw_bars(one, cell, limit)
            paper = "not in the paper's table" if cell.paper is None else (
                f"paper: most beyond ±{cell.paper.value:g} {unit}" if cell.paper.beyond
                else f"paper ±{cell.paper.value:g} {unit}"
            )  # fmt: skip
            ours = f"here ±{number(cell.bars)} {unit}"
            text = f"{ours}, {paper}" if narrow else f"{ours}\n{paper}"
            one.set_title(NAMES[cell.obstacle], pad=17 if narrow else 28, color=COLORS[cell.obstacle])
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
        figure.supxlabel("case, sorted by mean error [-]", fontsize=9, y=0.04 / whole)
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
        caption = f"Farthest from zero (mean ± 2σ): {'; '.join(longest)}."
        start = f"Sorted mean errors of the {QUANTITY_NAMES[quantity]} with 2-sigma bars, {model} model. "
        return caption, start + ". ".join(said) + "."

    return describe


def case_text(runs: Cases, i: int) -> str:
    """A run's case in words: 75 m aside, −45°, slope 6°."""
    angle = "" if runs["obstacle"][i] == "cylinder" else f", {runs['alpha_deg'][i]:g}°".replace("-", "−")
    return f"{runs['side_m'][i]:g} m aside{angle}, {runs['altitude_m'][i]:g} m high, slope {runs['glide_deg'][i]:g}°"
