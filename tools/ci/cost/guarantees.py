"""README.md's guarantees of cost, and the targets on which they must be met and are met."""

from __future__ import annotations

from dataclasses import dataclass

from . import book
from .book import Figures, Ledger, key
from .instructions import UPDATES
from .targets import PROCESSORS, compiler_title, presets, processor_title


def targets_of(processor: str) -> tuple[str, ...]:
    return tuple(preset for preset in presets() if preset.rsplit("-", 2)[0] == processor)


@dataclass(frozen=True)
class Guarantee:
    """A figure and its upper limit."""

    words: str  # the limit is {limit}
    stated: str  # the limit as README.md's text gives it
    figure: str
    limit: int
    listed: tuple[str, ...]  # targets in README.md's table
    promised: tuple[str, ...]  # targets that must meet it


EVERYWHERE = tuple(presets())
M4F = targets_of("m4f")
M4F_GCC_O2 = ("m4f-gcc-o2",)
GUARANTEES = (
    Guarantee(
        "an estimator takes at most {limit} bytes at a window of 8",
        "2.1 KiB",
        key(book.STATE, "window 8"),
        2100,
        EVERYWHERE,
        EVERYWHERE,
    ),
    Guarantee(
        "no writable data outside the estimator",
        "no hidden state",
        key(book.DATA, book.TOTAL),
        0,
        EVERYWHERE,
        EVERYWHERE,
    ),
    Guarantee(
        "an update takes at most {limit} instructions, proved",
        "59,150 instructions",
        key(book.PROVED, UPDATES["filter"]),
        59150,
        M4F_GCC_O2,
        M4F_GCC_O2,
    ),
    Guarantee(
        "... with method `window` at most {limit}, proved",
        "5,700",
        key(book.PROVED, UPDATES["window"]),
        5700,
        M4F_GCC_O2,
        M4F_GCC_O2,
    ),
    Guarantee(
        "an update takes at most {limit} bytes of stack",
        "2,048 bytes of stack",
        key(book.STACK, UPDATES["filter"]),
        2048,
        M4F,
        M4F_GCC_O2,
    ),
)
# From the C library; sqrtf is an instruction there.
CALLS_ALLOWED = {"memcpy", "memset"}
CALLS_PROMISED = M4F_GCC_O2


def value_of(figures: Figures, guarantee: Guarantee) -> float:
    value = figures[guarantee.figure]
    assert not isinstance(value, str)
    return value


def broken_promises(ledger: Ledger) -> list[str]:
    """Promises that these targets break."""
    broken = []
    for preset, figures in ledger.items():
        for guarantee in (guarantee for guarantee in GUARANTEES if preset in guarantee.promised):
            value = value_of(figures, guarantee)
            if value > guarantee.limit:
                broken.append(f"{preset}: {guarantee.figure}: {value}, promised {guarantee.limit}")
        strange = set(str(figures.get(book.CALLS, "")).split()) - CALLS_ALLOWED
        if preset in CALLS_PROMISED and strange:
            broken.append(f"{preset}: the library calls {', '.join(sorted(strange))}")
    return broken


def listed(ledger: Ledger, chosen: list[str], guarantee: Guarantee) -> str:
    """Targets by processor, each with its figure."""
    parts = []
    for processor in PROCESSORS:
        of_it = [preset for preset in targets_of(processor) if preset in chosen]
        texts = [f"{compiler_title(preset)} ({value_of(ledger[preset], guarantee):,})" for preset in of_it]
        if texts:
            parts.append(f"{processor_title(of_it[0])} {', '.join(texts)}")
    return "; ".join(parts)


def rows(ledger: Ledger) -> list[str]:
    """README.md's table: each guarantee, and the targets that meet it or not."""
    lines = ["| guarantee | valid for | not valid for |", "|---|---|---|"]
    for guarantee in GUARANTEES:
        chosen = [preset for preset in guarantee.listed if preset in ledger]
        good = [preset for preset in chosen if value_of(ledger[preset], guarantee) <= guarantee.limit]
        bad = [preset for preset in chosen if preset not in good]
        if good == list(EVERYWHERE):
            most = max(value_of(ledger[preset], guarantee) for preset in good)
            where = "every target and compiler" + (f" (at most {most:,})" if guarantee.limit else "")
        else:
            where = listed(ledger, good, guarantee)
        words = guarantee.words.format(limit=f"{guarantee.limit:,}")
        lines.append(f"| {words} | {where} | {listed(ledger, bad, guarantee)} |")
    return lines


def not_stated(readme: str) -> list[str]:
    """Guarantees whose limit is not in README.md's text."""
    return [
        f"README.md does not say “{guarantee.stated}”: {guarantee.words.format(limit=guarantee.limit)}"
        for guarantee in GUARANTEES
        if guarantee.stated not in readme
    ]
