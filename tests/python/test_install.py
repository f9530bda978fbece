"""Builds by other projects: a plain configure of a fresh copy, and the files that cmake --install writes."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"


def run(*command: object, **options: object) -> str:
    done = subprocess.run(
        [str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def test_a_plain_configure_needs_nothing(tmp_path: Path) -> None:
    """Without Unity a plain configure leaves the tests out, with a message. If they are requested, their absence is an
    error."""
    copy = tmp_path / "goe"
    copy.mkdir()
    for name in ("lib", "port", "sim_host", "tests"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("target", "__pycache__"))
    for name in ("CMakeLists.txt", "CMakePresets.json", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, copy)
    without = "-DCMAKE_DISABLE_FIND_PACKAGE_unity=ON"
    said = run("cmake", "-S", copy, "-B", tmp_path / "build", without)
    assert "The tests are left out: no Unity test framework. tools/setup.sh installs" in said
    done = subprocess.run(
        ["cmake", "-S", copy, "-B", tmp_path / "requested", without, "-DGOE_BUILD_TESTS=ON"],
        capture_output=True,
        text=True,
    )
    assert done.returncode != 0 and "The Unity test framework is not here" in done.stderr


@pytest.mark.skipif(not (BUILD / "cmake_install.cmake").exists(), reason=f"{BUILD} is not configured")
def test_the_programs_are_installed(replay: Path, tmp_path: Path) -> None:
    run("cmake", "--install", BUILD, "--prefix", tmp_path)
    for name in ("goe_replay", "goe_sim", "goe_campaign", "goe_avoid"):
        assert os.access(tmp_path / "bin" / name, os.X_OK), name
    rows = run(tmp_path / "bin" / "goe_replay", ROOT / "tests" / "data" / "corner").splitlines()
    assert rows[0].startswith("t_s,id,status") and len(rows) > 10
