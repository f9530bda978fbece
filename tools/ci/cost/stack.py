"""The worst-case stack of each public function, from the call graph and from painting under QEMU."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from bench.running import LedgerError

from .building import Build
from .instructions import PUBLIC, UPDATES


@dataclass
class Function:
    """A function of the image. ``frame``: bytes; ``callees``: addresses, or a word for a call that cannot be
    followed."""

    name: str
    frame: int = 0
    callees: set[int | str] = field(default_factory=set)


CALL = re.compile(
    r"\t(?:bl|blx|bl[a-z]{2}|b|b\.w|b\.n|b[a-z]{2}(?:\.[wn])?|jal|j|call|tail)\t(?:\w+,)?\s*([0-9a-f]+) <[^>+]+>"
)
INDIRECT = re.compile(r"\tblx\tr\d|\tjalr\t")  # jumps through a register are also returns and switches

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
    # objdump may show a jump in a function with the name of an unrelated linker constant of the same value.
    starts = sorted(graph)
    for start, end in zip(starts, [*starts[1:], float("inf")]):
        inner = {to for to in graph[start].callees if isinstance(to, int) and to not in graph and start < to < end}
        graph[start].callees -= inner
    return graph


def compiled_frames(built: Build) -> dict[str, int]:
    """Frames in bytes as reported by the compiler (-fstack-usage). A frame that grows at run time is an error."""
    frames: dict[str, int] = {}
    for path in built.library_files("su"):
        for line in path.read_text(encoding="utf-8").splitlines():
            place, size, kind = line.split("\t")
            name = place.rsplit(":", 1)[-1]
            if kind != "static":
                raise LedgerError(f"{place}: its frame is {kind}, not static")
            frames[name] = max(int(size), frames.get(name, 0))
    return frames


def refuse_indirect_calls(built: Build) -> None:
    """Fails for indirect calls in the compiler's call graph, which the machine code may hide behind a jump."""
    for path in built.library_files("ci"):
        if "__indirect_call" in path.read_text(encoding="utf-8"):
            raise LedgerError(f"{path.stem}: an indirect call")


def deepest(graph: dict[int, Function], address: int | str, path: tuple[str, ...] = ()) -> int:
    """Bytes of stack of a function and all its callees."""
    function = graph.get(address) if isinstance(address, int) else None
    if function is None:
        raise LedgerError(f"unknown callee: {' -> '.join((*path, str(address)))}")
    if function.name in path:
        raise LedgerError(f"recursion: {' -> '.join((*path, function.name))}")
    others = (callee for callee in function.callees if callee != address)  # a loop's jump to the start is not a call
    return function.frame + max((deepest(graph, callee, (*path, function.name)) for callee in others), default=0)


def computed_stack(built: Build) -> dict[str, int]:
    """Worst-case stack in bytes by public function: the compiler's frames over the calls in the machine code."""
    graph = disassembled_graph(built)
    frames = compiled_frames(built)
    for function in graph.values():  # static functions of several files may share a name: use the largest
        function.frame = frames.get(function.name, function.frame)
    refuse_indirect_calls(built)
    entries = {function.name: address for address, function in graph.items()}
    return {name: deepest(graph, entries[name]) for name in PUBLIC}


def painted_stack(built: Build) -> dict[str, int]:
    """Stack in bytes by public function, as measured over the embedded logs."""
    text = built.run_image(built.image("stack"))
    found = {name: int(size) for name, size in re.findall(r"^stack (\w+) (\d+)$", text, re.MULTILINE)}
    found[UPDATES["window"]] = found.pop("goe_update_window")
    return found
