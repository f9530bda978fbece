"""Upright boxes from a rolling aircraft: errors and coverage of both methods, by roll amplitude."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .data import COVERED, Campaign, Cases
from .paper_table3 import FRACTION
from .style import number

ALIKE = 1.15  # errors with a smaller ratio count as equal


@dataclass(frozen=True)
class Answers:
    """By quantity: root mean square error, median over the flights, m; share of the estimates within 2 of their own
    sigma, mean over the flights, percent."""

    error_m: dict[str, float]
    covered: dict[str, float]


@dataclass(frozen=True)
class RollRow:
    roll_deg: float
    flights: int
    window: Answers
    refined: Answers


def _answers(runs: Cases) -> Answers:
    def of(column: str, middle: str) -> float:
        values = runs[column][np.isfinite(runs[column])]
        return float(getattr(np, middle)(values)) if len(values) else float("nan")

    return Answers(
        {q: of(f"{q}_rmse", "median") for q in COVERED}, {q: 100.0 * of(f"{q}_covered", "mean") for q in COVERED}
    )


def by_roll(campaign: Campaign) -> list[RollRow]:
    """By ascending roll amplitude; empty if the campaign has no such flights."""
    if campaign.refined is None:
        return []
    window, refined = (cases.select(study="boxes", fraction=FRACTION) for cases in (campaign.cases, campaign.refined))
    rows = []
    for roll in refined.levels("roll_deg"):
        runs = [cases.select(roll_deg=roll) for cases in (window, refined)]
        rows.append(RollRow(roll, len(runs[1]), *(_answers(of_one) for of_one in runs)))
    return rows


def span(values: list[float]) -> str:
    """The range of values as text: 91 to 95."""
    low, high = number(min(values)), number(max(values))
    return low if low == high else f"{low} to {high}"


def sentences(rows: list[RollRow]) -> list[str]:
    """The result in words, from the numbers."""
    if not rows:
        return []
    level, most = rows[0], rows[-1]
    said = []
    if len(rows) > 1:
        before, after = level.refined.error_m["z0"], most.refined.error_m["z0"]
        ratio = after / before if before > 0.0 else float("nan")
        effect = "hardly changes" if 1.0 / ALIKE <= ratio <= ALIKE else "reduces" if ratio < 1.0 else "increases"
        said.append(
            f"Roll {effect} the error of goe's initial range Z₀: {number(before)} m at {level.roll_deg:g}° of roll, "
            f"{number(after)} m at {most.roll_deg:g}°."
        )
    shares = [[share for row in rows for share in of(row).covered.values()] for of in (_refined, _window)]
    errors = [[of(row).error_m["z0"] for row in rows] for of in (_refined, _window)]
    said.append(
        f"{span(shares[0])} % of goe's estimates lie within 2 of their own σ of the truth. Of the window method's "
        f"estimates {span(shares[1])} % do; its error of Z₀ is {span(errors[1])} m."
    )
    return said


def _refined(row: RollRow) -> Answers:
    return row.refined


def _window(row: RollRow) -> Answers:
    return row.window
