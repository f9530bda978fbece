"""The parts of the evidence."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from dataclasses import dataclass

from .record import Result

MODULES: dict[str, str] = {  # name: what it asks; the module of that name has run(amount)
    "flips": "one flipped bit anywhere in the estimator's memory",
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
