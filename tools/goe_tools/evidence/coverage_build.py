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
    tests: str  # pattern of the names in ctest; all have the label unit
    library: str  # archive that the sources are compiled into, in the build


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


def build(groups: Sequence[Group], jobs: int) -> None:
    """The programs of the groups' tests and no others. A test c_<name> or <name> is run by the program test_<name>."""
    programs: set[str] = set()
    for group in groups:
        command = ["ctest", "--test-dir", BUILD, "-L", "^unit$", "-R", group.tests, "--show-only=json-v1"]
        names = [str(test["name"]) for test in json.loads(_run(command))["tests"]]
        programs |= {"test_" + (name[2:] if name.startswith("c_") else name) for name in names}
    _run(["cmake", "--build", BUILD, "-j", str(jobs), "--target", *sorted(programs)])


def run_tests(group: Group, jobs: int) -> Path:
    """Runs the group's tests. Returns the merged profile."""
    name = group.folder.replace("/", "_")
    raw = PROFILES / name
    merged = PROFILES / f"{name}.profdata"
    shutil.rmtree(raw, ignore_errors=True)
    raw.mkdir(parents=True)
    command = ["ctest", "--test-dir", BUILD, "-L", "^unit$", "-R", group.tests, "-j", str(jobs), "--output-on-failure"]
    _run([*command, "--no-tests=error"], profile=raw / "%p.profraw")
    _run(["llvm-profdata-19", "merge", "--sparse", "-o", merged, *sorted(raw.glob("*.profraw"))])
    shutil.rmtree(raw)
    return merged


def export(group: Group, profile: Path) -> dict[str, Any]:
    """llvm-cov's counts of the group's sources."""
    command = ["llvm-cov-19", "export", "--instr-profile", profile, BUILD / group.library, "--sources"]
    told: dict[str, Any] = json.loads(_run([*command, ROOT / group.folder]))["data"][0]
    return told
