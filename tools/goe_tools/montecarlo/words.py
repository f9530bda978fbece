"""The text of the table and the page."""

from __future__ import annotations

import math

import numpy as np

from .flown import QUANTITIES
from .summary import EXPECTED, Row, Share, Summary, Warnings

SIMULATION = "All of this is simulation: goe_sim flew every run."
HEADS = ("quantity", "runs", "last error", "last sigma", "within 1 sigma", "within 2 sigma", "rms of error / sigma")
HOW_TO_READ = (
    f"If the sigmas are right, {EXPECTED[1]:.0%} of the estimates lie within 1 sigma of the truth and "
    f"{EXPECTED[2]:.0%} within 2 sigma. More: the sigmas are wider than necessary. Less: they are too small for the "
    "sensors of this scenario; configure the errors of the sensors with --set. A number after +- is one standard "
    "error, from the number of runs. Last error and last sigma are medians over the runs, of the absolute error and "
    "of the sigma of a run's last estimate."
)

EARLY = (
    "While the range is uncertain, a path near the margin often has a conflict probability above that of the rule. "
    "Such a warning usually ends when the range is known better."
)


def figure_of(value: float, unit: str) -> str:
    if not math.isfinite(value):
        return "-"
    digits = 0 if abs(value) >= 100.0 else 1 if abs(value) >= 10.0 else 2
    return f"{value:.{digits}f} {unit}" if unit != "°" else f"{value:.{digits}f}°"


def percent(share: Share) -> str:
    if not math.isfinite(share.mean):
        return "-"
    error = f" +- {100.0 * share.error:.1f}" if math.isfinite(share.error) and share.error > 0.0 else ""
    return f"{100.0 * share.mean:.1f}{error} %"


def cells(row: Row) -> list[str]:
    """In the order of ``HEADS``."""
    of = next(quantity for quantity in QUANTITIES if quantity.key == row.key)
    return [
        f"{of.symbol} {of.name}", str(row.runs), figure_of(row.last_error, of.unit), figure_of(row.last_sigma, of.unit),
        percent(row.inside[1]), percent(row.inside[2]), f"{row.rms:.2f}",
    ]  # fmt: skip


def lead_times(warnings: Warnings) -> str:
    if not warnings.leads_s:
        return ""
    least, low, middle = (float(np.percentile(warnings.leads_s, share)) for share in (0.0, 5.0, 50.0))
    return f"first warning {middle:.1f} s ahead in the median, {low:.1f} s in the worst 5 %, {least:.1f} s at the least"


def warning_sentences(warnings: Warnings, margin_m: float, clearance_m: float) -> list[str]:
    what = f"{margin_m:g} m to the walls with less than {clearance_m:g} m over the top"
    said = [f"The flown path, continued straight, violates {what} in {warnings.violated} of {warnings.runs} runs."]
    if warnings.violated:
        lead = lead_times(warnings)
        said.append(f"Warned in time: {warnings.warned}{f'; {lead}' if lead else ''}. Missed: {warnings.missed}.")
    if warnings.runs > warnings.violated:
        harmless = warnings.runs - warnings.violated
        said.append(f"False warnings: {warnings.false} of {harmless} runs without a violation.")
        if warnings.false:
            said.append(EARLY)
    if warnings.suspect:
        said.append(f"The estimate was suspect at least once in {warnings.suspect} runs.")
    return said


def unanswered(summary: Summary) -> str:
    """The quantities without an estimate in any run; empty: none."""
    absent = [q.symbol for q in QUANTITIES if not summary.row(q.key).runs]
    if len(absent) == len(QUANTITIES):
        return "No run gave an estimate. Was the obstacle in the camera's view? goe_sim --help has the camera's angles."
    return f"No estimate to compare with the truth: {', '.join(absent)}." if absent else ""
