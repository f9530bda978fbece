"""The parts of the evidence."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from dataclasses import dataclass

from .record import Result

MODULES: dict[str, str] = {  # name: what it asks; the module of that name has run(amount)
    "targets": "the same bits on every processor and compiler, the safety tests at full length",
    "fuzz": "whatever comes in: does every answer hold what the headers promise?",
    "coverage": "what the unit tests reach of every line, branch and condition",
    "worst_case": "the most instructions and stack of each public call: measured, proved, stated",
    "rounding": "float32 against float64 at the ends of what the header allows, in sigmas",
    "flips": "one flipped bit anywhere in the estimator's memory",
    "programs": "what an attack found in the programs, and the tests that would fail if it came back",
    "reproducible": "whether two builds of the same sources give the same bits",
    "sbom": "the bill of materials: what the tests and tools install, and that the library holds nothing but itself",
    "requirements": "has every promise its tests, and every test its promise",
    "mutation": "which small changes of lib/, port/flight and port/companion the tests notice",
    "lies": "confident errors, and warnings that vanish, in random flights that the manual allows",
    "proof": "is no call undefined, whatever bits it is given",
    "misra": "is each violation of MISRA C:2012 one that has its reason",
    "analyzers": "do the compilers' analysers find nothing",
}


class NotHereError(Exception):
    """A tool that the part needs is not installed; says which."""


@dataclass(frozen=True)
class Amount:
    """How much is run: quick ones fit ten minutes together, long ones take what they take."""

    long: bool = False
    jobs: int = os.cpu_count() or 1
    updates: int = 0  # fuzzing: at least so many; 0: as the part thinks fit

    @property
    def name(self) -> str:
        return "long" if self.long else "quick"


def runner(name: str) -> Callable[[Amount], Result]:
    """Imported when it is asked for."""
    run: Callable[[Amount], Result] = importlib.import_module(f".{name}", __package__).run
    return run
