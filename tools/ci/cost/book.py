"""The ledger's file: a row for each figure, a column for each target; a change then affects only a few rows.

The name of a figure consists of words separated by ": ", from the general to the particular.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Union

Value = Union[int, float, str]
Figures = dict[str, Value]  # of one target, by name
Ledger = dict[str, Figures]  # by target

HEAD = "figure"
COMPILER, FLAGS, MACHINE, CALLS = "compiler", "flags", "machine", "calls to other libraries"
CODE, CONSTANTS, DATA = "code bytes", "constants bytes", "data bytes"  # ...: total, ...: <module>
TOTAL = "total"
STATE = "state bytes"  # ...: window <length>
STACK, PAINTED = "stack bytes computed", "stack bytes painted"  # ...: <public function>
INSTRUCTIONS = "instructions"  # ...: <public function>: min, mean, max
PROVED = "instructions proved"  # ...: <public function>: the longest path. For proved targets only
OF_UPDATE = "instructions of goe_update"  # ...: <module>: min, mean, max
WORST = "worst goe_update"  # ...: track; ...: <module>: <function>. For one target; may shift between functions
PART_BYTES, PART_STATE = "code and constants bytes with parts", "state bytes with parts"  # ...: <combination>


def key(*words: object) -> str:
    return ": ".join(map(str, words))


def below(figures: Figures, *words: object) -> list[str]:
    """The words that follow directly, in the order of the ledger: below(figures, CODE) gives total and the modules."""
    start = key(*words, "")
    return list(dict.fromkeys(name[len(start) :].split(": ")[0] for name in figures if name.startswith(start)))


def number(figures: Figures, *words: object) -> float:
    """A figure; 0 if it has no row."""
    value = figures.get(key(*words), 0)
    if isinstance(value, str):
        raise ValueError(f"{key(*words)}: {value} is not a number")
    return value


def text_of(ledger: Ledger) -> str:
    names = list(dict.fromkeys(name for figures in ledger.values() for name in figures))
    # Targets may have figures that others lack; rows of a kind stay together, sorted below their kind.
    kinds = list(dict.fromkeys(name.split(": ")[0] for name in names))
    place = {name: number for number, name in enumerate(names)}
    names.sort(key=lambda name: (kinds.index(name.split(": ")[0]), place[name]))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([HEAD, *ledger])
    for name in names:
        writer.writerow([name, *(figures.get(name, "") for figures in ledger.values())])
    return out.getvalue()


def value_of(text: str) -> Value:
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text


def ledger_of(text: str) -> Ledger:
    rows = list(csv.reader(io.StringIO(text)))
    if not rows or rows[0][:1] != [HEAD]:
        raise ValueError(f"not a ledger: its first cell is not {HEAD}")
    ledger: Ledger = {target: {} for target in rows[0][1:]}
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(rows[0]):
            raise ValueError(f"line {line} of the ledger: {len(row)} cells, not {len(rows[0])}")
        for target, cell in zip(ledger, row[1:]):
            if cell:
                ledger[target][row[0]] = value_of(cell)
    return ledger


def read(path: Path) -> Ledger:
    return ledger_of(path.read_text(encoding="utf-8"))


def write(path: Path, ledger: Ledger) -> None:
    path.write_text(text_of(ledger), encoding="utf-8")
