"""The table of goals for the README: results of a recorded search, and causes of missed goals."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path
from typing import Any

from goe_tools.logs.marked_block import MarkedBlock
from goe_tools.places import ROOT

from .show import CONFIDENT_GOAL, mixes_of, percent
from .tally import Key

RECORD = ROOT / "tests" / "data" / "lies.json"
REASONS = Path(__file__).with_name("reasons.csv")
BLOCK = MarkedBlock("lies")
CLASS_SHARE = 0.0003  # of a mix's flights: larger classes of confident errors need a reason
CONFIDENT, VANISHED = "confident", "vanished"
ALL = "all"  # mixes, of a reason
Class = tuple[str, str, str]  # kind, mix, case: model and solid, or the cause of a vanished warning


def reasons() -> dict[Class, str]:
    with REASONS.open(encoding="utf-8", newline="") as file:
        return {(row["kind"], row["mix"], row["case"]): row["reason"] for row in csv.DictReader(file)}


def reason_of(known: dict[Class, str], found: Class) -> str | None:
    kind, mix, case = found
    return known.get((kind, mix, case)) or known.get((kind, ALL, case))


def classes(counts: Counter[Key]) -> dict[Class, int]:
    """Flights by kind, mix and case: each vanished warning, and confident errors above the share."""
    found: Counter[Class] = Counter()
    for word, *key in counts:
        if word == "class" and key[0] in (CONFIDENT, VANISHED):
            kind, mix, quantity, model, solid, _ = key
            case = quantity if kind == VANISHED else f"{model} of a {solid}"
            found[kind, mix, case] += counts[(word, *key)]
    least = {mix: CLASS_SHARE * counts["flights", mix] for mix in mixes_of(counts)}
    return {key: flights for key, flights in found.items() if key[0] == VANISHED or flights >= least[key[1]]}


def unexplained(counts: Counter[Key]) -> list[Class]:
    known = reasons()
    return sorted(found for found in classes(counts) if reason_of(known, found) is None)


def idle(counts: Counter[Key]) -> list[Class]:
    """Reasons for classes that are no longer found."""
    found = classes(counts)
    return sorted(
        known for known in reasons() if known not in found and not any((k, ALL, w) == known for k, _, w in found)
    )


def block(about: dict[str, Any], counts: Counter[Key]) -> str:
    mixes, known = mixes_of(counts), reasons()
    total = sum(counts["flights", mix] for mix in mixes)
    lines = [
        f"{total:,} flights, seed {about['seed']}; goals: confident errors in at most {100 * CONFIDENT_GOAL:g} % "
        "of the flights of a mix, no vanished warning.",
        "",
        "| mix | flights | confident error, % | goal | vanished warning, flights | goal |",
        "| --- | ---: | ---: | --- | ---: | --- |",
    ]
    for mix in mixes:
        flights = counts["flights", mix]
        confident, gone = counts[CONFIDENT, mix, "any"], counts[VANISHED, mix, "any"]
        met = ["reached" if reached else "missed" for reached in (confident <= CONFIDENT_GOAL * flights, gone == 0)]
        lines.append(f"| `{mix}` | {flights:,} | {percent(confident, flights)} | {met[0]} | {gone:,} | {met[1]} |")
    lines += ["", "| class | mix | model or cause | flights, % | reason |", "| --- | --- | --- | ---: | --- |"]
    ordered = sorted(classes(counts).items(), key=lambda item: (item[0][0], mixes.index(item[0][1]), -item[1]))
    for found, flights in ordered:
        kind, mix, case = found
        share = percent(flights, counts["flights", mix])
        lines.append(f"| {kind} | `{mix}` | {case} | {share} | {reason_of(known, found) or 'not explained'} |")
    return "\n".join(lines)
