"""Breaks the code one line at a time in a copy, and checks that the test with the mark fails."""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from ..parts import NotHereError
from . import marks

TABLE = ROOT / "tests" / "mutation" / "breaks.csv"
FLAGS = ("-std=c99", "-O1", "-ffp-contract=off")
NOT_REPORTED = "not reported"
SECONDS = 300  # a test that takes longer counts as failed


@dataclass(frozen=True)
class Break:
    """One line of the code, broken on purpose, and the test that then fails."""

    mark: str  # of the broken promise and of the test
    file: str
    old: str
    new: str
    test: str
    line: int  # of the table


def read(path: Path = TABLE) -> list[Break]:
    with path.open(encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file, strict=True)
        return [Break(row["mark"], row["file"], row["old"], row["new"], row["test"], rows.line_num) for row in rows]


def stale(breaks: Iterable[Break], found: marks.Findings, root: Path = ROOT) -> Iterator[str]:
    """Entries whose line no longer exists, or whose test no longer has the mark."""
    for broken in breaks:
        place = f"tests/mutation/{TABLE.name}:{broken.line} ({broken.mark})"
        if broken.test not in (test.name for test in found.by_key.get(broken.mark, [])):
            yield f"{place}: {broken.test} does not have that mark"
        if not (root / broken.file).is_file() or marks.read(root / broken.file).count(broken.old) != 1:
            yield f"{place}: {broken.file} must have these words once: {broken.old}"


def unity() -> Path:
    """The folder of unity.c."""
    for folder in (Path(os.environ.get("UNITY_DIR", ROOT / ".cache" / "unity")), Path("/usr/include/unity")):
        for candidate in (folder, folder / "src"):
            if (candidate / "unity.c").exists():
                return candidate
    raise NotHereError("the Unity test framework: tools/setup.sh, or UNITY_DIR")


@dataclass(frozen=True)
class Outcome:
    broken: Break
    noticed: bool
    message: str  # of the named test


class Bench:
    """Objects of the library and the shared files of the unit tests; a program may replace one file of the library."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.folder, self.jobs, self.unity = folder, jobs, unity()
        self.compiler = os.environ.get("CC", "cc")
        library = [*(ROOT / "lib").glob("*.c"), *(ROOT / "lib").glob("*/*.c")]
        shared = [path for path in (ROOT / "tests" / "c").glob("*.c") if not path.name.startswith("test_")]
        with ThreadPoolExecutor(jobs) as pool:
            objects = dict(zip(library, pool.map(self.compile, library)))
            self.shared = list(pool.map(self.compile, [*shared, self.unity / "unity.c"]))
        self.library: dict[Path, Path] = objects

    def run(self, *command: str | Path) -> None:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{command}\n{done.stderr}")

    def compile(self, source: Path, to: Path | None = None) -> Path:
        to = to or self.folder / f"{source.stem}.o"
        folders = (ROOT / "lib", ROOT / "tests" / "c", self.unity)
        include = () if source.is_relative_to(ROOT) else (f"-I{ROOT / 'lib'}",)
        self.run(self.compiler, *FLAGS, *(f"-I{folder}" for folder in folders), *include, "-c", source, "-o", to)
        return to

    def link(self, objects: Sequence[Path], to: Path) -> Path:
        self.run(self.compiler, *objects, *self.shared, "-lm", "-o", to)
        return to

    def result_of(self, program: Path, test: str) -> tuple[bool, str]:
        """Whether the test failed, and its message."""
        try:
            done = subprocess.run([program], cwd=ROOT, capture_output=True, text=True, check=False, timeout=SECONDS)
        except subprocess.TimeoutExpired:
            return True, f"no end within {SECONDS} s"
        lines = [line for line in done.stdout.splitlines() if f":{test}:" in line]
        if done.returncode < 0 and not lines:
            return True, f"ended by signal {-done.returncode}"
        message = lines[-1].partition(f"{test}:")[2] if lines else NOT_REPORTED
        return any(":FAIL" in line for line in lines), message

    def judge(self, broken: Break | None, file: str, test: str) -> tuple[bool, str]:
        """One program, with the broken line or unchanged."""
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            folder = Path(name)
            objects = dict(self.library)
            if broken is not None:
                original = ROOT / broken.file
                copy = folder / original.name
                copy.write_text(original.read_text(encoding="utf-8").replace(broken.old, broken.new), encoding="utf-8")
                objects[original] = self.compile(copy, folder / "broken.o")
            program = self.compile(ROOT / file, folder / "test.o")
            return self.result_of(self.link([program, *objects.values()], folder / "test"), test)

    def outcome(self, broken: Break) -> Outcome:
        file, _, test = broken.test.partition(":")
        try:
            return Outcome(broken, *self.judge(broken, file, test))
        except RuntimeError as error:
            return Outcome(broken, False, f"does not compile: {error}")


def try_all(breaks: Iterable[Break], jobs: int) -> tuple[list[Outcome], list[str]]:
    """Outcomes of the named tests for each broken line; and tests that fail with nothing broken."""
    breaks = list(breaks)
    if not shutil.which(os.environ.get("CC", "cc")):
        raise NotHereError("a C compiler")
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(jobs) as pool:
        bench = Bench(Path(name), jobs)
        tests = sorted({broken.test for broken in breaks})
        whole = pool.map(lambda test: bench.judge(None, *test.split(":", 1)), tests)
        failing = [test for test, (failed, message) in zip(tests, whole) if failed or message == NOT_REPORTED]
        return list(pool.map(bench.outcome, breaks)), failing
