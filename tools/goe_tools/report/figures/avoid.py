"""The aircraft's closest distance to the obstacle, with the flight layer's orders followed and without."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import avoid as av
from ..data import Campaign
from ..style import COLORS, INK, MISSED_PALE, PAPER_COLOR, SOFT
from .drawing import FigureSpec, panels

KIND_COLORS = {"mast": COLORS["cylinder"], "building": COLORS["building"], "truck": COLORS["truck"]}
WITHOUT, MARGIN = (0, (5, 2)), (0, (1, 1.5))
USUAL = 0.95  # share of the runs


def _reach(found: list[av.Courses]) -> float:
    """The end of the axis: most runs, not the few that turn away or climb early and pass far away."""
    usual = max(av.quantile(row.closest_with_m, USUAL) for row in found)
    return min(1.04 * max(_farthest(row) for row in found), 1.3 * usual)


def _farthest(row: av.Courses) -> float:
    return float(max(row.closest_with_m[-1], row.closest_without_m[-1]))


def _share(axes: Axes, ascending: np.ndarray, reach: float, **style: Any) -> None:
    """The share of the runs up to each closest distance, up to the end of the axis."""
    x = np.concatenate([[0.0], ascending, [max(reach, ascending[-1])]])
    y = np.concatenate([np.arange(len(ascending) + 1), [len(ascending)]]) * (100.0 / len(ascending))
    axes.step(x, y, where="post", **style)


def draw_avoid(campaign: Campaign, narrow: bool) -> Figure | None:
    found = av.courses(campaign.avoid) if campaign.avoid else []
    if campaign.avoid is None or not found:
        return None
    setup, reach = av.setup(campaign.avoid), _reach(found)
    height = 2.35 if narrow else 3.2
    figure, axes = panels(len(found), narrow, height)
    whole = height * len(found) if narrow else height
    figure.subplots_adjust(top=1.0 - (0.95 if narrow else 0.78) / whole, hspace=0.52)
    for one, row in zip(axes, found):
        one.axvspan(0.0, float(setup["collision_m"]), color=MISSED_PALE, linewidth=0, zorder=0)
        one.axvline(float(setup["margin_m"]), color=SOFT, linewidth=0.9, linestyle=MARGIN, zorder=1)
        _share(one, row.closest_without_m, reach, color=PAPER_COLOR, linewidth=1.5, linestyle=WITHOUT)
        _share(one, row.closest_with_m, reach, color=KIND_COLORS[row.kind], linewidth=1.8)
        _name(one, row, reach)
        one.set_xlim(0.0, reach)
        one.set_ylim(0.0, 103.0)
        one.set_yticks(range(0, 101, 25))
        one.grid()
        if not narrow or one is axes[-1]:
            one.set_xlabel("closest distance [m]", labelpad=1)
        if narrow or one is axes[0]:
            one.set_ylabel("share of the runs [%]")
    figure.legend(handles=_handles(setup), loc="upper center", ncols=2 if narrow else 4, borderaxespad=0.2,
                  columnspacing=1.2, fontsize=7.8 if narrow else 8.5)  # fmt: skip
    return figure


def _name(axes: Axes, row: av.Courses, reach: float) -> None:
    axes.set_title(av.KIND_NAMES[row.kind], pad=17, color=KIND_COLORS[row.kind])
    axes.text(0.0, 1.035, _said(row), transform=axes.transAxes, fontsize=7.8, color=SOFT)
    beyond = int(np.sum(row.closest_with_m > reach))
    if beyond:
        axes.text(0.985, 0.03, f"{beyond} of {row.runs} pass farther away", fontsize=7.2, color=SOFT, ha="right",
                  va="bottom", transform=axes.transAxes,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2, "alpha": 0.85})  # fmt: skip


def _handles(setup: dict[str, str]) -> list[Line2D | Patch]:
    margin = f"configured margin, {setup['margin_m']} m"
    return [
        Line2D([], [], color=INK, linewidth=1.8, label="goe's orders followed"),
        Line2D([], [], color=PAPER_COLOR, linewidth=1.5, linestyle=WITHOUT, label="without goe"),
        Line2D([], [], color=SOFT, linewidth=0.9, linestyle=MARGIN, label=margin),
        Patch(color=MISSED_PALE, label=f"collision, below {setup['collision_m']} m"),
    ]


def _said(row: av.Courses) -> str:
    least, middle = (av.one_decimal(av.quantile(row.closest_with_m, share)) for share in (0.0, 0.5))
    return f"with orders: least {least} m, median {middle} m"


def describe_avoid(campaign: Campaign) -> tuple[str, str]:
    assert campaign.avoid is not None
    caption = (
        "Closest distance of the aircraft's center to the obstacle's walls and top on a collision course: share of the "
        "runs up to each distance. A run ends with a collision."
    )
    said = [f"{av.KIND_NAMES[row.kind]}, {row.runs} runs: {_said(row)}" for row in av.courses(campaign.avoid)]
    return caption, (
        f"Distribution of the closest distance by obstacle. {'. '.join(said)}. {av.sentence(campaign.avoid)}"
    )


AVOID_FIGURE = FigureSpec("avoid_distance", "Closest distance", "avoid", draw_avoid, describe_avoid)
