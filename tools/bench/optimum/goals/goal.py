"""A line of the goals' table, and the names of its columns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from goe_tools.models.judge import ORIENTATION

NAMES = ("X0", "Z0", "orientation", "W", "L", "H")
ALL = tuple(range(6))
UNITS = np.where(np.arange(6) == ORIENTATION, 180.0 / math.pi, 1.0)  # angles are shown in degrees
Figures = dict[str, float]
Range = tuple[float, float]  # wanted range, including its ends
OPEN = (-math.inf, math.inf)


@dataclass
class Goal:
    """A line of the table. ``wanted`` applies to the values named in ``asked``; without names the line is
    information."""

    group: str
    name: str
    unit: str
    values: Figures
    wanted: Range = OPEN
    asked: tuple[str, ...] = ()

    @property
    def met(self) -> bool | None:
        if not self.asked:
            return None
        low, high = self.wanted
        return all(low <= self.values.get(name, math.nan) <= high for name in self.asked)

    @property
    def missed(self) -> tuple[str, ...]:
        low, high = self.wanted
        return tuple(name for name in self.asked if not low <= self.values.get(name, math.nan) <= high)


def named(values: Iterable[float], numbers: Sequence[int] = ALL) -> Figures:
    return {NAMES[i]: float(v) for i, v in zip(numbers, values)}


def names_of(numbers: Sequence[int]) -> tuple[str, ...]:
    return tuple(NAMES[i] for i in numbers)
