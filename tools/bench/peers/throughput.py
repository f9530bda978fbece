"""Updates per second of the whole library on one core of this machine, by kind of update."""

from __future__ import annotations

from pathlib import Path

from .build import PEERS, ROOT, Builder, library_includes, library_sources, output_of, own_program

REPLAY = ROOT / "tests" / "targets"
FULL = (10000, 1000000)  # most obstacles; least updates of each number and kind
QUICK = (10, 1)
KINDS = ("window", "filter", "filter and hazard")
COLUMNS = (
    "obstacles",
    "state, KiB",
    *(f"{kind}: updates per second" for kind in KINDS),
    "time of filter over window",
    "of filter and hazard over filter",
)
TITLE = "Updates of the whole library on one core, built with the library's flags"


def throughput_program(builder: Builder) -> Path:
    """The program, which the builder makes."""
    sources = [PEERS / "throughput.c", REPLAY / "replay.c", REPLAY / "embedded_logs.c", *library_sources()]
    return own_program(builder, "throughput", sources, [*library_includes(), f"-I{REPLAY}"])


def throughput_table(program: Path, size: tuple[int, int]) -> list[str]:
    lines = [TITLE, "", f"| {' | '.join(COLUMNS)} |", "|---" * len(COLUMNS) + "|"]
    for line in output_of([program, *map(str, size)]).splitlines():
        count, state, *times = line.split()
        window, refined, with_hazard = (float(time) for time in times)  # ns
        speeds = [f"{1.0e9 / time:.0f}" for time in (window, refined, with_hazard)]
        cells = [count, state, *speeds, f"{refined / window:.2f}", f"{with_hazard / refined:.2f}"]
        lines.append(f"| {' | '.join(cells)} |")
    return lines
