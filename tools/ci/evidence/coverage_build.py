"""An instrumented build of the unit tests, their run, and the counts of llvm-cov."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from goe_tools.places import ROOT

from .parts import NotHereError

PRESET = "coverage"
BUILD = ROOT / ".cache" / "evidence" / "coverage"  # the folder in CMakePresets.json
PROFILES = ROOT / ".cache" / "evidence" / "coverage-profiles"
SAFETY = "safety"  # in the names of the tests with arbitrary input
TOOLS = ("cmake", "ninja", "clang-19", "llvm-profdata-19", "llvm-cov-19")


class BuildError(ValueError):
    """A command of the build or a test failed; contains the end of its output."""


@dataclass(frozen=True)
class Group:
    """Tests that count for the sources of one folder."""

    folder: str  # of the sources, in the project
    library: str  # with these sources: its target in the build
    tests: str  # folder of the tests' programs, in the build
    prefix: str  # of the tests' names in ctest; the programs are test_<name>, all with the label unit
    cut: bool = False  # ... without the prefix


def _run(command: Sequence[str | Path], **environment: str) -> str:
    ended = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )
    if ended.returncode:
        tail = "\n".join((ended.stdout + ended.stderr).splitlines()[-40:])
        raise BuildError(f"{' '.join(map(str, command[:8]))}: exit status {ended.returncode}\n{tail}")
    return ended.stdout


def need_tools() -> None:
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        raise NotHereError(f"not installed: {', '.join(missing)}")
    resources = Path(_run(["clang-19", "--print-resource-dir"]).strip())
    if not any(resources.rglob("libclang_rt.profile*")):
        raise NotHereError("not installed: clang's library for profiles (libclang-rt-19-dev)")


def configure() -> None:
    unity = os.environ.get("UNITY_DIR")
    _run(["cmake", "--preset", PRESET, "-DGOE_BUILD_TESTS=ON", *([f"-DUNITY_DIR={unity}"] if unity else [])])


def _select(group: Group, but: str = "") -> list[str]:
    return ["ctest", "--test-dir", str(BUILD), "-L", "^unit$", "-R", f"^{group.prefix}{but}"]


def programs(group: Group) -> list[str]:
    """The programs of the group's tests."""
    tests = json.loads(_run([*_select(group), "--show-only=json-v1"]))["tests"]
    names = [str(test["name"]) for test in tests]
    return sorted("test_" + (name[len(group.prefix) :] if group.cut else name) for name in names)


def build(targets: Iterable[str], jobs: int) -> None:
    _run(["cmake", "--build", BUILD, "-j", str(jobs), "--target", *sorted(set(targets))])


def _profile(name: str, command: Sequence[str | Path], **environment: str) -> Path:
    """Runs a command that leaves profiles, and merges them."""
    raw = PROFILES / name
    shutil.rmtree(raw, ignore_errors=True)
    raw.mkdir(parents=True)
    _run(command, LLVM_PROFILE_FILE=str(raw / "%p.profraw"), **environment)
    merged = _merge(name, sorted(raw.glob("*.profraw")))
    shutil.rmtree(raw)
    return merged


def _merge(name: str, profiles: Sequence[Path]) -> Path:
    merged = PROFILES / f"{name}.profdata"
    # A program killed by a test may leave an incomplete profile, which is left out.
    _run(["llvm-profdata-19", "merge", "--sparse", "--failure-mode=all", "-o", merged, *profiles])
    return merged


def _export(profile: Path, objects: Sequence[str], folder: str) -> dict[str, Any]:
    first, *more = [str(BUILD / name) for name in objects]
    command = ["llvm-cov-19", "export", "--instr-profile", profile, first, *(f"--object={name}" for name in more)]
    export: dict[str, Any] = json.loads(_run([*command, "--sources", ROOT / folder]))["data"][0]
    return export


def _objects(group: Group) -> list[str]:
    """The objects of the library. Not its archive, in which llvm-cov misreads members at odd offsets."""
    sources = sorted((ROOT / group.folder).rglob("*.c"))
    folder = f"{group.folder}/CMakeFiles/{group.library}.dir"
    return [f"{folder}/{source.relative_to(ROOT / group.folder).as_posix()}.o" for source in sources]


def count_tests(group: Group, jobs: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Runs the tests. Returns llvm-cov's counts of the sources, including copies that a test compiles itself.

    First with all tests, then without the safety tests, which only check that arbitrary input does no harm.
    """
    name = group.folder.replace("/", "_")
    how = ["-j", str(jobs), "--output-on-failure", "--no-tests=error"]
    judging = _profile(f"{name}_judging", [*_select(group), "-E", SAFETY, *how])
    every = _merge(name, [judging, _profile(f"{name}_safety", [*_select(group, but=f".*{SAFETY}"), *how])])
    objects = [*_objects(group), *(f"{group.tests}/{name}" for name in programs(group))]
    return _export(every, objects, group.folder), _export(judging, objects, group.folder)


@dataclass(frozen=True)
class Readers:
    """Programs for the host, run by Python tests."""

    folder: str  # of the sources, in the project, and of the programs, in the build
    programs: dict[str, str]  # by the environment variable that the tests read
    tests: tuple[str, ...]  # files or folders


def count_readers(readers: Readers) -> dict[str, Any]:
    places = {variable: f"{readers.folder}/{name}" for variable, name in readers.programs.items()}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", "tools/pyproject.toml"]
    named = {variable: str(BUILD / place) for variable, place in places.items()}
    counting = ["-k", "not full_disk"]  # a program that cannot write files cannot write its counts either
    profile = _profile(readers.folder, [*command, *counting, *readers.tests], **named)
    return _export(profile, list(places.values()), readers.folder)
