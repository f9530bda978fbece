"""Sentences on the studies beyond the paper, on the condition number and on the window."""

from __future__ import annotations

import math

import numpy as np

from .. import paper_table3 as t3
from .. import statistics as st
from ..data import Campaign, Cases
from ..style import number
from .words import plural

HARDER, EASIER = 1.3, 0.9  # ratio of a study's error to that of straight flight


def studies(cases: Cases) -> list[str]:
    """Which studies are harder than straight flight, by the error of Z₀."""
    harder, alike, easier = [], [], []
    for variant in st.variants(cases):
        straight = st.like_for_like(cases, variant.runs)
        a, b = st.median_rmse(straight, "z0"), st.median_rmse(variant.runs, "z0")
        if math.isfinite(a) and math.isfinite(b) and a > 0.0:
            group = harder if b > HARDER * a else easier if b < EASIER * a else alike
            group.append(f"{variant.label} (×{number(b / a)})")
    said = []
    for group, text in (
        (harder, f"Harder than straight flight (error of Z₀ more than {number(HARDER)} times as large): "),
        (alike, "About as hard: "),
        (easier, f"Easier (less than {number(EASIER)} times): "),
    ):
        if group:
            said.append(text + "; ".join(group) + ".")
    return said


def outliers(campaign: Campaign) -> str:
    """An open question of the paper: do its outliers have large condition numbers?"""
    runs = campaign.cases.select(study="paper", fraction=t3.FRACTION)
    runs = runs.where(((runs["model"] == "auto") | (runs["obstacle"] == "cylinder")) & np.isfinite(runs["condition"]))
    count, bad, shares = 0, 0, []
    for obstacle in runs.levels("obstacle"):
        mine = runs.select(obstacle=obstacle)
        extent = np.abs(mine["z0_mean_pct"]) + mine["z0_two_sigma_pct"]
        mask = extent > 3.0 * np.nanmedian(extent)
        limit = np.percentile(mine["condition"], 75.0)
        count += int(np.sum(mask))
        bad += int(np.sum(mask & (mine["condition"] >= limit)))
        shares.append(np.mean(mask))
    if not len(runs):
        return ""
    if not count:
        return "No run of the paper's study has a Z₀ bar longer than three times its obstacle's median."
    return (
        f"Outliers as in the paper: {count} of {plural(len(runs), 'run')} have a Z₀ bar longer than "
        "three times their "
        f"obstacle's median. {bad} of these {count} are in the worst quarter of their obstacle's condition numbers; "
        f"chance would give {number(count / 4.0)}."
    )


def condition_effect(campaign: Campaign) -> str:
    """Does the condition number of the paper's equations distinguish good runs from bad ones?"""
    runs = campaign.cases.select(study="paper", fraction=t3.FRACTION)
    runs = runs.where((runs["model"] == "auto") | (runs["obstacle"] == "cylinder"))
    there = np.isfinite(runs["condition"]) & np.isfinite(runs["z0_rmse_pct"])
    if np.sum(there) < 5:
        return ""
    condition, error = runs["condition"][there], runs["z0_rmse_pct"][there]
    low, high = np.percentile(condition, (10.0, 90.0))
    best, worst = np.percentile(error, (10.0, 90.0))
    rho = st.rank_correlation(condition, error)
    text = (
        f"In the paper's study, 80 % of the runs have a condition number from {number(float(low))} to "
        f"{number(float(high))}, "
        f"and errors of Z₀ from {number(float(best))} to {number(float(worst))} %; the rank correlation is "
        f"{number(rho)}. "
    )
    if abs(rho) < 0.4:
        text += (
            "The condition number of (5) as written does not distinguish good runs from bad ones: it depends on the "
            "units and the length of the baseline, which all runs share, not on the change of the apparent size."
        )
    else:
        text += "So it explains a part of the errors."
    return text


def window_effect(campaign: Campaign) -> str:
    rows = campaign.cases.select(study="conditioning", fraction=t3.FRACTION)
    windows = [w for w in rows.levels("window")] if len(rows) else []
    if len(windows) < 2:
        return ""
    kept = st.nominal_rows(rows, "window")
    errors = {w: st.median_rmse(kept.select(window=w), "z0") for w in windows}
    shown = [w for w in windows if math.isfinite(errors[w])]
    if len(shown) < 2:
        return ""
    values = "; ".join(f"{w:g} images {number(errors[w])}\u00a0%" for w in shown)
    return f"Root mean square error of Z₀ by length of the window, median over all obstacles: {values}."
