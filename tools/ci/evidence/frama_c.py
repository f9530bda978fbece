"""Frama-C's Eva over the library: one parse, one run for each driver, and the status of every property.

Needs frama-c 25 (Debian: frama-c-base). A driver is a function of tests/proof that calls the library with arbitrary
bits.
"""

from __future__ import annotations

import csv
import re
import shutil
import subprocess
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from . import contracts
from .parts import NotHereError

LIBRARY = ROOT / "lib"
COPY = ROOT / "build" / "proof" / "lib"  # with all contracts, from contracts.py
DRIVERS = ROOT / "tests" / "proof"
PROVED = ("Valid", "Considered valid", "Dead")


@dataclass(frozen=True)
class Driver:
    """A function of tests/proof, and options of its analysis."""

    name: str
    options: tuple[str, ...] = ()
    finite: bool = False  # a non-finite result is an alarm
    quick: bool = False


@dataclass(frozen=True)
class Property:
    """Eva's status of one property. The line is not part of its identity."""

    file: str  # from lib/ or tests/proof/
    function: str
    kind: str
    status: str
    text: str

    @property
    def proved(self) -> bool:
        return self.status in PROVED

    @property
    def key(self) -> tuple[str, str, str, str]:
        return self.file, self.function, self.kind, self.text


@dataclass(frozen=True)
class Run:
    driver: str
    machine: str
    seconds: float
    properties: tuple[Property, ...]
    reached: frozenset[str]  # functions


def frama_c() -> str:
    program = shutil.which("frama-c")
    if not program:
        raise NotHereError("no frama-c (Debian: frama-c-base)")
    return program


def place(folder: str, file: str) -> str:
    """Name of the file in tests/proof/alarms.csv; "" for files of neither the library nor a driver."""
    path = Path(folder.replace("FRAMAC_SHARE", "/")) / file
    path = path if path.is_absolute() else ROOT / path
    for base in (LIBRARY, COPY, DRIVERS):
        if path.is_relative_to(base):
            return path.relative_to(base.parent).as_posix()
    return ""


def read_properties(path: Path) -> tuple[Property, ...]:
    """Parses the report's table, with tabs between its columns."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE))
    found = set()
    for folder, name, _line, function, kind, status, text in rows[1:]:
        if file_name := place(folder, name):
            called = " ".join(plain(word) for word in kind.split())
            found.add(Property(file_name, plain(function), called, status, " ".join(text.split())))
    return tuple(sorted(found, key=lambda entry: (entry.key, entry.status)))


def reached_functions(log: str) -> frozenset[str]:
    """Functions as "lib/x.c:name": a static function is called from its file, and others may have the same name."""
    text = re.sub(r"<- *\n +", "<- ", log)
    calls = re.findall(r"computing for function (\w+) <- [^\n]*\n +Called from (\S+?):\d+", text)
    return frozenset(found for name, file in calls for found in (f"{place('', file)}:{plain(name)}", plain(name)))


def plain(name: str) -> str:
    """Without the number that distinguishes static functions of the same name."""
    return re.sub(r"_\d+$", "", name)


def library_functions(library: Path = LIBRARY) -> frozenset[str]:
    """In the format of reached_functions(): external functions and those of headers by their name alone."""
    found = set()
    for path in sorted(library.rglob("*.[ch]")):
        for match in contracts.functions(path.read_text(encoding="utf-8"), path.suffix == ".c"):
            name = match["name"]
            found.add(f"{place(str(path.parent), path.name)}:{name}" if path.suffix == ".c" else name)
    return frozenset(found)


class Analyzer:
    """The library and the drivers, parsed once for a machine; runs drivers."""

    def __init__(self, work: Path, machine: str) -> None:
        self.machine = machine
        self.work = work
        self.saved = work / f"parsed-{machine}.sav"
        contracts.copy(LIBRARY, COPY)
        self.call(
            ["-machdep", machine, f"-cpp-extra-args=-I{COPY} -I{DRIVERS} -include {DRIVERS / 'builtins.h'}"]
            + [str(path) for path in sorted(COPY.rglob("*.c")) + sorted(DRIVERS.glob("*.c"))]
            + ["-save", str(self.saved)]
        )

    def call(self, arguments: list[str]) -> str:
        done = subprocess.run(
            [frama_c(), *arguments], cwd=ROOT, capture_output=True, text=True, check=False, encoding="utf-8"
        )
        if done.returncode != 0:
            tail = "\n".join((done.stdout + done.stderr).splitlines()[-20:])
            raise RuntimeError(f"frama-c {' '.join(arguments[-6:])}: exit status {done.returncode}\n{tail}")
        return done.stdout

    def run(self, driver: Driver) -> Run:
        begun = time.monotonic()
        table = self.work / f"{driver.name}-{self.machine}.csv"
        log = self.call(
            [
                *("-load", str(self.saved), "-eva", "-main", driver.name, "-eva-no-print", "-eva-show-progress"),
                *("-warn-special-float", "non-finite" if driver.finite else "none"),
                *(*driver.options, "-then", "-report-csv", str(table)),
            ]
        )
        (self.work / f"{driver.name}-{self.machine}.log").write_text(log, encoding="utf-8")
        seconds = round(time.monotonic() - begun, 1)
        return Run(driver.name, self.machine, seconds, read_properties(table), reached_functions(log) | {driver.name})


def run_all(analyzer: Analyzer, drivers: Iterable[Driver], jobs: int) -> list[Run]:
    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:
        return list(pool.map(analyzer.run, drivers))
