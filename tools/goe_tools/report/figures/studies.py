"""The studies beyond the paper, compared with straight flight."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .. import statistics as st
from ..data import Campaign, Cases
from ..style import BAND, COLORS, MARKERS, NARROW_IN, OBSTACLES, QUANTITY_NAMES, SOFT, UNITS, WIDE_IN, number
from .drawing import obstacle_handles


def draw_studies(campaign: Campaign, narrow: bool) -> Figure | None:
    found = st.variants(campaign.cases)
    if not found:
        return None
    labels = ["straight, as the paper", *(variant.label for variant in found)]
    columns = 2 if narrow else 3
    rows = math.ceil(len(st.STUDY_QUANTITIES) / columns)
    height = (0.62 + 0.235 * len(labels)) * rows + 0.75
    figure, grid = plt.subplots(rows, columns, figsize=(NARROW_IN if narrow else WIDE_IN, height), sharey=True)
    figure.subplots_adjust(
        left=0.38 if narrow else 0.19, right=0.975, top=1 - 0.62 / height, bottom=0.5 / height,
        wspace=0.12, hspace=0.42,
    )  # fmt: skip
    offsets = dict(zip(OBSTACLES, (-0.24, -0.08, 0.08, 0.24)))
    for one, quantity in zip(grid.ravel(), st.STUDY_QUANTITIES):
        for obstacle in OBSTACLES:
            values = _study_values(campaign.cases, found, obstacle, quantity)
            y = np.arange(len(values)) + offsets[obstacle]
            one.scatter(values, y, s=17, color=COLORS[obstacle], marker=MARKERS[obstacle], linewidths=0, zorder=3)
            if math.isfinite(values[0]):
                one.plot(
                    [values[0]] * 2,
                    [0, len(values) - 0.5],
                    color=COLORS[obstacle],
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
    straight = Line2D([], [], color=SOFT, linewidth=0.8, alpha=0.6, label="straight flight")
    figure.legend(handles=[*obstacle_handles(), straight], loc="upper center", ncols=3 if narrow else 5,
                  handletextpad=0.3, columnspacing=1.2, borderaxespad=0.2)  # fmt: skip
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


def describe_studies(campaign: Campaign) -> tuple[str, str]:
    found = st.variants(campaign.cases)
    caption = (
        "Root mean square error over the last 40 % of the solved images, median over the cases; logarithmic axes. "
        "Faint vertical lines: straight flight of the same cases. Boxes use the paper's switching (disc, then "
        "line), the cylinder uses the disc."
    )
    said = []
    for variant in found:
        straight = st.like_for_like(campaign.cases, variant.runs)
        ratio = st.median_rmse(variant.runs, "z0") / st.median_rmse(straight, "z0")
        said.append(f"{variant.label} {number(ratio)} times")
    return caption, (
        "Errors of all quantities for each study, by obstacle. Ratio of the initial distance's error to that of "
        "straight flight of the same cases: " + ", ".join(said) + "."
    )
