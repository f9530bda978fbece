"""Figures of the goals: early warning, bound, coverage, moving cars."""

from __future__ import annotations

import math
from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import refined as rf
from ..data import Campaign
from ..goals_file import QUANTITIES, GoalRow
from ..prose import refined as prose
from ..style import (
    GOAL_SYMBOLS,
    INK,
    MISSED,
    NAMES,
    NARROW_IN,
    OBSTACLES,
    REFINED_COLOR,
    REFINED_PALE,
    SOFT,
    WIDE_IN,
    WINDOW_COLOR,
    number,
)
from .drawing import FigureSpec

GOOD_BAND = "#e3f1e8"
LEGEND_IN = 0.32  # height of a line of the legend


def _grid(count: int, columns: int, width: float, height: float, left: float) -> tuple[Figure, list[Axes], float]:
    """Panels of ``height`` inches in rows, with space for a legend above. Also returns the figure's height."""
    columns = min(columns, count)
    rows = math.ceil(count / columns)
    whole = height * rows + LEGEND_IN + 0.2
    figure, grid = plt.subplots(rows, columns, figsize=(width, whole), squeeze=False, sharey=True)
    figure.subplots_adjust(
        left=left, right=0.975, top=1 - (LEGEND_IN + 0.35) / whole, bottom=0.5 / whole, wspace=0.1,
        hspace=0.85 / (height - 0.85),
    )  # fmt: skip
    axes = list(grid.ravel())
    for spare in axes[count:]:
        spare.set_visible(False)
    return figure, axes[:count], whole


def _quantity_axis(axes: Axes) -> None:
    axes.set_yticks(range(len(QUANTITIES)), [GOAL_SYMBOLS[name] for name in QUANTITIES])
    axes.set_ylim(len(QUANTITIES) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x")


# ------------------------------------------------------------------------------------------------------- early warning

EARLY_WAYS = (
    ("window, true error", "window: true error below 10 %", WINDOW_COLOR),
    ("filter, own 2 sigma", "goe: own 2σ below 10 %", REFINED_COLOR),
    ("filter, true error", "goe: true error below 10 %", REFINED_PALE),
)


def draw_early(campaign: Campaign, narrow: bool) -> Figure | None:
    found = rf.early_rows(campaign.goals) if campaign.goals else {}
    if not found:
        return None
    figure, axes, _ = _grid(len(found), 1 if narrow else 2, NARROW_IN if narrow else WIDE_IN, 2.9,
                            0.22 if narrow else 0.1)  # fmt: skip
    for one, (noise, ways) in zip(axes, found.items()):
        _draw_early_panel(one, ways)
        title = prose.NOISE_NAMES.get(noise, noise)
        one.set_title(title if len(title) < 36 or not narrow else title.replace("a small aircraft's ", ""))
        one.set_xlabel("seconds before the obstacle is abeam")
    handles = [Patch(color=color, label=label) for _, label, color in EARLY_WAYS]
    if narrow:
        figure.legend(handles=handles, loc="upper center", ncols=2, fontsize=7.4, handlelength=1.2, columnspacing=0.9,
                      borderaxespad=0.1)  # fmt: skip
    else:
        figure.legend(handles=handles, loc="upper center", ncols=3, borderaxespad=0.2)
    return figure


def _draw_early_panel(axes: Axes, ways: dict[str, GoalRow]) -> None:
    height = 0.26
    longest = max((v for row in ways.values() for v in row.values.values() if math.isfinite(v)), default=1.0)
    for i, obstacle in enumerate(OBSTACLES):
        for j, (way, _, color) in enumerate(EARLY_WAYS):
            value = ways[way].values.get(obstacle, math.nan) if way in ways else math.nan
            if math.isfinite(value):
                y = i + (j - 1) * height
                axes.barh(y, value, height=0.9 * height, color=color)
                axes.text(value + 0.01 * longest, y, number(value, 3), va="center", fontsize=7.6, color=INK)
    axes.set_yticks(range(len(OBSTACLES)), [NAMES[obstacle] for obstacle in OBSTACLES])
    axes.set_ylim(len(OBSTACLES) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.1 * longest)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x")


def describe_early(campaign: Campaign) -> tuple[str, str]:
    assert campaign.goals is not None
    caption = (
        "Time before the obstacle is abeam from which on the initial distance is known to 10 %; median over the "
        "paper's cases. A longer bar is earlier. The true error is not known in flight; goe's own 2σ are."
    )
    return caption, "Bars of early warning by obstacle. " + " ".join(prose.early(campaign.goals))


# --------------------------------------------------------------------------------------------------------------- bound


def draw_bound(campaign: Campaign, narrow: bool) -> Figure | None:
    found = rf.bound_rows(campaign.goals) if campaign.goals else {}
    if not found:
        return None
    figure, axes, _ = _grid(len(found), 1 if narrow else 3, NARROW_IN if narrow else WIDE_IN, 2.6,
                            0.09 if narrow else 0.04)  # fmt: skip
    reach = max(_largest([row for pair in found.values() for row in pair]), 2.0)
    for one, (group, (median, tail)) in zip(axes, found.items()):
        for i, name in enumerate(QUANTITIES):
            middle, outer = median.values.get(name, math.nan), tail.values.get(name, math.nan)
            if not math.isfinite(middle):
                continue
            one.barh(i, middle, height=0.55, color=MISSED if name in median.missed else REFINED_COLOR)
            one.plot([middle, outer], [i, i], color=MISSED if name in tail.missed else SOFT, linewidth=1.2)
            one.plot(outer, i, marker="D", markersize=4.0, color=MISSED if name in tail.missed else SOFT)
            one.text(0.04 * reach, i, number(middle, 3), va="center", fontsize=7.8, color="white")
        one.axvline(1.0, color=INK, linewidth=1.1)
        for row, style in ((median, (0, (5, 3))), (tail, (0, (1, 1.5)))):
            if row.asked and math.isfinite(row.high):
                one.axvline(row.high, color=SOFT, linewidth=1.0, linestyle=style)
        _quantity_axis(one)
        one.set_xlim(0.0, 1.06 * reach)
        one.set_title(rf.group_title(group))
        one.set_xlabel("RMSE / Cramér-Rao bound [-]")
    handles = [
        Patch(color=REFINED_COLOR, label="median case"),
        Line2D([], [], color=SOFT, marker="D", markersize=4, linewidth=1.2, label="90th percentile"),
        Line2D([], [], color=INK, linewidth=1.1, label="the bound"),
        Line2D([], [], color=SOFT, linewidth=1.0, linestyle=(0, (5, 3)), label="goal, median"),
        Line2D([], [], color=SOFT, linewidth=1.0, linestyle=(0, (1, 1.5)), label="goal, 90th"),
    ]
    figure.legend(handles=handles, loc="upper center", ncols=3 if narrow else 5, borderaxespad=0.2,
                  handlelength=1.4, columnspacing=1.0, fontsize=7.5 if narrow else None)  # fmt: skip
    return figure


def _largest(rows: Sequence[GoalRow]) -> float:
    return max((v for row in rows for v in row.values.values() if math.isfinite(v)), default=1.0)


def describe_bound(campaign: Campaign) -> tuple[str, str]:
    assert campaign.goals is not None
    caption = (
        "Root mean square error at the end of the run over the Cramér-Rao bound, the smallest error of any unbiased "
        "estimator with these images, over the seeds of each case; the paper's cases and random ones. Dashed and "
        "dotted: goals for the median and the 90th percentile. With few seeds, a case's ratio scatters around its true "
        "value."
    )
    return caption, "Bars by quantity. " + " ".join(prose.bounds(campaign.goals))


# ------------------------------------------------------------------------------------------------------------ coverage

KIND_MARKERS = {"boxes": "s", "cylinders": "o", "parked cars": "o"}
MOMENT_COLORS = {"all answers": REFINED_COLOR, "first answers": "#E69F00", "at the end": "#5b6673"}
LEAST_SHARE = 80.0  # left end of the axis, unless a share is lower
SHORT_TITLES = {
    "Gaussian pixel noise": "Gaussian", "All errors of a small aircraft's sensors": "All errors",
    "Autopilots' recorded flights, ": "",
}  # fmt: skip


def draw_coverage(campaign: Campaign, narrow: bool) -> Figure | None:
    found = rf.coverage_rows(campaign.goals) if campaign.goals else {}
    if not found:
        return None
    figure, axes, _ = _grid(len(found), 2 if narrow else 4, NARROW_IN if narrow else WIDE_IN, 2.45,
                            0.08 if narrow else 0.04)  # fmt: skip
    rows = [row for kinds in found.values() for row in kinds.values()]
    least = min((v for row in rows for v in row.values.values() if math.isfinite(v)), default=LEAST_SHARE)
    low = min(LEAST_SHARE, 10.0 * math.floor((least - 1.0) / 10.0))
    for one, (group, kinds) in zip(axes, found.items()):
        band = next((row for row in kinds.values() if row.asked), None)
        if band is not None:
            one.axvspan(band.low, min(band.high, 100.0), color=GOOD_BAND, linewidth=0, zorder=0)
        for (kind, moment), row in kinds.items():
            _draw_shares(one, kind, moment, row)
        _quantity_axis(one)
        one.set_xlim(low, 101.0)
        one.set_xticks(np.arange(low, 101.0, _tick_step(low, narrow)))
        one.set_title(_short_title(group), fontsize=8.6)
        one.set_xlabel("within 2σ [%]", labelpad=1)
        one.tick_params(axis="x", labelsize=7.6)
    _coverage_legend(figure, narrow)
    return figure


def _tick_step(low: float, narrow: bool) -> float:
    """Percent, so that the labels do not overlap."""
    if low < 60.0:
        return 20.0
    return 5.0 if low >= LEAST_SHARE and not narrow else 10.0


def _short_title(group: str) -> str:
    title = rf.group_title(group)
    for long, short in SHORT_TITLES.items():
        title = title.replace(long, short)
    return title


def _draw_shares(axes: Axes, kind: str, moment: str, row: GoalRow) -> None:
    shift = (rf.MOMENTS.index(moment) - 1) * 0.2 if moment in rf.MOMENTS else 0.0
    shift += 0.09 if kind != "boxes" else 0.0
    names = [name for name in QUANTITIES if math.isfinite(row.values.get(name, math.nan))]
    axes.scatter(
        [row.values[name] for name in names], [QUANTITIES.index(name) + shift for name in names], s=19,
        marker=KIND_MARKERS.get(kind, "o"), facecolors=MOMENT_COLORS.get(moment, INK) if kind == "boxes" else "white",
        edgecolors=MOMENT_COLORS.get(moment, INK), linewidths=1.0, zorder=3, clip_on=False,
    )  # fmt: skip


def _coverage_legend(figure: Figure, narrow: bool) -> None:
    handles = [Line2D([], [], linestyle="none", marker="s", markersize=4.5, color=color, label=moment)
               for moment, color in MOMENT_COLORS.items()]  # fmt: skip
    handles += [
        Line2D([], [], linestyle="none", marker="s", markersize=4.5, color=INK, label="boxes"),
        Line2D([], [], linestyle="none", marker="o", markersize=4.5, markerfacecolor="white", color=INK,
               label="cylinders, cars"),
        Patch(color=GOOD_BAND, label="required"),
    ]  # fmt: skip
    figure.legend(handles=handles, loc="upper center", ncols=3 if narrow else 6, borderaxespad=0.2,
                  handletextpad=0.3, columnspacing=1.0 if narrow else 1.4, handlelength=1.2,
                  fontsize=7.8 if narrow else None)  # fmt: skip


def describe_coverage(campaign: Campaign) -> tuple[str, str]:
    assert campaign.goals is not None
    bands = dict.fromkeys(
        prose.wanted(row) for kinds in rf.coverage_rows(campaign.goals).values() for row in kinds.values() if row.asked
    )
    caption = (
        "Share of the estimates within 2 of their own sigma of the truth: all estimates of all flights, each flight's "
        f"first estimate, its last one. Green: required range ({' or '.join(bands)} %). Ideal: 95 %."
    )
    return caption, "Coverage by quantity, one panel for each kind of error. " + " ".join(
        prose.coverage(campaign.goals)
    )


# -------------------------------------------------------------------------------------------------------- moving cars


def draw_flags(campaign: Campaign, narrow: bool) -> Figure | None:
    found = rf.flags(campaign.goals) if campaign.goals else None
    if found is None:
        return None
    figure, axes = plt.subplots(figsize=(NARROW_IN, 3.4) if narrow else (WIDE_IN, 3.4))
    figure.subplots_adjust(left=0.14 if narrow else 0.068, right=0.97, top=0.96, bottom=0.15)
    axes.plot(found.false, found.caught, color=REFINED_COLOR, marker="o", markersize=4, linewidth=1.6,
              label="threshold of the NIS ratio varied")  # fmt: skip
    last = max(found.false)
    axes.plot([0.0, last], [0.0, last], color=SOFT, linewidth=0.9, linestyle=(0, (1, 1.5)), label="chance")
    for name in found.goal.asked:
        axes.plot(float(name.rstrip("% ")), found.goal.low, marker="*", markersize=12, linestyle="none",
                  color=REFINED_COLOR if found.goal.met else MISSED,
                  label=f"goal, {'met' if found.goal.met else 'missed'}")  # fmt: skip
    if found.default is not None:
        axes.plot(*found.default, marker="s", markersize=6, linestyle="none", color=INK, label="default threshold")
    axes.set_xlim(-0.03 * last, 1.05 * last)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlabel("parked cars flagged [%]")
    axes.set_ylabel("moving cars flagged [%]")
    axes.grid()
    axes.legend(loc="upper right", numpoints=1)
    return figure


def describe_flags(campaign: Campaign) -> tuple[str, str]:
    found = rf.flags(campaign.goals) if campaign.goals else None
    assert campaign.goals is not None and found is not None
    points = [f"{number(y)} % at {number(x)} %" for x, y in zip(found.false, found.caught)]
    caption = (
        "Cars of the KITTI data set: share of the moving cars that are flagged as not static, by the share of parked "
        "cars that are flagged in error. Each point has another threshold of the NIS ratio."
    )
    return caption, f"Receiver operating curve: detected {', '.join(points)} false flags. " + " ".join(
        prose.flags(campaign.goals)
    )


REFINED_FIGURES: tuple[FigureSpec, ...] = (
    FigureSpec("early", "Time from which the range is known", "early", draw_early, describe_early),
    FigureSpec("bound", "Error relative to the Cramér-Rao bound", "bound", draw_bound, describe_bound),
    FigureSpec("coverage", "Share of the estimates within 2σ", "coverage", draw_coverage, describe_coverage),
    FigureSpec("flags", "Moving cars", "flags", draw_flags, describe_flags),
)
