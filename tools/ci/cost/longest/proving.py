"""The proved figures of a target: the longest path of each public function."""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from bench.running import ROOT, LedgerError

from ..building import Build
from ..instructions import PUBLIC, UPDATES, WITH_LENS
from ..modules import plain_command
from . import loop_bounds, machine_code, source_lines
from .longest_path import Code, Context, Finder

PROVED_PRESETS = ("m4f-gcc-o2",)

# Ledger name: function. The table's statements distinguish the entries of a function.
CALLS = {
    **{name: name for name in PUBLIC},
    f"{UPDATES['filter']} {WITH_LENS}": "goe_update",
    UPDATES["window"]: "goe_update",
    f"{UPDATES['window']} {WITH_LENS}": "goe_update",
}


@dataclass(frozen=True)
class Proof:
    most: int
    shares: Counter[str]  # of a longest path, by function


def constants_of(built: Build) -> dict[str, int]:
    library = ROOT / "lib"
    given = "".join(f'#include "{path.relative_to(library)}"\n' for path in sorted(library.rglob("*.h")))
    command = [*plain_command(built), f"-I{library}", "-E", "-dD", "-P", "-x", "c", "-"]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: {done.stderr}")
    return loop_bounds.constants_of(done.stdout, (p.read_text(encoding="utf-8") for p in sorted(library.rglob("*.c"))))


def sizes_of(symbols: str) -> dict[str, int]:
    """Bytes of the image's constant arrays, as sizeof_<name>."""
    found = re.findall(r"^[0-9a-f]+ ([0-9a-f]+) [rRtT] (\w+)$", symbols, re.MULTILINE)
    return {f"sizeof_{name}": int(size, 16) for size, name in found}


def code_of(built: Build, image: Path, table: Path = loop_bounds.TABLE) -> Code:
    functions = machine_code.functions_below(built.tool("objdump", "-d", "--no-show-raw-insn", image), PUBLIC)
    addresses = [i.address for f in functions.values() for b in f.blocks.values() for i in b.instructions]
    places = source_lines.read(built.tool_prefix + "addr2line", image, addresses)
    constants = constants_of(built) | sizes_of(built.tool("nm", "-S", image))
    return Code(functions, places, loop_bounds.read(table), constants)


def proofs(code: Code) -> dict[str, Proof]:
    starts = {function.name: start for start, function in code.functions.items()}
    found = {}
    for name, function in CALLS.items():
        most, shares = Finder(code, name).most(starts[function], Context())
        found[name] = Proof(most, shares)
    return found


def unused(code: Code) -> list[str]:
    """Lines of the table that bounded nothing, since their subject no longer exists. A line that exists for other
    callers than those distinguished by the table counts as used."""
    loops = {(row.function, row.line) for row in code.table if row.number in code.used and row.kind == "loop"}
    return [
        f"line {row.number}: {row.kind} {row.function}: {row.line}"
        for row in code.table
        if row.number not in code.used and not (not row.when and (row.function, row.line) in loops)
    ]
