"""The command ``evidence``: runs the parts, prints the table, keeps the record.

python -m goe_tools evidence --quick | --long | --show [--only PART] ... [--record FILE]
python -m goe_tools evidence --page FILE | --check-page FILE
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import subprocess
import sys
import time
from pathlib import Path

from ..places import ROOT
from . import testing_page
from .parts import MODULES, Amount, NotHereError, runner
from .record import Kept, read, table, write

HASH = ROOT / "tests" / "targets" / "golden_hash.txt"
RECORD = ROOT / "tests" / "evidence" / "record.json"
REPORTS = ROOT / ".cache" / "evidence"


def machine() -> str:
    """Processor and compiler."""
    told = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in told.splitlines() if line.startswith("model name")]
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True, check=False).stdout.splitlines()[:1]
    return ", ".join([names[0] if names else platform.machine(), *compiler])


def run_part(name: str, amount: Amount) -> Kept:
    begun = time.monotonic()
    result = runner(name)(amount)
    seconds = round(time.monotonic() - begun, 1)
    REPORTS.mkdir(parents=True, exist_ok=True)
    (REPORTS / f"{name}.txt").write_text(result.report + "\n", encoding="utf-8")
    today = datetime.date.today().isoformat()
    return Kept(name, amount.name, today, HASH.read_text().split()[0], seconds, machine(), result.rows)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--quick", action="store_true", help="what fits ten minutes")
    how.add_argument("--long", action="store_true", help="all of it, and keep the figures in the record")
    how.add_argument("--show", action="store_true", help="print the record's table, run nothing")
    how.add_argument("--page", type=Path, metavar="FILE", help="put counts and the record's table into a page")
    how.add_argument("--check-page", type=Path, metavar="FILE", help="fail if a page shows others")
    parser.add_argument("--only", action="append", choices=sorted(MODULES), metavar="PART", help=", ".join(MODULES))
    parser.add_argument("--updates", type=int, default=0, metavar="N", help="fuzzing: at least so many updates")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes")
    parser.add_argument("--record", type=Path, default=RECORD, metavar="FILE", help="the record of long runs")


def run(arguments: argparse.Namespace) -> int:
    kept = read(arguments.record)
    if arguments.show:
        print(table(kept.values()))
        return 0
    if arguments.page:
        testing_page.write(arguments.page, kept)
        return 0
    if arguments.check_page:
        page = arguments.check_page
        wrong = list(testing_page.stale(testing_page.FIGURES.of(page), kept))
        print(*(f"{page}: {what}: python -m goe_tools evidence --page {page}" for what in wrong), sep="\n")
        return 1 if wrong else 0
    amount = Amount(arguments.long, arguments.jobs, arguments.updates)
    ran: list[Kept] = []
    for name in arguments.only or MODULES:
        print(f"evidence: {name}: {MODULES[name]}", file=sys.stderr)
        try:
            ran.append(run_part(name, amount))
        except NotHereError as error:
            print(f"evidence: {name}: left out: {error}", file=sys.stderr)
            continue
        print(f"evidence: {name}: {ran[-1].seconds:.0f} s, details in .cache/evidence/{name}.txt", file=sys.stderr)
        if arguments.long:
            kept[name] = ran[-1]
            write(arguments.record, kept.values())
    print(table(ran))
    return 1 if any(row.met is False for entry in ran for row in entry.rows) else 0
