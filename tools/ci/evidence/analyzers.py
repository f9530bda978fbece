"""Static analyzers of the compilers, over lib/ and port/flight: each must report nothing.

.clang-tidy disables checks, each with its reason; so do comments in the code (NOLINT).
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
    "--suppress=variableScope",  # a declaration is placed with its explanation
    "--suppress=unusedStructMember",  # in files that are analyzed alone
]


@dataclass(frozen=True)
class Analyzer:
    name: str
    program: str  # that must be installed
    command: tuple[str, ...]  # followed by the source
    minutes: bool = False  # takes minutes: only in a long run


ANALYZERS = (
    Analyzer("gcc -fanalyzer", "gcc", ("gcc", *STRICT, "-O2", "-fanalyzer", "-c", "-o", "/dev/null")),
    Analyzer("clang --analyze", "clang-19", ("clang-19", *STRICT, "--analyze", "-o", "/dev/null"), minutes=True),
)
FALSE_ALARMS = {  # analyzer, file, message: why it is false
    (
        "gcc -fanalyzer",
        "lib/window/goe_orientation.c",
        "dereference of NULL 'front'",
    ): "hypothesis_deg() is called only if"
    " one of two edges has a heading: if the side has none, the front has one, so it is not null",
    (
        "cppcheck",
        "lib/refined/goe_touch.c",
        "Using argument solid that points at uninitialized variable solid",
    ): "goe_touch_open() initializes it: it writes the rotation, and reads nothing from it",
}


def sources() -> list[Path]:
    return [path for folder in FOLDERS for path in sorted(folder.rglob("*.c"))]


def warnings_of(log: str) -> list[str]:
    """Distinct warnings: a header's warning appears once for each source."""
    shown = re.findall(r"^(\S+:\d+:\d+: (?:warning|error): .*)$", log, re.MULTILINE)
    return sorted({line.replace(f"{ROOT}/", "") for line in shown})


def split_false(name: str, found: list[str]) -> tuple[list[str], list[str]]:
    """The real warnings, and the false alarms that no longer appear."""
    known = {(file, text) for analyzer, file, text in FALSE_ALARMS if analyzer == name}
    met = {(file, text) for file, text in known for line in found if line.startswith(f"{file}:") and text in line}
    left = [line for line in found if not any(line.startswith(f"{file}:") and text in line for file, text in known)]
    return left, sorted(f"{file}: {text}" for file, text in known - met)


def look(command: Iterable[str], source: Path) -> str:
    plain = {**os.environ, "LC_ALL": "C"}  # plain quotation marks
    done = subprocess.run([*command, str(source)], cwd=ROOT, env=plain, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def find(command: tuple[str, ...], jobs: int) -> list[str]:
    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:
        return warnings_of("\n".join(pool.map(lambda source: look(command, source), sources())))


def tidy_command(checks: str) -> tuple[str, ...]:
    """With the exclusions of .clang-tidy from these families."""
    left_out = re.findall(r"^\s+(-(?:bugprone|cert|clang-analyzer)-[\w.-]+)", (ROOT / ".clang-tidy").read_text(), re.M)
    return ("clang-tidy-19", "--quiet", f"--checks={','.join([checks, *left_out])}")


def find_tidy(jobs: int) -> list[str]:
    command = tidy_command(TIDY_CHECKS)
    flags = ("--", *STRICT)
    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:

        def one(source: Path) -> str:
            done = subprocess.run(
                [*command, str(source), *flags], cwd=ROOT, capture_output=True, text=True, check=False
            )
            return done.stdout + done.stderr

        return warnings_of("\n".join(pool.map(one, sources())))


def find_cppcheck(jobs: int) -> list[str]:
    found = cppcheck.check(sources(), FOLDERS, [*CPPCHECK_OPTIONS, *cppcheck.definitions(())], jobs)
    return sorted(f"{entry.file}:{entry.line}:{entry.column}: {entry.rule}: {entry.text}" for entry in found)


def run(amount: Amount) -> Result:
    found: dict[str, list[str]] = {}
    gone: list[str] = []
    for analyzer in ANALYZERS:
        if analyzer.minutes and not amount.long:
            continue
        if not shutil.which(analyzer.program):
            raise NotHereError(f"no {analyzer.program}")
        found[analyzer.name], no_longer = split_false(analyzer.name, find(analyzer.command, amount.jobs))
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
    rows = [
        Row(f"{name} over {number} files", f"{len(lines)} warnings", "0", not lines) for name, lines in found.items()
    ]
    rows.append(Row("known false alarms that no longer appear", str(len(gone)), "0", not gone))
    report = "\n\n".join(f"{name}: {len(lines)}\n" + "\n".join(lines) for name, lines in found.items())
    return Result(rows, report)
