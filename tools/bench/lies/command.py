"""Searches for lies: confident errors, false safety and warnings that vanish.

python -m bench lies --flights 100000 --json FILE"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import goe
from goe_tools import spread
from goe_tools.spread import Workers
from rich.console import Console
from tqdm import tqdm

from . import record, search
from .decode import decode
from .evolve import Best, evolve
from .finds import KINDS
from .genes import MIXES, Flights
from .goals import BLOCK, block
from .show import from_json, show, to_json
from .shrink import Want, shrink, want_of
from .tally import Key, Tally

FLIGHTS = 10_000
LOGS_MOST = 60
Job = tuple[Key, Flights, Path]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--flights", type=int, metavar="N", help=f"random flights (default {FLIGHTS}; with --seconds: no limit)")
    add("--seconds", type=float, metavar="S", help="stop after this time")
    add("--seed", type=int, default=1, metavar="N", help="of the flights (default 1)")
    add("--mix", action="append", choices=MIXES, help="features; may be repeated (default: all)")
    add("--evolve", type=int, default=0, metavar="GENERATIONS", help="then evolve the worst flights of each mix")
    add("--out", type=Path, metavar="DIR", help="reduce a flight of each class, and write it as a log")
    add("--json", type=Path, metavar="FILE", help="write the counts")
    add("--show", type=Path, metavar="FILE", help="print the table of such a file without a search")
    add("--page", type=Path, metavar="FILE", help="with --show: write the table of goals to this page")
    spread.add_arguments(parser)


def _checked(arguments: argparse.Namespace) -> int:
    """The number of flights."""
    most = 10**12 if arguments.seconds is not None else FLIGHTS
    flights = most if arguments.flights is None else arguments.flights
    for name, value in (("--flights", flights), ("--seed", arguments.seed + 1), ("--evolve", arguments.evolve + 1)):
        if value < 1:
            raise ValueError(f"{name}: too small")
    return int(flights)


def _chosen(tally: Tally, seed: int, mixes: list[int]) -> dict[str, tuple[Key, Flights]]:
    """A flight of each class, by output folder: lost warnings first, then the most frequent classes."""
    keys = sorted(tally.examples, key=lambda key: (-KINDS.index(key[0]), -tally.counts[("class", *key)], key))
    keys = keys[:LOGS_MOST]
    found = {}
    for key in keys:
        example = tally.examples[key]
        task = search.Task(seed, example.batch, example.row + 1, tuple(mixes))
        status = str(goe.Status(int(key[-1])))
        found["-".join((*key[:-1], status))] = key, search.flights_of(task).take([example.row])
    return found


def _shrunk(job: Job) -> str:
    key, flights, folder = job
    want: Want = want_of(key)
    found = record.write(folder, shrink(decode(flights), want), want)
    return f"{folder}: {found['wrong']}"


def _write(out: Path, chosen: dict[str, tuple[Key, Flights]], workers: Workers) -> None:
    jobs = [(key, flights, out / name.replace(" ", "_")) for name, (key, flights) in chosen.items()]
    console = Console(highlight=False)
    for line in tqdm(
        spread.spread(_shrunk, jobs, workers), total=len(jobs), desc="shrinking", disable=None, leave=False
    ):
        console.print(line, soft_wrap=True)


def _bred(best: dict[Key, Best]) -> None:
    console = Console(highlight=False)
    console.print("evolved (1 and more: a find; confident errors as multiples of the limit)")
    for key, one in sorted(best.items()):
        console.print(f"  {key[1]}: {key[0]}, {key[2]}: {one.score:.2f}")


def run(arguments: argparse.Namespace) -> int:
    if arguments.show is not None:
        about, counts = from_json(arguments.show)
        if arguments.page is not None:
            BLOCK.write(arguments.page, block(about, counts))
        show(counts, about)
        return 0
    if arguments.page is not None:
        raise ValueError("--page: needs --show")
    flights, workers = _checked(arguments), spread.workers_of(arguments)
    mixes = [MIXES.index(name) for name in dict.fromkeys(arguments.mix or MIXES)]
    tally = search.search(arguments.seed, mixes, flights, arguments.seconds, workers)
    best = evolve(arguments.seed, mixes, arguments.evolve, workers) if arguments.evolve else {}
    about = {"seed": arguments.seed, "mixes": [MIXES[mix] for mix in mixes], "two_cameras": goe.CAMERAS_MAX > 1}
    found = to_json(tally, about)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    show(tally.counts, found)
    if best:
        _bred(best)
    if arguments.out is not None:
        chosen = _chosen(tally, arguments.seed, mixes)
        chosen |= {"-".join(("bred", *key)): (key, one.flights) for key, one in best.items()}
        _write(arguments.out, chosen, workers)
    return 0
