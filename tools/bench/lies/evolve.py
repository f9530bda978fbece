"""Evolves the worst flights: genes mutated and crossed, errors drawn again, for some generations.

The result is not a random sample: it shows what exists, not how often.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from goe_tools.spread import Workers, spread
from tqdm import tqdm

from . import search
from .decode import decode
from .finds import CONFIDENT_SIGMA, JUDGED, KINDS, PROMISED, Finds
from .genes import GENES, MIXES, Flights
from .judge import DISC, Judged
from .search import BATCH, Flown
from .shrink import all_wants, hits
from .tally import Key, worst_images

PER_MIX = 500
NICHE = 12  # survivors of one class
SURVIVORS = 100
MUTATED, STEP, REDRAWN = 0.08, 0.15, 0.02  # shares of genes, and size of a step
CROSSED, SAME_ERRORS = 0.3, 0.4  # shares of children
WORST_VIOLATION = 1e-9


@dataclass
class Best:
    """A flight of a class, and its score."""

    score: float
    flights: Flights


@dataclass
class Scored:
    """Of F flights: the score of each (1 and more: a find), and its class."""

    score: np.ndarray
    niche: np.ndarray
    finds: list[tuple[str, str, float, int]] = field(default_factory=list)  # kind, what, score, flight


def _safety(judged: Judged, lies: Finds) -> np.ndarray:
    """(N,): 1 if a true violation has a probability of a hundredth."""
    low = np.log10(np.clip(judged.violation, WORST_VIOLATION, 1.0))
    return np.where(judged.violated & np.isfinite(judged.violation), -0.5 * low, 0.0).max(1) * ~lies.doubted.any(1)


def _vanishing(flown: Flown) -> np.ndarray:
    """(N,): 1 if a warning fell from 0.5 to 0.05 from one image to the next."""
    judged, world = flown.judged, flown.world
    now = np.nan_to_num(judged.violation)
    before = np.roll(now, 1, 0)
    same = (np.roll(world.flight, 1) == world.flight) & np.all(np.roll(world.velocity, 1, 0) == world.velocity, 1)
    counted = judged.violated & same[:, None] & (flown.lies.cause >= PROMISED)
    return np.where(counted, (before - now) / 0.95, 0.0).max(1)


def score(flights: Flights) -> Scored:
    flown = search.fly(decode(flights))
    lies, world = flown.lies, flown.world
    ratio = np.nan_to_num(lies.ratio[:, : len(JUDGED)])
    parts = np.stack(
        [np.minimum(ratio.max(1) / CONFIDENT_SIGMA, 10.0), _safety(flown.judged, lies), _vanishing(flown)], 1
    )
    parts = np.nan_to_num(parts)
    found, images = worst_images(world, parts.max(1))
    result = Scored(np.zeros(len(flights)), np.zeros(len(flights), int))
    result.score[found] = parts.max(1)[images]
    e = flown.found.estimates
    kind = parts[images].argmax(1)
    what = np.where(kind == 0, ratio[images].argmax(1), np.where(kind == 1, 0, lies.cause.max(1)[images]))
    result.niche[found] = ((kind * 32 + what) * 8 + e["model"][images]) * 2 + (e["model"][images] == DISC)
    for want in all_wants():
        hit = hits(flown, want)
        if hit.any():
            size = parts[:, KINDS.index(want.kind)] * hit
            result.finds += [(want.kind, want.what, float(size[k]), int(i)) for i, k in zip(*worst_images(world, size))]
    return result


def survivors(flights: Flights, scored: Scored) -> Flights:
    """The worst flights, with a limit for each class to keep all classes."""
    order = np.argsort(-scored.score, kind="stable")
    taken: dict[int, int] = {}
    chosen = []
    for i in order.tolist():
        niche = int(scored.niche[i])
        taken[niche] = taken.get(niche, 0) + 1
        if taken[niche] <= NICHE:
            chosen.append(i)
        if len(chosen) == SURVIVORS:
            break
    return flights.take(np.array(chosen))


def children(parents: Flights, count: int, rng: np.random.Generator) -> Flights:
    mothers, fathers = (rng.integers(0, len(parents), count) for _ in range(2))
    unit = parents.unit[mothers].copy()
    crossed = (rng.random((count, 1)) < CROSSED) & (rng.random(unit.shape) < 0.5)
    unit = np.where(crossed, parents.unit[fathers], unit)
    moved = unit + np.where(rng.random(unit.shape) < MUTATED, STEP * rng.standard_normal(unit.shape), 0.0)
    moved = np.clip(np.abs(moved), 0.0, 2.0)
    unit = np.where(moved > 1.0, 2.0 - moved, moved)
    unit = np.where(rng.random(unit.shape) < REDRAWN, rng.random(unit.shape), unit)
    fresh = rng.integers(0, 2**63, count).astype(np.uint64)
    seed = np.where(rng.random(count) < SAME_ERRORS, parents.seed[mothers], fresh)
    assert unit.shape[1] == len(GENES)
    return Flights(parents.mix[mothers], unit, seed)


def _joined(one: Flights, other: Flights) -> Flights:
    return Flights(*(np.concatenate([getattr(one, n), getattr(other, n)]) for n in ("mix", "unit", "seed")))


def _kept(best: dict[Key, Best], flights: Flights, scored: Scored) -> None:
    for kind, what, size, row in scored.finds:
        key = (kind, MIXES[int(flights.mix[row])], what)
        if key not in best or size > best[key].score:
            best[key] = Best(size, flights.take(np.array([row])))


def evolve(seed: int, mixes: Sequence[int], generations: int, workers: Workers) -> dict[Key, Best]:
    """The worst flight of each kind, mix and quantity or cause."""
    rng = np.random.default_rng([seed, 1 << 31])
    best: dict[Key, Best] = {}
    populations = [search.flights_of(search.Task(seed, (1 << 30) + mix, BATCH, (mix,))) for mix in mixes]
    rounds = tqdm(range(generations + 1), desc="generations", disable=None, leave=False)
    parents: list[Flights] = []
    for number in rounds:
        scored = list(spread(score, populations, workers))
        for flights, result in zip(populations, scored):
            _kept(best, flights, result)
        if number == generations:
            break
        parents = [survivors(f, s) for f, s in zip(populations, scored)]
        populations = [_joined(p, children(p, PER_MIX - len(p), rng)) for p in parents]
    return best
