"""Cost of a firmware without some parts of the library: GOE_WITH_WINDOW, GOE_WITH_FILTER, GOE_WITH_HAZARD, and
GOE_WITH_TARGET_MOTION of the filter method.

Each combination of parts that lib/goe.h accepts is compiled for one target. There are no figures if the header has no
such parts.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from bench.running import ROOT, LedgerError, output_of
from goe_tools.places import interface

from .building import Build
from .modules import bytes_of_object, plain_command, size_of_state

PARTS = ("window", "filter", "hazard")
PARTS_PRESET = "m4f-gcc-os"  # the smallest code for the project's usual processor


@dataclass
class Part:
    """A combination of parts and its cost."""

    name: str
    code: int  # and constants, bytes
    state: int  # bytes, at the default window


def parts_known(header: str) -> bool:
    """Whether the public headers have the parts."""
    return all(re.search(rf"\bGOE_WITH_{part.upper()}\b", header) for part in PARTS)


def combinations() -> list[tuple[str, list[str]]]:
    """Names and definitions of all combinations, the smaller ones first; everything last."""
    result = []
    for chosen in sorted(product((1, 0), repeat=len(PARTS)), key=sum):
        words = [part for part, is_in in zip(PARTS, chosen) if is_in]
        name = "everything" if len(words) == len(PARTS) else " and ".join(words)
        result.append((name, [f"-DGOE_WITH_{part.upper()}={is_in}" for part, is_in in zip(PARTS, chosen)]))
    return result[1:]  # without the empty combination


def is_refused(command: Sequence[str], definitions: Sequence[str]) -> bool:
    """Whether goe.h refuses these definitions with #error."""
    words = [*command, *definitions, "-E", "-x", "c", "-"]
    done = subprocess.run(words, input='#include "goe.h"\n', capture_output=True, text=True)
    if done.returncode != 0 and "#error" not in done.stderr:
        raise LedgerError(f"{' '.join(words)}: {done.stderr}")
    return done.returncode != 0


def code_bytes(built: Build, sources: Sequence[Path], definitions: Sequence[str], folder: Path) -> int:
    """Bytes of code and constants of the library's sources with these definitions."""
    total = 0
    for source in sources:
        target = folder / "part.obj"
        output_of([*plain_command(built), *definitions, "-o", target, "-c", source])
        figures = bytes_of_object(built.tool("size", "-A", target))
        total += figures["code"] + figures["constants"]
    return total


def measured_parts(built: Build, folder: Path, library: Path = ROOT / "lib") -> list[Part]:
    """One entry for each combination of parts; none if goe.h has no parts."""
    headers = interface(library)
    if not parts_known(headers):
        return []
    sources = sorted(library.rglob("*.c"))
    chosen = combinations()
    if "GOE_WITH_TARGET_MOTION" in headers:
        chosen.append(("everything but target_motion", ["-DGOE_WITH_TARGET_MOTION=0"]))
    return [
        Part(name, code_bytes(built, sources, definitions, folder), size_of_state(built, folder, definitions))
        for name, definitions in chosen
        if not is_refused(plain_command(built), definitions)
    ]
