"""Whether two builds of the same sources give the same bits: the archives of the library and the flight layer, with
gcc and clang, with debug information; the Python package's sdist; in long runs also its wheel.

The two builds differ in folder and depth, time, parallel jobs, umask, locale, time zone and the build folder's name;
those of the wheel not in umask, which scikit-build-core keeps as the modes of the files inside."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

from goe_tools.places import ROOT

from .parts import Amount, NotHereError
from .record import Result, Row

NEEDED = ("lib", "port", "CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md")  # of the tree
ARCHIVES = ("lib/libgoe.a", "port/flight/libgoe_flight.a")
COMPILERS = ("gcc", "clang-19")
EPOCH = "1700000000"  # SOURCE_DATE_EPOCH of the packages, s: arbitrary
SDIST = "import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))"
WHEEL = "import sys; from scikit_build_core.build import build_wheel; print(build_wheel(sys.argv[1]))"


@dataclass(frozen=True)
class Surroundings:
    """Properties that must not matter."""

    folder: str
    build: str
    jobs: int
    umask: int
    environment: tuple[tuple[str, str], ...]


FIRST = Surroundings("one", "build", 1, 0o022, (("LC_ALL", "C"), ("TZ", "UTC")))
SECOND = Surroundings(
    "another/deeper/tree", "made-elsewhere", 2, 0o077, (("LC_ALL", "C.UTF-8"), ("TZ", "Asia/Tokyo"), ("USER", "nobody"))
)


def copied(around: Surroundings, scratch: Path) -> Path:
    """Copies the sources to a new folder, with links followed and new times."""
    tree = scratch / around.folder
    tree.mkdir(parents=True)
    no_sources = shutil.ignore_patterns("build*", "target", "__pycache__", "*.egg-info", "dist")
    for name in NEEDED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, tree / name, copy_function=shutil.copyfile, ignore=no_sources)
        else:
            shutil.copyfile(source, tree / name)
    return tree


def _run(words: list[str], folder: Path, around: Surroundings) -> str:
    environment = {**os.environ, **dict(around.environment), "SOURCE_DATE_EPOCH": EPOCH}
    done = subprocess.run(
        ["sh", "-c", f'umask {around.umask:o}; exec "$@"', "sh", *words], cwd=folder, env=environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise ValueError(f"{' '.join(words)}: {(done.stdout + done.stderr).strip()[-500:]}")
    return done.stdout


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def archives(tree: Path, around: Surroundings, compiler: str) -> dict[str, str]:
    """SHA-256 of each archive. -g: debug information may contain folder names."""
    build = tree.parent / f"{around.build}-{compiler}"
    _run(
        [
            "cmake", "-S", str(tree), "-B", str(build), "-G", "Ninja", f"-DCMAKE_C_COMPILER={compiler}",
            "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS=-g", "-DGOE_BUILD_HOST=OFF", "-DGOE_BUILD_TESTS=OFF",
        ],
        tree,
        around,
    )  # fmt: skip
    _run(["cmake", "--build", str(build), "-j", str(around.jobs), "--target", "goe", "goe_flight"], tree, around)
    return {name: digest(build / name) for name in ARCHIVES}


def package(tree: Path, around: Surroundings, program: str, out: str) -> str:
    place = tree.parent / out
    name = _run([sys.executable, "-c", program, str(place)], tree / "port" / "python", around).split()[-1]
    return digest(place / name)


def same(what: str, first: str, second: str) -> Row:
    figure = f"same, {first[:16]}" if first == second else f"{first[:16]} and {second[:16]}"
    return Row(what, figure, "the same bits", first == second)


def run(amount: Amount) -> Result:
    compilers = [name for name in COMPILERS if shutil.which(name)]
    if not compilers or not all(map(shutil.which, ("cmake", "ninja"))):
        raise NotHereError("cmake, ninja and gcc or clang-19")
    report = [f"{around.folder}: {around}" for around in (FIRST, SECOND)]
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as name:
        trees = []
        for around in (FIRST, SECOND):
            trees.append((copied(around, Path(name)), around))
            time.sleep(1.1)  # makes time stamps of whole seconds differ
        for compiler in compilers:
            first, second = (archives(tree, around, compiler) for tree, around in trees)
            rows += [same(f"{compiler}: {Path(one).name}", first[one], second[one]) for one in ARCHIVES]
        rows.append(same("sdist of the Python package", *(package(*tree, SDIST, "sdist") for tree in trees)))
        if amount.long:
            same_umask = [(tree, replace(around, umask=FIRST.umask)) for tree, around in trees]
            wheels = (package(*tree, WHEEL, "wheel") for tree in same_umask)
            rows.append(same("wheel of the Python package, umask 022", *wheels))
    report += [f"{row.what}: {row.figure}" for row in rows]
    return Result(rows, "\n".join(report))
