"""Analysers that compilers bring, over lib/ and port/flight: each must find nothing.

What they are told to leave out is in .clang-tidy, each check with its reason, and beside the code (NOLINT).
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from . import cppcheck
from .parts import Amount, NotHereError
from .record import Result, Row

FOLDERS = (ROOT / "lib", ROOT / "port" / "flight")
INCLUDES = [f"-I{folder}" for folder in FOLDERS]
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", *INCLUDES]
TIDY_CHECKS = "-*,bugprone-*,cert-*,clang-analyzer-*"
CPPCHECK_OPTIONS = [
    "--enable=warning,style,performance,portability",
    "--suppress=variableScope",  # a declaration stands where its meaning is told
    "--suppress=unusedStructMember",  # of files that are seen alone
]


@dataclass(frozen=True)
class Analyser:
    name: str
    program: str  # that is looked for
    command: tuple[str, ...]  # the source follows
    minutes: bool = False  # of the processor: only in a long run


ANALYSERS = (
    Analyser("gcc -fanalyzer", "gcc", ("gcc", *STRICT, "-O2", "-fanalyzer", "-c", "-o", "/dev/null")),
    Analyser("clang --analyze", "clang-19", ("clang-19", *STRICT, "--analyze", "-o", "/dev/null"), minutes=True),
)
FALSE_ALARMS = {  # analyser, file, what it says: why it is false
    (
        "gcc -fanalyzer",
        "lib/window/goe_orientation.c",
        "dereference of NULL 'front'",
    ): "hypothesis_deg() is called only if"
    " one of two edges has a heading: where the side has none, the front has it, so that it is there",
    (
        "cppcheck",
        "lib/refined/goe_touch.c",
        "Using argument solid that points at uninitialized variable solid",
    ): "goe_touch_open() is what initialises it: it writes the rotation, and reads nothing of it",
}


def sources() -> list[Path]:
    return [path for folder in FOLDERS for path in sorted(folder.rglob("*.c"))]


def warnings_of(told: str) -> list[str]:
    """Distinct ones: a header's comes once for each source."""
    shown = re.findall(r"^(\S+:\d+:\d+: (?:warning|error): .*)$", told, re.MULTILINE)
    return sorted({line.replace(f"{ROOT}/", "") for line in shown})


def split_false(name: str, found: list[str]) -> tuple[list[str], list[str]]:
    """What is left without the false alarms, and those that no longer come."""
    known = {(file, text) for analyser, file, text in FALSE_ALARMS if analyser == name}
    met = {(file, text) for file, text in known for line in found if line.startswith(f"{file}:") and text in line}
    left = [line for line in found if not any(line.startswith(f"{file}:") and text in line for file, text in known)]
    return left, sorted(f"{file}: {text}" for file, text in known - met)


def look(command: Iterable[str], source: Path) -> str:
    plain = {**os.environ, "LC_ALL": "C"}  # quotation marks, too
    told = subprocess.run([*command, str(source)], cwd=ROOT, env=plain, capture_output=True, text=True, check=False)
    return told.stdout + told.stderr


def find(command: tuple[str, ...], jobs: int) -> list[str]:
    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:
        return warnings_of("\n".join(pool.map(lambda source: look(command, source), sources())))


def tidy_command(checks: str) -> tuple[str, ...]:
    """With what .clang-tidy leaves out of these families left out."""
    left_out = re.findall(r"^\s+(-(?:bugprone|cert|clang-analyzer)-[\w.-]+)", (ROOT / ".clang-tidy").read_text(), re.M)
    return ("clang-tidy-19", "--quiet", f"--checks={','.join([checks, *left_out])}")


def find_tidy(jobs: int) -> list[str]:
    command = tidy_command(TIDY_CHECKS)
    flags = ("--", *STRICT)
    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:

        def one(source: Path) -> str:
            told = subprocess.run(
                [*command, str(source), *flags], cwd=ROOT, capture_output=True, text=True, check=False
            )
            return told.stdout + told.stderr

        return warnings_of("\n".join(pool.map(one, sources())))


def find_cppcheck(jobs: int) -> list[str]:
    found = cppcheck.check(sources(), FOLDERS, [*CPPCHECK_OPTIONS, *cppcheck.definitions(())], jobs)
    return sorted(f"{entry.file}:{entry.line}:{entry.column}: {entry.rule}: {entry.text}" for entry in found)


def run(amount: Amount) -> Result:
    found: dict[str, list[str]] = {}
    gone: list[str] = []
    for analyser in ANALYSERS:
        if analyser.minutes and not amount.long:
            continue
        if not shutil.which(analyser.program):
            raise NotHereError(f"no {analyser.program}")
        found[analyser.name], no_longer = split_false(analyser.name, find(analyser.command, amount.jobs))
        gone += no_longer
    if amount.long:
        if not shutil.which("clang-tidy-19"):
            raise NotHereError("no clang-tidy-19")
        found["clang-tidy, bugprone, cert, clang-analyzer"] = find_tidy(amount.jobs)
    if not shutil.which("cppcheck"):
        raise NotHereError("no cppcheck")
    found["cppcheck"], no_longer = split_false("cppcheck", find_cppcheck(amount.jobs))
    gone += no_longer
    number = len(sources())
    rows = [Row(f"{name} over {number} files", f"{len(told)} warnings", "0", not told) for name, told in found.items()]
    rows.append(Row("false alarms, each with its reason, that no longer come", str(len(gone)), "0", not gone))
    report = "\n\n".join(f"{name}: {len(told)}\n" + "\n".join(told) for name, told in found.items())
    return Result(rows, report)
