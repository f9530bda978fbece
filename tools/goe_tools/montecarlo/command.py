"""The command ``montecarlo``: flies a scenario many times in simulation and reports errors, coverage and warnings.

    python -m goe_tools montecarlo SCENARIO [--runs N] [--seed N] [--out DIR] [--jobs N | --scheduler ADDRESS]

The runs use consecutive seeds from --seed on; a ``seed`` in the scenario is ignored. The results depend neither on the
number of processes nor on the machine that flew a run.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table
from tqdm import tqdm

from ..library import package
from ..logs.fields import LogError, read_text
from ..logs.whole_file import log_files
from ..spread import Workers, connect, deaf, spread, workers_of
from ..spread import add_arguments as add_workers
from ..view.command import add_options, options_of
from . import words
from .flown import PROGRAM, Pass, Scenario, fly
from .summary import Summary, summaries

DEFAULT_OUT = Path("montecarlo")
LAST_SEED = 2**62  # goe_sim's limit, minus a reserve for the runs
TABLE_WIDTH = 118


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("scenario", type=Path, metavar="SCENARIO", help="scenario file of goe_sim --scenario")
    add("--runs", type=int, default=100, metavar="N", help="flights (default 100)")
    add("--seed", type=int, default=1, metavar="N", help="of the first flight; the next ones add 1 each (default 1)")
    add("--out", type=Path, default=DEFAULT_OUT, metavar="DIR", help=f"output folder (default {DEFAULT_OUT})")
    add("--program", type=Path, default=PROGRAM, help=argparse.SUPPRESS)
    add_options(parser)
    add_workers(parser)


def read_scenario(arguments: argparse.Namespace) -> Scenario:
    if arguments.runs < 1:
        raise ValueError(f"--runs {arguments.runs}: must be at least 1")
    if not 0 <= arguments.seed < LAST_SEED:
        raise ValueError(f"--seed {arguments.seed}: must be 0 to {LAST_SEED}")
    if not arguments.program.exists():
        raise FileNotFoundError(f"{arguments.program} is not built (cmake --build build)")
    path = arguments.scenario
    text = read_text(path)
    return Scenario(str(path), text, os.getcwd(), str(arguments.program.resolve()), options_of(arguments))


def make_folder(path: Path) -> None:
    if any(file.exists() for file in log_files(path)):
        raise LogError(path, 0, "", "is the folder of a log; name another one with --out")
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None
    if not os.access(path, os.W_OK | os.X_OK):
        raise LogError(path, 0, "", "cannot be written")


def flights(scenario: Scenario, seeds: Sequence[int], workers: Workers, folder: Path) -> Iterator[list[Pass]]:
    """In the order of the seeds. The first run is flown in this process, so a mistake in the scenario is reported
    before the output folder or other processes exist."""
    first = fly(scenario, seeds[0])
    make_folder(folder)
    yield first
    if len(seeds) > 1:
        yield from spread(partial(fly, scenario), seeds[1:], workers)


def print_summary(found: Sequence[Summary], scenario: Scenario) -> None:
    console, options = Console(highlight=False), scenario.options
    if not console.is_terminal:
        console.width = max(console.width, TABLE_WIDTH)
    for one in found:
        table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
        for i, head in enumerate(words.HEADS):
            table.add_column(head, justify="right" if i else "left")
        for row in one.rows:
            if row.runs:
                table.add_row(*words.cells(row))
        console.print(f"Obstacle {one.obstacle}", style="bold")
        console.print(table)
        notes = [*words.warning_sentences(one.warnings, options.margin_m, options.clearance_m), words.unanswered(one)]
        for note in filter(None, notes):
            console.print(note, soft_wrap=True)
        console.print()
    console.print(words.HOW_TO_READ, soft_wrap=True)
    console.print(words.SIMULATION)


def report(scenario: Scenario, flown: Sequence[Sequence[Pass]], arguments: argparse.Namespace) -> None:
    from .files import write  # imported here: the drawing modules load slowly

    passes = [one for run in flown for one in run]
    if not passes:
        raise ValueError(f"{scenario.path}: no run took an image")
    found = summaries(passes)
    seeds = range(arguments.seed, arguments.seed + len(flown))
    paths = write(arguments.out, scenario, passes, found, seeds, arguments.runs, package().__version__)
    print_summary(found, scenario)
    print("\n".join(str(path) for path in paths))


def run(arguments: argparse.Namespace) -> int:
    workers, scenario = workers_of(arguments), read_scenario(arguments)
    seeds = range(arguments.seed, arguments.seed + arguments.runs)
    connect(workers)
    flown: list[list[Pass]] = []
    try:
        with tqdm(total=len(seeds), desc="flights", unit="", disable=None, leave=False) as bar:
            for passes in flights(scenario, seeds, workers, arguments.out):
                flown.append(passes)
                bar.update()
    except BaseException:  # Ctrl-C, a lost process or cluster: keeps the finished runs
        if flown:
            complete = f"{len(flown)} of {arguments.runs} runs are complete"
            print(f"stopped early: {complete}; writing their files", file=sys.stderr)
            with suppress(ValueError), deaf():
                report(scenario, flown, arguments)
        raise
    report(scenario, flown, arguments)
    return 0
