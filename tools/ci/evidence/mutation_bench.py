"""Builds the library once and only the changed file for each mutant, and runs the unit tests and the probe.

The library is shared; tests and probe get its path when they start. A mutant costs the compilation of its
file and a link of the library.
"""

from __future__ import annotations

import hashlib
import os
import re
import resource
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from .mutants import LIBRARY, Mutant, apply, sources
from .parts import NotHereError

COMPILER = "cc"
FLAGS = ("-std=c99", "-w", "-fPIC", "-ffp-contract=off", "-fno-math-errno", "-fno-semantic-interposition", "-O1")
DEFINED = ("-DGOE_WINDOW_MAX=8",)
LINKED = ("-shared", "-Wl,-Bsymbolic")
C_TESTS = ROOT / "tests" / "c"
TARGETS = ROOT / "tests" / "targets"
PROBE = ROOT / "tests" / "mutation" / "probe.c"
BITS = "refined_bits"  # the test of a hash alone
GOLDEN = TARGETS / "golden_hash.txt"
SPARE = 4.0  # a mutant may take this multiple of the library's time ...
SPARE_S = 1.0  # ... plus a second
WALL_S = 300.0
# A long test runs only for the files it is about, and random input is shorter than in a normal test run: leaving
# something out can only let a mutant survive.
ABOUT = {
    "double_hazard": ("hazard/", "goe_covariance", "maths/"),
    "double_angle": ("maths/",),
    "double_normal": ("maths/",),
    "safety_hazard": ("hazard/", "goe_covariance", "goe_latest", "maths/"),
}
SHORTER = {"GOE_TEST_UPDATES": "6000"}
UNITY_PLACES = (".cache/unity/src", ".cache/unity")


@dataclass(frozen=True)
class Ran:
    """A program's end. ``why``: the test that failed and its place, or how the program ended."""

    good: bool
    seconds: float  # of processor time
    output: str
    why: str = ""


def unity_folder() -> Path:
    named = os.environ.get("UNITY_DIR")
    for folder in [Path(named), Path(named) / "src"] if named else [ROOT / place for place in UNITY_PLACES]:
        if (folder / "unity.c").exists():
            return folder
    raise NotHereError("the sources of Unity: tools/setup.sh, or UNITY_DIR")


def hash_of(paths: Iterable[Path], *words: str) -> str:
    """Hash of the files' texts, in this order."""
    made = hashlib.sha256("\0".join(words).encode())
    for path in paths:
        made.update(path.read_bytes())
    return made.hexdigest()[:16]


def unit_tests() -> list[str]:
    """Unit tests of the library alone, by name."""
    names = sorted(path.stem[len("test_") :] for path in C_TESTS.glob("test_*.c"))
    return [name for name in names if not name.startswith("host_")]


def shared_by_tests() -> list[Path]:
    """Files that all tests share."""
    own = sorted(path for path in C_TESTS.glob("*.[ch]") if not path.name.startswith("test_"))
    return [*own, *sorted((C_TESTS / "golden").glob("*.h"))]


def support_of_tests() -> list[Path]:
    """Sources that every test is linked with."""
    return [path for path in shared_by_tests() if path.suffix == ".c"]


def library_hash() -> str:
    return hash_of(sorted(LIBRARY.rglob("*.[ch]")), COMPILER, *FLAGS, *DEFINED)


def test_hash(name: str) -> str:
    return hash_of([C_TESTS / f"test_{name}.c", *shared_by_tests()])


def inline_functions(file: str) -> list[tuple[str, str]]:
    """Name and text of each inline function in a header; the text may extend up to the next one."""
    parts = re.split(r"^static inline ", (LIBRARY / file).read_text(encoding="ascii"), flags=re.MULTILINE)[1:]
    return [(found[1], part) for part in parts if (found := re.search(r"(\w+)\(", part))]


def stem(mutant: Mutant) -> str:
    """The stem of its file, as in the names of tests."""
    return Path(mutant.file).stem[len("goe_") :]


def compiled(command: list[str]) -> bool:
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def must(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr[-2000:]}")


class Bench:
    """The library, its tests and the probe, built in a folder."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.folder = folder
        self.unity = unity_folder()
        self.tests = unit_tests()
        self.include = ["-I" + str(place) for place in (LIBRARY, C_TESTS, TARGETS, self.unity)]
        self.users: dict[str, set[str]] = {}  # sources that include a header
        self.seconds: dict[str, float] = {}
        self.objects = folder / "objects"
        self.programs = folder / "programs"
        for place in (self.objects, self.programs):
            place.mkdir(parents=True, exist_ok=True)
        with ThreadPoolExecutor(jobs) as pool:
            list(pool.map(self.compile_library, (file for file in sources() if file.endswith(".c"))))
            self.link(folder, {})
            self.shared = list(pool.map(self.compile_shared, [*support_of_tests(), self.unity / "unity.c"]))
            for failed in pool.map(self.build_program, [*self.tests, "probe"]):
                failed and must(failed)
        self.probe_output = self.ran("probe", folder, None).output
        self.check()

    # ------------------------------------------------------------------------------------------------------------ build

    def object_of(self, file: str) -> Path:
        return self.objects / (file.replace("/", "_") + ".o")

    def command(self, source: Path, made: Path, *more: str) -> list[str]:
        return [COMPILER, *FLAGS, *DEFINED, *more, *self.include, "-c", str(source), "-o", str(made)]

    def compile_library(self, file: str) -> None:
        """Cached by the hash of the whole library, in the folder's name."""
        made = self.object_of(file)
        needs = made.with_suffix(".d")
        if not made.exists():
            must([*self.command(LIBRARY / file, made), "-MMD", "-MF", str(needs)])
        for name in re.findall(r"\S+\.h", needs.read_text()):
            path = Path(name).resolve()
            if LIBRARY in path.parents:
                self.users.setdefault(str(path.relative_to(LIBRARY)), set()).add(file)

    def compile_shared(self, source: Path) -> str:
        """The objects that every program is linked with, except its own file."""
        made = self.objects / f"shared_{source.stem}_{hash_of([source, *shared_by_tests()])}.o"
        if not made.exists():
            must(self.command(source, made))
        return str(made)

    def link(self, folder: Path, instead: dict[str, Path]) -> None:
        parts = [str(instead.get(file) or self.object_of(file)) for file in sources() if file.endswith(".c")]
        must([COMPILER, *LINKED, *parts, "-lm", "-o", str(folder / "libgoe.so")])

    def linking(self, own: list[Path], program: Path) -> list[str]:
        made = [str(part) for part in own] + self.shared
        return [
            COMPILER,
            *FLAGS,
            *DEFINED,
            *self.include,
            *made,
            f"-L{self.folder}",
            "-lgoe",
            "-lm",
            "-o",
            str(program),
        ]

    def build_program(self, name: str) -> list[str] | None:
        """Returns the failing command, if one fails."""
        own = [C_TESTS / f"test_{name}.c"]
        if name == "probe":
            own = [PROBE, TARGETS / "replay.c", TARGETS / "embedded_logs.c"]
        key = hash_of([*own, *shared_by_tests(), *sorted(LIBRARY.rglob("*.h"))])
        program = self.program(name)
        stamp = program.with_suffix(".hash")
        if program.exists() and stamp.exists() and stamp.read_text() == key:
            return None
        command = self.linking(own, program)
        if not compiled(command):
            return command
        stamp.write_text(key)
        return None

    def program(self, name: str) -> Path:
        return self.programs / name

    def check(self) -> None:
        """Checks that the unchanged library passes all tests, and measures their time."""
        for name in self.tests:
            ran = self.ran(name, self.folder, None)
            if not ran.good:
                raise RuntimeError(f"the unchanged library fails the unit test {name}: {ran.why}")
            self.seconds[name] = ran.seconds
        golden = GOLDEN.read_text().split()[0]
        if f"replay {golden}" not in self.probe_output:
            raise RuntimeError(f"the library built here does not give the golden hash:\n{self.probe_output}")

    # ---------------------------------------------------------------------------------------------------------- mutants

    def build(self, mutant: Mutant, folder: Path) -> str:
        """Builds the mutant's libgoe.so in the folder. Returns "made"; or "no code" if a compiler refuses it, "same
        code" if its code equals the library's."""
        text = apply(mutant, (LIBRARY / mutant.file).read_text(encoding="ascii"))
        instead: dict[str, Path] = {}
        same = True
        tree = folder / "lib"
        header = mutant.file.endswith(".h")
        if header:
            shutil.copytree(LIBRARY, tree, dirs_exist_ok=True)
            (tree / mutant.file).write_text(text)
        for file in self.users_of(mutant) if header else [mutant.file]:
            made = folder / (file.replace("/", "_") + ".o")
            source = tree / file if header else folder / Path(file).name
            if not header:
                source.write_text(text)
            command = self.command(source, made)
            if header:
                command = [word.replace(f"-I{LIBRARY}", f"-I{tree}") for word in command]
            if not compiled(command):
                return "no code"
            same = same and made.read_bytes() == self.object_of(file).read_bytes()
            instead[file] = made
        if same:
            return "same code"
        self.link(folder, instead)
        if header:
            self.rebuild_own_test(mutant, folder, tree)
        return "made"

    def rebuild_own_test(self, mutant: Mutant, folder: Path, tree: Path) -> None:
        """A header's test calls its functions in the test program, which is therefore rebuilt."""
        name = stem(mutant)
        if name in self.tests:
            command = self.linking([C_TESTS / f"test_{name}.c"], folder / name)
            compiled([word.replace(f"-I{LIBRARY}", f"-I{tree}") for word in command])

    def users_of(self, mutant: Mutant) -> list[str]:
        """For a header's function: sources that include the header and use it, directly or through the header."""
        names = {mutant.function}
        inline = [(name, body) for file in sources() if file.endswith(".h") for name, body in inline_functions(file)]
        for _ in inline:
            names |= {name for name, body in inline if names & set(re.findall(r"\w+", body))}
        users = sorted(self.users.get(mutant.file, ()))
        return [file for file in users if names & set(re.findall(r"\w+", (LIBRARY / file).read_text()))]

    def order(self, mutant: Mutant) -> list[str]:
        """The tests with the file's name first, then by their time; the hash last."""
        own_name = stem(mutant)

        def place(name: str) -> tuple[int, float]:
            own = 0 if name == own_name else 1 if own_name in name and self.seconds[name] < 0.5 else 2
            return (3 if name == BITS else own), self.seconds[name]

        wanted = [name for name in self.tests if mutant.file.startswith(ABOUT.get(name, ("",)))]
        return sorted(wanted, key=place)

    def limit(self, name: str) -> float:
        return SPARE * self.seconds.get(name, 10.0) + SPARE_S

    def ran(self, name: str, folder: Path, seconds: float | None) -> Ran:
        """Runs a program with the library in the folder, within this processor time."""

        def bounded() -> None:
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if seconds is not None:
                resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))

        program = folder / name if (folder / name).exists() else self.program(name)
        environment = {**os.environ, **SHORTER, "LD_LIBRARY_PATH": str(folder)}
        with tempfile.TemporaryFile() as output:
            before = time.monotonic()
            process = subprocess.Popen(
                [str(program)], stdout=output, stderr=output, cwd=ROOT, env=environment, preexec_fn=bounded
            )
            used = 0.0
            try:
                status, used = wait(process, before + WALL_S)
            finally:
                if process.returncode is None:
                    process.kill()
                    process.wait()
            output.seek(0)
            text = output.read(200_000).decode("utf-8", "replace")
        if status == 0:
            return Ran(True, used, text)
        failed = re.search(r":(\d+):(\w+):FAIL", text)
        why = f"{failed[2]}, line {failed[1]}" if failed else f"ended by signal {-status}" if status < 0 else "failed"
        return Ran(False, used, text, "hangs" if status in (-24, -9) else why)


def wait(process: subprocess.Popen[bytes], until: float) -> tuple[int, float]:
    """Exit status and seconds of processor time."""
    while True:
        found, status, used = os.wait4(process.pid, os.WNOHANG)
        if found:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, used.ru_utime + used.ru_stime
        if time.monotonic() > until:
            return -9, used.ru_utime
        time.sleep(0.001)
