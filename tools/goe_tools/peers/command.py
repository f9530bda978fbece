"""Side by side: our window solve and what others would do with the same window, in one run on one machine.

Each solver solves the same 64 windows of 8 images (tools/peers/window/windows.c): on the host it is timed and its width
is held against double precision; on a Cortex-M4F under QEMU its instructions are counted one by one and its stack is
painted. Every solver is built twice: with the library's own flags, and with flags that leave a compiler all freedom
(-O3 -ffast-math, on the host -march=native), which most peers profit from.

Ours tells sigmas and refuses bad windows, and is counted with that; the peers only solve.

    python -m goe_tools peers [--cmsis-dsp DIR] [--tinyekf DIR]

Eigen (libeigen3-dev) and LAPACK (liblapacke-dev) are used where they are installed; CMSIS-DSP and TinyEKF where a
folder with their sources is named. What is not there is named and left out.
"""

from __future__ import annotations

import argparse
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from tqdm import tqdm

from ..ledger import ROOT, LedgerError, build_plugin, emulated, output_of

PEERS = ROOT / "tools" / "peers"
FRAME = PEERS / "frame"
WINDOW = PEERS / "window"
BARE_METAL = ROOT / "port" / "baremetal"
REPLAY = ROOT / "tests" / "targets"
OWN_FLAGS = ("-O2", "-ffp-contract=off", "-fno-math-errno")
BEST_FLAGS = ("-O3", "-ffast-math")
THROUGHPUT = (10000, 400000)  # most obstacles, updates per measurement
QUICK_THROUGHPUT = (1, 100)
M4F = ("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
M4F_MEMORY = (
    "ROM_ORIGIN=0", "ROM_LENGTH=0x400000", "RAM_ORIGIN=0x20000000", "RAM_LENGTH=0x400000", "STACK_LENGTH=0x8000",
)  # fmt: skip
EMULATOR = (
    "qemu-system-arm", "-M", "mps2-an386", "-nographic", "-monitor", "none", "-serial", "none",
    "-semihosting-config", "enable=on,target=native",
)  # fmt: skip


@dataclass
class Peer:
    """A solver: its source in tools/peers/window, what it needs to compile and link, and what it can do."""

    name: str
    source: str
    flags: list[str] = field(default_factory=list)
    more_sources: list[Path] = field(default_factory=list)
    libraries: list[str] = field(default_factory=list)
    on_target: bool = True
    solves: bool = True  # the window; otherwise its error means nothing

    @property
    def is_cpp(self) -> bool:
        return self.source.endswith(".cpp")


@dataclass
class Result:
    """Figures of one solver with one set of flags; None: not run there."""

    nanoseconds: float | None = None
    worst_error: float | None = None
    mean_error: float | None = None
    instructions: tuple[int, float, int] | None = None
    stack: int | None = None
    code: int | None = None


# ------------------------------------------------------------------------------------------------------------- peers


def has_header(name: str) -> bool:
    found = subprocess.run(["cc", "-E", "-x", "c", "-"], input=f"#include <{name}>\n", text=True, capture_output=True)
    return found.returncode == 0


def all_peers(arguments: argparse.Namespace) -> list[Peer]:
    """The solvers that can be had here; the others are named."""
    library = sorted((ROOT / "lib").glob("*.c"))
    peers = [Peer("goe, closed form", "peer_goe.c", [f"-I{ROOT / 'lib'}"], library)]
    if (arguments.eigen / "Eigen" / "Dense").exists():
        flags = [f"-isystem{arguments.eigen}", "-DNDEBUG", "-DEIGEN_NO_MALLOC"]
        for number, method in enumerate(("LLT", "LDLT", "ColPivHouseholderQR"), start=1):
            peers.append(Peer(f"Eigen {method}", "peer_eigen.cpp", [*flags, f"-DMETHOD={number}"]))
    else:
        print(f"skipped: Eigen: there is no {arguments.eigen}/Eigen/Dense (libeigen3-dev)")
    if has_header("lapacke.h"):
        peers.append(Peer("LAPACK sgels", "peer_lapack.c", libraries=["-llapacke"], on_target=False))
    else:
        print("skipped: LAPACK: there is no lapacke.h (liblapacke-dev)")
    if arguments.cmsis_dsp:
        folder = arguments.cmsis_dsp
        sources = [folder / "Source" / "MatrixFunctions" / f"arm_{name}_f32.c" for name in CMSIS_FUNCTIONS]
        sources += [folder / "Source" / "BasicMathFunctions" / f"arm_{name}_f32.c" for name in ("dot_prod", "scale")]
        flags = [f"-isystem{folder / 'Include'}", f"-isystem{folder / 'PrivateInclude'}", "-D__GNUC_PYTHON__", "-w"]
        for number, method in enumerate(("Cholesky", "QR"), start=1):
            peers.append(Peer(f"CMSIS-DSP {method}", "peer_cmsis.c", [*flags, f"-DMETHOD={number}"], sources))
    else:
        print("skipped: CMSIS-DSP: name its sources with --cmsis-dsp")
    if arguments.tinyekf:
        include = next((path.parent for path in arguments.tinyekf.rglob("tinyekf.h")), None)
        if include is None:
            raise ValueError(f"--tinyekf {arguments.tinyekf}: there is no tinyekf.h in it")
        peers.append(Peer("TinyEKF, one step", "peer_tinyekf.c", [f"-isystem{include}", "-w"], solves=False))
    else:
        print("skipped: TinyEKF: name its sources with --tinyekf")
    return peers


CMSIS_FUNCTIONS = (
    "mat_trans", "mat_mult", "mat_cholesky", "mat_solve_lower_triangular", "mat_solve_upper_triangular", "mat_qr",
    "householder",
)  # fmt: skip


# -------------------------------------------------------------------------------------------------------------- host


def compile_all(compiler: str, flags: list[str], sources: list[Path], folder: Path) -> list[str]:
    """Compiles sources into a folder; the objects."""
    folder.mkdir(parents=True, exist_ok=True)
    objects = []
    for source in sources:
        target = folder / (source.name + ".o")
        output_of([compiler, *flags, "-c", source, "-o", target])
        objects.append(str(target))
    return objects


def split_flags(peer: Peer) -> tuple[list[str], list[str]]:
    """Flags for C and for C++ sources."""
    folders = [f"-I{FRAME}", f"-I{WINDOW}"]
    return ["-std=gnu11", *folders, *peer.flags], ["-std=c++17", "-fno-exceptions", "-fno-rtti", *folders, *peer.flags]


def run_on_host(peer: Peer, flags: list[str], folder: Path, result: Result) -> None:
    c_flags, cpp_flags = split_flags(peer)
    own = [WINDOW / peer.source]
    objects = compile_all(
        "g++" if peer.is_cpp else "gcc", [*flags, *(cpp_flags if peer.is_cpp else c_flags)], own, folder
    )
    objects += compile_all("gcc", [*flags, *c_flags], peer.more_sources, folder)
    frame = ["-std=gnu11", "-O2", "-ffp-contract=off", f"-I{FRAME}"]  # windows and truth: the same for all
    objects += compile_all("gcc", frame, [WINDOW / "windows.c", FRAME / "host_main.c"], folder)
    program = folder / "host"
    output_of(["g++" if peer.is_cpp else "gcc", *objects, *peer.libraries, "-lm", "-o", program])
    numbers = re.match(r"ns (\S+) error (\S+) (\S+)", output_of([program]))
    assert numbers
    result.nanoseconds = float(numbers.group(1))
    if peer.solves:
        result.worst_error, result.mean_error = float(numbers.group(2)), float(numbers.group(3))


# ------------------------------------------------------------------------------------------------------------ target


def image_of(peer: Peer, flags: list[str], folder: Path) -> Path:
    c_flags, cpp_flags = split_flags(peer)
    base = [*M4F, "-ffunction-sections", "-fdata-sections"]
    compiler = "arm-none-eabi-g++" if peer.is_cpp else "arm-none-eabi-gcc"
    language = [*cpp_flags, "-fno-threadsafe-statics"] if peer.is_cpp else c_flags
    objects = compile_all(compiler, [*base, *flags, *language], [WINDOW / peer.source], folder / "solver")
    objects += compile_all("arm-none-eabi-gcc", [*base, *flags, *c_flags], peer.more_sources, folder / "solver")
    frame = [*base, "-std=gnu11", "-O2", "-ffp-contract=off", "-DGOE_BARE_METAL", f"-I{BARE_METAL}", f"-I{FRAME}"]
    port = [BARE_METAL / name for name in ("semihosting.c", "start_arm.c", "c_library.c")]
    objects += compile_all(
        "arm-none-eabi-gcc", frame, [WINDOW / "windows.c", FRAME / "image_main.c", *port], folder / "frame"
    )
    image = folder / "image.elf"
    link = ["-nostartfiles", f"-T{BARE_METAL / 'image.ld'}", "-Wl,-e,port_start,--gc-sections,--no-warn-rwx-segments"]
    link += [f"-Wl,--defsym,{symbol}" for symbol in M4F_MEMORY]
    output_of(["arm-none-eabi-gcc", *M4F, *link, *objects, "-lm", "-o", image, f"-Wl,-Map,{folder / 'image.map'}"])
    return image


def code_bytes(image: Path) -> int:
    return int(output_of(["arm-none-eabi-size", image]).splitlines()[1].split()[0])


def solver_ranges(folder: Path, image: Path) -> str:
    """The plugin's map: everything but the frame's own code; peer_solve is the entry."""
    text = (folder / "image.map").read_text(encoding="utf-8")
    text = text[text.index("Linker script and memory map") :]
    pattern = re.compile(r"^ \.text[\w.$]*\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$", re.MULTILINE)
    symbols = output_of(["arm-none-eabi-nm", image])
    entry = re.search(r"^(\w+) T peer_solve$", symbols, re.MULTILINE)
    assert entry
    start_of_solve = int(entry.group(1), 16) & ~1
    lines = []
    for start, size, origin in sorted((int(a, 16), int(b, 16), c) for a, b, c in pattern.findall(text)):
        if size and "/frame/" not in origin:
            lines.append(f"{start:x} {start + size:x} {'E' if start == start_of_solve else 'C'} {Path(origin).name}")
    return "\n".join(lines) + "\n"


def run_on_target(peer: Peer, flags: list[str], folder: Path, plugin: Path, empty: int, result: Result) -> None:
    image = image_of(peer, flags, folder)
    ranges, counts = folder / "ranges", folder / "counts"
    ranges.write_text(solver_ranges(folder, image), encoding="utf-8")
    text = emulated([*EMULATOR, "-plugin", f"{plugin},map={ranges},out={counts}", "-kernel", str(image)])
    stack = re.search(r"stack (\d+)", text)
    totals = [int(line.split()[1]) for line in counts.read_text(encoding="utf-8").splitlines()]
    if not stack or len(totals) != 64:
        raise LedgerError(f"{peer.name}: {len(totals)} solves were counted, not 64: {text}")
    result.instructions = (min(totals), sum(totals) / len(totals), max(totals))
    result.stack = int(stack.group(1))
    result.code = code_bytes(image) - empty


# -------------------------------------------------------------------------------------------------------------- table


def row(name: str, flags: str, result: Result) -> str:
    def shown(value: object, form: str) -> str:
        return "-" if value is None else format(value, form)

    count = "-" if result.instructions is None else f"{result.instructions[1]:.0f} ({result.instructions[2]})"
    return (
        f"| {name} | {flags} | {shown(result.nanoseconds, '.0f')} | {count} | {shown(result.stack, 'd')} | "
        f"{shown(result.code, 'd')} | {shown(result.worst_error, '.1e')} | {shown(result.mean_error, '.1e')} |"
    )


HEAD = (
    "| solver | flags | host, ns | M4F, instructions: mean (max) | M4F stack, bytes | M4F code, bytes | "
    "error of W: worst | root mean square |\n|---|---|---|---|---|---|---|---|"
)


def processor() -> str:
    text = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    model = re.search(r"^model name\s*: (.*)$", text, re.MULTILINE)
    return model.group(1) if model else platform.processor()


def throughput(folder: Path, size: tuple[int, int]) -> list[str]:
    """Updates per second on one core."""
    sources = [PEERS / "throughput.c", REPLAY / "replay.c", REPLAY / "embedded_logs.c", *(ROOT / "lib").glob("*.c")]
    flags = ["-std=gnu11", *OWN_FLAGS, f"-I{ROOT / 'lib'}", f"-I{REPLAY}"]
    program = folder / "throughput"
    output_of(["gcc", *flags, *sources, "-lm", "-o", program])
    lines = ["| obstacles | updates per second, one core | ns per update | state, KiB |", "|---|---|---|---|"]
    return lines + [f"| {' | '.join(line.split())} |" for line in output_of([program, *map(str, size)]).splitlines()]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--eigen", type=Path, default=Path("/usr/include/eigen3"), metavar="DIR", help="folder of Eigen/")
    add("--cmsis-dsp", type=Path, metavar="DIR", help="sources of CMSIS-DSP (its folder with Include and Source)")
    add("--tinyekf", type=Path, metavar="DIR", help="sources of TinyEKF")
    add("--quick", action="store_true", help="own flags only, next to no throughput: to test this command")


def run(arguments: argparse.Namespace) -> int:
    peers = all_peers(arguments)
    with_target = shutil.which("arm-none-eabi-g++") is not None and shutil.which("qemu-system-arm") is not None
    if not with_target:
        print("skipped: Cortex-M4F: there is no arm-none-eabi-g++ or no qemu-system-arm")
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plugin = build_plugin(folder) if with_target else Path()
        sets = (OWN_FLAGS,) if arguments.quick else (OWN_FLAGS, BEST_FLAGS)
        tasks = [(peer, flags) for peer in peers for flags in sets]
        for number, (peer, flags) in enumerate(tqdm(tasks, unit="build", disable=not sys.stderr.isatty())):
            result = Result()
            native = ["-march=native"] if flags == BEST_FLAGS else []
            run_on_host(peer, [*flags, *native], folder / f"host{number}", result)
            if with_target and peer.on_target:
                nothing = image_of(Peer("", "../frame/peer_none.c"), list(flags), folder / f"none{number}")
                run_on_target(peer, list(flags), folder / f"m4f{number}", plugin, code_bytes(nothing), result)
            rows.append(row(peer.name, "own" if flags == OWN_FLAGS else "best", result))
        speed = throughput(folder, QUICK_THROUGHPUT if arguments.quick else THROUGHPUT)
    print(HEAD, *rows, sep="\n")
    print(f"\nown: {' '.join(OWN_FLAGS)}; best: {' '.join(BEST_FLAGS)}, on the host with -march=native")
    print(f"host: {processor()}, {output_of(['gcc', '--version']).splitlines()[0]}")
    if with_target:
        print(f"M4F: {output_of(['arm-none-eabi-gcc', '--version']).splitlines()[0]}, {' '.join(M4F)}")
    print("", *speed, sep="\n")
    return 0
