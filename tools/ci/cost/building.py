"""Builds a target's preset, or updates the build left by the tests."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bench.running import ROOT, emulated, output_of

OBJECTS = "lib/CMakeFiles/goe.dir"  # of the library, in a build's folder
EXTRA_OUTPUT = ("-fstack-usage", "-fcallgraph", "-g1")  # options that change no figure


@dataclass
class Build:
    """A built preset."""

    preset: str
    tree: Path
    board: str
    tool_prefix: str  # of the binary utilities
    compiler: str  # first line of its --version
    command: list[str]  # compiler and flags of a file of the library, without input and output
    emulator: list[str]

    def tool(self, name: str, *arguments: str | Path) -> str:
        return output_of([self.tool_prefix + name, *arguments])

    def image(self, kind: str) -> Path:
        return self.tree / "tests" / "targets" / f"{kind}_{self.board}.elf"

    def map_file(self) -> Path:
        return self.tree / "tests" / "targets" / f"replay_{self.board}.map"

    def library_files(self, ending: str) -> list[Path]:
        """Files that the compiler wrote for the library's sources, also in subfolders."""
        return sorted((self.tree / OBJECTS).rglob(f"*.{ending}"))

    def module(self, path: Path) -> str:
        """The module of an object or another output of its source: <file>, or <folder>/<file>."""
        return (path.relative_to(self.tree / OBJECTS).parent / path.name.split(".")[0]).as_posix()

    def run_image(self, image: Path, *options: str) -> str:
        return emulated([*self.emulator[:-1], *options, self.emulator[-1], str(image)])


def library_command(commands: list[dict[str, str]]) -> list[str]:
    """Compiler and flags of the library's files, from a build's compile_commands.json."""
    for entry in commands:
        words = entry["command"].split()
        at = words.index("-o")
        if words[at + 1].startswith(f"{OBJECTS}/"):
            return words[:at]
    raise ValueError("compile_commands.json names no file of the library")


def build(preset: str, folder: Path) -> Build:
    """Builds the replay and the stack programs of a preset, in a subfolder of that name."""
    tree = folder / preset
    cache_file = tree / "CMakeCache.txt"
    if not cache_file.exists():
        output_of(["cmake", "--preset", preset, "-B", tree, "-DGOE_TARGET_TESTS=none"], ROOT)
    elif cache_file.stat().st_mtime < (ROOT / "CMakePresets.json").stat().st_mtime:
        output_of(["cmake", "--preset", preset, "-B", tree], ROOT)
    cache = cache_file.read_text(encoding="utf-8")
    board = re.search(r"^GOE_TARGET_BOARD:INTERNAL=(.*)$", cache, re.MULTILINE)
    qemu = re.search(r"^GOE_QEMU_COMMAND:INTERNAL=(.*)$", cache, re.MULTILINE)
    assert board and qemu, "the toolchain file must define how to run images"
    output_of(["cmake", "--build", tree, "--target", f"replay_{board.group(1)}", f"stack_{board.group(1)}"])
    command = library_command(json.loads((tree / "compile_commands.json").read_text(encoding="utf-8")))
    return Build(
        preset=preset,
        tree=tree,
        board=board.group(1),
        tool_prefix="riscv64-unknown-elf-" if preset.startswith("rv32") else "arm-none-eabi-",
        compiler=output_of([command[0], "--version"]).splitlines()[0],
        command=command,
        emulator=qemu.group(1).split(";"),
    )


def shown_flags(command: Iterable[str]) -> str:
    """The flags that affect the figures: no extra outputs, no machine's folders."""
    shown = (w for w in command if re.match(r"-(O|m|f|std=)", w) and not w.startswith(EXTRA_OUTPUT))
    return " ".join(w for w in shown if not re.match(r"-f\w+-prefix-map=", w))
