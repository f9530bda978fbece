"""The command ``rare``: runs ``goe_avoid`` many times and records rare events.

    python -m goe_tools rare --flights N --out FILE [--jobs N | --scheduler ADDRESS]

It continues an existing file if its first flights still give the same result. An interruption loses a few seconds.
"""

from __future__ import annotations

import argparse
import datetime
import re
import subprocess
import tempfile
from functools import partial
from pathlib import Path

from tqdm import tqdm

from ..places import ROOT
from ..spread import add_arguments as add_workers
from ..spread import spread, workers_of
from .avoid_file import KINDS, read_avoid
from .rare_record import (
    EVENTS,
    FIRST_SEED,
    FLIGHTS_OF_RUN,
    Counts,
    Record,
    added,
    events_of,
    flights,
    interval,
    out_of,
    read_record,
)

PROGRAM = ROOT / "build" / "sim_host" / "goe_avoid"
HASH = ROOT / "tests" / "targets" / "flight_hash.txt"
CHUNK_RUNS = 20
FLIGHTS_OF_CHUNK = CHUNK_RUNS * len(KINDS) * sum(FLIGHTS_OF_RUN.values())


def fly(program: Path, first_seed: int) -> Counts:
    """CHUNK_RUNS runs of each kind of obstacle and course."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "runs.csv"
        command = [str(program), "--runs", str(CHUNK_RUNS), "--seed", str(first_seed), "--csv", str(rows)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise ValueError(done.stderr.strip() or f"{program}: ended with {done.returncode}")
        return events_of(read_avoid(rows))


def version_of(program: Path) -> str:
    if not program.exists():
        raise FileNotFoundError(f"{program} is not built (cmake --build build)")
    text = subprocess.run([str(program), "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"[0-9]+\.[0-9]+\.[0-9]+", text)
    return found[0] if found else text.strip()


def begun(path: Path, program: Path, version: str, flight_hash: str) -> Record:
    if not path.exists():
        return Record(version, flight_hash)
    record = read_record(path)
    if (record.version, record.flight_hash) != (version, flight_hash):
        theirs, ours = f"version {record.version}, hash {record.flight_hash}", f"version {version}, hash {flight_hash}"
        raise ValueError(f"{path} has {theirs}; this program has {ours}; name another file")
    if fly(program, FIRST_SEED) != record.first:
        raise ValueError(
            f"{path}: its first flights now give another result, so the program has changed; name another file"
        )
    return record


def print_record(record: Record) -> None:
    print(f"{flights(record.counts)} simulated flights; 95 % intervals after Clopper and Pearson")
    for course, kinds in record.counts.items():
        for kind, of in kinds.items():
            for name in EVENTS[course]:
                low, high = interval(of[name], out_of(of, name))
                print(f"{course:9} {kind:8} {name:11} {of[name]:6} of {out_of(of, name):8}  {low:.2g} to {high:.2g}")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--flights", type=int, required=True, metavar="N", help="total number, including those in FILE")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the record; continued if it exists")
    parser.add_argument("--program", type=Path, default=PROGRAM, help=argparse.SUPPRESS)
    add_workers(parser)


def run(arguments: argparse.Namespace) -> int:
    workers = workers_of(arguments)
    if arguments.flights < 1:
        raise ValueError(f"--flights {arguments.flights}: must be at least 1")
    record = begun(arguments.out, arguments.program, version_of(arguments.program), HASH.read_text().split()[0])
    have = flights(record.counts)
    seeds = [
        FIRST_SEED + record.runs + CHUNK_RUNS * k
        for k in range(max(0, -(-(arguments.flights - have) // FLIGHTS_OF_CHUNK)))
    ]
    with tqdm(total=arguments.flights, initial=have, desc="flights", unit="", disable=None) as bar:
        for counts in spread(partial(fly, arguments.program), seeds, workers):
            record.counts = added(record.counts, counts) if record.counts else counts
            record.first = record.first or counts
            record.runs += CHUNK_RUNS
            record.date = datetime.date.today().isoformat()
            record.write(arguments.out)
            bar.update(FLIGHTS_OF_CHUNK)
    print_record(record)
    return 0
