"""The paper's figures 5 to 14 with this campaign's numbers, and those of the studies beyond it.

A figure is drawn twice: wide (panels side by side) and narrow (panels one below the other, for phones).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

from ..optimum import paper_table3 as t3
from . import statistics as st
from .data import Campaign, Cases
from .drawing import Draw, FigureSpec, panels
from .refined_figures import REFINED_FIGURES
from .style import (
    BAND,
    COLOURS,
    FAINT,
    INK,
    MARKERS,
    NAMES,
    NARROW_IN,
    OBSTACLES,
    PAPER_COLOUR,
    QUANTITY_NAMES,
    SOFT,
    SYMBOLS,
    UNITS,
    WIDE_IN,
    number,
)

# ------------------------------------------------------------------------------------------------- figures 6 to 14

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


# ---------------------------------------------------------------------------------------------------------- figure 5


def orientation_series(campaign: Campaign) -> tuple[Cases, Cases] | None:
    """The paper's example: building at -20 degrees. Its side distance is not told; the middle one, level flight."""
    runs = st.first_seed(campaign.cases.select(study="paper", obstacle="building", alpha_deg=-20.0, model="auto"))
    runs = runs.where(runs["glide_deg"] == 0.0)
    if not len(runs):
        return None
    sides = runs.levels("side_m")
    run = runs.select(side_m=sides[len(sides) // 2])
    series = campaign.series(int(run["case"][0]), "auto")
    if series is None or "orientation_raw_deg" not in series.columns or "other_side_deg" not in series.columns:
        return None
    return run, series


def _fold(angle: np.ndarray) -> np.ndarray:
    """Degrees into (-90, 90]."""
    return 90.0 - np.mod(90.0 - angle, 180.0)


def draw_orientation(campaign: Campaign, narrow: bool) -> Figure | None:
    found = orientation_series(campaign)
    if found is None:
        return None
    run, series = found
    t, raw, mean = series["t_s"], series["orientation_raw_deg"], series["orientation_deg"]
    truth = float(run["alpha_deg"][0])
    other_truth = float(_fold(np.array([truth + 90.0]))[0])
    height = 5.6 if narrow else 3.9
    figure, axes = plt.subplots(2, 1, figsize=(NARROW_IN if narrow else WIDE_IN, height), sharex=True)
    figure.subplots_adjust(
        left=0.15 if narrow else 0.068, right=0.97 if narrow else 0.99, top=1 - 0.35 / height, bottom=0.5 / height,
        hspace=0.26,
    )  # fmt: skip
    rows = (
        (axes[0], _fold(raw + 90.0), series["other_side_deg"], other_truth, "other side", "#D55E00"),
        (axes[1], raw, mean, truth, "side edge: the orientation", "#0072B2"),
    )
    for one, points, line, true, title, colour in rows:
        one.axhline(true, color=INK, linewidth=1.0, linestyle=(0, (5, 3)), zorder=2)
        one.plot(t, points, linestyle="none", marker="o", markersize=2.6, markeredgewidth=0, color=colour, alpha=0.45)
        one.plot(t, line, color=colour, linewidth=1.8)
        off = np.abs(points[np.isfinite(points)] - true)
        farthest = np.nanmax(np.abs(line - true), initial=0.0, where=np.isfinite(line))
        reach = 1.1 * max(2.0, float(np.percentile(off, 98.0)) if len(off) else 0.0, float(farthest))
        one.set_ylim(true - reach, true + reach)
        one.set_title(title, color=colour)
        one.set_ylabel("angle to Z [deg]")
        one.grid(axis="y")
    axes[1].set_xlabel("time [s]")
    handles = [
        Line2D([], [], linestyle="none", marker="o", markersize=3.5, color=SOFT, alpha=0.6, label="single image"),
        Line2D([], [], color=SOFT, linewidth=1.8, label="filtered"),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (5, 3)), label="truth"),
    ]
    figure.legend(handles=handles, loc="upper right", ncols=3, bbox_to_anchor=(0.975 if narrow else 0.99, 1.0),
                  borderaxespad=0.1, handlelength=1.6, columnspacing=1.0)  # fmt: skip
    return figure


def describe_orientation(campaign: Campaign) -> tuple[str, str]:
    found = orientation_series(campaign)
    if found is None:
        return "", ""
    run, series = found
    error = series["orientation_deg"] - float(run["alpha_deg"][0])
    raw = _fold(series["orientation_raw_deg"] - float(run["alpha_deg"][0]))
    there = error[np.isfinite(error)]
    last = there[int(len(there) * (1.0 - t3.FRACTION)) :]
    start, end = (there[0], there[-1]) if len(there) else (math.nan, math.nan)
    spread = float(np.nanstd(raw[np.isfinite(raw)][-len(last) :])) if len(last) else math.nan
    caption = (
        f"Building at −20°, {run['side_m'][0]:g} m aside, level flight: the angle of each image alone (dots) "
        "and after the "
        f"low-pass (line), for both visible sides. The library takes the other "
        "side at a right angle to the one it measures. First "
        f"filtered value {number(abs(start))}° off, last {number(abs(end))}° off."
    )
    alt = (
        f"Orientation of the building over time, true value −20 degrees. The filtered side-edge angle starts "
        f"{number(start)} "
        f"degrees off and ends {number(end)} degrees off; single images scatter by {number(spread)} degrees (standard "
        f"deviation) over the last {t3.FRACTION:.0%} of the run. The other side is seen near 70 degrees."
    )
    return caption, alt


# ------------------------------------------------------------------------------------------- studies beyond the paper


def draw_studies(campaign: Campaign, narrow: bool) -> Figure | None:
    found = st.variants(campaign.cases)
    if not found:
        return None
    labels = ["straight, as the paper", *(variant.label for variant in found)]
    columns = 2 if narrow else 3
    rows = math.ceil(len(st.STUDY_QUANTITIES) / columns)
    height = (0.62 + 0.235 * len(labels)) * rows + 0.75
    figure, grid = plt.subplots(rows, columns, figsize=(NARROW_IN * 1.12 if narrow else WIDE_IN, height), sharey=True)
    figure.subplots_adjust(
        left=0.34 if narrow else 0.19, right=0.975, top=1 - 0.62 / height, bottom=0.5 / height,
        wspace=0.12, hspace=0.42,
    )  # fmt: skip
    offsets = dict(zip(OBSTACLES, (-0.24, -0.08, 0.08, 0.24)))
    for one, quantity in zip(grid.ravel(), st.STUDY_QUANTITIES):
        for obstacle in OBSTACLES:
            values = _study_values(campaign.cases, found, obstacle, quantity)
            y = np.arange(len(values)) + offsets[obstacle]
            one.scatter(values, y, s=17, color=COLOURS[obstacle], marker=MARKERS[obstacle], linewidths=0, zorder=3)
            if math.isfinite(values[0]):
                one.plot(
                    [values[0]] * 2,
                    [0, len(values) - 0.5],
                    color=COLOURS[obstacle],
                    linewidth=0.8,
                    alpha=0.35,
                    zorder=1,
                )
        one.set_xscale("log")
        _plain_log_axis(one, narrow)
        one.set_ylim(len(labels) - 0.5, -0.5)
        one.axhspan(-0.5, 0.5, color=BAND, zorder=0, linewidth=0)
        one.set_yticks(range(len(labels)), labels)
        one.tick_params(axis="y", length=0, labelsize=8)
        one.grid(axis="x", which="major")
        one.set_title(QUANTITY_NAMES[quantity].replace("initial ", "").replace("side distance", "side dist."))
        one.set_xlabel(f"RMSE [{UNITS[quantity]}]", labelpad=1)
    figure.legend(handles=_obstacle_handles(), loc="upper center", ncols=4, handletextpad=0.3, columnspacing=1.2,
                  borderaxespad=0.2)  # fmt: skip
    return figure


def _study_values(cases: Cases, found: list[st.Variant], obstacle: str, quantity: str) -> np.ndarray:
    """Median over the cases of the RMSE: straight flight of the same cases first, then each variant."""
    mine = [variant.runs.select(obstacle=obstacle) for variant in found]
    flown = next((runs for runs in mine if len(runs)), None)
    if flown is None:
        return np.full(len(found) + 1, math.nan)
    straight = st.like_for_like(cases, flown)
    return np.array([st.median_rmse(runs, quantity) for runs in (straight, *mine)])


def _plain_log_axis(axes: Axes, narrow: bool) -> None:
    low, high = axes.get_xlim()
    decades = math.log10(high / low) if low > 0 else 1.0
    subs = (1.0,) if decades > 2.0 else ((1.0, 3.0) if decades > 1.0 or narrow else (1.0, 2.0, 5.0))
    axes.xaxis.set_major_locator(LogLocator(subs=subs, numticks=8))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_locator(NullLocator())


def _obstacle_handles(which: tuple[str, ...] = OBSTACLES, line: bool = False) -> list[Line2D]:
    return [
        Line2D(
            [],
            [],
            linestyle="-" if line else "none",
            marker=MARKERS[o],
            markersize=4.5,
            color=COLOURS[o],
            label=NAMES[o],
        )
        for o in which
    ]


def describe_studies(campaign: Campaign) -> tuple[str, str]:
    found = st.variants(campaign.cases)
    caption = (
        "Root mean square error over the last 40 % of the solved images, median over the cases; logarithmic "
        "axes. Faint "
        "vertical lines: straight flight of the same cases. Boxes with the paper's switching (disc, then line), "
        "cylinder with "
        "the disc."
    )
    said = []
    for variant in found:
        straight = st.like_for_like(campaign.cases, variant.runs)
        ratio = st.median_rmse(variant.runs, "z0") / st.median_rmse(straight, "z0")
        said.append(f"{variant.label} {number(ratio)} times")
    return caption, (
        "Errors of all quantities for each study, by obstacle. Initial distance against straight flight of the "
        "same cases: " + ", ".join(said) + "."
    )


# -------------------------------------------------------------------------------------------------------- conditioning

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
    shape = (len(factors), len(measures)) if narrow else (len(measures), len(factors))
    height = 1.75 * shape[0] + 0.75
    figure, grid = plt.subplots(
        *shape, figsize=(NARROW_IN * 1.5 if narrow else WIDE_IN, height), squeeze=False,
        sharex="row" if narrow else "col", sharey="col" if narrow else "row",
    )  # fmt: skip
    figure.subplots_adjust(
        left=0.11 if narrow else 0.075, right=0.985, top=1 - 0.62 / height, bottom=0.5 / height,
        wspace=0.24 if narrow else 0.08, hspace=0.45 if narrow else 0.12,
    )  # fmt: skip
    for i, factor in enumerate(factors):
        kept = st.nominal_rows(rows, factor)
        for j, (label, values_of) in enumerate(measures):
            one = grid[i, j] if narrow else grid[j, i]
            for obstacle in OBSTACLES:
                _draw_factor(one, kept.select(obstacle=obstacle), factor, values_of, obstacle)
            one.set_yscale("log")
            if factor in ("window", "fps_hz"):
                one.set_xscale("log", base=2)
                _plain_ticks(one, factor, kept)
            elif factor == "alpha_deg":
                one.set_xticks((-45, 0, 45))
            one.grid(which="major")
            first = (i if narrow else j) == 0
            if first:
                one.set_title(label if narrow else FACTOR_TITLES[factor], fontsize=8 if narrow else None)
            if (j if narrow else i) == 0 and not narrow:
                one.set_ylabel(label)
            if narrow or j == len(measures) - 1:
                one.set_xlabel(FACTOR_LABELS[factor], fontsize=8)
            one.tick_params(labelsize=7.8, which="both")
            _plain_axis(one.yaxis)
    figure.legend(handles=_obstacle_handles(line=True), loc="upper center", ncols=4, handletextpad=0.4,
                  columnspacing=1.2, borderaxespad=0.2)  # fmt: skip
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
    if factor == "fps_hz":  # shown by what it changes
        levels = np.array([np.median(rows["baseline_m"][rows["fps_hz"] == level]) for level in levels])
        order = np.argsort(levels)
        levels, bands = levels[order], bands[order]
    if not len(levels):
        return
    style = {"color": COLOURS[obstacle], "zorder": 3}
    if np.any(bands[:, 2] > bands[:, 0]):
        axes.fill_between(levels, bands[:, 0], bands[:, 2], color=COLOURS[obstacle], alpha=0.12, linewidth=0)
    axes.plot(levels, bands[:, 1], marker=MARKERS[obstacle], markersize=3.0, linewidth=1.2, **style)


def describe_conditioning(campaign: Campaign) -> tuple[str, str]:
    rows = conditioning_rows(campaign)
    caption = (
        "Median (line) and quartiles (band) over the cases. Top to bottom: condition number of the 2N × 3 "
        "matrix of (5) with "
        "columns as written, relative root mean square error of Z₀ and of W; one setting is changed at a time. "
        "On a phone: left to right. A longer window also delays the line, which waits until its window is full; until "
        "then a box is seen as a disc."
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
    return caption, "Condition number and errors against window, side distance, orientation and baseline. " + "; ".join(
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
            one.scatter(mine["condition"], mine[f"{quantity}_rmse_pct"], s=9, color=COLOURS[obstacle], alpha=0.45,
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
    figure.legend(handles=_obstacle_handles(), loc="upper center", ncols=4, handletextpad=0.3, columnspacing=1.2,
                  borderaxespad=0.2)  # fmt: skip
    return figure


def scatter_rows(campaign: Campaign) -> Cases:
    """Runs of the paper's and of the conditioning study whose condition is known."""
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
        "Each run's error against its median condition number, paper's and conditioning study together. Rank "
        "correlation "
        "(Spearman; 1: the error always grows with the condition, 0: unrelated). " + "; ".join(said) + "."
    )
    return (
        caption,
        "Scatter of errors against condition number on logarithmic axes, one panel each for Z₀, X₀ and W. " + caption,
    )


# ------------------------------------------------------------------------------------------------------------ the list

_ERRORS = (
    (6, "z0", "disc"), (7, "x0", "disc"), (8, "width", "disc"), (9, "z0", "line"), (10, "x0", "line"),
    (11, "width", "line"), (12, "length", "line"), (13, "height", "disc"), (14, "height", "line"),
)  # fmt: skip


def _error_figure(number_in_paper: int, quantity: str, model: str) -> FigureSpec:
    name = QUANTITY_NAMES[quantity]
    return FigureSpec(
        f"fig{number_in_paper:02d}_{quantity}_{model}",
        f"Figure {number_in_paper}. {name[0].upper() + name[1:]}, {model} model",
        "figures",
        draw_sorted_errors(quantity, model),
        describe_sorted_errors(quantity, model),
    )


FIGURES: tuple[FigureSpec, ...] = (
    *REFINED_FIGURES,
    FigureSpec("fig05_orientation", "Figure 5. Orientation of a building", "figures", draw_orientation,
               describe_orientation),
    *(_error_figure(*entry) for entry in _ERRORS),
    FigureSpec("studies", "Errors by study", "studies", draw_studies, describe_studies),
    FigureSpec("conditioning", "What drives the condition, and the error", "conditioning", draw_conditioning,
               describe_conditioning),
    FigureSpec("condition_scatter", "Error against condition number", "conditioning", draw_condition_scatter,
               describe_condition_scatter, in_page="png"),
)  # fmt: skip
