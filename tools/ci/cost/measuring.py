"""All figures of a target."""

from __future__ import annotations

import tempfile
from pathlib import Path

from bench.running import LedgerError

from . import book
from .book import Figures, key, number
from .building import Build, build, shown_flags
from .instructions import PUBLIC, UPDATES, Spread, count, counted_calls
from .longest.proving import PROVED_PRESETS, code_of, proofs, unused
from .longest.trip_counts import exceeded
from .longest.trip_counts import measured as turns
from .modules import KINDS, external_calls, module_bytes, state_bytes
from .parts import PARTS_PRESET, measured_parts
from .stack import computed_stack, painted_stack

FULL_PRESET = "m4f-gcc-o2"  # with the worst update by function


def size_figures(built: Build, scratch: Path) -> Figures:
    modules = module_bytes(built)
    figures: Figures = {}
    for kind, name in zip(KINDS, (book.CODE, book.CONSTANTS, book.DATA)):
        figures[key(name, book.TOTAL)] = sum(sizes[kind] for sizes in modules.values())
        named = modules if kind != "data" else {module for module, sizes in modules.items() if sizes["data"]}
        figures |= {key(name, module): modules[module][kind] for module in named}
    figures |= {key(book.STATE, f"window {n}"): size for n, size in state_bytes(built, scratch).items()}
    return figures


def stack_figures(built: Build) -> Figures:
    painted, computed = painted_stack(built), computed_stack(built)
    for name in PUBLIC:
        if painted[name] > computed[name]:
            raise LedgerError(
                f"{built.preset}: {name}: {painted[name]} bytes of stack painted, {computed[name]} computed"
            )
    figures: Figures = {key(book.STACK, name): computed[name] for name in PUBLIC}
    return figures | {key(book.PAINTED, name): painted[name] for name in (*PUBLIC, UPDATES["window"])}


def spread_figures(spread: Spread, *words: str) -> Figures:
    return {key(*words, name): getattr(spread, name) for name in ("min", "mean", "max")}


def instruction_figures(built: Build, plugin: Path, scratch: Path) -> Figures:
    counted = count(counted_calls(built, plugin, scratch))
    figures: Figures = {}
    for name, spread in counted.functions.items():
        figures |= spread_figures(spread, book.INSTRUCTIONS, name)
    for module, spread in counted.modules.items():
        figures |= spread_figures(spread, book.OF_UPDATE, module)
    if built.preset == FULL_PRESET:
        figures[key(book.WORST, "track")] = counted.worst_track
        figures |= {key(book.WORST, module, name): n for (module, name), n in counted.worst.items()}
    return figures


def proved_figures(built: Build, measured: Figures, scratch: Path) -> Figures:
    """Figures of the longest path; an error if a call took more, or a loop more turns than the table's bound."""
    code = code_of(built, built.image("replay"))
    proved = {name: proof.most for name, proof in proofs(code).items()}
    wrong = [*unused(code), *exceeded(turns(built, code, scratch))]
    for name, most in proved.items():
        taken = number(measured, book.INSTRUCTIONS, name, "max")
        if taken > most:
            wrong.append(f"{name}: {taken} instructions measured, {most} proved")
    if wrong:
        raise LedgerError(f"{built.preset}: " + "; ".join(wrong))
    return {key(book.PROVED, name): most for name, most in proved.items()}


def part_figures(built: Build, scratch: Path) -> Figures:
    parts = measured_parts(built, scratch)
    figures: Figures = {key(book.PART_BYTES, part.name): part.code for part in parts}
    return figures | {key(book.PART_STATE, part.name): part.state for part in parts}


def measure(preset: str, folder: Path, plugin: Path) -> Figures:
    """All figures of one preset, built in a folder of its name."""
    built = build(preset, folder)
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        figures: Figures = {
            book.COMPILER: built.compiler,
            book.FLAGS: shown_flags(built.command),
            book.MACHINE: built.board,
            book.CALLS: " ".join(external_calls(built)),
            **size_figures(built, scratch),
            **stack_figures(built),
            **instruction_figures(built, plugin, scratch),
        }
        if built.preset in PROVED_PRESETS:
            figures |= proved_figures(built, figures, scratch)
        return figures | part_figures(built, scratch) if preset == PARTS_PRESET else figures
