"""Bytes: of code, constants and data by module, and of the state."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from bench.running import LedgerError, output_of

from .building import EXTRA_OUTPUT, Build

WINDOWS = (3, 8, 16, 32, 64)  # of the table with bytes of state
KINDS = ("code", "constants", "data")


def bytes_of_object(sizes: str) -> dict[str, int]:
    """Bytes of each kind, from the output of size -A for an object."""
    figures = dict.fromkeys(KINDS, 0)
    for name, size in re.findall(r"^(\.[\w.$]+)\s+(\d+)\s+\d+$", sizes, re.MULTILINE):
        if name.startswith(".text"):
            figures["code"] += int(size)
        elif name.startswith((".rodata", ".srodata")):
            figures["constants"] += int(size)
        elif name.startswith((".data", ".sdata", ".bss", ".sbss")):
            figures["data"] += int(size)
    return figures


def module_bytes(built: Build) -> dict[str, dict[str, int]]:
    """Bytes of code, constants and writable data by module."""
    return {built.module(path): bytes_of_object(built.tool("size", "-A", path)) for path in built.library_files("obj")}


def external_calls(built: Build) -> list[str]:
    """Symbols that the library needs from elsewhere."""
    defined, wanted = set(), set()
    for kind, name in re.findall(r" (\w) (\S+)$", built.tool("nm", *built.library_files("obj")), re.MULTILINE):
        (wanted if kind in "Uw" else defined).add(name)
    return sorted(wanted - defined)


def plain_command(built: Build) -> list[str]:
    """The library's command without extra outputs and without user definitions."""
    left_out = ("-DGOE_WINDOW_MAX", "-DGOE_WITH_", *EXTRA_OUTPUT)
    return [word for word in built.command if not word.startswith(left_out)]


def size_of_state(built: Build, folder: Path, definitions: Sequence[str]) -> int:
    """sizeof(goe_estimator_t) for a program compiled with these definitions."""
    source, target = folder / "state.c", folder / "state.obj"
    lines = ['#include "goe.h"', "extern char state[];", "char state[sizeof(goe_estimator_t)];", ""]
    source.write_text("\n".join(lines), encoding="utf-8")
    output_of([*plain_command(built), *definitions, "-o", target, "-c", source])
    size = re.search(r"^\w+ (\w+) \w state$", built.tool("nm", "-S", target), re.MULTILINE)
    if not size:
        raise LedgerError(f"{built.preset}: the compiler produced no array of the state's size")
    return int(size.group(1), 16)


def state_bytes(built: Build, folder: Path) -> dict[int, int]:
    """Bytes of state by window length."""
    return {window: size_of_state(built, folder, [f"-DGOE_WINDOW_MAX={window}"]) for window in WINDOWS}
