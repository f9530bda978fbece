"""The charts over time, for the page and the picture."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from .answers import NIS_RATIO_MAX, Answers, Options
from .outline import SIGMAS
from .words import NOTHING, measured

RARE, WIDE = 0.02, 0.12  # shares of values and of bands that may lie outside an axis, at each end
PADDING, SMALLEST = 0.06, 0.5


@dataclass(frozen=True)
class Chart:
    """A quantity over time. ``key``: its column in ``Answers``, and in the truth if known there; ``sigma``: the column
    of its 1 sigma, empty if it has none. ``scale``: from the column's unit to the displayed one."""

    key: str
    title: str
    unit: str
    note: str = ""
    sigma: str = ""
    scale: float = 1.0
    least: float | None = None  # a physical limit of the value, for the band
    limit: float | None = None  # a horizontal line
    floor: float | None = None  # the axis reaches at least from here ...
    ceiling: float | None = None  # ... to here


CHARTS = (
    Chart("z_m", "Distance ahead", "m", "along the direction of flight, to the reference point", "z_sd_m"),
    Chart("x_m", "Distance to the side", "m", "right of the direction of flight; negative: left", "x_sd_m"),
    Chart("width_m", "Width", "m", "of the front; disc: diameter; upright obstacle: across the first line of sight",
          "width_sd_m", least=0.0),
    Chart("height_m", "Height", "m", "top above ground", "height_sd_m", least=0.0),
    Chart("length_m", "Length", "m", "of the side", "length_sd_m", least=0.0),
    Chart("orientation_deg", "Orientation", "°", "of the side from the direction of flight, clockwise",
          "orientation_sd_deg"),
    Chart("tcpa_s", "Time to closest approach", "s", "on the present course", "tcpa_sd_s", least=0.0),
    Chart("dcpa_m", "Distance at closest approach", "m", "to the outline, horizontally; 0: above it", "dcpa_sd_m",
          least=0.0),
    Chart("clearance_m", "Height above the top then", "m", "at closest approach; negative: below the top",
          "clearance_sd_m"),
    Chart("conflict_probability", "Conflict probability", "%", "that margin and clearance are both violated", "", 100.0,
          floor=0.0, ceiling=100.0),
    Chart("nis_ratio", "NIS ratio", "", "residuals over the settings' noise; 1: as expected; suspect above the line",
          limit=NIS_RATIO_MAX, floor=0.0),
)  # fmt: skip


def charts_of(options: Options) -> tuple[Chart, ...]:
    """The charts of a replay, with the NIS ratio's limit from its settings."""
    limit = options.settings.get("filter.nis_ratio_max", NIS_RATIO_MAX)
    return tuple(dataclasses.replace(c, limit=limit) if c.key == "nis_ratio" else c for c in CHARTS)


def text(chart: Chart, answers: Answers, k: int) -> str:
    """The value in one image: "473 ± 12 m"."""
    value = chart.scale * float(answers.column[chart.key][k])
    if not math.isfinite(value):
        return NOTHING
    if chart.unit == "%":
        return f"{value:.0f}\u00a0%" if value >= 1.0 or value == 0.0 else "< 1\u00a0%"
    if not chart.sigma:
        return f"{value:.2f}"
    sigma = chart.scale * float(answers.column[chart.sigma][k])
    if chart.key == "x_m":
        return f"{measured(abs(value), sigma, chart.unit)} {'left' if value < 0.0 else 'right'}"
    return measured(value, sigma, chart.unit)


def axis_range(chart: Chart, answers: Answers, truth: dict[str, np.ndarray]) -> tuple[float, float] | None:
    """Contains the values, the truth and most of the band, but not the largest early bands; None: there are no
    values."""
    value = chart.scale * answers.column[chart.key]
    known = value[np.isfinite(value)]
    if not len(known):
        return None
    low, high = np.quantile(known, [RARE, 1.0 - RARE])
    if chart.sigma:
        band = SIGMAS * chart.scale * answers.column[chart.sigma]
        low = min(low, np.nanquantile(value - band, WIDE))
        high = max(high, np.nanquantile(value + band, 1.0 - WIDE))
    true = truth.get(chart.key, np.empty(0))
    true = chart.scale * true[np.isfinite(true)]
    edges = [low, high, *(edge for edge in (chart.limit, chart.floor, chart.ceiling) if edge is not None)]
    edges += [true.min(), true.max()] if len(true) else []
    low, high = min(edges), max(edges)
    if chart.least is not None:
        low = max(low, chart.least)
    padding = PADDING * (high - low) or max(PADDING * abs(high), SMALLEST)
    return float(low - padding), float(high + padding)
