"""Plots error over sigma over time, a panel for each quantity with answers."""

from __future__ import annotations

from io import BytesIO

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from ..view.picture import THEMES, style
from .flown import KEYS, QUANTITIES
from .summary import OverTime, Summary

WIDE, NARROW = 4, 2  # panels side by side
PANEL_IN = (2.4, 1.75)
DPI = 130
LEAST = 3.0  # smallest range of an axis, sigmas


def _panel(axes: Axes, times: OverTime, quantity: int, theme: dict[str, str]) -> None:
    level = times.level[:, quantity]
    for low, high, alpha in ((0, 4, 0.20), (1, 3, 0.35)):
        axes.fill_between(
            times.time_s, level[:, low], level[:, high], color=theme["estimate"], alpha=alpha, linewidth=0
        )
    axes.plot(times.time_s, level[:, 2], color=theme["estimate"], linewidth=1.4)
    for sigmas, dashes in ((1, (1, 2)), (2, (4, 2))):
        for sign in (-1, 1):
            axes.axhline(sign * sigmas, color=theme["suspect"], linewidth=0.9, dashes=dashes)
    most = max(LEAST, 1.1 * float(np.nanmax(np.abs(level))))
    axes.set_ylim(-most, most)
    axes.set_xlim(0.0, float(times.time_s[-1]) + 0.5 * float(times.time_s[0]))
    of = QUANTITIES[quantity]
    axes.set_title(f"{of.symbol}  {of.name}", fontsize=7.5, loc="left", color=theme["ink"])


def shown(summary: Summary) -> list[int]:
    """The quantities with enough runs for a band."""
    return [q for q in range(len(KEYS)) if np.isfinite(summary.over_time.level[:, q]).any()]


def png(summary: Summary, theme_name: str, narrow: bool) -> bytes:
    """Empty if no quantity has enough runs."""
    theme, quantities = THEMES[theme_name], shown(summary)
    if not quantities:
        return b""
    columns = min(NARROW if narrow else WIDE, len(quantities))
    lines = -(-len(quantities) // columns)
    with plt.rc_context(style(theme)):
        figure, grid = plt.subplots(
            lines, columns, figsize=(PANEL_IN[0] * columns, PANEL_IN[1] * lines), squeeze=False, layout="constrained"
        )
        panels = list(grid.ravel())
        for axes, quantity in zip(panels, quantities):
            _panel(axes, summary.over_time, quantity, theme)
        for axes in panels[len(quantities) :]:
            axes.set_visible(False)
        for axes in panels[max(0, len(quantities) - columns) : len(quantities)]:
            axes.set_xlabel("time, s")
        for axes in grid[:, 0]:
            axes.set_ylabel("error / sigma")
        file = BytesIO()
        figure.savefig(file, format="png", dpi=DPI, metadata={"Software": None})
        plt.close(figure)
    return file.getvalue()
