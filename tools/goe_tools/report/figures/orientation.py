"""The paper's figure 5: the orientation of a building over time."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Campaign, Cases
from ..style import INK, NARROW_IN, SOFT, WIDE_IN, number


def orientation_series(campaign: Campaign) -> tuple[Cases, Cases] | None:
    """The paper's example: building at -20 degrees. It does not give the side distance; here the middle one, level."""
    runs = st.first_seed(campaign.cases.select(study="paper", obstacle="building", alpha_deg=-20.0, model="auto"))
    runs = runs.where(runs["glide_deg"] == 0.0)
    if not len(runs):
        return None
    sides = runs.levels("side_m")
    run = runs.select(side_m=sides[len(sides) // 2])
    series = campaign.series(int(run["case"][0]), "auto")
    if series is None or "orientation_raw_deg" not in series.columns or "front_orientation_deg" not in series.columns:
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
        (axes[0], _fold(raw + 90.0), series["front_orientation_deg"], other_truth, "other side", "#D55E00"),
        (axes[1], raw, mean, truth, "side edge: the orientation", "#0072B2"),
    )
    for one, points, line, true, title, color in rows:
        one.axhline(true, color=INK, linewidth=1.0, linestyle=(0, (5, 3)), zorder=2)
        one.plot(t, points, linestyle="none", marker="o", markersize=2.6, markeredgewidth=0, color=color, alpha=0.45)
        one.plot(t, line, color=color, linewidth=1.8)
        off = np.abs(points[np.isfinite(points)] - true)
        farthest = np.nanmax(np.abs(line - true), initial=0.0, where=np.isfinite(line))
        reach = 1.1 * max(2.0, float(np.percentile(off, 98.0)) if len(off) else 0.0, float(farthest))
        one.set_ylim(true - reach, true + reach)
        one.set_title(title, color=color)
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
        "and after the low-pass (line), for both visible sides. The library assumes a right angle between them. First "
        f"filtered value {number(abs(start))}° off, last {number(abs(end))}° off."
    )
    alt = (
        f"Orientation of the building over time, true value −20 degrees. The filtered side-edge angle starts "
        f"{number(start)} "
        f"degrees off and ends {number(end)} degrees off; single images scatter by {number(spread)} degrees (standard "
        f"deviation) over the last {t3.FRACTION:.0%} of the run. The other side is near 70 degrees."
    )
    return caption, alt
