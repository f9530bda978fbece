"""Effect of float32 rounding on the answers: the same filter in float32, as in firmware, and in float64.

Both get the same numbers. If a decision differs (a model, an outlier at the edge of the gate), the answers differ by
more than rounding; images with different methods, models or sets of valid quantities are
counted but not compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from goe_tools.flights.flight import Flight
from goe_tools.flights.rotations import fold
from goe_tools.library import METHODS, Track, estimate, known_shape
from goe_tools.models.judge import ORIENTATION


@dataclass
class Rounding:
    """One flight with K images."""

    sigmas: np.ndarray  # (K, 6) |float32 - float64| over the float64 filter's one sigma; NaN where not compared
    answered: int  # images with an answer of the filter method in either build
    apart: int  # of these, those where method, model or validity differ

    @property
    def worst(self) -> np.ndarray:
        """(6,): largest difference over the images, sigmas; NaN without any."""
        return np.fmax.reduce(self.sigmas, 0)

    @property
    def last(self) -> np.ndarray:
        """(6,): difference at the end of the run, sigmas."""
        return self.sigmas[-1]


def _refined(track: Track) -> np.ndarray:
    """(K,): images with an answer of the filter method."""
    return (track.method == METHODS["filter"]) & track.valid.any(1)


def rounding_of(flight: Flight) -> Rounding:
    """Runs both builds over a flight, with the obstacle's shape configured (``known_shape``)."""
    shape = known_shape(flight)
    single, double = estimate(flight, **shape), estimate(flight, double=True, **shape)
    either = _refined(single) | _refined(double)
    same = (single.method == double.method) & (single.model == double.model) & (single.valid == double.valid).all(1)
    difference = single.values - double.values
    difference[:, ORIENTATION] = fold(difference[:, ORIENTATION])
    compared = (either & same)[:, None] & single.valid
    with np.errstate(invalid="ignore", divide="ignore"):
        sigmas = np.where(compared, np.abs(difference) / double.sigma, np.nan)
    return Rounding(sigmas, int(either.sum()), int((either & ~same).sum()))
