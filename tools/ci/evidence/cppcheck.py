"""Runs cppcheck with its MISRA addon away from the sources, since it writes files next to its input.

Needs cppcheck 2.10 (Debian: cppcheck). The addon names rules by their numbers only; their texts are MISRA's.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from .parts import NotHereError

LIBRARY = ROOT / "lib"
PARTS = ("WINDOW", "FILTER", "HAZARD", "TARGET_MOTION")
CONFIGURATIONS: dict[str, tuple[str, ...]] = {  # name: omitted parts
    "default": (),
    **{f"without {part}": (part,) for part in PARTS},
}
TEMPLATE = "{file}|{line}|{column}|{id}|{message}"


@dataclass(frozen=True)
class Finding:
    rule: str  # "12.1", or another check's name
    file: str  # from the root
    line: int
    column: int
    text: str = ""


def cppcheck() -> str:
    program = shutil.which("cppcheck")
    if not program:
        raise NotHereError("no cppcheck")
    return program


def definitions(left_out: Iterable[str]) -> list[str]:
    """All definitions, so cppcheck tries no other configurations."""
    off = set(left_out)
    values = {f"GOE_WITH_{part}": 0 if part in off else 1 for part in PARTS}
    values |= {"GOE_WINDOW_MAX": 8, "GOE_CAMERAS_MAX": 1, "__GNUC__": 12}
    return [f"-D{name}={value}" for name, value in values.items()]


def findings_of(log: str) -> set[Finding]:
    found = set()
    for line in log.splitlines():
        if matched := re.fullmatch(r"([^|]+\.[ch])\|(\d+)\|(\d+)\|([^|]+)\|(.*)", line):
            file, row, column, name, text = matched.groups()
            path = Path(file)
            inside = path.relative_to(ROOT).as_posix() if path.is_absolute() and path.is_relative_to(ROOT) else file
            found.add(Finding(name.removeprefix("misra-c2012-"), inside, int(row), int(column), text))
    return found


def check(sources: Iterable[Path], includes: Iterable[Path], options: Iterable[str], jobs: int) -> set[Finding]:
    with tempfile.TemporaryDirectory() as build:
        done = subprocess.run(
            [cppcheck(), "--std=c99", "--platform=arm32-wchar_t4", f"--cppcheck-build-dir={build}", "-q", f"-j{jobs}"]
            + [f"--addon-python={sys.executable}"]
            + [f"--template={TEMPLATE}", "--inline-suppr", *options, *(f"-I{path}" for path in includes)]
            + [str(path) for path in sources],
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode != 0:
        raise RuntimeError(f"cppcheck: exit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return findings_of(done.stderr)


def misra(left_out: Iterable[str], jobs: int) -> set[Finding]:
    """Violations reported by the addon in lib/; those in headers count once."""
    sources = sorted(LIBRARY.rglob("*.c"))
    found = check(sources, [LIBRARY], ["--addon=misra", "--enable=style", *definitions(left_out)], jobs)
    return {finding for finding in found if re.fullmatch(r"\d+\.\d+", finding.rule)}


def counts(findings: Iterable[Finding]) -> Counter[tuple[str, str]]:
    """Counts by rule and file."""
    return Counter((finding.rule, finding.file) for finding in findings)
