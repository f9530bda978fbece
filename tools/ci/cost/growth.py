"""Figures that grew compared with the ledger."""

from __future__ import annotations

from . import book
from .book import Figures, Ledger

GROWTH_ALLOWED = 0.02  # of a figure, relative to the committed ledger
NO_ROW_IF_NONE = book.DATA  # of a module


def compared(figures: Figures) -> dict[str, float]:
    """Figures that must not grow. Parts of the worst call may shift between functions; words are not compared."""
    return {
        name: value for name, value in figures.items() if not isinstance(value, str) and not name.startswith(book.WORST)
    }


def grown(before: Figures, now: Figures) -> list[str]:
    """Figures that grew by more than the limit, or that only one side has, in words."""
    old, new = compared(before), compared(now)
    result = []
    for name, value in new.items():
        was = old.get(name)
        if was is None and not (name.startswith(NO_ROW_IF_NONE) and value == 0):
            result.append(f"{name}: {value}, not in the ledger")
        elif was is not None and value > was * (1.0 + GROWTH_ALLOWED):
            result.append(f"{name}: {was} -> {value}")
    gone = [name for name in old if name not in new and not name.startswith(NO_ROW_IF_NONE)]
    return result + [f"{name}: {old[name]} in the ledger, no longer measured" for name in gone]


def compare(before: Ledger, now: Ledger) -> list[str]:
    """Figures that grew, by target. Reports targets built by another compiler, which cannot be compared."""
    failures = []
    for preset, figures in now.items():
        was = before.get(preset)
        if was is None:
            failures.append(f"{preset}: not in the ledger")
        elif was[book.COMPILER] != figures[book.COMPILER]:
            print(f"skipped: {preset}: the ledger has {was[book.COMPILER]}, this is {figures[book.COMPILER]}")
        else:
            failures += [f"{preset}: {text}" for text in grown(was, figures)]
    return failures
