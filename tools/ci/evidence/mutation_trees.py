"""Mutants of port/flight and port/companion: each is applied to a copy of the project, which ninja builds.

Only the changed file is compiled, and the tests of its folder are linked. The C tests run first, the fastest first;
then the Python tests of the program. The first failure ends the trial.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue

from goe_tools.places import ROOT

from .mutants import Mutant, apply, mutants, sources
from .mutation_counts import KILLED, KILLED_BY_PROGRAM, NO_CODE, SAME_CODE, SURVIVED, Outcome, report
from .survivors import reasons_of

CACHE = ROOT / ".cache" / "evidence" / "mutation"
LEFT_OUT = shutil.ignore_patterns(".git", ".cache", ".venv", "build*", "__pycache__")
OPTIONS = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O2", "-DGOE_BUILD_TESTS=ON")
OPTIONS += ("-DGOE_WERROR=OFF", "-DGOE_INSTALL=OFF")
PROGRAM = "program"  # name of all Python tests of the program
SPARE, SPARE_S = 10.0, 5.0  # a mutant's test may take this multiple of its normal time, plus these seconds
SPARE_OF_PROGRAM = 2.0  # its tests are slow already, so a hanging program must end soon


@dataclass(frozen=True)
class Layer:
    """A folder of sources, its C tests, and a program run by Python tests."""

    name: str  # of the folder
    tests: str  # the folder of its tests: test_*.c and test_*.py
    listed: str  # in tests/mutation: its mutants that survive, with reasons
    flags: tuple[str, ...]
    programs: dict[str, str] = field(default_factory=dict)  # environment variable of the tests: build target
    slow: tuple[str, ...] = ()  # Python tests that run last

    @property
    def folder(self) -> Path:
        return ROOT / self.name

    @property
    def reasons(self) -> Path:
        return ROOT / "tests" / "mutation" / self.listed

    def mutants(self) -> list[Mutant]:
        """All mutants. The flags refer to files in build/ of the first copy."""
        build = str(Tree(self, 0).build)
        flags = [flag.replace("build/", f"{build}/") for flag in self.flags]
        return [mutant for file in sources(self.folder) for mutant in mutants(file, self.folder, flags)]


FLIGHT = Layer("port/flight", "tests/flight", "flight.csv", ("-DGOE_WINDOW_MAX=8", "-Ilib"))
COMPANION = Layer(
    "port/companion",
    "tests/companion",
    "companion.csv",
    (
        *("-D_DEFAULT_SOURCE", "-D_XOPEN_SOURCE=700", '-DGOE_VERSION="0"'),
        *("-DGOE_CAMERAS_MAX=2", "-DGOE_FLIGHT_SLOTS=16", "-DGOE_WINDOW_MAX=64"),
        *("-Iport/flight", "-Iport/mavlink", "-Ilib", "-Isim_host/log", "-Isim_host/text"),
        *("-isystem", "build/port/companion/headers"),
    ),
    {"GOE_COMPANION": "port/companion/goe_companion", "GOE_REPLAY": "sim_host/goe_replay"},
    ("test_companion_flight", "test_companion_security", "test_companion_disturbed", "test_companion_load"),
)
LAYERS = (FLIGHT, COMPANION)


class Tree:
    """A copy of the project, in which one mutant at a time is tried."""

    def __init__(self, layer: Layer, number: int) -> None:
        self.layer = layer
        self.folder = CACHE / f"{Path(layer.name).name}_{number}"
        self.build = self.folder / "build"
        self.tests = sorted(path.stem for path in (ROOT / layer.tests).glob("test_*.c"))
        found = sorted((ROOT / layer.tests).glob("test_*.py")) if layer.programs else []
        self.python_tests = sorted(found, key=lambda path: path.stem in layer.slow and layer.slow.index(path.stem) + 1)
        self.seconds: dict[str, float] = {}

    def prepare(self) -> None:
        """Copies and builds the project, and measures its tests."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for path in self.folder.iterdir():
            if path != self.build:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        shutil.copytree(ROOT, self.folder, ignore=LEFT_OUT, dirs_exist_ok=True)
        for source in (self.folder / self.layer.name).glob("*.[ch]"):
            source.touch()  # a stopped run may have left a mutant's object
        unity = os.environ.get("UNITY_DIR", str(ROOT / ".cache" / "unity"))
        configured = ["cmake", "-S", self.folder, "-B", self.build, *OPTIONS, f"-DUNITY_DIR={unity}"]
        subprocess.run([*map(str, configured), f"-DGOE_PYTHON={sys.executable}"], check=True, capture_output=True)
        if not self.make():
            raise RuntimeError(f"{self.folder} does not build")
        for name in [*self.tests, *([PROGRAM] if self.python_tests else [])]:
            before = time.monotonic()
            if not self.passes(name):
                raise RuntimeError(f"{self.layer.name} without a mutant fails {name}")
            self.seconds[name] = time.monotonic() - before
        self.tests.sort(key=self.seconds.__getitem__)
        self.objects = self.object_code()

    def make(self) -> bool:
        targets = [*self.tests, *(Path(program).name for program in self.layer.programs.values())]
        command = ["ninja", "-C", str(self.build), "-j1", *targets]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    def object_code(self) -> dict[str, bytes]:
        folder = self.build / self.layer.name / "CMakeFiles"
        return {str(path): path.read_bytes() for path in sorted(folder.rglob("*.o"))}

    def passes(self, name: str) -> bool:
        """Runs a C test by its name, or those of the program."""
        command = [str(self.build / self.layer.tests / name)]
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
        if name == PROGRAM:
            command = [
                sys.executable,
                "-m",
                "pytest",
                "-x",
                "-q",
                "-p",
                "no:cacheprovider",
                "-c",
                "tools/pyproject.toml",
            ]
            command += [str(path.relative_to(ROOT)) for path in self.python_tests]
            environment.update((name, str(self.build / path)) for name, path in self.layer.programs.items())
        spare = SPARE_OF_PROGRAM if name == PROGRAM else SPARE
        limit = SPARE_S + spare * self.seconds[name] if name in self.seconds else None
        nothing = subprocess.DEVNULL
        process = subprocess.Popen(
            command, cwd=self.folder, env=environment, stdout=nothing, stderr=nothing, start_new_session=True
        )
        try:
            return process.wait(limit) == 0
        except subprocess.TimeoutExpired:
            return False
        finally:
            if process.returncode is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def attempt(self, mutant: Mutant) -> Outcome:
        path = self.folder / self.layer.name / mutant.file
        text = (self.layer.folder / mutant.file).read_text(encoding="ascii")
        path.write_text(apply(mutant, text), encoding="ascii")
        try:
            return self.outcome(mutant)
        finally:
            path.write_text(text, encoding="ascii")

    def outcome(self, mutant: Mutant) -> Outcome:
        if not self.make():
            return Outcome(mutant, NO_CODE)
        if self.object_code() == self.objects:
            return Outcome(mutant, SAME_CODE)
        for name in self.tests:
            if not self.passes(name):
                return Outcome(mutant, KILLED, name)
        if self.python_tests and not self.passes(PROGRAM):
            return Outcome(mutant, KILLED_BY_PROGRAM, PROGRAM)
        return Outcome(mutant, SURVIVED)


def sampled(every: Sequence[Mutant], count: int, seed: int) -> list[Mutant]:
    """The same number from each family, as far as it has them."""
    families: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in every:
        families[mutant.family].append(mutant)
    chosen: list[Mutant] = []
    by_size = sorted(families, key=lambda name: len(families[name]))
    for i, name in enumerate(by_size):
        share = min(len(families[name]), round((count - len(chosen)) / (len(by_size) - i)))
        chosen += random.Random(f"{seed} {name}").sample(families[name], share)
    return sorted(chosen, key=lambda mutant: (mutant.file, mutant.begin, mutant.text))


def prepared(layer: Layer, jobs: int) -> list[Tree]:
    trees = [Tree(layer, number) for number in range(jobs)]
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(Tree.prepare, trees))
    return trees


def try_all(trees: Sequence[Tree], chosen: Sequence[Mutant]) -> list[Outcome]:
    """Tries the mutants in all trees in parallel."""
    free: SimpleQueue[Tree] = SimpleQueue()
    for tree in trees:
        free.put(tree)

    def attempt(mutant: Mutant) -> Outcome:
        tree = free.get()
        try:
            outcome = tree.attempt(mutant)
        finally:
            free.put(tree)
        if outcome.came_to == SURVIVED:
            print(f"{mutant.file} {mutant.function}: {mutant.source} -> {mutant.mutation}", file=sys.stderr, flush=True)
        return outcome

    with ThreadPoolExecutor(len(trees)) as pool:
        return list(pool.map(attempt, chosen))


def main() -> None:
    parser = argparse.ArgumentParser(description="Mutants of one folder, with a chosen seed.")
    parser.add_argument("folder", choices=[layer.name for layer in LAYERS])
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    layer = next(layer for layer in LAYERS if layer.name == arguments.folder)
    begun = time.monotonic()
    trees = prepared(layer, arguments.jobs)
    outcomes = try_all(trees, sampled(layer.mutants(), arguments.count, arguments.seed))
    print(report(outcomes, reasons_of(layer.reasons), time.monotonic() - begun))


if __name__ == "__main__":
    main()
