"""Cost ledger: the measured cost of the library on each target.

    python -m ci ledger                  measure and print the tables
    python -m ci ledger m4f-gcc-o2       ... for one target
    python -m ci ledger --check          measure, compare, fail if a figure grew or a page has other tables
    python -m ci ledger --check-pages    measure nothing, compare the pages with the ledger
    python -m ci ledger --write          measure, write the ledger and the pages

The ledger is tests/targets/ledger.csv, its pages are tests/targets/LEDGER.md and a part of README.md. Figures: bytes of
code, constants and data per module and in total; bytes of the state per window length; the worst-case stack of each
public function, from the call graph and from painting under QEMU; instructions per call of each public function over
the embedded logs, and of goe_update per module; cost of the library's parts.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bench.count_plugin import build_plugin
from bench.running import ROOT, LedgerError
from tqdm import tqdm

from . import book
from .book import Figures, Ledger
from .growth import compare
from .guarantees import broken_promises
from .measuring import measure
from .pages import ledger_tables, write_pages, wrong_pages
from .targets import missing_tool, presets

LEDGER = ROOT / "tests" / "targets" / "ledger.csv"
BUILDS = ROOT / "build" / "tests" / "targets"  # where ctest builds the targets; existing builds are reused
EXIT_GREW = 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("presets", nargs="*", metavar="PRESET", help="targets to measure (default: all with installed tools)")
    add("--build", type=Path, default=BUILDS, metavar="DIR", help="folder with the builds; default build/tests/targets")
    add("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="targets at a time (default: processors)")
    add("--ledger", type=Path, default=LEDGER, metavar="FILE", help="default tests/targets/ledger.csv")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", action="store_true", help="fail if a figure is more than 2 %% above the ledger's")
    what.add_argument("--check-pages", action="store_true", help="measure nothing, fail if a page has other tables")
    what.add_argument("--write", action="store_true", help="write the ledger and its pages")


def measured(wanted: Sequence[str], folder: Path, jobs: int) -> Ledger:
    """The ledger of the presets with installed tools; reports the others."""
    folder.mkdir(parents=True, exist_ok=True)
    plugin = build_plugin(folder)
    able = []
    for preset in wanted:
        missing = missing_tool(preset)
        if missing:
            print(f"skipped: {preset}: no {missing}")
        else:
            able.append(preset)

    def figures(preset: str) -> Figures:
        return measure(preset, folder, plugin)

    with ThreadPoolExecutor(max(jobs, 1)) as pool:
        try:
            progress = tqdm(pool.map(figures, able), total=len(able), unit="target", disable=not sys.stderr.isatty())
            return dict(zip(able, progress))
        finally:
            pool.shutdown(cancel_futures=True)


def merged(before: Ledger, now: Ledger) -> Ledger:
    """The ledger with the new measurements, in the order of the presets."""
    both = before | now
    return {preset: both[preset] for preset in presets() if preset in both}


def run(arguments: argparse.Namespace) -> int:
    unknown = set(arguments.presets) - set(presets())
    if unknown:
        raise ValueError(f"no such target: {', '.join(sorted(unknown))}; there are {', '.join(presets())}")
    failures: list[str] = []
    now: Ledger = {}
    if not arguments.check_pages:
        try:
            now = measured(arguments.presets or presets(), arguments.build, arguments.jobs)
        except LedgerError as error:
            print(f"ledger: {error}", file=sys.stderr)
            return EXIT_GREW
        failures += broken_promises(now)
    if arguments.write:
        ledger = merged(book.read(arguments.ledger) if arguments.ledger.exists() else {}, now)
        book.write(arguments.ledger, ledger)
        write_pages(ROOT, book.read(arguments.ledger))  # in the file's order, which a new module changes
    elif arguments.check or arguments.check_pages:
        ledger = book.read(arguments.ledger)
        failures += compare(ledger, now) + wrong_pages(ROOT, ledger)
    else:
        print(ledger_tables(now), end="")
    for failure in failures:
        print(f"ledger: {failure}", file=sys.stderr)
    return EXIT_GREW if failures else 0
