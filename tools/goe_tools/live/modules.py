"""Builds the WebAssembly modules of port/wasm."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from ..places import ROOT

PRESET = "wasm"
NEEDED = ("cmake", "ninja", "clang-19", "wasm-ld-19", "wasm-opt")  # of Debian's packages


@dataclass(frozen=True)
class Modules:
    """The modules as bytes: the library, the flight, the replay of the test logs."""

    goe: bytes
    flight: bytes
    golden: bytes


def missing() -> list[str]:
    """The missing programs for a build."""
    return [name for name in NEEDED if shutil.which(name) is None]


def build(folder: Path) -> Modules:
    """Builds in ``folder``. ValueError: a program is missing, or the build failed."""
    absent = missing()
    if absent:
        raise ValueError(f"needs {', '.join(absent)}, which tools/setup.sh --demo installs")
    for command in (
        ["cmake", "--preset", PRESET, "-B", str(folder)],
        ["cmake", "--build", str(folder), "--target", "goe_wasm", "goe_wasm_flight", "goe_wasm_golden"],
    ):
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            raise ValueError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout}{done.stderr}".rstrip())
    return read(folder)


def read(folder: Path) -> Modules:
    """The modules in a folder of :func:`build`."""
    place = folder / "port" / "wasm"
    return Modules(*((place / f"{name}.wasm").read_bytes() for name in ("goe", "flight", "golden")))
