"""Share of answers within two sigma of the truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..flights.flight import Flight

COVERED_SIGMA = 2.0


class Judged(Protocol):
    """Errors and sigmas (K, 6) of a track's answers, NaN without one; suspect (K,)."""

    @property
    def error(self) -> np.ndarray: ...
    @property
    def sigma(self) -> np.ndarray: ...
    @property
    def suspect(self) -> np.ndarray: ...


@dataclass
class BoxOutcome:
    """Errors and sigmas (K, 6) of the answers, NaN without one; suspect (K,)."""

    flight: Flight
    error: np.ndarray
    sigma: np.ndarray
    suspect: np.ndarray


def coverage(outcomes: Sequence[Judged]) -> np.ndarray:
    """(6,) percent of a track's answers within two sigma, averaged over the tracks with an answer, whatever their
    length."""
    shares = np.full((len(outcomes), 6), np.nan)
    for i, outcome in enumerate(outcomes):
        count = np.isfinite(outcome.error).sum(0)
        with np.errstate(invalid="ignore"):
            inside = (np.abs(outcome.error) < COVERED_SIGMA * outcome.sigma).sum(0)
        shares[i] = np.where(count > 0, 100.0 * inside / np.maximum(count, 1), np.nan)
    there = np.isfinite(shares)
    return np.where(there.any(0), np.nansum(shares, 0) / np.maximum(there.sum(0), 1), np.nan)
