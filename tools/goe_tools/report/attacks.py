"""Hostile flights: where the sigma holds, and where not. From the goals ``attack`` and ``hazard``."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

from . import attack_lines
from .goals_file import QUANTITIES, GoalRow, Goals
from .prose.words import plural

ATTACK, HAZARD = "attack", "hazard"
OTHER_LINES = (
    attack_lines.REASON,
    attack_lines.LATENESS,
    attack_lines.ODD,
    attack_lines.VELOCITY,
    attack_lines.FOLLOWED,
    attack_lines.LATENCY,
    attack_lines.TIME,
    attack_lines.ANSWERS,
)


@dataclass
class Attack:
    """A row of either group: its lines by name."""

    section: str
    title: str
    lines: dict[str, GoalRow] = field(default_factory=dict)
    met: bool | None = None  # None: the row has no goal
    missed: frozenset[tuple[str, str]] = frozenset()  # line and name of each figure that misses its goal

    def figure(self, line: str, name: str) -> float:
        return self.lines[line].values.get(name, math.nan) if line in self.lines else math.nan

    def misses(self, line: str, name: str) -> bool:
        return (line, name) in self.missed


def is_hostile(row: GoalRow) -> bool:
    return row.group.split(":")[0] in (ATTACK, HAZARD)


def without(goals: Goals) -> Goals:
    """The lines of all other groups."""
    return Goals(tuple(row for row in goals.rows if not is_hostile(row)), goals.quick, goals.date)


def _taken(lines: Iterable[GoalRow], sections: bool) -> list[Attack]:
    found: dict[tuple[str, str], Attack] = {}
    for row in lines:
        title, _, line = row.name.partition(": ")
        section = row.group.partition(": ")[2] if sections else ""
        attack = found.setdefault((section, title), Attack(section, title))
        attack.lines.setdefault(line, row)
        if row.met is not None:
            attack.met = bool(row.met) and attack.met is not False
        base = line.partition(",")[0]  # "within 2 sigma, W": the same line with another limit for W
        attack.missed |= {(base, name) for name in row.missed}
    return list(found.values())


def attacks(goals: Goals) -> list[Attack]:
    """In the file's order."""
    return _taken((row for row in goals.rows if row.group.split(":")[0] == ATTACK), sections=True)


def warnings(goals: Goals) -> list[Attack]:
    return _taken((row for row in goals.rows if row.group == HAZARD), sections=False)


def _percent(value: float) -> str:
    return "" if not math.isfinite(value) else f"{value:.0f}" if value == 0.0 or value >= 0.95 else f"{value:.1f}"


def _cell(attack: Attack, line: str, names: Iterable[str]) -> dict[str, str]:
    """Figures of a line, separated by slashes; red if one of them misses its goal."""
    names = list(names)
    texts = [_percent(attack.figure(line, name)) for name in names]
    css = "miss" if any(attack.misses(line, name) for name in names) else ""
    return {"text": "/".join(text or "–" for text in texts) if any(texts) else "", "css": css}


def _others(attack: Attack) -> dict[str, str]:
    parts, css = [], ""
    for line in OTHER_LINES:
        row = attack.lines.get(line)
        if row is not None and (line != attack_lines.ANSWERS or row.met is not None):
            values = row.values
            known = [f"{name} {_percent(value)} %" for name, value in values.items() if math.isfinite(value)]
            parts += [f"{attack_lines.TITLES.get(line, line)}: {', '.join(known) or 'never'}"]
            css = "miss" if row.missed else css
    return {"text": "; ".join(parts), "css": css}


def attack_table(goals: Goals) -> list[dict[str, object]]:
    """For the page: coverage of the six quantities, confident errors, suspect, other reports, goal."""
    rows, section = [], ""
    for attack in attacks(goals):
        cells = [_cell(attack, attack_lines.COVER, [name]) for name in QUANTITIES]
        wrong = _cell(attack, attack_lines.WRONG, (attack_lines.ANY, attack_lines.POSITION))
        suspect = _cell(attack, attack_lines.SUSPECT, (attack_lines.TRACKS, attack_lines.IMAGES))
        rows.append({
            "section": attack.section if attack.section != section else "", "title": attack.title,
            "cells": [*cells, wrong, suspect], "other": _others(attack), "met": attack.met,
        })  # fmt: skip
        section = attack.section
    return rows


def warning_table(goals: Goals) -> list[dict[str, object]]:
    lines = []
    for row in warnings(goals):
        shares = row.lines.get(attack_lines.TRUE_SHARE)
        levels = [f"{level}: {share:.2f}" for level, share in shares.values.items()] if shares else []
        off = any(line == attack_lines.OFF for line, _ in row.missed)
        lines.append({
            "title": row.title, "met": row.met,
            "cells": [
                {"text": "; ".join(levels), "css": "miss" if off else ""},
                _cell(row, attack_lines.COVERED, ("time", "miss", "clearance")),
                _cell(row, attack_lines.UNWARNED, ("violators",)),
                _cell(row, attack_lines.FALSE, ("passes",)),
            ],
        })  # fmt: skip
    return lines


def sentences(goals: Goals) -> list[str]:
    """The result in words, from the numbers."""
    said = []
    for found, one in ((attacks(goals), "attack"), (warnings(goals), "row of warnings")):
        asked = [row for row in found if row.met is not None]
        if asked:
            many = "rows of warnings" if one.startswith("row") else None
            met = sum(bool(row.met) for row in asked)
            verb = "meets" if met == 1 else "meet"
            said.append(f"Of {plural(len(asked), one, many)} with a goal, {met} {verb} it.")
    wrong = [
        (row.figure(attack_lines.WRONG, attack_lines.POSITION), row.title)
        for row in attacks(goals)
        if attack_lines.WRONG in row.lines
    ]
    worst = sorted((figure for figure in wrong if figure[0] > 0.0), reverse=True)[:3]
    if worst:
        names = "; ".join(f"{title} ({_percent(share)} %)" for share, title in worst)
        said.append(f"Positions wrong by more than 5σ and not suspect, most tracks: {names}.")
    unwarned = [(row.figure(attack_lines.UNWARNED, "violators"), row.title) for row in warnings(goals)]
    lacking = [f"{title} ({_percent(share)} %)" for share, title in unwarned if share > 0.0]
    if unwarned:
        said.append(
            f"Violations without a warning of goe_decide() {attack_lines.AHEAD_S:g} s ahead: "
            + ("; ".join(lacking) if lacking else "none")
            + "."
        )
    return said
