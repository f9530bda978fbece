"""port/nuttx without NuttX: its makefiles, CMake file, Kconfig and programs, among what stands in for the tree's."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from kconfig_of import NUTTX, ROOT, apply, parse, write

STAND_IN = Path(__file__).resolve().parent / "nuttx"
SECONDS = 300
BOTH = ("CONFIG_GOE=y", "CONFIG_GOE_GOLDEN_BITS=y", "CONFIG_GOE_MAVLINK=y", "CONFIG_LIBM=y")


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
    """apps/ with a checkout linked into it. make leaves its objects in port/nuttx, so that is a copy."""
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
    """Both, built by make."""
    folder = tmp_path_factory.mktemp("nuttx")
    apps = checkout(folder)
    config(apps, *BOTH)
    flags = "STAND_IN_CFLAGS=-O1 -DGOE_SQRTF_IN_INTEGERS"
    run("make", "-j2", "-C", apps / "external", f"APPDIR={apps}", flags)
    return apps / "external"


def test_sensor_loop(programs: Path) -> None:
    text = run(programs / "goe_sensor_loop", "-f")
    (shown,) = re.findall(r"^```text\n(.*?)^```$", (NUTTX / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    flown = [line for line in text.splitlines() if " s: " in line]
    assert len(flown) > 10
    assert flown == [line for line in shown.splitlines() if " s: " in line]
    assert "self-check 0x00" in text and "\nimages 149; " in text


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
    off = ("GOE_WITH_REFINED", "GOE_WITH_HAZARD")
    config(apps, "CONFIG_GOE=y", *(f"CONFIG_{name}=n" for name in off), "CONFIG_GOE_WINDOW_MAX=5")
    (tmp_path / "print.mk").write_text(
        "include $(APPDIR)/external/Makefile\nprint:\n\t@echo $(CSRCS)\n\t@echo $(CFLAGS)\n"
    )
    sources, flags = run("make", "-f", tmp_path / "print.mk", f"APPDIR={apps}", "print").splitlines()
    assert set(sources.split()) == {file.name for file in (ROOT / "lib").rglob("*.c")}
    assert "-DGOE_WITH_WINDOW=1 -DGOE_WITH_REFINED=0 -DGOE_WITH_MOVERS=0 -DGOE_WITH_HAZARD=0" in flags
    assert "-DGOE_WINDOW_MAX=5" in flags and "GOE_FLIGHT_SLOTS" not in flags


def test_cmake_agrees_with_make(programs: Path, tmp_path: Path) -> None:
    """The same files with the same flags; and the sensor loop links."""
    config(tmp_path, *BOTH)
    tree = tmp_path / "build"
    run(
        "cmake", "-G", "Ninja", "-S", STAND_IN / "cmake", "-B", tree, f"-DSTAND_IN_CONFIG={tmp_path}",
        f"-DGOE_APP={NUTTX}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DCMAKE_C_FLAGS=-O0",
    )  # fmt: skip
    commands = {
        Path(entry["file"]).stem: entry["command"] for entry in json.loads((tree / "compile_commands.json").read_text())
    }
    assert set(commands) == {file.stem for file in programs.glob("*.o")}
    for stem, command in commands.items():
        assert "-ffp-contract=off" in command and "-DGOE_FLIGHT_SLOTS=4" in command and "-DGOE_WITH_HAZARD=1" in command
        in_library = not ((ROOT / "port" / "examples" / "scripted_flight" / f"{stem}.c").exists() or "main" in stem or "replay" in stem
                          or stem == "embedded_logs")  # fmt: skip
        assert ("-Dsqrtf=goe_sqrtf" in command) == in_library, stem
    run("cmake", "--build", tree, "-j", "2", "--target", "goe_sensor_loop")
    assert "\nimages 149; " in run(tree / "external" / "goe_sensor_loop", "-f")
