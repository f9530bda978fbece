"""The paper's Table 3, and the range of a set of errors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

MOST = 0.75  # share of the cases that counts as "most of the values"
FRACTION = 0.4  # part of a run's solved images, at its end, that the statistics cover
TABLE3_QUANTITIES = ("z0", "x0", "width", "length", "height")


@dataclass(frozen=True)
class PaperRange:
    """A number of the paper's Table 3: most values inside +-value, or with ``beyond`` most of them outside."""

    value: float
    beyond: bool = False

    def __str__(self) -> str:
        return f">{self.value:g}" if self.beyond else f"{self.value:g}"


def _paper(z0: float, x0: float, width: float, length: float | None, height: float) -> dict[str, PaperRange | None]:
    """Negative: the paper's sign for 'most values are outside'."""
    numbers = dict(zip(TABLE3_QUANTITIES, (z0, x0, width, length, height)))
    return {q: None if n is None else PaperRange(abs(n), n < 0) for q, n in numbers.items()}


# (obstacle, model in the paper's words) -> the paper's Table 3
PAPER_TABLE3: dict[tuple[str, str], dict[str, PaperRange | None]] = {
    ("cylinder", "disc"): _paper(3, 10, 12, None, 1),
    ("truck", "disc"): _paper(5, -20, -50, None, 2),
    ("long-truck", "disc"): _paper(5, -20, -50, None, 2),
    ("building", "line"): _paper(10, 30, 5, 30, 8),
    ("truck", "line"): _paper(7, 20, 2, 25, 2),
    ("long-truck", "line"): _paper(7, 25, 2, 25, 2),
}


def holding_range(extents: np.ndarray, share: float = MOST) -> float:
    """The smallest value that at least ``share`` of the extents do not exceed; NaN for none."""
    values = np.sort(extents[np.isfinite(extents)])
    if not len(values):
        return math.nan
    return float(values[math.ceil(share * len(values) - 1e-9) - 1])
