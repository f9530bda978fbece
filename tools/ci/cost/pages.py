"""The tables for readers: all of them in tests/targets/LEDGER.md, a few rows of the first in README.md."""

from __future__ import annotations

from pathlib import Path

from goe_tools.logs.marked_block import MarkedBlock
from goe_tools.places import interface

from . import book, guarantees, stated
from .book import Figures, Ledger, below, number
from .instructions import PUBLIC, UPDATES, WITH_LENS
from .measuring import FULL_PRESET
from .modules import WINDOWS
from .parts import PARTS_PRESET
from .targets import compiler_title, processor_title

TABLES = MarkedBlock("ledger")
README_PRESETS = ("m4f-gcc-os", "m4f-gcc-o2", "m0plus-gcc-os")
TARGET_HEAD = [
    "| target | compiler | code + constants, bytes | stack of `goe_update`, bytes (painted) | "
    "instructions per `goe_update`: min / mean / max | instructions with lens distortion: max | "
    "instructions, window method: min / mean / max |",
    "|---|---|---|---|---|---|---|",
]


def title(preset: str) -> str:
    return f"{processor_title(preset)} | {compiler_title(preset)}"


def spread(figures: Figures, *words: str) -> str:
    low, mean, high = (number(figures, *words, name) for name in ("min", "mean", "max"))
    return f"{low} / {mean:.0f} / {high}"


def target_row(preset: str, figures: Figures) -> str:
    size = number(figures, book.CODE, book.TOTAL) + number(figures, book.CONSTANTS, book.TOTAL)
    stack = f"{number(figures, book.STACK, 'goe_update')} ({number(figures, book.PAINTED, 'goe_update')})"
    lens = number(figures, book.INSTRUCTIONS, f"{UPDATES['filter']} {WITH_LENS}", "max")
    return (
        f"| {title(preset)} | {size} | {stack} | {spread(figures, book.INSTRUCTIONS, UPDATES['filter'])} | {lens} | "
        f"{spread(figures, book.INSTRUCTIONS, UPDATES['window'])} |"
    )


def target_table(ledger: Ledger) -> list[str]:
    return TARGET_HEAD + [target_row(preset, figures) for preset, figures in ledger.items()]


def module_table(figures: Figures) -> list[str]:
    lines = ["| module | code, bytes | constants, bytes | instructions per `goe_update`: min / mean / max |"]
    lines += ["|---|---|---|---|"]
    sized = [module for module in below(figures, book.CODE) if module != book.TOTAL]
    counted = below(figures, book.OF_UPDATE)
    for module in sized:
        share = spread(figures, book.OF_UPDATE, module) if module in counted else "-"
        sizes = [number(figures, kind, module) for kind in (book.CODE, book.CONSTANTS)]
        lines.append(f"| {module} | {sizes[0]} | {sizes[1]} | {share} |")
    others = [module for module in counted if module not in sized]
    return lines + [f"| ({module}) | | | {spread(figures, book.OF_UPDATE, module)} |" for module in others]


def function_table(figures: Figures) -> list[str]:
    lines = [
        "| function | stack, bytes (painted) | instructions: min / mean / max | proved: at most |",
        "|---|---|---|---|",
    ]
    for name in (*PUBLIC, *below(figures, book.PROVED)):
        stack = f"{number(figures, book.STACK, name)} ({number(figures, book.PAINTED, name)})" if name in PUBLIC else ""
        most = number(figures, book.PROVED, name)
        row = f"| `{name}` | {stack} | {spread(figures, book.INSTRUCTIONS, name)} | {most} |"
        lines += [row] if row not in lines else []
    return lines


def state_table(figures: Figures) -> list[str]:
    sizes = [str(number(figures, book.STATE, f"window {window}")) for window in WINDOWS]
    return [
        "| window | " + " | ".join(map(str, WINDOWS)) + " |",
        "|---" * (len(WINDOWS) + 1) + "|",
        "| state, bytes | " + " | ".join(sizes) + " |",
    ]


def part_table(figures: Figures) -> list[str]:
    """Empty if the library has no parts."""
    parts = below(figures, book.PART_BYTES)
    if not parts:
        return []
    rows = [f"| {p} | {number(figures, book.PART_BYTES, p)} | {number(figures, book.PART_STATE, p)} |" for p in parts]
    return ["| parts | code + constants, bytes | state, bytes |", "|---|---|---|", *rows]


def heading(preset: str, figures: Figures) -> str:
    return f"{processor_title(preset)}, {figures[book.COMPILER]}, `{figures[book.FLAGS]}`:"


def ledger_tables(ledger: Ledger) -> str:
    """All tables, for LEDGER.md."""
    blocks = [target_table(ledger), guarantees.rows(ledger)]
    parts = ledger.get(PARTS_PRESET)
    if parts and part_table(parts):
        blocks += [[heading(PARTS_PRESET, parts)], part_table(parts)]
    full = ledger.get(FULL_PRESET)
    if full:
        blocks += [[heading(FULL_PRESET, full)], module_table(full), function_table(full), state_table(full)]
    return "\n".join("\n".join([*block, ""]) for block in blocks)


def readme_tables(ledger: Ledger) -> str:
    """A few targets."""
    few = {preset: ledger[preset] for preset in README_PRESETS if preset in ledger}
    return "\n".join([*target_table(few), ""])


PAGES = {Path("README.md"): readme_tables, Path("tests/targets/LEDGER.md"): ledger_tables}


def wrong_pages(root: Path, ledger: Ledger) -> list[str]:
    """Pages with other tables than the ledger's, guarantees missing in README.md, understated costs in the headers."""
    wrong = [
        f"{page}: its tables differ from the ledger: run python -m ci ledger --write"
        for page, tables in PAGES.items()
        if TABLES.of(root / page) != tables(ledger).strip()
    ]
    wrong += guarantees.not_stated(TABLES.around(root / "README.md"))
    if stated.TARGET in ledger:
        wrong += stated.understated(interface(root / "lib"), ledger[stated.TARGET])
    return wrong


def write_pages(root: Path, ledger: Ledger) -> None:
    for page, tables in PAGES.items():
        TABLES.write(root / page, tables(ledger))
