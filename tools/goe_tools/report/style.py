"""Colors, names and sizes of the report. The colors are from the set of Okabe and Ito, which color-blind readers can
distinguish."""

from __future__ import annotations

import math
from typing import Any

INK, SOFT, FAINT, BAND = "#1c2430", "#5b6673", "#c9d0d8", "#eef2f6"
PAPER_COLOR = "#8a94a0"
WINDOW_COLOR, REFINED_COLOR, REFINED_PALE, MISSED = "#8a94a0", "#0072B2", "#8cc0e0", "#a33400"
MISSED_PALE = "#f2cdbd"

OBSTACLES = ("cylinder", "building", "truck", "long-truck")
NAMES = {"cylinder": "Cylinder", "building": "Building", "truck": "Truck", "long-truck": "Long truck"}
COLORS = {"cylinder": "#0072B2", "building": "#D55E00", "truck": "#009E73", "long-truck": "#AA4499"}
MARKERS = {"cylinder": "o", "building": "s", "truck": "^", "long-truck": "D"}

QUANTITY_NAMES = {
    "z0": "initial distance Z₀",
    "x0": "side distance X₀",
    "width": "width W",
    "length": "length L",
    "height": "height H",
    "orientation": "orientation",
}
SYMBOLS = {"z0": "Z₀", "x0": "X₀", "width": "W", "length": "L", "height": "H", "orientation": "β"}
GOAL_SYMBOLS = {"X0": "X₀", "Z0": "Z₀", "orientation": "β", "W": "W", "L": "L", "H": "H"}  # names in the file of goals
UNITS = {"z0": "%", "x0": "%", "width": "%", "length": "%", "height": "m", "orientation": "deg"}

WIDE_IN, NARROW_IN = 9.6, 3.8  # figure widths at about 100 px per inch: wide page, phone
DPI = 144  # of the PNG files

RC: dict[str, Any] = {
    "font.size": 9.0,
    "font.family": "DejaVu Sans",
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "grid.color": "#e3e8ed",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "goe",
    "path.simplify": True,
}


def number(value: float, digits: int = 2) -> str:
    """A value with ``digits`` significant digits, without an exponent: 0.043, 1.2, 23, 340."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.{digits - 1}e}")
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:.{decimals}f}".replace("-", "−")


def with_unit(value: float, quantity: str) -> str:
    unit = UNITS[quantity]
    return number(value) + ("°" if unit == "deg" else f"\u00a0{unit}")
