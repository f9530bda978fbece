"""Shared by all figures: their description, panels, files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..data import Campaign
from ..style import COLORS, DPI, MARKERS, NAMES, NARROW_IN, OBSTACLES, RC, WIDE_IN

Draw = Callable[[Campaign, bool], "Figure | None"]


@dataclass(frozen=True)
class FigureSpec:
    """A figure of a page. ``draw(campaign, narrow)`` gives None if the campaign has no data for it."""

    key: str  # name of its files
    title: str
    section: str
    draw: Draw
    describe: Callable[[Campaign], tuple[str, str]]  # caption, alternative text
    in_page: str = "svg"  # png for many points


def panels(count: int, narrow: bool, height: float, widths: list[float] | None = None) -> tuple[Figure, list[Axes]]:
    """A row of panels, or a column of them. ``height``: of one panel, inches."""
    if narrow:
        figure, axes = plt.subplots(count, 1, figsize=(NARROW_IN, height * count), squeeze=False)
        figure.subplots_adjust(
            left=0.15, right=0.97, top=1.0 - 0.42 / (height * count), bottom=0.5 / (height * count), hspace=0.48
        )
    else:
        ratios = {"width_ratios": widths} if widths else None
        figure, axes = plt.subplots(1, count, figsize=(WIDE_IN, height), squeeze=False, gridspec_kw=ratios)
        figure.subplots_adjust(left=0.068, right=0.99, top=1.0 - 0.62 / height, bottom=0.5 / height, wspace=0.26)
    return figure, list(axes.ravel())


def obstacle_handles(which: tuple[str, ...] = OBSTACLES, line: bool = False) -> list[Line2D]:
    return [
        Line2D(
            [],
            [],
            linestyle="-" if line else "none",
            marker=MARKERS[o],
            markersize=4.5,
            color=COLORS[o],
            label=NAMES[o],
        )
        for o in which
    ]


def render(campaign: Campaign, spec: FigureSpec, narrow: bool, formats: Sequence[str]) -> dict[str, bytes]:
    """The figure in each of the formats (svg, png); empty if the campaign has no data for it."""
    with plt.rc_context(RC):
        figure = spec.draw(campaign, narrow)
        if figure is None:
            return {}
        drawn = {}
        for kind in formats:
            file = BytesIO()
            nothing = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
            figure.savefig(file, format=kind, dpi=DPI, metadata=nothing)
            drawn[kind] = file.getvalue()
        plt.close(figure)
    return drawn
