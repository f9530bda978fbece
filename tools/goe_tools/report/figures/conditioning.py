"""The condition number of (5) by setting, and its relation to the error."""

from __future__ import annotations

import math
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullLocator

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Campaign, Cases
from ..style import COLORS, FAINT, MARKERS, NAMES, NARROW_IN, OBSTACLES, QUANTITY_NAMES, SOFT, UNITS, WIDE_IN, number
from .drawing import obstacle_handles

FACTOR_LABELS = {
    "window": "window [images]",
    "side_m": "side distance [m]",
    "alpha_deg": "orientation [deg]",
    "fps_hz": "baseline of 8 images [m]",
}
FACTOR_TITLES = {
    "window": "Window",
    "side_m": "Side distance",
    "alpha_deg": "Orientation",
    "fps_hz": "Baseline (image rate)",
}


def conditioning_rows(campaign: Campaign) -> Cases:
    rows = campaign.cases.select(study="conditioning", fraction=t3.FRACTION)
    return rows.where((rows["model"] == "auto") | (rows["obstacle"] == "cylinder"))


def draw_conditioning(campaign: Campaign, narrow: bool) -> Figure | None:
    rows = conditioning_rows(campaign)
    if not len(rows):
        return None
    factors = [f for f in st.CONDITIONING_FACTORS if len(rows.levels(f)) > 1]
    measures = (
        ("condition number of (5) [-]", lambda r: r["condition"]),
        ("RMSE of Z₀ [%]", lambda r: r["z0_rmse_pct"]),
        ("RMSE of W [%]", lambda r: r["width_rmse_pct"]),
    )
    columns = 2 if narrow else len(factors)
    blocks = -(-len(factors) // columns)  # rows of one measure
    rows_of_panels = blocks * len(measures)
    height = (1.6 if narrow else 1.75) * rows_of_panels + 0.75
    figure, grid = plt.subplots(
        rows_of_panels, columns, figsize=(NARROW_IN if narrow else WIDE_IN, height), squeeze=False,
        sharex=False if narrow else "col", sharey=False if narrow else "row",
    )  # fmt: skip
    figure.subplots_adjust(
        left=0.15 if narrow else 0.075, right=0.985, top=1 - (0.78 if narrow else 0.62) / height, bottom=0.5 / height,
        wspace=0.26 if narrow else 0.08, hspace=0.62 if narrow else 0.12,
    )  # fmt: skip
    for spare in grid.ravel()[len(factors) :] if narrow and len(factors) < columns else []:
        spare.set_visible(False)
    for i, factor in enumerate(factors):
        kept = st.nominal_rows(rows, factor)
        for j, (label, values_of) in enumerate(measures):
            one = grid[j * blocks + i // columns, i % columns]
            for obstacle in OBSTACLES:
                _draw_factor(one, kept.select(obstacle=obstacle), factor, values_of, obstacle)
            one.set_yscale("log")
            if factor in ("window", "fps_hz"):
                one.set_xscale("log", base=2)
                _plain_ticks(one, factor, kept)
            elif factor == "alpha_deg":
                one.set_xticks((-45, 0, 45))
            one.grid(which="major")
            if narrow and i == 0:
                one.set_title(label, fontsize=8.5)
            elif not narrow and j == 0:
                one.set_title(FACTOR_TITLES[factor])
            if not narrow and i == 0:
                one.set_ylabel(label)
            if narrow or j == len(measures) - 1:
                one.set_xlabel(FACTOR_LABELS[factor], fontsize=8)
            one.tick_params(labelsize=7.8, which="both")
            _plain_axis(one.yaxis)
    quartiles = Patch(color=SOFT, alpha=0.25, linewidth=0, label="quartiles")
    figure.legend(handles=[*obstacle_handles(line=True), quartiles], loc="upper center", ncols=3 if narrow else 5,
                  handletextpad=0.4, columnspacing=1.2, borderaxespad=0.2)  # fmt: skip
    return figure


def _plain_ticks(axes: Axes, factor: str, rows: Cases) -> None:
    if factor == "window":
        axes.set_xticks([level for level in rows.levels(factor) if math.log2(level).is_integer()])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_locator(NullLocator())


def _plain_axis(axis: Axis) -> None:
    """A logarithmic axis with plain numbers and no minor ticks."""
    axis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}" if v < 1e4 else f"{v / 1e3:g}k"))
    axis.set_minor_locator(NullLocator())


def _draw_factor(axes: Axes, rows: Cases, factor: str, values_of: Callable[[Cases], np.ndarray], obstacle: str) -> None:
    if not len(rows):
        return
    values = values_of(rows)
    levels, bands = st.quartiles_by(rows, factor, values)
    if factor == "fps_hz":  # shown by the baseline that it changes
        levels = np.array([np.median(rows["baseline_m"][rows["fps_hz"] == level]) for level in levels])
        order = np.argsort(levels)
        levels, bands = levels[order], bands[order]
    if not len(levels):
        return
    style = {"color": COLORS[obstacle], "zorder": 3}
    if np.any(bands[:, 2] > bands[:, 0]):
        axes.fill_between(levels, bands[:, 0], bands[:, 2], color=COLORS[obstacle], alpha=0.12, linewidth=0)
    axes.plot(levels, bands[:, 1], marker=MARKERS[obstacle], markersize=3.0, linewidth=1.2, **style)


def describe_conditioning(campaign: Campaign) -> tuple[str, str]:
    rows = conditioning_rows(campaign)
    caption = (
        "Line: median over the cases; band: quartiles. Top to bottom: condition number of the "
        "2N × 3 matrix of (5) with columns as written, relative root mean square error of Z₀ and of W. One setting "
        "varies at a time. The line model waits until its window is full; until then a box is treated as a disc."
    )
    said = []
    for obstacle in OBSTACLES:
        mine = rows.select(obstacle=obstacle)
        windows = mine.levels("window") if len(mine) else []
        if len(windows) > 1:
            short, long = (mine.select(window=w) for w in (windows[0], windows[-1]))
            said.append(
                f"{NAMES[obstacle]}: Z₀ error {number(st.median_rmse(short, 'z0'))} % at {windows[0]:g} images, "
                f"{number(st.median_rmse(long, 'z0'))} % at {windows[-1]:g}"
            )
    return caption, "Condition number and errors by window, side distance, orientation and baseline. " + "; ".join(
        said
    ) + "."


def draw_condition_scatter(campaign: Campaign, narrow: bool) -> Figure | None:
    rows = scatter_rows(campaign)
    if not len(rows):
        return None
    quantities = ("z0", "x0", "width")
    height = 2.5 * len(quantities) if narrow else 3.3
    shape = (len(quantities), 1) if narrow else (1, len(quantities))
    figure, grid = plt.subplots(*shape, figsize=(NARROW_IN if narrow else WIDE_IN, height), sharey=False, squeeze=False)
    figure.subplots_adjust(
        left=0.15 if narrow else 0.07, right=0.985, top=1 - 0.7 / height, bottom=0.5 / height, wspace=0.24, hspace=0.36,
    )  # fmt: skip
    for one, quantity in zip(grid.ravel(), quantities):
        for obstacle in OBSTACLES:
            mine = rows.select(obstacle=obstacle)
            one.scatter(mine["condition"], mine[f"{quantity}_rmse_pct"], s=9, color=COLORS[obstacle], alpha=0.45,
                        marker=MARKERS[obstacle], linewidths=0)  # fmt: skip
        one.set_xscale("log")
        one.set_yscale("log")
        _plain_axis(one.xaxis)
        _plain_axis(one.yaxis)
        one.grid(which="major", color=FAINT, linewidth=0.5)
        one.set_title(QUANTITY_NAMES[quantity])
        one.set_ylabel(f"RMSE [{UNITS[quantity]}]", labelpad=2)
        if not narrow or quantity == quantities[-1]:
            one.set_xlabel("condition number of (5) [-]")
    figure.legend(handles=obstacle_handles(), loc="upper center", ncols=4, handletextpad=0.3, columnspacing=1.2,
                  borderaxespad=0.2)  # fmt: skip
    return figure


def scatter_rows(campaign: Campaign) -> Cases:
    """Runs of the paper's and of the conditioning study with a condition number."""
    rows = campaign.cases.select(study=("paper", "conditioning"), fraction=t3.FRACTION)
    return rows.where(((rows["model"] == "auto") | (rows["obstacle"] == "cylinder")) & np.isfinite(rows["condition"]))


def describe_condition_scatter(campaign: Campaign) -> tuple[str, str]:
    rows = scatter_rows(campaign)
    said = []
    for quantity in ("z0", "x0", "width"):
        values = []
        for obstacle in OBSTACLES:
            mine = rows.select(obstacle=obstacle)
            rho = st.rank_correlation(mine["condition"], mine[f"{quantity}_rmse_pct"])
            if math.isfinite(rho):
                values.append(f"{NAMES[obstacle].lower()} {rho:+.2f}".replace("-", "−"))
        said.append(f"{QUANTITY_NAMES[quantity]}: {', '.join(values)}")
    caption = (
        "Each run's error by its median condition number, paper's and conditioning study together. Rank correlation "
        "(Spearman; 1: the error always grows with the condition, 0: unrelated). " + "; ".join(said) + "."
    )
    return (
        caption,
        "Scatter of errors by condition number on logarithmic axes, one panel each for Z₀, X₀ and W. " + caption,
    )
