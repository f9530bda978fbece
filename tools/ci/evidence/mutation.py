"""Part ``mutation``: whether the tests detect small changes of lib/, port/flight and port/companion.

A mutant of lib/ counts if it changes something detectable: a unit test fails, or the hash over all outputs of
the probe (tests/mutation/probe.c) changes. It is killed if a unit test of tests/c fails, ends by a signal, or takes
several times as long. The outcome of each mutant is kept in .cache/evidence, so a long run may be stopped and
continued. For the other two folders see mutation_trees.
"""

from __future__ import annotations

import itertools
import json
import multiprocessing
import os
import re
import shutil
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from goe_tools.places import ROOT

from . import mutation_trees, survivors
from .mutants import LIBRARY, Mutant, mutants, sources
from .mutation_bench import BITS, PROBE, Bench, hash_of, library_hash, test_hash, unit_tests
from .mutation_counts import (
    BY_HASH,
    EQUIVALENT,
    KILLED,
    NO_CODE,
    SAME_CODE,
    SURVIVED,
    Outcome,
    report,
    rows,
    rows_of_layer,
)
from .parts import Amount
from .record import Result, Row

LONG = 500
LONG_OF_LAYER = 200
QUICK = 15
SEED = 1  # of the mutants of port/flight and port/companion
TRIES = 6  # next mutants to try if a compiler refuses one
CACHE = ROOT / ".cache" / "evidence" / "mutation"


# ------------------------------------------------------------------------------------------------------------- choosing


def shares(sizes: Sequence[int], count: int) -> list[int]:
    """The share of ``count`` for each size; the rest goes to the largest remainders."""
    whole = sum(sizes)
    exact = [size * count / whole for size in sizes]
    found = [int(share) for share in exact]
    by_remainder = sorted(range(len(sizes)), key=lambda i: (found[i] - exact[i], i))
    for i in by_remainder[: count - sum(found)]:
        found[i] += 1
    return found


def strided(all_of_file: Sequence[Mutant], count: int) -> list[list[Mutant]]:
    """One mutant at each of ``count`` evenly spaced places, alternating among the changes at a place; with alternatives
    in case a compiler refuses it."""
    places = [list(at) for _, at in itertools.groupby(all_of_file, key=lambda mutant: mutant.begin)]
    groups = []
    for i in range(count):
        first = int((i + 0.5) * len(places) / count)
        own = places[first]
        turn = i % len(own)
        behind = itertools.chain.from_iterable(places[first + 1 : first + 1 + TRIES])
        groups.append([*own[turn:], *own[:turn], *behind][:TRIES])
    return groups


def code_lines(file: str) -> int:
    lines = (LIBRARY / file).read_text(encoding="utf-8").splitlines()
    return sum(bool(re.match(r"\s*[^\s/*#]", line)) for line in lines)


def chosen(count: int) -> list[list[Mutant]]:
    """Mutants spread over the files by their lines of code."""
    files = sources()
    counts = shares([code_lines(file) for file in files], count)
    return [group for file, share in zip(files, counts) if share for group in strided(mutants(file), share)]


# -------------------------------------------------------------------------------------------------------------- running

_bench: Bench | None = None  # one per worker process


def try_one(bench: Bench, mutant: Mutant, folder: Path) -> Outcome:
    made = bench.build(mutant, folder)
    if made != "made":
        return Outcome(mutant, made)
    for name in bench.order(mutant):
        ran = bench.ran(name, folder, bench.limit(name))
        if not ran.good:
            return Outcome(mutant, BY_HASH if name == BITS else KILLED, name, ran.why)
    probed = bench.ran("probe", folder, bench.limit("probe"))
    if probed.good and probed.output == bench.probe_output:
        return Outcome(mutant, EQUIVALENT)
    return Outcome(mutant, SURVIVED, "", differing(bench.probe_output, probed.output))


def differing(one: str, other: str) -> str:
    """The first words of the probe's lines that differ."""
    lines = other.splitlines()
    return ", ".join(sorted({line.split()[0] for line in one.splitlines() if line not in lines}))


def try_group(group: list[Mutant]) -> list[Outcome]:
    """The first mutant that compiles, and those before it."""
    assert _bench
    folder = _bench.folder / f"process_{os.getpid()}"
    found: list[Outcome] = []
    for mutant in group:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        found.append(try_one(_bench, mutant, folder))
        if found[-1].came_to != NO_CODE:
            break
    return found


class Kept:
    """Earlier outcomes: a line of JSON for each mutant. The outcome of a killed mutant is valid while the library and
    the killing test are unchanged, any other while all tests are."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "outcomes.jsonl"
        self.tests = {name: test_hash(name) for name in unit_tests()}
        self.all_tests = hash_of([PROBE], json.dumps(self.tests))
        self.known: dict[tuple[int, int, str, str], Outcome] = {}
        for line in self.path.read_text(encoding="utf-8").splitlines() if self.path.exists() else ():
            entry = json.loads(line)
            outcome = Outcome(**{**entry["outcome"], "mutant": Mutant(**entry["outcome"]["mutant"])})
            if entry["tests"] == self.stamp(outcome):
                self.known[self.place(outcome.mutant)] = outcome

    @staticmethod
    def place(mutant: Mutant) -> tuple[int, int, str, str]:
        return mutant.begin, mutant.end, mutant.text, mutant.file

    def stamp(self, outcome: Outcome) -> str:
        if outcome.came_to in (NO_CODE, SAME_CODE):
            return ""
        return self.tests.get(outcome.test, "") if outcome.came_to == KILLED else self.all_tests

    def of_group(self, group: list[Mutant]) -> list[Outcome] | None:
        """The outcomes of a group, if all are known."""
        found: list[Outcome] = []
        for mutant in group:
            outcome = self.known.get(self.place(mutant))
            if outcome is None:
                return None
            found.append(outcome)
            if outcome.came_to != NO_CODE:
                return found
        return found

    def keep(self, outcome: Outcome) -> None:
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"tests": self.stamp(outcome), "outcome": asdict(outcome)}) + "\n")


def try_all(groups: list[list[Mutant]], jobs: int) -> list[Outcome]:
    global _bench
    folder = CACHE / library_hash()
    folder.mkdir(parents=True, exist_ok=True)
    kept = Kept(folder)
    _bench = Bench(folder, jobs)
    found = [kept.of_group(group) for group in groups]
    new = [group for group, known in zip(groups, found) if known is None]
    new.sort(key=lambda group: hash_of([], *group[0].key))  # a run stopped early has then tried some of every file
    outcomes = [outcome for known in found if known for outcome in known]
    with multiprocessing.get_context("fork").Pool(jobs) as pool:
        for of_group in pool.imap_unordered(try_group, new):
            for outcome in of_group:
                kept.keep(outcome)
            outcomes += of_group
    for left in folder.glob("process_*"):
        shutil.rmtree(left)
    return outcomes


def of_layer(layer: mutation_trees.Layer, amount: Amount) -> Result:
    begun = time.monotonic()
    trees = mutation_trees.prepared(layer, amount.jobs)
    every = layer.mutants()
    count = LONG_OF_LAYER if amount.long else QUICK
    outcomes = mutation_trees.try_all(trees, mutation_trees.sampled(every, count, SEED))
    entries = survivors.read(layer.reasons)
    reasons = {entry.key: entry.reason for entry in entries}
    known = {mutant.key for mutant in every}
    made = rows_of_layer(layer.name, outcomes, reasons)
    made.append(row_of_strangers(layer.reasons, [entry for entry in entries if entry.key not in known]))
    return Result(made, report(outcomes, reasons, time.monotonic() - begun))


def row_of_strangers(listed: Path, wrong: Sequence[survivors.Survivor]) -> Row:
    lines = ", ".join(f"line {entry.line}" for entry in wrong) or "none"
    return Row(f"entries of {listed.relative_to(ROOT)} that fit no mutant", lines, "none", not wrong)


def of_library(amount: Amount) -> Result:
    begun = time.monotonic()
    entries = survivors.read()
    reasons = {entry.key: entry.reason for entry in entries}
    outcomes = try_all(chosen(LONG if amount.long else QUICK), amount.jobs)
    made = [*rows(outcomes, reasons), row_of_strangers(survivors.LIST, survivors.strangers(entries))]
    return Result(made, report(outcomes, reasons, time.monotonic() - begun))


def run(amount: Amount) -> Result:
    parts = [of_library(amount), *(of_layer(layer, amount) for layer in mutation_trees.LAYERS)]
    return Result([row for part in parts for row in part.rows], "\n\n\n".join(part.report for part in parts))
