"""The table of finds and goals, and the file it is printed from."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import goe
from rich.console import Console
from rich.table import Table

from .finds import CAUSES, COLUMNS, CONFIDENT_SIGMA, JUDGED, PROMISED, SAFE_MOST
from .genes import MIXES
from .tally import COVER_SIGMA, Key, Tally

SEPARATOR = "|"
CONFIDENT_GOAL = 0.003
CLASSES_SHOWN = 40
LIFT_LEAST, LIFT_SHOWN = 1.5, 4
LIFT_SHARE = 0.25  # least share of a class's finds with the circumstance
FORMAT = 1
JSON_BYTES_MAX = 1 << 26


def to_json(tally: Tally, about: dict[str, Any]) -> dict[str, Any]:
    counts = {SEPARATOR.join(key): value for key, value in sorted(tally.counts.items()) if value}
    return {"format": FORMAT, "library": goe.FINGERPRINT, **about, "counts": counts}


def from_json(path: Path) -> tuple[dict[str, Any], Counter[Key]]:
    """The file's metadata and its counts; ValueError names a file of another format."""
    try:
        with open(path, encoding="utf-8") as file:
            found = json.loads(file.read(JSON_BYTES_MAX))
        if found["format"] != FORMAT:
            raise ValueError(f"format {found['format']}")
        counts = Counter({tuple(key.split(SEPARATOR)): int(value) for key, value in found.pop("counts").items()})
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"{path}: not written by lies --json: {error}") from None
    return found, counts


def percent(part: int, whole: int) -> str:
    return "-" if whole == 0 else f"{100.0 * part / whole:.3g}"


def mixes_of(counts: Counter[Key]) -> list[str]:
    return [mix for mix in MIXES if counts["flights", mix]]


def misses(counts: Counter[Key]) -> Iterator[str]:
    """The missed goals, in words."""
    for mix in mixes_of(counts):
        flights, confident = counts["flights", mix], counts["confident", mix, "any"]
        if confident > CONFIDENT_GOAL * flights:
            yield f"{mix}: confident errors in {percent(confident, flights)} % of the flights"
        gone = counts["vanished", mix, "any"]
        if gone:
            yield f"{mix}: warnings vanished in {gone} flights ({percent(gone, flights)} %)"


def _table(title: str, headings: list[str]) -> Table:
    table = Table(title=title, title_justify="left", box=None, pad_edge=False)
    for number, heading in enumerate(headings):
        table.add_column(heading, justify="left" if number == 0 else "right")
    return table


def _overview(counts: Counter[Key]) -> Table:
    mixes = mixes_of(counts)
    table = _table("% of the flights", ["", *mixes, "goal"])

    def row(label: str, *key: str, goal: str = "") -> None:
        parts = [counts[(key[0], mix, *key[1:])] for mix in mixes]
        table.add_row(label, *(percent(n, counts["flights", m]) for n, m in zip(parts, mixes)), goal)

    table.add_row("flights", *(str(counts["flights", mix]) for mix in mixes))
    row("answered", "answered")
    row("suspect at any time", "suspect")
    row(f"confident error, > {CONFIDENT_SIGMA:g} sigma", "confident", "any", goal=f"<= {100.0 * CONFIDENT_GOAL:g}")
    for column in COLUMNS:
        if any(counts["confident", mix, column] for mix in mixes):
            row(f"  {column}" + ("" if column in JUDGED else " (not counted)"), "confident", column)
    row(f"false safety, violation < {SAFE_MOST:g}", "false safety")
    row("  suspect or old", "doubted")
    row("vanished warning", "vanished", "any", goal="0")
    for number, cause in enumerate(CAUSES):
        if any(counts["vanished", mix, cause] for mix in mixes):
            row(f"  {cause}" + (" (not counted)" if number < PROMISED else ""), "vanished", cause)
    pairs = [(counts["safety found", m] / 1e6, counts["safety allowed", m] / 1e6) for m in mixes]
    table.add_row("false safety, images: found/implied", *(f"{found:.0f}/{own:.0f}" for found, own in pairs))
    return table


def _coverage(counts: Counter[Key]) -> Table:
    mixes = mixes_of(counts)
    table = _table(f"% of the answers within {COVER_SIGMA:g} sigma (95.4 is right; 100 is wrong, too)", ["", *mixes])
    for column in COLUMNS:
        parts = [percent(counts["within", mix, column], counts["judged", mix, column]) for mix in mixes]
        if set(parts) != {"-"}:
            table.add_row(column, *parts)
    return table


def lifts(counts: Counter[Key], key: Key) -> list[str]:
    """Circumstances that are more frequent in a class of finds than in the flights of its mix."""
    mix, total = key[1], counts[("class", *key)]
    found = []
    for word, name, *rest in [k for k in counts if k[0] == "flag" and k[1] == mix]:
        flag = rest[0]
        usual = counts[word, name, flag] / counts["flights", mix]
        share = counts[("with", *key, flag)] / total
        if share >= LIFT_SHARE and usual > 0.0 and share > LIFT_LEAST * usual:
            found.append((share / usual, f"{flag} {100 * share:.0f}/{100 * usual:.0f}"))
    return [text for _, text in sorted(found, reverse=True)[:LIFT_SHOWN]]


def _classes(counts: Counter[Key]) -> Table:
    table = _table(
        "classes: flights; circumstances, % of the class / of the mix",
        ["kind", "mix", "what", "model", "solid", "status", "flights", "more often with"],
    )
    keys = sorted((key[1:] for key in counts if key[0] == "class"), key=lambda key: (-counts[("class", *key)], key))
    for key in keys[:CLASSES_SHOWN]:
        status = str(goe.Status(int(key[5])))
        table.add_row(*key[:5], status, str(counts[("class", *key)]), ", ".join(lifts(counts, key)))
    if len(keys) > CLASSES_SHOWN:
        rest = sum(counts[("class", *key)] for key in keys[CLASSES_SHOWN:])
        table.add_row(f"{len(keys) - CLASSES_SHOWN} more", "", "", "", "", "", str(rest), "")
    return table


def show(counts: Counter[Key], about: dict[str, Any]) -> None:
    console = Console(highlight=False, width=180)
    console.print(
        f"library {about['library'][:12]}, seed {about.get('seed')}, {sum(counts['flights', m] for m in MIXES)} flights"
    )
    if not about.get("two_cameras", True):
        console.print("without two cameras: the library was compiled for one")
    for table in (_overview(counts), _coverage(counts), _classes(counts)):
        console.print(table)
        console.print()
    missed = list(misses(counts))
    console.print("goals: " + ("all reached" if not missed else "missed"))
    for line in missed:
        console.print(f"  {line}")
