"""Cost of the flight layer's calls (port/flight): instructions, counted under QEMU over the embedded logs.

python -m ci flight_cost            on the Cortex-M4F with gcc -Os and -O2
python -m ci flight_cost m33-gcc-o2

The command fails if a call on the Cortex-M4F takes more than goe_flight.h states.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from bench.count_plugin import build_plugin
from bench.running import ROOT, LedgerError, output_of

from .building import Build, build
from .instructions import Spread
from .ledger import BUILDS
from .targets import compiler_title, missing_tool, processor_title

PRESETS = ("m4f-gcc-os", "m4f-gcc-o2")  # whose cost goe_flight.h states
HEADER = ROOT / "port" / "flight" / "goe_flight.h"
SLOTS = 4
EXIT_MORE = 1
PUBLIC = (  # called in flight
    "goe_flight_init",
    "goe_flight_attitude",
    "goe_flight_position",
    "goe_flight_frame",
    "goe_flight_assess",
    "goe_flight_obstacle",
    "goe_flight_sectors",
)
CALLERS = ("main", "fly", "give_samples", "give_frame", "read_layer")  # of tests/targets/flight_main.c


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("presets", nargs="*", metavar="PRESET", default=list(PRESETS), help=f"targets; default: {' '.join(PRESETS)}")
    add("--build", type=Path, default=BUILDS, metavar="DIR", help="folder with the builds; default build/tests/targets")


def ranges_of(symbols: str) -> list[tuple[int, int, str]]:
    """Start, end and name of each function in the output of nm -S, except the callers of the layer, where a call
    ends."""
    found = re.findall(r"^([0-9a-f]+) ([0-9a-f]+) [tTwW] ([\w.]+)$", symbols, re.MULTILINE)
    starts = {int(start, 16) & ~1: (int(size, 16), name) for start, size, name in found if name not in CALLERS}
    return [(start, start + size, name) for start, (size, name) in sorted(starts.items())]


def calls_of(counts: str, names: list[str]) -> dict[str, Spread]:
    """Instructions of the calls of each function, from the plugin's output."""
    totals: dict[str, list[int]] = defaultdict(list)
    for line in counts.splitlines():
        entry, total, *_ = line.split()
        totals[names[int(entry)]].append(int(total))
    return {name: Spread.of(values) for name, values in totals.items()}


def measured(built: Build, folder: Path) -> dict[str, Spread]:
    image = built.image("flight")
    output_of(["cmake", "--build", built.tree, "--target", image.stem])
    ranges = ranges_of(built.tool("nm", "-S", image))
    file, counts = folder / "ranges", folder / "counts"
    lines = [f"{start:x} {end:x} {'E' if name in PUBLIC else 'C'} {name}" for start, end, name in ranges]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    built.run_image(image, "-plugin", f"{build_plugin(folder)},map={file},out={counts}")
    spreads = calls_of(counts.read_text(encoding="utf-8"), [name for _, _, name in ranges])
    if missing := set(PUBLIC) - set(spreads):
        raise LedgerError(f"{built.preset}: no call of {', '.join(sorted(missing))}")
    return spreads


def stated(header: str) -> dict[str, int]:
    """The most instructions of each call, from the manual's paragraph."""
    (paragraph,) = re.findall(r"^ \* Cost +(.*?)^ \* Failure", header, re.MULTILINE | re.DOTALL)
    numbers = [int(n.replace(",", "")) for n in re.findall(r"\b\d{1,3}(?:,\d{3})+\b|\b\d{3}\b", paragraph)]
    sample, frame, assessment, _further, obstacle, sectors, slot = numbers
    return dict(zip(PUBLIC, (SLOTS * slot, sample, sample, frame, assessment, obstacle, sectors)))


def exceeded(columns: dict[str, dict[str, Spread]], limits: dict[str, int]) -> list[str]:
    return [
        f"{preset}: {name}: {spreads[name].max} instructions, goe_flight.h states {limits[name]}"
        for preset, spreads in columns.items()
        for name in PUBLIC
        if preset in PRESETS and spreads[name].max > limits[name]
    ]


def table(columns: dict[str, dict[str, Spread]]) -> str:
    titles = [f"{processor_title(preset)} {compiler_title(preset)}" for preset in columns]
    lines = ["| instructions per call: mean / most | " + " | ".join(titles) + " |", "|---|" + "---|" * len(titles)]
    for name in PUBLIC:
        cells = [f"{spreads[name].mean:.0f} / {spreads[name].max}" for spreads in columns.values()]
        lines.append(f"| `{name}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def run(arguments: argparse.Namespace) -> int:
    columns = {}
    for preset in arguments.presets:
        if missing := missing_tool(preset):
            print(f"skipped: {preset} (no {missing})", file=sys.stderr)
            continue
        with tempfile.TemporaryDirectory() as name:
            columns[preset] = measured(build(preset, arguments.build), Path(name))
    print(table(columns))
    more = exceeded(columns, stated(HEADER.read_text(encoding="utf-8")))
    print("".join(f"{line}\n" for line in more), end="", file=sys.stderr)
    return EXIT_MORE if more else 0
