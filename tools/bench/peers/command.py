"""Comparison of the library with other solvers of the same problems, in one run on one machine.

All solvers solve the same cases. On the host they are timed; on a Cortex-M4F under QEMU their instructions are counted
and their stack is painted; on both, their answers are compared with double precision. Every solver is built twice:
with the library's flags, and with flags that allow the compiler everything, from which most peers profit.

    python -m bench peers [--cmsis-dsp DIR] [--tinyekf DIR] [window | update | throughput ...]

tools/peers/README.md describes the comparisons and the columns.
"""

from __future__ import annotations

import argparse
import platform
import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from tqdm import tqdm

from .build import BEST_HOST_FLAGS, FLAG_SETS, M4F, Builder, LedgerError, build_plugin, missing_tool, output_of
from .job import Counted, Group, Job, Peer
from .measure import Bench, Result
from .others import find_others
from .throughput import FULL, QUICK, throughput_program, throughput_table
from .update import update_job
from .window import window_job

JOBS = {"window": window_job, "update": update_job}
THROUGHPUT = "throughput"
PARTS = (*JOBS, THROUGHPUT)
SECONDS, QUICK_SECONDS = 0.5, 0.01  # for a solver and a group of cases, on the host
EXIT_FAILED = 1

# -------------------------------------------------------------------------------------------------------------- tables

COLUMNS = (
    "solver", "flags", "host, ns", "over ours", "M4F, instructions: mean (max)", "over ours", "M4F stack, bytes",
    "M4F code, bytes",
)  # fmt: skip
Results = dict[tuple[str, str], Result]  # by solver and set of flags


def shown(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def mean(counts: Sequence[int] | None) -> float | None:
    return None if counts is None else sum(counts) / len(counts)


def ratio(figure: float | None, ours: float | None) -> float | None:
    return None if figure is None or not ours else figure / ours


def row(peer: Peer, set_name: str, results: Results) -> str:
    result, ours = results[peer.name, set_name], results[peer.against, set_name]
    count, our_count = mean(result.instructions), mean(ours.instructions)
    cells = [
        peer.name,
        set_name,
        shown(result.nanoseconds, ".0f"),
        shown(ratio(result.nanoseconds, ours.nanoseconds), ".2f"),
        "-" if result.instructions is None else f"{count:.0f} ({max(result.instructions)})",
        shown(ratio(count, our_count), ".2f"),
        shown(result.stack, "d"),
        shown(result.code, "d"),
    ]
    return f"| {' | '.join([*cells, *(shown(error, '.1e') for error in result.errors)])} |"


def bound_row(bound: Counted, results: Results, columns: int) -> str:
    ours = results.get((bound.against, bound.set_name), Result())
    count = mean(bound.instructions)
    cells = [bound.name, bound.set_name, "-", "-", f"{count:.0f} ({max(bound.instructions)})"]
    cells.append(shown(ratio(count, mean(ours.instructions)), ".2f"))
    return f"| {' | '.join([*cells, *['-'] * (columns - len(cells))])} |"


def table(job: Job, group: Group, results: Results) -> Iterator[str]:
    columns = [*COLUMNS, *job.error_names]
    yield from (f"{job.title}: {group.name}", "", f"| {' | '.join(columns)} |", "|---" * len(columns) + "|")
    for peer in job.peers:
        yield from (row(peer, set_name, results) for set_name in FLAG_SETS if (peer.name, set_name) in results)
    sets = {set_name for _, set_name in results}
    yield from (bound_row(bound, results, len(columns)) for bound in job.bounds(group) if bound.set_name in sets)


def processor() -> str:
    text = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    model = re.search(r"^model name\s*: (.*)$", text, re.MULTILINE)
    return model.group(1) if model else platform.processor()


def closing(with_target: bool) -> Iterator[str]:
    """Compilers and flags of the figures."""
    own, best = (" ".join(flags) for flags in FLAG_SETS.values())
    yield f"own: {own}; best: {best}, on the host with {' '.join(BEST_HOST_FLAGS)}"
    yield f"host: {processor()}, {output_of(['gcc', '--version']).splitlines()[0]}"
    if with_target:
        yield f"M4F: {output_of(['arm-none-eabi-gcc', '--version']).splitlines()[0]}, {' '.join(M4F)}"


# --------------------------------------------------------------------------------------------------------------- shell


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("parts", nargs="*", metavar="PART", help=f"parts to compare: {', '.join(PARTS)}; default: all")
    add("--eigen", type=Path, default=Path("/usr/include/eigen3"), metavar="DIR", help="folder of Eigen/")
    add("--cmsis-dsp", type=Path, metavar="DIR", help="sources of CMSIS-DSP (its folder with Include and Source)")
    add("--tinyekf", type=Path, metavar="DIR", help="sources of TinyEKF")
    add("--quick", action="store_true", help="library flags only, few cases: to test this command")


def measured(bench: Bench, set_names: Sequence[str]) -> list[Results]:
    """One for each group."""
    programs = {(peer, name): bench.programs(peer, name) for peer in bench.job.peers for name in set_names}
    bench.builder.make()
    found: list[Results] = [{} for _ in bench.job.groups]
    title = bench.job.folder.name
    for (peer, name), made in tqdm(programs.items(), title, unit="run", disable=not sys.stderr.isatty()):
        for results, result in zip(found, bench.measure(peer, made)):
            results[peer.name, name] = result
    return found


def compare_solvers(arguments: argparse.Namespace, names: Sequence[str], builder: Builder) -> None:
    others = find_others(arguments)
    tool = missing_tool()
    if tool is not None:
        print(f"skipped: Cortex-M4F: no {tool}")
    plugin = build_plugin(builder.folder) if tool is None else None
    set_names = list(FLAG_SETS)[:1] if arguments.quick else list(FLAG_SETS)
    for name in names:
        job = JOBS[name](builder, others, arguments.quick)
        bench = Bench(builder, job, QUICK_SECONDS if arguments.quick else SECONDS, plugin)
        for group, results in zip(job.groups, measured(bench, set_names)):
            print(*table(job, group, results), "", sep="\n", flush=True)


def compare(arguments: argparse.Namespace, parts: Sequence[str], builder: Builder) -> None:
    jobs = [name for name in JOBS if name in parts]
    if jobs:
        compare_solvers(arguments, jobs, builder)
    if THROUGHPUT in parts:
        program = throughput_program(builder)
        builder.make()
        print(*throughput_table(program, QUICK if arguments.quick else FULL), "", sep="\n")
    print(*closing(bool(jobs) and missing_tool() is None), sep="\n")


def run(arguments: argparse.Namespace) -> int:
    unknown = set(arguments.parts) - set(PARTS)
    if unknown:
        raise ValueError(f"no such part: {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    with tempfile.TemporaryDirectory() as name:
        try:
            compare(arguments, arguments.parts or PARTS, Builder(Path(name)))
        except LedgerError as error:
            print(f"peers: {error}", file=sys.stderr)
            return EXIT_FAILED
    return 0
