"""Other published methods, written from their mathematics, for comparison on the same flights.

Each rival takes a ``Track`` and returns quantities and, with ``_sd`` before the unit, their one-sigmas. Quantities that
it does not estimate are absent; without enough images or parallax the result is an empty dict. ``box`` is 1 if x0, z0
are the middle of the front edge and 0 if they are the axis of a disc (for a box: of the disc that replaces it).

All take the pose as exact, so their sigmas do not include its errors. They get the association of the
corners, the noise of points and attitude, and Huber's weights against outliers.
"""

from __future__ import annotations

from typing import Callable

from . import triangulation as _triangulation
from .bearing_angle import bearing_angle
from .inverse_depth import inverse_depth
from .inverse_size import inverse_size
from .points import Values
from .track import Track
from .triangulation import triangulation

__all__ = ["RIVALS", "Track", "history", "missing"]

RIVALS: dict[str, Callable[[Track], Values]] = {
    "triangulation": triangulation,
    "inverse_depth": inverse_depth,
    "bearing_angle": bearing_angle,
    "inverse_size": inverse_size,
}


def missing() -> dict[str, str]:
    """Rivals that cannot run here, with the reason."""
    reason = _triangulation.absent()
    return {"triangulation": reason} if reason else {}


def history(name: str, track: Track, every: int = 1) -> list[Values]:
    """The rival's answer after every ``every``-th image (empty dicts before the first one); cost grows with K
    squared."""
    return [RIVALS[name](track.until(count)) for count in range(every, len(track) + 1, every)]
