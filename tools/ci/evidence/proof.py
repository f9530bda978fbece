"""Proof with Frama-C's Eva that no call of the library has undefined behavior, for any input bits.

tests/proof/README.md lists the proved properties and the assumptions. tests/proof/alarms.csv has every remaining alarm
with its reason; a new alarm fails, and so does one that no longer appears.
"""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Iterable
from pathlib import Path

from .frama_c import DRIVERS, Analyzer, Driver, Property, Run, library_functions, run_all
from .parts import Amount
from .record import Result, Row

ALARMS = DRIVERS / "alarms.csv"
MACHINES = ("gcc_x86_64", "gcc_x86_32")  # the second represents 32-bit ARM: the same sizes of int, long and pointers

# Unrolls loops of up to nine turns, and all with a constant number of turns. Floats are arbitrary.
PLAIN = (
    *("-eva-domains", "cvalue", "-eva-slevel", "20", "-eva-ilevel", "24", "-eva-plevel", "70"),
    *("-eva-widening-delay", "2", "-eva-subdivide-non-linear", "0"),
    *("-eva-min-loop-unroll", "9", "-eva-auto-loop-unroll", "128"),
    "-eva-slevel-function",
    "find_pace:30,goe_align_points:40,name_at:2000,first_bad:20000,goe_settings_default:500",
)
FINITE = ("-eva-precision", "6", "-eva-subdivide-non-linear", "50")

LONG = (
    "update_refined",
    "covariance",
    "hazard",
    "decide",
    "intake_image",
    "settings_camera",
    "settings_general",
    "settings_refined",
)
QUICK = ("update_window", "short_calls", "intake_noise", "answer")
NUMBERS = ("angle", "exp", "normal", "rotation", "time", "mean")
ALL = (
    *(Driver(f"proof_{what}", PLAIN) for what in LONG),
    *(Driver(f"proof_{what}", PLAIN, quick=True) for what in QUICK),
    *(Driver(f"proof_finite_{what}", FINITE, finite=True) for what in NUMBERS),
)

Key = tuple[str, str, str, str, str]  # driver, file, function, kind, expression


def alarms_of(runs: Iterable[Run]) -> set[Key]:
    return {(run.driver, *entry.key) for run in runs for entry in run.properties if not entry.proved}


def read_alarms(path: Path) -> dict[Key, str]:
    """The reason of each alarm."""
    with path.open(encoding="utf-8", newline="") as file:
        return {
            (driver, row["file"], row["function"], row["kind"], row["expression"]): row["reason"]
            for row in csv.DictReader(file)
            for driver in row["drivers"].split()
        }


def compare(found: set[Key], explained: dict[Key, str], ran: set[str]) -> tuple[list[Key], list[Key], list[Key]]:
    """New alarms, entries that no longer appear, alarms without a reason."""
    new = sorted(found - set(explained))
    gone = sorted(key for key in explained if key[0] in ran and key not in found)
    return new, gone, sorted(key for key in found & set(explained) if not explained[key].strip())


def preconditions(runs: Iterable[Run]) -> tuple[int, int]:
    """Preconditions of the library's contracts, over all calls: number proved, and total."""
    proved: dict[tuple[str, str, str], bool] = {}
    for run in runs:
        for entry in run.properties:
            of_library = entry.kind.startswith("precondition") and entry.file.startswith("lib/")
            if of_library and entry.status != "Dead":  # unreachable
                key = (entry.file, entry.function, entry.text)
                proved[key] = proved.get(key, True) and entry.proved
    return sum(proved.values()), len(proved)


def describe(key: Key) -> str:
    driver, file, function, kind, text = key
    return f"{driver}: {file}: {function}: {kind}: {text}"


def run(amount: Amount) -> Result:
    drivers = [driver for driver in ALL if amount.long or driver.quick]
    machines = MACHINES if amount.long else MACHINES[:1]
    runs: list[Run] = []
    with tempfile.TemporaryDirectory() as work:
        for machine in machines:
            analyzer = Analyzer(Path(work), machine)
            runs += run_all(analyzer, drivers, amount.jobs)
    found = alarms_of(runs)
    explained = read_alarms(ALARMS)
    new, gone, silent = compare(found, explained, {entry.driver for entry in runs})
    library = library_functions()
    reached = library.intersection(*[set().union(*(entry.reached for entry in runs))])
    met, total = preconditions(runs)
    finite = [entry for entry in runs if entry.driver.startswith("proof_finite_")]
    rows = [
        Row(
            "functions of lib/ that Eva analyzed",
            f"{len(reached)} of {len(library)}",
            "all" if amount.long else "",
            len(reached) == len(library) if amount.long else None,
        ),
        Row("alarms", f"{len({key[1:] for key in found})}", "each explained in tests/proof/alarms.csv", not silent),
        Row("unexplained alarms", str(len(new)), "0", not new),
        Row("explained alarms that no longer appear", str(len(gone)), "0", not gone),
        Row("preconditions proved at every call", f"{met} of {total}", "", None),
        Row("runs for finite results", f"{len(finite)}", "", None),
    ]
    return Result(rows, report_of(runs, library - reached, new, gone))


def report_of(runs: list[Run], unreached: frozenset[str], new: list[Key], gone: list[Key]) -> str:
    lines = []
    for entry in runs:
        left = [one for one in entry.properties if not one.proved]
        lines.append(
            f"{entry.driver} ({entry.machine}): {entry.seconds} s, {len(entry.reached)} functions,"
            f" {len(entry.properties)} properties, {len(left)} alarms"
        )
    lines += ["", *(f"new: {describe(key)}" for key in new), *(f"gone: {describe(key)}" for key in gone)]
    lines += [f"not reached: {name}" for name in sorted(unreached)]
    return "\n".join(lines)


def merged(found: set[Key], explained: dict[Key, str]) -> list[dict[str, str]]:
    """Rows of the table: an alarm once, with the drivers that raise it."""
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for key in sorted(found):
        driver, file, function, kind, text = key
        row = rows.setdefault(
            key[1:],
            {"file": file, "function": function, "kind": kind, "expression": text, "drivers": "", "reason": ""},
        )
        row["drivers"] = f"{row['drivers']} {driver}".strip()
        row["reason"] = row["reason"] or explained.get(key, "")
    return list(rows.values())


__all__ = ["ALL", "Property", "alarms_of", "compare", "merged", "preconditions", "read_alarms", "run"]
