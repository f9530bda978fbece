"""Share of the library's answers, with given settings, that are within two sigmas of the truth."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..flights.flight import Flight
from ..library import METHODS, camera_settings, estimate
from ..models.coverage import BoxOutcome, coverage
from ..models.judge import HEIGHT, X0, Z0

JUDGED = {"X0": X0, "Z0": Z0, "H": HEIGHT}


def outcome_of(flight: Flight, settings: dict[str, float]) -> BoxOutcome:
    """Errors and sigmas of X0, Z0 and H in all images with an answer."""
    track = estimate(flight, {**camera_settings(flight), **settings})
    judged = track.valid & (track.method == METHODS["filter"])[:, None]
    judged[:, [i for i in range(6) if i not in JUDGED.values()]] = False
    error, sigma = (np.where(judged, a, np.nan) for a in (track.values - flight.truth.values, track.sigma))
    return BoxOutcome(flight, error, sigma, track.suspect)


def covered(flights: Sequence[Flight], settings: dict[str, float]) -> dict[str, float]:
    """Percent of the answers within two sigmas, by quantity: of each track, then averaged; NaN without an answer."""
    if not flights:
        return dict.fromkeys(JUDGED, math.nan)
    shares = coverage([outcome_of(flight, settings) for flight in flights])
    return {name: float(shares[i]) for name, i in JUDGED.items()}
