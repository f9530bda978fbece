"""The page with all goals: accuracy, honest sigmas, other methods, hostile flights."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from . import attacks
from . import refined as rf
from .data import Campaign
from .goals_file import QUANTITIES, GoalRow, Goals
from .prose import refined as rp
from .style import GOAL_SYMBOLS, number


def _goal_rows(rows: Iterable[GoalRow]) -> list[dict[str, Any]]:
    found, group = [], ""
    for row in rows:
        names = QUANTITIES if row.by_quantity else tuple(row.values)
        cells = []
        for name in names:
            value = row.values.get(name, math.nan)
            text = rp.goal_value(value) if math.isfinite(value) or name in row.asked else ""
            css = "miss" if name in row.missed else "unasked" if row.asked and name not in row.asked else ""
            cells.append({"name": rp.value_label(name), "text": text, "css": css})
        found.append({
            "group": rf.group_title(row.group) if row.group != group else "", "name": row.name,
            "unit": rp.unit_text(row), "wanted": rp.wanted(row), "by_quantity": row.by_quantity, "cells": cells,
            "met": row.met,
        })  # fmt: skip
        group = row.group
    return found


def _rivals(goals: Goals) -> list[dict[str, Any]]:
    tables: list[dict[str, Any]] = []
    for noise, rows in rf.rivals(goals).items():
        ours = next((row.errors for row in rows if row.name == "filter"), dict.fromkeys(QUANTITIES, math.nan))
        lines = []
        for row in rows:
            cells = []
            for name in QUANTITIES:
                share = row.answers.get(name, math.nan)
                cells.append({
                    "text": number(row.errors[name]), "ahead": row.errors[name] < ours[name],
                    "share": number(share) if 0.0 < share < 99.95 else "",
                })  # fmt: skip
            lines.append({
                "name": rp.METHOD_NAMES.get(row.name, row.name), "own": row.name == "filter", "cells": cells,
                "strength": "" if tables else rp.STRENGTHS.get(row.name, ""),
            })  # fmt: skip
        tables.append({"noise": rp.NOISE_NAMES.get(noise, noise), "flights": rows[0].flights, "rows": lines,
                       "strengths": not tables})  # fmt: skip
    return tables


def _goals(goals: Goals) -> dict[str, Any] | None:
    """Without hostile flights, which have a section of their own; None if there are no others."""
    goals = attacks.without(goals)
    if not goals.rows:
        return None
    parts = (
        ("bound", rp.bounds(goals)), ("", [*rp.coverage(goals), *rp.nees(goals)]), ("flags", rp.flags(goals)),
    )  # fmt: skip
    return {
        "verdict": rp.verdict(goals),
        "missed": rp.missed(goals),
        "asked": _goal_rows(goals.asked),
        "others": _goal_rows(row for row in goals.rows if row.met is None),
        "parts": [{"figure": figure, "sentences": sentences} for figure, sentences in parts],
        "rivals": _rivals(goals),
        "rival_heads": [(GOAL_SYMBOLS[name], "°" if name == "orientation" else "m") for name in QUANTITIES],
        "rival_sentences": rp.rivals(goals),
    }


def _attacks(goals: Goals) -> dict[str, Any] | None:
    """The section on hostile flights; None if the goals have none."""
    table, warnings = attacks.attack_table(goals), attacks.warning_table(goals)
    if not table and not warnings:
        return None
    return {
        "rows": table, "warnings": warnings, "sentences": attacks.sentences(goals),
        "heads": [*(GOAL_SYMBOLS[name] for name in QUANTITIES), "5σ off", "suspect"],
        "warning_heads": ["predicted: true", "in 2σ: time/miss/clearance", "unwarned", "false"],
    }  # fmt: skip


def variables(campaign: Campaign) -> dict[str, Any]:
    """Of the template."""
    assert campaign.goals is not None
    return {
        "goals": _goals(campaign.goals), "attacks": _attacks(campaign.goals), "date": campaign.goals.date,
        "goal_symbols": [GOAL_SYMBOLS[name] for name in QUANTITIES],
    }  # fmt: skip
