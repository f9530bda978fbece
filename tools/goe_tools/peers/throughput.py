"""Updates per second of the whole library on one core of this machine."""

from __future__ import annotations

from pathlib import Path

from .build import PEERS, ROOT, Builder, library_includes, library_sources, output_of, own_program

REPLAY = ROOT / "tests" / "targets"
FULL = (10000, 400000)  # most obstacles, updates per measurement
QUICK = (1, 100)


def throughput_program(builder: Builder) -> Path:
    """To be made by the builder."""
    sources = [PEERS / "throughput.c", REPLAY / "replay.c", REPLAY / "embedded_logs.c", *library_sources()]
    return own_program(builder, "throughput", sources, [*library_includes(), f"-I{REPLAY}"])


def throughput_table(program: Path, size: tuple[int, int]) -> list[str]:
    lines = ["| obstacles | updates per second, one core | ns per update | state, KiB |", "|---|---|---|---|"]
    return lines + [f"| {' | '.join(line.split())} |" for line in output_of([program, *map(str, size)]).splitlines()]
