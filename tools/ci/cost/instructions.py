"""Instructions of each call of a public function over the embedded logs.

A plugin of QEMU (tools/count_plugin) counts them one by one: figures repeat exactly. They are instructions, not
cycles. They include the work of the compiler's run-time library and of memcpy/memset for the library.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from bench.running import ROOT, LedgerError

from .building import Build

PUBLIC = (
    "goe_settings_default",
    "goe_init",
    "goe_update",
    "goe_covariance",
    "goe_hazard",
    "goe_rule_default",
    "goe_decide",
    "goe_earliest_tcpa_s",
    "goe_reset",
    "goe_status_text",
    "goe_reason_text",
    "goe_self_check",
)
METHODS = ("window", "filter")  # each track is flown with each, in this order
UPDATES = {"filter": "goe_update", "window": "goe_update, window"}  # names of the figures
LENS_TRACKS = "lens"  # prefix of the tracks with lens distortion
WITH_LENS = "with lens distortion"


@dataclass
class Code:
    """A range of the image's code that belongs to one function."""

    start: int
    end: int
    module: str
    name: str


@dataclass
class Call:
    """One call of a public function. ``parts``: instructions by (module, function)."""

    function: str
    track: str
    method: str
    total: int
    parts: dict[tuple[str, str], int]


@dataclass
class Spread:
    """Fewest, mean and most instructions of several calls."""

    min: int
    mean: float
    max: int

    @classmethod
    def of(cls, values: Sequence[int]) -> Spread:
        return cls(min(values), round(sum(values) / len(values), 1), max(values))


@dataclass
class Count:
    """Cost of the calls: by public function; for goe_update without lens distortion, filter, also by module, and its
    worst call by (module, function)."""

    functions: dict[str, Spread]
    modules: dict[str, Spread]
    worst_track: str
    worst: dict[tuple[str, str], int]


def module_names(built: Build) -> dict[str, str]:
    """Modules by the name of their object, the only name of an archive's members in a linker's map."""
    names: dict[str, str] = {}
    for path in built.library_files("obj"):
        if path.name in names:
            raise LedgerError(f"{names[path.name]} and {built.module(path)}: modules need different file names")
        names[path.name] = built.module(path)
    return names


def code_of_map(text: str, modules: dict[str, str]) -> list[Code]:
    """Library code in an image, from the linker's map, sorted by address; without the code of the test program."""
    text = text[text.index("Linker script and memory map") :]
    result = []
    pattern = re.compile(r"^ (\.text[\w.$]*)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$", re.MULTILINE)
    for section, start, size, origin in pattern.findall(text):
        member = re.search(r"(\w+)\.a\(([^)]+)\)$", origin)
        if int(size, 16) == 0 or not member or member.group(1) == "libgoe_port":
            continue
        if member.group(1) == "libgoe":
            module = modules[member.group(2)]
            name = section[len(".text.") :] or module
        else:
            module = "C library" if member.group(1) in ("libc", "libm") else "compiler's library"
            name = section[len(".text.") :] or member.group(2).split(".")[0]
        result.append(Code(int(start, 16), int(start, 16) + int(size, 16), module, name))
    return sorted(result, key=lambda code: code.start)


def track_names() -> list[str]:
    text = (ROOT / "tests" / "targets" / "embedded_logs.c").read_text(encoding="utf-8")
    return re.findall(r'^    \{"(\w+)", ', text, re.MULTILINE)


def counted_calls(built: Build, plugin: Path, folder: Path) -> list[Call]:
    code = code_of_map(built.map_file().read_text(encoding="utf-8"), module_names(built))
    ranges, counts = folder / "ranges", folder / "counts"
    lines = [f"{c.start:x} {c.end:x} {'E' if c.name in PUBLIC else 'C'} {c.name.replace(' ', '_')}" for c in code]
    ranges.write_text("\n".join(lines) + "\n", encoding="utf-8")
    built.run_image(built.image("replay"), "-plugin", f"{plugin},map={ranges},out={counts}")
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


def count(calls: Sequence[Call]) -> Count:
    functions = {name: Spread.of([call.total for call in calls if call.function == name]) for name in PUBLIC}
    updates = [call for call in calls if call.function == "goe_update"]
    for method, name in UPDATES.items():
        own = [call for call in updates if call.method == method]
        functions[name] = Spread.of([call.total for call in own if not call.track.startswith(LENS_TRACKS)])
        lens = [call.total for call in own if call.track.startswith(LENS_TRACKS)]
        functions[f"{name} {WITH_LENS}"] = Spread.of(lens)
    plain = [call for call in updates if call.method == "filter" and not call.track.startswith(LENS_TRACKS)]
    modules = sorted({module for call in plain for module, _ in call.parts})
    by_module = {
        module: Spread.of([sum(n for (m, _), n in call.parts.items() if m == module) for call in plain])
        for module in modules
    }
    worst = max(plain, key=lambda call: call.total)
    return Count(functions, by_module, worst.track, dict(sorted(worst.parts.items(), key=lambda item: -item[1])))
