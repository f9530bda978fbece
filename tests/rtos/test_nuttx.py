"""port/nuttx without NuttX: its makefiles, CMake file, Kconfig and programs, with stand-ins for the tree's files."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from kconfig_of import NUTTX, ROOT, apply, parse, write
from scripted import assert_flown

STAND_IN = Path(__file__).resolve().parent / "nuttx"
SECONDS = 1800  # guard against a hang
BOTH = (
    "CONFIG_GOE=y", "CONFIG_GOE_SENSOR_LOOP=y", "CONFIG_GOE_GOLDEN_BITS=y", "CONFIG_GOE_MAVLINK=y", "CONFIG_LIBM=y",
)  # fmt: skip


def run(*words: str | Path) -> str:
    done = subprocess.run(
        [str(word) for word in words], env=os.environ, stdin=subprocess.DEVNULL, capture_output=True, text=True,
        timeout=SECONDS,
    )  # fmt: skip
    assert done.returncode == 0, f"{words}: exit status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def config(folder: Path, *assignments: str) -> None:
    parsed = parse(NUTTX, folder)
    apply(parsed, assignments)
    write(parsed, folder)


def checkout(folder: Path) -> Path:
    """apps/ with a checkout linked into it. make leaves its objects in port/nuttx, so that folder is a copy."""
    for part in ("lib", "port/flight", "port/mavlink", "port/sqrtf", "port/examples/scripted_flight", "tests/targets"):
        (folder / "goe" / part).parent.mkdir(parents=True, exist_ok=True)
        (folder / "goe" / part).symlink_to(ROOT / part)
    shutil.copytree(NUTTX, folder / "goe" / "port" / "nuttx", ignore=shutil.ignore_patterns("*.o", ".*", "Make.dep"))
    apps = folder / "apps"
    shutil.copytree(STAND_IN / "apps", apps)
    (apps / "external").symlink_to(folder / "goe" / "port" / "nuttx")
    return apps


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Both programs, built by make."""
    folder = tmp_path_factory.mktemp("nuttx")
    apps = checkout(folder)
    config(apps, *BOTH)
    flags = "STAND_IN_CFLAGS=-O1 -DGOE_SQRTF_IN_INTEGERS"
    run("make", "-j2", "-C", apps / "external", f"APPDIR={apps}", flags)
    return apps / "external"


def test_sensor_loop(programs: Path) -> None:
    text = run(programs / "goe_sensor_loop", "-f")
    assert_flown(text)
    assert "\nimages 135, dropped 0\n" in text


def test_golden_bits(programs: Path) -> None:
    text = run(programs / "goe_golden_bits")
    (golden,) = (ROOT / "tests" / "targets" / "golden_hash.txt").read_text().split()
    (flight,) = (ROOT / "tests" / "targets" / "flight_hash.txt").read_text().split()
    assert re.fullmatch(rf"replay {golden} images \d+ self_check 0x00\nflight {flight} frames \d+\n", text)


def test_every_source_is_compiled(programs: Path) -> None:
    folders = ("lib", "port/flight", "port/mavlink", "port/sqrtf", "port/examples/scripted_flight")
    wanted = {file.stem for folder in folders for file in (ROOT / folder).rglob("*.c")}
    assert wanted <= {file.stem for file in programs.glob("*.o")}


def test_make_leaves_out_parts(tmp_path: Path) -> None:
    apps = checkout(tmp_path)
    off = ("GOE_WITH_FILTER", "GOE_WITH_HAZARD")
    config(apps, "CONFIG_GOE=y", *(f"CONFIG_{name}=n" for name in off), "CONFIG_GOE_WINDOW_MAX=5")
    (tmp_path / "print.mk").write_text(
        "include $(APPDIR)/external/Makefile\nprint:\n\t@echo $(CSRCS)\n\t@echo $(CFLAGS)\n"
    )
    sources, flags = run("make", "-f", tmp_path / "print.mk", f"APPDIR={apps}", "print").splitlines()
    assert set(sources.split()) == {file.name for file in (ROOT / "lib").rglob("*.c")}
    assert "-DGOE_WITH_WINDOW=1 -DGOE_WITH_FILTER=0 -DGOE_WITH_TARGET_MOTION=0 -DGOE_WITH_HAZARD=0" in flags
    assert "-DGOE_WINDOW_MAX=5" in flags and "GOE_FLIGHT_SLOTS" not in flags


def test_make_does_not_vectorise_where_helium_would_flush(tmp_path: Path) -> None:
    apps = checkout(tmp_path)
    for value in "yn":
        config(apps, "CONFIG_GOE=y", f"CONFIG_ARM_HAVE_MVE={value}")
        assert ("-fno-tree-vectorize" in commands_of_make(apps)["goe_estimator"]) == (value == "y")


def test_make_renames_main_in_modules_too(tmp_path: Path) -> None:
    """A kernel build compiles with CELFFLAGS; three functions main() would not link."""
    apps = checkout(tmp_path)
    config(apps, *BOTH, "CONFIG_BUILD_KERNEL=y")
    commands = commands_of_make(apps)
    assert all("-fvisibility=hidden" in command for command in commands.values())
    assert "-Dmain=goe_replay_main" in commands["replay_main"]
    assert "-Dmain=goe_flight_main" in commands["flight_main"]
    assert "-Dmain" not in commands["goe_golden_bits_main"] + commands["goe_estimator"]


def commands_of_make(apps: Path) -> dict[str, list[str]]:
    """Words of the command that compiles each file, by the file's stem."""
    text = run("make", "-n", "-B", "-C", apps / "external", f"APPDIR={apps}", "STAND_IN_CFLAGS=-O0")
    commands = [line.split() for line in text.splitlines() if " -c " in line]
    return {Path(words[-1]).stem: words for words in commands}


def meaning_of(words: list[str]) -> set[str]:
    """Definitions, options and forced includes of a command."""
    return {word for word in words if word.startswith(("-D", "-f"))} | {
        f"include {Path(word).resolve()}" for before, word in zip(words, words[1:]) if before == "-include"
    }


@pytest.mark.parametrize("helium", "yn")
def test_cmake_agrees_with_make(helium: str, tmp_path: Path) -> None:
    """The same files with the same flags."""
    apps = checkout(tmp_path)
    config(apps, *BOTH, f"CONFIG_ARM_HAVE_MVE={helium}")
    by_make = commands_of_make(apps)
    by_cmake = {
        Path(entry["file"]).stem: entry["command"].split()
        for entry in json.loads((configured(apps, tmp_path / "build") / "compile_commands.json").read_text())
    }
    assert set(by_cmake) == set(by_make)
    for stem, words in by_cmake.items():
        assert meaning_of(words) == meaning_of(by_make[stem]), stem
        assert {"-ffp-contract=off", "-DGOE_FLIGHT_SLOTS=4", "-Dsqrtf=goe_sqrtf"} <= meaning_of(words)


@pytest.mark.release
def test_cmake_passes_the_needs_of_programs_on(tmp_path: Path) -> None:
    config(tmp_path, "CONFIG_GOE=y", "CONFIG_GOE_SENSOR_LOOP=y")
    tree = configured(tmp_path, tmp_path / "build")
    run("cmake", "--build", tree, "-j", "2", "--target", "goe_sensor_loop")
    assert_flown(run(tree / "external" / "goe_sensor_loop", "-f"))


def configured(folder: Path, tree: Path) -> Path:
    run(
        "cmake", "-G", "Ninja", "-S", STAND_IN / "cmake", "-B", tree, f"-DSTAND_IN_CONFIG={folder}",
        f"-DGOE_APP={NUTTX}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DCMAKE_C_FLAGS=-O0",
    )  # fmt: skip
    return tree
