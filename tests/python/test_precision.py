"""The library in float32 against the same library in float64: rounding must be far below the sigmas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bench.optimum.precision import rounding_of
from goe_tools import double_precision
from goe_tools.flights.measured import measure
from goe_tools.flights.noise import NOISES
from goe_tools.flights.scene import Scene
from goe_tools.flights.simulated import paper_scenes, random_scenes
from goe_tools.library import MODEL_DISC, estimate, package, ready

LIMIT = 0.05  # of one sigma
NAMES = ("gauss0.3", "gauss1", "field")


@pytest.fixture(scope="module", autouse=True)
def built() -> None:
    for double in (False, True):
        try:
            ready(double)
        except FileNotFoundError as reason:
            pytest.skip(str(reason))


@pytest.fixture(scope="module")
def scenes() -> list[Scene]:
    """Every sixth of the paper's cases, and a few random ones."""
    return paper_scenes()[::6] + random_scenes(24)


@pytest.fixture(scope="module")
def box(scenes: list[Scene]) -> Scene:
    return next(scene for scene in scenes if scene.truth.kind == "box")


@pytest.mark.parametrize("noise", NAMES)
def test_rounding_is_small_beside_the_sigma(noise: str, scenes: list[Scene]) -> None:
    flights = [rounding_of(measure(s, NOISES[noise], (1, i))) for i, s in enumerate(scenes)]
    worst, last = (np.array([getattr(r, name) for r in flights]) for name in ("worst", "last"))
    assert np.isfinite(worst).sum(0).min() >= 10  # every quantity was compared
    assert max(np.quantile(column[np.isfinite(column)], 0.99) for column in worst.T) < LIMIT
    assert np.nanmax(last) <= LIMIT
    assert sum(r.answered for r in flights) > 50 * len(flights)
    assert sum(r.apart for r in flights) <= 0.01 * sum(r.answered for r in flights)


def test_the_other_build_does_compute_in_float64(box: Scene) -> None:
    """Its structs contain doubles, and its answers differ slightly."""
    _, types = double_precision.library()
    single = [getattr(package(), name) for name in ("IMAGE", "ESTIMATE", "HAZARD")]
    assert all(wide.itemsize > 1.5 * plain.itemsize for wide, plain in zip(types, single))
    flight = measure(box, NOISES["gauss0.3"], 1)
    single, double = estimate(flight), estimate(flight, double=True)
    assert 0.0 < np.nanmax(np.abs(single.values[-1] - double.values[-1])) < 0.1
    assert math.isfinite(rounding_of(flight).worst.max())


def test_where_the_builds_decide_otherwise_is_counted(monkeypatch: pytest.MonkeyPatch, box: Scene) -> None:
    flight = measure(box, NOISES["gauss1"], 1)
    tracks = [estimate(flight), estimate(flight, double=True)]
    tracks[1].model[-3:] = MODEL_DISC
    tracks[0].values[-4] += 0.5 * tracks[1].sigma[-4]
    monkeypatch.setattr("bench.optimum.precision.estimate", lambda _, double=False: tracks[int(double)])
    rounding = rounding_of(flight)
    assert rounding.apart == 3
    assert np.isnan(rounding.last).all()
    assert rounding.worst == pytest.approx(np.full(6, 0.5), abs=0.01)
