"""The parts of the evidence."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from dataclasses import dataclass

from .record import Result

MODULES: dict[str, str] = {  # name: description; the module of that name has run(amount)
    "targets": "the same bits on every processor and compiler, the safety tests at full length",
    "fuzz": "whether every answer keeps the headers' promises for any input",
    "coverage": "lines, branches and conditions reached by the unit tests",
    "worst_case": "the most instructions and stack of each public call: measured, proved, stated",
    "rounding": "float32 against float64 at the limits of the header, in sigmas",
    "flips": "one flipped bit anywhere in the estimator's memory",
    "programs": "faults found earlier in the programs, and the tests that detect their return",
    "reproducible": "whether two builds of the same sources give the same bits",
    "sbom": "the bill of materials: installed packages, and no foreign content in the library",
    "requirements": "whether every promise has tests, and every test a promise",
    "mutation": "small changes of lib/, port/flight and port/companion that the tests detect",
    "lies": "confident errors, and warnings that vanish, in random legal flights",
    "proof": "whether calls are free of undefined behavior for any bits",
    "misra": "whether each violation of MISRA C:2012 has a reason",
    "analyzers": "whether the compilers' analyzers report nothing",
}


class NotHereError(Exception):
    """A tool that the part needs is not installed; the text names it."""


@dataclass(frozen=True)
class Amount:
    """Amount of work: quick parts fit in ten minutes together, long ones have no limit."""

    long: bool = False
    jobs: int = os.cpu_count() or 1
    updates: int = 0  # fuzzing: minimum number; 0: the part's default

    @property
    def name(self) -> str:
        return "long" if self.long else "quick"


def runner(name: str) -> Callable[[Amount], Result]:
    """Imports the part's module."""
    run: Callable[[Amount], Result] = importlib.import_module(f".{name}", __package__).run
    return run
