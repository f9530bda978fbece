"""Cost ledger: what the library costs on each target, measured, not estimated.

For each preset of a target (CMakePresets.json): bytes of code, constants and data per module and in total; bytes of the
state per window length; the worst-case stack of each public function, from the call graph and from painting under QEMU;
instructions per call of each public function over the embedded logs, and of goe_update per module and function.

Instructions are counted one by one by a plugin of QEMU (tools/count_plugin): figures repeat exactly. They are
instructions, not cycles. They include what the compiler's run-time library and memcpy/memset do for the library.

    python -m goe_tools ledger --json ledger.json --markdown ledger.md      measure and write
    python -m goe_tools ledger --check ledger.json                          measure, compare, fail if a figure grew
    python -m goe_tools ledger --check ledger.json --readme README.md       ... or if the README shows other tables
    python -m goe_tools ledger --json ledger.json --write-readme README.md  measure, write, and put the tables there
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tqdm import tqdm

ROOT = Path(__file__).resolve().parents[2]
PROCESSORS = ("m0plus", "m4f", "m7-sp", "m7-dp", "m33", "m55", "rv32imac", "rv32imafc")
PUBLIC = (
    "goe_settings_default",
    "goe_init",
    "goe_update",
    "goe_covariance",
    "goe_hazard",
    "goe_reset",
    "goe_status_text",
    "goe_self_check",
)
METHODS = ("window", "refined")  # each track is flown by each, in this order
UPDATES = {"refined": "goe_update", "window": "goe_update, window"}  # how its figures are named
WINDOWS = (3, 8, 16, 32, 64)  # of the table with bytes of state
GROWTH_ALLOWED = 0.02  # of a figure, over the committed ledger
LENS_TRACKS = "lens"  # tracks whose name begins so are flown with lens distortion
EXIT_GREW = 1
EMULATOR_SECONDS = 600

# What must hold on the Cortex-M4F at -O2 with gcc: the project's promise.
PROMISE_PRESET = "m4f-gcc-o2"
PROMISE_INSTRUCTIONS = {"refined": 25000, "window": 2550}  # of goe_update, any image, without lens distortion
PROMISE_STATE_BYTES = 2048  # at a window of 8
PROMISE_STACK_BYTES = 1024  # of goe_update
PROMISE_CALLS = {"memcpy", "memset"}


class LedgerError(RuntimeError):
    """A figure cannot be had, or is not what it must be."""


def output_of(command: Sequence[str | Path], cwd: Path | None = None) -> str:
    """Standard output of a command; LedgerError with what it printed if it fails."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def emulated(command: Sequence[str]) -> str:
    """All that an emulator prints: the image's console is standard output or error, as the machine has it."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=EMULATOR_SECONDS)
    if done.returncode != 0:
        raise LedgerError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


# --------------------------------------------------------------------------------------------------------- presets


def presets() -> list[str]:
    """All presets of targets, in the order of the table."""
    return [
        f"{processor}-{compiler}-{level}"
        for processor in PROCESSORS
        for compiler in ("gcc", "clang")
        for level in ("os", "o2")
        if compiler == "gcc" or not processor.startswith("rv32")
    ]


def missing_tool(preset: str) -> str | None:
    """The first program that a preset needs and that is not installed."""
    tools = ["cmake", "ninja", "cc"]
    if preset.startswith("rv32"):
        tools += ["riscv64-unknown-elf-gcc", "qemu-system-riscv32"]
    else:
        tools += ["arm-none-eabi-gcc", "qemu-system-arm"]
    if "-clang-" in preset:
        tools.append("clang-19")
    return next((tool for tool in tools if shutil.which(tool) is None), None)


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

    def objects(self) -> list[Path]:
        return sorted((self.tree / "lib" / "CMakeFiles" / "goe.dir").glob("*.obj"))


def build(preset: str, folder: Path) -> Build:
    tree = folder / preset
    output_of(["cmake", "--preset", preset, "-B", tree, "-DGOE_TARGET_UNIT_TESTS=OFF"], ROOT)
    boards = [
        path.name[len("replay_") : -len(".dir")]
        for path in (tree / "tests" / "targets" / "CMakeFiles").glob("replay_*.dir")
    ]
    cache = (tree / "CMakeCache.txt").read_text(encoding="utf-8")
    first = re.search(r"^GOE_TARGET_BOARD:INTERNAL=(.*)$", cache, re.MULTILINE)
    board = first.group(1) if first else boards[0]
    output_of(["cmake", "--build", tree, "--target", f"replay_{board}", f"stack_{board}"])
    commands = json.loads((tree / "compile_commands.json").read_text(encoding="utf-8"))
    words = next(entry for entry in commands if entry["file"].endswith("lib/goe_estimator.c"))["command"].split()
    command = words[: words.index("-o")]
    riscv = preset.startswith("rv32")
    qemu = re.search(r"^GOE_QEMU_COMMAND:INTERNAL=(.*)$", cache, re.MULTILINE)
    assert qemu, "the toolchain file tells how its images are run"
    return Build(
        preset=preset,
        tree=tree,
        board=board,
        tool_prefix="riscv64-unknown-elf-" if riscv else "arm-none-eabi-",
        compiler=output_of([command[0], "--version"]).splitlines()[0],
        command=command,
        emulator=qemu.group(1).split(";"),
    )


def shown_flags(command: Iterable[str]) -> str:
    """The flags that matter for the figures."""
    return " ".join(
        word for word in command if re.match(r"-(O|m|f(?!unction-sections|stack-usage|callgraph)|std=)", word)
    )


# --------------------------------------------------------------------------------------------------- bytes of modules


def module_bytes(built: Build) -> dict[str, dict[str, int]]:
    """Bytes of code, constants and writable data by module."""
    result = {}
    for path in built.objects():
        figures = {"code": 0, "constants": 0, "data": 0}
        for name, size in re.findall(r"^(\.[\w.$]+)\s+(\d+)\s+\d+$", built.tool("size", "-A", path), re.MULTILINE):
            if name.startswith(".text"):
                figures["code"] += int(size)
            elif name.startswith((".rodata", ".srodata")):
                figures["constants"] += int(size)
            elif name.startswith((".data", ".sdata", ".bss", ".sbss")):
                figures["data"] += int(size)
        result[path.name.split(".")[0]] = figures
    return result


def external_calls(built: Build) -> list[str]:
    """Symbols that the library needs from elsewhere."""
    defined, wanted = set(), set()
    for path in built.objects():
        for line in built.tool("nm", path).splitlines():
            kind, name = line.split()[-2:]
            (wanted if kind in "Uw" else defined).add(name)
    return sorted(wanted - defined)


def state_bytes(built: Build, folder: Path) -> dict[str, int]:
    """sizeof(goe_estimator_t) by window length."""
    source = folder / "state.c"
    lines = ['#include "goe.h"', "extern char state[];", "char state[sizeof(goe_estimator_t)];", ""]
    source.write_text("\n".join(lines), encoding="utf-8")
    result = {}
    command = [word for word in built.command if not word.startswith(("-DGOE_WINDOW_MAX", "-fcallgraph", "-fstack-us"))]
    for window in WINDOWS:
        target = folder / "state.obj"
        output_of([*command, f"-DGOE_WINDOW_MAX={window}", "-o", target, "-c", source])
        sizes = re.search(r"^\w+ (\w+) \w state$", built.tool("nm", "-S", target), re.MULTILINE)
        assert sizes
        result[str(window)] = int(sizes.group(1), 16)
    return result


# -------------------------------------------------------------------------------------------------------------- stack


@dataclass
class Function:
    """A function of the image. ``frame``: bytes; ``callees``: addresses, or a word for what cannot be followed."""

    name: str
    frame: int = 0
    callees: set[int | str] = field(default_factory=set)


CALL = re.compile(r"\t(?:bl|blx|b|b\.w|b\.n|b[a-z]{2}(?:\.[wn])?|jal|j|call|tail)\t(?:\w+,)?\s*([0-9a-f]+) <[^>+]+>")
INDIRECT = re.compile(r"\tblx\tr\d|\tjalr\t")  # jumps through a register also return, and serve switches

VARIABLE_FRAME = re.compile(r"\tsub(?:\.w|s)?\tsp,(?: ?sp,)? ?(?!sp\b)[a-z]")


def frame_of_line(line: str) -> int:
    """Bytes by which an instruction lowers the stack pointer."""
    pushed = re.search(r"\t(v?push|stmdb(?:\.w)?\tsp!,)\s*\{([^}]*)\}", line)
    if pushed:
        count = 0
        for part in pushed.group(2).split(","):
            ends = re.findall(r"[rsd](\d+)", part)
            count += int(ends[1]) - int(ends[0]) + 1 if len(ends) == 2 else 1
        return count * (8 if "d" in pushed.group(2) else 4)
    lowered = re.search(r"\tsub(?:w|\.w|s)?\tsp,(?: sp,)? ?#(\d+)|\taddi?\tsp,sp,-(\d+)", line)
    if lowered:
        return int(lowered.group(1) or lowered.group(2))
    stored = re.search(r"\tstrd?(?:\.w)?\t.*\[sp, #-(\d+)\]!", line)
    return int(stored.group(1)) if stored else 0


def disassembled_graph(built: Build) -> dict[int, Function]:
    """Call graph of the image, by address, from its machine code. Frames are upper bounds: every push of a function."""
    graph: dict[int, Function] = {}
    function: Function | None = None
    for line in built.tool("objdump", "-d", "--no-show-raw-insn", built.image("replay")).splitlines():
        header = re.match(r"([0-9a-f]+) <(.+)>:$", line)
        if header:
            function = Function(header.group(2))
            graph[int(header.group(1), 16)] = function
        elif function is not None and "\t" in line:
            function.frame += frame_of_line(line)
            call = CALL.search(line)
            if call:
                function.callees.add(int(call.group(1), 16))
            if INDIRECT.search(line):
                function.callees.add("an indirect call")
            if VARIABLE_FRAME.search(line):
                function.callees.add("a frame of unknown size")
    # A jump within a function may be shown by the name of a constant of the linker script that happens to be as large.
    starts = sorted(graph)
    for start, end in zip(starts, [*starts[1:], float("inf")]):
        inner = {to for to in graph[start].callees if isinstance(to, int) and to not in graph and start < to < end}
        graph[start].callees -= inner
    return graph


def compiled_frames(built: Build) -> dict[str, int]:
    """Frames in bytes as the compiler tells them (-fstack-usage). One that grows at run time is an error."""
    frames: dict[str, int] = {}
    for path in (built.tree / "lib" / "CMakeFiles" / "goe.dir").glob("*.su"):
        for line in path.read_text(encoding="utf-8").splitlines():
            place, size, kind = line.split("\t")
            name = place.rsplit(":", 1)[-1]
            if kind != "static":
                raise LedgerError(f"{place}: its frame is {kind}, not static")
            frames[name] = max(int(size), frames.get(name, 0))
    return frames


def refuse_indirect_calls(built: Build) -> None:
    """The compiler's own call graph names what the machine code may hide behind a jump."""
    for path in (built.tree / "lib" / "CMakeFiles" / "goe.dir").glob("*.ci"):
        if "__indirect_call" in path.read_text(encoding="utf-8"):
            raise LedgerError(f"{path.stem}: an indirect call")


def deepest(graph: dict[int, Function], address: int | str, path: tuple[str, ...] = ()) -> int:
    """Bytes of stack of a function and all that it calls."""
    function = graph.get(address) if isinstance(address, int) else None
    if function is None:
        raise LedgerError(f"unknown callee: {' -> '.join((*path, str(address)))}")
    if function.name in path:
        raise LedgerError(f"recursion: {' -> '.join((*path, function.name))}")
    others = (callee for callee in function.callees if callee != address)  # a loop's jump to the start is no call
    return function.frame + max((deepest(graph, callee, (*path, function.name)) for callee in others), default=0)


def computed_stack(built: Build) -> dict[str, int]:
    """Worst-case stack in bytes by public function: the compiler's frames over the calls in the machine code."""
    graph = disassembled_graph(built)
    by_name = {function.name: function for function in graph.values()}
    for name, frame in compiled_frames(built).items():
        if name in by_name:
            by_name[name].frame = frame
    refuse_indirect_calls(built)
    entries = {function.name: address for address, function in graph.items()}
    return {name: deepest(graph, entries[name]) for name in PUBLIC}


def painted_stack(built: Build) -> dict[str, int]:
    """Stack in bytes by public function, as measured over the embedded logs."""
    text = run_image(built, built.image("stack"))
    found = {name: int(size) for name, size in re.findall(r"^stack (\w+) (\d+)$", text, re.MULTILINE)}
    found[UPDATES["window"]] = found.pop("goe_update_window")
    return found


def run_image(built: Build, image: Path, *options: str) -> str:
    return emulated([*built.emulator[:-1], *options, built.emulator[-1], str(image)])


# ------------------------------------------------------------------------------------------------------ instructions


@dataclass
class Code:
    """A stretch of the image's code that belongs to one function."""

    start: int
    end: int
    module: str
    name: str


def code_map(built: Build) -> list[Code]:
    """Library code in the image, by the linker's map, sorted by address; code of the test program is left out."""
    text = (built.tree / "tests" / "targets" / f"replay_{built.board}.map").read_text(encoding="utf-8")
    text = text[text.index("Linker script and memory map") :]
    result = []
    pattern = re.compile(r"^ (\.text[\w.$]*)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$", re.MULTILINE)
    for section, start, size, origin in pattern.findall(text):
        member = re.search(r"(\w+)\.a\(([^)]+)\)$", origin)
        if int(size, 16) == 0 or not member or member.group(1) == "libgoe_port":
            continue
        module = member.group(2).split(".")[0]
        name = section[len(".text.") :] or module
        if member.group(1) != "libgoe":
            name, module = module, "C library" if member.group(1) in ("libc", "libm") else "compiler's library"
        result.append(Code(int(start, 16), int(start, 16) + int(size, 16), module, name))
    return sorted(result, key=lambda code: code.start)


def build_plugin(folder: Path) -> Path:
    plugin = folder / "count_calls.so"
    source = ROOT / "tools" / "count_plugin" / "count_calls.c"
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-shared", "-fPIC", "-fvisibility=hidden"]
    output_of(["cc", *flags, source, "-o", plugin])
    return plugin


@dataclass
class Call:
    """One call of a public function. ``parts``: instructions by (module, function)."""

    function: str
    track: str
    method: str
    total: int
    parts: dict[tuple[str, str], int]


def track_names() -> list[str]:
    text = (ROOT / "tests" / "targets" / "embedded_logs.c").read_text(encoding="utf-8")
    return re.findall(r'^    \{"(\w+)", ', text, re.MULTILINE)


def counted_calls(built: Build, plugin: Path, folder: Path) -> list[Call]:
    code = code_map(built)
    ranges, counts = folder / f"{built.preset}.ranges", folder / f"{built.preset}.counts"
    lines = [f"{c.start:x} {c.end:x} {'E' if c.name in PUBLIC else 'C'} {c.name.replace(' ', '_')}" for c in code]
    ranges.write_text("\n".join(lines) + "\n", encoding="utf-8")
    run_image(built, built.image("replay"), "-plugin", f"{plugin},map={ranges},out={counts}")
    names = track_names()
    track = -1
    calls = []
    for line in counts.read_text(encoding="utf-8").splitlines():
        entry, total, *parts = line.split()
        function = code[int(entry)].name
        track += function == "goe_init"
        by_part: dict[tuple[str, str], int] = {}
        for part in parts:
            index, count = part.split(":")
            key = (code[int(index)].module, code[int(index)].name)
            by_part[key] = by_part.get(key, 0) + int(count)
        name, method = names[max(track, 0) // len(METHODS)], METHODS[max(track, 0) % len(METHODS)]
        calls.append(Call(function, name, method, int(total), by_part))
    if {call.function for call in calls} != set(PUBLIC):
        raise LedgerError(f"{built.preset}: not every public function was called")
    return calls


def spread(values: Sequence[int]) -> dict[str, float]:
    return {"min": min(values), "mean": round(sum(values) / len(values), 1), "max": max(values)}


def instructions(calls: list[Call]) -> dict[str, Any]:
    """Instructions per call by public function; of goe_update by method, and of the refined one also by module, and the
    worst call by function."""
    functions = {name: spread([call.total for call in calls if call.function == name]) for name in PUBLIC}
    updates = [call for call in calls if call.function == "goe_update"]
    for method, name in UPDATES.items():
        own = [call for call in updates if call.method == method]
        lens = [call.total for call in own if call.track.startswith(LENS_TRACKS)]
        functions[name] = spread([call.total for call in own if not call.track.startswith(LENS_TRACKS)])
        functions[f"{name} with lens distortion"] = spread(lens)
    plain = [call for call in updates if call.method == "refined" and not call.track.startswith(LENS_TRACKS)]
    modules = sorted({module for call in plain for module, _ in call.parts})
    by_module = {
        module: spread([sum(n for (m, _), n in call.parts.items() if m == module) for call in plain])
        for module in modules
    }
    worst = max(plain, key=lambda call: call.total)
    parts = sorted(worst.parts.items(), key=lambda item: -item[1])
    return {
        "functions": functions,
        "goe_update by module": by_module,
        "worst goe_update": {"track": worst.track, "by function": {f"{m}: {name}": n for (m, name), n in parts}},
    }


# -------------------------------------------------------------------------------------------------------------- ledger


def measure(preset: str, folder: Path, plugin: Path) -> dict[str, Any]:
    """All figures of one preset."""
    built = build(preset, folder)
    modules = module_bytes(built)
    total = {kind: sum(module[kind] for module in modules.values()) for kind in ("code", "constants", "data")}
    painted, computed = painted_stack(built), computed_stack(built)
    for name in PUBLIC:
        if painted[name] > computed[name]:
            raise LedgerError(f"{preset}: {name}: {painted[name]} bytes of stack painted, {computed[name]} computed")
    return {
        "compiler": built.compiler,
        "flags": shown_flags(built.command),
        "machine": built.board,
        "bytes": {"total": total, "modules": modules},
        "calls to other libraries": external_calls(built),
        "state bytes by window": state_bytes(built, folder),
        "stack bytes": {name: {"computed": computed[name], "painted": painted[name]} for name in PUBLIC}
        | {UPDATES["window"]: {"painted": painted[UPDATES["window"]]}},
        "instructions": instructions(counted_calls(built, plugin, folder)),
    }


def broken_promises(ledger: dict[str, Any]) -> list[str]:
    """What is promised of the Cortex-M4F and does not hold."""
    figures = ledger.get(PROMISE_PRESET)
    if figures is None:
        return []
    size = figures["bytes"]["total"]
    counts = figures["instructions"]["functions"]
    stack = figures["stack bytes"]["goe_update"]["computed"]
    limits = [
        *((f"instructions of {name}", counts[name]["max"], PROMISE_INSTRUCTIONS[m]) for m, name in UPDATES.items()),
        ("bytes of writable data", size["data"], 0),
        ("bytes of state at a window of 8", figures["state bytes by window"]["8"], PROMISE_STATE_BYTES),
        ("bytes of stack of goe_update", stack, PROMISE_STACK_BYTES),
    ]
    broken = [f"{PROMISE_PRESET}: {what}: {value}, promised {most}" for what, value, most in limits if value > most]
    strange = set(figures["calls to other libraries"]) - PROMISE_CALLS
    if strange:
        broken.append(f"{PROMISE_PRESET}: the library calls {', '.join(sorted(strange))}")
    return broken


def leaves(value: Any, path: tuple[str, ...] = ()) -> dict[tuple[str, ...], Any]:
    if isinstance(value, dict):
        return {key: leaf for name, inner in value.items() for key, leaf in leaves(inner, (*path, name)).items()}
    return {path: value}


def grown(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Figures that grew by more than is allowed, in words. Parts of the worst call may shift between functions."""
    result = []
    old = leaves(before)
    for path, value in leaves(now).items():
        if not isinstance(value, (int, float)) or "by function" in path:
            continue
        was = old.get(path)
        where = ": ".join(path)
        if was is None:
            result.append(f"{where}: {value}, not in the ledger")
        elif value > was * (1.0 + GROWTH_ALLOWED):
            result.append(f"{where}: {was} -> {value}")
    return result


# ------------------------------------------------------------------------------------------------------------- tables


def title(preset: str) -> str:
    processor, compiler, level = preset.rsplit("-", 2)
    name = processor.upper() if processor.startswith("rv") else "Cortex-" + processor.upper().replace("PLUS", "+")
    return f"{name.replace('-SP', ' (single)').replace('-DP', ' (double)')} | {compiler} -O{level[1]}"


def markdown(ledger: dict[str, Any]) -> str:
    """The README's tables."""
    lines = [
        "| target | compiler | code + constants, bytes | stack of `goe_update`, bytes (painted) | "
        "instructions per `goe_update`: min / mean / max | ... with lens distortion: max | "
        "... method window: min / mean / max |",
        "|---|---|---|---|---|---|---|",
    ]
    for preset, figures in ledger.items():
        size, stack = figures["bytes"]["total"], figures["stack bytes"]["goe_update"]
        functions = figures["instructions"]["functions"]
        update, lens = functions["goe_update"], functions["goe_update with lens distortion"]
        window = functions[UPDATES["window"]]
        lines.append(
            f"| {title(preset)} | {size['code'] + size['constants']} | {stack['computed']} ({stack['painted']}) | "
            f"{update['min']} / {update['mean']:.0f} / {update['max']} | {lens['max']} | "
            f"{window['min']} / {window['mean']:.0f} / {window['max']} |"
        )
    figures = ledger.get(PROMISE_PRESET)
    if figures is None:
        return "\n".join(lines) + "\n"
    lines += ["", f"Cortex-M4F, {figures['compiler']}, `{figures['flags']}`:", ""]
    lines += ["| module | code, bytes | constants, bytes | instructions per `goe_update`: min / mean / max |"]
    lines += ["|---|---|---|---|"]
    by_module = figures["instructions"]["goe_update by module"]
    for module, size in figures["bytes"]["modules"].items():
        share = by_module.get(module)
        text = f"{share['min']} / {share['mean']:.0f} / {share['max']}" if share else "-"
        lines.append(f"| {module} | {size['code']} | {size['constants']} | {text} |")
    for module, share in by_module.items():
        if module not in figures["bytes"]["modules"]:
            lines.append(f"| ({module}) | | | {share['min']} / {share['mean']:.0f} / {share['max']} |")
    lines += ["", "| function | stack, bytes (painted) | instructions: min / mean / max |", "|---|---|---|"]
    for name in PUBLIC:
        stack, count = figures["stack bytes"][name], figures["instructions"]["functions"][name]
        lines.append(
            f"| `{name}` | {stack['computed']} ({stack['painted']}) | "
            f"{count['min']} / {count['mean']:.0f} / {count['max']} |"
        )
    windows = figures["state bytes by window"]
    lines += ["", "| window | " + " | ".join(windows) + " |", "|---" * (len(windows) + 1) + "|"]
    lines.append("| state, bytes | " + " | ".join(str(size) for size in windows.values()) + " |")
    return "\n".join(lines) + "\n"


BEGIN, END = "<!-- ledger: begin -->", "<!-- ledger: end -->"


def with_tables(path: Path, tables: str) -> str:
    """The text of a file with the tables between its two markers."""
    text = path.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise ValueError(f"{path}: needs the lines {BEGIN} and {END} once")
    return text[: text.index(BEGIN) + len(BEGIN)] + "\n" + tables + text[text.index(END) :]


# -------------------------------------------------------------------------------------------------------------- shell


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("presets", nargs="*", metavar="PRESET", help="targets to measure; default: all whose tools are installed")
    add("--build", type=Path, default=ROOT / "build" / "ledger", metavar="DIR", help="folder for the builds")
    add("--json", type=Path, metavar="FILE", help="write the ledger")
    add("--markdown", type=Path, metavar="FILE", help="write the tables")
    add("--check", type=Path, metavar="FILE", help="fail if a figure is more than 2 %% above this ledger's")
    add(
        "--readme", type=Path, metavar="FILE", help="with --check: fail if this file does not show that ledger's tables"
    )
    add("--write-readme", type=Path, metavar="FILE", help=f"put the tables between {BEGIN} and {END} in this file")


def measured(wanted: Sequence[str], folder: Path) -> dict[str, Any]:
    """The ledger of the presets whose tools are installed; the others are named."""
    folder.mkdir(parents=True, exist_ok=True)
    plugin = build_plugin(folder)
    result = {}
    for preset in tqdm(wanted, unit="target", disable=not sys.stderr.isatty()):
        missing = missing_tool(preset)
        if missing:
            print(f"skipped: {preset}: no {missing}")
            continue
        result[preset] = measure(preset, folder, plugin)
    return result


def compare(path: Path, ledger: dict[str, Any]) -> list[str]:
    """What grew over the ledger in a file. Targets that another compiler built cannot be compared: they are named."""
    before = json.loads(path.read_text(encoding="utf-8"))
    failures = []
    for preset, now in ledger.items():
        was = before.get(preset)
        if was is None:
            failures.append(f"{preset}: not in {path}")
        elif was["compiler"] != now["compiler"]:
            print(f"skipped: {preset}: {path} is of {was['compiler']}, this is {now['compiler']}")
        else:
            failures += [f"{preset}: {text}" for text in grown(was, now)]
    return failures


def run(arguments: argparse.Namespace) -> int:
    unknown = set(arguments.presets) - set(presets())
    if unknown:
        raise ValueError(f"no such target: {', '.join(sorted(unknown))}; there are {', '.join(presets())}")
    try:
        ledger = measured(arguments.presets or presets(), arguments.build)
    except LedgerError as error:
        print(f"ledger: {error}", file=sys.stderr)
        return EXIT_GREW
    failures = broken_promises(ledger)
    if arguments.check:
        failures += compare(arguments.check, ledger)
        committed = json.loads(arguments.check.read_text(encoding="utf-8"))
        readme = arguments.readme
        if readme and with_tables(readme, markdown(committed)) != readme.read_text(encoding="utf-8"):
            failures.append(f"{readme}: its tables are not those of {arguments.check}: run with --write-readme")
    if arguments.json:
        arguments.json.write_text(json.dumps(ledger, indent=1) + "\n", encoding="utf-8")
    if arguments.write_readme:
        text = with_tables(arguments.write_readme, markdown(ledger))
        arguments.write_readme.write_text(text, encoding="utf-8")
    if arguments.markdown:
        arguments.markdown.write_text(markdown(ledger), encoding="utf-8")
    if not (arguments.json or arguments.markdown or arguments.check or arguments.write_readme):
        print(markdown(ledger), end="")
    for failure in failures:
        print(f"ledger: {failure}", file=sys.stderr)
    return EXIT_GREW if failures else 0
