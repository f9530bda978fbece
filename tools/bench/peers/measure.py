"""Figures of one solver: on this machine and on the emulated Cortex-M4F."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .build import (
    BARE_METAL,
    BEST_HOST_FLAGS,
    CPP,
    EMULATOR,
    FLAG_SETS,
    FRAME,
    M4F,
    M4F_MEMORY,
    STRICT,
    Builder,
    C,
    LedgerError,
    emulated,
    output_of,
)
from .job import Job, Peer

FRAME_FLAGS = ("-O2", "-ffp-contract=off", "-Wno-missing-braces")  # the same for all; cases are flat lists of numbers
FRAME_ROLE, SOLVER_ROLE = "frame", "solver"
PORT = tuple(BARE_METAL / name for name in ("semihosting.c", "start_arm.c", "c_library.c"))
NOTHING = Peer("nothing", FRAME / "peer_none.c", "")


@dataclass
class Result:
    """Figures of one solver with one set of flags over one group; None: not run there."""

    nanoseconds: float | None = None
    instructions: list[int] | None = None  # of each case
    stack: int | None = None
    code: int | None = None
    errors: tuple[float | None, ...] = ()  # the worse of both machines


@dataclass(frozen=True)
class Programs:
    """Programs that run a solver or show its size. image: None if it does not run on the target."""

    host: Path
    image: Path | None = None
    code: Path | None = None
    code_of_nothing: Path | None = None


class Bench:
    """A job on both machines. seconds: on the host, for each group. plugin: counts instructions; None: host only."""

    def __init__(self, builder: Builder, job: Job, seconds: float, plugin: Path | None) -> None:
        self.builder, self.job, self.seconds, self.plugin = builder, job, seconds, plugin
        self.includes = (f"-I{FRAME}", f"-I{job.folder}")
        self.cases = builder.folder / f"{job.folder.name}_cases.c"
        self.cases.write_text(job.cases_in_c(), encoding="utf-8")

    # ------------------------------------------------------------------------------------------------------ building

    def solver(self, prefix: str, peer: Peer, base: Iterable[str]) -> list[str]:
        cpp = peer.source.suffix == ".cpp"
        flags = [*base, *peer.flags]
        strict = STRICT if peer.all_ours else ()  # headers of others cause warnings when inlined
        own = [*flags, *peer.defines, *self.includes, *strict, *(CPP if cpp else C)]
        objects = self.builder.objects(SOLVER_ROLE, prefix + ("g++" if cpp else "gcc"), own, [peer.source])
        return objects + self.builder.objects(SOLVER_ROLE, prefix + "gcc", [*flags, *C], peer.more_sources)

    def frame(self, prefix: str, base: Iterable[str], sources: Iterable[Path]) -> list[str]:
        flags = [*base, *FRAME_FLAGS, *self.includes, *STRICT, *C]
        return self.builder.objects(FRAME_ROLE, prefix + "gcc", flags, sources)

    def host_program(self, peer: Peer, set_name: str) -> Path:
        native = BEST_HOST_FLAGS if set_name == "best" else ()
        objects = self.solver("", peer, [*FLAG_SETS[set_name], *native])
        objects += self.frame("", [f"-DPEER_SECONDS={self.seconds}"], [FRAME / "host_main.c"])
        objects += self.frame("", [], [FRAME / "console.c", self.cases])
        name = self.file_name(peer, set_name, "host")
        return self.builder.program(name, "g++", [*objects, *peer.libraries, "-lm"])

    def image(self, peer: Peer, set_name: str, main: str) -> Path:
        base = [*M4F, "-ffunction-sections", "-fdata-sections"]
        objects = self.solver("arm-none-eabi-", peer, [*base, *FLAG_SETS[set_name]])
        bare = [*base, "-DGOE_BARE_METAL", f"-I{BARE_METAL}"]
        objects += self.frame("arm-none-eabi-", bare, [FRAME / main, FRAME / "console.c", self.cases, *PORT])
        name = self.file_name(peer, set_name, main)
        link = ["-nostartfiles", f"-T{BARE_METAL / 'image.ld'}"]
        link += ["-Wl,-e,port_start,--gc-sections,--no-warn-rwx-segments", f"-Wl,-Map,{self.builder.folder / name}.map"]
        link += [f"-Wl,--defsym,{symbol}" for symbol in M4F_MEMORY]
        return self.builder.program(name, "arm-none-eabi-gcc", [*M4F, *link, *objects, "-lm"])

    def file_name(self, peer: Peer, set_name: str, main: str) -> str:
        return re.sub(r"\W+", "_", f"{self.job.folder.name} {peer.name} {set_name} {main}")

    def programs(self, peer: Peer, set_name: str) -> Programs:
        """Programs that the builder makes."""
        host = self.host_program(peer, set_name)
        if self.plugin is None or not peer.on_target:
            return Programs(host)
        images = (self.image(peer, set_name, "image_main.c"), self.image(peer, set_name, "code_main.c"))
        return Programs(host, *images, self.image(NOTHING, set_name, "code_main.c"))

    # ----------------------------------------------------------------------------------------------------- measuring

    def measure(self, peer: Peer, programs: Programs) -> list[Result]:
        """One result for each group."""
        text = output_of([programs.host])
        results = [Result(int(time) / 1000.0) for time in re.findall(r"^picoseconds (\d+)$", text, re.MULTILINE)]
        self.check(peer, text, results)
        if programs.image is not None and programs.code is not None and programs.code_of_nothing is not None:
            text, counts = self.count(programs.image)
            stacks = re.findall(r"^stack (\d+)$", text, re.MULTILINE)
            code = code_bytes(programs.code) - code_bytes(programs.code_of_nothing)
            for result, share, stack in zip(results, self.by_group(counts), stacks):
                result.instructions, result.stack, result.code = list(share), int(stack), code
            self.check(peer, text, results)
        return results

    def by_group(self, rows: list[int] | NDArray[np.float32]) -> list[list[int] | NDArray[np.float32]]:
        ends = np.cumsum([len(group.cases) for group in self.job.groups])
        if len(rows) != ends[-1]:
            raise LedgerError(f"{self.job.title}: {len(rows)} solves are reported, not {ends[-1]}")
        return [rows[end - len(group.cases) : end] for end, group in zip(ends, self.job.groups)]

    def check(self, peer: Peer, text: str, results: list[Result]) -> None:
        """Stores the errors of a program's printed answers."""
        lines = re.findall(r"^answer ([0-9a-f ]+)$", text, re.MULTILINE)
        words = np.array([[int(word, 16) for word in line.split()] for line in lines], dtype=np.uint32)
        for group, result, answers in zip(self.job.groups, results, self.by_group(words.view(np.float32))):
            errors = self.job.errors(peer, group, answers)
            before = result.errors or errors
            result.errors = tuple(worse(a, b) for a, b in zip(before, errors))

    def count(self, image: Path) -> tuple[str, list[int]]:
        """Output of an image, and the instructions of each solve."""
        ranges, counts = image.with_suffix(".ranges"), image.with_suffix(".counts")
        ranges.write_text(solver_ranges(image), encoding="utf-8")
        text = emulated([*EMULATOR, "-plugin", f"{self.plugin},map={ranges},out={counts}", "-kernel", str(image)])
        return text, [int(line.split()[1]) for line in counts.read_text(encoding="utf-8").splitlines()]


def worse(a: float | None, b: float | None) -> float | None:
    """The larger one; NaN is the largest."""
    return None if a is None or b is None else float(np.maximum(a, b))


def code_bytes(image: Path) -> int:
    """Code and constants."""
    return int(output_of(["arm-none-eabi-size", image]).splitlines()[1].split()[0])


def solver_ranges(image: Path) -> str:
    """The plugin's map: everything except the frame's code; peer_solve is the entry."""
    text = Path(f"{image}.map").read_text(encoding="utf-8")
    text = text[text.index("Linker script and memory map") :]
    pattern = re.compile(r"^ \.text[\w.$]*\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$", re.MULTILINE)
    entry = re.search(r"^(\w+) T peer_solve$", output_of(["arm-none-eabi-nm", image]), re.MULTILINE)
    assert entry, f"{image} solves nothing"
    solve = int(entry.group(1), 16) & ~1
    lines = []
    for start, size, origin in sorted((int(a, 16), int(b, 16), c) for a, b, c in pattern.findall(text)):
        if size and f"/{FRAME_ROLE}/" not in origin:
            lines.append(f"{start:x} {start + size:x} {'E' if start == solve else 'C'} {Path(origin).name}")
    return "\n".join(lines) + "\n"
