"""An instrumented build of the unit tests, their run, and what llvm-cov counts in it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..places import ROOT
from .parts import NotHereError

PRESET = "coverage"
BUILD = ROOT / ".cache" / "evidence" / "coverage"  # as CMakePresets.json names it
PROFILES = ROOT / ".cache" / "evidence" / "coverage-profiles"
TOOLS = ("cmake", "ninja", "clang-19", "llvm-profdata-19", "llvm-cov-19")


class BuildError(ValueError):
    """A command of the build or a test failed; holds the end of what it wrote."""


@dataclass(frozen=True)
class Group:
    """Tests that count for the sources of one folder."""

    folder: str  # of the sources, in the project
    archive: str  # that these are compiled into, in the build
    tests: str  # folder of the tests' programs, in the build
    prefix: str  # of the names of the tests in ctest; the programs are test_<name>, all have the label unit
    cut: bool = False  # ... without the prefix


def _run(command: Sequence[str | Path], profile: Path | None = None) -> str:
    environment = {**os.environ, **({"LLVM_PROFILE_FILE": str(profile)} if profile else {})}
    ended = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if ended.returncode:
        told = "\n".join((ended.stdout + ended.stderr).splitlines()[-40:])
        raise BuildError(f"{' '.join(map(str, command))}\n{told}")
    return ended.stdout


def need_tools() -> None:
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        raise NotHereError(f"not installed: {', '.join(missing)}")


def configure() -> None:
    unity = os.environ.get("UNITY_DIR")
    _run(["cmake", "--preset", PRESET, "-DGOE_BUILD_TESTS=ON", *([f"-DUNITY_DIR={unity}"] if unity else [])])


def _select(group: Group) -> list[str]:
    return ["ctest", "--test-dir", str(BUILD), "-L", "^unit$", "-R", f"^{group.prefix}"]


def programs(group: Group) -> list[str]:
    """Of the group's tests."""
    tests = json.loads(_run([*_select(group), "--show-only=json-v1"]))["tests"]
    names = [str(test["name"]) for test in tests]
    return sorted("test_" + (name[len(group.prefix) :] if group.cut else name) for name in names)


def build(groups: Sequence[Group], jobs: int) -> None:
    """The programs of the groups' tests and no others."""
    targets = sorted({program for group in groups for program in programs(group)})
    _run(["cmake", "--build", BUILD, "-j", str(jobs), "--target", *targets])


def run_tests(group: Group, jobs: int) -> Path:
    """Runs the group's tests. Returns the merged profile."""
    name = group.folder.replace("/", "_")
    raw = PROFILES / name
    merged = PROFILES / f"{name}.profdata"
    shutil.rmtree(raw, ignore_errors=True)
    raw.mkdir(parents=True)
    command = [*_select(group), "-j", str(jobs), "--output-on-failure", "--no-tests=error"]
    _run(command, profile=raw / "%p.profraw")
    _run(["llvm-profdata-19", "merge", "--sparse", "-o", merged, *sorted(raw.glob("*.profraw"))])
    shutil.rmtree(raw)
    return merged


def export(group: Group, profile: Path) -> dict[str, Any]:
    """llvm-cov's counts of the group's sources: as they lie in the archive, and as a test compiles them for itself."""
    objects = [f"--object={BUILD / group.tests / program}" for program in programs(group)]
    command = ["llvm-cov-19", "export", "--instr-profile", profile, BUILD / group.archive, *objects]
    told: dict[str, Any] = json.loads(_run([*command, "--sources", ROOT / group.folder]))["data"][0]
    return told
