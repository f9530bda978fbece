"""Programs for this machine and images for the Cortex-M4F under QEMU."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from ..count_plugin import build_plugin  # noqa: F401 - measure imports it from here
from ..running import ROOT, LedgerError, emulated, output_of  # noqa: F401 - measure imports them from here

PEERS = ROOT / "tools" / "peers"
FRAME = PEERS / "frame"
LIBRARY = ROOT / "lib"
BARE_METAL = ROOT / "port" / "baremetal"
FLAG_SETS = {"own": ("-O2", "-ffp-contract=off", "-fno-math-errno"), "best": ("-O3", "-ffast-math")}
BEST_HOST_FLAGS = ("-march=native",)  # in addition, on the host
STRICT = ("-Wall", "-Wextra", "-Werror")  # for sources of this repository
C = ("-std=gnu11",)
CPP = ("-std=c++17", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics")
M4F = ("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
M4F_MEMORY = (
    "ROM_ORIGIN=0", "ROM_LENGTH=0x400000", "RAM_ORIGIN=0x20000000", "RAM_LENGTH=0x400000", "STACK_LENGTH=0x8000",
)  # fmt: skip
EMULATOR = (
    "qemu-system-arm", "-M", "mps2-an386", "-nographic", "-monitor", "none", "-serial", "none",
    "-semihosting-config", "enable=on,target=native",
)  # fmt: skip
TARGET_TOOLS = ("arm-none-eabi-gcc", "arm-none-eabi-g++", "qemu-system-arm")


def missing_tool() -> str | None:
    """The first missing program of the emulated part."""
    return next((tool for tool in TARGET_TOOLS if shutil.which(tool) is None), None)


def library_sources() -> tuple[Path, ...]:
    return tuple(sorted(LIBRARY.rglob("*.c")))


def library_includes() -> tuple[str, ...]:
    """Include paths, also of the folders with private headers."""
    return tuple(f"-I{folder}" for folder in sorted({path.parent for path in LIBRARY.rglob("*.h")}))


@dataclass(frozen=True)
class Step:
    """A command that makes one file."""

    target: Path
    command: tuple[str, ...]


class Builder:
    """Collects the files to compile and link, each once, and then makes them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.compiling: dict[Path, Step] = {}
        self.linking: dict[Path, Step] = {}

    def objects(self, role: str, compiler: str, flags: Iterable[str], sources: Iterable[Path]) -> list[str]:
        """Objects of sources. role: a folder name that identifies them in a linker map."""
        words = (compiler, *flags)
        digest = hashlib.sha256("\0".join(words).encode()).hexdigest()[:12]
        folder = self.folder / role / digest
        folder.mkdir(parents=True, exist_ok=True)
        made = []
        for source in sources:
            target = folder / f"{source.parent.name}_{source.name}.o"
            self.compiling[target] = Step(target, (*words, "-c", str(source), "-o", str(target)))
            made.append(str(target))
        return made

    def program(self, name: str, compiler: str, words: Iterable[str]) -> Path:
        target = self.folder / name
        self.linking[target] = Step(target, (compiler, *words, "-o", str(target)))
        return target

    def make(self) -> None:
        for steps in (self.compiling, self.linking):
            run_all([step for step in steps.values() if not step.target.exists()])


def run_all(steps: list[Step]) -> None:
    """Runs the steps on all cores."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        running = [pool.submit(output_of, step.command) for step in steps]
        try:
            for one in tqdm(running, unit="file", leave=False, disable=not sys.stderr.isatty()):
                one.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def own_program(
    builder: Builder, name: str, sources: Iterable[Path], flags: Iterable[str], links: Iterable[str] = ()
) -> Path:
    """A program of this repository, with the library's flags; the builder makes it."""
    objects = builder.objects("program", "gcc", [*C, *STRICT, *FLAG_SETS["own"], *flags], sources)
    return builder.program(name, "gcc", [*links, *objects, "-lm"])
