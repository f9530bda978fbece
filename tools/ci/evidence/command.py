"""The command ``evidence``: runs the parts, prints the table, keeps the record, makes the file of a release.

python -m ci evidence --quick | --long | --show [--only PART] ... [--record FILE]
python -m ci evidence --release VERSION [--record FILE]

All output of a run goes to build/evidence. A release commits one file, tests/evidence/VERSION.json.
"""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import re
import subprocess
import sys
import time
from pathlib import Path

from goe_tools.places import ROOT

from .parts import MODULES, Amount, NotHereError, runner
from .record import Kept, Release, newest_release, read, table, write, write_release

HASH = ROOT / "tests" / "targets" / "golden_hash.txt"
REPORTS = ROOT / "build" / "evidence"
RECORD = REPORTS / "record.json"
RELEASES = ROOT / "tests" / "evidence"


def machine() -> str:
    """Processor and compiler."""
    info = Path("/proc/cpuinfo").read_text(encoding="utf-8") if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")]
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True, check=False).stdout.splitlines()[:1]
    return ", ".join([names[0] if names else platform.machine(), *compiler])


def commit() -> str:
    """The checkout's commit; with "+" if files differ from it; "" outside a repository."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        return done.stdout.strip() if done.returncode == 0 else ""

    head = git("rev-parse", "HEAD")
    return head + ("+" if head and git("status", "--porcelain") else "")


def run_part(name: str, amount: Amount) -> Kept:
    begun = time.monotonic()
    result = runner(name)(amount)
    seconds = round(time.monotonic() - begun, 1)
    REPORTS.mkdir(parents=True, exist_ok=True)
    (REPORTS / f"{name}.txt").write_text(result.report + "\n", encoding="utf-8")
    today = datetime.date.today().isoformat()
    made_by = (today, HASH.read_text().split()[0], seconds, machine())
    return Kept(name, amount.name, *made_by, result.rows, commit(), os.cpu_count() or 1)


def release(version: str, kept: dict[str, Kept]) -> Path:
    """Writes the file of a release: all parts, from one commit."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        raise ValueError(f"--release {version}: not a version such as 0.4.0")
    missing = [name for name in MODULES if name not in kept or kept[name].amount != "long"]
    if missing:
        raise ValueError(f"--release: no long run of {', '.join(missing)} on record")
    commits = {entry.commit for entry in kept.values()}
    if len(commits) != 1 or commits <= {""} or next(iter(commits)).endswith("+"):
        raise ValueError(f"--release: parts ran on {', '.join(sorted(commits))}, not on one commit without changes")
    path = RELEASES / f"{version}.json"
    today = datetime.date.today().isoformat()
    parts = list(kept.values())
    write_release(path, Release(version, parts[0].commit, today, parts[0].machine, parts[0].cores, parts))
    return path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--quick", action="store_true", help="the parts that fit in ten minutes")
    how.add_argument("--long", action="store_true", help="everything; keeps the figures in the record")
    how.add_argument(
        "--show", action="store_true", help="run nothing, print the table of the record or of the newest release"
    )
    how.add_argument("--release", metavar="VERSION", help="make the release's file, tests/evidence/VERSION.json")
    parser.add_argument("--only", action="append", choices=sorted(MODULES), metavar="PART", help=", ".join(MODULES))
    parser.add_argument("--updates", type=int, default=0, metavar="N", help="fuzzing: minimum number of updates")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes")
    parser.add_argument("--record", type=Path, default=RECORD, metavar="FILE", help="the record of long runs")


def run(arguments: argparse.Namespace) -> int:
    kept = read(arguments.record)
    if arguments.show:
        newest = newest_release(RELEASES) if arguments.record == RECORD else None
        print(table((kept or (read(newest) if newest else {})).values()))
        return 0
    if arguments.release:
        print(release(arguments.release, kept))
        return 0
    amount = Amount(arguments.long, arguments.jobs, arguments.updates)
    ran: list[Kept] = []
    failed: list[str] = []
    for name in arguments.only or MODULES:
        print(f"evidence: {name}: {MODULES[name]}", file=sys.stderr)
        try:
            ran.append(run_part(name, amount))
        except NotHereError as error:
            print(f"evidence: {name}: left out: {error}", file=sys.stderr)
            continue
        except RuntimeError as error:  # what it needs does not build or run: no reason to lose the other parts
            print(f"evidence: {name}: FAILED: {error}", file=sys.stderr)
            failed.append(name)
            continue
        print(f"evidence: {name}: {ran[-1].seconds:.0f} s, details in build/evidence/{name}.txt", file=sys.stderr)
        if arguments.long:
            kept[name] = ran[-1]
            write(arguments.record, kept.values())
    print(table(ran))
    if failed:
        print(f"evidence: no figures of {', '.join(failed)}: see above", file=sys.stderr)
    return 1 if failed or any(row.met is False for entry in ran for row in entry.rows) else 0
