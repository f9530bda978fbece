"""The command ``attack_tables``: a file of the goals attack and hazard, as the tables of attack/README.md."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from goe_tools.logs.marked_block import MarkedBlock
from goe_tools.places import ROOT
from goe_tools.report import attack_lines
from goe_tools.report.attacks import Attack, attacks, warnings
from goe_tools.report.goals_file import QUANTITIES, Goals, read_goals

from . import harder

PAGE = ROOT / "tools" / "bench" / "attack" / "README.md"
TABLES = MarkedBlock("attack")
VERDICT = {True: "met", False: "missed", None: ""}
HEADS = {
    "moving obstacles": ("motion", "moves within 4 s/8 s/ever", "velocity in 2 sigma"),
    "conventions": ("error", "detected within 3 s"),
    harder.SECTION: (
        "attack",
        "in 2 sigma",
        "5 sigma off",
        "suspect",
        "median error of Z0, sigmas",
        "moves within 4 s/8 s/ever",
        "velocity/place now/latency in 2 sigma",
        "estimates",
    ),
}
ANSWERS = ("attack", "in 2 sigma", "5 sigma off", "suspect", "flagged late or inconsistent", "estimates")
WARNINGS = (
    "features, errors", "true share by predicted", "off by", "TCPA/DCPA/clearance in 2 sigma", "unwarned", "false",
)  # fmt: skip


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("goals", type=Path, metavar="FILE", help="output of goals --only attack,hazard --json FILE")
    parser.add_argument("--write", action="store_true", help="replace the tables in attack/README.md")


def _percents(attack: Attack, line: str, names: tuple[str, ...]) -> str:
    values = [attack.figure(line, name) for name in names]
    if not any(math.isfinite(value) for value in values):
        return ""
    return "/".join(f"{value:.0f}" if math.isfinite(value) else "-" for value in values)


def _line(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _table(heads: tuple[str, ...], lines: list[list[str]]) -> list[str]:
    """Without columns that are empty in all lines."""
    kept = [i for i in range(len(heads)) if i == 0 or any(line[i] for line in lines)]
    text = [_line([*(heads[i] for i in kept), "goal"]), "|" + "---|" * (len(kept) + 1)]
    return text + [_line([*(line[i] for i in kept), line[-1]]) for line in lines] + [""]


def _harder(attack: Attack) -> list[str]:
    lines = ((attack_lines.VELOCITY, attack_lines.IMAGES), (attack_lines.FOLLOWED, attack_lines.IMAGES),
             (attack_lines.LATENCY, attack_lines.IMAGES))  # fmt: skip
    others = [attack.figure(*line) for line in lines]
    typical = attack.figure(attack_lines.TYPICAL, "Z0")
    return [
        attack.title, _percents(attack, attack_lines.COVER, QUANTITIES),
        _percents(attack, attack_lines.WRONG, (attack_lines.ANY, attack_lines.POSITION)),
        _percents(attack, attack_lines.SUSPECT, (attack_lines.TRACKS, attack_lines.IMAGES)),
        f"{typical:.2f}" if math.isfinite(typical) else "",
        _percents(attack, attack_lines.REASON, (attack_lines.IN_4_S, attack_lines.IN_8_S, attack_lines.EVER)),
        "/".join(f"{value:.0f}" if math.isfinite(value) else "-" for value in others),
        _percents(attack, attack_lines.ANSWERS, (attack_lines.TRACKS,)),
    ]  # fmt: skip


def _cells(attack: Attack) -> list[str]:
    verdict = VERDICT[attack.met]
    if attack.section == "moving obstacles":
        moves = _percents(attack, attack_lines.REASON, (attack_lines.IN_4_S, attack_lines.IN_8_S, attack_lines.EVER))
        return [attack.title, moves, _percents(attack, attack_lines.VELOCITY, (attack_lines.IMAGES,)), verdict]
    if attack.section == "conventions":
        return [attack.title, _percents(attack, attack_lines.ODD, (attack_lines.FLAGGED,)), verdict]
    if attack.section == harder.SECTION:
        return [*_harder(attack), verdict]
    flagged = [_percents(attack, line, (attack_lines.FLAGGED,)) for line in (attack_lines.LATENESS, attack_lines.ODD)]
    return [
        attack.title, _percents(attack, attack_lines.COVER, QUANTITIES),
        _percents(attack, attack_lines.WRONG, (attack_lines.ANY, attack_lines.POSITION)),
        _percents(attack, attack_lines.SUSPECT, (attack_lines.TRACKS, attack_lines.IMAGES)),
        next(filter(None, flagged), ""),
        _percents(attack, attack_lines.ANSWERS, (attack_lines.TRACKS,)), verdict,
    ]  # fmt: skip


def _warning(row: Attack) -> list[str]:
    shares = row.lines[attack_lines.TRUE_SHARE].values.values() if attack_lines.TRUE_SHARE in row.lines else ()
    off = row.lines[attack_lines.OFF].values.values() if attack_lines.OFF in row.lines else ()
    return [
        row.title, "/".join(f"{share:.2f}" for share in shares), f"{max(off):.2f}" if off else "",
        _percents(row, attack_lines.COVERED, ("time", "miss", "clearance")),
        f"{row.figure(attack_lines.UNWARNED, 'violators'):.1f}", f"{row.figure(attack_lines.FALSE, 'passes'):.0f}",
        VERDICT[row.met],
    ]  # fmt: skip


def tables(goals: Goals) -> str:
    text: list[str] = []
    found = attacks(goals)
    for section in dict.fromkeys(attack.section for attack in found):
        lines = [_cells(attack) for attack in found if attack.section == section]
        if not any(any(line[1:-1]) for line in lines):
            continue
        text += [f"### {section[0].upper()}{section[1:]}", "", *_table(HEADS.get(section, ANSWERS), lines)]
    if warnings(goals):
        text += ["### Warnings", "", *_table(WARNINGS, [_warning(row) for row in warnings(goals)])]
    asked = [row for row in goals.rows if row.met is not None]
    return "\n".join([*text, f"{sum(bool(row.met) for row in asked)} of {len(asked)} goals are met."])


def run(arguments: argparse.Namespace) -> int:
    text = tables(read_goals(arguments.goals))
    if not arguments.write:
        print(text)
        return 0
    TABLES.write(PAGE, text)
    return 0
