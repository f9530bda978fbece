"""The command ``campaign``: goe_campaign in parts, distributed over processes or over a cluster.

    python -m goe_tools campaign --out DIR [--seeds N] [--studies NAMES] [--series] [--jobs N | --scheduler ADDRESS]

DIR gets the same files as from one run of goe_campaign, byte for byte, except for jobs and wall_s in campaign.json.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ..logs.whole_file import replacing_all
from ..places import ROOT
from ..spread import Workers, each, workers_of
from ..spread import add_arguments as add_workers

PROGRAM = ROOT / "build" / "sim_host" / "goe_campaign"
CASES, FACTS, SERIES = "cases.csv", "campaign.json", "series"
SUMS = ("flights", "flights_ended_early", "frames", "runs", "series")  # of campaign.json, over the parts
PARTS = 64  # for any number of workers: enough that none waits long for the last one
SERIES_ENDINGS = ("_auto.csv", "_disc.csv", "_filter.csv")


@dataclass(frozen=True)
class Flown:
    """The files of a part, perhaps from another machine."""

    cases: bytes
    facts: dict[str, Any]
    series: dict[str, bytes]


def fly(program: Path, options: tuple[str, ...], part: int) -> Flown:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "part"
        how = ["--quiet", "--jobs", "1", "--part", f"{part}/{PARTS}", "--out", str(out)]
        done = subprocess.run([str(program), *options, *how], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            reason = done.stderr.strip().replace("goe_campaign: ", "", 1)
            raise ValueError(reason or f"{program}: ended with {done.returncode}")
        series = {path.name: path.read_bytes() for path in sorted((out / SERIES).iterdir())}
        return Flown((out / CASES).read_bytes(), json.loads((out / FACTS).read_text(encoding="utf-8")), series)


def joined(parts: list[Flown]) -> Flown:
    """The files of one run: the first part's header, every part's rows."""
    facts = {**parts[0].facts, **{name: sum(part.facts[name] for part in parts) for name in SUMS}}
    cases = parts[0].cases + b"".join(part.cases.split(b"\n", 1)[1] for part in parts[1:])
    return Flown(cases, facts, {name: content for part in parts for name, content in part.series.items()})


def write(folder: Path, flown: Flown) -> None:
    """Replaces the folder's files once all are written, cases.csv last, then removes series of an earlier campaign."""
    facts = (json.dumps(flown.facts, indent=2) + "\n").encode()
    fresh = {folder / CASES: flown.cases, folder / FACTS: facts}
    fresh.update({folder / SERIES / name: content for name, content in flown.series.items()})
    (folder / SERIES).mkdir(parents=True, exist_ok=True)
    with replacing_all(fresh) as places:
        for place, content in zip(places, fresh.values()):
            place.write_bytes(content)
    for path in (folder / SERIES).iterdir():
        earlier = path.name.endswith(SERIES_ENDINGS) and path.name.split("_")[0].isdigit()
        if earlier and path not in fresh:
            path.unlink()


def check_out(folder: Path) -> None:
    """ValueError before the flights, not after them."""
    place = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
        raise ValueError(f"{folder}: cannot be written")


def count_of(workers: Workers) -> int:
    return 0 if workers.scheduler else workers.jobs  # the number of a cluster's workers may change


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, default=Path("campaign"), metavar="DIR", help="default: campaign")
    parser.add_argument("--seeds", type=int, default=1, metavar="N", help="fly everything with the seeds 1 to N")
    parser.add_argument("--studies", default="all", metavar="NAMES", help="see goe_campaign --help")
    parser.add_argument("--series", action="store_true", help="write time series of all the paper's cases")
    parser.add_argument("--program", type=Path, default=PROGRAM, help=argparse.SUPPRESS)
    add_workers(parser)


def run(arguments: argparse.Namespace) -> int:
    workers = workers_of(arguments)
    if not arguments.program.exists():
        raise FileNotFoundError(f"{arguments.program} is not built (cmake --build build)")
    check_out(arguments.out)
    options = ("--seeds", str(arguments.seeds), "--studies", arguments.studies, *["--series"] * arguments.series)
    begun = time.monotonic()
    flown = joined(each(partial(fly, arguments.program, options), range(1, PARTS + 1), workers, "parts"))
    seconds = round(time.monotonic() - begun, 3)
    write(
        arguments.out, Flown(flown.cases, {**flown.facts, "jobs": count_of(workers), "wall_s": seconds}, flown.series)
    )
    facts = flown.facts
    done = f"{facts['flights']} flights, {facts['frames']} frames, {facts['runs']} runs in {seconds:.1f} s"
    print(f"{done}: {arguments.out / CASES}")
    return 0
