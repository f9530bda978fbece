"""Single precision: the numbers, and what the C library asks of their bits."""

from __future__ import annotations

import numpy as np

F = np.float32
Decisions = dict[str, bool]
ZERO, HALF, ONE, TWO = F(0.0), F(0.5), F(1.0), F(2.0)


def magnitude(x: np.float32) -> int:
    """Bits of |x|, which order as the magnitudes do."""
    return int(F(x).view(np.uint32)) & 0x7FFFFFFF


def within(x: np.float32, limit: np.float32) -> bool:
    return magnitude(x) <= magnitude(limit)


def larger(a: np.float32, b: np.float32) -> np.float32:
    return a if a > b else b
