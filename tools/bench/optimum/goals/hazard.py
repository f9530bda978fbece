"""Warnings from the library's decision rule, over thousands of straight passes, near misses and collision courses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from goe_tools.library import METHODS, run
from goe_tools.report import attack_lines
from goe_tools.spread import each

from ...attack import approach, rows, scenario
from ...attack.approach import HazardRow, Run, Warnings
from .attack import PLANS, images_of, known
from .goal import Goal
from .work import Amount

COVERED = (90.0, 100.0)
LEVELS = tuple(f"{low:g} to {high:g}" for low, high in zip(approach.BINS, approach.BINS[1:]))  # bins that are judged


def perform(row: HazardRow, number: int) -> Run:
    inputs = scenario.fly(row.scenario, number)
    track = run(images_of(inputs, PLANS), {**inputs.settings, **known(row.if_known)})
    there = track.hazard["status"] == 0
    plain = {name: np.where(there[:, 0], values[:, 0], np.nan) for name, values in track.hazard.items()}
    height = plain["has_clearance"] == 1.0
    warnings = Warnings(
        inputs.time_s, track.method == METHODS["filter"], plain["tcpa_s"], plain["tcpa_sd_s"], plain["dcpa_m"],
        plain["dcpa_sd_m"], np.where(height, plain["clearance_m"], np.nan), plain["clearance_sd_m"],
        plain["conflict_probability"],
        track.hazard["act"][:, 1],
    )  # fmt: skip
    return Run(warnings, approach.closest(inputs.truth))


def goals_of(group: str, row: HazardRow, runs: Sequence[Run]) -> list[Goal]:
    found = approach.probabilities(runs)
    off = {level: abs(found[level][0] - found[level][1]) if level in found else math.nan for level in LEVELS}
    judged = tuple(level for level in LEVELS if level in found and found[level][2] >= approach.BIN_LEAST)
    coverage = approach.coverage(runs)
    unwarned, false = {"violators": approach.unwarned(runs)}, {"passes": approach.false_warnings(runs)}
    judged = (judged or LEVELS) if row.sigmas else ()
    return [
        Goal(group, f"{row.name}: {attack_lines.TRUE_SHARE}", "1", {level: t[1] for level, t in found.items()}),
        Goal(group, f"{row.name}: {attack_lines.OFF}", "1", off, (0.0, row.error_max), judged),
        Goal(group, f"{row.name}: {attack_lines.COVERED}", "%", coverage, COVERED,
             tuple(coverage) if row.sigmas else ()),
        Goal(group, f"{row.name}: {attack_lines.UNWARNED}", "%", unwarned, (0.0, row.unwarned_most),
             ("violators",)),
        Goal(group, f"{row.name}: {attack_lines.FALSE}", "%", false, (0.0, row.false_most), ("passes",)),
        Goal(group, f"{row.name}: {attack_lines.FLOWN}", "runs", approach.counts(runs)),
    ]  # fmt: skip


def hazard_group(group: str, amount: Amount) -> list[Goal]:
    goals = []
    for row in approach.ROWS:
        numbers = rows.numbers(amount.half, max(1, round(amount.hazard * row.runs_share)))
        goals += goals_of(group, row, each(partial(perform, row), numbers, amount.workers, row.name))
    return goals
